/* The smallest complete use of libbrainshift in C: a block of soft tissue stands on the floor of a
 * box full of cerebrospinal fluid. The fluid is let out, buoyancy is gone, and the block sags.
 *
 *        +-----------+  wall                 +-----------+
 *        | ~~~~~~~~~ |  fluid                |   _____   |  air
 *        | ~+-----+~ |              ->       |  /     \  |
 *        | ~|block|~ |                       | (       ) |
 *        +--+=====+--+  held base            +--+=====+--+
 *
 * Build:  cc hello.c -lbrainshift_c -o hello
 * Prints: level 29.357 mm, air 297.636 mL (the tissue, no longer under pressure, swells by 2.4 mL)
 *         middle of the top moved by (-0.249353, -0.249353, -1.469564) mm (sideways: a coarse mesh)
 *         and the certificate of the solve: residual, smallest det F, iterations, seconds
 */
#include <stdio.h>
#include <stdlib.h>

#include "brainshift/c/brainshift.h"

enum { CELLS = 6, SIDE = CELLS + 1, NODES = SIDE * SIDE * SIDE, TETS = 6 * CELLS * CELLS * CELLS };

static const double edge = 60.0; /* mm */
static double nodes[NODES * 3];
static int32_t tets[TETS * 4];

/* Six tets per cell: one for each order in which x, y, z are climbed from corner to corner. */
static void make_block(void) {
  static const int climb[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  static const int32_t stride[3] = {1, SIDE, SIDE * SIDE};
  int32_t* tet = tets;
  for (int i = 0; i < NODES; ++i)
    for (int a = 0; a < 3; ++a) nodes[3 * i + a] = edge / CELLS * (i / stride[a] % SIDE);
  for (int c = 0; c < CELLS * CELLS * CELLS; ++c)
    for (int t = 0; t < 6; ++t) {
      *tet++ = c % CELLS + SIDE * (c / CELLS % CELLS) + SIDE * SIDE * (c / CELLS / CELLS);
      for (int step = 0; step < 3; ++step, ++tet) *tet = tet[-1] + stride[climb[t][step]];
    }
}

static brs_context* context;

static void check(brs_status status) {
  if (status == BRS_OK) return;
  fprintf(stderr, "%s: %s\n", brs_status_name(status), brs_context_message(context));
  if (status < 0) exit(EXIT_FAILURE);
}

int main(void) {
  printf("%s\n", brs_build_info());
  check(brs_context_create(BRS_VERSION, &context));

  /* 1. The mesh; tets may be given either way round. */
  brs_mesh* mesh;
  make_block();
  check(brs_mesh_create(context, nodes, NODES, tets, TETS, NULL, 1, &mesh));

  /* 2. The scene: a material, and a base that is held (the first layer of nodes). */
  brs_scene* scene;
  brs_material material;
  int32_t base[SIDE * SIDE];
  for (int32_t i = 0; i < SIDE * SIDE; ++i) base[i] = i;
  check(brs_scene_create(context, mesh, &scene));
  check(brs_material_init(&material, sizeof material));
  material.law = "stable_neo_hookean";
  material.young = 6.0; /* kPa */
  material.poisson = 0.45;
  material.density = 1.04e-6; /* kg/mm^3 */
  check(brs_scene_set_material(scene, 0, &material));
  check(brs_scene_add_fixed(scene, "base", base, SIDE * SIDE, BRS_AXES, NULL));

  /* 3. The fluid: a box around the block; it wets all of its surface but the base. */
  static const double wall[24] = {-20, -20, 0,  80, -20, 0,  -20, 80, 0,  80, 80, 0,
                                  -20, -20, 70, 80, -20, 70, -20, 80, 70, 80, 80, 70};
  static const int32_t wall_triangles[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                             2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  static int32_t body[12 * CELLS * CELLS], wet[12 * CELLS * CELLS];
  brs_compartment box;
  check(brs_compartment_init(&box, sizeof box));
  box.name = "box";
  box.wall_points = wall, box.wall_point_count = 8;
  box.wall_triangles = wall_triangles, box.wall_triangle_count = 12;
  box.body_faces = body, box.wetted_faces = wet;
  check(brs_mesh_faces(mesh, 0, NULL, 0, body, 12 * CELLS * CELLS, &box.body_face_count));
  check(
      brs_mesh_faces(mesh, 0, base, SIDE * SIDE, wet, 12 * CELLS * CELLS, &box.wetted_face_count));
  check(brs_scene_set_csf(scene, 1.0e-6, BRS_CSF_SEPARATE, 70.0));
  check(brs_scene_add_compartment(scene, &box, NULL));

  /* 4. Let 300 mL of the 484 mL out, and solve for the new balance. */
  brs_stepper* stepper;
  brs_solve_report report;
  check(brs_stepper_create(scene, NULL, &stepper));
  check(brs_stepper_set_csf(stepper, 0, BRS_CSF_LOST_VOLUME, 300e3));
  check(brs_solve_report_init(&report, sizeof report));
  check(brs_stepper_solve_static(stepper, &report));

  /* 5. What came out of it. */
  brs_compartment_state csf;
  const double* u;
  const int top = 3 * (NODES - 1 - SIDE * SIDE / 2);
  check(brs_compartment_state_init(&csf, sizeof csf));
  check(brs_stepper_compartment(stepper, 0, &csf));
  check(brs_stepper_field(stepper, BRS_FIELD_DISPLACEMENT, &u, NULL, NULL));
  printf("level %.3f mm, air %.3f mL\n", csf.head, csf.air_volume / 1000.0);
  printf("middle of the top moved by (%.6f, %.6f, %.6f) mm\n", u[top], u[top + 1], u[top + 2]);
  printf("residual %.1e, min J %.3f, %d Newton iterations, %.3f s\n", report.residual,
         report.smallest_jacobian, (int)report.iterations, report.seconds);

  brs_stepper_destroy(stepper);
  brs_scene_destroy(scene);
  brs_mesh_destroy(mesh);
  brs_context_destroy(context);
  return report.status == BRS_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}
