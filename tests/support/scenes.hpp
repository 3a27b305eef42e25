// Scenes for tests: meshes put together from shapes, nodes picked by where they are, CSF around them.
#pragma once

#include <cstring>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "brainshift/stepper.hpp"
#include "support/shapes.hpp"

namespace brainshift::test {

constexpr double tissue_density = 1.04e-6;  // kg/mm^3
constexpr double fluid_density = 1.0e-6;    // kg/mm^3

inline Mesh make_mesh(const TetShape& shape, Indices regions = {}) {
  return Mesh(shape.points, shape.tets, std::move(regions));
}

template <class Shape>
Shape moved(Shape shape, const Vec3& by) {
  shape.points.rowwise() += by.transpose();
  return shape;
}

// Two bodies in one mesh; those of b keep their order after those of a.
inline TetShape joined(const TetShape& a, const TetShape& b) {
  TetShape both{Points(a.points.rows() + b.points.rows(), 3),
                Tets(a.tets.rows() + b.tets.rows(), 4)};
  both.points << a.points, b.points;
  both.tets << a.tets, (b.tets.array() + Index(a.points.rows())).matrix();
  return both;
}

inline SurfaceShape box_wall(const Vec3& low, const Vec3& high) {
  return moved(make_box_surface(high - low), low);
}

template <class Condition>
Indices nodes_where(const Mesh& mesh, Condition&& condition) {
  Indices found;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    if (condition(Vec3(mesh.nodes().row(i).transpose()))) found.push_back(i);
  }
  return found;
}

inline Indices all_nodes(const Mesh& mesh) {
  return nodes_where(mesh, [](const Vec3&) { return true; });
}

inline Indices surface_nodes(const Mesh& mesh) {
  std::vector<bool> outside(std::size_t(mesh.node_count()), false);
  for (Eigen::Index f = 0; f < mesh.surface().rows(); ++f) {
    for (int k = 0; k < 3; ++k) outside[std::size_t(mesh.surface()(f, k))] = true;
    for (int k = 0; k < 3 && mesh.is_quadratic(); ++k) {
      outside[std::size_t(mesh.surface_edge_nodes()(f, k))] = true;
    }
  }
  Indices found;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    if (outside[std::size_t(i)]) found.push_back(i);
  }
  return found;
}

inline Indices all_faces(const Mesh& mesh) {
  Indices faces;
  for (Index f = 0; f < Index(mesh.surface().rows()); ++f) faces.push_back(f);
  return faces;
}

// A compartment whose fluid wets `faces` of the mesh, which bound the tissue in it.
inline Compartment make_compartment(std::string name, const SurfaceShape& wall, Indices faces) {
  return {std::move(name), wall.points, wall.triangles, faces, faces};
}

inline bool same_bits(const Points& a, const Points& b) {
  return a.rows() == b.rows() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * std::size_t(a.size())) == 0;
}

// Largest distance between rows.
inline double largest_distance(const Points& a, const Points& b) {
  return (a - b).rowwise().norm().maxCoeff();
}

inline Vec3 mean_row(const Points& values, const Indices& rows) {
  Vec3 sum = Vec3::Zero();
  for (Index i : rows) sum += values.row(i).transpose();
  return sum / double(rows.size());
}

// A soft block in fluid on elastic feet, in a narrow case: contact, levels, supports, every kind of
// force at once. cells: per edge of 30 mm; feet: mN/mm per node.
inline Scene busy_scene(int cells, double feet, const SurfaceOptions& options = {}) {
  const Mesh mesh = make_mesh(make_box({30, 30, 30}, cells, cells, cells));
  Scene scene{mesh,
              {{0, Material(Law::corotational, 6.0, 0.45, tissue_density)}},
              Vec3(0, 0, -standard_gravity),
              Csf(fluid_density, FluidModel::separate,
                  {make_compartment("all", box_wall({-3, -3, -3}, {33, 33, 34}), all_faces(mesh))}),
              {}};
  const auto wall = box_wall({-0.5, -0.5, -0.2}, {30.5, 30.5, 30.5});
  scene.constraints.obstacle("skull", surface_nodes(mesh),
                             Surface::cavity(wall.points, wall.triangles, options));
  scene.constraints.support("stem",
                            nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; }),
                            Eigen::VectorXd::Constant(1, feet));
  return scene;
}

// Nodes of two bodies of `count` nodes each that lie on each other, in pairs.
inline std::pair<Indices, Indices> seam(const Mesh& mesh, Index count) {
  std::pair<Indices, Indices> pairs;
  for (Index i = 0; i < count; ++i) {
    for (Index j = count; j < 2 * count; ++j) {
      if ((mesh.nodes().row(i) - mesh.nodes().row(j)).norm() > 1e-12) continue;
      pairs.first.push_back(i);
      pairs.second.push_back(j);
    }
  }
  return pairs;
}

}  // namespace brainshift::test
