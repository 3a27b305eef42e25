// Steps that are too long, too short, too sudden, or ask for more than arithmetic has.
#include <ctime>
#include <limits>

#include "robustness/outcome.hpp"

namespace brainshift::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

// A cube in fluid on soft feet, in its case.
Scene in_fluid() { return busy_scene(2, 0.3); }

// Under gravity for the first time: released from rest.
Scene released(Law law = Law::stable_neo_hookean) { return cube_on_base(law); }

TEST(TimeStepping, T1_steps_that_are_none_and_steps_of_any_length) {
  Stepper stepper(released());
  for (const double dt : {0.0, -0.0, -1e-9, nan, infinity, -infinity})
    expect_error(ErrorCode::invalid_argument, {"dt"}, [&] { stepper.step(dt); });
  // Below what rounding of positions resolves a status says so; nothing is frozen or lost.
  const ShownState before(stepper);
  const SolveReport report = stepper.step(1e-12);
  if (!report.converged()) {
    EXPECT_NE(report.message.find("time step"), std::string::npos);
    EXPECT_TRUE(ShownState(stepper) == before);
  }
  // A short step changes velocities by g dt, a very long one is the static solve.
  Stepper brief(released());
  expect_converged(brief.step(1e-4));
  EXPECT_LE(largest(brief.velocity()), 1.001 * standard_gravity * 1e-4);
  Stepper slow(released()), rest(released());
  expect_converged(slow.step(1e6));
  expect_converged(rest.solve_static());
  EXPECT_LE(largest_distance(slow.displacement(), rest.displacement()), 1e-6);
}

TEST(TimeStepping, T2_a_sudden_load_in_long_steps_gains_no_energy) {
  for (const Law law : {Law::corotational, Law::stable_neo_hookean, Law::log_neo_hookean}) {
    for (const double dt : {0.003, 0.1}) {
      Scene scene = cube_on_base(law, {0.5 * standard_gravity, 0.0, -standard_gravity});
      Stepper stepper(scene);
      double before = 0.0;
      for (int i = 0; i < 10; ++i) {
        const SolveReport r = stepper.step(dt);
        expect_converged(r);
        const double now = total_energy(stepper, r);
        EXPECT_LE(now, before + 1e-9 * (r.energy + r.kinetic_energy)) << to_string(law) << dt;
        before = now;
      }
    }
  }
}

// The damping of the method is numerical: what remains of a motion depends on dt, of order one.
TEST(TimeStepping, T3_the_error_halves_with_the_step) {
  Points end[4];
  for (int k = 0; k < 4; ++k) {
    Stepper stepper(released());
    const int steps = 40 << k;
    for (int i = 0; i < steps; ++i) ASSERT_TRUE(stepper.step(0.02 / steps).converged());
    end[k] = stepper.displacement();
  }
  const double ratio = largest_distance(end[2], end[3]) / largest_distance(end[1], end[2]);
  EXPECT_NEAR(ratio, 0.5, 0.08);
}

TEST(TimeStepping, T4_another_step_length_uses_nothing_of_the_last) {
  Stepper stepper(released()), fresh(released());
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(stepper.step(0.002).converged());
  fresh.restore(stepper.snapshot());  // the state, and none of its factors
  for (const double dt : {0.02, 0.0005, 1.0}) {
    ASSERT_TRUE(stepper.step(dt).converged());
    ASSERT_TRUE(fresh.step(dt).converged());
    EXPECT_TRUE(ShownState(stepper) == ShownState(fresh)) << dt;
  }
}

TEST(TimeStepping, T5_the_level_falls_from_the_top_to_below_the_body_in_one_step) {
  for (const bool in_time : {false, true}) {
    Stepper stepper(in_fluid());
    stepper.csf().set_level(0, -2.0);
    const SolveReport report = in_time ? stepper.step(0.05) : stepper.solve_static();
    expect_converged(report);
    EXPECT_GE(report.load_steps, 1);
    EXPECT_NEAR(stepper.compartment(0).head, -2.0, 1e-12);
    EXPECT_TRUE(stepper.fluid_force().isZero(0.0));
  }
}

// A body as heavy as its fluid, fully under it: no load at all, and nothing that holds it. With three
// points held (3-2-1) they carry nothing.
TEST(TimeStepping, T6_neutral_buoyancy_is_no_equilibrium_without_a_support) {
  Scene scene = in_fluid();
  scene.constraints = {};
  scene.balanced_reference = false;
  // Stiff: a soft one is squeezed, displaces less than it weighs, and sinks.
  scene.materials = {{0, Material(Law::corotational, 6e6, 0.45, fluid_density)}};
  expect_error(ErrorCode::rigid_mode, {"6 rigid"}, [&] { Stepper(scene).solve_static(); });
  scene.constraints.fix("three", {0});
  scene.constraints.fix("two", {2}, {false, true, true});
  scene.constraints.fix("one", {6}, {false, false, true});
  Stepper stepper(scene);
  expect_converged(stepper.solve_static());
  const Points reaction = stepper.internal_force() - stepper.external_force();
  const double weight = fluid_density * 27000.0 * standard_gravity;  // mN
  // 0.3 kPa of pressure over a bulk modulus of 2e7 kPa, and what the tolerance leaves.
  EXPECT_LE(reaction.cwiseAbs().maxCoeff(), 3e-8 * weight);
  EXPECT_LE(reaction.colwise().sum().norm(), 3e-8 * weight);
}

TEST(TimeStepping, T7_a_body_at_rest_stays_there) {  // 10^6 steps: soak
  Stepper stepper(in_fluid());
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(stepper.step(0.01).converged());
  EXPECT_LE(largest(stepper.displacement()), 1e-12 * stepper.mesh().diameter());
}

TEST(TimeStepping, T8_iterations_that_run_out_are_said) {
  StepperOptions options;
  options.max_iterations = 1;
  options.smallest_load_step = 1.0;
  Stepper stepper(released(), options);
  const ShownState before(stepper);
  const SolveReport report = stepper.solve_static();
  EXPECT_EQ(report.status, Status::not_converged);
  EXPECT_GT(report.residual, options.residual_tolerance);
  EXPECT_NE(report.message.find("max_iterations"), std::string::npos) << report.message;
  EXPECT_TRUE(ShownState(stepper) == before);
}

// There is no flag for "as good as rounding allows": a tolerance below it is not met, and the status
// and the residual that was reached say so, in a bounded number of iterations.
TEST(TimeStepping, T9_a_tolerance_below_rounding_ends) {
  StepperOptions options;
  options.residual_tolerance = 1e-30;
  Stepper stepper(released(), options);
  const SolveReport report = stepper.solve_static();
  expect_failed(report);
  EXPECT_LE(report.residual, 1e-12);
  EXPECT_LT(report.iterations, 60 * 20);
  options.residual_tolerance = 0.0;
  EXPECT_THROW(Stepper(released(), options), Error);
}

TEST(TimeStepping, T10_without_load_there_is_nothing_to_do) {
  Scene scene = released();
  scene.gravity.setZero();
  Stepper stepper(scene);
  const SolveReport report = stepper.solve_static();
  expect_converged(report);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(report.factorisations, 0);
  EXPECT_TRUE(stepper.displacement().isZero(0.0));
}

// Numbers below 2e-308 are slow on some processors: a scene that all but rests must not be.
TEST(TimeStepping, T11_denormal_velocities_cost_no_time) {
  const auto fastest = [](double speed) {
    Scene scene = busy_scene(4, 0.3);
    Points v = Points::Constant(scene.mesh.node_count(), 3, speed);
    clock_t best = std::numeric_limits<clock_t>::max();
    for (int repeat = 0; repeat < 5; ++repeat) {
      Stepper stepper(scene);
      stepper.set_velocity(v);
      const clock_t begin = clock();
      for (int i = 0; i < 5; ++i) EXPECT_TRUE(stepper.step(0.01).converged());
      best = std::min(best, clock() - begin);
    }
    return double(best);
  };
  EXPECT_LE(fastest(1e-310), 1.2 * fastest(1.0));
}

}  // namespace
}  // namespace brainshift::test
