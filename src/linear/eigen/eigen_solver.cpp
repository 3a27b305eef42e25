// Eigen's simplicial Cholesky behind SpdSolver: the permissive build.
#include <Eigen/SparseCholesky>

#include "brainshift/error.hpp"
#include "linear/spd_solver.hpp"
#include "threads/for_chunks.hpp"

namespace brainshift {
namespace {

class EigenSolver final : public SpdSolver {
 public:
  void analyse(const BlockMatrix& matrix) override {
    m_llt.analyzePattern(view(matrix));
    m_nonzeros = 0.0;
  }

  bool factorise(const BlockMatrix& matrix) override {
    m_llt.factorize(view(matrix));
    if (m_llt.info() != Eigen::Success) return false;
    m_nonzeros = double(m_llt.matrixL().nestedExpression().nonZeros());
    return true;
  }

  void solve(Eigen::MatrixXd& x) override {
    for_chunks(m_threads, Index(x.cols()),
               [&](Index c) { x.col(c) = m_llt.solve(x.col(c)).eval(); });
  }

  Eigen::MatrixXd compliance(const SparseColumns& C) override {
    Eigen::MatrixXd x = C;
    solve(x);
    Eigen::MatrixXd product = C.transpose() * x;
    return 0.5 * (product + product.transpose());
  }

  void set_threads(int threads) override { m_threads = threads; }

  double factor_nonzeros() const override { return m_nonzeros; }

 private:
  using Sparse = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

  static Sparse view(const BlockMatrix& matrix) {
    const int size = 3 * matrix.blocks();
    return Eigen::Map<const Sparse>(size, size, Eigen::Index(matrix.values().size()),
                                    matrix.scalar_columns().data(), matrix.scalar_rows().data(),
                                    matrix.values().data());
  }

  // The matrix comes in nested-dissection order, so none is chosen here.
  Eigen::SimplicialLLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>> m_llt;
  double m_nonzeros = 0.0;
  int m_threads = 1;
};

}  // namespace

std::unique_ptr<SpdSolver> make_spd_solver() { return std::make_unique<EigenSolver>(); }

}  // namespace brainshift
