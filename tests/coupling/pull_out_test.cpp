// Friction along a track: the force that pulls tissue off a device is the bound times its surface,
// 2 pi r L tau, and below it nothing slips.
#include <cmath>
#include <cstdio>
#include <numeric>

#include <gtest/gtest.h>

#include "stepper/stepper_impl.hpp"
#include "support/beams.hpp"
#include "support/leaning_block.hpp"

namespace brainshift::test {
namespace {

// Gravity along the device pulls the block off it, towards the wire: no point leaves the tip.
constexpr double part_of_gravity = 0.02;
// Track length in tissue, from the tip to the top of the block when the device was put in.
const double track_length = (block_height - lead_tip.z()) / lead_outward.z();

struct PullOut {
  SolveReport report;
  DeviceState before, after;
  std::vector<double> along;  // mN; multiplier of the axial row of each path point
  std::vector<double> bound;
  double largest_slip() const { return (after.path_arcs - before.path_arcs).maxCoeff(); }
  double least_slip() const { return (after.path_arcs - before.path_arcs).minCoeff(); }
  double sum() const { return std::accumulate(along.begin(), along.end(), 0.0); }
};

PullOut pull_out(const BeamDevice& device, const Hold& hold, double shear_bound) {
  Stepper stepper(block_on_base(Vec3::Zero()));
  TrackOptions options;
  options.shear_bound = shear_bound;
  const DeviceId id = stepper.insert(device, {lead_tip, lead_outward}, hold, options);
  PullOut p;
  p.before = stepper.device(id);
  stepper.set_gravity(part_of_gravity * 9810.0 * lead_outward);
  p.report = stepper.solve_static();
  EXPECT_TRUE(p.report.converged()) << p.report.message;
  p.after = stepper.device(id);
  const InsertedDevice inserted = stepper.snapshot()->devices.front();
  for (std::size_t i = 0; i < inserted.path.size(); ++i) {
    p.along.push_back(inserted.motion.multipliers[i][2]);
    p.bound.push_back(2.0 * pi * device.section(0).radius * shear_bound * inserted.path[i].length);
  }
  return p;
}

// Largest angle between the lead and the line it was put in along.
double largest_tilt(const DeviceState& d) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i + 1 < d.nodes.rows(); ++i) {
    const Vec3 chord = (d.nodes.row(i + 1) - d.nodes.row(i)).transpose();
    largest = std::max(largest, chord.cross(lead_outward).norm() / chord.norm());
  }
  return largest;
}

TEST(PullOut, OfADeviceHeldWholeIsTheBoundOnItsSurface) {
  const BeamDevice device = make_device("cannula", device_length);
  const double radius = device.section(0).radius;
  for (const double bound : {1e-4, 1e-3, 4e-3}) {  // kPa; the block weighs 20 mN
    const PullOut p = pull_out(device, whole(), bound);
    const double force = -p.after.anchor_force.dot(lead_outward);  // that the skull takes up
    const double expected = 2.0 * pi * radius * track_length * bound;
    std::printf(
        "pull-out, rigid, bound %.0e kPa: %.12f mN, 2 pi r L tau %.12f, relative %.1e; "
        "slip %.3f to %.3f mm\n",
        bound, force, expected, std::abs(force / expected - 1.0), p.least_slip(), p.largest_slip());
    EXPECT_GT(p.least_slip(), 1e-2);  // mm: every row slips
    EXPECT_NEAR(force, expected, 1e-9 * expected);
    for (std::size_t i = 0; i < p.along.size(); ++i) {
      EXPECT_NEAR(p.along[i], -p.bound[i], 1e-9 * p.bound[i]) << i;
    }
  }
}

// An elastic lead, fixed to the skull at its wire: the rows act along a line that bends a little.
TEST(PullOut, OfAnElasticLeadIsTheBoundOnItsSurface) {
  const double bound = 1e-3;
  const PullOut p = pull_out(lead(), wire_only(), bound);
  const double expected = 2.0 * pi * lead().section(0).radius * track_length * bound;
  std::printf("pull-out, elastic lead: %.12f mN, 2 pi r L tau %.12f, slip from %.3f mm, bow %.1e\n",
              -p.sum(), expected, p.least_slip(), p.after.bow);
  EXPECT_GT(p.least_slip(), 1e-2);
  EXPECT_NEAR(-p.sum(), expected, 1e-9 * expected);
  // What the anchor takes along the former line differs by the ties' part along it: their forces are
  // at right angles to the lead as it lies now.
  const double across = p.after.path_forces.rowwise().norm().sum();
  EXPECT_NEAR(-p.after.anchor_force.dot(lead_outward), expected, across * largest_tilt(p.after));
}

TEST(PullOut, BelowTheBoundNothingSlips) {
  const PullOut p = pull_out(make_device("cannula", device_length), whole(), 10.0);
  double used = 0.0;
  for (std::size_t i = 0; i < p.along.size(); ++i) {
    used = std::max(used, std::abs(p.along[i]) / p.bound[i]);
  }
  const double slip = std::max(p.largest_slip(), -p.least_slip());
  std::printf("pull-out, sticking: largest slip %.1e mm, largest part of a bound %.3f, %.3f mN\n",
              slip, used, -p.sum());
  EXPECT_LE(slip, 3e-9);  // tolerance of the ties: 4e-11 of the diameter of 82 mm
  EXPECT_LT(used, 1.0);
  EXPECT_LT(p.sum(), -1.0);  // and the device does hold the tissue
}

// A tip that tissue has grown onto bears its bound besides, from when the host says so.
TEST(PullOut, ATipHeldBearsItsBoundBesides) {
  Stepper stepper(block_on_base(Vec3::Zero()));
  const BeamDevice device = make_device("cannula", device_length);
  TrackOptions options;
  options.tip_bound = 5.0;
  const DeviceId id = stepper.insert(device, {lead_tip, lead_outward}, whole(), options);
  stepper.set_gravity(part_of_gravity * 9810.0 * lead_outward);
  ASSERT_TRUE(stepper.solve_static().converged());
  const double strong = -stepper.device(id).anchor_force.dot(lead_outward);
  const double shear = 1e-3, tip = 0.25;
  stepper.set_friction(id, shear, tip);
  ASSERT_TRUE(stepper.solve_static().converged());
  const double expected = 2.0 * pi * device.section(0).radius * track_length * shear + tip;
  const double weak = -stepper.device(id).anchor_force.dot(lead_outward);
  std::printf("pull-out, tip held: %.9f mN; bound %.9f mN; while it does not slip %.3f mN\n", weak,
              expected, strong);
  EXPECT_NEAR(weak, expected, 1e-9 * expected);
  EXPECT_GT(strong, 1.1 * weak);
  EXPECT_LT(strong, 5.0);   // the bound it did not reach
  EXPECT_THROW(stepper.set_friction(id, -1.0), Error);
  EXPECT_THROW(stepper.set_friction(id, 0.0, std::nan("")), Error);
}

// In between, the rows near the top slip and the others hold; the force is less than the bound.
TEST(PullOut, InBetweenPartOfTheTrackSlips) {
  const BeamDevice device = make_device("cannula", device_length);
  const PullOut p = pull_out(device, whole(), 0.04);
  int slipping = 0;
  for (std::size_t i = 0; i < p.along.size(); ++i) {
    const double slip = p.after.path_arcs[Eigen::Index(i)] - p.before.path_arcs[Eigen::Index(i)];
    const bool full = std::abs(p.along[i]) >= (1.0 - 1e-9) * p.bound[i];
    EXPECT_LE(std::abs(p.along[i]), p.bound[i] * (1.0 + 1e-12));
    if (full) {
      EXPECT_LT(p.along[i] * slip, 0.0) << i;  // friction opposes it
    } else {
      EXPECT_LE(std::abs(slip), 3e-9) << i;
    }
    slipping += full;
  }
  std::printf("pull-out, partly: %d of %d rows slip, %.4f of %.4f mN\n", slipping,
              int(p.along.size()), -p.sum(),
              2.0 * pi * device.section(0).radius * track_length * 0.04);
  EXPECT_GT(slipping, 0);
  EXPECT_LT(slipping, int(p.along.size()));
}

}  // namespace
}  // namespace brainshift::test
