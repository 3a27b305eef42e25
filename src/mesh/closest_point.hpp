// The point of a triangle nearest to a given point, by Voronoi regions: Ericson, Real-Time
// Collision Detection (2005), section 5.1.5.
#pragma once

#include "brainshift/types.hpp"

namespace brainshift {

// Part of a triangle a b c: its corners, its edges ab, bc, ca, its inside.
enum class Feature { a, b, c, ab, bc, ca, inside };

struct TrianglePoint {
  Vec3 weights;  // barycentric
  Feature feature;
};

inline TrianglePoint closest_point(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {Vec3(1, 0, 0), Feature::a};

  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {Vec3(0, 1, 0), Feature::b};

  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double t = d1 / (d1 - d3);
    return {Vec3(1.0 - t, t, 0), Feature::ab};
  }

  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {Vec3(0, 0, 1), Feature::c};

  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double t = d2 / (d2 - d6);
    return {Vec3(1.0 - t, 0, t), Feature::ca};
  }

  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {Vec3(0, 1.0 - t, t), Feature::bc};
  }

  const double sum = va + vb + vc;
  return {Vec3(va, vb, vc) / sum, Feature::inside};
}

}  // namespace brainshift
