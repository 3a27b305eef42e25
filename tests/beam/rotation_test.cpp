// Rotations without limit: half and full turns, ten turns of twist, steps of any size.
#include <gtest/gtest.h>

#include "support/beams.hpp"

namespace brainshift::test {
namespace {

TEST(BeamRotation, ExponentialOfHalfAndFullTurns) {
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 e = Vec3::Unit(axis);
    EXPECT_LE((rotation_exp(2.0 * pi * e) - Mat3::Identity()).norm(), 1e-15);
    EXPECT_LE((rotation_exp(pi * e) - (2.0 * e * e.transpose() - Mat3::Identity())).norm(), 1e-15);
    for (const double tiny : {0.0, 1e-300, 1e-12, 9e-5, 1.1e-4}) {
      const Vec3 u = Vec3::Unit((axis + 1) % 3), turned = rotation_exp(tiny * e) * u;
      EXPECT_NEAR(turned.dot(e.cross(u)), std::sin(tiny), 1e-16);
    }
  }
}

Eigen::VectorXd uniform_twist(const Beam& beam, double angle) {
  Eigen::VectorXd step = Eigen::VectorXd::Zero(beam.dof_count());
  const Vec3 axis = beam.rest().R.front().col(0);
  for (Index i = 0; i < beam.node_count(); ++i) {
    step.segment<3>(6 * i + 3) = angle * i / beam.element_count() * axis;
  }
  return step;
}

// B7, B3: energy GJ angle^2/2L whatever the number of turns, also pi, 2 pi and more per element,
// in one step or in many, along any axis.
TEST(BeamRotation, TwistDoesNotWrap) {
  const double length = 10.0, torsion = 3.0;
  for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(1, -2, 3)}) {
    const Mat3 orientation = any_frame(direction.normalized());
    for (const Index elements : {1, 5, 10, 40}) {
      const Beam beam =
          straight_beam(length, elements, round_section(5.0, 1e6, torsion), orientation);
      for (const double turns : {0.5, 1.0, 5.0, 10.0, -10.0}) {
        const double angle = 2.0 * pi * turns;
        const double exact = 0.5 * torsion * angle * angle / length;
        for (const int steps : {1, 3, 64}) {
          BeamState state = beam.rest();
          for (int k = 0; k < steps; ++k) beam.update(state, uniform_twist(beam, angle / steps));
          EXPECT_NEAR(beam.energy(state), exact, 1e-10 * exact) << elements << " " << turns;
          EXPECT_NEAR(beam.resultants(state, 0).torque, torsion * angle / length,
                      1e-9 * std::abs(angle));
          for (int k = 0; k < steps; ++k) beam.update(state, uniform_twist(beam, -angle / steps));
          EXPECT_LE(beam.energy(state), 1e-18 * exact) << elements << " " << turns;
        }
      }
    }
  }
}

// Steps of a wild iteration: a section turned right round across the beam has no bending direction;
// energy and forces stay finite, and the way back is free.
TEST(BeamRotation, FoldedElementStaysFinite) {
  const Beam beam = straight_beam(4.0, 2, round_section(5.0));
  for (const double angle : {0.5 * pi, pi, 2.0 * pi}) {
    for (const int axis : {1, 2}) {
      Eigen::VectorXd step = Eigen::VectorXd::Zero(beam.dof_count());
      step.segment<3>(9) = angle * Vec3::Unit(axis);
      BeamState state = beam.rest();
      beam.update(state, step);
      Eigen::VectorXd gradient;
      BlockTridiagonal K;
      EXPECT_TRUE(std::isfinite(beam.tangent(state, gradient, K)));
      EXPECT_TRUE(gradient.allFinite());
      EXPECT_TRUE(K.dense().allFinite());
      beam.update(state, -step);
      EXPECT_LE(beam.energy(state), 1e-20);
      EXPECT_EQ(state.turns, beam.rest().turns);
    }
  }
}

// Rotations stay rotations over ten thousand updates.
TEST(BeamRotation, FramesDoNotDrift) {
  const Beam beam = straight_beam(4.0, 2, round_section(5.0));
  BeamState state = beam.rest();
  std::mt19937 random(1);
  for (int k = 0; k < 10000; ++k) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(beam.dof_count());
    const Vec3 spin = random_vector(random, 1.0);
    for (Index i = 0; i < beam.node_count(); ++i) step.segment<3>(6 * i + 3) = spin;
    beam.update(state, step);
  }
  for (const Mat3& R : state.R) {
    EXPECT_LE((R.transpose() * R - Mat3::Identity()).norm(), 1e-14);
  }
}

// B6: a lead of L/r = 300 and a steel cannula: the stiffness of the tip, EI 3/L^3, comes out of a
// tangent whose entries differ by EA L^2/EI to a relative accuracy of its condition number.
TEST(BeamRotation, StiffAgainstStretchingIsNoObstacle) {
  const double length = 190.0, radius = 0.635;
  for (const double bending : {1e3, 6.5e7}) {
    const Beam beam =
        straight_beam(length, 95, round_section(bending, 4.0 * bending / (radius * radius)));
    BeamState state = beam.rest();
    const double P = 1e-6 * bending / (length * length);
    ASSERT_TRUE(solve_statics(beam, cantilever(beam, Vec3(0, P, 0)), state).converged);
    const double exact = P * length * length * length / (3.0 * bending);
    // condition 95^4 of the fine beam, times rounding
    EXPECT_NEAR(tip_of(state).y(), exact, 1e-7 * exact);
  }
}

}  // namespace
}  // namespace brainshift::test
