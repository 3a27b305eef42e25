// LU with row exchanges of a dense matrix, by the library that the sparse factor stands on.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace brainshift {

class DenseLu {
 public:
  void compute(Eigen::MatrixXd A);   // square
  // A^-1 B; not finite where A is singular.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;

 private:
  Eigen::MatrixXd m_lu;
  std::vector<int> m_exchanges;
};

}  // namespace brainshift
