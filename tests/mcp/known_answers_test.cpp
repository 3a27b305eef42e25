// Small problems whose answer is known in closed form.
#include <cstdio>

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
    EXPECT_LE(solve(c, McpMethod::pivoting).report.iterations, 2);  // the covering vector of ones
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

// Kojima and Shindo (1986), nonlinear: linearised at each iterate (Josephy 1979), quadratic near a
// solution and not sure to reach one from afar. The first solution is degenerate, z_3 = F_3 = 0.
struct KojimaShindo {
  static VectorXd value(const VectorXd& z) {
    const double a = z[0], b = z[1], c = z[2], d = z[3];
    return vector({3 * a * a + 2 * a * b + 2 * b * b + c + 3 * d - 6,
                   2 * a * a + a + b * b + 10 * c + 2 * d - 2,
                   3 * a * a + a * b + 2 * b * b + 2 * c + 9 * d - 9,
                   a * a + 3 * b * b + 2 * c + 3 * d - 3});
  }
  static MatrixXd jacobian(const VectorXd& z) {
    const double a = z[0], b = z[1];
    MatrixXd J(4, 4);
    J << 6 * a + 2 * b, 2 * a + 4 * b, 1, 3,  //
        4 * a + 1, 2 * b, 10, 2,              //
        6 * a + b, a + 4 * b, 2, 9,           //
        2 * a, 6 * b, 2, 3;
    return J;
  }
};

TEST(KnownAnswers, kojima_shindo_by_linearisation) {
  const VectorXd degenerate = vector({std::sqrt(6.0) / 2.0, 0, 0, 0.5}),
                 other = vector({1, 0, 3, 0});
  for (const VectorXd& z : {degenerate, other}) {  // the answers themselves
    const VectorXd F = KojimaShindo::value(z);
    EXPECT_LE(z.cwiseMin(F).cwiseAbs().maxCoeff(), 1e-14);
  }
  std::mt19937 generator(41);
  int found[2] = {0, 0}, failed = 0;
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    const VectorXd random = random_matrix(4, 1, generator);
    VectorXd z = trial % 2 ? VectorXd(2.0 * random) : VectorXd(other + 0.1 * random);
    z = z.cwiseAbs();
    bool solved = true;
    for (int i = 0; i < 40 && solved; ++i) {
      // in the step, so that the search starts at the last iterate: there are two solutions
      Case c = one_sided(KojimaShindo::jacobian(z), KojimaShindo::value(z));
      c.lower = -z;
      const McpSolution s = solve(c);
      EXPECT_TRUE(s.z.allFinite());
      solved = s.report.status == McpStatus::solved;
      if (solved) expect_complementary(c, s);
      z = (z + s.z).cwiseMax(0.0);
    }
    const double residual = z.cwiseMin(KojimaShindo::value(z)).cwiseAbs().maxCoeff();
    if (!solved || residual > 1e-10) {
      ++failed;
      continue;
    }
    const double to_degenerate = (z - degenerate).norm(), to_other = (z - other).norm();
    // the residual times the inverse of the Jacobian, of order 1 at either
    EXPECT_LE(std::min(to_degenerate, to_other), 1e-8) << z.transpose();
    ++found[to_degenerate < to_other ? 0 : 1];
  }
  std::printf("Kojima-Shindo: (sqrt6/2, 0, 0, 1/2) %d times, (1, 0, 3, 0) %d times, neither %d\n",
              found[0], found[1], failed);
  EXPECT_GE(found[0], 5);
  EXPECT_GE(found[1], 5);
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
