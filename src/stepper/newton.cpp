#include "stepper/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stepper/norms.hpp"
#include "stepper/stopwatch.hpp"

namespace brainshift {
namespace {

// A factor serves again after a step of its own this short (in diameters), while steps shrink this much and
// no more than so many are to be expected. docs/decisions/speed.md
constexpr double stale_reach = 5e-3, stale_rate = 0.5;
constexpr int stale_steps = 4;

// Iterations that a credit lasts: a slender body that turns far needs up to four until its energy is below.
constexpr int credit_iterations = 5;

// Turned factors that may be too far away in one search.
constexpr int turns_that_may_fail = 2;

}  // namespace

void FactorCache::prepare(const std::shared_ptr<const Blocks>& blocks, int threads) {
  if (made_for == blocks) return;
  made_for.reset();  // of no pattern, should one of the next lines throw
  stiffness = blocks->make_matrix();
  reduced = stiffness;
  solver = make_spd_solver();
  solver->set_threads(threads);
  solver->analyse(reduced);
  made_for = blocks;
}

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
  m_cache.prepare(blocks, m_options.threads);
}

void Newton::refresh() {
  Stopwatch watch(m_report.seconds_assembly);
  if (m_forces_at.rows() != m_state.u.rows() || m_forces_at != m_state.u) {
    m_forces = m_eq.forces(m_state.u);
    m_forces_at = m_state.u;
  }
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
  Reduction(m_eq.blocks().count(), rows_of(m_active)).multipliers(m_load + coupling_force(), found);
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
  m_credit.reset();
  m_may_borrow = !m_euler && m_coupling.empty() && m_eq.contacts().size() == 0;
  m_linearised.emplace(m_cache.stiffness, *m_cache.solver, m_coupling.path_columns(m_eq.blocks()));
  m_turned_factor.emplace(m_eq.mesh(), m_eq.blocks(), m_cache.stiffness, *m_cache.solver);
  m_turned = m_far_from_factor = false;
  m_turns_left = m_coupling.empty() ? turns_that_may_fail : 0;
  refresh();
  measure();
  if (unchanged(start)) {
    m_report.last_correction = 0.0;
    return Outcome::converged;
  }
  return Outcome::ongoing;
}

void Newton::linearise() {
  if (m_fresh) assemble();
  if (m_turned) assemble_stiffness();
}

void Newton::solve() {
  m_found = m_turned ? find_step_by_turned_factor() : find_step();
}

Newton::Outcome Newton::update() {
  Outcome outcome = go_on();
  const bool ended = outcome == Outcome::converged || outcome == Outcome::stuck;
  if (m_credit && (ended || m_iteration >= m_credit->since + credit_iterations)) outcome = return_from_credit();
  if (outcome != Outcome::ongoing) return outcome;
  return ++m_iteration < m_options.max_iterations ? outcome : Outcome::out_of_iterations;
}

Newton::Outcome Newton::go_on() {
  if (!m_found) return m_fresh ? Outcome::stuck : blame();
  MechanicalState next = m_state;
  const double part = search(m_step, next);
  return part > 0.0 ? take(part, next) : blame();
}

// Back to where the energy was lower, to search along its step as ever.
Newton::Outcome Newton::return_from_credit() {
  m_state = std::move(m_credit->from);
  m_credit.reset();
  m_definite = false;
  m_fresh = true;
  m_turned = false;
  m_last = m_previous = std::numeric_limits<double>::infinity();
  refresh();
  measure();
  return Outcome::ongoing;
}

// No part of the step would do: perhaps a stale factor was to blame, or an indefinite tangent.
Newton::Outcome Newton::blame() {
  if (!m_fresh) {
    m_fresh = true;
    if (m_turned) --m_turns_left;
    m_turned = false;
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
  const bool was_fresh = m_fresh;
  m_turned = part == 1.0 && may_turn();
  m_fresh = !m_turned && !(part == 1.0 && !m_far_from_factor && serves_again(was_fresh));
  return Outcome::ongoing;
}

// Whether another step with the factor at hand is worth less than a new one: after its own step where that
// was short, then as long as few more of them are to be expected.
bool Newton::serves_again(bool was_fresh) const {
  if (!(m_last <= stale_rate * m_previous)) return false;
  const double diameter = m_eq.mesh().diameter();
  if (was_fresh) return m_last <= stale_reach * diameter;
  const double enough = m_options.correction_tolerance * diameter;
  return enough >= m_last * std::pow(m_last / m_previous, stale_steps);
}

// Conjugate gradients know no devices, no terms of the fluid, and no rows but those of the factor.
bool Newton::may_turn() const {
  return m_turns_left > 0 && !m_lost_stability && m_active == m_factored && !m_linearised->has_terms();
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
