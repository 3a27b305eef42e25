// The first Newton iteration of a solve, timed and given up: CPU seconds of one thread.
#pragma once

#include <benchmark/benchmark.h>

#include "brainshift/stepper.hpp"
#include "clock.hpp"

namespace bench {

// begin: of a solve, not timed.
template <class Begin>
void time_first_iteration(benchmark::State& state, brainshift::Stepper& stepper, const Begin& begin) {
  for (auto _ : state) {
    begin();
    const Clock clock;
    stepper.linearise();
    stepper.solve();
    stepper.update();
    state.SetIterationTime(clock.cpu());
    state.counters["factorisations"] = stepper.progress_report().factorisations;
    stepper.reject();
  }
}

}  // namespace bench
