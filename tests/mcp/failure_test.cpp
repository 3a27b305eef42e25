// What has no solution, what does not converge, what is refused.
#include <algorithm>

#include "brainshift/error.hpp"
#include "problems.hpp"

namespace brainshift::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

void expect_infeasible(const Case& c, const Indices& rows) {
  for (const McpMethod method : exact_methods) {
    SCOPED_TRACE(name(method));
    const McpSolution s = solve(c, method);
    EXPECT_EQ(s.report.status, McpStatus::infeasible) << s.report.message;
    EXPECT_EQ(s.report.conflict, rows);
    EXPECT_TRUE(s.z.allFinite());
    EXPECT_GT(s.report.residual, 1e-3);
  }
}

TEST(Infeasible, a_row_that_nothing_moves) {
  const Case c = one_sided(MatrixXd::Zero(1, 1), vector({-1}));
  expect_infeasible(c, {0});
  EXPECT_EQ(solve(c).report.message, "infeasible: row 0 cannot be satisfied");
}

TEST(Infeasible, a_row_that_nothing_moves_among_others) {
  Case c = one_sided(MatrixXd::Identity(4, 4), vector({-1, 2, -1, -3}));
  c.M(2, 2) = 0.0;
  expect_infeasible(c, {2});
}

// One body between two walls that approach past each other.
TEST(Infeasible, two_walls) {
  Case c = one_sided(MatrixXd(3, 3), vector({-1, -1, -1}));
  c.M << 1, -1, 0, -1, 1, 0, 0, 0, 1;
  expect_infeasible(c, {0, 1});
  EXPECT_EQ(solve(c).report.message, "infeasible: rows 0, 1 contradict each other");
  c.q = vector({-1, 1.0, -1});  // room enough, exactly
  EXPECT_EQ(solve(c).report.status, McpStatus::solved);
}

TEST(Infeasible, a_tie_and_a_contact_on_the_same_freedom) {
  Case c = one_sided(MatrixXd::Ones(2, 2), vector({0, -1}));
  c.lower[0] = -inf;  // held at 0, and at least 1
  expect_infeasible(c, {0, 1});
  c.q[1] = 0.5;
  EXPECT_EQ(solve(c).report.status, McpStatus::solved);
}

TEST(Infeasible, ties_that_disagree) {
  Case c = one_sided(MatrixXd::Ones(2, 2), vector({1, 2}));
  c.lower = VectorXd::Constant(2, -inf);
  expect_infeasible(c, {0, 1});
}

TEST(Infeasible, a_box_that_cannot_push_hard_enough_is_not_infeasible) {
  Case c = one_sided(MatrixXd::Identity(1, 1), vector({-5}));
  c.upper[0] = 1.0;
  const McpSolution s = solve(c);
  EXPECT_EQ(s.report.status, McpStatus::solved);
  EXPECT_EQ(s.z[0], 1.0);
  EXPECT_EQ(s.w[0], -4.0);
}

// Murty (1988), section 9: every method of successive relaxation cycles.
TEST(GaussSeidel, cycles_where_newton_and_pivoting_converge) {
  Case c = one_sided(MatrixXd(3, 3), vector({-1, -1, -1}));
  c.M << 1, 2, 0, 0, 1, 2, 2, 0, 1;
  const McpSolution cycling = solve(c, McpMethod::gauss_seidel);
  EXPECT_EQ(cycling.report.status, McpStatus::not_converged);
  EXPECT_GT(cycling.report.residual, 0.1);
  EXPECT_EQ(cycling.report.message.rfind("not converged", 0), 0u);
  for (const McpMethod method : exact_methods) {
    const McpSolution s = solve(c, method);
    expect_solved(c, s);
    EXPECT_LE((s.z - VectorXd::Constant(3, 1.0 / 3.0)).norm(), 1e-12);
  }
}

TEST(GaussSeidel, agrees_with_newton_on_definite_problems) {
  std::mt19937 generator(31);
  const MatrixXd B = random_matrix(15, 15, generator);
  const Case c = one_sided(B * B.transpose() / 15 + 0.2 * MatrixXd::Identity(15, 15),
                           random_matrix(15, 1, generator));
  const McpSolution s = solve(c, McpMethod::gauss_seidel);
  expect_solved(c, s);
  EXPECT_LE((s.z - solve(c).z).norm(), 1e-8 * s.z.norm());
}

TEST(NotConverged, is_said_when_the_budget_is_too_small) {
  const Case c =
      one_sided(murty_matrix(10) * murty_matrix(10).transpose(), VectorXd::Constant(10, -1.0));
  McpOptions options;
  options.method = McpMethod::pivoting;
  options.max_pivots = 1;
  McpSolution s = solve_mcp(c.M, c.q, c.lower, c.upper, options);
  EXPECT_EQ(s.report.status, McpStatus::not_converged);
  EXPECT_TRUE(s.z.allFinite());
  options.method = McpMethod::newton;
  options.max_iterations = 1;
  s = solve_mcp(c.M, c.q, c.lower, c.upper, options);
  EXPECT_EQ(s.report.status, McpStatus::not_converged);
  EXPECT_GT(s.report.residual, 1e-10);
}

// Where Newton's budget does not reach, pivoting takes over, itself capped.
TEST(NotConverged, automatic_falls_back_on_pivoting) {
  const Case c = one_sided(murty_matrix(12), VectorXd::Constant(12, -1.0));
  McpOptions options;
  options.max_iterations = 1;
  options.method = McpMethod::newton;
  EXPECT_EQ(solve_mcp(c.M, c.q, c.lower, c.upper, options).report.status, McpStatus::not_converged);
  options.method = McpMethod::automatic;
  const McpSolution s = solve_mcp(c.M, c.q, c.lower, c.upper, options);
  expect_solved(c, s);
  EXPECT_LE((s.z - VectorXd::Unit(12, 0)).norm(), 1e-12);
  EXPECT_LE(s.report.iterations, 1 + 2);  // of Newton, and pivots
}

TEST(NotConverged, tolerance_zero_means_as_good_as_rounding_allows) {
  std::mt19937 generator(32);
  const Case c = one_sided(random_p_matrix(20, generator), random_matrix(20, 1, generator));
  McpOptions options;
  options.tolerance = 0.0;
  EXPECT_EQ(solve_mcp(c.M, c.q, c.lower, c.upper, options).report.status, McpStatus::solved);
}

void expect_error(const Case& c, ErrorCode code, const std::string& message) {
  for (const McpMethod method : exact_methods) {
    try {
      solve(c, method);
      FAIL() << "accepted: " << message;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code);
      EXPECT_EQ(error.what(), message);
    }
  }
}

TEST(Refused, names_the_culprit) {
  const Case good = one_sided(MatrixXd::Identity(2, 2), vector({-1, -1}));
  Case c = good;
  c.q[1] = nan;
  expect_error(c, ErrorCode::not_finite, "solve_mcp: q[1] is not finite");
  c = good;
  c.M(1, 0) = inf;
  expect_error(c, ErrorCode::not_finite, "solve_mcp: M(1, 0) is not finite");
  c = good;
  c.lower[0] = nan;
  expect_error(c, ErrorCode::not_finite, "solve_mcp: lower[0] is not a number");
  c = good;
  c.upper[1] = -1.0;
  expect_error(c, ErrorCode::invalid_argument, "solve_mcp: lower[1] is above upper[1]");
  c = good;
  c.lower[0] = inf;
  expect_error(c, ErrorCode::invalid_argument, "solve_mcp: lower[0] is +infinity");
  c = good;
  c.q = vector({1, 2, 3});
  expect_error(c, ErrorCode::size_mismatch, "solve_mcp: q has 3 entries, M has 2 rows");
  c = good;
  c.M = MatrixXd::Zero(2, 3);
  expect_error(c, ErrorCode::size_mismatch, "solve_mcp: M is 2 x 3, not square");
}

// Whatever comes in, a success is a solution: never NaN or infinity with status solved.
TEST(Certificate, holds_on_random_matrices_of_no_class) {
  std::mt19937 generator(33);
  int solved = 0;
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    const Eigen::Index n = 1 + trial % 8;
    MatrixXd M = random_matrix(n, n, generator);
    if (trial % 3 == 0) M = (M.array().abs() < 0.7).select(0.0, M);
    if (trial % 7 == 0) M *= 1e150;
    const Case c = one_sided(M, random_matrix(n, 1, generator));
    const McpSolution s = solve(c);
    EXPECT_TRUE(s.z.allFinite());
    if (s.report.status != McpStatus::solved) continue;
    expect_complementary(c, s);
    ++solved;
  }
  EXPECT_GT(solved, 80);
}

// A row of rounding must not hide another row's violation.
TEST(Failure, ARowOfRoundingHidesNoOther) {
  for (double tiny : {1e-61, 1e-45, 1e-31}) {
    for (bool boxed : {true, false}) {
      Eigen::MatrixXd M = Eigen::MatrixXd::Zero(2, 2);
      M.diagonal() << tiny, 1.0;
      const Eigen::Vector2d q(3.5e-15, -1e-2);
      const double bound = boxed ? 0.0 : 1.0;
      const Eigen::Vector2d upper(bound, std::numeric_limits<double>::infinity());
      const McpSolution found = solve_mcp(M, q, -upper, upper);
      ASSERT_EQ(found.report.status, McpStatus::solved) << tiny;
      EXPECT_NEAR(found.z[1], 1e-2, 1e-12) << tiny << (boxed ? " boxed" : "");
      EXPECT_NEAR(found.w[1], 0.0, 1e-12) << tiny;
    }
  }
}

}  // namespace
}  // namespace brainshift::test
