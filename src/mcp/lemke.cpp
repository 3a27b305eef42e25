#include "mcp/lemke.hpp"

#include <cmath>

namespace brainshift::mcp {
namespace {

// Cottle, Pang, Stone, "The Linear Complementarity Problem", algorithm 4.4.5.
// Columns: w_0 .. w_{n-1} | x_0 .. x_{n-1} | covering variable | right-hand side.
class Tableau {
 public:
  Tableau(const MatrixXd& M, const VectorXd& q) : m_n(static_cast<Index>(q.size())) {
    m_rows.resize(m_n, 2 * m_n + 2);
    m_rows << MatrixXd::Identity(m_n, m_n), -M, VectorXd::Constant(m_n, -1.0), q;
    for (Index i = 0; i < m_n; ++i) m_basis.push_back(i);
    m_right_scale = q.cwiseAbs().maxCoeff();
  }

  Index covering() const { return 2 * m_n; }
  Index complement(Index variable) const {
    return variable < m_n ? variable + m_n : variable - m_n;
  }
  bool finite() const { return m_rows.allFinite(); }

  // The first pivot: the covering variable enters where q is most negative.
  Index most_negative_row() const {
    Index row = 0;
    for (Index i = 1; i < m_n; ++i) {
      if (right(i) < right(row) || (right(i) == right(row) && lexicographically_less(i, row, -1)))
        row = i;
    }
    return row;
  }

  // The row that blocks the entering variable first; -1: none, a ray.
  Index blocking_row(Index entering) const {
    constexpr double negligible = 1e-11;
    const double least = negligible * std::max(1.0, m_rows.col(entering).cwiseAbs().maxCoeff());
    Index blocking = -1;
    for (Index i = 0; i < m_n; ++i) {
      if (m_rows(i, entering) <= least) continue;
      if (blocking < 0 || lexicographically_less(i, blocking, entering)) blocking = i;
    }
    return blocking;
  }

  // Exchanges the entering variable with the basic one of the row, which is returned.
  Index pivot(Index row, Index entering) {
    m_rows.row(row) /= m_rows(row, entering);
    const VectorXd factors = m_rows.col(entering);
    for (Index i = 0; i < m_n; ++i) {
      if (i != row && factors[i] != 0.0) m_rows.row(i) -= factors[i] * m_rows.row(row);
    }
    const Index leaving = m_basis[row];
    m_basis[row] = entering;
    return leaving;
  }

  VectorXd x() const {
    VectorXd result = VectorXd::Zero(m_n);
    for (Index i = 0; i < m_n; ++i) {
      if (m_basis[i] >= m_n && m_basis[i] < 2 * m_n) result[m_basis[i] - m_n] = right(i);
    }
    return result;
  }

  VectorXd ray(Index entering) const {
    VectorXd result = VectorXd::Zero(m_n);
    if (entering >= m_n && entering < 2 * m_n) result[entering - m_n] = 1.0;
    for (Index i = 0; i < m_n; ++i) {
      if (m_basis[i] >= m_n && m_basis[i] < 2 * m_n)
        result[m_basis[i] - m_n] = -m_rows(i, entering);
    }
    return result;
  }

 private:
  double right(Index row) const { return m_rows(row, 2 * m_n + 1); }

  // Compares rows a, b divided by their entries in `entering` (-1: as they are): right-hand side,
  // then the columns of the basis inverse, the last one first: of equal rows the first leaves, as
  // one would expect (Murty's problem then takes 2 pivots, not 2^n). The covering variable
  // wins a tie: that is the solution.
  bool lexicographically_less(Index a, Index b, Index entering) const {
    const double da = entering < 0 ? 1.0 : m_rows(a, entering);
    const double db = entering < 0 ? 1.0 : m_rows(b, entering);
    constexpr double tie = 1e-12;
    const double ra = right(a) / da, rb = right(b) / db;
    if (std::abs(ra - rb) > tie * std::max(m_right_scale, std::abs(ra))) return ra < rb;
    if (entering >= 0 && m_basis[a] == covering()) return true;
    if (entering >= 0 && m_basis[b] == covering()) return false;
    for (Index k = m_n - 1; k >= 0; --k) {
      const double ca = m_rows(a, k) / da, cb = m_rows(b, k) / db;
      if (std::abs(ca - cb) > tie * std::max(1.0, std::abs(ca))) return ca < cb;
    }
    return false;
  }

  Index m_n;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> m_rows;
  std::vector<Index> m_basis;
  double m_right_scale = 0.0;
};

}  // namespace

LemkeResult lemke(const MatrixXd& M, const VectorXd& q, int max_pivots) {
  LemkeResult result;
  result.x = VectorXd::Zero(q.size());
  if (q.size() == 0 || q.minCoeff() >= 0.0) {
    result.end = LemkeResult::End::solved;
    return result;
  }
  Tableau tableau(M, q);
  Index entering = tableau.covering(), row = tableau.most_negative_row();
  while (result.pivots < max_pivots) {
    const Index leaving = tableau.pivot(row, entering);
    ++result.pivots;
    if (!tableau.finite()) return result;
    if (leaving == tableau.covering()) {
      result.end = LemkeResult::End::solved;
      result.x = tableau.x();
      return result;
    }
    entering = tableau.complement(leaving);
    row = tableau.blocking_row(entering);
    if (row < 0) {
      result.end = LemkeResult::End::ray;
      result.direction = tableau.ray(entering);
      return result;
    }
  }
  return result;
}

}  // namespace brainshift::mcp
