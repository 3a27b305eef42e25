// Very many steps: memory flat, nothing drifts, energy never rises without load. Label: long.
#include <cstdio>

#include "brainshift/brainshift.hpp"
#include "robustness/outcome.hpp"
#include "robustness/procedure.hpp"

namespace brainshift::test {
namespace {

// kB in memory now.
long resident() {
  long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%*d %ld", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * 4;
}

constexpr int steps = 1000000;

Scene one_cell(const Vec3& gravity) { return cube_on_base(Law::corotational, gravity, 1); }

TEST(Soak, T7_a_million_steps_at_rest) {
  Stepper stepper(one_cell(Vec3::Zero()));
  long early = 0;
  for (int i = 0; i < steps; ++i) {
    const SolveReport report = stepper.step(0.01);
    ASSERT_TRUE(report.converged()) << i << ": " << report.message;
    if (i == steps / 10) early = resident();
  }
  EXPECT_LE(largest(stepper.displacement()), 1e-12 * stepper.mesh().diameter());
  EXPECT_LE(resident(), early + 200);
}

// Thrown once, nothing drives it: energy falls or stays, to where the body hangs in balance.
TEST(Soak, AMillionStepsOfAMotionThatDiesOut) {
  Stepper stepper(one_cell({0, 0, -standard_gravity})), rest(one_cell({0, 0, -standard_gravity}));
  Points v = Points::Zero(8, 3);
  v.bottomRows(4).col(0).setConstant(200.0);
  stepper.set_velocity(v);
  double before = std::numeric_limits<double>::infinity(), worst = 0.0;
  long early = 0;
  for (int i = 0; i < steps; ++i) {
    const SolveReport report = stepper.step(0.001);
    ASSERT_TRUE(report.converged()) << i << ": " << report.message;
    const double now = total_energy(stepper, report);
    if (i > 0) worst = std::max(worst, (now - before) / (report.energy + report.kinetic_energy));
    before = now;
    if (i == steps / 10) early = resident();
  }
  std::printf("soak: energy rises by %.1e of itself at most; memory by %ld kB\n", worst,
              resident() - early);
  EXPECT_LE(worst, 1e-9);
  EXPECT_LE(resident(), early + 200);
  expect_converged(rest.solve_static());
  EXPECT_LE(largest_distance(stepper.displacement(), rest.displacement()), 1e-8);
}

// The same brain, a thousand trajectories tried and taken back.
TEST(Soak, AThousandTrajectoriesFromOneState) {
  Stepper stepper(busy_scene(3, 0.3));
  stepper.csf().set_lost_volume(0, 3000.0);
  expect_converged(stepper.solve_static());
  const auto kept = stepper.snapshot();
  const Points before = stepper.displacement();
  Points first;
  long early = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = 8.0 + 14.0 * (i % 10) / 10.0;
    const DeviceId id =
        stepper.insert(make_device("3389", 40.0), {Vec3(x, 15.7, 9.1), Vec3::UnitZ()}, {0.0, 38.0});
    stepper.csf().set_lost_volume(0, 6000.0);
    ASSERT_TRUE(stepper.solve_static().converged()) << i;
    if (i == 0) first = stepper.displacement();
    EXPECT_TRUE(i % 10 != 0 || same_bits(stepper.displacement(), first)) << i;
    stepper.remove(id);
    stepper.restore(kept);
    ASSERT_TRUE(same_bits(stepper.displacement(), before));
    if (i == 100) early = resident();
  }
  std::printf("soak: a thousand trajectories, memory grows by %ld kB\n", resident() - early);
  EXPECT_LE(resident(), early + 500);
}

}  // namespace
}  // namespace brainshift::test
