// Small problems whose answer is known in closed form.
#include "problems.hpp"

namespace brainshift::test {
namespace {

void expect_z(const Case& c, const VectorXd& expected, double tolerance = 1e-12) {
  for (const McpMethod method : exact_methods) {
    SCOPED_TRACE(name(method));
    const McpSolution s = solve(c, method);
    expect_solved(c, s);
    EXPECT_LE((s.z - expected).cwiseAbs().maxCoeff(), tolerance) << s.z.transpose();
  }
}

// Principal pivoting by largest index needs 2^n - 1 pivots, Lemke with d_i = 2^(n-i) 2^n of them.
TEST(KnownAnswers, murty) {
  for (const int n : {1, 2, 5, 12, 40}) {
    SCOPED_TRACE(n);
    const Case c = one_sided(murty_matrix(n), VectorXd::Constant(n, -1.0));
    expect_z(c, VectorXd::Unit(n, 0));
    EXPECT_LE(solve(c, McpMethod::pivoting).report.iterations, 2 * n);
    EXPECT_LE(solve(c, McpMethod::newton).report.iterations, n + 1);
    EXPECT_TRUE(solve(c).report.unique);
  }
}

TEST(KnownAnswers, fathi) {
  for (const int n : {1, 2, 5, 12, 40}) {
    SCOPED_TRACE(n);
    const MatrixXd L = murty_matrix(n);
    const Case c = one_sided(L * L.transpose(), VectorXd::Constant(n, -1.0));
    expect_z(c, VectorXd::Unit(n, 0), 1e-10);  // cond(M) ~ n^4
    EXPECT_LE(solve(c, McpMethod::pivoting).report.iterations, 50 + 10 * n);
  }
}

TEST(KnownAnswers, not_monotone) {
  Case c = one_sided(MatrixXd(3, 3), vector({-3, 6, -1}));
  c.M << 0, 2, -1, -1, 0, 1, 2, -2, 0;
  const McpSolution s = solve(c);
  expect_solved(c, s);
  EXPECT_LE((s.z - vector({6, 1.5, 0})).norm(), 1e-12) << s.z.transpose();
  EXPECT_LE((s.w - vector({0, 0, 8})).norm(), 1e-12);
}

TEST(KnownAnswers, free_row_and_the_same_row_one_sided) {
  Case c = one_sided(MatrixXd(2, 2), vector({1, -4}));
  c.M << 2, 1, 1, 2;
  expect_z(c, vector({0, 2}));
  c.lower[0] = -inf;
  expect_z(c, vector({-2, 3}));
}

TEST(KnownAnswers, boxes_clamp_and_flip_the_sign_of_w) {
  Case c = one_sided(MatrixXd::Identity(5, 5), vector({-3, -0.5, 2, 3, 1}));
  c.lower = vector({-1, -1, -1, -inf, 0.25});
  c.upper = vector({1, 1, 1, 2, 0.25});
  expect_z(c, vector({1, 0.5, -1, -3, 0.25}));
  const McpSolution s = solve(c);
  EXPECT_LT(s.w[0], 0.0);
  EXPECT_GT(s.w[2], 0.0);
}

TEST(KnownAnswers, an_upper_bound_only) {
  Case c = one_sided(MatrixXd(2, 2), vector({-3, 1}));
  c.M << 2, 1, 1, 2;
  c.lower = VectorXd::Constant(2, -inf);
  c.upper = vector({1, inf});
  expect_z(c, vector({1, -1}));  // w = (-2, 0)
}

// A saddle point: a free pair tied by one bilateral row without a diagonal.
TEST(KnownAnswers, bilateral_rows_without_a_diagonal) {
  Case c = one_sided(MatrixXd(3, 3), vector({-1, -3, 0}));
  c.M << 1, 0, 1, 0, 1, -1, -1, 1, 0;  // minimise |x - (1, 3)|^2 / 2 with x_0 = x_1
  c.lower = VectorXd::Constant(3, -inf);
  expect_z(c, vector({2, 2, -1}));
}

TEST(KnownAnswers, nothing_to_solve) {
  const McpSolution s = solve({MatrixXd(0, 0), VectorXd(0), VectorXd(0), VectorXd(0)});
  EXPECT_EQ(s.report.status, McpStatus::solved);
  const Case zero = one_sided(MatrixXd::Identity(3, 3), VectorXd::Zero(3));
  for (const McpMethod method : exact_methods) {
    EXPECT_EQ(solve(zero, method).z.norm(), 0.0);
    EXPECT_EQ(solve(zero, method).report.iterations, 0);
  }
}

}  // namespace
}  // namespace brainshift::test
