// Whole solves on a head: fluid lost, the procedure of both sides, and another trajectory for one of them.
#include <cmath>

#include <benchmark/benchmark.h>
#include <Eigen/Geometry>

#include "procedure.hpp"
#include "speed/heads.hpp"
#include "speed/one_iteration.hpp"

namespace {

using namespace dbs;

// Arguments of every scene: threads, and the accuracy in micrometres (0: as exact as can be).
Options quiet(const benchmark::State& state) {
  Options options;
  options.threads = int(state.range(0));
  options.accuracy = 1e-3 * double(state.range(1));
  options.quiet = true;
  return options;
}

struct Work {
  int solves = 0, iterations = 0, factorisations = 0;
  void add(const SolveReport& report) {
    if (!report.converged()) throw Error(ErrorCode::internal, "a stage found no balance: " + report.message);
    ++solves;
    iterations += report.iterations;
    factorisations += report.factorisations;
  }
  void tell(benchmark::State& state) const {
    state.counters["solves"] = solves;
    state.counters["iterations_of_newton"] = iterations;
    state.counters["factorisations"] = factorisations;
  }
};

Work run_all(Procedure& procedure, const std::vector<Stage>& plan) {
  Work work;
  for (const Stage& stage : plan) work.add(procedure.run(stage).report);
  return work;
}

// One Newton iteration of the brain in its skull, in a step of a second from balance: CPU seconds of one thread,
// beside the yardstick, which is the factor and the solve of this matrix. From a tilt of ten degrees the head is tilted
// on before the step, by five more or by so little that contacts stay; the step is given up after it.
void iteration(benchmark::State& state) {
  SceneIds ids;
  const Scene scene = make_scene(bench::head(), Options{}, ids);
  Stepper stepper(scene);
  const auto tilt = [&](double degrees) {
    stepper.set_gravity(Eigen::AngleAxisd(degrees * M_PI / 180.0, Vec3::UnitX()) * scene.gravity);
  };
  tilt(10.0);
  if (!stepper.solve_static().converged()) throw Error(ErrorCode::internal, "no balance to begin with");
  tilt(10.0 + 1e-3 * double(state.range(0)));
  bench::time_first_iteration(state, stepper, [&] { stepper.begin_step(1.0); });
}

// 20 mL lost on each side, no devices; from files to the last stage but for reading them.
void csf_loss(benchmark::State& state) {
  Options options = quiet(state);
  options.devices = false;
  Work work;
  for (auto _ : state) {
    Procedure procedure(bench::head(), options);
    work = run_all(procedure, procedure.plan());
  }
  work.tell(state);
}

void procedure_of_both_sides(benchmark::State& state) {
  Work work;
  for (auto _ : state) {
    Procedure procedure(bench::head(), quiet(state));
    work = run_all(procedure, procedure.plan());
  }
  work.tell(state);
}

// Stages 2 to 5 of the right side once more, two millimetres beside, from the state after stage 1.
void what_if(benchmark::State& state) {
  Options options = quiet(state);
  options.sides = "right";
  Procedure procedure(bench::head(), options);
  const std::vector<Stage> plan = procedure.plan();
  std::size_t done = 0;
  for (; done < plan.size() && plan[done].label != "2"; ++done) procedure.run(plan[done]);
  const auto before = procedure.branch();
  double beside = 0.0;
  Work work;
  for (auto _ : state) {
    procedure.go_back_to(before);
    beside += 2.0;
    options.offset_right = {beside, 0.0, 0.0};
    procedure.replan(options);
    work = {};
    for (const Stage& stage : procedure.plan()) {
      if (stage.label < "2" || stage.label > "5") continue;
      work.add(procedure.run(stage).report);
    }
  }
  work.tell(state);
}

}  // namespace

#define SCENE(name)                                                            \
  BENCHMARK(name)->ArgNames({"threads", "um"})->ArgsProduct({{1, 2}, {0, 100}}) \
      ->Unit(benchmark::kMillisecond)->Iterations(1)->UseRealTime()
BENCHMARK(iteration)->ArgName("millidegrees")->Arg(1)->Arg(5000)
    ->Unit(benchmark::kMillisecond)->Iterations(6)->UseManualTime();
SCENE(csf_loss);
SCENE(procedure_of_both_sides);
SCENE(what_if);
