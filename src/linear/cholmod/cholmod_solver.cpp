// CHOLMOD behind SpdSolver. This folder is the only place that touches SuiteSparse: its Supernodal
// module is GPL-2+, see THIRD_PARTY.md.
#include <cholmod.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "brainshift/error.hpp"
#include "linear/cholmod/blas_turn.hpp"
#include "linear/cholmod/columns.hpp"
#include "linear/cholmod/single_factor.hpp"
#include "linear/spd_solver.hpp"
#include "threads/for_chunks.hpp"

// Of OpenMP, in which CHOLMOD may be built. Null where nothing has loaded it.
extern "C" int omp_get_max_active_levels(void) __attribute__((weak));
extern "C" void omp_set_max_active_levels(int) __attribute__((weak));

namespace brainshift {
namespace {

// CHOLMOD's OpenMP loops stay on the calling thread: a team of its own (four threads, whatever machine and
// host want) would spin on the cores of others and outlive the solve, and a child of the process would
// wait for it for ever. The setting is the calling thread's, and is put back. docs/decisions/threads.md
class NoTeam {
 public:
  NoTeam() {
    if (!omp_get_max_active_levels || !omp_set_max_active_levels) return;
    m_levels = omp_get_max_active_levels();
    omp_set_max_active_levels(0);
  }
  ~NoTeam() {
    if (m_levels >= 0) omp_set_max_active_levels(m_levels);
  }
  NoTeam(const NoTeam&) = delete;
  NoTeam& operator=(const NoTeam&) = delete;

 private:
  int m_levels = -1;
};

// Columns solved for together: enough for the dense kernels, few enough to share among threads.
constexpr Eigen::Index columns_per_chunk = 16;

[[noreturn]] void fail(const char* what, int status) {
  throw Error(ErrorCode::linear_solver,
              std::string("CHOLMOD ") + what + " failed: " +
                  (status == CHOLMOD_OUT_OF_MEMORY ? "out of memory"
                   : status == CHOLMOD_TOO_LARGE   ? "its factor has more than 2^31 entries"
                                                   : "status " + std::to_string(status)));
}

void configure(cholmod_common& common) {
  cholmod_start(&common);
  common.print = 0;
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_NATURAL;
  common.postorder = 1;
  common.try_catch = 1;  // no message handler of the host's is called
  common.quick_return_if_not_posdef = 1;
}

// Solves with a factor that several may read at once, in a workspace of its own.
class Workspace {
 public:
  Workspace() { configure(m_common); }
  ~Workspace() {
    cholmod_free_dense(&m_solution, &m_common);
    cholmod_free_dense(&m_y, &m_common);
    cholmod_free_dense(&m_e, &m_common);
    cholmod_finish(&m_common);
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  void solve(cholmod_factor* factor, Eigen::Ref<Eigen::MatrixXd> x, int system = CHOLMOD_A) {
    cholmod_dense b{};
    b.nrow = std::size_t(x.rows());
    b.ncol = std::size_t(x.cols());
    b.nzmax = b.nrow * b.ncol;
    b.d = b.nrow;
    b.x = x.data();
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    const NoTeam alone;
    const BlasTurn turn;
    cholmod_solve2(system, factor, &b, nullptr, &m_solution, nullptr, &m_y, &m_e, &m_common);
    if (m_common.status < CHOLMOD_OK) fail("solve", m_common.status);
    x = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(m_solution->x), x.rows(),
                                          x.cols());
  }

 private:
  cholmod_common m_common{};
  cholmod_dense *m_solution = nullptr, *m_y = nullptr, *m_e = nullptr;
};

class CholmodSolver final : public SpdSolver {
 public:
  CholmodSolver() { configure(m_common); }
  ~CholmodSolver() override {
    cholmod_free_factor(&m_factor, &m_common);
    cholmod_finish(&m_common);
  }
  CholmodSolver(const CholmodSolver&) = delete;
  CholmodSolver& operator=(const CholmodSolver&) = delete;

  void analyse(const BlockMatrix& matrix) override {
    cholmod_free_factor(&m_factor, &m_common);
    m_columns.clear();
    m_single.clear();
    cholmod_sparse a = view(matrix);
    const NoTeam alone;
    m_factor = cholmod_analyze(&a, &m_common);
    m_entries = matrix.values().size();
    if (m_common.status < CHOLMOD_OK) fail("analysis", m_common.status);
  }

  // Supernodes with their rows; a permuted copy of the matrix and the largest update while it works.
  FactorSize size() const override {
    constexpr auto entry = std::int64_t(sizeof(double)), index = std::int64_t(sizeof(int));
    const cholmod_factor& f = *m_factor;
    return {std::int64_t(f.xsize) * entry + std::int64_t(f.ssize + 2 * f.n + 3 * f.nsuper) * index,
            std::int64_t(m_entries) * (entry + index) + std::int64_t(f.maxcsize) * entry};
  }
  std::vector<std::int64_t> reach(const SparseColumns& C) const override {
    return FactorColumns::reach(*m_factor, C);
  }

  bool factorise(const BlockMatrix& matrix) override {
    cholmod_sparse a = view(matrix);
    const NoTeam alone;
    const BlasTurn turn;
    m_columns.clear();
    m_single.clear();
    cholmod_factorize(&a, m_factor, &m_common);
    if (m_common.status == CHOLMOD_NOT_POSDEF) return false;
    if (m_common.status < CHOLMOD_OK) fail("factorisation", m_common.status);
    return true;
  }

  // Chunks do not depend on the threads, so neither do the bits.
  void solve(Eigen::MatrixXd& x) override {
    if (m_single.holds()) return solve_rounded(x);
    const auto chunks = Index((x.cols() + columns_per_chunk - 1) / columns_per_chunk);
    while (m_workspaces.size() < std::size_t(chunks)) {
      m_workspaces.push_back(std::make_unique<Workspace>());
    }
    for_chunks(m_threads, chunks, [&](Index c) {
      const Eigen::Index from = c * columns_per_chunk;
      const Eigen::Index count = std::min(columns_per_chunk, x.cols() - from);
      m_workspaces[std::size_t(c)]->solve(m_factor, x.middleCols(from, count));
    });
  }

  bool round_factor() override {
    m_columns.clear();
    return m_single.holds() || m_single.take(*m_factor);
  }

  void append(const SparseColumns& C) override {
    expect_whole();
    const BlasTurn turn;
    m_columns.append(*m_factor, C);
  }
  void keep(Eigen::Index count) override { m_columns.keep(count); }
  Eigen::Index column_count() const override { return m_columns.count(); }
  const Eigen::MatrixXd& compliance() const override { return m_columns.product(); }

  Eigen::VectorXd forward(const Eigen::VectorXd& b) override {
    expect_whole();
    Eigen::VectorXd z = b;
    halves().solve(m_factor, z, CHOLMOD_P);
    halves().solve(m_factor, z, CHOLMOD_L);
    return z;
  }
  Eigen::VectorXd project(const Eigen::VectorXd& z) const override { return m_columns.project(z); }
  Eigen::VectorXd backward(const Eigen::VectorXd& z, const Eigen::VectorXd& a) override {
    expect_whole();
    Eigen::VectorXd x = z;
    m_columns.add(a, x);
    halves().solve(m_factor, x, CHOLMOD_Lt);
    halves().solve(m_factor, x, CHOLMOD_Pt);
    return x;
  }

  void set_threads(int threads) override { m_threads = threads; }
  double factor_nonzeros() const override { return m_common.lnz; }

 private:
  void expect_whole() const {
    if (m_single.holds()) throw Error(ErrorCode::internal, "a rounded factor is for solve() alone");
  }

  void solve_rounded(Eigen::MatrixXd& x) {
    const BlasTurn turn;
    for (Eigen::Index c = 0; c < x.cols(); ++c) m_single.solve(x.col(c));
  }

  static cholmod_sparse view(const BlockMatrix& matrix) {
    cholmod_sparse a{};
    a.nrow = a.ncol = 3 * std::size_t(matrix.blocks());
    a.nzmax = matrix.values().size();
    a.p = const_cast<int*>(matrix.scalar_columns().data());
    a.i = const_cast<int*>(matrix.scalar_rows().data());
    a.x = const_cast<double*>(matrix.values().data());
    a.stype = -1;  // lower triangle; what lies above the diagonal is ignored
    a.itype = CHOLMOD_INT;
    a.xtype = CHOLMOD_REAL;
    a.dtype = CHOLMOD_DOUBLE;
    a.sorted = 1;
    a.packed = 1;
    return a;
  }

  Workspace& halves() {
    if (m_workspaces.empty()) m_workspaces.push_back(std::make_unique<Workspace>());
    return *m_workspaces.front();
  }

  cholmod_common m_common{};
  cholmod_factor* m_factor = nullptr;
  std::size_t m_entries = 0;   // of the matrix
  FactorColumns m_columns;
  SingleFactor m_single;
  std::vector<std::unique_ptr<Workspace>> m_workspaces;   // one per chunk of columns
  int m_threads = 1;
};

}  // namespace

std::unique_ptr<SpdSolver> make_spd_solver() { return std::make_unique<CholmodSolver>(); }

}  // namespace brainshift
