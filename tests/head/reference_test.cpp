// The image is in balance with gravity and full CSF; losing fluid moves the brain, and restoring it
// brings every node back.
#include <gtest/gtest.h>

#include "head_scene.hpp"

namespace dbs {
namespace {

TEST(Reference, NetLoadOfTheFullHeadIsNothing) {
  HeadStepper h(quiet_options());
  const Points weight = h.stepper.gravity_force(), fluid = h.stepper.fluid_force();
  const double total = weight.colwise().sum().norm();
  const double net = h.stepper.external_force().cwiseAbs().maxCoeff();
  std::printf("weight %.3f N, fluid on wetted faces %.3f N, net load at stage 0: %.1e of the "
              "weight\n",
              total / 1000.0, fluid.colwise().sum().norm() / 1000.0, net / total);
  EXPECT_GT(fluid.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_LE(net, 1e-12 * total);
}

TEST(Reference, IsReachedAgainWhenTheFluidIsRestored) {
  HeadStepper h(quiet_options());
  const Index side = h.compartment(right);
  h.stepper.csf().set_lost_volume(side, 5.0 * mm3_per_ml);
  ASSERT_TRUE(h.stepper.solve_static().converged());
  const double moved = largest_motion(h.stepper.displacement());
  EXPECT_GT(moved, 0.01);   // mm: far above any tolerance of the solve
  h.stepper.csf().set_full(side);
  const SolveReport report = h.stepper.solve_static();
  ASSERT_TRUE(report.converged()) << report.message;
  const double left_over = largest_motion(h.stepper.displacement());
  std::printf("5 mL lost moves %.3f mm; restored: %.1e mm left, last correction %.1e mm\n", moved,
              left_over, report.last_correction);
  EXPECT_LE(report.last_correction, 1e-8);
  EXPECT_LE(left_over, 1e-6);
}

}  // namespace
}  // namespace dbs
