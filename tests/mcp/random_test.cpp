// Problems made around a chosen solution, then spoilt: copies, scales, rank, degenerate pairs.
#include "problems.hpp"

namespace brainshift::test {
namespace {

struct Known {
  Case c;
  VectorXd z, w;
};

// Every kind of bound at random; `degenerate` of the rows at a bound have w = 0, too.
Known around_a_solution(const MatrixXd& M, double degenerate, std::mt19937& generator) {
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

TEST(RandomProblems, p_matrices_with_every_kind_of_bound) {
  std::mt19937 generator(21);
  for (int trial = 0; trial < 60; ++trial) {
    const Eigen::Index n = 2 + trial % 30;
    const double degenerate = trial % 3 == 0 ? 0.5 : 0.0;
    const Known known = around_a_solution(random_p_matrix(n, generator), degenerate, generator);
    for (const McpMethod method : {McpMethod::automatic, McpMethod::pivoting}) {
      SCOPED_TRACE(name(method) + " trial " + std::to_string(trial));
      const McpSolution s = solve(known.c, method);
      expect_solved(known.c, s);
      EXPECT_LE((s.z - known.z).norm(), 1e-8 * known.z.norm());
      EXPECT_TRUE(s.report.unique);
    }
  }
}

TEST(RandomProblems, newton_alone_solves_symmetric_ones) {
  std::mt19937 generator(22);
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const Eigen::Index n = 2 + trial % 40;
    const MatrixXd B = random_matrix(n, n, generator);
    const MatrixXd M = B * B.transpose() + 0.01 * MatrixXd::Identity(n, n);
    const Known known = around_a_solution(M, 0.2, generator);
    const McpSolution s = solve(known.c, McpMethod::newton);
    expect_solved(known.c, s);
    EXPECT_LE((s.z - known.z).norm(), 1e-8 * known.z.norm());
  }
}

// Rows in other units: the right solution, not only a small residual.
TEST(RandomProblems, rows_scaled_by_a_million_either_way) {
  std::mt19937 generator(23);
  std::uniform_real_distribution<double> exponent(-6.0, 6.0);
  for (int trial = 0; trial < 40; ++trial) {
    const Eigen::Index n = 3 + trial % 20;
    Known known = around_a_solution(random_p_matrix(n, generator), 0.0, generator);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double factor = std::pow(10.0, exponent(generator));
      known.c.M.row(i) *= factor;
      known.c.q[i] *= factor;
    }
    for (const McpMethod method : {McpMethod::automatic, McpMethod::pivoting}) {
      SCOPED_TRACE(name(method) + " trial " + std::to_string(trial));
      const McpSolution s = solve(known.c, method);
      ASSERT_EQ(s.report.status, McpStatus::solved) << s.report.message;
      EXPECT_LE((s.z - known.z).norm(), 1e-8 * known.z.norm());
    }
  }
}

TEST(RandomProblems, rows_and_columns_scaled_symmetrically) {
  std::mt19937 generator(24);
  std::uniform_real_distribution<double> exponent(-6.0, 6.0);
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    const Eigen::Index n = 3 + trial % 20;
    const MatrixXd B = random_matrix(n, n, generator);
    const Known known =
        around_a_solution(B * B.transpose() / n + 0.1 * MatrixXd::Identity(n, n), 0.0, generator);
    VectorXd d(n);
    for (Eigen::Index i = 0; i < n; ++i) d[i] = std::pow(10.0, exponent(generator));
    const VectorXd inverse = d.cwiseInverse();
    const Case c{d.asDiagonal() * known.c.M * d.asDiagonal(), known.c.q.cwiseProduct(d),
                 known.c.lower.cwiseProduct(inverse), known.c.upper.cwiseProduct(inverse)};
    const McpSolution s = solve(c);
    ASSERT_EQ(s.report.status, McpStatus::solved) << s.report.message;
    const VectorXd error = s.z.cwiseProduct(d) - known.z;  // each entry in its own unit
    EXPECT_LE(error.cwiseAbs().maxCoeff(), 1e-8 * known.z.norm());
  }
}

// The same problem in units that differ by powers of two: the same bits.
TEST(RandomProblems, units_that_are_powers_of_two_give_equal_bits) {
  std::mt19937 generator(25);
  const MatrixXd B = random_matrix(12, 12, generator);
  const MatrixXd M = B * B.transpose() + 0.1 * MatrixXd::Identity(12, 12);
  const Known known = around_a_solution(M, 0.2, generator);
  for (const double compliance : {2.0, 1024.0, 1.0 / 8.0}) {
    const double force = 1.0 / 32.0;
    const Case c{compliance * known.c.M, compliance * force * known.c.q, force * known.c.lower,
                 force * known.c.upper};
    for (const McpMethod method : exact_methods) {
      const McpSolution a = solve(known.c, method), b = solve(c, method);
      EXPECT_EQ(b.z, force * a.z) << name(method);
      EXPECT_EQ(b.report.iterations, a.report.iterations) << name(method);
      EXPECT_EQ(b.report.residual, a.report.residual) << name(method);
    }
  }
}

TEST(RandomProblems, dropped_rank_and_copies_leave_w_unique) {
  std::mt19937 generator(26);
  for (int trial = 0; trial < 60; ++trial) {
    const Eigen::Index n = 6 + trial % 30, rank = 2 + trial % 5;
    const MatrixXd H = random_matrix(n, rank, generator);
    const Known known = around_a_solution(H * H.transpose(), trial % 2 ? 0.3 : 0.0, generator);
    for (const McpMethod method : {McpMethod::automatic, McpMethod::newton}) {
      SCOPED_TRACE(name(method) + " trial " + std::to_string(trial));
      const McpSolution s = solve(known.c, method);
      expect_solved(known.c, s);
      EXPECT_LE((H.transpose() * (s.z - known.z)).norm(), 1e-8 * (1.0 + H.norm() * known.z.norm()));
    }
  }
}

TEST(RandomProblems, a_diagonal_over_twelve_decades_keeps_small_forces_right) {
  const Eigen::Index n = 13;
  VectorXd d(n), q(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    d[i] = std::pow(10.0, static_cast<double>(i) - 6.0);
    q[i] = i % 3 ? -1.0 : 1.0;
  }
  const Case c = one_sided(MatrixXd(d.asDiagonal()), q);
  for (const McpMethod method :
       {McpMethod::automatic, McpMethod::pivoting, McpMethod::gauss_seidel}) {
    const McpSolution s = solve(c, method);
    ASSERT_EQ(s.report.status, McpStatus::solved);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double expected = std::max(0.0, -q[i] / d[i]);
      EXPECT_NEAR(s.z[i], expected, 1e-10 * expected) << name(method) << " " << i;
    }
  }
}

}  // namespace
}  // namespace brainshift::test
