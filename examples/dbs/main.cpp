// A deep brain stimulation procedure on a real head, from before the craniotomy to the months after.
//
//   before surgery -> fluid lost through the right burr hole -> cannula and electrode in -> more is
//   lost while they are tested -> cannula out -> the same on the left -> fluid restored in the months
//   after
//
// Build:  cmake -B build -DCMAKE_BUILD_TYPE=Release && cmake --build build --target dbs
// Run:    examples/run, or build/examples/dbs/dbs --head examples/head/data/medium
// Output: a line per stage and one per electrode; in --out: stages.json, stages.csv, electrodes.csv,
//         stages.pvd (ParaView), stage_*.vtu and stage_*.vtp (3D Slicer); with --report a page. After
//         Ctrl-C, of the stages that were finished, without a page; exit status 130.
#include <chrono>
#include <cstdio>

#include "alternatives.hpp"
#include "brainshift/io.hpp"
#include "interrupt.hpp"
#include "page.hpp"
#include "progress.hpp"
#include "results.hpp"

namespace {

bool stop() { return dbs::interrupted() != 0; }

// Everything a run leaves behind, complete after every stage.
class Files {
 public:
  Files(const dbs::Head& head, const dbs::Options& options, const dbs::Procedure& procedure)
      : m_head(head), m_options(options), m_procedure(procedure) {}

  void add(const std::vector<dbs::StageResult>& stages) {
    if (!m_options.files) return;
    if (stages.size() == 1) dbs::prepare_folder(m_options.out);   // earlier results stay until there are new
    const dbs::StageResult& last = stages.back();
    if (m_options.vtk && last.report.converged()) {
      m_brain.emplace_back(last.time, write_stage(m_options.out, m_head, m_procedure, last.label));
      for (const std::string& name : write_electrodes(m_options.out, m_procedure, last)) {
        m_electrodes.emplace_back(last.time, name);
      }
      brainshift::io::write_pvd(m_options.out + "/stages.pvd", m_brain);
      brainshift::io::write_pvd(m_options.out + "/stages.electrodes.pvd", m_electrodes);
    }
    write_tables(m_options.out, m_head, m_options, m_procedure.plan(), stages);
  }

  void tell() const {
    if (!m_options.files) return;
    std::printf("results in %s: stages.json, stages.csv, electrodes.csv%s\n", m_options.out.c_str(),
                m_options.vtk ? "; stages.pvd and stages.electrodes.pvd for ParaView" : "");
  }

 private:
  const dbs::Head& m_head;
  const dbs::Options& m_options;
  const dbs::Procedure& m_procedure;
  dbs::Series m_brain, m_electrodes;
};

dbs::Head head_of(const dbs::Options& options) {
  dbs::Head head = dbs::read_head(options.head, options.scale, options.gap);
  if (!options.materials.empty()) head.parts = dbs::read_parts(options.materials);
  return head;
}

int run(const dbs::Options& options) {
  using namespace dbs;
  const auto start = std::chrono::steady_clock::now();
  check_page(options);
  // 1. The head: meshes, node sets, landmarks.
  const Head head = head_of(options);
  print_head(head, options);
  // 2. The scene, and a stepper that owns its state.
  ProgressMeter meter(options, 1, stop);
  Procedure procedure(head, options, &meter);
  // 3. The stages, one solve each; results are written as they come.
  std::vector<StageResult> stages;
  Files files(head, options, procedure);
  print_table_header();
  const Stage* interrupted_in = nullptr;
  for (const Stage& stage : procedure.plan()) {
    const bool before = stop();
    const StageResult result = before ? StageResult{} : procedure.run(stage);
    if (before || result.report.status == Status::cancelled) {
      interrupted_in = &stage;
      break;
    }
    stages.push_back(result);
    print_stage(result);
    files.add(stages);
    if (!result.report.converged()) break;
  }
  if (!stages.empty()) print_stage_notes();
  print_electrodes(stages);
  // 4. What is left to look at.
  const bool failed = !stages.empty() && !stages.back().report.converged();
  meter.end(interrupted_in ? "interrupted" : failed ? "failed" : "done");
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::printf("\n%.1f s in all\n", seconds.count());
  if (interrupted_in) print_interrupt(stages, *interrupted_in);
  if (!stages.empty()) files.tell();
  if (interrupted_in) return exit_status_of_interrupt();
  std::fflush(stdout);
  write_page(options);
  return failed ? 2 : 0;
}

void tell_best(const dbs::Options& options, const std::vector<dbs::Alternative>& found) {
  const dbs::Alternative& best = dbs::best_of(found);
  std::printf("\nbest: %s, %.2f mm nearer; for its procedure add: %s\n", best.name.c_str(),
              found.front().mean() - best.mean(), best.words.empty() ? "nothing" : best.words.c_str());
  if (!options.files) return;
  dbs::prepare_folder(options.out);
  dbs::write_alternatives(options.out, found);
  std::printf("results in %s: plan.json\n", options.out.c_str());
}

// --plan: no procedure in itself, but what to choose for one.
int plan(const dbs::Options& options) {
  using namespace dbs;
  check_page(options);
  const Head head = head_of(options);
  print_head(head, options);
  print_alternative_header();
  ProgressMeter meter(options, most_alternatives(options), stop);
  std::vector<Alternative> found;
  bool ended = false;
  try {
    search_alternatives(head, options, [&](const Alternative& a) {
      found.push_back(a);
      meter.procedure_ends();
      print_alternative(a, found.front().mean());
    }, &meter);
  } catch (const Interrupted&) {
    ended = true;
  }
  meter.end(ended ? "interrupted" : "done");
  if (ended) std::printf("\ninterrupted after %d choice%s\n", int(found.size()), found.size() == 1 ? "" : "s");
  if (!found.empty()) tell_best(options, found);
  return ended ? exit_status_of_interrupt() : 0;
}

}  // namespace

int main(int argc, char** argv) {
  dbs::Options options;
  try {
    const int code = dbs::parse(argc, argv, options);
    if (code >= 0) return code;
    dbs::catch_interrupts();
    return options.plan ? plan(options) : run(options);
  } catch (const std::exception& e) {
    dbs::say_error(dbs::progress_style(options), e.what());
    return 1;
  }
}
