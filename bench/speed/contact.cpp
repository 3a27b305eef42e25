// What contact candidates cost a scene that has an equilibrium without them: a block of tissue, its base
// held, leans under a tilted gravity, and nodes of it are kept within walls that some of them reach.
#include <algorithm>
#include <ctime>
#include <string>

#include <benchmark/benchmark.h>

#include "brainshift/brainshift.hpp"
#include "support/scenes.hpp"

namespace {

using namespace brainshift;

constexpr double side = 60.0;   // mm

Scene block(Index cells, Index candidates) {
  Scene scene{test::make_mesh(test::make_box({side, side, side}, cells, cells, cells)),
              {{0, Material(Law::corotational, 6.0, 0.45, test::tissue_density)}}};
  scene.balanced_reference = false;
  scene.gravity = standard_gravity * Vec3(0.6, 0.0, -0.8);
  scene.constraints.fix("base", test::nodes_where(scene.mesh, [](const Vec3& x) { return x.z() == 0.0; }));
  const auto wall = test::box_wall({-5.0, -5.0, -5.0}, {side + 5.0, side + 5.0, side + 5.0});
  const Surface cavity = Surface::cavity(wall.points, wall.triangles);
  Indices nodes = test::nodes_where(scene.mesh, [](const Vec3& x) { return x.z() > 0.0; });
  for (int group = 0; candidates > 0; ++group) {   // more candidates than nodes: several walls
    nodes.resize(std::min(nodes.size(), std::size_t(candidates)));
    scene.constraints.obstacle("wall " + std::to_string(group), nodes, cavity);
    candidates -= Index(nodes.size());
  }
  return scene;
}

void candidates(benchmark::State& state) {
  const Scene scene = block(17, Index(state.range(0)));
  SolveReport report;
  for (auto _ : state) {
    Stepper stepper(scene);
    const std::clock_t begin = std::clock();   // CPU seconds bear a busy machine
    report = stepper.solve_static();
    state.SetIterationTime(double(std::clock() - begin) / CLOCKS_PER_SEC);
    if (!report.converged()) throw Error(ErrorCode::internal, "no balance: " + report.message);
  }
  state.counters["nodes"] = scene.mesh.node_count();
  state.counters["contacts"] = report.active_contacts;
  state.counters["iterations_of_newton"] = report.iterations;
  state.counters["factorisations"] = report.factorisations;
}

}  // namespace

BENCHMARK(candidates)->Arg(0)->Arg(100)->Arg(1000)->Arg(5000)->Arg(10000)
    ->Unit(benchmark::kMillisecond)->Iterations(1)->UseManualTime();
