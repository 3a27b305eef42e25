// Which changes of the merit a line search accepts, and the one rise of energy it lends.
#include "stepper/sufficient_decrease.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "support/scenes.hpp"

namespace brainshift {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(SufficientDecrease, AsksForAPartOfThePredictedFall) {
  EXPECT_TRUE(sufficient_decrease(-0.5, 1.0, 0.0));
  EXPECT_FALSE(sufficient_decrease(-1e-5, 1.0, 0.0));
  EXPECT_FALSE(sufficient_decrease(1e-3, 1.0, 0.0));
}

TEST(SufficientDecrease, AllowsForRounding) {
  EXPECT_TRUE(sufficient_decrease(1e-15, 1e-20, 1e-12));
  EXPECT_FALSE(sufficient_decrease(1e-11, 1e-20, 1e-12));
}

// The rounding of an infinite energy is infinite, of one that is not a number not a number.
TEST(SufficientDecrease, NeverAcceptsWhatIsNotFinite) {
  for (const double change : {inf, -inf, nan}) {
    for (const double rounding : {0.0, 1.0, inf, nan}) {
      EXPECT_FALSE(sufficient_decrease(change, 1.0, rounding)) << change << " " << rounding;
    }
  }
  EXPECT_FALSE(sufficient_decrease(-1.0, nan, 0.0));
}

// A clamped bar of 99 nodes, 200 mm long, whose end its weight takes down by half its length.
Scene slender_bar(double gravity, Law law = Law::st_venant_kirchhoff) {
  Scene scene{test::make_mesh(test::make_box({200.0, 40.0, 40.0}, 10, 2, 2)),
              {{0, Material(law, 6.0, 0.45, test::tissue_density)}}};
  scene.balanced_reference = false;
  scene.gravity = {0.0, 0.0, -gravity * standard_gravity};
  scene.constraints.fix("wall", test::nodes_where(scene.mesh, [](const Vec3& x) { return x.x() == 0.0; }));
  return scene;
}

// A search that never lets the energy rise takes 11 iterations.
TEST(LineSearch, LendsASlenderBarTheFirstStep) {
  Stepper stepper(slender_bar(0.05), within(1e-6, slender_bar(0.05).mesh));
  const SolveReport report = stepper.solve_static();
  ASSERT_TRUE(report.converged()) << report.message;
  EXPECT_LE(report.iterations, 12);
  EXPECT_LE(report.factorisations, 2);
}

Points balance_in_parts(double gravity, Law law, int parts) {
  Stepper stepper(slender_bar(0.0, law));
  for (int i = 1; i <= parts; ++i) {
    stepper.set_gravity({0.0, 0.0, -gravity * standard_gravity * i / parts});
    EXPECT_TRUE(stepper.solve_static().converged()) << i;
  }
  return stepper.displacement();
}

// Another way there, the same state.
TEST(LineSearch, LendsNoOtherState) {
  for (const Law law : {Law::st_venant_kirchhoff, Law::stable_neo_hookean}) {
    Stepper at_once(slender_bar(0.05, law));
    ASSERT_TRUE(at_once.solve_static().converged());
    const Points apart = at_once.displacement() - balance_in_parts(0.05, law, 20);
    EXPECT_LT(apart.cwiseAbs().maxCoeff(), 1e-6);
  }
}

// What the neo-Hookean bar borrows it does not pay back within five iterations.
TEST(LineSearch, BeginsAgainWhereNothingIsPaidBack) {
  Stepper stepper(slender_bar(0.3, Law::stable_neo_hookean));
  int at_rest = 0;   // iterates
  stepper.begin_static();
  while (stepper.phase() == StepPhase::begun || stepper.phase() == StepPhase::updated) {
    stepper.linearise();
    stepper.solve();
    stepper.update();
    at_rest += stepper.iterate().cwiseAbs().maxCoeff() == 0.0;
  }
  ASSERT_EQ(stepper.phase(), StepPhase::converged);
  EXPECT_EQ(at_rest, 1);
  EXPECT_TRUE(stepper.accept().converged());
}

}  // namespace
}  // namespace brainshift
