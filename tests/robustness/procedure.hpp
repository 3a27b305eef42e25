// A procedure with everything in it on a small scene: what a planner would run, and a hash of it.
#pragma once

#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "brainshift/brainshift.hpp"
#include "support/expect_error.hpp"
#include "support/scenes.hpp"

namespace brainshift::test {

// FNV-1a of bytes.
class Hash {
 public:
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) m_value = (m_value ^ bytes[i]) * 1099511628211u;
  }
  template <class Derived>
  void add(const Eigen::PlainObjectBase<Derived>& values) {
    add(values.data(), sizeof(double) * std::size_t(values.size()));
  }
  std::uint64_t value() const { return m_value; }

 private:
  std::uint64_t m_value = 14695981039346656037u;
};

struct Stage {
  std::string name;
  SolveReport report;
};

struct Procedure {
  std::uint64_t hash = 0;
  std::vector<Stage> stages;
};

// Fluid lost, a cannula in, more lost, a lead in its place, the cannula gone, the head tilted, some
// motion in time, a branch that is taken back, fluid restored.
inline Procedure run_procedure(int cells = 3, StepperOptions options = {}) {
  Stepper s(busy_scene(cells, 0.3), std::move(options));
  Procedure result;
  Hash hash;
  const auto keep = [&](const char* name, const SolveReport& report) {
    EXPECT_TRUE(report.converged()) << name << ": " << report.message;
    result.stages.push_back({name, report});
    hash.add(s.displacement());
    hash.add(s.velocity());
    hash.add(s.external_force());
    hash.add(s.contact(0).multiplier);
    hash.add(&report.energy, sizeof report.energy);
  };
  const Placement along{Vec3(14.3, 15.7, 9.1), Vec3::UnitZ()};
  s.csf().set_lost_volume(0, 3000.0);
  keep("loss", s.solve_static());
  TrackOptions track;
  track.shear_bound = 1e-3;
  const DeviceId id = s.insert(make_device("cannula", 40.0), along, {0.0, 38.0}, track);
  s.csf().set_lost_volume(0, 6000.0);
  keep("cannula in, more lost", s.solve_static());
  s.exchange(id, make_device("3389", 40.0), {0.0, 38.0});
  keep("lead in its place", s.solve_static());
  s.set_hold(id, {std::numeric_limits<double>::infinity(), 38.0});
  s.csf().set_lost_volume(0, 9000.0);
  keep("held at its wire", s.solve_static());
  s.set_gravity(standard_gravity * Vec3(0.0, -0.26, -0.97));
  keep("tilted", s.solve_static());
  const auto branch = s.snapshot();
  s.set_damping({2.0, 1e-3});
  s.csf().set_level(0, 15.0);
  for (int i = 0; i < 4; ++i) keep("in time", s.step(0.02));
  s.restore(branch);
  s.csf().set_full(0);
  keep("restored", s.solve_static());
  const DeviceState d = s.device(id);
  hash.add(d.nodes);
  hash.add(d.path_forces);
  result.hash = hash.value();
  return result;
}

}  // namespace brainshift::test
