// Where a solve that has failed came: a balance under the part of the load that it names.
#include <gtest/gtest.h>

#include "robustness/outcome.hpp"

namespace brainshift::test {
namespace {

// Heavier than its material bears, whose law has a limit point. A slender one would buckle before it comes there.
Scene heavy_cube() {
  Scene scene = cube_on_base(Law::st_venant_kirchhoff);
  scene.gravity = {0.0, 0.0, -20.0 * standard_gravity};
  return scene;
}

Vec3 weight(double part) { return part * heavy_cube().gravity; }

// A balance by another way, from rest.
Points balance_under(double part) {
  Stepper stepper(heavy_cube());
  stepper.set_gravity(weight(part));
  expect_converged(stepper.solve_static());
  return stepper.displacement();
}

constexpr double same_balance = 1e-6;   // mm; corrections end at 4e-11 of 104 mm, and a limit point is near

TEST(Farthest, OfASolveThatFailedIsInBalanceUnderThePartOfTheLoadItNames) {
  Stepper stepper(heavy_cube());
  const SolveReport report = stepper.solve_static();
  ASSERT_EQ(report.status, Status::no_equilibrium) << report.message;
  ASSERT_GT(report.load_factor, 0.05);   // tests/robustness, A7
  EXPECT_TRUE(stepper.displacement().isZero(0.0));
  const Farthest& farthest = stepper.farthest();
  EXPECT_EQ(farthest.load_factor, report.load_factor);
  EXPECT_GT(largest(farthest.displacement), 1.0);
  EXPECT_LE(largest_distance(farthest.displacement, balance_under(report.load_factor)), same_balance);
}

TEST(Farthest, CountsTheLoadFromThatOfTheStateBefore) {
  Stepper stepper(heavy_cube());
  const double held = 0.05;
  stepper.set_gravity(weight(held));
  expect_converged(stepper.solve_static());
  const Points before = stepper.displacement();
  stepper.set_gravity(weight(1.0));
  const SolveReport report = stepper.solve_static();
  ASSERT_EQ(report.status, Status::no_equilibrium) << report.message;
  ASSERT_GT(report.load_factor, 0.0);
  EXPECT_TRUE(same_bits(stepper.displacement(), before));
  const double part = held + (1.0 - held) * report.load_factor;
  EXPECT_LE(largest_distance(stepper.farthest().displacement, balance_under(part)), same_balance);
}

TEST(Farthest, IsThatOfTheLastSolveAlone) {
  Stepper stepper(heavy_cube());
  const auto expect_none = [&](const char* when) {
    SCOPED_TRACE(when);
    expect_error(ErrorCode::invalid_argument, {"farthest", "failed"}, [&] { stepper.farthest(); });
  };
  expect_none("new");
  EXPECT_FALSE(stepper.solve_static().converged());
  EXPECT_GT(stepper.farthest().load_factor, 0.0);
  stepper.begin_static();
  expect_none("begun");
  stepper.reject();
  expect_none("rejected before it failed");
  stepper.set_gravity(weight(0.01));
  expect_converged(stepper.solve_static());
  expect_none("converged");
}

TEST(Farthest, OfASolveThatWasCancelledAtOnceIsTheStateBefore) {
  StepperOptions options;
  bool go_on = true;
  options.progress = [&](const Progress&) { return go_on; };
  Stepper stepper(heavy_cube(), options);
  stepper.set_gravity(weight(0.02));
  expect_converged(stepper.solve_static());
  stepper.set_gravity(weight(0.04));
  go_on = false;
  EXPECT_EQ(stepper.solve_static().status, Status::cancelled);
  EXPECT_EQ(stepper.farthest().load_factor, 0.0);
  EXPECT_TRUE(same_bits(stepper.farthest().displacement, stepper.displacement()));
}

}  // namespace
}  // namespace brainshift::test
