// What a Stepper holds.
#pragma once

#include <cmath>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "brainshift/error.hpp"
#include "brainshift/stepper.hpp"
#include "coupling/coupling.hpp"
#include "coupling/local_give.hpp"
#include "stepper/equilibrium.hpp"
#include "stepper/newton.hpp"
#include "stepper/solve.hpp"
#include "text.hpp"

namespace brainshift {

struct Settings {
  std::optional<Csf> csf;
  ConstraintSet constraints;
  Vec3 gravity = Vec3::Zero();
  Damping damping = {};
};

// What snapshot() keeps. Multipliers by group, so that groups may come and go.
class Stepper::Snapshot {
 public:
  explicit Snapshot(Mesh of) : mesh(std::move(of)) {}
  Mesh mesh;         // shared, not copied
  Points u;
  Points velocity;
  std::map<ConstraintId, Eigen::VectorXd> multipliers;
  std::vector<InsertedDevice> devices;
  DeviceId next_device = 0;
  Settings wanted;   // by the host, for the next solve
  Settings solved;   // those u is in balance with
  double open_force = 0.0, open_tie = 0.0;   // what its solve left open; 0 after a step in time
};

class Stepper::Impl {
 public:
  using State = Snapshot;

  Impl(Scene scene, StepperOptions options)
      : m_scene(scene),
        m_mesh(scene.mesh),
        m_options(std::move(options)),
        m_equilibrium(scene),
        m_state(m_mesh) {
    check_options();
    m_equilibrium.set_threads(m_options.threads);
    m_state.wanted = {std::move(scene.csf), std::move(scene.constraints), scene.gravity, {}};
    m_state.solved = m_state.wanted;
    m_state.u.setZero(m_mesh.node_count(), 3);
    m_state.velocity = m_state.u;
    refuse_penetration(m_equilibrium);
  }

  void check_options() const {
    const auto require = [](bool good, const char* what) {
      if (!good) throw Error(ErrorCode::invalid_argument, std::string("StepperOptions: ") + what);
    };
    const auto positive = [](double x) { return x > 0.0 && std::isfinite(x); };
    require(positive(m_options.residual_tolerance), "residual_tolerance is not positive");
    require(positive(m_options.complementarity_tolerance),
            "complementarity_tolerance is not positive");
    require(positive(m_options.correction_tolerance), "correction_tolerance is not positive");
    require(positive(m_options.smallest_load_step), "smallest_load_step is not positive");
    require(m_options.initial_penetration >= 0.0, "initial_penetration is negative");
    require(m_options.max_iterations > 0, "max_iterations is not positive");
    require(m_options.threads > 0, "threads is not positive");
    require(m_options.time_limit >= 0.0, "time_limit is negative or not a number");
  }

  // At the start, and where a host enables an obstacle that tissue is in by then.
  void refuse_penetration(const Equilibrium& equilibrium) const {
    const ContactRows& contacts = equilibrium.contacts();
    const double allowed = m_options.initial_penetration * m_mesh.diameter();
    for (std::size_t r = 0; r < contacts.size(); ++r) {
      const double gap = contacts.sample(r, m_state.u).gap;
      if (gap < -allowed) {
        throw Error(ErrorCode::initial_penetration,
                    "constraint '" + contacts.group_of(r).name + "': node " +
                        std::to_string(contacts.mesh_node(r)) + " starts " + text(-gap) +
                        " mm inside the obstacle");
      }
    }
  }

  // The solve that is begun, with the settings it has taken up.
  struct OpenSolve {
    Settings settings;
    Solve solve;
  };

  MemoryEstimate memory_estimate();   // memory_estimate.cpp

  // stepper_solve.cpp
  void begin(const std::optional<double>& dt);
  template <class Phase>
  void run_phase(const char* call, std::initializer_list<StepPhase> needed, Phase&& phase);
  void require(const char* call, std::initializer_list<StepPhase> needed) const;
  void refuse_when_begun(const char* call) const;
  StepPhase phase() const { return m_open ? m_open->solve.phase() : StepPhase::idle; }
  const Solve& open(const char* call) const;

  static void configure(Equilibrium& equilibrium, const Settings& settings) {
    equilibrium.configure(settings.constraints, settings.csf, settings.gravity);
  }

  MechanicalState mechanical(const ContactRows& contacts) const {
    MechanicalState m{m_state.u, std::vector<double>(contacts.size(), 0.0), {}, m_state.open_force,
                      m_state.open_tie};
    for (const InsertedDevice& d : m_state.devices) m.devices.push_back(d.motion);
    for (std::size_t r = 0; r < m.multipliers.size(); ++r) {
      const auto found = m_state.multipliers.find(contacts.group_of(r).id);
      if (found == m_state.multipliers.end()) continue;
      m.multipliers[r] = found->second[Eigen::Index(contacts.row(r).item)];
    }
    return m;
  }

  // The present state with what a solve has found; made apart, so that a failure changes nothing.
  Snapshot solved(OpenSolve& open) const {
    const MechanicalState& m = open.solve.result();
    const ContactRows& contacts = open.solve.equilibrium().contacts();
    Snapshot next = m_state;
    next.u = m.u;
    next.velocity = open.solve.velocity();
    for (std::size_t d = 0; d < m.devices.size(); ++d) next.devices[d].motion = m.devices[d];
    next.multipliers.clear();
    next.solved = open.settings;
    next.open_force = open.solve.is_static() ? m.open_force : 0.0;
    next.open_tie = open.solve.is_static() ? m.open_tie : 0.0;
    for (std::size_t r = 0; r < m.multipliers.size(); ++r) {
      const ConstraintGroup& group = contacts.group_of(r);
      Eigen::VectorXd& values = next.multipliers[group.id];
      if (values.size() == 0) values.setZero(Eigen::Index(group.nodes.size()));
      values[Eigen::Index(contacts.row(r).item)] = m.multipliers[r];
    }
    return next;
  }

  // With the local give; positions: of the nodes now.
  void set_give(const Points& positions, InsertedDevice& device) const {
    if (!device.options.local_give) return;
    const Tissue& tissue = m_equilibrium.tissue();
    const double radius = device.beam.device().section(0).radius;
    spread_ties(tissue, positions, device.placement.outward, radius, device.path);
    set_local_give(tissue, radius, device.path);
  }

  InsertedDevice& device(DeviceId id) {
    for (InsertedDevice& d : m_state.devices) {
      if (d.id == id) return d;
    }
    throw Error(ErrorCode::invalid_argument, "there is no device with the id " + std::to_string(id));
  }

  Scene m_scene;   // as it was given
  Mesh m_mesh;
  StepperOptions m_options;
  Equilibrium m_equilibrium;
  Snapshot m_state;
  FactorCache m_cache;
  std::unique_ptr<OpenSolve> m_open;
  std::optional<Farthest> m_farthest;   // of the last solve, if it has failed
  bool m_in_phase = false;   // a callback must not end the solve it is called from
};

}  // namespace brainshift
