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

// What the factor gives is kept with it: the heads' part, and how the tracks of devices give way.
void Newton::keep_factor(const Reduction& reduction) {
  Stopwatch watch(m_report.seconds_factor);
  const auto terms = Eigen::Index(m_columns.size()), size = 3 * Eigen::Index(m_eq.blocks().count());
  Factor factor{reduction, m_active, Eigen::MatrixXd(size, terms), Eigen::MatrixXd(size, terms), {}};
  for (Eigen::Index k = 0; k < terms; ++k) {
    factor.term_rows.col(k) = reduction.restrict_force(m_rows[std::size_t(k)]);
    factor.term_moves.col(k) = reduction.restrict_force(m_columns[std::size_t(k)]);
  }
  if (terms > 0) m_cache.solver->solve(factor.term_moves);
  if (!m_coupling.empty()) {
    const SparseColumns C = reduction.restrict_columns(m_path_columns);
    factor.path = m_cache.solver->compliance(C);
    if (terms > 0) {
      Eigen::MatrixXd moved = factor.term_rows;
      m_cache.solver->solve(moved);
      const Eigen::MatrixXd small = Eigen::MatrixXd::Identity(terms, terms) +
                                    factor.term_rows.transpose() * factor.term_moves;
      const Eigen::MatrixXd left = C.transpose() * factor.term_moves, right = C.transpose() * moved;
      factor.path -= left * small.partialPivLu().solve(right.transpose());
    }
  }
  m_factor = std::move(factor);
}

// (K + sum column row^T) dx.
Eigen::VectorXd Newton::times_tangent(const Eigen::VectorXd& dx) const {
  Eigen::VectorXd product;
  m_cache.stiffness.multiply(dx, product);
  for (std::size_t k = 0; k < m_columns.size(); ++k) product += m_columns[k] * m_rows[k].dot(dx);
  return product;
}

// On the admissible directions of the factor's reduction (Sherman, Morrison, Woodbury).
Eigen::VectorXd Newton::solve_factored(const Eigen::VectorXd& y) const {
  Eigen::MatrixXd x = y;
  m_cache.solver->solve(x);
  const auto terms = m_factor->term_rows.cols();
  if (terms > 0) {
    const Eigen::MatrixXd small = Eigen::MatrixXd::Identity(terms, terms) +
                                  m_factor->term_rows.transpose() * m_factor->term_moves;
    x -= m_factor->term_moves * small.partialPivLu().solve(m_factor->term_rows.transpose() * x);
  }
  return x;
}

// dx with T^T tangent dx = T^T force among the motions the rows allow; the factor is that of `reduction`.
Eigen::VectorXd Newton::solve_tissue(const Reduction& reduction, const Eigen::VectorXd& force) const {
  const Eigen::VectorXd& c = reduction.particular();
  const Eigen::VectorXd b = reduction.restrict_force(force - times_tangent(c));
  return reduction.expand(solve_factored(b)) + c;
}

// The step of tissue and devices, and the multipliers of contact and coupling rows.
Newton::Step Newton::direction(const Reduction& reduction) {
  Stopwatch watch(m_report.seconds_factor);
  Step step;
  Eigen::VectorXd pushed = m_load;  // with what the coupling adds
  if (m_coupling.empty()) {
    step.dx = solve_tissue(reduction, m_load);
  } else {
    couple(reduction, step, pushed);
  }
  const Eigen::VectorXd unbalanced = pushed - times_tangent(step.dx);
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
  m_step = direction(make_reduction(&m_factor->reduction));
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
    keep_factor(reduction);
    m_step = direction(reduction);
    singular = flies(m_step) && ++shifts < max_shifts;
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

}  // namespace brainshift
