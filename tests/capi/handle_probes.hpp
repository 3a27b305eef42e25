// A call of every function for each of its handles, all other arguments harmless.
// Written by capi/bindings/generate from include/brainshift/c/brainshift.h; do not edit.
// clang-format off
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "world.hpp"

namespace brainshift::test {

struct Probe {
  const char* function;
  const char* type;                       // of the handle that is replaced
  std::function<brs_status(void*)> call;
};

template <class T>
T* as(void* handle) {
  return static_cast<T*>(handle);
}

// What the calls read and write.
struct Harmless {
  brs_progress progress;
  brs_mesh_info mesh_info;
  brs_surface_options surface_options;
  brs_material material;
  brs_compartment compartment;
  brs_device_options device_options;
  brs_device_entry device_entry;
  brs_device_info device_info;
  brs_stepper_options stepper_options;
  brs_hold hold;
  brs_track_options track_options;
  brs_memory_estimate memory_estimate;
  brs_solve_report solve_report;
  brs_compartment_state compartment_state;
  brs_contact_state contact_state;
  brs_device_state device_state;
  brs_mcp_options mcp_options;
  brs_mcp_report mcp_report;
  double numbers[64] = {};
  std::int32_t indices[64] = {};
  std::uint8_t bytes[64] = {};
  std::int64_t count = 0;
  const double* view = nullptr;
  const std::int32_t* index_view = nullptr;

  Harmless() {
    brs_mesh_info_init(&mesh_info, sizeof mesh_info);
    brs_surface_options_init(&surface_options, sizeof surface_options);
    brs_material_init(&material, sizeof material);
    brs_compartment_init(&compartment, sizeof compartment);
    brs_device_options_init(&device_options, sizeof device_options);
    brs_device_entry_init(&device_entry, sizeof device_entry);
    brs_device_info_init(&device_info, sizeof device_info);
    brs_stepper_options_init(&stepper_options, sizeof stepper_options);
    brs_hold_init(&hold, sizeof hold);
    brs_track_options_init(&track_options, sizeof track_options);
    brs_memory_estimate_init(&memory_estimate, sizeof memory_estimate);
    brs_solve_report_init(&solve_report, sizeof solve_report);
    brs_compartment_state_init(&compartment_state, sizeof compartment_state);
    brs_contact_state_init(&contact_state, sizeof contact_state);
    brs_device_state_init(&device_state, sizeof device_state);
    brs_mcp_options_init(&mcp_options, sizeof mcp_options);
    brs_mcp_report_init(&mcp_report, sizeof mcp_report);
    material.law = "x";
    compartment.name = "x";
  }
};

// Handles that came out of a call which went through.
struct Made {
  brs_context *context = nullptr;
  brs_mesh *mesh = nullptr;
  brs_surface *surface = nullptr;
  brs_scene *scene = nullptr;
  brs_device *device = nullptr;
  brs_stepper *stepper = nullptr;
  brs_snapshot *snapshot = nullptr;

  ~Made() { clear(); }
  void clear() {
    brs_context_destroy(std::exchange(context, nullptr));
    brs_mesh_destroy(std::exchange(mesh, nullptr));
    brs_surface_destroy(std::exchange(surface, nullptr));
    brs_scene_destroy(std::exchange(scene, nullptr));
    brs_device_destroy(std::exchange(device, nullptr));
    brs_stepper_destroy(std::exchange(stepper, nullptr));
    brs_snapshot_destroy(std::exchange(snapshot, nullptr));
  }
};

inline std::vector<Probe> probes(World& w, Harmless& s, Made& made) {
  return {
      {"brs_context_set_log", "context",
       [&](void* h) {
         return brs_context_set_log(as<brs_context>(h), nullptr, nullptr);
       }},
      {"brs_context_set_threads", "context",
       [&](void* h) {
         return brs_context_set_threads(as<brs_context>(h), 1);
       }},
      {"brs_context_set_progress", "context",
       [&](void* h) {
         return brs_context_set_progress(as<brs_context>(h), nullptr, nullptr);
       }},
      {"brs_context_set_cancel", "context",
       [&](void* h) {
         return brs_context_set_cancel(as<brs_context>(h), 1);
       }},
      {"brs_mesh_create", "context",
       [&](void* h) {
         return brs_mesh_create(as<brs_context>(h), s.numbers, 1, s.indices, 1, s.indices, 1, &made.mesh);
       }},
      {"brs_mesh_create_quadratic", "context",
       [&](void* h) {
         return brs_mesh_create_quadratic(as<brs_context>(h), s.numbers, 1, s.indices, s.indices, 1, 1, s.indices, 1, &made.mesh);
       }},
      {"brs_mesh_quadratic", "mesh",
       [&](void* h) {
         return brs_mesh_quadratic(as<brs_mesh>(h), &made.mesh);
       }},
      {"brs_mesh_describe", "mesh",
       [&](void* h) {
         return brs_mesh_describe(as<brs_mesh>(h), &s.mesh_info);
       }},
      {"brs_mesh_dihedrals", "mesh",
       [&](void* h) {
         return brs_mesh_dihedrals(as<brs_mesh>(h), s.numbers, 1, &s.count);
       }},
      {"brs_mesh_locate", "mesh",
       [&](void* h) {
         return brs_mesh_locate(as<brs_mesh>(h), s.numbers, 1, s.indices, s.numbers);
       }},
      {"brs_mesh_surface", "mesh",
       [&](void* h) {
         return brs_mesh_surface(as<brs_mesh>(h), &s.index_view, &s.count);
       }},
      {"brs_mesh_faces", "mesh",
       [&](void* h) {
         return brs_mesh_faces(as<brs_mesh>(h), 1, s.indices, 1, s.indices, 1, &s.count);
       }},
      {"brs_surface_create", "context",
       [&](void* h) {
         return brs_surface_create(as<brs_context>(h), 1, s.numbers, 1, s.indices, 1, &s.surface_options, &made.surface);
       }},
      {"brs_surface_distance", "surface",
       [&](void* h) {
         return brs_surface_distance(as<brs_surface>(h), s.numbers, 1, s.numbers);
       }},
      {"brs_scene_create", "context",
       [&](void* h) {
         return brs_scene_create(as<brs_context>(h), w.mesh, &made.scene);
       }},
      {"brs_scene_create", "mesh",
       [&](void* h) {
         return brs_scene_create(w.context, as<brs_mesh>(h), &made.scene);
       }},
      {"brs_scene_set_material", "scene",
       [&](void* h) {
         return brs_scene_set_material(as<brs_scene>(h), 1, &s.material);
       }},
      {"brs_scene_set_gravity", "scene",
       [&](void* h) {
         return brs_scene_set_gravity(as<brs_scene>(h), s.numbers);
       }},
      {"brs_scene_set_balanced_reference", "scene",
       [&](void* h) {
         return brs_scene_set_balanced_reference(as<brs_scene>(h), 1);
       }},
      {"brs_scene_set_volume_strain", "scene",
       [&](void* h) {
         return brs_scene_set_volume_strain(as<brs_scene>(h), 1);
       }},
      {"brs_scene_quadratic", "scene",
       [&](void* h) {
         return brs_scene_quadratic(as<brs_scene>(h), &made.scene);
       }},
      {"brs_scene_set_csf", "scene",
       [&](void* h) {
         return brs_scene_set_csf(as<brs_scene>(h), 1, 1, 1);
       }},
      {"brs_scene_add_compartment", "scene",
       [&](void* h) {
         return brs_scene_add_compartment(as<brs_scene>(h), &s.compartment, s.indices);
       }},
      {"brs_scene_add_fixed", "scene",
       [&](void* h) {
         return brs_scene_add_fixed(as<brs_scene>(h), "x", s.indices, 1, 1, s.indices);
       }},
      {"brs_scene_add_tied", "scene",
       [&](void* h) {
         return brs_scene_add_tied(as<brs_scene>(h), "x", s.indices, s.indices, 1, s.indices);
       }},
      {"brs_scene_add_support", "scene",
       [&](void* h) {
         return brs_scene_add_support(as<brs_scene>(h), "x", s.indices, 1, s.numbers, 1, s.indices);
       }},
      {"brs_scene_add_obstacle", "scene",
       [&](void* h) {
         return brs_scene_add_obstacle(as<brs_scene>(h), "x", s.indices, 1, w.surface, 1, s.numbers, 1, s.indices);
       }},
      {"brs_scene_add_obstacle", "surface",
       [&](void* h) {
         return brs_scene_add_obstacle(w.scene, "x", s.indices, 1, as<brs_surface>(h), 1, s.numbers, 1, s.indices);
       }},
      {"brs_scene_add_opposing", "scene",
       [&](void* h) {
         return brs_scene_add_opposing(as<brs_scene>(h), "x", s.indices, s.indices, s.numbers, 1, s.indices);
       }},
      {"brs_scene_set_enabled", "scene",
       [&](void* h) {
         return brs_scene_set_enabled(as<brs_scene>(h), 1, 1);
       }},
      {"brs_scene_remove_constraint", "scene",
       [&](void* h) {
         return brs_scene_remove_constraint(as<brs_scene>(h), 1);
       }},
      {"brs_section_tube", "context",
       [&](void* h) {
         return brs_section_tube(as<brs_context>(h), 1, 1, 1, 1, 1, s.numbers);
       }},
      {"brs_section_rod", "context",
       [&](void* h) {
         return brs_section_rod(as<brs_context>(h), 1, 1, 1, 1, s.numbers);
       }},
      {"brs_device_create", "context",
       [&](void* h) {
         return brs_device_create(as<brs_context>(h), "x", s.numbers, 1, s.numbers, 1, s.numbers, 1, s.numbers, 1, &made.device);
       }},
      {"brs_device_create_named", "context",
       [&](void* h) {
         return brs_device_create_named(as<brs_context>(h), "x", 1, &s.device_options, &made.device);
       }},
      {"brs_device_table", "context",
       [&](void* h) {
         return brs_device_table(as<brs_context>(h), 1, &s.device_entry);
       }},
      {"brs_device_describe", "device",
       [&](void* h) {
         return brs_device_describe(as<brs_device>(h), &s.device_info);
       }},
      {"brs_stepper_options_within", "mesh",
       [&](void* h) {
         return brs_stepper_options_within(as<brs_mesh>(h), 1, &s.stepper_options);
       }},
      {"brs_stepper_create", "scene",
       [&](void* h) {
         return brs_stepper_create(as<brs_scene>(h), &s.stepper_options, &made.stepper);
       }},
      {"brs_stepper_mesh", "stepper",
       [&](void* h) {
         return brs_stepper_mesh(as<brs_stepper>(h), &made.mesh);
       }},
      {"brs_stepper_set_gravity", "stepper",
       [&](void* h) {
         return brs_stepper_set_gravity(as<brs_stepper>(h), s.numbers);
       }},
      {"brs_stepper_set_enabled", "stepper",
       [&](void* h) {
         return brs_stepper_set_enabled(as<brs_stepper>(h), 1, 1);
       }},
      {"brs_stepper_set_csf", "stepper",
       [&](void* h) {
         return brs_stepper_set_csf(as<brs_stepper>(h), 1, 1, 1);
       }},
      {"brs_stepper_set_damping", "stepper",
       [&](void* h) {
         return brs_stepper_set_damping(as<brs_stepper>(h), 1, 1);
       }},
      {"brs_stepper_check_settings", "stepper",
       [&](void* h) {
         return brs_stepper_check_settings(as<brs_stepper>(h));
       }},
      {"brs_stepper_insert", "stepper",
       [&](void* h) {
         return brs_stepper_insert(as<brs_stepper>(h), w.device, s.numbers, s.numbers, &s.hold, &s.track_options, s.indices);
       }},
      {"brs_stepper_insert", "device",
       [&](void* h) {
         return brs_stepper_insert(w.stepper, as<brs_device>(h), s.numbers, s.numbers, &s.hold, &s.track_options, s.indices);
       }},
      {"brs_stepper_exchange", "stepper",
       [&](void* h) {
         return brs_stepper_exchange(as<brs_stepper>(h), 1, w.device, &s.hold, 1);
       }},
      {"brs_stepper_exchange", "device",
       [&](void* h) {
         return brs_stepper_exchange(w.stepper, 1, as<brs_device>(h), &s.hold, 1);
       }},
      {"brs_stepper_set_hold", "stepper",
       [&](void* h) {
         return brs_stepper_set_hold(as<brs_stepper>(h), 1, &s.hold);
       }},
      {"brs_stepper_set_friction", "stepper",
       [&](void* h) {
         return brs_stepper_set_friction(as<brs_stepper>(h), 1, 1, 1);
       }},
      {"brs_stepper_remove_device", "stepper",
       [&](void* h) {
         return brs_stepper_remove_device(as<brs_stepper>(h), 1);
       }},
      {"brs_stepper_memory_estimate", "stepper",
       [&](void* h) {
         return brs_stepper_memory_estimate(as<brs_stepper>(h), &s.memory_estimate);
       }},
      {"brs_stepper_solve_static", "stepper",
       [&](void* h) {
         return brs_stepper_solve_static(as<brs_stepper>(h), &s.solve_report);
       }},
      {"brs_stepper_step", "stepper",
       [&](void* h) {
         return brs_stepper_step(as<brs_stepper>(h), 1, &s.solve_report);
       }},
      {"brs_stepper_set_velocity", "stepper",
       [&](void* h) {
         return brs_stepper_set_velocity(as<brs_stepper>(h), s.numbers, 1);
       }},
      {"brs_stepper_begin_static", "stepper",
       [&](void* h) {
         return brs_stepper_begin_static(as<brs_stepper>(h));
       }},
      {"brs_stepper_begin_step", "stepper",
       [&](void* h) {
         return brs_stepper_begin_step(as<brs_stepper>(h), 1);
       }},
      {"brs_stepper_linearise", "stepper",
       [&](void* h) {
         return brs_stepper_linearise(as<brs_stepper>(h));
       }},
      {"brs_stepper_solve", "stepper",
       [&](void* h) {
         return brs_stepper_solve(as<brs_stepper>(h));
       }},
      {"brs_stepper_update", "stepper",
       [&](void* h) {
         return brs_stepper_update(as<brs_stepper>(h), s.indices);
       }},
      {"brs_stepper_accept", "stepper",
       [&](void* h) {
         return brs_stepper_accept(as<brs_stepper>(h), &s.solve_report);
       }},
      {"brs_stepper_reject", "stepper",
       [&](void* h) {
         return brs_stepper_reject(as<brs_stepper>(h));
       }},
      {"brs_stepper_phase", "stepper",
       [&](void* h) {
         return brs_stepper_phase(as<brs_stepper>(h), s.indices);
       }},
      {"brs_stepper_progress_report", "stepper",
       [&](void* h) {
         return brs_stepper_progress_report(as<brs_stepper>(h), &s.solve_report);
       }},
      {"brs_stepper_field", "stepper",
       [&](void* h) {
         return brs_stepper_field(as<brs_stepper>(h), 1, &s.view, &s.count, &s.count);
       }},
      {"brs_stepper_displacement_at", "stepper",
       [&](void* h) {
         return brs_stepper_displacement_at(as<brs_stepper>(h), s.numbers, 1, s.numbers, s.indices);
       }},
      {"brs_stepper_rest_points_of", "stepper",
       [&](void* h) {
         return brs_stepper_rest_points_of(as<brs_stepper>(h), s.numbers, 1, s.numbers, s.indices);
       }},
      {"brs_stepper_estimate_error", "stepper",
       [&](void* h) {
         return brs_stepper_estimate_error(as<brs_stepper>(h), s.numbers, 1, s.numbers, s.numbers);
       }},
      {"brs_stepper_compartment", "stepper",
       [&](void* h) {
         return brs_stepper_compartment(as<brs_stepper>(h), 1, &s.compartment_state);
       }},
      {"brs_stepper_contact", "stepper",
       [&](void* h) {
         return brs_stepper_contact(as<brs_stepper>(h), 1, &s.contact_state);
       }},
      {"brs_stepper_device", "stepper",
       [&](void* h) {
         return brs_stepper_device(as<brs_stepper>(h), 1, &s.device_state);
       }},
      {"brs_stepper_device_model", "stepper",
       [&](void* h) {
         return brs_stepper_device_model(as<brs_stepper>(h), 1, &made.device);
       }},
      {"brs_stepper_snapshot", "stepper",
       [&](void* h) {
         return brs_stepper_snapshot(as<brs_stepper>(h), &made.snapshot);
       }},
      {"brs_stepper_restore", "stepper",
       [&](void* h) {
         return brs_stepper_restore(as<brs_stepper>(h), w.snapshot);
       }},
      {"brs_stepper_restore", "snapshot",
       [&](void* h) {
         return brs_stepper_restore(w.stepper, as<brs_snapshot>(h));
       }},
      {"brs_snapshot_bytes", "snapshot",
       [&](void* h) {
         return brs_snapshot_bytes(as<brs_snapshot>(h), s.bytes, 1, &s.count);
       }},
      {"brs_stepper_read_snapshot", "stepper",
       [&](void* h) {
         return brs_stepper_read_snapshot(as<brs_stepper>(h), s.bytes, 1, &made.snapshot);
       }},
      {"brs_stepper_record", "stepper",
       [&](void* h) {
         return brs_stepper_record(as<brs_stepper>(h), s.bytes, 1, &s.count);
       }},
      {"brs_stepper_replay", "context",
       [&](void* h) {
         return brs_stepper_replay(as<brs_context>(h), s.bytes, 1, &made.stepper);
       }},
      {"brs_mcp_solve", "context",
       [&](void* h) {
         return brs_mcp_solve(as<brs_context>(h), s.numbers, s.numbers, s.numbers, s.numbers, 1, &s.mcp_options, s.numbers, s.numbers, s.indices, &s.mcp_report);
       }},
  };
}

// Apart: NULL is good to destroy.
inline std::vector<Probe> probes_of_destroy() {
  return {
      {"brs_context_destroy", "context",
       [&](void* h) {
         return brs_context_destroy(as<brs_context>(h));
       }},
      {"brs_mesh_destroy", "mesh",
       [&](void* h) {
         return brs_mesh_destroy(as<brs_mesh>(h));
       }},
      {"brs_surface_destroy", "surface",
       [&](void* h) {
         return brs_surface_destroy(as<brs_surface>(h));
       }},
      {"brs_scene_destroy", "scene",
       [&](void* h) {
         return brs_scene_destroy(as<brs_scene>(h));
       }},
      {"brs_device_destroy", "device",
       [&](void* h) {
         return brs_device_destroy(as<brs_device>(h));
       }},
      {"brs_stepper_destroy", "stepper",
       [&](void* h) {
         return brs_stepper_destroy(as<brs_stepper>(h));
       }},
      {"brs_snapshot_destroy", "snapshot",
       [&](void* h) {
         return brs_snapshot_destroy(as<brs_snapshot>(h));
       }},
  };
}

}  // namespace brainshift::test
