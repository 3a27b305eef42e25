// Every stage of the procedure ends in a certified balance, in time.
#include <chrono>
#include <ctime>

#include <gtest/gtest.h>

#include "head_scene.hpp"

namespace dbs {
namespace {

TEST(Stages, EndInBalanceAndInTime) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t start_of_work = std::clock();
  Procedure procedure(shipped_head(), quiet_options());
  for (const Stage& stage : procedure.plan()) {
    const StageResult s = procedure.run(stage);
    const SolveReport& r = s.report;
    std::printf(
        "stage %-2s: residual %.1e, complementarity %.1e, violation %.1e mm, tie gap %.1e mm, "
        "min J %.3f, %d iterations, %d factorisations, %.2f s\n",
        s.label.c_str(), r.residual, r.complementarity, r.violation, r.tie_gap,
        r.smallest_jacobian, r.iterations, r.factorisations, r.seconds);
    EXPECT_TRUE(r.converged()) << r.message;
    EXPECT_LE(r.residual, 1e-8);  // of the largest force norm
    EXPECT_LE(r.complementarity, 1e-8);
    EXPECT_GT(r.smallest_jacobian, 0.0);
    EXPECT_LE(r.tie_gap, 1e-7);  // mm
    for (const auto& [name, shift] : s.shifts) EXPECT_TRUE(shift.allFinite()) << name;
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  // Work of all threads beside it: far less than wall clock means a busy machine.
  const double work = double(std::clock() - start_of_work) / CLOCKS_PER_SEC;
  std::printf("all stages: %.1f s, %.1f s of them at work (limit %.0f)\n", seconds.count(), work,
              double(SECONDS_LIMIT));
  EXPECT_LE(seconds.count(), SECONDS_LIMIT);   // wall clock, as a user waits
}

// Frictionless and elastic: the state does not depend on the way to it.
TEST(Stages, SplitInTwoEndAtTheSameState) {
  HeadStepper once(quiet_options()), twice(quiet_options());
  once.stepper.csf().set_lost_volume(once.compartment(right), 20.0 * mm3_per_ml);
  ASSERT_TRUE(once.stepper.solve_static().converged());
  for (double ml : {10.0, 20.0}) {
    twice.stepper.csf().set_lost_volume(twice.compartment(right), ml * mm3_per_ml);
    ASSERT_TRUE(twice.stepper.solve_static().converged());
  }
  const double apart = largest_motion(once.stepper.displacement() - twice.stepper.displacement());
  std::printf("20 mL at once and in two: %.1e mm apart\n", apart);
  EXPECT_LE(apart, 1e-6);
}

}  // namespace
}  // namespace dbs
