#include "beam/centreline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "beam/rotation.hpp"

namespace brainshift {
namespace {

// Factors of xa, L d1a, xb, L d1b in a point of the cubic, or in a derivative by xi.
struct Weights {
  double xa, da, xb, db;
};

Weights weights(double t) {
  return {(1 + 2 * t) * (1 - t) * (1 - t), t * (1 - t) * (1 - t), t * t * (3 - 2 * t),
          t * t * (t - 1)};
}

Weights first_derivative(double t) {
  return {6 * t * (t - 1), (1 - t) * (1 - 3 * t), 6 * t * (1 - t), t * (3 * t - 2)};
}

Weights second_derivative(double t) { return {12 * t - 6, 6 * t - 4, 6 - 12 * t, 6 * t - 2}; }

Vec3 combined(const Beam& beam, const BeamState& state, Index e, const Weights& w) {
  const double L = beam.element(e).length();
  const auto i = std::size_t(e);
  return w.xa * state.x.row(e).transpose() + w.xb * state.x.row(e + 1).transpose() +
         L * (w.da * state.R[i].col(0) + w.db * state.R[i + 1].col(0));
}

Mat3x12 combined_derivative(const Beam& beam, const BeamState& state, Index e, const Weights& w) {
  const double L = beam.element(e).length();
  const auto i = std::size_t(e);
  Mat3x12 D;
  D.block<3, 3>(0, 0) = w.xa * Mat3::Identity();
  D.block<3, 3>(0, 3) = -w.da * L * skew(state.R[i].col(0));
  D.block<3, 3>(0, 6) = w.xb * Mat3::Identity();
  D.block<3, 3>(0, 9) = -w.db * L * skew(state.R[i + 1].col(0));
  return D;
}

// Largest value of f in [lo, hi], which brackets one maximum, to the accuracy of double in f.
template <class F>
double golden_maximum(F&& f, double lo, double hi) {
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  double a = hi - ratio * (hi - lo), b = lo + ratio * (hi - lo);
  double fa = f(a), fb = f(b);
  for (int i = 0; i < 48; ++i) {  // 0.618^48 = 1e-10: f is flat there
    if (fa >= fb) {
      hi = b, b = a, fb = fa;
      a = hi - ratio * (hi - lo), fa = f(a);
    } else {
      lo = a, a = b, fa = fb;
      b = lo + ratio * (hi - lo), fb = f(b);
    }
  }
  return 0.5 * (lo + hi);
}

// Closest point of one element: the best of a few samples, then Newton's method on
// (c - p) . c' = 0, kept inside the neighbouring samples by bisection.
double closest_in_element(const Beam& beam, const BeamState& state, Index e, const Vec3& p) {
  constexpr int samples = 8;
  const auto squared = [&](double t) { return (position(beam, state, {e, t}) - p).squaredNorm(); };
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= samples; ++k) {
    const double d = squared(double(k) / samples);
    if (d < least) least = d, best = k;
  }
  double lo = std::max(0.0, (best - 1.0) / samples), hi = std::min(1.0, (best + 1.0) / samples);
  double t = double(best) / samples;
  for (int i = 0; i < 60 && hi - lo > 1e-15; ++i) {
    const Vec3 c = combined(beam, state, e, weights(t)) - p;
    const Vec3 c1 = combined(beam, state, e, first_derivative(t));
    const double slope = c.dot(c1);
    (slope > 0.0 ? hi : lo) = t;
    const double curvature =
        c1.squaredNorm() + c.dot(combined(beam, state, e, second_derivative(t)));
    double next = t - slope / curvature;
    if (!(curvature > 0.0) || next < lo || next > hi) next = 0.5 * (lo + hi);
    const bool done = std::abs(next - t) <= 1e-15;
    t = next;
    if (done) break;
  }
  for (const double end : {0.0, 1.0}) {
    if (squared(end) <= squared(t)) t = end;
  }
  return t;
}

}  // namespace

BeamPoint place_at(const Beam& beam, double arc) {
  const Eigen::VectorXd& arcs = beam.device().arcs();
  const Index e = beam.device().element_at(arc);
  const double xi = (arc - arcs[e]) / (arcs[e + 1] - arcs[e]);
  return {e, std::clamp(xi, 0.0, 1.0)};
}

double arc_of(const Beam& beam, const BeamPoint& place) {
  const Eigen::VectorXd& arcs = beam.device().arcs();
  return (1.0 - place.xi) * arcs[place.element] + place.xi * arcs[place.element + 1];
}

Vec3 position(const Beam& beam, const BeamState& state, const BeamPoint& place) {
  return combined(beam, state, place.element, weights(place.xi));
}

Vec3 unit_tangent(const Beam& beam, const BeamState& state, const BeamPoint& place) {
  return combined(beam, state, place.element, first_derivative(place.xi)).normalized();
}

Mat3x12 position_derivative(const Beam& beam, const BeamState& state, const BeamPoint& place) {
  return combined_derivative(beam, state, place.element, weights(place.xi));
}

Mat3x12 unit_tangent_derivative(const Beam& beam, const BeamState& state, const BeamPoint& place) {
  const Weights w = first_derivative(place.xi);
  const Vec3 v = combined(beam, state, place.element, w);
  const double length = v.norm();
  const Vec3 t = v / length;
  const Mat3 project = (Mat3::Identity() - t * t.transpose()) / length;
  return project * combined_derivative(beam, state, place.element, w);
}

// x moves its point in proportion; of exp(w) v the second-order term is w x (w x v) / 2.
Mat12 position_hessian(const Beam& beam, const BeamState& state, const BeamPoint& place,
                       const Vec3& force) {
  const Weights w = weights(place.xi);
  const double L = beam.element(place.element).length();
  const auto i = std::size_t(place.element);
  const auto turn = [&force](const Vec3& v) {
    const Mat3 outer = force * v.transpose();
    return Mat3(0.5 * (outer + outer.transpose()) - force.dot(v) * Mat3::Identity());
  };
  Mat12 H = Mat12::Zero();
  H.block<3, 3>(3, 3) = w.da * L * turn(state.R[i].col(0));
  H.block<3, 3>(9, 9) = w.db * L * turn(state.R[i + 1].col(0));
  return H;
}

Vec3 curvature(const Beam& beam, const BeamState& state, const BeamPoint& place) {
  const Vec3 first = combined(beam, state, place.element, first_derivative(place.xi));
  const Vec3 second = combined(beam, state, place.element, second_derivative(place.xi));
  const double squared = first.squaredNorm();
  return (second - second.dot(first) / squared * first) / squared;
}

double curve_length(const Beam& beam, const BeamState& state, double from, double to) {
  constexpr double points[3] = {0.11270166537925831, 0.5, 0.88729833462074169};
  constexpr double shares[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const BeamPoint first = place_at(beam, from), last = place_at(beam, to);
  double sum = 0.0;
  for (Index e = first.element; e <= last.element; ++e) {
    const double lo = e == first.element ? first.xi : 0.0, hi = e == last.element ? last.xi : 1.0;
    for (int q = 0; q < 3; ++q) {
      const double t = lo + points[q] * (hi - lo);
      sum += shares[q] * (hi - lo) * combined(beam, state, e, first_derivative(t)).norm();
    }
  }
  return sum;
}

ClosestBeamPoint closest_point(const Beam& beam, const BeamState& state, const Vec3& point) {
  ClosestBeamPoint best{
      {0, 0.0}, Vec3::Zero(), std::numeric_limits<double>::infinity(), CurveEnd::none};
  for (Index e = 0; e < beam.element_count(); ++e) {
    // the cubic lies within its control polygon: skip elements that cannot come closer
    const double nearest_end = (state.x.row(e).transpose() - point).norm();
    const double reach = (state.x.row(e + 1) - state.x.row(e)).norm() + beam.element(e).length();
    if (nearest_end - reach > best.distance) continue;
    const BeamPoint place{e, closest_in_element(beam, state, e, point)};
    const Vec3 at = position(beam, state, place);
    const double distance = (at - point).norm();
    if (distance < best.distance) best = {place, at, distance, CurveEnd::none};
  }
  // beyond an end: the clamped place is the best, and the point lies outwards of the normal plane
  const Vec3 away = point - best.position;
  const double outwards = away.dot(unit_tangent(beam, state, best.place));
  const double rounding = 1e-12 * (best.position.norm() + beam.device().length());
  const bool at_tip = best.place.element == 0 && best.place.xi == 0.0;
  const bool at_wire = best.place.element == beam.element_count() - 1 && best.place.xi == 1.0;
  if (at_tip && outwards < -rounding) best.beyond = CurveEnd::tip;
  if (at_wire && outwards > rounding) best.beyond = CurveEnd::wire;
  return best;
}

Bow bow(const Beam& beam, const BeamState& state, double from, double to) {
  constexpr int samples = 8;  // per element
  const auto at = [&](double arc) { return position(beam, state, place_at(beam, arc)); };
  const Vec3 start = at(from), chord = at(to) - start;
  const double length = chord.norm();
  const Vec3 axis = length > 0.0 ? Vec3(chord / length) : Vec3(Vec3::Zero());
  const auto offset = [&](double arc) {
    const Vec3 d = at(arc) - start;
    return Vec3(d - d.dot(axis) * axis);
  };
  const auto height = [&](double arc) { return offset(arc).norm(); };
  const int count = samples * (place_at(beam, to).element - place_at(beam, from).element + 1);
  const auto arc_at = [&](int k) { return from + (to - from) * k / count; };
  int best = 0;
  for (int k = 1; k <= count; ++k) {
    if (height(arc_at(k)) > height(arc_at(best))) best = k;
  }
  Bow result;
  result.arc =
      golden_maximum(height, arc_at(std::max(0, best - 1)), arc_at(std::min(count, best + 1)));
  result.size = height(result.arc);
  const Vec3 d = offset(result.arc);
  result.direction = result.size > 0.0 ? Vec3(d / result.size) : Vec3(Vec3::Zero());
  return result;
}

}  // namespace brainshift
