// The curve of a beam: on each element the cubic through its end nodes along their d1 (exactly
// tangent when the section has no shear), parameter xi in [0, 1]; rest arc length is linear in it.
#pragma once

#include "beam/beam.hpp"

namespace brainshift {

using Mat3x12 = Eigen::Matrix<double, 3, 12>;

struct BeamPoint {
  Index element;
  double xi;  // 0 at the end nearer to the tip
};

// Place of a rest arc length (clamped to the device), and back.
BeamPoint place_at(const Beam& beam, double arc);
double arc_of(const Beam& beam, const BeamPoint& place);

Vec3 position(const Beam& beam, const BeamState& state, const BeamPoint& place);
Vec3 unit_tangent(const Beam& beam, const BeamState& state, const BeamPoint& place);
// Derivatives with respect to the 12 dofs of the element (nodes `element` and `element + 1`).
Mat3x12 position_derivative(const Beam& beam, const BeamState& state, const BeamPoint& place);
Mat3x12 unit_tangent_derivative(const Beam& beam, const BeamState& state, const BeamPoint& place);
// Second derivatives of force . position at a place that stays (12 x 12), rotations as exp(w) R.
Mat12 position_hessian(const Beam& beam, const BeamState& state, const BeamPoint& place,
                       const Vec3& force);
// Derivative of the unit tangent by the length of the curve, 1/mm.
Vec3 curvature(const Beam& beam, const BeamState& state, const BeamPoint& place);

// Length of the deformed curve between two rest arc lengths, mm.
double curve_length(const Beam& beam, const BeamState& state, double from, double to);

enum class CurveEnd { none, tip, wire };

struct ClosestBeamPoint {
  BeamPoint place;
  Vec3 position;
  double distance;  // mm
  CurveEnd beyond;  // the point lies beyond this end of the device: the place is clamped to it
};
// Closest point of the curve; of several equally close ones the first from the tip.
ClosestBeamPoint closest_point(const Beam& beam, const BeamState& state, const Vec3& point);

// How far the curve between two rest arc lengths leaves its chord.
struct Bow {
  double size;     // mm
  double arc;      // rest arc length of the farthest point
  Vec3 direction;  // unit, from the chord to it; zero when there is no bow
};
Bow bow(const Beam& beam, const BeamState& state, double from, double to);

}  // namespace brainshift
