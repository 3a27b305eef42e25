// A device too stiff to bend: a straight line with a pose of six degrees of freedom.
#pragma once

#include "brainshift/types.hpp"

namespace brainshift {

class RigidDevice {
 public:
  // `direction` points from the tip towards the wire; d2, d3 across it are chosen. Throws Error for
  // a length or radius that is not positive, and for a direction that is none.
  RigidDevice(const Vec3& tip, const Vec3& direction, double length, double radius);

  double length() const { return m_length; }  // mm
  double radius() const { return m_radius; }  // mm
  const Vec3& tip() const { return m_tip; }
  Vec3 axis() const { return m_frame.col(0); }
  const Mat3& frame() const { return m_frame; }  // d1 (axis), d2, d3 (across) as columns

  Vec3 point(double arc) const { return m_tip + arc * axis(); }  // arc length from the tip
  // Derivative of point(arc) by (dx, t): translation of the tip, and spin about it.
  Eigen::Matrix<double, 3, 6> point_derivative(double arc) const;
  // Arc length of the foot of a point on the axis, not clamped.
  double arc_of(const Vec3& point) const { return (point - m_tip).dot(axis()); }

  // x <- x + dx, R <- exp(t) R.
  void update(const Eigen::Matrix<double, 6, 1>& step);

 private:
  Vec3 m_tip;
  Mat3 m_frame;
  double m_length, m_radius;
};

}  // namespace brainshift
