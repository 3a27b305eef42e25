// Symmetric block-tridiagonal matrix of 6 x 6 blocks (a beam's stiffness: one block per node) and
// its factor L D L^T, O(n) in time and memory.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/StdVector>

#include "brainshift/types.hpp"

namespace brainshift {

using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat12 = Eigen::Matrix<double, 12, 12>;

class BlockTridiagonal {
 public:
  explicit BlockTridiagonal(Index blocks = 0);

  Index blocks() const { return Index(m_diagonal.size()); }
  Index rows() const { return 6 * blocks(); }

  void set_zero();
  Mat6& diagonal(Index i) { return m_diagonal[std::size_t(i)]; }
  const Mat6& diagonal(Index i) const { return m_diagonal[std::size_t(i)]; }
  // Block (i + 1, i); block (i, i + 1) is its transpose.
  Mat6& lower(Index i) { return m_lower[std::size_t(i)]; }
  const Mat6& lower(Index i) const { return m_lower[std::size_t(i)]; }
  // Adds the symmetric matrix of the element between blocks i and i + 1.
  void add_element(Index i, const Mat12& matrix);

  // Takes row and column `dof` out: zeros, and its own diagonal entry (or 1) kept.
  void fix(Index dof);
  // The same for the spin of node i about `axis` (unit): 5 of its dofs stay, in no coordinate's favour.
  void fix_spin(Index i, const Vec3& axis);

  Eigen::VectorXd multiply(const Eigen::VectorXd& x) const;
  Eigen::VectorXd diagonal_entries() const;
  Eigen::MatrixXd dense() const;

 private:
  using Blocks = std::vector<Mat6, Eigen::aligned_allocator<Mat6>>;
  Blocks m_diagonal, m_lower;
};

class BlockTridiagonalFactor {
 public:
  // Factorises without pivoting. Negative pivots are allowed and counted, by Sylvester's law the
  // number of negative eigenvalues. False: a pivot vanishes or is not finite; do not solve.
  bool factorise(const BlockTridiagonal& matrix);
  Index negative_pivots() const { return m_negative; }
  bool positive() const { return m_usable && m_negative == 0; }

  // Overwrites each column of x (6 blocks() rows) with the solution for it.
  void solve(Eigen::Ref<Eigen::MatrixXd> x) const;

 private:
  using Blocks = std::vector<Mat6, Eigen::aligned_allocator<Mat6>>;
  Blocks m_diagonal;  // unit lower triangle and pivots of each block
  Blocks m_lower;     // block (i + 1, i) of L
  Index m_negative = 0;
  bool m_usable = false;
};

}  // namespace brainshift
