// What the C++ lines of the README take for given: arrays of the host, here those of examples/block.h.
#pragma once

#include <cstdio>
#include <limits>
#include <numeric>
#include <string>

#include "block.hpp"

namespace frame {

using namespace brainshift;

inline const Scene block = block_scene();
inline const Compartment right = block.csf->compartment(0);
inline const Points nodes = block.mesh.nodes();
inline const Tets tets = block.mesh.tets();
inline const Indices regions(std::size_t(tets.rows()), 1);
inline const Points wall_points = right.wall_points;
inline const Triangles wall_triangles = right.wall_triangles;

inline Indices numbers(Index from, Index to) {
  Indices some(std::size_t(to - from));
  std::iota(some.begin(), some.end(), from);
  return some;
}
inline const Indices stem_nodes = numbers(0, BASE_NODES);
inline const Indices surface_nodes = numbers(NODES - BASE_NODES, NODES);   // the upper face

inline const Vec3 tip(22.0, 33.0, 21.0), outward(0.0, 0.0, 1.0);   // mm
inline const Points targets = tip.transpose();
constexpr double length = 45.0;   // mm
constexpr double infinity = std::numeric_limits<double>::infinity();

inline int fail(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  return 1;
}

}  // namespace frame
