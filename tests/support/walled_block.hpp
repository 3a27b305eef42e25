// A block of tissue that leans, nodes of it kept within walls that some of them reach, with leads side by
// side: as many tets, contact candidates and coupling rows as are asked for.
#pragma once

#include <algorithm>
#include <string>

#include "brainshift/brainshift.hpp"
#include "support/scenes.hpp"

namespace brainshift::test {

constexpr double walled_side = 60.0;   // mm

// `cells` along each edge, six tets each; held at its base, under a tilted gravity. It has an equilibrium
// without the walls, which are `room` mm away at first. Candidates: from its top downwards.
inline Scene walled_block(Index cells, Index candidates, double room = 5.0) {
  const double side = walled_side;
  Scene scene{make_mesh(make_box({side, side, side}, cells, cells, cells)),
              {{0, Material(Law::corotational, 6.0, 0.45, tissue_density)}}};
  scene.balanced_reference = false;
  scene.gravity = standard_gravity * Vec3(0.6, 0.0, -0.8);
  scene.constraints.fix("base", nodes_where(scene.mesh, [](const Vec3& x) { return x.z() == 0.0; }));
  const auto wall = box_wall(Vec3::Constant(-room), Vec3::Constant(side + room));
  const Surface cavity = Surface::cavity(wall.points, wall.triangles);
  Indices nodes = nodes_where(scene.mesh, [](const Vec3& x) { return x.z() > 0.0; });
  std::reverse(nodes.begin(), nodes.end());
  for (int group = 0; candidates > 0; ++group) {   // more candidates than nodes: several walls
    nodes.resize(std::min(nodes.size(), std::size_t(candidates)));
    scene.constraints.obstacle("wall " + std::to_string(group), nodes, cavity);
    candidates -= Index(nodes.size());
  }
  return scene;
}

// Leads from above, `depth` mm into the block as it is made, their wires held above it. Oblique to the mesh.
inline void insert_leads(Stepper& stepper, int count, double depth) {
  const Vec3 outward = Vec3(0.1, 0.05, 1.0).normalized();
  constexpr double outside = 10.0;
  const BeamDevice lead = make_device("3389", depth + outside);
  Hold wire;
  wire.anchor = depth + outside;
  for (int i = 0; i < count; ++i) {
    const Vec3 entry(12.3 + 9.1 * (i % 4), 14.7 + 9.3 * (i / 4), walled_side);   // mm
    stepper.insert(lead, {entry - depth * outward, outward}, wire);
  }
}

}  // namespace brainshift::test
