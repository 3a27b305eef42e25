// CHOLMOD behind SpdSolver. This folder is the only place that touches SuiteSparse: its Supernodal
// module is GPL-2+, see THIRD_PARTY.md.
#include <cholmod.h>

#include <string>

#include "brainshift/error.hpp"
#include "linear/spd_solver.hpp"

namespace brainshift {
namespace {

class CholmodSolver final : public SpdSolver {
 public:
  CholmodSolver() {
    cholmod_start(&m_common);
    m_common.print = 0;
    m_common.supernodal = CHOLMOD_SUPERNODAL;
    m_common.nmethods = 1;
    m_common.method[0].ordering = CHOLMOD_NATURAL;
    m_common.postorder = 1;
    m_common.try_catch = 1;  // no message handler of the host's is called
    m_common.quick_return_if_not_posdef = 1;
  }
  ~CholmodSolver() override {
    cholmod_free_factor(&m_factor, &m_common);
    cholmod_free_dense(&m_solution, &m_common);
    cholmod_free_dense(&m_y, &m_common);
    cholmod_free_dense(&m_e, &m_common);
    cholmod_finish(&m_common);
  }
  CholmodSolver(const CholmodSolver&) = delete;
  CholmodSolver& operator=(const CholmodSolver&) = delete;

  void analyse(const BlockMatrix& matrix) override {
    cholmod_free_factor(&m_factor, &m_common);
    cholmod_sparse a = view(matrix);
    m_factor = cholmod_analyze(&a, &m_common);
    check("analysis");
  }

  bool factorise(const BlockMatrix& matrix) override {
    cholmod_sparse a = view(matrix);
    cholmod_factorize(&a, m_factor, &m_common);
    if (m_common.status == CHOLMOD_NOT_POSDEF) return false;
    check("factorisation");
    return true;
  }

  void solve(Eigen::MatrixXd& x) override {
    cholmod_dense b{};
    b.nrow = std::size_t(x.rows());
    b.ncol = std::size_t(x.cols());
    b.nzmax = b.nrow * b.ncol;
    b.d = b.nrow;
    b.x = x.data();
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    cholmod_solve2(CHOLMOD_A, m_factor, &b, nullptr, &m_solution, nullptr, &m_y, &m_e, &m_common);
    check("solve");
    x = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(m_solution->x), x.rows(),
                                          x.cols());
  }

  double factor_nonzeros() const override { return m_common.lnz; }

 private:
  static cholmod_sparse view(const BlockMatrix& matrix) {
    cholmod_sparse a{};
    a.nrow = a.ncol = std::size_t(3 * matrix.blocks());
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

  void check(const char* what) const {
    if (m_common.status >= CHOLMOD_OK) return;
    const bool memory = m_common.status == CHOLMOD_OUT_OF_MEMORY;
    throw Error(ErrorCode::linear_solver,
                std::string("CHOLMOD ") + what + " failed: " +
                    (memory ? "out of memory" : "status " + std::to_string(m_common.status)));
  }

  cholmod_common m_common{};
  cholmod_factor* m_factor = nullptr;
  cholmod_dense *m_solution = nullptr, *m_y = nullptr, *m_e = nullptr;
};

}  // namespace

std::unique_ptr<SpdSolver> make_spd_solver() { return std::make_unique<CholmodSolver>(); }

}  // namespace brainshift
