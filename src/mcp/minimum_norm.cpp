#include "mcp/minimum_norm.hpp"

namespace brainshift::mcp {
namespace {

constexpr double rank_tolerance = 1e-10;
// rcond is an estimate in the 1-norm, below 1/cond_2 by up to n: one decade of margin.
constexpr double regular_rcond = 1e-11;

bool is_symmetric(const MatrixXd& A) {
  return (A - A.transpose()).cwiseAbs().maxCoeff() <= 1e-14 * A.cwiseAbs().maxCoeff();
}

}  // namespace

MinimumNormSolver::MinimumNormSolver(const MatrixXd& A) : m_matrix(A) {
  if (A.size() == 0) return;
  m_rank = static_cast<Index>(A.rows());
  m_row_scale = VectorXd::Ones(A.rows());
  if (is_symmetric(A)) {
    m_kind = Kind::cholesky;
    m_cholesky.compute(A);
    if (m_cholesky.info() == Eigen::Success && m_cholesky.rcond() > regular_rcond) return;
  }
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    const double largest = A.row(i).cwiseAbs().maxCoeff();
    if (largest > 0.0) m_row_scale[i] = 1.0 / largest;
  }
  m_matrix = m_row_scale.asDiagonal() * A;
  m_kind = Kind::lu;
  m_lu.compute(m_matrix);
  if (m_lu.rcond() > regular_rcond) return;
  m_kind = Kind::orthogonal;
  m_orthogonal.setThreshold(rank_tolerance);
  m_orthogonal.compute(m_matrix);
  m_rank = static_cast<Index>(m_orthogonal.rank());
}

VectorXd MinimumNormSolver::apply(const VectorXd& b) const {
  switch (m_kind) {
    case Kind::cholesky: return m_cholesky.solve(b);
    case Kind::lu: return m_lu.solve(b);
    case Kind::orthogonal: return m_orthogonal.solve(b);
    case Kind::empty: break;
  }
  return b;
}

VectorXd MinimumNormSolver::solve(const VectorXd& b) const {
  if (m_kind == Kind::empty) return b;
  const VectorXd right = m_row_scale.cwiseProduct(b);
  VectorXd x = apply(right);
  x += apply(right - m_matrix * x);  // one step of refinement
  return x;
}

MatrixXd sub_matrix(const MatrixXd& M, const std::vector<Index>& rows,
                    const std::vector<Index>& columns) {
  MatrixXd part(rows.size(), columns.size());
  for (std::size_t j = 0; j < columns.size(); ++j) {
    for (std::size_t i = 0; i < rows.size(); ++i) part(i, j) = M(rows[i], columns[j]);
  }
  return part;
}

VectorXd sub_vector(const VectorXd& v, const std::vector<Index>& rows) {
  VectorXd part(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) part[i] = v[rows[i]];
  return part;
}

SideSolution solve_on_sides(const Problem& problem, const std::vector<Side>& sides) {
  std::vector<Index> inner;
  VectorXd z = VectorXd::Zero(problem.size());
  for (Index i = 0; i < problem.size(); ++i) {
    switch (sides[i]) {
      case Side::lower: z[i] = problem.lower[i]; break;
      case Side::upper: z[i] = problem.upper[i]; break;
      case Side::inner: inner.push_back(i); break;
    }
  }
  const VectorXd right = -sub_vector(problem.w(z), inner);
  const MinimumNormSolver solver(sub_matrix(problem.M, inner, inner));
  const VectorXd solution = solver.solve(right);
  for (std::size_t i = 0; i < inner.size(); ++i) z[inner[i]] = solution[i];
  return {z, solver.rank() == static_cast<Index>(inner.size())};
}

}  // namespace brainshift::mcp
