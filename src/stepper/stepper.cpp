#include "brainshift/stepper.hpp"

#include <chrono>
#include <cmath>
#include <limits>
#include <string>

#include "brainshift/error.hpp"
#include "stepper/stepper_impl.hpp"

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

// The change of settings since the last solve appears as a force out of balance; it is let go in
// one load step, or in smaller ones where Newton does not get through.
SolveReport Stepper::Impl::solve_static() {
  const auto start = std::chrono::steady_clock::now();
  Equilibrium trial = m_equilibrium;  // whatever fails below leaves the present one as it is
  configure(trial, m_state.wanted);
  SolveReport report;
  const Coupling coupling(m_mesh, m_state.devices, m_state.u);
  Newton newton(trial, coupling, m_options, m_cache, report);
  MechanicalState state = mechanical(trial.contacts());
  const Offset unbalanced = newton.unbalanced(state);
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
    newton.certify(state);
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
