// Square linear systems that may be singular.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>

#include "mcp/problem.hpp"

namespace brainshift::mcp {

// Solves A x = b: exactly where A is regular, otherwise the x of least norm among those of least
// residual. Directions below 1e-10 of the largest count as null: the compliance W = H A^-1 H^T of a
// duplicated contact is singular only up to the accuracy of the factorisation behind it.
class MinimumNormSolver {
 public:
  explicit MinimumNormSolver(const MatrixXd& A);

  Index rank() const { return m_rank; }
  VectorXd solve(const VectorXd& b) const;

 private:
  enum class Kind { empty, cholesky, lu, orthogonal };

  VectorXd apply(const VectorXd& b) const;

  MatrixXd m_matrix;
  VectorXd m_row_scale;  // each row's largest entry to 1: unsymmetric scales do not cost rank
  Kind m_kind = Kind::empty;
  Index m_rank = 0;
  Eigen::LLT<MatrixXd> m_cholesky;
  Eigen::PartialPivLU<MatrixXd> m_lu;
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> m_orthogonal;
};

// The rows and columns of M, the entries of v, named by `rows`.
MatrixXd sub_matrix(const MatrixXd& M, const std::vector<Index>& rows,
                    const std::vector<Index>& columns);
VectorXd sub_vector(const VectorXd& v, const std::vector<Index>& rows);

// z with the rows that `sides` puts on a bound held there and w = 0 (as near as can be) elsewhere.
struct SideSolution {
  VectorXd z;
  bool regular;  // the rows between their bounds are independent
};
SideSolution solve_on_sides(const Problem& problem, const std::vector<Side>& sides);

}  // namespace brainshift::mcp
