#include "beam/rigid_device.hpp"

#include <cmath>

#include "beam/rotation.hpp"
#include "brainshift/error.hpp"
#include "text.hpp"

namespace brainshift {

RigidDevice::RigidDevice(const Vec3& tip, const Vec3& direction, double length, double radius)
    : m_tip(tip), m_length(length), m_radius(radius) {
  if (!tip.allFinite() || !direction.allFinite() || !std::isfinite(length + radius)) {
    throw Error(ErrorCode::not_finite, "rigid device: tip, direction, length or radius not finite");
  }
  if (!(direction.norm() > 0.0) || !(length > 0.0) || !(radius > 0.0)) {
    throw Error(
        ErrorCode::invalid_argument,
        "rigid device: needs a direction, a positive length and a positive radius; got |d| = " +
            text(direction.norm()) + ", " + text(length) + ", " + text(radius));
  }
  m_frame = any_frame(direction.normalized());
}

Eigen::Matrix<double, 3, 6> RigidDevice::point_derivative(double arc) const {
  Eigen::Matrix<double, 3, 6> D;
  D << Mat3::Identity(), -arc * skew(axis());
  return D;
}

void RigidDevice::update(const Eigen::Matrix<double, 6, 1>& step) {
  m_tip += step.head<3>();
  m_frame = orthonormalised(rotation_exp(step.tail<3>()) * m_frame);
}

}  // namespace brainshift
