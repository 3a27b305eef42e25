// The material points of tissue that lie on a straight line through the deformed mesh.
#pragma once

#include <vector>

#include "brainshift/mesh.hpp"

namespace brainshift {

struct PathPoint {
  Index tet;
  Eigen::Vector4d weights;  // barycentric (natural, if quadratic); a point on a face between two tets has one zero
  double arc;               // mm from the tip when it was found
  double length;            // mm of the track it stands for
  double give = 0.0;        // mm/mN; of its ties, see local_give.hpp
};

// Crossings of the segment from `tip` along `outward` (unit) with faces of the deformed tets, from
// the tip outwards: between two tets each point lies on the face they share, so no tet holds more
// than two of them. Points closer than `least_spacing` to the one before are left out. Throws
// Error(invalid_argument) when the tip is not in tissue or the line leaves it and enters again.
std::vector<PathPoint> cut_track(const Mesh& mesh, const Points& positions, const Vec3& tip,
                                 const Vec3& outward, double length, double least_spacing);

// The track of a device that goes `advance` deeper, to `tip`: what it crosses now, then `path`.
std::vector<PathPoint> extend_track(const Mesh& mesh, const Points& positions, const Vec3& tip,
                                    const Vec3& outward, double advance, double least_spacing,
                                    const std::vector<PathPoint>& path);

}  // namespace brainshift
