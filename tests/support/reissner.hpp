// A clamped rod in space by shooting: the equations of Reissner's geometrically exact rod as an
// initial value problem, solved without any code of the library.
#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <Eigen/Geometry>

namespace brainshift::test {

// Compliances along d1 (the line), d2, d3: of forces (1/EA, 1/GA, 1/GA) and of moments (1/GJ, 1/EI,
// 1/EI); curvature at rest in the same axes. Clamped at the origin, d1 = x.
struct ReissnerRod {
  double length;
  Eigen::Vector3d force_compliance, moment_compliance;
  Eigen::Vector3d rest_curvature = Eigen::Vector3d::Zero();

  struct End {
    Eigen::Vector3d position, moment;
  };

  // The far end under a dead force, from the moment at the clamp: x' = R (e1 + shear and stretch),
  // R' = R [curvature], m' = -x' x force, by the classical Runge-Kutta method on quaternions.
  End march(const Eigen::Vector3d& force, const Eigen::Vector3d& moment, int steps) const {
    State y = State::Zero();
    y[3] = 1.0;
    y.tail<3>() = moment;
    const double h = length / steps;
    for (int i = 0; i < steps; ++i) {
      const State a = slope(y, force), b = slope(y + 0.5 * h * a, force);
      const State c = slope(y + 0.5 * h * b, force), d = slope(y + h * c, force);
      y += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
      y.segment<4>(3).normalize();
    }
    return {y.head<3>(), y.tail<3>()};
  }

  // Position of the far end under a dead force and a moment fixed in space, by Newton's method on
  // the moment at the clamp; `near` picks the equilibrium. NaN where it does not converge.
  Eigen::Vector3d tip(const Eigen::Vector3d& force, const Eigen::Vector3d& moment,
                      const Eigen::Vector3d& near, int steps = 2000) const {
    Eigen::Vector3d clamp = moment + near.cross(force);
    const double scale = clamp.norm(), step = 1e-6 * scale;
    for (int i = 0; i < 20; ++i) {
      const End end = march(force, clamp, steps);
      const Eigen::Vector3d open = end.moment - moment;
      if (open.norm() <= 1e-11 * scale) return end.position;
      Eigen::Matrix3d J;
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d dk = step * Eigen::Vector3d::Unit(k);
        J.col(k) = (march(force, clamp + dk, steps).moment - end.moment) / step;
      }
      clamp -= J.fullPivLu().solve(open);
    }
    return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  }

 private:
  using State = Eigen::Matrix<double, 10, 1>;  // position, quaternion (w, x, y, z), moment

  State slope(const State& y, const Eigen::Vector3d& force) const {
    const Eigen::Quaterniond q(y[3], y[4], y[5], y[6]);
    const Eigen::Matrix3d R = q.normalized().toRotationMatrix();
    const Eigen::Vector3d strain = force_compliance.cwiseProduct(R.transpose() * force);
    const Eigen::Vector3d k =
        rest_curvature + moment_compliance.cwiseProduct(R.transpose() * y.tail<3>());
    const Eigen::Quaterniond turn = q * Eigen::Quaterniond(0.0, k[0], k[1], k[2]);
    State d;
    d.head<3>() = R * (Eigen::Vector3d::UnitX() + strain);
    d.segment<4>(3) << turn.w(), turn.x(), turn.y(), turn.z();
    d.segment<4>(3) *= 0.5;
    d.tail<3>() = -d.head<3>().cross(force);
    return d;
  }
};

}  // namespace brainshift::test
