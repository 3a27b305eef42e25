// Sparse Cholesky of a symmetric positive definite block matrix: one interface, two backends.
#pragma once

#include <memory>

#include "linear/block_matrix.hpp"

namespace brainshift {

class SpdSolver {
 public:
  virtual ~SpdSolver() = default;
  // Symbolic analysis in the order the matrix has (it should be fill-reducing already).
  virtual void analyse(const BlockMatrix& matrix) = 0;
  // Numeric factor of a matrix with the analysed pattern; false: not positive definite.
  virtual bool factorise(const BlockMatrix& matrix) = 0;
  // Overwrites each column of `x` with the solution for it.
  virtual void solve(Eigen::MatrixXd& x) = 0;
  // C^T A^-1 C; cheap where each column of C has few entries (the rows it reaches alone are worked on).
  virtual Eigen::MatrixXd compliance(const SparseColumns& C) = 0;
  // Threads that solves for many columns may use; no result depends on it.
  virtual void set_threads(int threads) = 0;
  // Entries of the factor.
  virtual double factor_nonzeros() const = 0;
};

std::unique_ptr<SpdSolver> make_spd_solver();

}  // namespace brainshift
