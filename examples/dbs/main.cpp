// A deep brain stimulation procedure on a real head, from before the craniotomy to the months after.
//
//   before surgery -> fluid lost through the right burr hole -> cannula and electrode in -> more is
//   lost while they are tested -> cannula out -> the same on the left -> fluid restored in the months
//   after
//
// Build:  cmake -B build -DCMAKE_BUILD_TYPE=Release && cmake --build build --target dbs
// Run:    examples/run, or build/examples/dbs/dbs --head examples/head/data/medium
// Output: a line per stage and one per electrode; in --out: stages.json, stages.csv, electrodes.csv,
//         stages.pvd (ParaView), stage_*.vtu and stage_*.vtp (3D Slicer).
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "alternatives.hpp"
#include "brainshift/io.hpp"
#include "results.hpp"

namespace {

int run(const dbs::Options& options) {
  using namespace dbs;
  const auto start = std::chrono::steady_clock::now();
  // 1. The head: meshes, node sets, landmarks.
  const Head head = read_head(options.head, options.scale, options.gap);
  print_head(head, options);
  // 2. The scene, and a stepper that owns its state.
  Procedure procedure(head, options);
  // 3. The stages, one solve each.
  std::vector<StageResult> stages;
  Series brain, electrodes;
  if (options.files) prepare_folder(options.out);
  print_table_header();
  for (const Stage& stage : procedure.plan()) {
    stages.push_back(procedure.run(stage));
    const StageResult& result = stages.back();
    print_stage(result);
    if (!result.report.converged()) break;
    if (!options.files || !options.vtk) continue;
    brain.emplace_back(result.time, write_stage(options.out, head, procedure, stage.label));
    for (const std::string& name : write_electrodes(options.out, procedure, result)) {
      electrodes.emplace_back(result.time, name);
    }
  }
  print_electrodes(stages);
  // 4. What is left to look at.
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::printf("\n%.1f s in all\n", seconds.count());
  if (options.files) {
    write_tables(options.out, head, options, stages);
    if (options.vtk) {
      io::write_pvd(options.out + "/stages.pvd", brain);
      io::write_pvd(options.out + "/stages.electrodes.pvd", electrodes);
    }
    std::printf("results in %s: stages.json, stages.csv, electrodes.csv%s\n", options.out.c_str(),
                options.vtk ? "; stages.pvd and stages.electrodes.pvd for ParaView" : "");
  }
  return stages.back().report.converged() ? 0 : 2;
}

// --plan: no procedure in itself, but what to choose for one.
int plan(const dbs::Options& options) {
  using namespace dbs;
  const Head head = read_head(options.head, options.scale, options.gap);
  print_head(head, options);
  print_alternative_header();
  double asked = -1.0;
  const auto found = search_alternatives(head, options, [&asked](const Alternative& a) {
    if (asked < 0.0) asked = a.mean();
    print_alternative(a, asked);
  });
  const Alternative& best = best_of(found);
  std::printf("\nbest: %s, %.2f mm nearer; for its procedure add: %s\n", best.name.c_str(),
              asked - best.mean(), best.words.empty() ? "nothing" : best.words.c_str());
  if (options.files) {
    prepare_folder(options.out);
    write_alternatives(options.out, found);
    std::printf("results in %s: plan.json\n", options.out.c_str());
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    dbs::Options options;
    const int code = dbs::parse(argc, argv, options);
    if (code >= 0) return code;
    return options.plan ? plan(options) : run(options);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "dbs: %s\n", e.what());
    return 1;
  }
}
