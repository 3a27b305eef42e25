#include "stepper/newton.hpp"

#include <algorithm>
#include <limits>

#include "stepper/norms.hpp"
#include "stepper/stopwatch.hpp"

namespace brainshift {

Newton::Newton(const Equilibrium& equilibrium, const Coupling& coupling,
               const StepperOptions& options, FactorCache& cache, SolveReport& report,
               const BackwardEuler* euler)
    : m_eq(equilibrium),
      m_coupling(coupling),
      m_options(options),
      m_cache(cache),
      m_report(report),
      m_euler(euler),
      m_offset(no_offset()) {
  const auto& blocks = m_eq.blocks_pointer();
  m_free.assign(std::size_t(blocks->count()), Mat3::Identity());
  for (const NodeRow& row : m_eq.fixed_rows()) {
    Mat3& free = m_free[std::size_t(row.block)];
    const Vec3 left = free * row.normal;
    if (left.squaredNorm() > 1e-12) free -= left * left.transpose() / left.squaredNorm();
  }
  if (m_cache.made_for == blocks) return;
  m_cache.made_for.reset();  // of no pattern, should one of the next lines throw
  m_cache.stiffness = blocks->make_matrix();
  m_cache.reduced = m_cache.stiffness;
  m_cache.solver = make_spd_solver();
  m_cache.solver->set_threads(m_options.threads);
  m_cache.solver->analyse(m_cache.reduced);
  m_cache.made_for = blocks;
}

void Newton::refresh() {
  Stopwatch watch(m_report.seconds_assembly);
  m_forces = m_eq.forces(m_state.u);
  m_load = m_eq.blocks().gather(m_forces.external - m_forces.internal) + m_offset.tissue;
  if (m_euler) {
    m_inertia = m_euler->inertia(m_state.u);
    m_damping = m_euler->damping(m_state.u);
    m_load += m_inertia + m_damping;
  }
  refresh_devices();
}

// Multipliers that balance the forces at the present state best; negative ones are given up.
void Newton::estimate_multipliers() {
  std::vector<double> found(m_active.size() + 1, 0.0);
  make_reduction().multipliers(m_load + coupling_force(), found);
  found.pop_back();
  for (std::size_t r = 0; r < found.size(); ++r) {
    m_state.multipliers[r] = m_active[r] ? std::max(found[r], 0.0) : 0.0;
  }
}

Newton::Outcome Newton::begin(const MechanicalState& start, const Offset& offset,
                              double load_factor) {
  m_state = start;
  m_offset = offset;
  m_load_factor = load_factor;
  m_definite = m_lost_stability = false;
  m_fresh = true;
  m_iteration = 0;
  m_last = m_previous = std::numeric_limits<double>::infinity();
  m_active.assign(m_eq.contacts().size(), 0);
  m_factor.reset();
  m_path_columns = m_coupling.path_columns(m_eq.blocks());
  refresh();
  measure();
  if (m_report.residual <= 1e-4 * m_options.residual_tolerance &&
      m_report.complementarity <= m_options.complementarity_tolerance &&
      m_report.tie_gap <= 1e-4 * m_options.correction_tolerance * m_eq.mesh().diameter()) {
    m_report.last_correction = 0.0;
    return Outcome::converged;
  }
  return Outcome::ongoing;
}

void Newton::linearise() {
  if (m_fresh) assemble();
}

void Newton::solve() {
  m_found = m_fresh ? find_step() : reuse_factor();
}

Newton::Outcome Newton::update() {
  if (!m_found) return m_fresh ? Outcome::stuck : blame();
  MechanicalState next = m_state;
  const double part = search(m_step, next);
  const Outcome outcome = part > 0.0 ? take(part, next) : blame();
  if (outcome != Outcome::ongoing) return outcome;
  return ++m_iteration < m_options.max_iterations ? outcome : Outcome::out_of_iterations;
}

// No part of the step would do: perhaps a stale factor was to blame, or an indefinite tangent.
Newton::Outcome Newton::blame() {
  if (!m_fresh) {
    m_fresh = true;
    return Outcome::ongoing;
  }
  if (m_definite) return Outcome::stuck;
  m_definite = true;
  return Outcome::ongoing;
}

Newton::Outcome Newton::take(double part, MechanicalState& next) {
  m_definite = false;
  m_previous = m_last;
  m_last = length_of_step(part);
  m_state.u = std::move(next.u);
  m_state.devices = std::move(next.devices);
  refresh();
  estimate_multipliers();
  measure();
  ++m_report.iterations;
  m_report.last_correction = m_last;
  if (m_options.progress &&
      !m_options.progress({m_load_factor, m_report.iterations, m_report.residual})) {
    return Outcome::cancelled;
  }
  if (small_enough(m_last)) return Outcome::converged;
  // The factor at hand serves again while the set stands and it converges fast.
  const bool same = m_active == m_factor->active;
  m_fresh = !(same && part == 1.0 && m_last <= 1e-3 * m_eq.mesh().diameter() &&
              m_last <= 0.1 * m_previous);
  return Outcome::ongoing;
}

// Largest displacement in the part of the step that is taken, of tissue and devices.
double Newton::length_of_step(double part) const {
  double length = max_norm(m_step.dx) * part;
  for (const Eigen::VectorXd& dq : m_step.dq) {
    for (Eigen::Index i = 0; i < dq.size(); i += 6) {
      length = std::max(length, part * dq.segment<3>(i).cwiseAbs().maxCoeff());
    }
  }
  return length;
}

}  // namespace brainshift
