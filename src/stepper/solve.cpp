#include "stepper/solve.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "linear/blas_threads.hpp"
#include "text.hpp"

namespace brainshift {
namespace {

bool all_finite(const Offset& offset) {
  return offset.tissue.allFinite() &&
         std::all_of(offset.devices.begin(), offset.devices.end(),
                     [](const Eigen::VectorXd& force) { return force.allFinite(); });
}

}  // namespace

Solve::Solve(Equilibrium equilibrium, const std::vector<InsertedDevice>& devices,
             MechanicalState start, const StepperOptions& options, FactorCache& cache,
             const std::optional<Motion>& motion)
    : m_options(options),
      m_equilibrium(std::move(equilibrium)),
      m_coupling(m_equilibrium.mesh(), devices, start.u),
      m_euler(motion ? std::optional<BackwardEuler>(std::in_place, m_equilibrium, m_coupling, start,
                                                    *motion)
                     : std::nullopt),
      m_newton(m_equilibrium, m_coupling, m_options, cache, m_report,
               m_euler ? &*m_euler : nullptr),
      m_balanced(std::move(start)) {
  m_report.load_factor = 0.0;
  m_report.blas_threads = blas_threads();
  m_unbalanced = m_newton.unbalanced(m_balanced);
  if (!all_finite(m_unbalanced)) {
    refuse_start();
    return;
  }
  settle(begin_load_step());
  if (m_phase == StepPhase::updated) m_phase = StepPhase::begun;
}

void Solve::linearise() {
  m_newton.linearise();
  m_phase = StepPhase::linearised;
}

void Solve::solve() {
  m_newton.solve();
  m_phase = StepPhase::solved;
}

void Solve::update() {
  const Newton::Outcome outcome = m_newton.update();
  settle(outcome == Newton::Outcome::ongoing && is_late() ? Newton::Outcome::cancelled : outcome);
}

bool Solve::is_late() const {
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - m_begin;
  return spent.count() > m_options.time_limit;
}

// No part of a load that is not finite can be let go, and no step be found from there.
void Solve::refuse_start() {
  m_newton.certify(m_balanced);
  Eigen::Index tet = 0;
  const double smallest = m_equilibrium.tissue().jacobians(m_balanced.u).minCoeff(&tet);
  m_report.status = Status::no_equilibrium;
  m_report.message = "the forces are not finite where the solve begins; the smallest det F is " +
                     text(smallest) + ", of tet " + std::to_string(tet);
  m_report.message += smallest > 0.0 ? "; loads or moduli may be beyond the range of double"
                                     : ", and not every law has an energy there (log_neo_hookean)";
  m_phase = StepPhase::failed;
}

Newton::Outcome Solve::begin_load_step() {
  m_next = std::min(1.0, m_reached + m_step);
  return m_newton.begin(m_balanced, -(1.0 - m_next) * m_unbalanced, m_next);
}

// What follows from the end of an iteration: another one, another load step, or the end.
void Solve::settle(Newton::Outcome outcome) {
  while (outcome != Newton::Outcome::ongoing) {
    if (outcome == Newton::Outcome::converged) {
      m_balanced = m_newton.iterate();
      m_report.load_factor = m_reached = m_next;
      ++m_report.load_steps;
      m_step *= 2.0;
      if (m_reached >= 1.0) return finish();
    } else if (!halve_load_step(outcome)) {
      m_phase = StepPhase::failed;
      return;
    }
    outcome = begin_load_step();
  }
  m_phase = StepPhase::updated;
}

// False: this was the last attempt.
bool Solve::halve_load_step(Newton::Outcome outcome) {
  if (outcome != Newton::Outcome::cancelled) {
    m_step = 0.5 * (m_next - m_reached);
    if (m_step >= m_options.smallest_load_step) return true;
  }
  m_newton.describe();
  if (outcome == Newton::Outcome::cancelled) {
    m_report.status = Status::cancelled;
    m_report.message = is_late() ? "the time limit of " + text(m_options.time_limit) + " s has passed"
                                 : "the host asked to stop";
    return false;
  }
  // Where the iterations run out on a tangent that is still positive, more of them may help.
  const bool stuck = outcome == Newton::Outcome::stuck || m_newton.lost_stability();
  m_report.status = stuck ? Status::no_equilibrium : Status::not_converged;
  m_report.message = "no balance of forces was found beyond " + text(m_reached) +
                     " of the change of load; " + hint(stuck);
  return false;
}

std::string Solve::hint(bool stuck) const {
  if (m_euler) {
    return "a shorter time step may find it, or a longer one where forces are below what the rounding "
           "of positions makes of inertia";
  }
  if (stuck) {
    return "a law without limit point (stable_neo_hookean, log_neo_hookean), another support or the "
           "contact with the skull may be what the scene lacks";
  }
  return "the iterations ran out at a residual of " + text(m_report.residual) +
         ": more of them may help (max_iterations), or rounding leaves no better (residual_tolerance) "
         "where tets are nearly flat or Poisson's ratio is next to 0.5";
}

void Solve::finish() {
  if (!m_newton.certify(m_balanced)) {
    return fail("the last iterate, measured once more, does not meet the tolerances");
  }
  if (!(m_report.smallest_jacobian > 0.0)) {  // some laws are in balance inside out
    fail("the balance found has tet " + std::to_string(m_newton.describe()) + " inverted, det F = " +
         text(m_report.smallest_jacobian));
    m_report.status = Status::no_equilibrium;
    return;
  }
  for (std::size_t d = 0; d < m_balanced.devices.size(); ++d) {
    DeviceMotion& motion = m_balanced.devices[d];
    if (m_euler) {
      motion.velocity = m_euler->velocity(d, motion.beam);
    } else {
      motion.velocity.setZero(motion.beam.x.rows(), 3);
    }
  }
  m_report.tangent = m_newton.examine_tangent();
  m_report.message = remark();
  m_report.status = Status::converged;
  m_phase = StepPhase::converged;
}

// What a host should know of a balance that was found.
std::string Solve::remark() const {
  std::string said;
  if (m_report.tangent == Definiteness::indefinite) {
    said = "the balance found may not be stable: the tangent of the tissue is not positive definite there, "
           "as it is past a limit point, in buckling, or where a law has lost its ellipticity";
  }
  if (m_report.blas_threads != 1) {
    const std::string count = std::to_string(m_report.blas_threads);
    said += (said.empty() ? "" : "; ") + std::string("the same bits are not promised again: the BLAS ") +
            (m_report.blas_threads > 1 ? "may use " + count + " threads"
                                       : std::string("does not tell how many threads it uses"));
  }
  return said;
}

void Solve::fail(const std::string& message) {
  m_report.status = Status::not_converged;
  m_report.message = message;
  m_phase = StepPhase::failed;
}

void Solve::fail_by_exception(const char* call) noexcept {
  m_report.status = Status::not_converged;
  m_phase = StepPhase::failed;
  try {
    m_report.message = std::string("an exception has ended ") + call + "()";
  } catch (...) {  // no memory for the sentence
    m_report.message.clear();
  }
}

Points Solve::velocity() const {
  return m_euler ? m_euler->velocity(m_balanced.u) : Points(Points::Zero(m_balanced.u.rows(), 3));
}

}  // namespace brainshift
