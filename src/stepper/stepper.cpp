#include "brainshift/stepper.hpp"

#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "brainshift/error.hpp"
#include "stepper/equilibrium.hpp"
#include "stepper/newton.hpp"

namespace brainshift {

const char* to_string(Status status) {
  switch (status) {
    case Status::converged: return "converged";
    case Status::no_equilibrium: return "no_equilibrium";
    case Status::not_converged: return "not_converged";
    case Status::cancelled: return "cancelled";
  }
  return "unknown";
}

namespace {

struct Settings {
  std::optional<Csf> csf;
  ConstraintSet constraints;
  Vec3 gravity = Vec3::Zero();
};

}  // namespace

// What snapshot() keeps. Multipliers by group, so that groups may come and go.
class Stepper::Snapshot {
 public:
  Points u;
  std::map<ConstraintId, Eigen::VectorXd> multipliers;
  Settings wanted;   // by the host, for the next solve
  Settings solved;   // those u is in balance with
};

class Stepper::Impl {
 public:
  Impl(Scene scene, StepperOptions options)
      : m_mesh(scene.mesh), m_options(std::move(options)), m_equilibrium(scene) {
    check_options();
    m_state.wanted = {std::move(scene.csf), std::move(scene.constraints), scene.gravity};
    m_state.solved = m_state.wanted;
    m_state.u.setZero(m_mesh.node_count(), 3);
    refuse_penetration();
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
  }

  void refuse_penetration() const {
    const ContactRows& contacts = m_equilibrium.contacts();
    const double allowed = m_options.initial_penetration * m_mesh.diameter();
    for (std::size_t r = 0; r < contacts.size(); ++r) {
      const double gap = contacts.sample(r, m_state.u).gap;
      if (gap < -allowed) {
        throw Error(ErrorCode::initial_penetration,
                    "constraint '" + contacts.group_of(r).name + "': node " +
                        std::to_string(contacts.mesh_node(r)) + " starts " + std::to_string(-gap) +
                        " mm inside the obstacle");
      }
    }
  }

  SolveReport solve_static();

  static void configure(Equilibrium& equilibrium, const Settings& settings) {
    equilibrium.configure(settings.constraints, settings.csf, settings.gravity);
  }

  MechanicalState mechanical(const ContactRows& contacts) const {
    MechanicalState m{m_state.u, std::vector<double>(contacts.size(), 0.0)};
    for (std::size_t r = 0; r < m.multipliers.size(); ++r) {
      const auto found = m_state.multipliers.find(contacts.group_of(r).id);
      if (found == m_state.multipliers.end()) continue;
      m.multipliers[r] = found->second[Eigen::Index(contacts.row(r).item)];
    }
    return m;
  }

  // The present state with what a solve has found; made apart, so that a failure changes nothing.
  Snapshot solved(const MechanicalState& m, const ContactRows& contacts) const {
    Snapshot next = m_state;
    next.u = m.u;
    next.multipliers.clear();
    next.solved = next.wanted;
    for (std::size_t r = 0; r < m.multipliers.size(); ++r) {
      const ConstraintGroup& group = contacts.group_of(r);
      Eigen::VectorXd& values = next.multipliers[group.id];
      if (values.size() == 0) values.setZero(Eigen::Index(group.nodes.size()));
      values[Eigen::Index(contacts.row(r).item)] = m.multipliers[r];
    }
    return next;
  }

  Mesh m_mesh;
  StepperOptions m_options;
  Equilibrium m_equilibrium;
  Snapshot m_state;
  FactorCache m_cache;
};

// The change of settings since the last solve appears as a force out of balance; it is let go in
// one load step, or in smaller ones where Newton does not get through.
SolveReport Stepper::Impl::solve_static() {
  const auto start = std::chrono::steady_clock::now();
  Equilibrium trial = m_equilibrium;  // whatever fails below leaves the present one as it is
  configure(trial, m_state.wanted);
  SolveReport report;
  Newton newton(trial, m_options, m_cache, report);
  MechanicalState state = mechanical(trial.contacts());
  const Eigen::VectorXd unbalanced = newton.unbalanced(state);
  double reached = 0.0, step = 1.0;
  report.status = Status::converged;
  while (reached < 1.0) {
    const double next = std::min(1.0, reached + step);
    const Newton::Outcome outcome = newton.solve(state, -(1.0 - next) * unbalanced, next);
    if (outcome == Newton::Outcome::converged) {
      ++report.load_steps;
      reached = next;
      step *= 2.0;
      continue;
    }
    if (outcome == Newton::Outcome::cancelled) {
      report.status = Status::cancelled;
      report.message = "the host asked to stop";
      break;
    }
    step = 0.5 * (next - reached);
    if (step < m_options.smallest_load_step) {
      const bool stuck = outcome == Newton::Outcome::stuck;
      report.status = stuck ? Status::no_equilibrium : Status::not_converged;
      report.message =
          "no balance of forces was found beyond " + std::to_string(reached) +
          " of the change of load; a law without limit point (stable_neo_hookean), another "
          "support or the contact with the skull may be what the scene lacks";
      break;
    }
  }
  report.load_factor = reached;
  if (report.status == Status::converged) {
    newton.certify(state, Eigen::VectorXd::Zero(unbalanced.size()));
    Snapshot next = solved(state, trial.contacts());
    std::swap(m_state, next);
    m_equilibrium = std::move(trial);
  }
  report.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

Stepper::Stepper(Scene scene, StepperOptions options)
    : m_impl(std::make_unique<Impl>(std::move(scene), std::move(options))) {}
Stepper::~Stepper() = default;
Stepper::Stepper(Stepper&&) noexcept = default;
Stepper& Stepper::operator=(Stepper&&) noexcept = default;

const Mesh& Stepper::mesh() const { return m_impl->m_mesh; }
const StepperOptions& Stepper::options() const { return m_impl->m_options; }

Csf& Stepper::csf() {
  if (!m_impl->m_state.wanted.csf) {
    throw Error(ErrorCode::invalid_argument, "the scene of this stepper has no CSF");
  }
  return *m_impl->m_state.wanted.csf;
}

const Csf& Stepper::csf() const { return const_cast<Stepper*>(this)->csf(); }

const ConstraintSet& Stepper::constraints() const { return m_impl->m_state.wanted.constraints; }

void Stepper::set_gravity(const Vec3& gravity) {
  if (!gravity.allFinite()) throw Error(ErrorCode::not_finite, "gravity is not finite");
  m_impl->m_state.wanted.gravity = gravity;
}

void Stepper::enable(ConstraintId id) { m_impl->m_state.wanted.constraints.enable(id); }
void Stepper::disable(ConstraintId id) { m_impl->m_state.wanted.constraints.disable(id); }

void Stepper::check_settings() const {
  Equilibrium trial = m_impl->m_equilibrium;
  Impl::configure(trial, m_impl->m_state.wanted);
}

SolveReport Stepper::solve_static() { return m_impl->solve_static(); }

const Points& Stepper::displacement() const { return m_impl->m_state.u; }
Points Stepper::positions() const { return m_impl->m_mesh.nodes() + m_impl->m_state.u; }

Eigen::VectorXd Stepper::jacobians() const {
  return m_impl->m_equilibrium.tissue().jacobians(m_impl->m_state.u);
}

Eigen::VectorXd Stepper::fluid_pressure() const {
  const auto& fluid = m_impl->m_equilibrium.fluid();
  if (!fluid) return Eigen::VectorXd::Zero(m_impl->m_mesh.node_count());
  const Points x = positions();
  return fluid->nodal_pressure(x, fluid->heads(x));
}

Points Stepper::internal_force() const {
  return m_impl->m_equilibrium.forces(m_impl->m_state.u).internal;
}

Points Stepper::gravity_force() const {
  return m_impl->m_equilibrium.tissue().gravity_force(m_impl->m_state.solved.gravity);
}

Points Stepper::fluid_force() const {
  Points force = Points::Zero(m_impl->m_mesh.node_count(), 3);
  const auto& fluid = m_impl->m_equilibrium.fluid();
  if (fluid) {
    const Points x = positions();
    fluid->add_force(x, fluid->heads(x), 1.0, force);
  }
  return force;
}

Points Stepper::external_force() const {
  return m_impl->m_equilibrium.external_force(m_impl->m_state.u);
}

CompartmentState Stepper::compartment(Index i) const {
  const auto& fluid = m_impl->m_equilibrium.fluid();
  if (!fluid || i < 0 || i >= csf().compartment_count()) {
    throw Error(ErrorCode::index_out_of_range,
                "compartment " + std::to_string(i) + " is not in the scene");
  }
  const Points x = positions();
  return fluid->state(i, x, fluid->heads(x));
}

ContactState Stepper::contact(ConstraintId id) const {
  const ConstraintGroup& group = m_impl->m_state.wanted.constraints.group(id);
  const auto count = Eigen::Index(group.nodes.size());
  ContactState s;
  s.gap.setConstant(count, std::numeric_limits<double>::quiet_NaN());
  s.multiplier.setZero(count);
  s.force.setZero(count, 3);
  const ContactRows& contacts = m_impl->m_equilibrium.contacts();
  const auto found = m_impl->m_state.multipliers.find(id);
  for (std::size_t r = 0; r < contacts.size(); ++r) {
    if (contacts.group_of(r).id != id) continue;
    const auto i = Eigen::Index(contacts.row(r).item);
    const GapSample g = contacts.sample(r, m_impl->m_state.u);
    s.gap[i] = g.gap;
    if (found != m_impl->m_state.multipliers.end()) s.multiplier[i] = found->second[i];
    s.force.row(i) = s.multiplier[i] * g.normal.transpose();
    if (s.multiplier[i] > 0.0) ++s.active;
  }
  return s;
}

PointValues Stepper::displacement_at(const Points& rest_points) const {
  const Location where = m_impl->m_mesh.locate(rest_points);
  PointValues result{Points::Constant(rest_points.rows(), 3,
                                      std::numeric_limits<double>::quiet_NaN()),
                     where.tet};
  for (Eigen::Index i = 0; i < rest_points.rows(); ++i) {
    if (where.tet[std::size_t(i)] < 0) continue;
    result.values.row(i).setZero();
    for (int a = 0; a < 4; ++a) {
      result.values.row(i) += where.weights(i, a) *
                              m_impl->m_state.u.row(m_impl->m_mesh.tets()(
                                  where.tet[std::size_t(i)], a));
    }
  }
  return result;
}

PointValues Stepper::rest_points_of(const Points& points) const {
  const Location where = m_impl->m_mesh.locate_deformed(points, positions());
  PointValues result{Points::Constant(points.rows(), 3, std::numeric_limits<double>::quiet_NaN()),
                     where.tet};
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    if (where.tet[std::size_t(i)] < 0) continue;
    result.values.row(i) = points.row(i);
    for (int a = 0; a < 4; ++a) {
      result.values.row(i) -= where.weights(i, a) *
                              m_impl->m_state.u.row(m_impl->m_mesh.tets()(
                                  where.tet[std::size_t(i)], a));
    }
  }
  return result;
}

std::shared_ptr<const Stepper::Snapshot> Stepper::snapshot() const {
  return std::make_shared<const Snapshot>(m_impl->m_state);
}

void Stepper::restore(const std::shared_ptr<const Snapshot>& snapshot) {
  if (!snapshot || snapshot->u.rows() != m_impl->m_mesh.node_count()) {
    throw Error(ErrorCode::invalid_argument, "the snapshot is empty or of another mesh");
  }
  if (snapshot->wanted.csf.has_value() != m_impl->m_state.wanted.csf.has_value()) {
    throw Error(ErrorCode::invalid_argument, "of snapshot and scene only one has CSF");
  }
  Snapshot next = *snapshot;
  Impl::configure(m_impl->m_equilibrium, next.solved);
  std::swap(m_impl->m_state, next);
}

}  // namespace brainshift
