// The scene of world.hpp in C++, and how numbers of both are compared: bit for bit.
#pragma once

#include <algorithm>
#include <cstring>

#include "brainshift/brainshift.hpp"
#include "world.hpp"

namespace brainshift::test {

inline Scene cpp_scene() {
  const TetShape block = block_shape();
  const SurfaceShape wall = wall_shape();
  const Mesh mesh(block.points, block.tets);
  Scene scene{mesh, {{0, Material(Law::stable_neo_hookean, 3.0, 0.45, 1.04e-6)}}};
  Compartment box{"box", wall.points, wall.triangles, mesh.faces_of_region(0), {}};
  const Indices dry = mesh.faces_within(base_nodes());
  for (Index face : box.body_faces)
    if (std::find(dry.begin(), dry.end(), face) == dry.end()) box.wetted_faces.push_back(face);
  scene.csf = Csf(1e-6, FluidModel::separate, {box});
  scene.constraints.fix("base", base_nodes());
  scene.constraints.obstacle("sides", side_nodes(), Surface::cavity(wall.points, wall.triangles));
  return scene;
}

template <class Matrix>
void expect_same_bits(const Matrix& expected, const typename Matrix::Scalar* found) {
  if (expected.size() == 0) return;   // memcmp takes no null, of any length
  ASSERT_TRUE(found);
  EXPECT_EQ(std::memcmp(expected.data(), found, std::size_t(expected.size()) * sizeof *found), 0);
}

}  // namespace brainshift::test
