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
    m_llt.analyzePattern(copy(matrix));
    m_entries = std::int64_t(matrix.values().size());
    m_nonzeros = 0.0;
  }

  // What the analysis has made room for; a copy of the matrix and its permuted one while it works.
  FactorSize size() const override {
    constexpr auto entry = std::int64_t(sizeof(double) + sizeof(int));
    return {m_llt.entries() * entry, 2 * m_entries * entry};
  }
  // Columns are kept in full.
  std::vector<std::int64_t> reach(const SparseColumns& C) const override {
    return std::vector<std::int64_t>(std::size_t(C.cols()), std::int64_t(C.rows()));
  }

  bool factorise(const BlockMatrix& matrix) override {
    keep(0);
    m_llt.factorize(copy(matrix));
    if (m_llt.info() != Eigen::Success) return false;
    m_nonzeros = double(m_llt.matrixL().nestedExpression().nonZeros());
    return true;
  }

  void solve(Eigen::MatrixXd& x) override {
    for_chunks(m_threads, Index(x.cols()),
               [&](Index c) { x.col(c) = m_llt.solve(x.col(c)).eval(); });
  }

  bool round_factor() override { return false; }

  void append(const SparseColumns& C) override {
    const auto before = m_columns.cols();
    Eigen::MatrixXd more = C;
    for_chunks(m_threads, Index(more.cols()),
               [&](Index c) { more.col(c) = m_llt.matrixL().solve(more.col(c)).eval(); });
    m_columns.conservativeResize(C.rows(), before + C.cols());
    m_columns.rightCols(C.cols()) = more;
    m_product.conservativeResize(m_columns.cols(), m_columns.cols());
    m_product.bottomRows(C.cols()) = more.transpose() * m_columns;
    m_product.topRightCorner(before, C.cols()) = m_product.bottomLeftCorner(C.cols(), before).transpose();
  }
  void keep(Eigen::Index count) override {
    m_columns.conservativeResize(m_columns.rows(), count);
    m_product.conservativeResize(count, count);
  }
  Eigen::Index column_count() const override { return m_columns.cols(); }
  const Eigen::MatrixXd& compliance() const override { return m_product; }

  Eigen::VectorXd forward(const Eigen::VectorXd& b) override { return m_llt.matrixL().solve(b); }
  Eigen::VectorXd project(const Eigen::VectorXd& z) const override { return m_columns.transpose() * z; }
  Eigen::VectorXd backward(const Eigen::VectorXd& z, const Eigen::VectorXd& a) override {
    return m_llt.matrixU().solve(a.size() > 0 ? Eigen::VectorXd(z + m_columns * a) : z);
  }

  void set_threads(int threads) override { m_threads = threads; }

  double factor_nonzeros() const override { return m_nonzeros; }

 private:
  using Sparse = SparseColumns::Base;

  static SparseColumns copy(const BlockMatrix& matrix) {
    const int size = 3 * matrix.blocks();
    return Eigen::Map<const Sparse>(size, size, Eigen::Index(matrix.values().size()),
                                    matrix.scalar_columns().data(), matrix.scalar_rows().data(),
                                    matrix.values().data());
  }

  // The matrix comes in nested-dissection order, so none is chosen here.
  class Factor : public Eigen::SimplicialLLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>> {
   public:
    std::int64_t entries() const { return std::int64_t(m_matrix.nonZeros()); }   // known once it is analysed
  };
  Factor m_llt;
  Eigen::MatrixXd m_columns, m_product;   // L^-1 C and C^T A^-1 C
  double m_nonzeros = 0.0;
  std::int64_t m_entries = 0;   // of the matrix
  int m_threads = 1;
};

}  // namespace

std::unique_ptr<SpdSolver> make_spd_solver() { return std::make_unique<EigenSolver>(); }

}  // namespace brainshift
