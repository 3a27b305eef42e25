// A small scene with everything in it, solved to a first state, and all that shows of it.
#pragma once

#include "brainshift/brainshift.hpp"
#include "robustness/outcome.hpp"

namespace brainshift::test {

inline const Scene& small_scene() {
  static const Scene scene = busy_scene(2, 0.3);
  return scene;
}

inline const BeamDevice& device_of(const char* name) {
  static const BeamDevice cannula = make_device("cannula", 40.0), lead = make_device("3389", 40.0);
  return name[0] == 'c' ? cannula : lead;
}

const Vec3 small_tip(14.3, 15.7, 9.1);
inline Hold held_whole() { return {0.0, 38.0, false, 0.0}; }
inline Hold held_at_wire() { return {std::numeric_limits<double>::infinity(), 38.0, false, 0.0}; }

struct World {
  Stepper stepper;
  DeviceId id;
  std::shared_ptr<const Stepper::Snapshot> snapshot;

  explicit World(StepperOptions options = {}) : stepper(small_scene(), std::move(options)) {
    TrackOptions track;
    track.shear_bound = 0.001;
    id = stepper.insert(device_of("cannula"), {small_tip, Vec3::UnitZ()}, held_whole(), track);
    snapshot = stepper.snapshot();
    stepper.csf().set_lost_volume(0, 2000.0);
    if (!stepper.solve_static().converged()) throw std::runtime_error("the first state");
    stepper.csf().set_lost_volume(0, 5000.0);  // wanted, not yet solved for
  }

  // The next good step.
  Points next() {
    stepper.csf().set_lost_volume(0, 3000.0);
    EXPECT_TRUE(stepper.solve_static().converged());
    return stepper.displacement();
  }
};

// State and settings.
struct WorldState {
  ShownState shown;
  std::vector<double> rest;

  explicit WorldState(const Stepper& s) : shown(s) {
    for (DeviceId id = 0; id < 8; ++id) {
      DeviceState d;
      try {
        d = s.device(id);
      } catch (const Error&) {
        continue;
      }
      rest.push_back(double(id));
      const auto add = [this](const auto& values) {
        for (Eigen::Index i = 0; i < values.size(); ++i) {
          rest.push_back(std::isnan(values.data()[i]) ? -1e300 : values.data()[i]);
        }
      };
      add(d.nodes), add(d.path), add(d.path_arcs), add(d.path_forces), add(d.anchor_force);
    }
    for (const ConstraintGroup& group : s.constraints().groups()) rest.push_back(group.enabled);
    rest.push_back(s.csf().amount(0));
    rest.push_back(s.csf().is_open(0));
    rest.push_back(s.damping().alpha);
    rest.push_back(s.compartment(0).head);
    rest.push_back(double(s.phase()));
  }
  bool operator==(const WorldState& other) const {
    return shown == other.shown && rest == other.rest;
  }
};

}  // namespace brainshift::test
