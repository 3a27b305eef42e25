// Cannula and electrode on the head: what they restrain, how they bend, what they leave behind.
#include <cmath>

#include <gtest/gtest.h>

#include "head_scene.hpp"

namespace dbs {
namespace {

// Runs the stages until `last` is done; the results of all of them.
std::vector<StageResult> run_until(Procedure& procedure, const std::string& last) {
  std::vector<StageResult> results;
  for (const Stage& stage : procedure.plan()) {
    results.push_back(procedure.run(stage));
    EXPECT_TRUE(results.back().report.converged())
        << stage.label << ": " << results.back().report.message;
    if (stage.label == last || !results.back().report.converged()) break;
  }
  return results;
}

Options right_only() {
  Options o = quiet_options();
  o.sides = "right";
  return o;
}

Vec3 across(const Vec3& v, const Vec3& t) { return v - v.dot(t) * t; }

// The frame holds the cannula: its track stays, where the same tissue moves without it; when the
// cannula leaves, the tissue goes where it would have been, but for the lead.
TEST(Electrodes, TheCannulaRestrainsItsTrackAndItsRemovalReleasesIt) {
  Options bare = right_only();
  bare.devices = false;
  Procedure with(shipped_head(), right_only()), without(shipped_head(), bare);
  const StageResult before = run_until(with, "3").back();
  run_until(without, "1");
  const Points track = before.lead[right]->state.path;
  const Points rest = with.stepper().rest_points_of(track).values;
  const Vec3 t = before.lead[right]->trajectory.outward;
  const auto largest_across = [&](const Stepper& stepper) {
    const Points moved = rest + stepper.displacement_at(rest).values - track;
    double largest = 0.0;
    for (Eigen::Index p = 0; p < moved.rows(); ++p) {
      largest = std::max(largest, across(moved.row(p).transpose(), t).norm());
    }
    return largest;
  };
  // Insertion has moved nothing: both are at the same state.
  const double inserted =
      largest_motion(with.stepper().displacement() - without.stepper().displacement());
  EXPECT_LE(inserted, 1e-9);
  const StageResult testing = with.run(with.plan()[4]);
  ASSERT_EQ(testing.label, "4");
  ASSERT_EQ(without.plan()[2].label, "4");
  without.run(without.plan()[2]);
  const double held = largest_across(with.stepper()), free = largest_across(without.stepper());
  const double apart =
      largest_motion(with.stepper().displacement() - without.stepper().displacement());
  const StageResult out = with.run(with.plan()[5]);
  ASSERT_EQ(out.label, "5");
  const double released = largest_across(with.stepper());
  const double rest_apart =
      largest_motion(with.stepper().displacement() - without.stepper().displacement());
  std::printf(
      "insertion moves the brain by %.1e mm; while more fluid is lost the track moves, across, "
      "%.1e mm with the cannula, %.3f mm without it, and %.3f mm once it has left;\nthe brain "
      "differs from one without devices by %.3f mm at most with the cannula, %.3f mm with the lead "
      "alone (bow %.3f mm)\n",
      inserted, held, free, released, apart, rest_apart, out.lead[right]->state.bow);
  EXPECT_LE(held, 1e-6);
  EXPECT_GT(free, 0.05);
  EXPECT_GT(released, 0.05);
  EXPECT_LT(rest_apart, apart);
}

// Retraction and bow after recovery, and right after the cannula left.
TEST(Electrodes, RetractionAndBowForStiffnessesAndFrictions) {
  std::printf("right side; D against skull and tissue since the cannula left, mm\n%-9s%-10s%9s%9s"
              "%9s%9s%9s\n", "EI Nmm2", "shear kPa", "D skull", "D tissue", "bow 5", "bow 9", "tip y");
  for (double friction : {0.0, 0.02, 0.2}) {
    double softer = std::numeric_limits<double>::infinity();
    for (double bending : {1.0, 5.0, 100.0}) {
      Options o = right_only();
      o.bending = bending;
      o.friction = friction;
      Procedure procedure(shipped_head(), o);
      const std::vector<StageResult> all = run_until(procedure, "9");
      const LeadResult& out = *all[all.size() - 2].lead[right];
      const LeadResult& end = *all.back().lead[right];
      ASSERT_TRUE(end.since_cannula_left.has_value());
      std::printf("%-9.0f%-10.2f%9.3f%9.3f%9.3f%9.3f%9.3f\n", bending, friction,
                  end.since_cannula_left->skull, end.since_cannula_left->tissue, out.state.bow,
                  end.state.bow, end.state.nodes(0, 1) - end.trajectory.target.y());
      EXPECT_GT(out.state.bow, 0.0);
      EXPECT_LT(out.state.bow, softer) << "the stiffest lead bends least";
      softer = out.state.bow;
    }
  }
}

TEST(Electrodes, SnapshotsBranchToTheSameBits) {
  Procedure procedure(shipped_head(), right_only());
  run_until(procedure, "4");
  Stepper& stepper = procedure.stepper();
  const auto before = stepper.snapshot();
  const auto state = [&] {
    return std::make_pair(stepper.displacement(), stepper.device(0).nodes);
  };
  const auto first = state();
  ASSERT_TRUE(stepper.solve_static().converged());
  const auto straight = state();
  stepper.restore(before);
  EXPECT_EQ(state(), first);
  // Another loss of fluid, another electrode beside the first; then back and on as before.
  Csf& csf = stepper.csf();
  csf.set_lost_volume(csf.find("right"), 30.0 * mm3_per_ml);
  const Trajectory other = make_trajectory(shipped_head(), left,
                                           shipped_head().landmarks.at("STN_left"),
                                           outward_of(left, 65.0, 15.0));
  const DeviceId second =
      stepper.insert(make_device("vercise", other.length), {other.target, other.outward},
                     {0.0, other.length, false, 0.0});
  ASSERT_TRUE(stepper.solve_static().converged());
  EXPECT_GT(largest_motion(stepper.displacement() - first.first), 0.1);
  stepper.restore(before);
  EXPECT_EQ(state(), first);
  EXPECT_THROW(stepper.device(second), Error);
  ASSERT_TRUE(stepper.solve_static().converged());
  EXPECT_EQ(state(), straight);
}

TEST(Electrodes, ThreadsDoNotChangeABit) {
  std::vector<std::pair<Points, Points>> ends;
  for (int threads : {1, 2}) {
    Options o = right_only();
    o.threads = threads;
    o.friction = 0.02;
    Procedure procedure(shipped_head(), o);
    double seconds = 0.0;
    for (const StageResult& s : run_until(procedure, "9")) seconds += s.report.seconds;
    ends.emplace_back(procedure.stepper().displacement(), procedure.stepper().device(0).nodes);
    std::printf("%d thread%s: %.1f s in the solves\n", threads, threads > 1 ? "s" : "", seconds);
  }
  EXPECT_EQ(ends[0], ends[1]);
}

// A straight lead inside a rigid cannula and an elastic steel one do nearly the same; a test
// electrode exchanged before the cannula leaves is forgotten.
TEST(Electrodes, VariantsOfTheCannulaEndCloseTogether) {
  std::vector<LeadResult> ends;
  for (int variant = 0; variant < 4; ++variant) {
    Options o = right_only();
    o.elastic_cannula = variant == 1;
    o.test_electrode = variant == 2 ? "3387" : "";
    o.cannula_depth = variant == 3 ? 12.0 : 0.0;
    Procedure procedure(shipped_head(), o);
    ends.push_back(*run_until(procedure, "5").back().lead[right]);
    EXPECT_EQ(ends.back().state.name, "3389");
    const double apart = (ends.back().state.nodes - ends.front().state.nodes).rowwise().norm().maxCoeff();
    std::printf("%-34s bow %.4f mm, lead %.1e mm from the first\n",
                std::vector<const char*>{"rigid cannula", "elastic cannula", "exchanged electrode",
                                         "cannula 12 mm short"}[std::size_t(variant)],
                ends.back().state.bow, apart);
    EXPECT_LE(apart, variant == 3 ? 0.05 : 1e-5);   // a deeper track has other points
  }
}

}  // namespace
}  // namespace dbs
