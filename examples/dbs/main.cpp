// A deep brain stimulation procedure on a real head, as far as tissue and fluid go.
//
//   before surgery -> fluid lost through the right burr hole -> more while electrodes are tested
//   -> the same on the left -> fluid restored in the months after
//
// Build:  cmake -B build -DCMAKE_BUILD_TYPE=Release && cmake --build build --target dbs
// Run:    examples/run, or build/examples/dbs/dbs --head examples/head/data/medium
// Output: one line per stage; stages.json, stages.csv, stages.pvd (ParaView, 3D Slicer) in --out.
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "brainshift/io.hpp"
#include "results.hpp"

namespace {

int run(const dbs::Options& options) {
  using namespace dbs;
  const auto start = std::chrono::steady_clock::now();
  // 1. The head: meshes, node sets, landmarks.
  const Head head = read_head(options.head);
  print_head(head, options);
  // 2. The scene, and a stepper that owns its state.
  Procedure procedure(head, options);
  // 3. The stages, one solve each.
  std::vector<StageResult> stages;
  std::vector<std::pair<double, std::string>> series;
  if (options.files) prepare_folder(options.out);
  print_table_header();
  for (const auto& [number, title] : procedure.plan()) {
    stages.push_back(procedure.run(number, title));
    print_stage(stages.back());
    if (options.files && stages.back().report.converged()) {
      series.emplace_back(number, write_stage(options.out, head, procedure, number));
    }
    if (!stages.back().report.converged()) break;
  }
  // 4. What is left to look at.
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::printf("\n%.1f s in all\n", seconds.count());
  if (options.files) {
    write_tables(options.out, head, options, stages);
    io::write_pvd(options.out + "/stages.pvd", series);
    std::printf("results in %s: stages.json, stages.csv, stages.pvd (ParaView, 3D Slicer)\n",
                options.out.c_str());
  }
  return stages.back().report.converged() ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    dbs::Options options;
    const int code = dbs::parse(argc, argv, options);
    return code >= 0 ? code : run(options);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "dbs: %s\n", e.what());
    return 1;
  }
}
