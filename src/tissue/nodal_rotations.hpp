// How far the tissue around each node has turned.
#pragma once

#include <vector>

#include "brainshift/mesh.hpp"

namespace brainshift {

// Per node the rotation next to the mean of F over its tets, weighted by volume, of quadratic tets that
// of their corners.
std::vector<Mat3> nodal_rotations(const Mesh& mesh, const Points& u);

}  // namespace brainshift
