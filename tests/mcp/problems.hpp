// Problems and checks that the tests of the mixed complementarity problem share.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "brainshift/mcp.hpp"
#include "mcp/case.hpp"

namespace brainshift::test {

inline VectorXd vector(std::initializer_list<double> values) {
  VectorXd v(values.size());
  std::copy(values.begin(), values.end(), v.data());
  return v;
}

inline McpSolution solve(const Case& c, McpMethod method = McpMethod::automatic) {
  McpOptions options;
  options.method = method;
  return solve_mcp(c.M, c.q, c.lower, c.upper, options);
}

inline std::string name(McpMethod method) {
  switch (method) {
    case McpMethod::automatic: return "automatic";
    case McpMethod::newton: return "newton";
    case McpMethod::pivoting: return "pivoting";
    case McpMethod::gauss_seidel: return "gauss_seidel";
  }
  return "?";
}

constexpr McpMethod exact_methods[] = {McpMethod::automatic, McpMethod::newton,
                                       McpMethod::pivoting};

// The conditions of the header, row by row, checked without any code of the library.
// `tolerance` is relative to the largest |q|, |M z| (for w) and |z|.
inline void expect_complementary(const Case& c, const McpSolution& s, double tolerance = 1e-9) {
  ASSERT_TRUE(s.z.allFinite() && s.w.allFinite());
  const VectorXd w = c.M * s.z + c.q;
  const double w_scale = (c.M.cwiseAbs() * s.z.cwiseAbs() + c.q.cwiseAbs()).maxCoeff();
  const double z_scale = std::max(s.z.cwiseAbs().maxCoeff(), 1e-300);
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    EXPECT_EQ(s.w[i], w[i]);
    EXPECT_GE(s.z[i], c.lower[i]);
    EXPECT_LE(s.z[i], c.upper[i]);
    const bool at_lower = s.z[i] <= c.lower[i] + tolerance * z_scale;
    const bool at_upper = s.z[i] >= c.upper[i] - tolerance * z_scale;
    EXPECT_TRUE(at_lower || w[i] <= tolerance * w_scale) << "row " << i << ": " << w[i];
    EXPECT_TRUE(at_upper || w[i] >= -tolerance * w_scale) << "row " << i << ": " << w[i];
  }
}

inline void expect_solved(const Case& c, const McpSolution& s, double tolerance = 1e-9) {
  ASSERT_EQ(s.report.status, McpStatus::solved) << s.report.message << " " << s.report.residual;
  EXPECT_LE(s.report.residual, 1e-10);
  expect_complementary(c, s, tolerance);
}

inline MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::mt19937& generator) {
  std::normal_distribution<double> normal;
  MatrixXd m(rows, columns);
  for (Eigen::Index i = 0; i < m.size(); ++i) m.data()[i] = normal(generator);
  return m;
}

// A P-matrix that is not symmetric: symmetric part positive definite.
inline MatrixXd random_p_matrix(Eigen::Index n, std::mt19937& generator) {
  const MatrixXd B = random_matrix(n, n, generator), C = random_matrix(n, n, generator);
  return B * B.transpose() / n + 0.1 * MatrixXd::Identity(n, n) + 0.3 * (C - C.transpose());
}

// Murty (1978): lower triangular, 1 on the diagonal, 2 below.
inline MatrixXd murty_matrix(Eigen::Index n) {
  MatrixXd M = MatrixXd::Identity(n, n);
  M.triangularView<Eigen::StrictlyLower>().setConstant(2.0);
  return M;
}

struct Known {
  Case c;
  VectorXd z, w;
};

// Every kind of bound at random; `degenerate` of the rows at a bound have w = 0, too.
inline Known around_a_solution(const MatrixXd& M, double degenerate, std::mt19937& generator) {
  const Eigen::Index n = M.rows();
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Known known{one_sided(M, VectorXd::Zero(n)), VectorXd::Zero(n), VectorXd::Zero(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const double kind = uniform(generator), pick = uniform(generator);
    const bool box = kind > 0.6 && kind < 0.8, free = kind >= 0.8;
    if (box) known.c.lower[i] = -uniform(generator);
    if (box) known.c.upper[i] = uniform(generator);
    if (free) known.c.lower[i] = -inf;
    const double w = uniform(generator) < degenerate ? 0.0 : uniform(generator);
    if (free) {
      known.z[i] = 2.0 * pick - 1.0;
    } else if (pick < 0.5) {
      known.z[i] = known.c.lower[i];
      known.w[i] = w;
    } else if (box && pick < 0.75) {
      known.z[i] = known.c.upper[i];
      known.w[i] = -w;
    } else {
      const double top = box ? known.c.upper[i] : 1.0;
      known.z[i] = known.c.lower[i] + uniform(generator) * (top - known.c.lower[i]);
    }
  }
  known.c.q = known.w - M * known.z;
  return known;
}

}  // namespace brainshift::test
