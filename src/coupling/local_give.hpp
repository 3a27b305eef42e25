// Ties of a device thinner than the tets around it: over what they spread, and how they give way.
//
// The force of ties at single points is felt as that of a rod as thick as the tets are wide, by up to a
// quarter more or less with the place of the points in their tets. Each tie therefore takes the mean over a
// ring of points across the device, about as wide as the tets: what tets do with a force so spread
// hardly depends on their shapes. It moves the line as a rod of the acting radius a would be moved (plane strain,
// far edges held); a device of the radius r < a moves further, by
//   kappa ln(a / r) / (8 pi mu (1 - nu)) per force and length,   kappa = 3 - 4 nu,
// the difference of two annuli with one outer edge; docs/theory.md (25).
#pragma once

#include <vector>

#include "coupling/track.hpp"
#include "tissue/tissue.hpp"

namespace brainshift {

// Gives the points of a straight track their rings, where the nodes are now, for a device of the radius
// (mm). Near the surface rings are smaller; points that have one keep it.
void spread_ties(const Tissue& tissue, const Points& positions, const Vec3& outward, double radius,
                 std::vector<PathPoint>& path);

// Sets `give` of each path point for a device of the radius (mm) that lies there.
void set_local_give(const Tissue& tissue, double radius, std::vector<PathPoint>& path);

}  // namespace brainshift
