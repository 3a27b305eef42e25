// The complementarity solvers of Siconos (INRIA, Apache-2.0; Debian: libsiconos-numerics-dev) on
// the problems of brainshift/mcp.hpp. Test only.
#pragma once

#include <cstdlib>
#include <memory>
#include <vector>

#include "mcp/case.hpp"

extern "C" {
#include <FrictionContactProblem.h>
#include <Friction_cst.h>
#include <LinearComplementarityProblem.h>
#include <MixedLinearComplementarityProblem.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <RelayProblem.h>
#include <SolverOptions.h>
#include <lcp_cst.h>
#include <mlcp_cst.h>
#include <relay_cst.h>
}

namespace brainshift::test::siconos {

inline const char* name(int solver) { return solver_options_id_to_name(solver); }

struct Solution {
  int info = -1;  // 0: solved, by its own account
  VectorXd z, w;
};

// Options of a solver, with a tolerance far below that of the comparison.
class Options {
 public:
  explicit Options(int solver) : m_options(solver_options_create(solver), solver_options_delete) {
    m_options->dparam[SICONOS_DPARAM_TOL] = 1e-10;
    m_options->iparam[SICONOS_IPARAM_MAX_ITER] = 10000;
  }
  SolverOptions* get() const { return m_options.get(); }

 private:
  std::unique_ptr<SolverOptions, decltype(&solver_options_delete)> m_options;
};

// A dense matrix by columns, which Siconos may write to.
class Dense {
 public:
  explicit Dense(const MatrixXd& M)
      : m_values(M),
        m_matrix(NM_create_from_data(NM_DENSE, int(M.rows()), int(M.cols()), m_values.data())) {}
  ~Dense() {
    m_matrix->matrix0 = nullptr;  // the values are ours
    NM_clear(m_matrix);
    std::free(m_matrix);
  }
  Dense(const Dense&) = delete;
  Dense& operator=(const Dense&) = delete;
  NumericsMatrix* get() { return m_matrix; }

 private:
  MatrixXd m_values;
  NumericsMatrix* m_matrix;
};

// 0 <= z, w = M z + q >= 0.
inline Solution solve_lcp(const MatrixXd& M, VectorXd q, int solver = SICONOS_LCP_LEMKE) {
  Dense matrix(M);
  const Options options(solver);
  LinearComplementarityProblem problem{int(q.size()), matrix.get(), q.data()};
  Solution s{0, VectorXd::Zero(q.size()), VectorXd::Zero(q.size())};
  s.info = linearComplementarity_driver(&problem, s.z.data(), s.w.data(), options.get());
  return s;
}

// The first `equalities` rows free, the others one-sided.
inline Solution solve_mlcp(const MatrixXd& M, VectorXd q, int equalities,
                           int solver = SICONOS_MLCP_LCP_LEMKE) {
  const int n = int(q.size()), m = n - equalities;
  if (equalities == 0) return solve_lcp(M, q);
  Dense matrix(M);
  const Options options(solver);
  std::vector<int> rows{0, equalities}, is_complementary{0};
  if (n > equalities) {
    rows.push_back(n);
    is_complementary.push_back(1);
  }
  MixedLinearComplementarityProblem problem{};
  // some solvers read (M, q), others the blocks (A C; D B), (a; b)
  MatrixXd A = M.topLeftCorner(equalities, equalities), C = M.topRightCorner(equalities, m);
  MatrixXd D = M.bottomLeftCorner(m, equalities), B = M.bottomRightCorner(m, m);
  VectorXd a = q.head(equalities), b = q.tail(m);
  problem.A = A.data(), problem.B = B.data(), problem.C = C.data(), problem.D = D.data();
  problem.a = a.data(), problem.b = b.data();
  problem.isStorageType1 = problem.isStorageType2 = 1;
  problem.n = equalities;
  problem.m = m;
  problem.blocksRows = rows.data();
  problem.blocksIsComp = is_complementary.data();
  problem.M = matrix.get();
  problem.q = q.data();
  Solution s{0, VectorXd::Zero(n), VectorXd::Zero(n)};
  s.info = mlcp_driver(&problem, s.z.data(), s.w.data(), options.get());
  return s;
}

// Every row a box: -w in the normal cone of [lower, upper] at z.
inline Solution solve_boxes(const Case& c, int solver = SICONOS_RELAY_LEMKE) {
  Dense matrix(c.M);
  const Options options(solver);
  VectorXd q = c.q, lower = c.lower, upper = c.upper;
  RelayProblem problem{int(q.size()), matrix.get(), q.data(), lower.data(), upper.data()};
  Solution s{0, VectorXd::Zero(q.size()), VectorXd::Zero(q.size())};
  s.info = relay_driver(&problem, s.z.data(), s.w.data(), options.get());
  return s;
}

// Contacts in the plane with Coulomb's law, each with its normal and its tangential row:
// 0 <= w_n, r_n >= 0 complementary, |r_t| <= friction r_n, against the slip w_t.
inline Solution solve_friction(const MatrixXd& W, VectorXd q, VectorXd friction,
                               int solver = SICONOS_FRICTION_2D_LEMKE) {
  Dense matrix(W);
  const Options options(solver);
  FrictionContactProblem problem{2, int(friction.size()), matrix.get(), q.data(), friction.data()};
  Solution s{0, VectorXd::Zero(q.size()), VectorXd::Zero(q.size())};
  s.info = fc2d_driver(&problem, s.z.data(), s.w.data(), options.get());
  return s;
}

}  // namespace brainshift::test::siconos
