// One brain, ten trajectories: each thread takes a stepper of its own from the same snapshot, inserts a
// lead along another line, lets fluid out and asks where the tip has gone in the tissue. A planner
// chooses the line that stays nearest to its target.
//
// Build:  c++ -std=c++17 what_if.cpp $(pkg-config --cflags --libs brainshift) -pthread -o what_if
// Prints: a line per trajectory with tilt, bow and distance from the tissue aimed at, and the best one.
#include <cmath>
#include <cstdio>
#include <limits>
#include <thread>
#include <vector>

#include "block.hpp"

using namespace brainshift;

namespace {

const Vec3 target(24.0, 27.0, 21.0);   // mm, in the brain before anything is lost
constexpr double length = 50.0;        // mm

struct Outcome {
  double bow, miss;   // mm
  bool converged;
};

Outcome try_trajectory(Stepper& stepper, double tilt) {
  const Vec3 outward = Vec3(std::sin(tilt), 0.3 * std::sin(2.0 * tilt), std::cos(tilt)).normalized();
  const Hold wire{std::numeric_limits<double>::infinity(), length};
  const DeviceId id = stepper.insert(make_device("3389", length), {target, outward}, wire);
  stepper.csf().set_lost_volume(0, 350.0 * mm3_per_ml);
  const bool converged = stepper.solve_static().converged();
  const DeviceState lead = stepper.device(id);
  const Points tissue = target.transpose() + stepper.displacement_at(target.transpose()).values;
  return {lead.bow, (lead.nodes.row(0) - tissue.row(0)).norm(), converged};
}

}  // namespace

int main() try {
  constexpr int count = 10;
  const Scene scene = block_scene();
  Stepper before(scene);
  before.csf().set_lost_volume(0, 150.0 * mm3_per_ml);
  if (!before.solve_static().converged()) return 1;
  const auto snapshot = before.snapshot();

  const auto tilt_of = [](int i) { return (i - count / 2) * 0.05; };   // rad
  std::vector<Outcome> outcomes(count);
  std::vector<std::thread> threads;
  for (int first = 0; first < 2; ++first) {   // two threads, every other trajectory
    threads.emplace_back([&, first] {
      Stepper mine(scene);   // meshes and surfaces are shared, not copied
      for (int i = first; i < count; i += 2) {
        mine.restore(snapshot);
        outcomes[std::size_t(i)] = try_trajectory(mine, tilt_of(i));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();

  int best = 0;
  bool good = true;
  for (int i = 0; i < count; ++i) {
    const Outcome& o = outcomes[std::size_t(i)];
    std::printf("tilt %5.2f rad: bow %.4f mm, tip %.4f mm from the tissue aimed at\n", tilt_of(i), o.bow,
                o.miss);
    if (o.miss < outcomes[std::size_t(best)].miss) best = i;
    good = good && o.converged;
  }
  std::printf("best: %.2f rad\n", tilt_of(best));

  // The threads have not disturbed each other: alone, the best one has the same bits.
  before.restore(snapshot);
  const Outcome alone = try_trajectory(before, tilt_of(best));
  const Outcome& found = outcomes[std::size_t(best)];
  const bool same = alone.bow == found.bow && alone.miss == found.miss;
  std::printf("%s\n", same ? "the same bits alone" : "other bits alone");
  return good && same ? 0 : 1;
} catch (const Error& error) {
  std::fprintf(stderr, "%s: %s\n", to_string(error.code()), error.what());
  return 1;
}
