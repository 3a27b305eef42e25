// Ties between tissue that is fixed and a device that is held: neither side can give way.
#include <cmath>
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>

#include "support/leaning_block.hpp"

namespace brainshift::test {
namespace {

// The lower half of the block is fixed, the track begins in it.
TEST(HeldRows, OfFixedTissueAndAHeldDeviceCarryNothing) {
  Scene scene = block_on_base(Vec3::Zero());
  scene.constraints.fix("lower half",
                        nodes_where(scene.mesh, [](const Vec3& x) { return x.z() <= 40.0; }));
  for (const double shear_bound : {0.0, 1.0}) {
    Stepper stepper(scene);
    TrackOptions options;
    options.shear_bound = shear_bound;
    const DeviceId id = stepper.insert(make_device("cannula", device_length),
                                       {lead_tip, lead_outward}, whole(), options);
    stepper.set_gravity(leaning(0.02));
    const SolveReport report = stepper.solve_static();
    ASSERT_TRUE(report.converged()) << report.message;
    const DeviceState d = stepper.device(id);
    int held = 0;
    double held_force = 0.0, free_force = 0.0;
    for (Eigen::Index p = 0; p < d.path.rows(); ++p) {
      const bool fixed = d.path(p, 2) <= 40.0 + 1e-9;
      held += fixed;
      (fixed ? held_force : free_force) += d.path_forces.row(p).norm();
    }
    std::printf(
        "held rows: %d of %d path points in fixed tissue carry %.1e mN, the others %.3f; "
        "rank %d of %d rows\n",
        held, int(d.path.rows()), held_force, free_force, int(report.coupling_rank),
        int(report.coupling_rows));
    EXPECT_GE(held, 3);
    EXPECT_LT(held, d.path.rows());
    EXPECT_EQ(held_force, 0.0);
    EXPECT_GT(free_force, 0.1);
    EXPECT_TRUE(report.coupling_unique);
    EXPECT_EQ(report.coupling_rank, report.coupling_rows - held * (shear_bound > 0.0 ? 3 : 2));
    EXPECT_LE(report.tie_gap, 1e-12);
  }
}

// A lead clamped just where it leaves the fixed half: the path point there has nothing but rounding on
// either side, 1e-25 mm/mN, and 1e-15 mm of gap to close with it.
TEST(HeldRows, WhereAClampedLeadLeavesFixedTissueCarryNothing) {
  const double level = 40.0, clamp = (level - lead_tip.z()) / lead_outward.z();
  Scene scene = block_on_base(Vec3::Zero());
  scene.constraints.fix("lower half",
                        nodes_where(scene.mesh, [&](const Vec3& x) { return x.z() <= level; }));
  const Index below = 9, above = 18;  // elements on either side of the clamp
  Points nodes = Points::Zero(below + above + 1, 3);
  for (Index i = 0; i <= below + above; ++i) {
    nodes(i, 0) =
        i <= below ? clamp * i / below : clamp + (device_length - clamp) * (i - below) / above;
  }
  for (const bool clamped : {false, true}) {
    Stepper stepper(scene);
    const BeamDevice device("lead", nodes, {rod_section(1.27, 5000.0, 0.3)});
    const Hold hold{std::numeric_limits<double>::infinity(), clamp, clamped};
    const DeviceId id = stepper.insert(device, {lead_tip, lead_outward}, hold);
    stepper.set_gravity(leaning(0.02));
    const SolveReport report = stepper.solve_static();
    ASSERT_TRUE(report.converged()) << report.message;
    const DeviceState d = stepper.device(id);
    int there = 0;
    double free_force = 0.0;
    for (Eigen::Index p = 0; p < d.path.rows(); ++p) {
      const double force = d.path_forces.row(p).norm();
      if (std::abs(d.path(p, 2) - level) > 1e-9) {
        free_force += force;
        continue;
      }
      ++there;
      EXPECT_EQ(force, 0.0);
    }
    std::printf(
        "held rows: clamped %d, %d path point at the clamp; the others carry %.3f mN in sum; "
        "rank %d of %d rows\n",
        int(clamped), there, free_force, int(report.coupling_rank), int(report.coupling_rows));
    EXPECT_EQ(there, 1);
    EXPECT_GT(free_force, 0.1);
    EXPECT_TRUE(report.coupling_unique);
    EXPECT_EQ(report.coupling_rank, report.coupling_rows - 2);
  }
}

}  // namespace
}  // namespace brainshift::test
