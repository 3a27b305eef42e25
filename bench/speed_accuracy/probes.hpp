// Points whose motion is compared: where a surgeon looks, and where the brain moves most.
#pragma once

#include <string>
#include <vector>

#include "head.hpp"

namespace bench {

struct Probe {
  std::string name, kind;   // kind: STN, track, midline, cortex
  dbs::Vec3 point;          // mm, RAS, in the mesh as given
};

// The same for every mesh of one geometry. Points on the surface stand at nodes of the head's own mesh,
// which its refinement and its quadratic tets keep.
std::vector<Probe> probes(const dbs::Head& head);

dbs::Points points_of(const std::vector<Probe>& probes);

}  // namespace bench
