#include "linear/dense_lu.hpp"

#include <limits>
#include <utility>

#include "linear/cholmod/blas_turn.hpp"

// Of the LAPACK that CHOLMOD stands on.
extern "C" {
void dgetrf_(const int* m, const int* n, double* a, const int* lda, int* ipiv, int* info);
void dgetrs_(const char* trans, const int* n, const int* nrhs, const double* a, const int* lda,
             const int* ipiv, double* b, const int* ldb, int* info);
}

namespace brainshift {

void DenseLu::compute(Eigen::MatrixXd A) {
  m_lu = std::move(A);
  const int n = int(m_lu.rows());
  m_exchanges.assign(std::size_t(n), 0);
  if (n == 0) return;
  const BlasTurn turn;
  int info = 0;
  dgetrf_(&n, &n, m_lu.data(), &n, m_exchanges.data(), &info);
  if (info > 0) m_lu.setConstant(std::numeric_limits<double>::quiet_NaN());
}

Eigen::MatrixXd DenseLu::solve(const Eigen::MatrixXd& B) const {
  Eigen::MatrixXd X = B;
  const int n = int(m_lu.rows()), columns = int(X.cols());
  if (n == 0 || columns == 0) return X;
  const BlasTurn turn;
  int info = 0;
  dgetrs_("N", &n, &columns, m_lu.data(), &n, m_exchanges.data(), X.data(), &n, &info);
  return X;
}

}  // namespace brainshift
