// A clamped bar of tissue, 200 x 40 x 40 mm in 5n x n x n cells of six tets, E 6 kPa, nu 0.45: a scene with
// published times of other programs. Times are CPU seconds of one thread, so that they bear a busy machine.
#include <algorithm>
#include <optional>
#include <string>

#include <benchmark/benchmark.h>

#include "brainshift/brainshift.hpp"
#include "clock.hpp"
#include "linear/spd_solver.hpp"
#include "stiffness_at_rest.hpp"
#include "support/scenes.hpp"

namespace {

using namespace brainshift;
using bench::Clock;

Scene bar(Index n, Law law) {
  Scene scene{test::make_mesh(test::make_box({200.0, 40.0, 40.0}, 5 * n, n, n)),
              {{0, Material(law, 6.0, 0.45, test::tissue_density)}}};
  scene.balanced_reference = false;
  scene.gravity = {0.0, 0.0, -0.1 * standard_gravity};
  scene.constraints.fix("wall", test::nodes_where(scene.mesh, [](const Vec3& x) { return x.x() == 0.0; }));
  return scene;
}

void tell(benchmark::State& state, const Stepper& stepper, const SolveReport& report) {
  if (!report.converged()) throw Error(ErrorCode::internal, "no balance: " + report.message);
  state.counters["nodes"] = stepper.mesh().node_count();
  state.counters["iterations_of_newton"] = report.iterations;
  state.counters["factorisations"] = report.factorisations;
  state.counters["contacts"] = report.active_contacts;
}

// Numeric factor and one solve of its stiffness, and nothing else.
void bar_factor_and_solve(benchmark::State& state) {
  const Scene scene = bar(Index(state.range(0)), Law::corotational);
  const BlockMatrix A = bench::stiffness_at_rest(scene);
  const auto solver = make_spd_solver();
  solver->analyse(A);
  Eigen::MatrixXd x = Eigen::MatrixXd::Ones(3 * Eigen::Index(A.blocks()), 1);
  for (auto _ : state) {
    const Clock clock;
    solver->factorise(A);
    solver->solve(x);
    state.SetIterationTime(clock.cpu());
  }
}

// One linearisation of a step in time, as in 2011: tolerances that the first iterate meets.
StepperOptions one_linearisation() {
  StepperOptions options;
  options.residual_tolerance = options.complementarity_tolerance = 10.0;
  options.correction_tolerance = 1e9;
  return options;
}

void time_steps(benchmark::State& state, Stepper& stepper) {
  stepper.step(0.01);   // the analysis is made once
  SolveReport report;
  for (auto _ : state) {
    const Clock clock;
    report = stepper.step(0.01);
    state.SetIterationTime(clock.cpu());
  }
  tell(state, stepper, report);
}

void bar_step(benchmark::State& state) {
  Stepper stepper(bar(Index(state.range(0)), Law::corotational), one_linearisation());
  time_steps(state, stepper);
}

// The same on a floor that as many nodes of its lower side are pressed onto.
void bar_step_on_floor(benchmark::State& state) {
  Scene scene = bar(Index(state.range(0)), Law::corotational);
  Indices below = test::nodes_where(scene.mesh, [](const Vec3& x) { return x.z() == 0.0 && x.x() > 0.0; });
  below.resize(std::min(below.size(), std::size_t(state.range(1))));
  const auto box = test::box_wall({-50.0, -50.0, 0.0}, {250.0, 90.0, 100.0});
  const ConstraintId floor = scene.constraints.obstacle("floor", below, Surface::cavity(box.points, box.triangles));
  Stepper stepper(scene, one_linearisation());
  time_steps(state, stepper);
  const Points force = stepper.contact(floor).force;
  state.counters["contacts"] = double((force.col(2).array() > 0.0).count());
}

// A tenth of its weight in ten increments.
void bar_sags(benchmark::State& state) {
  int most = 0, all = 0, factors = 0;
  std::optional<Stepper> stepper;
  SolveReport report;
  for (auto _ : state) {
    stepper.emplace(bar(Index(state.range(0)), Law::st_venant_kirchhoff));
    const Vec3 weight{0.0, 0.0, -0.1 * standard_gravity};
    const Clock clock;
    for (int i = 1; i <= 10; ++i) {
      stepper->set_gravity(0.1 * i * weight);
      report = stepper->solve_static();
      most = std::max(most, report.iterations);
      all += report.iterations;
      factors += report.factorisations;
    }
    state.SetIterationTime(clock.cpu());
  }
  tell(state, *stepper, report);
  state.counters["most_in_an_increment"] = most;
  state.counters["iterations_of_newton"] = all;
  state.counters["factorisations"] = factors;
}

}  // namespace

#define BAR(name) BENCHMARK(name)->Unit(benchmark::kMillisecond)->UseManualTime()
BAR(bar_factor_and_solve)->Arg(6)->Arg(9)->Arg(14)->Iterations(3);
BAR(bar_step)->Arg(6)->Arg(9)->Arg(14)->Iterations(3);
BAR(bar_step_on_floor)->Args({9, 300})->Iterations(3);
BAR(bar_sags)->Arg(6)->Iterations(1);
