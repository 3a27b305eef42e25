// The block of block.h as a Scene: made of brain, held at its base, in fluid.
#pragma once

#include <algorithm>
#include <numeric>

#include "block.h"
#include "brainshift/brainshift.hpp"

inline brainshift::Scene block_scene() {
  using namespace brainshift;
  Points nodes(NODES, 3);
  Tets tets(TETS, 4);
  make_block(nodes.data(), tets.data());
  MeshOptions either_way_round;
  either_way_round.orient = true;
  const Mesh mesh(nodes, tets, {}, either_way_round);

  Indices base(BASE_NODES);
  std::iota(base.begin(), base.end(), 0);
  Scene scene{mesh, {{0, Material(Law::stable_neo_hookean, 6.0, 0.45, 1.04e-6)}}};
  scene.constraints.fix("base", base);

  Compartment box{"box", Eigen::Map<const Points>(block_wall, 8, 3),
                  Eigen::Map<const Triangles>(block_wall_triangles, 12, 3),
                  mesh.faces_of_region(0), {}};
  const Indices dry = mesh.faces_within(base);   // fluid wets all but the base
  for (Index face : box.body_faces) {
    if (std::find(dry.begin(), dry.end(), face) == dry.end()) box.wetted_faces.push_back(face);
  }
  scene.csf.emplace(1.0e-6, FluidModel::separate, std::vector<Compartment>{box});
  return scene;
}
