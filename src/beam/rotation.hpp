// Rotations of nodes: exponential map, frames along a polyline.
#pragma once

#include <vector>

#include "brainshift/types.hpp"

namespace brainshift {

// [v]x, so that skew(v) * w = v x w.
Mat3 skew(const Vec3& v);

// Rotation by the angle |v| about v; any angle, also none.
Mat3 rotation_exp(const Vec3& v);

// R with the rounding of many products taken out (one step towards the polar factor).
Mat3 orthonormalised(const Mat3& R);

// The smallest rotation that takes the unit vector `from` to the unit vector `to`.
Mat3 smallest_rotation(const Vec3& from, const Vec3& to);

// A right-handed frame whose first column is `direction` (unit); the second is seeded by the
// coordinate axis that is least aligned with it, so that no direction is special.
Mat3 any_frame(const Vec3& direction);

// Unit tangents at the nodes of a polyline: of the parabola through three neighbours inside, the
// mirror image of the neighbour's at the ends. Exact for equal chords of a circle.
std::vector<Vec3> polyline_tangents(const Points& nodes);

// Frames with the given first columns, carried along without twist.
std::vector<Mat3> transported_frames(const std::vector<Vec3>& tangents, const Mat3& first);

}  // namespace brainshift
