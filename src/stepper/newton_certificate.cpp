// What a state is worth: residual, complementarity, violation, energies.
#include <algorithm>
#include <cmath>
#include <limits>

#include "stepper/newton.hpp"
#include "stepper/norms.hpp"

namespace brainshift {
namespace {

constexpr double rounding_up = 1.0 + 1e-9;
// Of the load on the softest tissue; more than that is not rounding of the forces in a hard one, which
// is about 1e-6 where that is 1e10 times as hard (bench/stability/run).
constexpr double most_open = 1e-4;

}  // namespace

void Newton::measure() {
  const Blocks& blocks = m_eq.blocks();
  const Eigen::VectorXd contact = m_eq.contact_force(m_forces, m_state.multipliers);
  const Eigen::VectorXd coupling = coupling_force();
  const Eigen::VectorXd total = m_load + contact + coupling;
  const Reduction fixed(blocks.count(), m_eq.fixed_rows());
  const Eigen::VectorXd rest = fixed.project(total);
  const double constraint =
      std::max({max_norm(contact), max_norm(coupling), max_norm(total - rest)});
  double scale = std::max({max_norm(blocks.gather(m_forces.internal)),
                           max_norm(blocks.gather(m_forces.external) + m_offset.tissue), constraint,
                           m_eq.softest_floor()});
  if (m_euler) scale = std::max({scale, max_norm(m_inertia), max_norm(m_damping)});
  m_softest_scale = scale;
  scale = std::max(scale, m_eq.force_floor());
  m_state.open_force = std::max(max_norm(rest), device_residual());
  // A norm may skip what is not a number; a certificate must not.
  bool finite = std::isfinite(scale) && total.allFinite();
  for (const Eigen::VectorXd& load : m_device_load) finite = finite && load.allFinite();
  if (!finite) m_state.open_force = std::numeric_limits<double>::infinity();
  m_report.residual = finite ? m_state.open_force / scale : m_state.open_force;
  m_report.complementarity = 0.0;
  measure_coupling(scale);
  m_state.open_tie = m_report.tie_gap;
  m_report.violation = 0.0;
  m_report.active_contacts = 0;
  for (std::size_t r = 0; r < m_forces.gaps.size(); ++r) {
    const double gap = m_forces.gaps[r].gap, multiplier = m_state.multipliers[r];
    if (mobility(r) == 0.0) continue;
    m_report.violation = std::max(m_report.violation, -gap);
    m_report.complementarity =
        std::max(m_report.complementarity,
                 std::abs(std::min(gap / m_eq.mesh().diameter(), multiplier / scale)));
    // Forces below the tolerance are rounding, not contact.
    if (multiplier > m_options.residual_tolerance * scale) ++m_report.active_contacts;
  }
}

// As good as where the last solve ended, or far better than this one is asked to be: small changes of the
// load add up until they are neither.
bool Newton::unchanged(const MechanicalState& start) const {
  if (m_report.complementarity > m_options.complementarity_tolerance) return false;
  const double ties = 1e-4 * m_options.correction_tolerance * m_eq.mesh().diameter();
  const bool still = !m_euler && m_report.residual <= m_options.residual_tolerance;
  return (m_state.open_force <= 1e-4 * m_options.residual_tolerance * m_softest_scale ||
          (still && m_state.open_force <= rounding_up * start.open_force)) &&
         (m_report.tie_gap <= ties || (still && m_report.tie_gap <= rounding_up * start.open_tie));
}

bool Newton::small_enough(double last_correction) const {
  return m_report.residual <= m_options.residual_tolerance &&
         m_state.open_force <= std::max(m_options.residual_tolerance, most_open) * m_softest_scale &&
         m_report.complementarity <= m_options.complementarity_tolerance &&
         m_report.tie_gap <= m_options.correction_tolerance * m_eq.mesh().diameter() &&
         last_correction <= m_options.correction_tolerance * m_eq.mesh().diameter();
}

Offset Newton::unbalanced(const MechanicalState& state) {
  m_state = state;
  m_offset = no_offset();
  refresh();
  Offset total{m_load + m_eq.contact_force(m_forces, m_state.multipliers) + coupling_force(),
               coupled_device_load()};
  return total;
}

bool Newton::certify(const MechanicalState& state) {
  m_state = state;
  m_offset = no_offset();
  refresh();
  measure();
  describe();
  return small_enough(m_report.last_correction);
}

Eigen::Index Newton::describe() {
  const Points& u = m_state.u;
  m_report.energy = m_forces.stored + device_energy(m_state.devices);
  m_report.kinetic_energy = m_euler ? m_euler->kinetic_energy(u, m_state.devices) : 0.0;
  Eigen::Index tet = 0;
  m_report.smallest_jacobian = m_forces.jacobians.minCoeff(&tet);
  return tet;
}

}  // namespace brainshift
