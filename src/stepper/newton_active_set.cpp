// The active set of the one-sided rows, and what a set leaves of the unknowns.
#include <algorithm>
#include <cmath>

#include "stepper/newton.hpp"
#include "stepper/norms.hpp"

namespace brainshift {
namespace {

// Part of the body's diameter within which obstacles are looked for in one change of the set.
constexpr double reach_of_a_step = 0.01;

}  // namespace

// What the fixed rows of a block leave of a direction.
Vec3 Newton::free_part(Index block, const Vec3& direction) const {
  return m_free[std::size_t(block)] * direction;
}

// Change of a contact row's gap for a unit push along it; 0 where fixed rows hold both sides: such
// a row can do nothing and is left out.
double Newton::mobility(std::size_t r) const {
  const ContactRow& row = m_eq.contacts().row(r);
  const Vec3& n = m_forces.gaps[r].normal;
  double sum = n.dot(free_part(row.node, n));
  if (row.partner >= 0) sum += n.dot(free_part(row.partner, n));
  return sum > 1e-12 * n.squaredNorm() ? sum : 0.0;
}

double Newton::local_stiffness(Index block) const {
  return m_cache.stiffness.get(m_cache.stiffness.slot_at(block, 0)).trace() / 3.0;
}

// Primal-dual prediction: a row is active where its multiplier outweighs its gap, both as forces.
void Newton::choose_active() {
  const ContactRows& contacts = m_eq.contacts();
  m_active.assign(contacts.size(), 0);
  for (std::size_t r = 0; r < contacts.size(); ++r) {
    if (mobility(r) == 0.0) continue;
    const double stiffness = local_stiffness(contacts.row(r).node);
    m_active[r] = m_state.multipliers[r] - stiffness * m_forces.gaps[r].gap > 0.0;
  }
}

bool Newton::update_active(const Step& step) {
  const ContactRows& contacts = m_eq.contacts();
  const double diameter = m_eq.mesh().diameter();
  const double slack = 1e-12 * diameter;
  // A floppy body would fly far past its obstacles: only those met early on the way are added.
  const double reach = std::min(1.0, reach_of_a_step * diameter / max_norm(step.dx));
  bool changed = false;
  for (std::size_t r = 0; r < contacts.size(); ++r) {
    if (m_active[r]) {
      if (step.multipliers[r] < 0.0) {
        m_active[r] = 0;
        changed = true;
      }
      continue;
    }
    const ContactRow& row = contacts.row(r);
    const GapSample& g = m_forces.gaps[r];
    if (mobility(r) == 0.0) continue;
    double change = g.normal.dot(step.dx.segment<3>(3 * row.node));
    if (row.partner >= 0) change -= g.normal.dot(step.dx.segment<3>(3 * row.partner));
    if (g.gap + reach * change < -slack) {
      m_active[r] = 1;
      changed = true;
    }
  }
  return changed;
}

std::vector<NodeRow> Newton::rows_of(const std::vector<char>& active) const {
  std::vector<NodeRow> rows = m_eq.fixed_rows();
  const std::size_t untagged = m_active.size();  // multipliers of fixed rows are not kept
  const Points& u = m_state.u;
  for (NodeRow& row : rows) {
    row.value = -row.normal.dot(u.row(Eigen::Index(row.tag)).transpose());
    row.tag = untagged;
  }
  for (int pass = 0; pass < 2; ++pass) {  // rows of one node first, then pairs
    for (std::size_t r = 0; r < m_active.size(); ++r) {
      const ContactRow& row = m_eq.contacts().row(r);
      if (!active[r] || (row.partner >= 0) != (pass == 1)) continue;
      rows.push_back({row.node, row.partner, m_forces.gaps[r].normal, -m_forces.gaps[r].gap, r});
    }
  }
  return rows;
}

}  // namespace brainshift
