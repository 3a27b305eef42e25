// Symmetric sparse matrix of 3 x 3 blocks, lower triangle, in the column layout CHOLMOD and Eigen
// read without a copy. Off-diagonal blocks are full; diagonal blocks are full too (their upper part
// is ignored by the solvers), which keeps every block at a fixed stride.
#pragma once

#include <algorithm>
#include <vector>

#include "brainshift/types.hpp"
#include "linear/sparse_columns.hpp"

namespace brainshift {

class BlockMatrix {
 public:
  // Where a block lives in values(): entry (r, c) at offset + c * stride + r.
  struct Slot {
    Index offset;
    Index stride;
  };

  BlockMatrix() = default;
  // adjacency[i]: sorted neighbours of block i, without i; symmetric.
  explicit BlockMatrix(const std::vector<Indices>& adjacency);

  Index blocks() const { return m_blocks; }
  Index block_nonzeros() const { return Index(m_rows.size()); }
  // Row blocks of block column j, the diagonal first, ascending.
  const Index* rows_begin(Index j) const { return m_rows.data() + m_start[std::size_t(j)]; }
  const Index* rows_end(Index j) const { return m_rows.data() + m_start[std::size_t(j) + 1]; }

  // row >= col; throws Error(internal) if not in the pattern.
  Slot slot(Index row, Index col) const;
  Slot slot_at(Index col, Index k) const;  // k-th block of the column

  void set_zero() { std::fill(m_values.begin(), m_values.end(), 0.0); }
  void add(const Slot& s, const Mat3& block) {
    double* v = m_values.data() + s.offset;
    for (int c = 0; c < 3; ++c, v += s.stride) {
      for (int r = 0; r < 3; ++r) v[r] += block(r, c);
    }
  }
  void add(const BlockMatrix& other, double factor);  // of the same pattern
  Mat3 get(const Slot& s) const {
    return Eigen::Map<const Mat3, 0, Eigen::OuterStride<>>(m_values.data() + s.offset, Eigen::OuterStride<>(s.stride));
  }
  // Adds a block at (row, col) or its transpose at (col, row), whichever is in the lower triangle.
  void add_at(Index row, Index col, const Mat3& block);
  void add_to_diagonal(double value);
  double mean_diagonal() const;

  // y = K x for the symmetric matrix; x, y: 3 * blocks().
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  // Of these rows of blocks alone; y is 0 in all others.
  void multiply(const Eigen::VectorXd& x, const Indices& rows, Eigen::VectorXd& y) const;
  // K X of columns with few entries each.
  SparseColumns multiply(const SparseColumns& X) const;

  // Compressed columns of scalars, as the solvers want them.
  const std::vector<int>& scalar_columns() const { return m_scalar_columns; }
  const std::vector<int>& scalar_rows() const { return m_scalar_rows; }
  const std::vector<double>& values() const { return m_values; }

 private:
  struct Left {   // of the diagonal: k-th block of that column
    Index column, k;
  };

  void find_left();

  Index m_blocks = 0;
  std::vector<Index> m_start, m_rows;
  std::vector<Index> m_left_start;   // per row of blocks
  std::vector<Left> m_left;
  std::vector<int> m_scalar_columns, m_scalar_rows;
  std::vector<double> m_values;
};

}  // namespace brainshift
