// Columns with few entries each.
#pragma once

#include <Eigen/SparseCore>

namespace brainshift {

// Eigen's sparse matrix, which gives back all it has where memory runs out. Eigen's own constructors fill what
// they have made, so when that throws no destructor runs, and the array of column starts is lost (3.4, all that
// take another matrix). Here an empty one is made first. An assignment is made or not made.
// None is constructed by moving: what is left behind needs an array, too, which may not be had.
class SparseColumns : public Eigen::SparseMatrix<double, Eigen::ColMajor, int> {
 public:
  using Base = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

  SparseColumns() = default;
  SparseColumns(Eigen::Index rows, Eigen::Index cols) : Base(rows, cols) {}
  SparseColumns(const SparseColumns& other) : SparseColumns() { Base::operator=(other); }
  template <typename Expression>
  SparseColumns(const Eigen::SparseMatrixBase<Expression>& other) : SparseColumns() {
    Base::operator=(other.derived());
  }
  ~SparseColumns() = default;

  SparseColumns& operator=(const SparseColumns& other) {
    SparseColumns made(other);
    swap(made);
    return *this;
  }
  SparseColumns& operator=(SparseColumns&& other) noexcept {
    swap(other);
    return *this;
  }
  template <typename Expression>
  SparseColumns& operator=(const Eigen::SparseMatrixBase<Expression>& other) {
    SparseColumns made(other);
    swap(made);
    return *this;
  }
};

}  // namespace brainshift
