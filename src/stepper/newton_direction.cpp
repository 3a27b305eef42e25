// The linearised problem: factors, and the step with its multipliers.
#include <Eigen/LU>

#include "stepper/newton.hpp"
#include "stepper/norms.hpp"
#include "stepper/stopwatch.hpp"

namespace brainshift {
namespace {

// Changes of the active set within one linearisation; more are left to the next iteration.
constexpr int max_active_set_changes = 4;

// A step this many diameters long: the tangent is singular, and only rounding let it be factored.
constexpr double length_of_no_step = 1e3;
constexpr int max_shifts = 12;

}  // namespace

// Assembles the tangent; definite where a former one of this solve was not positive.
void Newton::assemble() {
  assemble_stiffness();
  Stopwatch watch(m_report.seconds_assembly);
  const std::vector<RankOne> terms = m_eq.head_terms(m_state.u, m_forces);
  const auto size = 3 * Eigen::Index(m_eq.blocks().count());
  Eigen::MatrixXd columns(size, Eigen::Index(terms.size())), rows = columns;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    columns.col(Eigen::Index(k)) = m_eq.blocks().gather(terms[k].column);
    rows.col(Eigen::Index(k)) = m_eq.blocks().gather(terms[k].row);
  }
  m_linearised->set_terms(std::move(columns), std::move(rows));
}

void Newton::assemble_stiffness() {
  Stopwatch watch(m_report.seconds_assembly);
  m_eq.tangent(m_state.u, m_forces, m_state.multipliers, m_definite, m_cache.stiffness);
  if (m_euler) m_euler->add_tangent(m_cache.stiffness);
}

// singular: as it is the matrix is not worth a try.
bool Newton::factorise_shifted(const Reduction& reduction, bool singular) {
  Stopwatch watch(m_report.seconds_factor);
  const double scale = m_cache.stiffness.mean_diagonal();
  double shift = 0.0;
  for (int attempt = 0; attempt < max_shifts; ++attempt) {
    if (!singular || attempt > 0) {
      ++m_report.factorisations;
      if (m_cache.solver->factorise(m_cache.reduced)) return true;
    }
    ++m_report.shifted_factorisations;
    const double more = shift == 0.0 ? 1e-3 * scale : shift;  // doubles the shift
    m_cache.stiffness.add_to_diagonal(more);
    shift += more;
    reduction.reduce(m_cache.stiffness, scale, m_cache.reduced);
  }
  return false;
}

// The step of tissue and devices, and the multipliers of contact and coupling rows.
Newton::Step Newton::direction() {
  Stopwatch watch(m_report.seconds_factor);
  Step step;
  Eigen::VectorXd pushed = m_load;  // with what the coupling adds
  if (m_coupling.empty()) {
    step.dx = m_linearised->step({});
  } else {
    couple(step, pushed);
  }
  complete(step, pushed);
  return step;
}

// What follows from the motions of tissue and devices.
void Newton::complete(Step& step, const Eigen::VectorXd& pushed) const {
  const Eigen::VectorXd unbalanced = pushed - m_linearised->times(step.dx, m_reduction->held_blocks());
  step.multipliers.assign(m_active.size() + 1, 0.0);  // the last one collects fixed rows
  m_reduction->multipliers(unbalanced, step.multipliers);
  step.multipliers.pop_back();
  step.slope = m_load.dot(step.dx);
  for (std::size_t d = 0; d < step.dq.size(); ++d) step.slope += m_device_load[d].dot(step.dq[d]);
  predict(step);
}

bool Newton::flies(const Step& step) const {
  return !(max_norm(step.dx) <= length_of_no_step * m_eq.mesh().diameter());
}

// Factor of the reduced tangent; positive semidefinite parts and a shift where it takes them.
bool Newton::factorise(const Reduction& reduction, bool singular) {
  reduction.reduce(m_cache.stiffness, m_cache.stiffness.mean_diagonal(), m_cache.reduced);
  if (!m_definite && !singular) {
    Stopwatch watch(m_report.seconds_factor);
    ++m_report.factorisations;
    if (m_cache.solver->factorise(m_cache.reduced)) return true;
    ++m_report.shifted_factorisations;
  }
  m_lost_stability = true;
  if (!m_definite) {  // for this iteration
    m_definite = true;
    assemble();
    reduction.reduce(m_cache.stiffness, m_cache.stiffness.mean_diagonal(), m_cache.reduced);
  }
  return factorise_shifted(reduction, singular);
}

// The factor at hand with the rows and forces of today.
void Newton::begin_iteration() {
  Stopwatch watch(m_report.seconds_factor);
  m_linearised->begin(rows_of(m_factored), rows_of(m_active), m_state.multipliers, m_load);
}

// The factor at hand for the active set; false: it does not do.
bool Newton::serve() {
  Stopwatch watch(m_report.seconds_factor);
  const std::vector<NodeRow> rows = rows_of(m_active);
  m_reduction.emplace(m_eq.blocks().count(), rows);
  return m_linearised->serve(*m_reduction, rows, m_active.size());
}

bool Newton::make_ready(bool singular) {
  if (m_linearised->has_factor() && !singular && serve()) return true;
  if (!m_fresh) return false;
  const Reduction reduction(m_eq.blocks().count(), rows_of(m_active));
  if (!factorise(reduction, singular)) return false;
  m_factored = m_active;
  m_far_from_factor = false;
  {
    Stopwatch watch(m_report.seconds_factor);
    m_linearised->take_factor(reduction);
    if (m_turns_left > 0) m_turned_factor->take_factor(reduction, m_state.u);
  }
  begin_iteration();
  return serve();
}

// The step at the linearisation at hand; the active set is improved on the way.
bool Newton::find_step() {
  if (!factorise_devices()) return false;   // cheap, and a stiff one does not bear a stale factor
  if (m_fresh) {
    choose_active();
    m_lost_stability = false;
  } else {
    begin_iteration();
  }
  bool singular = false;
  for (int change = 0, shifts = 0;;) {
    if (!make_ready(singular)) return false;
    m_step = direction();
    singular = flies(m_step) && ++shifts < max_shifts;
    if (singular && !m_fresh) return false;
    if (singular) continue;
    if (!m_step.dx.allFinite()) return false;
    const std::vector<char> used = m_active;
    if (!update_active(m_step)) return true;
    if (++change >= max_active_set_changes) {
      m_active = used;
      return true;
    }
  }
}

// The step by conjugate gradients; none where it would take another active set.
bool Newton::find_step_by_turned_factor() {
  Stopwatch watch(m_report.seconds_factor);
  const std::vector<NodeRow> rows = rows_of(m_active);
  m_reduction.emplace(m_eq.blocks().count(), rows);
  m_far_from_factor = true;
  std::optional<Eigen::VectorXd> dx = m_turned_factor->step(rows, m_state.u, m_load);
  if (!dx) return false;
  m_step = {};
  m_step.dx = std::move(*dx);
  complete(m_step, m_load);
  const std::vector<char> used = m_active;
  if (!update_active(m_step)) return true;
  m_active = used;
  return false;
}

}  // namespace brainshift
