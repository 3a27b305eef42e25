#include "linear/dense_lu.hpp"

#include <Eigen/LU>

namespace brainshift {

void DenseLu::compute(Eigen::MatrixXd A) {
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(A);
  m_lu = lu.matrixLU();
  const auto& order = lu.permutationP().indices();
  m_exchanges.assign(order.data(), order.data() + order.size());
}

Eigen::MatrixXd DenseLu::solve(const Eigen::MatrixXd& B) const {
  Eigen::MatrixXd X(B.rows(), B.cols());
  for (Eigen::Index i = 0; i < B.rows(); ++i) X.row(m_exchanges[std::size_t(i)]) = B.row(i);
  m_lu.triangularView<Eigen::UnitLower>().solveInPlace(X);
  m_lu.triangularView<Eigen::Upper>().solveInPlace(X);
  return X;
}

}  // namespace brainshift
