// Sparse Cholesky of a symmetric positive definite block matrix: one interface, two backends.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "linear/block_matrix.hpp"

namespace brainshift {

// Bytes of a factor, and those that factorise() takes beside it while it works.
struct FactorSize {
  std::int64_t factor, work;
};

class SpdSolver {
 public:
  virtual ~SpdSolver() = default;
  // Symbolic analysis in the order the matrix has (it should be fill-reducing already).
  virtual void analyse(const BlockMatrix& matrix) = 0;
  // Of the factor to come, from the analysis alone.
  virtual FactorSize size() const = 0;
  // Entries that each column of C would take beside the factor, append().
  virtual std::vector<std::int64_t> reach(const SparseColumns& C) const = 0;
  // Numeric factor A = P^T L L^T P of a matrix with the analysed pattern; false: not positive definite.
  virtual bool factorise(const BlockMatrix& matrix) = 0;
  // Overwrites each column of `x` with the solution for it.
  virtual void solve(Eigen::MatrixXd& x) = 0;

  // Rounds the factor to single precision: until the next factorise() it serves solve() alone, as well as a
  // preconditioner needs and in half the time; what needs more throws Error(internal). False: some entry has no such
  // value, or the backend none such; all is as it was.
  virtual bool round_factor() = 0;

  // Columns C kept beside the factor as Y = L^-1 P C: cheap where each has few entries (the rows it
  // reaches alone are worked on). They are forgotten with the factor.
  virtual void append(const SparseColumns& C) = 0;
  // Forgets all but the first `count`, which end where an append() has ended.
  virtual void keep(Eigen::Index count) = 0;
  virtual Eigen::Index column_count() const = 0;
  virtual const Eigen::MatrixXd& compliance() const = 0;               // Y^T Y = C^T A^-1 C
  // A^-1 (b + C a) in two halves, between which C^T A^-1 b is to be had without a solve.
  virtual Eigen::VectorXd forward(const Eigen::VectorXd& b) = 0;       // z = L^-1 P b
  virtual Eigen::VectorXd project(const Eigen::VectorXd& z) const = 0; // Y^T z = C^T A^-1 b
  virtual Eigen::VectorXd backward(const Eigen::VectorXd& z, const Eigen::VectorXd& a) = 0;

  // Threads that solves for many columns may use; no result depends on it.
  virtual void set_threads(int threads) = 0;
  // Entries of the factor.
  virtual double factor_nonzeros() const = 0;
};

std::unique_ptr<SpdSolver> make_spd_solver();

}  // namespace brainshift
