// What an element sees of its pose: six numbers that no rigid motion changes, as values or as jets in
// (r, ta, tb): r = xb - xa, ta and tb the spins of its ends.
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "beam/element.hpp"
#include "beam/jet.hpp"
#include "beam/rotation.hpp"

namespace brainshift {

// angle / sin(angle) as a function of c = cos(angle), which is smooth at c = 1; with derivatives.
template <class T>
T angle_per_sine(const T& c) {
  const double x = value(c), d = 1.0 - x;
  double f = 0.0, df = 0.0, ddf = 0.0;
  if (d < 0.25) {
    // sum over k of 2^k (k!)^2 / (2k+1)! d^k; ratio of terms -> d/2: 20 terms reach 1e-17
    double a = 1.0, power[3] = {1.0, 0.0, 0.0};  // d^k, and its derivatives
    for (int k = 0; k < 20; ++k) {
      f += a * power[0], df -= a * power[1], ddf += a * power[2];
      power[2] = power[2] * d + 2.0 * power[1];
      power[1] = power[1] * d + power[0];
      power[0] *= d;
      a *= (k + 1.0) / (2.0 * k + 3.0);
    }
  } else {
    // a section turned right round has no direction of bending: stop just short of it
    const double y = std::max(x, -1.0 + 1e-9), s2 = 1.0 - y * y;
    f = std::acos(y) / std::sqrt(s2);
    df = (y * f - 1.0) / s2;
    ddf = (f + 3.0 * y * df) / s2;
  }
  return chain(c, f, df, ddf);
}

// 1/(1 + c), kept finite where the section is turned right round.
template <class T>
T reciprocal_of_one_plus(const T& c) {
  const double f = 1.0 / std::max(1.0 + value(c), 1e-9);
  return chain(c, f, -f * f, 2.0 * f * f * f);
}

inline double sine(double a) { return std::sin(a); }
inline double cosine(double a) { return std::cos(a); }
template <int N>
Jet<N> sine(const Jet<N>& a) {
  const double s = std::sin(a.v);
  return chain(a, s, std::cos(a.v), -s);
}
template <int N>
Jet<N> cosine(const Jet<N>& a) {
  const double c = std::cos(a.v);
  return chain(a, c, -std::sin(a.v), -c);
}

// Angle whose cosine and sine (with c^2 + s^2 = 1 identically) are given.
inline double angle_of(double c, double s) { return std::atan2(s, c); }
template <int N>
Jet<N> angle_of(const Jet<N>& c, const Jet<N>& s) {
  Jet<N> angle(std::atan2(s.v, c.v));
  angle.g = c.v * s.g - s.v * c.g;
  angle.h = c.v * s.h - s.v * c.h;
  return angle;
}

// Rules: scalar products the measures are made of: value, or jet in (r, ta, tb), r = xb - xa.
struct Plain {
  using Scalar = double;
  static double length(const Vec3& r) { return r.norm(); }
  static double with_chord(const Vec3& r, const Vec3& d, int) { return r.dot(d); }
  static double between(const Vec3& a, const Vec3& b) { return a.dot(b); }
};

using Jet9 = Jet<9>;
struct Differentiated {
  using Scalar = Jet9;
  static Jet9 length(const Vec3& r) {
    Jet9 l(r.norm());
    const Vec3 e = r / l.v;
    l.g.head<3>() = e;
    l.h.topLeftCorner<3, 3>() = (Mat3::Identity() - e * e.transpose()) / l.v;
    return l;
  }
  // Second derivative of exp(t) a . b with respect to t, at t = 0.
  static Mat3 spin_hessian(const Vec3& a, const Vec3& b) {
    const Mat3 ab = 0.5 * a * b.transpose();
    return ab + ab.transpose() - a.dot(b) * Mat3::Identity();
  }
  // r . exp(t) d; the spin t is that of end a (first = 3) or b (first = 6).
  static Jet9 with_chord(const Vec3& r, const Vec3& d, int first) {
    Jet9 y(r.dot(d));
    y.g.head<3>() = d;
    y.g.segment<3>(first) = d.cross(r);
    y.h.block<3, 3>(0, first) = skew(d).transpose();
    y.h.block<3, 3>(first, 0) = skew(d);
    y.h.block<3, 3>(first, first) = spin_hessian(d, r);
    return y;
  }
  // exp(ta) a . exp(tb) b.
  static Jet9 between(const Vec3& a, const Vec3& b) {
    Jet9 y(a.dot(b));
    y.g.segment<3>(3) = a.cross(b);
    y.g.segment<3>(6) = b.cross(a);
    y.h.block<3, 3>(3, 3) = y.h.block<3, 3>(6, 6) = spin_hessian(a, b);
    y.h.block<3, 3>(3, 6) = y.v * Mat3::Identity() - b * a.transpose();
    y.h.block<3, 3>(6, 3) = y.h.block<3, 3>(3, 6).transpose();
    return y;
  }
};

// Chord, angles from the normal of a and of b to the chord (along d2, d3 of each), twist.
template <class T>
struct Measures {
  T chord, angles[4], twist;
};

template <class Rules>
Measures<typename Rules::Scalar> measure(const ElementPose& pose) {
  using T = typename Rules::Scalar;
  const Vec3 r = pose.xb - pose.xa;
  const Mat3 &A = pose.Ra, &B = pose.Rb;
  Measures<T> m;
  m.chord = Rules::length(r);
  const T inverse = reciprocal(m.chord);
  T pa[3], pb[3];  // unit chord along d1, d2, d3 of either section
  for (int i = 0; i < 3; ++i) {
    pa[i] = inverse * Rules::with_chord(r, A.col(i), 3);
    pb[i] = inverse * Rules::with_chord(r, B.col(i), 6);
  }
  const T fa = angle_per_sine(pa[0]), fb = angle_per_sine(pb[0]);
  for (int i = 0; i < 2; ++i) {
    m.angles[i] = fa * pa[i + 1];
    m.angles[2 + i] = fb * pb[i + 1];
  }
  // Twist: d2, d3 of a and d2 of b, each carried to the chord by the smallest rotation of its
  // section; their scalar products are the cosine and sine.
  const T ia = reciprocal_of_one_plus(pa[0]);
  const T beta = reciprocal_of_one_plus(pb[0]) * pb[1];
  const T sum = Rules::between(A.col(0), B.col(0)) + pa[0] + pb[0] + 1.0;
  const T normal = Rules::between(A.col(0), B.col(1)) + pb[1] - beta * sum;
  T product[2];
  for (int i = 0; i < 2; ++i) {
    product[i] = Rules::between(A.col(i + 1), B.col(1)) -
                 beta * (Rules::between(A.col(i + 1), B.col(0)) + pa[i + 1]) -
                 ia * pa[i + 1] * normal;
  }
  constexpr double full_turn = 2.0 * 3.14159265358979323846;
  m.twist = angle_of(product[0], product[1]) + full_turn * pose.turns;
  return m;
}

// Slopes of the sections against the chord (a2, a3, b2, b3), in the axes of the mean section: those
// of a turned by half the twist, those of b turned back by as much.
template <class T>
void mean_axes(const T* angles, const T& twist, T* slopes) {
  const T c = cosine(twist * 0.5), s = sine(twist * 0.5);
  slopes[0] = (c * angles[0] + s * angles[1]) * -1.0;
  slopes[1] = (c * angles[1] - s * angles[0]) * -1.0;
  slopes[2] = (c * angles[2] - s * angles[3]) * -1.0;
  slopes[3] = (c * angles[3] + s * angles[2]) * -1.0;
}

}  // namespace brainshift
