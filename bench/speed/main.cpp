// Run: build/release/bench/bench_speed examples/head/data/medium [--benchmark_... of Google Benchmark]
// bench/speed/run does so and gives the times in yardsticks.
#include <cstdio>
#include <string>

#include <benchmark/benchmark.h>

#include "speed/heads.hpp"

extern "C" char* openblas_get_config(void) __attribute__((weak));

namespace {
std::string folder;
}

const dbs::Head& bench::head() {
  static const dbs::Head read = dbs::read_head(folder);
  return read;
}

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    std::fprintf(stderr, "bench_speed: give the folder of a head\n");
    return 1;
  }
  folder = argv[1];
  try {
    benchmark::AddCustomContext("head", bench::head().name);
    benchmark::AddCustomContext("nodes", std::to_string(bench::head().brain.node_count()));
    benchmark::AddCustomContext("tets", std::to_string(bench::head().brain.tet_count()));
    benchmark::AddCustomContext("blas", openblas_get_config ? openblas_get_config() : "not OpenBLAS");
    benchmark::AddCustomContext("compiler", __VERSION__);
    // A machine that others use does not keep its speed: the yardstick counts from before and after.
    benchmark::RegisterBenchmark("yardstick_after", bench::yardstick)->Unit(benchmark::kMillisecond);
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_speed: %s\n", e.what());
    return 1;
  }
  return 0;
}
