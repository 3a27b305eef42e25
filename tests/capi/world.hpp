// A small scene through the C face: a block in fluid in a box, between the walls of a cavity.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "brainshift/c/brainshift.h"
#include "support/shapes.hpp"

namespace brainshift::test {

constexpr int cells = 3;
constexpr double edge = 30.0, gap = 0.2, top = 40.0;  // mm

inline TetShape block_shape() { return make_box(Vec3::Constant(edge), cells, cells, cells); }

// The block touches its sides after a little bulging.
inline SurfaceShape wall_shape() {
  SurfaceShape wall = make_box_surface({edge + 2 * gap, edge + 2 * gap, top});
  wall.points.rowwise() -= Eigen::RowVector3d(gap, gap, 0.0);
  return wall;
}

inline Indices base_nodes() {
  Indices base;
  for (Index i = 0; i < (cells + 1) * (cells + 1); ++i) base.push_back(i);
  return base;
}

inline Indices side_nodes() {
  Indices sides;
  for (Index k = 1; k < cells; ++k)
    for (Index j = 0; j <= cells; ++j)
      for (Index i : {0, cells}) sides.push_back(box_node(cells, cells, i, j, k));
  return sides;
}

inline brs_material tissue() {
  brs_material material;
  brs_material_init(&material, sizeof material);
  material.law = "stable_neo_hookean";
  material.young = 3.0;
  material.poisson = 0.45;
  material.density = 1.04e-6;
  return material;
}

// Handles of every type in one context, made by plain calls; destroyed with it.
class World {
 public:
  World() {
    good(brs_context_create(BRS_VERSION, &context));
    good(brs_mesh_create(context, block.points.data(), block.points.rows(), block.tets.data(),
                         block.tets.rows(), nullptr, 0, &mesh));
    good(brs_surface_create(context, BRS_SURFACE_CAVITY, wall.points.data(), wall.points.rows(),
                            wall.triangles.data(), wall.triangles.rows(), nullptr, &surface));
    make_scene();
    good(brs_stepper_create(scene, nullptr, &stepper));
    good(brs_stepper_snapshot(stepper, &snapshot));
    good(brs_device_create_named(context, "3389", 20.0, nullptr, &device));
  }

  ~World() {
    brs_context_destroy(context);
    brs_mesh_destroy(mesh);
    brs_surface_destroy(surface);
    brs_scene_destroy(scene);
    brs_device_destroy(device);
    brs_stepper_destroy(stepper);
    brs_snapshot_destroy(snapshot);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  std::string message() const { return brs_context_message(context); }

  void good(brs_status status) const {
    ASSERT_EQ(status, BRS_OK) << brs_status_name(status) << ": " << message();
  }

  // Lets fluid out, mm^3; returns the status of the solve.
  brs_status solve_after_loss(double lost, brs_solve_report* report = nullptr) const {
    good(brs_stepper_set_csf(stepper, 0, BRS_CSF_LOST_VOLUME, lost));
    return brs_stepper_solve_static(stepper, report);
  }

  std::vector<double> field(std::int32_t number) const {
    const double* values = nullptr;
    std::int64_t rows = 0, columns = 0;
    good(brs_stepper_field(stepper, number, &values, &rows, &columns));
    return {values, values + rows * columns};
  }

  TetShape block = block_shape();
  SurfaceShape wall = wall_shape();
  Indices base = base_nodes(), sides = side_nodes(), body, wet;
  brs_context* context = nullptr;
  brs_mesh* mesh = nullptr;
  brs_surface* surface = nullptr;
  brs_scene* scene = nullptr;
  brs_device* device = nullptr;
  brs_stepper* stepper = nullptr;
  brs_snapshot* snapshot = nullptr;
  std::int32_t contact = -1;

  brs_compartment compartment() {
    brs_compartment box;
    brs_compartment_init(&box, sizeof box);
    box.name = "box";
    box.wall_points = wall.points.data();
    box.wall_point_count = wall.points.rows();
    box.wall_triangles = wall.triangles.data();
    box.wall_triangle_count = wall.triangles.rows();
    box.body_faces = body.data();
    box.body_face_count = std::int64_t(body.size());
    box.wetted_faces = wet.data();
    box.wetted_face_count = std::int64_t(wet.size());
    return box;
  }

 private:
  Indices faces(const Indices& dry) const {
    std::int64_t count = 0;
    good(brs_mesh_faces(mesh, 0, dry.data(), std::int64_t(dry.size()), nullptr, 0, &count));
    Indices rows(std::size_t(count), -1);
    good(brs_mesh_faces(mesh, 0, dry.data(), std::int64_t(dry.size()), rows.data(), count, &count));
    return rows;
  }

  void make_scene() {
    const brs_material material = tissue();
    body = faces({});
    wet = faces(base);
    const brs_compartment box = compartment();
    good(brs_scene_create(context, mesh, &scene));
    good(brs_scene_set_material(scene, 0, &material));
    good(brs_scene_set_csf(scene, 1e-6, BRS_CSF_SEPARATE, NAN));
    good(brs_scene_add_compartment(scene, &box, nullptr));
    good(brs_scene_add_fixed(scene, "base", base.data(), std::int64_t(base.size()), BRS_AXES,
                             nullptr));
    good(brs_scene_add_obstacle(scene, "sides", sides.data(), std::int64_t(sides.size()), surface,
                                1, nullptr, 0, &contact));
  }
};

}  // namespace brainshift::test
