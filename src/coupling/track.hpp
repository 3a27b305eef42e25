// The material points of tissue that lie on a straight line through the deformed mesh.
#pragma once

#include <vector>

#include "brainshift/mesh.hpp"

namespace brainshift {

// A material point of tissue.
struct TetPoint {
  Index tet;
  Eigen::Vector4d weights;  // barycentric (natural, if quadratic)
};

struct PathPoint {
  Index tet;
  Eigen::Vector4d weights;  // as of a TetPoint; a point on a face between two tets has one zero
  double arc;               // mm from the tip when it was found
  double length;            // mm of the track it stands for
  double give = 0.0;        // mm/mN; of its ties, see local_give.hpp
  std::vector<TetPoint> ring;  // its ties take the mean of these points around it; none: the point alone
  double spread = 0.0;         // mm; radius of the ring
};

// Calls at(tet, weights, share) for the material points whose mean is where the ties of a path point take
// hold; the shares add up to 1.
template <class At>
void for_each_tie_point(const PathPoint& point, const At& at) {
  if (point.ring.empty()) return at(point.tet, point.weights, 1.0);
  for (const TetPoint& p : point.ring) at(p.tet, p.weights, 1.0 / double(point.ring.size()));
}

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
