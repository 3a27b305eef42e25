// A head with every tet cut into eight: the same geometry, half the edge.
#pragma once

#include "head.hpp"
#include "scene.hpp"

namespace dbs {

Head refined(const Head& head);

// Nodes in the middle of edges may stand in the skull by the curvature of a chord: they touch there.
void let_touch(Scene& scene, ConstraintId skull);

}  // namespace dbs
