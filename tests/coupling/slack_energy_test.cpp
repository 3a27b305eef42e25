// A lead without friction and with slack slides until the skull stops it, where the energy falls all
// the way: the fall is the integral of the force that the stop takes up.
#include <cstdio>

#include <gtest/gtest.h>

#include "support/leaning_block.hpp"

namespace brainshift::test {
namespace {

struct Slid {
  double out, stop, potential;  // mm, mN, uJ
};

// In a block that leans on further when its cannula has left.
Slid slide(double slack) {
  Stepper stepper(leaning_block(0.01));
  EXPECT_TRUE(stepper.solve_static().converged());
  const DeviceId id =
      stepper.insert(make_device("cannula", device_length), {lead_tip, lead_outward}, whole());
  stepper.exchange(id, lead(), whole());
  stepper.set_gravity(leaning(0.03));
  EXPECT_TRUE(stepper.solve_static().converged());
  stepper.set_hold(id, wire_only(slack));
  const SolveReport report = stepper.solve_static();
  EXPECT_TRUE(report.converged()) << report.message;
  EXPECT_LE(report.iterations, 10);
  const DeviceState d = stepper.device(id);
  Eigen::Index anchor;
  const Eigen::VectorXd& arcs = stepper.device_model(id).arcs();
  (arcs.array() - wire).abs().minCoeff(&anchor);
  const Vec3 moved = d.nodes.row(anchor).transpose() - (lead_tip + arcs[anchor] * lead_outward);
  const double work = stepper.external_force().cwiseProduct(stepper.displacement()).sum();
  return {moved.dot(lead_outward), -d.anchor_force.dot(lead_outward), report.energy - work};
}

TEST(SlackEnergy, ALeadSlidesAsFarAsTheEnergyFalls) {
  constexpr double weights[] = {1.0, 4.0, 2.0, 4.0, 1.0};  // Simpson
  double integral = 0.0, first = 0.0, last = 0.0;
  for (int i = 0; i < 5; ++i) {
    const double slack = 0.25 * i;
    const Slid s = slide(slack);
    std::printf("slack %.2f mm: slid out by %.6f mm, stop %.5f mN, potential %.6f uJ\n", slack, s.out,
                s.stop, s.potential);
    EXPECT_NEAR(s.out, slack, 1e-8);
    EXPECT_GT(s.stop, 0.0);
    integral += weights[i] * s.stop * 0.25 / 3.0;
    last = s.potential;
    if (i == 0) first = last;
  }
  EXPECT_NEAR(first - last, integral, 0.01 * integral);
}

}  // namespace
}  // namespace brainshift::test
