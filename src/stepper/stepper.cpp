#include "brainshift/stepper.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "brainshift/error.hpp"
#include "stepper/error_estimate.hpp"
#include "stepper/stepper_impl.hpp"
#include "stepper/stopwatch.hpp"
#include "text.hpp"

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

const char* to_string(Definiteness definiteness) {
  switch (definiteness) {
    case Definiteness::not_examined: return "not_examined";
    case Definiteness::positive_definite: return "positive_definite";
    case Definiteness::indefinite: return "indefinite";
  }
  return "unknown";
}

StepperOptions within(double accuracy, const Mesh& mesh, StepperOptions options) {
  if (!(accuracy > 0.0) || !std::isfinite(accuracy)) {
    throw Error(ErrorCode::invalid_argument,
                "the accuracy of " + text(accuracy) + " mm is not positive and finite");
  }
  // Steps of Newton's method shrink by half at least where the tangent serves again, far more as a rule.
  constexpr double last_step = 0.2, force = 1e-2;
  options.correction_tolerance = last_step * accuracy / mesh.diameter();
  options.residual_tolerance = options.complementarity_tolerance = force;
  return options;
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

void Stepper::set_damping(const Damping& damping) {
  const auto check = [](double value, const char* name) {
    const std::string what = std::string("Damping: ") + name + " = " + text(value);
    if (!std::isfinite(value)) throw Error(ErrorCode::not_finite, what + " is not finite");
    if (value < 0.0) throw Error(ErrorCode::invalid_argument, what + " is negative");
  };
  check(damping.alpha, "alpha");
  check(damping.beta, "beta");
  m_impl->m_state.wanted.damping = damping;
}

const Damping& Stepper::damping() const { return m_impl->m_state.wanted.damping; }

void Stepper::check_settings() const {
  Equilibrium trial = m_impl->m_equilibrium;
  Impl::configure(trial, m_impl->m_state.wanted);
  m_impl->refuse_penetration(trial);
  trial.check_supported();
}

const Points& Stepper::displacement() const { return m_impl->m_state.u; }
const Points& Stepper::velocity() const { return m_impl->m_state.velocity; }

void Stepper::set_velocity(const Points& velocity) {
  m_impl->refuse_when_begun("set_velocity");
  if (velocity.rows() != m_impl->m_mesh.node_count()) {
    throw Error(ErrorCode::size_mismatch,
                "velocity has " + std::to_string(velocity.rows()) + " rows for " +
                    std::to_string(m_impl->m_mesh.node_count()) + " nodes");
  }
  for (Eigen::Index i = 0; i < velocity.rows(); ++i) {
    if (velocity.row(i).allFinite()) continue;
    throw Error(ErrorCode::not_finite,
                "the velocity of node " + std::to_string(i) + " is not finite");
  }
  m_impl->m_state.velocity = velocity;
}

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
    const Interpolation at =
        m_impl->m_mesh.interpolation(where.tet[std::size_t(i)], where.weights.row(i));
    result.values.row(i) = at.of(m_impl->m_state.u);
  }
  return result;
}

PointValues Stepper::rest_points_of(const Points& points) const {
  const Location where = m_impl->m_mesh.locate_deformed(points, positions());
  PointValues result{Points::Constant(points.rows(), 3, std::numeric_limits<double>::quiet_NaN()),
                     where.tet};
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    if (where.tet[std::size_t(i)] < 0) continue;
    const Interpolation at =
        m_impl->m_mesh.interpolation(where.tet[std::size_t(i)], where.weights.row(i));
    result.values.row(i) = points.row(i) - at.of(m_impl->m_state.u).transpose();
  }
  return result;
}

ErrorEstimate Stepper::estimate_error(const Points& rest_points) const {
  if (m_impl->m_mesh.is_quadratic()) {
    throw Error(ErrorCode::invalid_argument, "the error estimate is for linear tets");
  }
  if (!m_impl->m_state.velocity.isZero(0.0)) {
    throw Error(ErrorCode::invalid_argument, "the error estimate is for a state at rest");
  }
  ErrorEstimate estimate;
  {
    const Stopwatch watch(estimate.seconds);
    const Snapshot& state = m_impl->m_state;
    Scene scene = m_impl->m_scene;
    scene.constraints = state.solved.constraints;
    scene = quadratic(scene);
    Equilibrium fine(scene);
    fine.configure(scene.constraints, state.solved.csf, state.solved.gravity);
    const Equilibrium& coarse = m_impl->m_equilibrium;
    const QuadraticCorrection found = quadratic_correction(
        {coarse, state.u, m_impl->mechanical(coarse.contacts()).multipliers, state.devices}, fine);
    estimate.iterations = found.iterations;
    const Location where = found.mesh.locate(rest_points);
    estimate.correction.setConstant(rest_points.rows(), 3, std::numeric_limits<double>::quiet_NaN());
    for (Eigen::Index i = 0; i < rest_points.rows(); ++i) {
      const Index tet = where.tet[std::size_t(i)];
      if (tet < 0) continue;
      const Interpolation at = found.mesh.interpolation(tet, where.weights.row(i).transpose());
      estimate.correction.row(i) = at.of(found.w).transpose();
    }
    estimate.error = estimate.correction.rowwise().norm();
  }
  return estimate;
}

std::shared_ptr<const Stepper::Snapshot> Stepper::snapshot() const {
  return std::make_shared<const Snapshot>(m_impl->m_state);
}

void Stepper::restore(const std::shared_ptr<const Snapshot>& snapshot) {
  m_impl->refuse_when_begun("restore");
  const Mesh& mesh = m_impl->m_mesh;
  if (!snapshot || snapshot->mesh.nodes() != mesh.nodes() || snapshot->mesh.tets() != mesh.tets()) {
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
