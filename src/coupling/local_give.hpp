// What a mesh too coarse for a thin device leaves out of the tissue's give across it.
//
// A force spread along a line in tets of size h moves the line as a rod of the radius a h would be moved
// (plane strain, far edges held). A rod of the device's radius r < a h moves further, by
//   kappa ln(a h / r) / (8 pi mu (1 - nu)) per force and length,   kappa = 3 - 4 nu,
// the difference of two annuli with one outer edge; docs/theory.md (25). The factor a depends on the element:
// with it the stiffness in tests/coupling/lateral_stiffness_test.cpp is that of the annulus.
#pragma once

#include <vector>

#include "coupling/track.hpp"
#include "tissue/tissue.hpp"

namespace brainshift {

// Sets `give` of each path point for a device of the radius (mm) that lies there.
void set_local_give(const Tissue& tissue, double radius, std::vector<PathPoint>& path);

}  // namespace brainshift
