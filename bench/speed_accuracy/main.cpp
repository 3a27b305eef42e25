// Solves one case and writes as JSON what it cost and how its probes moved.
//
// Run: build/release/bench/bench_speed_accuracy HEADS '{"head": "coarse", "accuracy": 0.1}'
//   HEADS: the folder of the heads, examples/head/data; case.hpp has what a case is made of
// bench/speed_accuracy/run draws the chart of many of them.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>

#include <nlohmann/json.hpp>

#include "brainshift/version.hpp"
#include "case.hpp"
#include "speed/rest.hpp"

namespace {

using bench::Case, bench::Outcome, bench::Probe, bench::Rest;
using nlohmann::json;

// CPU seconds of one factor and one solve of the medium head's stiffness.
void take_yardsticks(Rest& rest, std::vector<double>& seconds) {
  for (int i = 0; i < 3; ++i) {
    Eigen::MatrixXd x = Eigen::MatrixXd::Ones(rest.unknowns(), 1);
    const std::clock_t begin = std::clock();
    rest.solver->factorise(rest.tangent);
    rest.solver->solve(x);
    seconds.push_back(double(std::clock() - begin) / CLOCKS_PER_SEC);
  }
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

json to_json(const dbs::Vec3& v) { return {v.x(), v.y(), v.z()}; }

json to_json(const bench::Solved& solved, const std::vector<Probe>& probes) {
  json shift = json::object(), tips = json::object();
  for (std::size_t i = 0; i < probes.size(); ++i) shift[probes[i].name] = to_json(solved.shift[i]);
  for (const auto& [name, tip] : solved.tips) tips[name] = to_json(tip);
  const brainshift::SolveReport& r = solved.report;
  return {{"stage", solved.stage}, {"status", to_string(r.status)}, {"message", r.message},
          {"iterations", r.iterations}, {"factorisations", r.factorisations}, {"seconds", r.seconds},
          {"shift_mm", shift}, {"tip_from_target_mm", tips}};
}

json to_json(const Outcome& outcome, const std::vector<Probe>& probes) {
  json stages = json::array(), where = json::array();
  for (const bench::Solved& solved : outcome.stages) stages.push_back(to_json(solved, probes));
  for (const Probe& p : probes) where.push_back({{"name", p.name}, {"kind", p.kind}, {"point", to_json(p.point)}});
  return {{"library", BRAINSHIFT_VERSION}, {"air_mL", bench::air}, {"nodes", outcome.nodes}, {"tets", outcome.tets},
          {"probes", where}, {"stages", stages}, {"setup_cpu_seconds", outcome.setup_cpu},
          {"cpu_seconds", outcome.cpu}, {"wall_seconds", outcome.wall}};
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fprintf(stderr, "bench_speed_accuracy: give the folder of the heads and a case as JSON\n");
    return 1;
  }
  const std::string heads = argv[1];
  const Case wanted = bench::case_from(json::parse(argv[2]));
  const dbs::Head head = dbs::read_head(heads + "/" + wanted.head);
  const std::vector<Probe> probes = bench::probes(head);
  Rest rest(dbs::read_head(heads + "/medium"));
  std::vector<double> yardsticks;
  take_yardsticks(rest, yardsticks);
  const Outcome outcome = bench::run(head, wanted, probes);
  take_yardsticks(rest, yardsticks);   // again: what else the machine does may have changed
  json result = to_json(outcome, probes);
  result["yardstick_cpu_seconds"] = median(yardsticks);
  std::printf("%s\n", result.dump(1).c_str());
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_speed_accuracy: %s\n", e.what());
  return 1;
}
