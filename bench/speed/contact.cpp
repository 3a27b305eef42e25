// What contact candidates cost a scene that has an equilibrium without them: a block of tissue, its base
// held, leans under a tilted gravity, and nodes of it are kept within walls that some of them reach.
#include <benchmark/benchmark.h>

#include "brainshift/brainshift.hpp"
#include "clock.hpp"
#include "speed/one_iteration.hpp"
#include "support/walled_block.hpp"

namespace {

using namespace brainshift;

void candidates(benchmark::State& state) {
  const Scene scene = test::walled_block(17, Index(state.range(0)));
  SolveReport report;
  for (auto _ : state) {
    Stepper stepper(scene);
    const bench::Clock clock;   // CPU seconds bear a busy machine
    report = stepper.solve_static();
    state.SetIterationTime(clock.cpu());
    if (!report.converged()) throw Error(ErrorCode::internal, "no balance: " + report.message);
  }
  state.counters["nodes"] = scene.mesh.node_count();
  state.counters["contacts"] = report.active_contacts;
  state.counters["iterations_of_newton"] = report.iterations;
  state.counters["factorisations"] = report.factorisations;
}

// The first Newton iteration of that, with its changes of contact, and given up then. In whole solves the factor
// of a block that nothing touches serves to the end, and that of one in contact does not.
void iteration_with_candidates(benchmark::State& state) {
  const Scene scene = test::walled_block(17, Index(state.range(0)));
  Stepper stepper(scene);
  bench::time_first_iteration(state, stepper, [&] { stepper.begin_static(); });
}

}  // namespace

BENCHMARK(iteration_with_candidates)->Arg(0)->Arg(5000)
    ->Unit(benchmark::kMillisecond)->Iterations(5)->UseManualTime();
BENCHMARK(candidates)->Arg(0)->Arg(100)->Arg(1000)->Arg(5000)->Arg(10000)
    ->Unit(benchmark::kMillisecond)->Iterations(1)->UseManualTime();
