#include "beam/rotation.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace brainshift {

Mat3 skew(const Vec3& v) {
  Mat3 m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Mat3 rotation_exp(const Vec3& v) {
  const double angle = v.norm();
  const Mat3 K = skew(v);
  // sin(a)/a and (1 - cos a)/a^2; below the bound the next terms of their series vanish in double
  double first = 1.0 - angle * angle / 6.0, second = 0.5 - angle * angle / 24.0;
  if (angle > 1e-4) {
    const double half = std::sin(0.5 * angle) / angle;
    first = std::sin(angle) / angle;
    second = 2.0 * half * half;
  }
  return Mat3::Identity() + first * K + second * K * K;
}

Mat3 orthonormalised(const Mat3& R) {
  return R * (1.5 * Mat3::Identity() - 0.5 * (R.transpose() * R));
}

Mat3 smallest_rotation(const Vec3& from, const Vec3& to) {
  const double c = from.dot(to);
  if (1.0 + c < 1e-12) {  // opposite: half a turn about any perpendicular axis
    const Vec3 axis = any_frame(from).col(1);
    return 2.0 * axis * axis.transpose() - Mat3::Identity();
  }
  const Vec3 axis = from.cross(to);
  return c * Mat3::Identity() + skew(axis) + axis * axis.transpose() / (1.0 + c);
}

Mat3 any_frame(const Vec3& direction) {
  Eigen::Index seed = 0;
  direction.cwiseAbs().minCoeff(&seed);
  Mat3 frame;
  frame.col(0) = direction;
  frame.col(1) = (Vec3::Unit(seed) - direction[seed] * direction).normalized();
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

std::vector<Vec3> polyline_tangents(const Points& nodes) {
  const Eigen::Index last = nodes.rows() - 1;
  const auto chord = [&](Eigen::Index i) -> Vec3 { return nodes.row(i + 1) - nodes.row(i); };
  std::vector<Vec3> tangents(std::size_t(last) + 1, chord(0).normalized());
  for (Eigen::Index i = 1; i < last; ++i) {
    const Vec3 before = chord(i - 1), after = chord(i);
    const double h = before.norm(), k = after.norm();
    const Vec3 sum = before * (k / h) + after * (h / k);
    // a polyline that turns back on itself has no tangent there: keep the chord
    const bool folded = sum.norm() < 1e-9 * (h + k);
    tangents[std::size_t(i)] = folded ? Vec3(after / k) : Vec3(sum.normalized());
  }
  const auto mirrored = [](const Vec3& tangent, const Vec3& axis) {
    const Vec3 e = axis.normalized();
    return Vec3((2.0 * e.dot(tangent) * e - tangent).normalized());
  };
  if (last > 1) {
    tangents.front() = mirrored(tangents[1], chord(0));
    tangents.back() = mirrored(tangents[std::size_t(last) - 1], chord(last - 1));
  }
  return tangents;
}

std::vector<Mat3> transported_frames(const std::vector<Vec3>& tangents, const Mat3& first) {
  std::vector<Mat3> frames(tangents.size(), first);
  for (std::size_t i = 1; i < tangents.size(); ++i) {
    const Mat3 carried = smallest_rotation(tangents[i - 1], tangents[i]) * frames[i - 1];
    frames[i] = orthonormalised(carried);
    frames[i].col(0) = tangents[i];
  }
  return frames;
}

}  // namespace brainshift
