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
  Stopwatch watch(m_report.seconds_assembly);
  m_eq.tangent(m_state.u, m_forces, m_state.multipliers, m_definite, m_cache.stiffness);
  if (m_euler) m_euler->add_tangent(m_cache.stiffness);
  m_terms = m_eq.head_terms(m_state.u, m_forces);
  m_columns.clear();
  m_rows.clear();
  for (const RankOne& term : m_terms) {
    m_columns.push_back(m_eq.blocks().gather(term.column));
    m_rows.push_back(m_eq.blocks().gather(term.row));
  }
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

// Solves (K + sum column row^T) y = T^T force for each column, on the admissible directions
// (Sherman, Morrison, Woodbury); the answer is expanded to motions of the blocks.
Eigen::MatrixXd Newton::solve_tissue(const Reduction& reduction,
                                     const Eigen::MatrixXd& forces) const {
  const auto terms = Eigen::Index(m_columns.size()), count = forces.cols();
  Eigen::MatrixXd y(forces.rows(), count + terms), rows(forces.rows(), terms);
  for (Eigen::Index k = 0; k < count; ++k) y.col(k) = reduction.restrict_force(forces.col(k));
  for (Eigen::Index k = 0; k < terms; ++k) {
    y.col(count + k) = reduction.restrict_force(m_columns[std::size_t(k)]);
    rows.col(k) = reduction.restrict_force(m_rows[std::size_t(k)]);
  }
  m_cache.solver->solve(y);
  if (terms > 0) {
    const Eigen::MatrixXd columns = y.rightCols(terms);
    const Eigen::MatrixXd small =
        Eigen::MatrixXd::Identity(terms, terms) + rows.transpose() * columns;
    y.leftCols(count) -= columns * small.partialPivLu().solve(rows.transpose() * y.leftCols(count));
  }
  Eigen::MatrixXd moved(forces.rows(), count);
  for (Eigen::Index k = 0; k < count; ++k) moved.col(k) = reduction.expand(y.col(k));
  return moved;
}

// The step of tissue and devices, and the multipliers of contact and coupling rows.
Newton::Step Newton::direction(const Reduction& reduction) {
  Stopwatch watch(m_report.seconds_factor);
  const Eigen::VectorXd& c = reduction.particular();
  Eigen::VectorXd product;
  m_cache.stiffness.multiply(c, product);
  Eigen::VectorXd rhs = m_load - product;
  for (std::size_t k = 0; k < m_columns.size(); ++k) rhs -= m_columns[k] * m_rows[k].dot(c);

  Step step;
  Eigen::VectorXd pushed = m_load;  // with what the coupling adds
  if (m_coupling.empty()) {
    step.dx = solve_tissue(reduction, rhs) + c;
  } else {
    couple(reduction, rhs, step, pushed);
  }
  m_cache.stiffness.multiply(step.dx, product);
  Eigen::VectorXd unbalanced = pushed - product;
  for (std::size_t k = 0; k < m_columns.size(); ++k) {
    unbalanced -= m_columns[k] * m_rows[k].dot(step.dx);
  }
  step.multipliers.assign(m_active.size() + 1, 0.0);  // the last one collects fixed rows
  reduction.multipliers(unbalanced, step.multipliers);
  step.multipliers.pop_back();
  step.slope = m_load.dot(step.dx);
  for (std::size_t d = 0; d < step.dq.size(); ++d) step.slope += m_device_load[d].dot(step.dq[d]);
  predict(step);
  return step;
}

// The factor at hand, with rows and forces of today.
bool Newton::reuse_factor() {
  m_step = direction(make_reduction(&*m_factored));
  return m_step.dx.allFinite();
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

// Factor and step at the assembled tangent; the active set is improved on the way.
bool Newton::find_step() {
  if (!factorise_devices()) return false;
  choose_active();
  m_lost_stability = false;
  bool singular = false;
  for (int change = 0, shifts = 0;;) {
    const Reduction reduction = make_reduction();
    if (!factorise(reduction, singular)) return false;
    m_step = direction(reduction);
    singular = flies(m_step) && ++shifts < max_shifts;
    if (singular) continue;
    if (!m_step.dx.allFinite()) return false;
    const std::vector<char> used = m_active;
    m_factored = reduction;
    if (!update_active(m_step)) return true;
    if (++change >= max_active_set_changes) {
      m_active = used;
      return true;
    }
  }
}

}  // namespace brainshift
