#include "linear/block_matrix.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "brainshift/error.hpp"

namespace brainshift {

BlockMatrix::BlockMatrix(const std::vector<Indices>& adjacency)
    : m_blocks(Index(adjacency.size())) {
  m_start.assign(adjacency.size() + 1, 0);
  std::size_t total = 0;
  for (std::size_t j = 0; j < adjacency.size(); ++j) {
    const Indices& near = adjacency[j];
    total += 1 + std::size_t(near.end() - std::upper_bound(near.begin(), near.end(), Index(j)));
  }
  if (9 * total > std::size_t(std::numeric_limits<int>::max())) {
    throw Error(ErrorCode::linear_solver, "the stiffness matrix would have " +
                                              std::to_string(9 * total) +
                                              " entries, more than 32-bit indices can count");
  }
  m_rows.reserve(total);
  for (std::size_t j = 0; j < adjacency.size(); ++j) {
    const Indices& near = adjacency[j];
    m_rows.push_back(Index(j));
    m_rows.insert(m_rows.end(), std::upper_bound(near.begin(), near.end(), Index(j)), near.end());
    m_start[j + 1] = Index(m_rows.size());
  }
  find_left();
  m_values.assign(9 * total, 0.0);
  m_scalar_rows.reserve(9 * total);
  m_scalar_columns.reserve(3 * adjacency.size() + 1);
  m_scalar_columns.push_back(0);
  for (Index j = 0; j < m_blocks; ++j) {
    for (int c = 0; c < 3; ++c) {
      for (const Index* row = rows_begin(j); row != rows_end(j); ++row) {
        for (int r = 0; r < 3; ++r) m_scalar_rows.push_back(3 * *row + r);
      }
      m_scalar_columns.push_back(int(m_scalar_rows.size()));
    }
  }
}

void BlockMatrix::find_left() {
  m_left_start.assign(std::size_t(m_blocks) + 1, 0);
  for (Index j = 0; j < m_blocks; ++j) {
    for (const Index* row = rows_begin(j) + 1; row != rows_end(j); ++row) ++m_left_start[std::size_t(*row) + 1];
  }
  for (Index i = 0; i < m_blocks; ++i) m_left_start[std::size_t(i) + 1] += m_left_start[std::size_t(i)];
  m_left.resize(std::size_t(m_left_start.back()));
  std::vector<Index> next = m_left_start;
  for (Index j = 0; j < m_blocks; ++j) {
    const Index count = Index(rows_end(j) - rows_begin(j));
    for (Index k = 1; k < count; ++k) m_left[std::size_t(next[std::size_t(rows_begin(j)[k])]++)] = {j, k};
  }
}

BlockMatrix::Slot BlockMatrix::slot_at(Index col, Index k) const {
  const Index start = m_start[std::size_t(col)];
  const Index count = m_start[std::size_t(col) + 1] - start;
  return {9 * start + 3 * k, 3 * count};
}

BlockMatrix::Slot BlockMatrix::slot(Index row, Index col) const {
  const Index* found = std::lower_bound(rows_begin(col), rows_end(col), row);
  if (found == rows_end(col) || *found != row) {
    throw Error(ErrorCode::internal, "block (" + std::to_string(row) + ", " + std::to_string(col) +
                                         ") is not in the pattern of the matrix");
  }
  return slot_at(col, Index(found - rows_begin(col)));
}

void BlockMatrix::add(const BlockMatrix& other, double factor) {
  if (other.m_values.size() != m_values.size()) {
    throw Error(ErrorCode::internal, "matrices of two patterns cannot be added");
  }
  for (std::size_t i = 0; i < m_values.size(); ++i) m_values[i] += factor * other.m_values[i];
}

void BlockMatrix::add_at(Index row, Index col, const Mat3& block) {
  if (row >= col) {
    add(slot(row, col), block);
  } else {
    add(slot(col, row), block.transpose());
  }
}

void BlockMatrix::add_to_diagonal(double value) {
  for (Index j = 0; j < m_blocks; ++j) add(slot_at(j, 0), value * Mat3::Identity());
}

double BlockMatrix::mean_diagonal() const {
  double sum = 0.0;
  for (Index j = 0; j < m_blocks; ++j) sum += get(slot_at(j, 0)).trace();
  return m_blocks ? sum / (3.0 * m_blocks) : 0.0;
}

void BlockMatrix::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  y.setZero(3 * m_blocks);
  for (Index j = 0; j < m_blocks; ++j) {
    const Index count = Index(rows_end(j) - rows_begin(j));
    const Vec3 xj = x.segment<3>(3 * j);
    Vec3 yj = get(slot_at(j, 0)) * xj;
    for (Index k = 1; k < count; ++k) {
      const Index i = rows_begin(j)[k];
      const Mat3 block = get(slot_at(j, k));
      y.segment<3>(3 * i) += block * xj;
      yj += block.transpose() * x.segment<3>(3 * i);
    }
    y.segment<3>(3 * j) += yj;
  }
}

void BlockMatrix::multiply(const Eigen::VectorXd& x, const Indices& rows, Eigen::VectorXd& y) const {
  y.setZero(3 * m_blocks);
  for (const Index i : rows) {
    const Index count = Index(rows_end(i) - rows_begin(i));
    Vec3 yi = get(slot_at(i, 0)) * x.segment<3>(3 * i);
    for (Index k = 1; k < count; ++k) yi += get(slot_at(i, k)).transpose() * x.segment<3>(3 * rows_begin(i)[k]);
    for (Index l = m_left_start[std::size_t(i)]; l < m_left_start[std::size_t(i) + 1]; ++l) {
      const Left& left = m_left[std::size_t(l)];
      yi += get(slot_at(left.column, left.k)) * x.segment<3>(3 * left.column);
    }
    y.segment<3>(3 * i) = yi;
  }
}

namespace {

struct Part {
  int column;
  Vec3 value;
};

// The non-zero blocks of each column, by row of blocks.
std::vector<std::vector<Part>> parts_of(const SparseColumns& X) {
  std::vector<std::vector<Part>> parts(std::size_t(X.rows() / 3));
  for (int c = 0; c < int(X.cols()); ++c) {
    for (SparseColumns::InnerIterator it(X, c); it; ++it) {
      std::vector<Part>& row = parts[std::size_t(it.row() / 3)];
      if (row.empty() || row.back().column != c) row.push_back({c, Vec3::Zero()});
      row.back().value[it.row() % 3] = it.value();
    }
  }
  return parts;
}

}  // namespace

SparseColumns BlockMatrix::multiply(const SparseColumns& X) const {
  const std::vector<std::vector<Part>> parts = parts_of(X);
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&entries](Index row, const Mat3& block, const std::vector<Part>& of) {
    for (const Part& part : of) {
      const Vec3 product = block * part.value;
      for (int k = 0; k < 3; ++k) entries.emplace_back(3 * row + k, part.column, product[k]);
    }
  };
  for (Index j = 0; j < m_blocks; ++j) {
    const Index count = Index(rows_end(j) - rows_begin(j));
    for (Index k = 0; k < count; ++k) {
      const Index i = rows_begin(j)[k];
      const std::vector<Part>&in_row = parts[std::size_t(i)], &in_column = parts[std::size_t(j)];
      if (in_row.empty() && in_column.empty()) continue;
      const Mat3 block = get(slot_at(j, k));
      add(i, block, in_column);
      if (i != j) add(j, block.transpose(), in_row);
    }
  }
  SparseColumns result(X.rows(), X.cols());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace brainshift
