/* A host that drives the procedure itself, stage by stage and phase by phase: it shows how far each
 * solve is, lets its user cancel one, and goes on from the state before. Last, a solve that does not
 * converge is written to one file, which replay.c solves again: a bug report.
 *
 * Build:  cc drive_stages.c $(pkg-config --cflags --libs brainshift_c) -o drive_stages
 * Run:    drive_stages [FILE]     (of the failing scene; failing.brainshift by default)
 * Prints: a line per Newton iteration and stage; "cancelled"; "not converged, written to FILE"
 */
#include <stdio.h>
#include <stdlib.h>

#include "block.h"
#include "brainshift/c/brainshift.h"

static brs_context* context;

static brs_status check(brs_status status) {
  if (status < 0) {
    fprintf(stderr, "%s: %s\n", brs_status_name(status), brs_context_message(context));
    exit(EXIT_FAILURE);
  }
  return status;
}

static void hear(brs_status status, const char* text, void* user) {
  (void)user;
  printf("  log: %s%s%s\n", status == BRS_OK ? "" : brs_status_name(status),
         status == BRS_OK ? "" : ": ", text);
}

/* Cancels when the iterations that the user grants are over. */
static int32_t show(const brs_progress* progress, void* user) {
  int* granted = (int*)user;
  printf("  iteration %d, residual %.1e\n", (int)progress->iteration, progress->residual);
  return --*granted <= 0;
}

/* One solve in its phases. A host may draw, or answer its user, between any two of them. */
static brs_status solve(brs_stepper* stepper) {
  int32_t phase = BRS_PHASE_BEGUN;
  brs_status status = BRS_OK;
  check(brs_stepper_begin_static(stepper));
  check(brs_stepper_phase(stepper, &phase)); /* CONVERGED where there is nothing to do */
  while (phase == BRS_PHASE_BEGUN || phase == BRS_PHASE_UPDATED) {
    check(brs_stepper_linearise(stepper));
    check(brs_stepper_solve(stepper));
    status = check(brs_stepper_update(stepper, &phase));
  }
  check(phase == BRS_PHASE_CONVERGED ? brs_stepper_accept(stepper, NULL) : brs_stepper_reject(stepper));
  return status;
}

static brs_scene* make_scene(void) {
  static double nodes[NODES * 3];
  static int32_t tets[TETS * 4], body[12 * CELLS * CELLS], wet[12 * CELLS * CELLS], base[BASE_NODES];
  const int64_t room = 12 * CELLS * CELLS;
  brs_mesh* mesh;
  brs_scene* scene;
  brs_material material;
  brs_compartment box;
  for (int32_t i = 0; i < BASE_NODES; ++i) base[i] = i;
  make_block(nodes, tets);
  check(brs_mesh_create(context, nodes, NODES, tets, TETS, NULL, 1, &mesh));
  check(brs_scene_create(context, mesh, &scene));
  check(brs_material_init(&material, sizeof material));
  material.law = "stable_neo_hookean";
  material.young = 6.0, material.poisson = 0.45, material.density = 1.04e-6;
  check(brs_scene_set_material(scene, 0, &material));
  check(brs_scene_add_fixed(scene, "base", base, BASE_NODES, BRS_AXES, NULL));
  check(brs_compartment_init(&box, sizeof box));
  box.name = "box";
  box.wall_points = block_wall, box.wall_point_count = 8;
  box.wall_triangles = block_wall_triangles, box.wall_triangle_count = 12;
  box.body_faces = body, box.wetted_faces = wet;
  check(brs_mesh_faces(mesh, 0, NULL, 0, body, room, &box.body_face_count));
  check(brs_mesh_faces(mesh, 0, base, BASE_NODES, wet, room, &box.wetted_face_count));
  check(brs_scene_set_csf(scene, 1.0e-6, BRS_CSF_SEPARATE, 70.0));
  check(brs_scene_add_compartment(scene, &box, NULL));
  check(brs_mesh_destroy(mesh)); /* the scene has its own share */
  return scene;
}

static void write_recording(brs_stepper* stepper, const char* path) {
  int64_t count = 0;
  uint8_t* bytes;
  FILE* file = fopen(path, "wb");
  check(brs_stepper_record(stepper, NULL, 0, &count));
  bytes = malloc((size_t)count);
  if (!file || !bytes) {
    fprintf(stderr, "%s cannot be written\n", path);
    exit(EXIT_FAILURE);
  }
  check(brs_stepper_record(stepper, bytes, count, &count));
  if (fwrite(bytes, 1, (size_t)count, file) != (size_t)count || fclose(file) != 0) exit(EXIT_FAILURE);
  free(bytes);
}

int main(int argc, char** argv) {
  const char* path = argc > 1 ? argv[1] : "failing.brainshift";
  static const double tip[3] = {22.0, 33.0, 21.0}, outward[3] = {0.0, 0.0, 1.0};
  const double length = 45.0; /* mm */
  int granted = 1000, cancelled;
  int32_t id;
  brs_scene* scene;
  brs_stepper* stepper;
  brs_stepper_options options;
  brs_device *cannula, *lead;
  brs_hold hold;

  check(brs_context_create(BRS_VERSION, &context));
  check(brs_context_set_progress(context, show, &granted));
  check(brs_context_set_log(context, hear, NULL));
  scene = make_scene();
  check(brs_stepper_create(scene, NULL, &stepper));

  puts("stage 1: fluid is lost");
  check(brs_stepper_set_csf(stepper, 0, BRS_CSF_LOST_VOLUME, 150e3));
  if (solve(stepper) != BRS_OK) return EXIT_FAILURE;

  puts("stage 2: a cannula, held by the frame");
  check(brs_device_create_named(context, "cannula", length, NULL, &cannula));
  check(brs_hold_init(&hold, sizeof hold));
  hold.rigid_from = 0.0;
  check(brs_stepper_insert(stepper, cannula, tip, outward, &hold, NULL, &id));
  if (solve(stepper) != BRS_OK) return EXIT_FAILURE;

  puts("stage 3: more is lost; the user cancels after the second iteration");
  check(brs_stepper_set_csf(stepper, 0, BRS_CSF_LOST_VOLUME, 350e3));
  granted = 2;
  cancelled = solve(stepper) == BRS_CANCELLED;
  puts(cancelled ? "cancelled" : "not cancelled");

  puts("stage 3 again, to its end");
  granted = 1000;
  if (!cancelled || solve(stepper) != BRS_OK) return EXIT_FAILURE;

  puts("stage 4: the lead takes over, its wire held by the skull");
  check(brs_device_create_named(context, "3389", length, NULL, &lead));
  check(brs_hold_init(&hold, sizeof hold));
  hold.anchor = length;
  check(brs_stepper_exchange(stepper, id, lead, &hold, 0.0));
  if (solve(stepper) != BRS_OK) return EXIT_FAILURE;

  puts("a solve with too few iterations");
  check(brs_stepper_destroy(stepper));
  check(brs_stepper_options_init(&options, sizeof options));
  options.max_iterations = 1, options.smallest_load_step = 0.5;
  check(brs_stepper_create(scene, &options, &stepper));
  check(brs_stepper_set_csf(stepper, 0, BRS_CSF_LOST_VOLUME, 350e3));
  if (solve(stepper) != BRS_NOT_CONVERGED) return EXIT_FAILURE;
  write_recording(stepper, path);
  printf("not converged, written to %s\n", path);

  brs_stepper_destroy(stepper);
  brs_device_destroy(cannula);
  brs_device_destroy(lead);
  brs_scene_destroy(scene);
  brs_context_destroy(context);
  return EXIT_SUCCESS;
}
