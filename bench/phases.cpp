// What one Newton iteration on a head costs, phase by phase, and in yardsticks: one numeric factor
// and one solve of the whole tissue's stiffness.
//
// Run: build/release/bench/bench_phases examples/head/data/medium
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <vector>

#include "linear/spd_solver.hpp"
#include "scene.hpp"
#include "stepper/equilibrium.hpp"

namespace {

// Median seconds of five calls.
double seconds(const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < 5; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    times.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(times.begin(), times.end());
  return times[2];
}

}  // namespace

int main(int argc, char** argv) {
  using namespace dbs;
  if (argc != 2) {
    std::fprintf(stderr, "bench_phases: give the folder of a head\n");
    return 1;
  }
  const Head head = read_head(argv[1]);
  SceneIds ids;
  const Equilibrium balance(make_scene(head, Options{}, ids));
  const Points u = Points::Zero(head.brain.node_count(), 3);
  BlockMatrix K = balance.blocks().make_matrix();
  const Forces forces = balance.forces(u);
  const std::vector<double> multipliers(balance.contacts().size(), 0.0);
  const auto solver = make_spd_solver();
  Eigen::MatrixXd x = Eigen::MatrixXd::Ones(3 * balance.blocks().count(), 1);

  const double force = seconds([&] { balance.forces(u); });
  const double tangent = seconds([&] { balance.tangent(u, forces, multipliers, false, K); });
  const double analysis = seconds([&] { solver->analyse(K); });
  const double factor = seconds([&] { solver->factorise(K); });
  const double solve = seconds([&] { solver->solve(x); });
  const double yardstick = factor + solve;
  std::printf("%d nodes, %d tets, %d unknowns; median of five, one thread\n",
              head.brain.node_count(), head.brain.tet_count(), 3 * balance.blocks().count());
  const auto line = [yardstick](const char* phase, double t) {
    std::printf("%-22s %9.2f ms %8.3f yardsticks\n", phase, 1e3 * t, t / yardstick);
  };
  line("forces and gaps", force);
  line("tangent", tangent);
  line("symbolic analysis", analysis);
  line("numeric factor", factor);
  line("one solve", solve);
  return 0;
}
