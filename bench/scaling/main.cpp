// Solves one case and writes as JSON what it took of time and memory: a process of its own for each, so that
// the peak is its own.
//
// Run: build/release/bench/bench_scaling HEADS '{"scene": "block", "cells": 17, "candidates": 1000}'
//   HEADS: the folder of the heads, examples/head/data
//   scene: yardstick   a factor and a solve of the medium head's stiffness
//          block       cells, candidates, leads, depth (mm), gravity (1: the Earth's), threads; see
//                      tests/support/walled_block.hpp
//          procedure   head, threads: the stages of both sides to 0.1 mm
//          branches    head, count: that many other trajectories from one state, all kept
// bench/scaling/run goes through them all.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "clock.hpp"
#include "procedure.hpp"
#include "scaling/resident.hpp"
#include "speed/rest.hpp"
#include "support/walled_block.hpp"

namespace {

using namespace dbs;
using bench::Clock;
using nlohmann::json;

constexpr double accuracy = 0.1;   // mm
constexpr double room = 2.0;       // mm between block and walls

json to_json(const MemoryEstimate& m) {
  return {{"factor", m.factor}, {"border", m.border}, {"compliance", m.compliance}, {"rest", m.rest}, {"total", m.total}};
}

// What a number of solves took.
struct Work {
  int solves = 0, iterations = 0, factorisations = 0;
  Index contacts = 0, rows = 0;   // the most
  void add(const SolveReport& report) {
    if (!report.converged()) throw Error(ErrorCode::internal, "a solve found no balance: " + report.message);
    ++solves;
    iterations += report.iterations;
    factorisations += report.factorisations;
    contacts = std::max(contacts, report.active_contacts);
    rows = std::max(rows, report.coupling_rows);
  }
  json to_json() const {
    return {{"solves", solves}, {"iterations", iterations}, {"factorisations", factorisations},
            {"active_contacts", contacts}, {"coupling_rows", rows}};
  }
};

json with_mesh(json result, const Mesh& mesh) {
  result["nodes"] = mesh.node_count();
  result["tets"] = mesh.tet_count();
  result["unknowns"] = 3 * mesh.node_count();
  return result;
}

void take(json& result, const Clock& clock, const bench::ResidentPeak& memory) {
  result["cpu_seconds"] = clock.cpu();
  result["wall_seconds"] = clock.wall();
  result["resident_rise"] = memory.rise();
}

json yardstick(const std::string& heads) {
  const Head head = read_head(heads + "/medium");
  bench::Rest rest(head);
  std::vector<double> seconds;
  for (int i = 0; i < 3; ++i) {
    Eigen::MatrixXd x = Eigen::MatrixXd::Ones(rest.unknowns(), 1);
    const Clock clock;
    if (!rest.solver->factorise(rest.tangent)) throw Error(ErrorCode::internal, "the head at rest is not stable");
    rest.solver->solve(x);
    seconds.push_back(clock.cpu());
  }
  std::sort(seconds.begin(), seconds.end());
  return {{"cpu_seconds", seconds[1]}};
}

json block(const json& asked) {
  const int candidates = asked.value("candidates", 0), leads = asked.value("leads", 0);
  StepperOptions options;
  options.threads = asked.value("threads", 1);
  Scene scene = test::walled_block(asked.at("cells"), candidates, room);
  scene.gravity *= asked.value("gravity", 1.0);
  Stepper stepper(scene, options);
  test::insert_leads(stepper, leads, asked.value("depth", 45.0));
  const bench::ResidentPeak memory;
  const MemoryEstimate estimate = stepper.memory_estimate();
  const Clock clock;
  Work work;
  work.add(stepper.solve_static());
  json result = with_mesh(work.to_json(), scene.mesh);
  take(result, clock, memory);
  result["candidates"] = candidates;
  result["estimate"] = to_json(estimate);
  return result;
}

Options quiet(const json& asked) {
  Options options;
  options.quiet = true;
  options.accuracy = accuracy;
  options.threads = asked.value("threads", 1);
  return options;
}

json procedure_of_both_sides(const std::string& heads, const json& asked) {
  const Head head = read_head(heads + "/" + asked.at("head").get<std::string>());
  Procedure procedure(head, quiet(asked));
  const bench::ResidentPeak memory;
  const Clock clock;
  Work work;
  MemoryEstimate largest;
  for (const Stage& stage : procedure.plan()) {
    work.add(procedure.run(stage).report);
    const MemoryEstimate now = procedure.stepper().memory_estimate();
    if (now.total > largest.total) largest = now;
  }
  json result = with_mesh(work.to_json(), head.brain);
  take(result, clock, memory);
  result["estimate"] = to_json(largest);
  return result;
}

// Stages 2 to 5 of the right side, each time two tenths of a millimetre further beside; every branch is kept.
json branches(const std::string& heads, const json& asked) {
  const Head head = read_head(heads + "/" + asked.at("head").get<std::string>());
  Options options = quiet(asked);
  options.sides = "right";
  Procedure procedure(head, options);
  for (const Stage& stage : procedure.plan()) {
    if (stage.label < "2") procedure.run(stage);
  }
  const auto before = procedure.branch();
  std::vector<std::shared_ptr<const Procedure::Branch>> kept;
  Work work;
  const bench::ResidentPeak memory;
  const Clock clock;
  for (int i = 0; i < asked.at("count").get<int>(); ++i) {
    procedure.go_back_to(before);
    options.offset_right = {0.2 * i, 0.0, 0.0};
    procedure.replan(options);
    for (const Stage& stage : procedure.plan()) {
      if (stage.label >= "2" && stage.label <= "5") work.add(procedure.run(stage).report);
    }
    kept.push_back(procedure.branch());
  }
  json result = with_mesh(work.to_json(), head.brain);
  take(result, clock, memory);
  result["kept"] = kept.size();
  return result;
}

json run(const std::string& heads, const json& asked) {
  const std::string scene = asked.at("scene");
  if (scene == "yardstick") return yardstick(heads);
  if (scene == "block") return block(asked);
  if (scene == "procedure") return procedure_of_both_sides(heads, asked);
  if (scene == "branches") return branches(heads, asked);
  throw Error(ErrorCode::invalid_argument, "there is no scene '" + scene + "'");
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fprintf(stderr, "bench_scaling: give the folder of the heads and a case as JSON\n");
    return 1;
  }
  std::printf("%s\n", run(argv[1], json::parse(argv[2])).dump(1).c_str());
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_scaling: %s\n", e.what());
  return 1;
}
