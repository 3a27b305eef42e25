// Steps in time of every length, from rest under a load that is there at once.
#include "axes.hpp"
#include "support/leaning_block.hpp"

namespace brainshift::stability {
namespace {

using namespace brainshift::test;

constexpr int count = 5;  // steps of each length

struct Start {
  std::string name;
  Scene scene;
  bool device = false, loss = false;

  Stepper stepper(Element element) const {
    Stepper s(with(scene, element));
    if (device) {
      DeviceOptions options;
      options.density = 8e-6;  // steel
      s.insert(make_device("cannula", device_length, options), {lead_tip, lead_outward},
               wire_only());
    }
    if (loss) s.csf().set_lost_volume(0, 9000.0);
    return s;
  }
};

std::vector<Start> starts() {
  std::vector<Start> all;
  for (const Law law : laws) {
    Scene scene = block_on_base(leaning(0.1), {3, 3, 4});
    scene.materials = {{0, Material(law, young, 0.45, tissue_density)}};
    all.push_back({to_string(law), scene});
  }
  all.push_back({"with a steel cannula", block_on_base(leaning(0.02), {3, 3, 4}), true});
  all.push_back({"with fluid and contact", busy_scene(3, 0.3), false, true});
  return all;
}

// uJ, with the height in gravity; without fluid and damping no step may add to it.
double energy(const Stepper& s, const SolveReport& r) {
  return r.energy + r.kinetic_energy - s.gravity_force().cwiseProduct(s.displacement()).sum();
}

void row(const Start& start, Element element, double dt, const Points& at_rest) {
  Stepper stepper = start.stepper(element);
  SolveReport last;
  int iterations = 0, done = 0;
  double before = 0.0, gained = 0.0, scale = 0.0;
  while (done < count) {
    last = stepper.step(dt);
    iterations = std::max(iterations, last.iterations);
    if (!last.converged()) break;
    ++done;
    const double now = energy(stepper, last);
    gained = std::max(gained, now - before);
    scale = std::max(scale, last.energy + last.kinetic_energy);
    before = now;
  }
  const double off =
      largest_distance(stepper.displacement(), at_rest) / at_rest.rowwise().norm().maxCoeff();
  std::printf("%s,%s,%.0e,%d,%d,%.2e,%.3e,%.1e,%s,%s\n", start.name.c_str(), to_string(element), dt,
              done, iterations, last.residual, off, scale > 0.0 ? gained / scale : 0.0,
              to_string(last.status), quoted(last.message).c_str());
}

}  // namespace

void time_steps() {
  std::printf(
      "scene,element,dt,steps,iterations,residual,off_static,energy_gained,status,message\n");
  for (const Start& start : starts()) {
    for (const Element element : elements) {
      Stepper at_rest = start.stepper(element);
      if (!at_rest.solve_static().converged()) continue;
      for (const double dt : {1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1e0, 1e1, 1e2, 1e3})
        row(start, element, dt, at_rest.displacement());
    }
  }
}

}  // namespace brainshift::stability
