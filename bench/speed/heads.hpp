// The head that benchmarks run on.
#pragma once

#include <benchmark/benchmark.h>

#include "scene.hpp"

namespace bench {

// Read once, from the folder the program was given; throws brainshift::Error.
const dbs::Head& head();

// One numeric factor and one solve of the stiffness of the head at rest: what all times are given in.
void yardstick(benchmark::State& state);

}  // namespace bench
