// Columns beside a supernodal Cholesky factor.
#pragma once

#include <cstdint>
#include <vector>

#include <cholmod.h>

#include "linear/block_matrix.hpp"

namespace brainshift {

// With A = P^T L L^T P these are the rows of Y = L^-1 P C, by supernode. Entries of a column of C reach
// the supernodes on their way to the root of the elimination tree and no others (Gilbert, Peierls 1988).
class FactorColumns {
 public:
  // Entries that append() would keep of each column; the factor may be a symbolic one.
  static std::vector<std::int64_t> reach(const cholmod_factor& factor, const SparseColumns& C);
  void clear();
  // Works out L^-1 P C behind what is there; throws Error(internal) for a factor of another kind.
  void append(const cholmod_factor& factor, const SparseColumns& C);
  void keep(Eigen::Index count);
  Eigen::Index count() const { return m_count; }
  const Eigen::MatrixXd& product() const { return m_product; }   // Y^T Y
  Eigen::VectorXd project(const Eigen::VectorXd& z) const;       // Y^T z
  void add(const Eigen::VectorXd& a, Eigen::VectorXd& z) const;  // z += Y a

 private:
  // What a supernode gives to some columns: their numbers, and Y^T of its rows.
  struct Part {
    int first;                  // row of Y
    std::vector<int> columns;
    Eigen::MatrixXd y;          // columns x rows
  };
  void multiply(const Part& part, int s);

  std::vector<std::vector<Part>> m_parts;   // per supernode
  Eigen::MatrixXd m_product;
  Eigen::Index m_count = 0;
};

}  // namespace brainshift
