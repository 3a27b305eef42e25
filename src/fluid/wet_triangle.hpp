// Moments of the shape functions over the wet part of a triangle, and of what follows from them.
//
// A triangle is cut by the waterline where height = head. Over its wet part, in parent coordinates
// (area 1/2): L_i = int N_i, M_ij = int N_i N_j, exactly. Both are continuous in head and heights,
// and with p = w (head - height), w = density |g|, the consistent nodal force is
//   f_i = -a int p N_i = -a w (head L_i - sum_j M_ij z_j),   a = (x1-x0) x (x2-x0)
// (docs/theory.md (5)).
// The waterline itself adds nothing to the derivative of f, since p = 0 there.
#pragma once

#include "brainshift/types.hpp"

namespace brainshift {

struct WetMoments {
  Vec3 L = Vec3::Zero();
  Mat3 M = Mat3::Zero();
  // int (head - height) N_i over the wet part.
  Vec3 depth(const Vec3& heights, double head) const { return head * L - M * heights; }
  bool dry() const { return L.isZero(0.0); }
};

// The wet part of a triangle: its corners in barycentric coordinates, none where it is dry.
struct WetPolygon {
  Vec3 corners[4];
  int count = 0;
};
WetPolygon wet_polygon(const Vec3& depth, bool clip);

// clip: only where height < head; otherwise the whole triangle is wet whatever its height.
WetMoments wet_moments(const Vec3& heights, double head, bool clip);

// d a / d x_k as a matrix acting on the motion of corner k.
Mat3 area_derivative(const Vec3& x0, const Vec3& x1, const Vec3& x2, int k);

}  // namespace brainshift
