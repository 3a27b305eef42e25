// How far to go along a step: backtracking on the energy along the feasible way.
#include <algorithm>
#include <cmath>

#include "stepper/newton.hpp"
#include "stepper/stopwatch.hpp"
#include "stepper/sufficient_decrease.hpp"

namespace brainshift {
namespace {

constexpr double closed_gap = 1e-13;   // diameters

// Neither a tet that was whole and is inverted, nor anything that is no number.
bool no_new_inversion(const Eigen::VectorXd& before, const Eigen::VectorXd& now) {
  for (Eigen::Index t = 0; t < now.size(); ++t) {
    if (!(now[t] > 0.0) && before[t] > 0.0) return false;
  }
  return true;
}

}  // namespace

// Moves nodes back onto the surfaces they have passed, and active ones to the gap the step gives
// them (what is left of theirs after `part` of the way), so that every iterate is feasible and the
// energy alone can judge a step.
void Newton::make_feasible(double part, Points& u, std::vector<char>& touched) const {
  const ContactRows& contacts = m_eq.contacts();
  const double slack = closed_gap * m_eq.mesh().diameter();
  touched = m_active;
  std::vector<char> stirred(std::size_t(m_eq.blocks().count()), 1), before;   // blocks moved in a sweep
  for (int sweep = 0; sweep < 20; ++sweep) {
    double worst = 0.0;
    before.assign(stirred.size(), 0);
    std::swap(before, stirred);
    for (std::size_t r = 0; r < contacts.size(); ++r) {
      const ContactRow& row = contacts.row(r);
      const auto moved = [&](Index block) {
        return block >= 0 && (before[std::size_t(block)] || stirred[std::size_t(block)]);
      };
      if (!moved(row.node) && !moved(row.partner)) continue;   // as it was found
      const GapSample g = contacts.sample(r, u);
      const Vec3 push = free_part(row.node, g.normal);
      const Vec3 back = row.partner >= 0 ? free_part(row.partner, g.normal) : Vec3(Vec3::Zero());
      const double mobility = g.normal.dot(push + back);
      if (mobility <= 1e-12 * g.normal.squaredNorm()) continue;  // held on both sides
      if (g.gap < -slack) touched[r] = 1;
      const double target = m_active[r] ? (1.0 - part) * std::max(m_forces.gaps[r].gap, 0.0) : 0.0;
      const double over = g.gap - target;
      if (!touched[r] || std::abs(over) <= slack) continue;
      worst = std::max(worst, std::abs(over));
      m_eq.blocks().move(row.node, -over / mobility * push, u);
      stirred[std::size_t(row.node)] = 1;
      if (row.partner < 0) continue;
      m_eq.blocks().move(row.partner, over / mobility * back, u);
      stirred[std::size_t(row.partner)] = 1;
    }
    if (worst == 0.0) break;
  }
}

// What a step lowers: the energy stored, and in a step in time the incremental potential of inertia
// and damping, docs/theory.md (11).
double Newton::potential(const Forces& forces, const Points& u, const std::vector<DeviceMotion>& motions) const {
  const double stored = forces.stored + device_energy(motions);
  return m_euler ? stored + m_euler->potential(u, motions) : stored;
}

// Once in a search for balance the first full step may raise the energy. Where a slender body turns far the
// linearised step stretches it, and the next one takes that back; cut short, the way there is far longer.
// docs/decisions/speed.md
bool Newton::borrow(double change) {
  if (!m_may_borrow || m_lost_stability || m_definite || !std::isfinite(change)) return false;
  m_may_borrow = false;
  m_credit = Credit{m_state, 0.0, m_iteration};
  return true;
}

void Newton::pay(double change) {
  if (m_credit && (m_credit->open += change) < 0.0) m_credit.reset();
}

// Backtracking on the change of energy (and of what open ties and slip add to the merit); returns the
// part of the step taken, 0 if none would do.
double Newton::search(const Step& step, MechanicalState& next) {
  Stopwatch watch(m_report.seconds_line_search);
  const Points& u0 = m_state.u;
  const double energy0 = potential(m_forces, u0, m_state.devices);
  const double rows0 = merit_of_rows(m_state, step.weight);
  double pressed = step.weight * double(m_couplings.size());   // mN
  for (double multiplier : step.multipliers) pressed += std::abs(multiplier);
  std::vector<char> touched;
  double part = 1.0;
  for (int attempt = 0; attempt < 30; ++attempt) {
    next.u = u0;
    m_eq.blocks().scatter_add(step.dx, part, next.u);
    make_feasible(part, next.u, touched);
    move_devices(step, part, next);
    const bool finite = next.u.allFinite();
    Forces forces = finite ? m_eq.forces(next.u) : Forces();
    if (!finite || !no_new_inversion(m_forces.jacobians, forces.jacobians)) {
      part *= 0.5;
      continue;
    }
    const double energy1 = potential(forces, next.u, next.devices);
    double work = m_eq.external_work(u0, m_forces.external, next.u, forces.external) +
                  m_offset.tissue.dot(m_eq.blocks().gather_motion(next.u - u0));
    for (std::size_t d = 0; d < step.dq.size(); ++d) {
      work += part * m_offset.devices[d].dot(step.dq[d]);
    }
    const double change = energy1 - energy0 - work + merit_of_rows(next, step.weight) - rows0;
    // Rounding of energies, and of the gaps of contacts and ties that are as closed as they can be.
    const double noise = 1e-12 * (std::abs(energy0) + std::abs(energy1) + std::abs(work)) +
                         closed_gap * m_eq.mesh().diameter() * pressed;
    const bool decreased = sufficient_decrease(change, part * step.predicted, noise);
    if (decreased || (attempt == 0 && borrow(change))) {
      pay(change);
      m_active = touched;
      m_forces = std::move(forces);
      m_forces_at = next.u;
      return part;
    }
    // Minimum of the parabola through value and slope at 0 and the value here, kept in [0.1, 0.5].
    const double bend = change + part * step.predicted;
    const double best = bend > 0.0 ? 0.5 * part * part * step.predicted / bend : 0.5 * part;
    part = std::clamp(best, 0.1 * part, 0.5 * part);
  }
  return 0.0;
}

}  // namespace brainshift
