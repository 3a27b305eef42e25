// What a device costs by its stiffness: a floppy lead and a steel cannula of the same length and elements on
// the same track, held at the burr hole, while fluid is lost and the brain sinks along them.
#include <ctime>
#include <string>

#include <benchmark/benchmark.h>

#include "speed/heads.hpp"
#include "trajectory.hpp"

namespace {

using namespace dbs;

constexpr double lost = 20e3;   // mm^3, on the side of the device

BeamDevice like_lead(const std::string& name, double length) {
  const BeamDevice lead = make_device("3389", length);
  if (name == "lead") return lead;
  return BeamDevice::straight(name, length, lead.element_count(), make_device(name, length).section(0));
}

void device(benchmark::State& state, const char* name) {
  const Head& head = bench::head();
  Options options;
  options.quiet = true;
  const Goal goal = plan_goal(head, options, right);
  const Trajectory line = aim_at(head, options, right, goal.point, goal.outward);
  const BeamDevice inserted = like_lead(name, line.length);
  Hold burr_hole;
  burr_hole.anchor = line.length;
  SolveReport report;
  double bow = 0.0;
  for (auto _ : state) {
    SceneIds ids;
    Stepper stepper(make_scene(head, options, ids));
    const DeviceId id = stepper.insert(inserted, {line.target, line.outward}, burr_hole);
    stepper.csf().set_lost_volume(stepper.csf().find(name_of(right)), lost);
    const std::clock_t begin = std::clock();   // CPU seconds bear a busy machine
    report = stepper.solve_static();
    state.SetIterationTime(double(std::clock() - begin) / CLOCKS_PER_SEC);
    if (!report.converged()) throw Error(ErrorCode::internal, "no balance: " + report.message);
    bow = stepper.device(id).bow;
  }
  state.counters["elements"] = inserted.element_count();
  state.counters["bending_mN_mm2"] = inserted.section(0).bending_2;
  state.counters["rows"] = report.coupling_rows;
  state.counters["bow_mm"] = bow;
  state.counters["iterations_of_newton"] = report.iterations;
  state.counters["factorisations"] = report.factorisations;
}

}  // namespace

BENCHMARK_CAPTURE(device, lead, "lead")->Unit(benchmark::kMillisecond)->Iterations(1)->UseManualTime();
BENCHMARK_CAPTURE(device, cannula, "cannula")->Unit(benchmark::kMillisecond)->Iterations(1)->UseManualTime();
