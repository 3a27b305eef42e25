// The same complementarity problems by this library and by the solvers of Siconos: w, and z where it
// is unique. Without Siconos the one test here says so and is skipped.
#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#ifndef BRAINSHIFT_WITH_SICONOS

TEST(Siconos, CrossCheck) { GTEST_SKIP() << "not compared with Siconos: " BRAINSHIFT_NO_SICONOS; }

#else

#include "mcp/friction.hpp"
#include "mcp/problems.hpp"
#include "siconos.hpp"

namespace brainshift::test {
namespace {

// Both answers solve the same problem to 1e-10 of its terms; the condition numbers of the problems
// here are below a thousand.
constexpr double agreement = 1e-7;

// Largest differences seen, for the row that every test prints.
struct Comparison {
  const char* name;
  int problems = 0;
  double z = 0.0, w = 0.0;

  void add(const VectorXd& our_z, const VectorXd& our_w, const VectorXd& their_z,
           const VectorXd& their_w, bool unique) {
    ++problems;
    const double dw = (our_w - their_w).norm() / (1.0 + our_w.norm());
    w = std::max(w, dw);
    EXPECT_LE(dw, agreement);
    if (!unique) return;
    const double dz = (our_z - their_z).norm() / (1.0 + our_z.norm());
    z = std::max(z, dz);
    EXPECT_LE(dz, agreement);
  }
  void print() const {
    std::printf("%-34s | %3d problems | z differs by %.1e | w by %.1e\n", name, problems, z, w);
    EXPECT_GT(problems, 0);
  }
};

// z and w of a problem with every kind of bound, by a problem with free and one-sided rows only:
// z = lower + y, and for an upper bound a multiplier v >= 0 with w + v >= 0, upper - lower - y >= 0.
siconos::Solution by_one_sided_rows(const Case& c, int solver) {
  const Eigen::Index n = c.q.size();
  std::vector<Eigen::Index> free, bounded, boxes;
  for (Eigen::Index i = 0; i < n; ++i) {
    (std::isinf(c.lower[i]) ? free : bounded).push_back(i);
    if (!std::isinf(c.lower[i]) && !std::isinf(c.upper[i])) boxes.push_back(i);
  }
  std::vector<Eigen::Index> order = free;
  order.insert(order.end(), bounded.begin(), bounded.end());
  const auto extra = Eigen::Index(boxes.size());
  const VectorXd lower = c.lower.array().isInf().select(0.0, c.lower);
  const VectorXd shifted = c.q + c.M * lower;
  MatrixXd M = MatrixXd::Zero(n + extra, n + extra);
  VectorXd q(n + extra);
  for (Eigen::Index i = 0; i < n; ++i) {
    q[i] = shifted[order[i]];
    for (Eigen::Index j = 0; j < n; ++j) M(i, j) = c.M(order[i], order[j]);
  }
  for (Eigen::Index k = 0; k < extra; ++k) {
    const Eigen::Index at = std::find(order.begin(), order.end(), boxes[k]) - order.begin();
    M(at, n + k) = 1.0;
    M(n + k, at) = -1.0;
    q[n + k] = c.upper[boxes[k]] - c.lower[boxes[k]];
  }
  siconos::Solution s = siconos::solve_mlcp(M, q, int(free.size()), solver);
  VectorXd z = lower;
  for (Eigen::Index i = 0; i < n; ++i) z[order[i]] += s.z[i];
  s.z = z;
  s.w = c.M * z + c.q;
  return s;
}

TEST(Siconos, RandomOneSidedProblems) {
  for (const int solver : {SICONOS_LCP_LEMKE, SICONOS_LCP_PIVOT, SICONOS_LCP_NEWTON_MIN_FBLSA}) {
    std::mt19937 generator(51);
    Comparison comparison{siconos::name(solver)};
    for (int trial = 0; trial < 40; ++trial) {
      SCOPED_TRACE(trial);
      const Eigen::Index n = 2 + trial;
      const Case c = one_sided(random_p_matrix(n, generator), random_matrix(n, 1, generator));
      const McpSolution ours = solve(c);
      expect_solved(c, ours);
      const siconos::Solution theirs = siconos::solve_lcp(c.M, c.q, solver);
      ASSERT_EQ(theirs.info, 0);
      EXPECT_TRUE(ours.report.unique);
      comparison.add(ours.z, ours.w, theirs.z, theirs.w, true);
    }
    comparison.print();
  }
}

// Free and one-sided rows, by enumeration where there are few enough.
TEST(Siconos, RandomProblemsWithFreeRows) {
  for (const int solver : {SICONOS_MLCP_LCP_LEMKE, SICONOS_MLCP_ENUM}) {
    std::mt19937 generator(52);
    Comparison comparison{siconos::name(solver)};
    for (int trial = 0; trial < 40; ++trial) {
      SCOPED_TRACE(trial);
      const Eigen::Index n = solver == SICONOS_MLCP_ENUM ? 2 + trial % 9 : 2 + trial;
      Case c = one_sided(random_p_matrix(n, generator), random_matrix(n, 1, generator));
      for (Eigen::Index i = 0; i < n; ++i) {
        if ((i * 7 + trial) % 3 == 0) c.lower[i] = -inf;
      }
      const McpSolution ours = solve(c);
      expect_solved(c, ours);
      const siconos::Solution theirs = by_one_sided_rows(c, solver);
      ASSERT_EQ(theirs.info, 0);
      comparison.add(ours.z, ours.w, theirs.z, theirs.w, true);
    }
    comparison.print();
  }
}

TEST(Siconos, RandomBoxes) {
  for (const int solver : {SICONOS_RELAY_LEMKE, SICONOS_RELAY_AVI_CAOFERRIS}) {
    std::mt19937 generator(53);
    Comparison comparison{siconos::name(solver)};
    for (int trial = 0; trial < 40; ++trial) {
      SCOPED_TRACE(trial);
      const Eigen::Index n = 2 + trial % 25;
      Case c = one_sided(random_p_matrix(n, generator), random_matrix(n, 1, generator));
      c.lower = -random_matrix(n, 1, generator).cwiseAbs();
      c.upper = random_matrix(n, 1, generator).cwiseAbs();
      const McpSolution ours = solve(c);
      expect_solved(c, ours);
      const siconos::Solution theirs = siconos::solve_boxes(c, solver);
      ASSERT_EQ(theirs.info, 0);
      comparison.add(ours.z, ours.w, theirs.z, theirs.w, true);
    }
    comparison.print();
  }
}

// Every kind of bound, degenerate pairs among them: the problems of RandomProblems.
TEST(Siconos, RandomProblemsWithEveryKindOfBound) {
  std::mt19937 generator(21);
  Comparison comparison{"every kind of bound"};
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const Eigen::Index n = 2 + trial % 30;
    const double degenerate = trial % 3 == 0 ? 0.5 : 0.0;
    const Known known = around_a_solution(random_p_matrix(n, generator), degenerate, generator);
    const McpSolution ours = solve(known.c);
    expect_solved(known.c, ours);
    const siconos::Solution theirs = by_one_sided_rows(known.c, SICONOS_MLCP_LCP_LEMKE);
    ASSERT_EQ(theirs.info, 0);
    comparison.add(ours.z, ours.w, theirs.z, theirs.w, true);
  }
  comparison.print();
}

// Dependent rows: w is unique, z in general not.
TEST(Siconos, DependentRowsHaveTheSameW) {
  std::mt19937 generator(54);
  Comparison comparison{"dependent rows"};
  int unsolved = 0;
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    const Eigen::Index n = 6 + trial % 20, rank = 2 + trial % 5;
    const MatrixXd H = random_matrix(n, rank, generator);
    const VectorXd z = random_matrix(n, 1, generator).cwiseMax(0.0);
    VectorXd w = random_matrix(n, 1, generator).cwiseAbs();
    w = (z.array() > 0.0).select(0.0, w);
    const Case c = one_sided(H * H.transpose(), w - H * (H.transpose() * z));
    const McpSolution ours = solve(c);
    expect_solved(c, ours);
    const siconos::Solution theirs = siconos::solve_lcp(c.M, c.q);
    if (theirs.info != 0) {  // its own word: a ray where there is a solution
      ++unsolved;
      continue;
    }
    comparison.add(ours.z, ours.w, theirs.z, theirs.w, ours.report.unique);
  }
  comparison.print();
  std::printf("dependent rows: %d more that Siconos' Lemke does not solve\n", unsolved);
  EXPECT_GE(comparison.problems, 30);
}

// No solution: neither finds one.
TEST(Siconos, NeitherSolvesTheInfeasible) {
  MatrixXd M(3, 3);
  M << 1, -1, 0, -1, 1, 0, 0, 0, 1;
  const Case c = one_sided(M, vector({-1, -1, -1}));
  EXPECT_EQ(solve(c).report.status, McpStatus::infeasible);
  EXPECT_NE(siconos::solve_lcp(c.M, c.q).info, 0);
}

// The belt of the capstan, reduced to its contacts: Coulomb's law in one problem by Siconos, in
// rounds of boxes by this library, and in one problem by it. Springs to the ground make the compliance
// exist; they take a part of the tension of about a thousand times their stiffness over the belt's.
TEST(Siconos, Capstan) {
  for (const int contacts : {8, 16}) {
    SCOPED_TRACE(contacts);
    Belt belt{contacts, pi, 0.3};
    belt.ground = 1e-8 * belt.stiffness;
    const Grip grip = coulomb(belt, McpMethod::automatic);
    ASSERT_LT(grip.rounds, 100);
    const int n = 2 * contacts;
    const Case whole = belt.problem(VectorXd::Zero(contacts));
    const MatrixXd K = whole.M.topLeftCorner(n, n);
    const VectorXd load = whole.q.head(n);
    MatrixXd H = MatrixXd::Zero(n, n);  // rows (normal, tangential) of each contact
    for (int i = 0; i < contacts; ++i) H(2 * i, 2 * i + 1) = H(2 * i + 1, 2 * i) = 1.0;
    const Eigen::LLT<MatrixXd> factor(K);
    const MatrixXd W = H * factor.solve(H.transpose());
    const VectorXd q = -H * factor.solve(load);

    const VectorXd friction = VectorXd::Constant(contacts, belt.friction);
    const siconos::Solution theirs = siconos::solve_friction(W, q, friction);
    ASSERT_EQ(theirs.info, 0);
    const McpSolution ours = solve(coulomb_problem(W, q, belt.friction));
    ASSERT_EQ(ours.report.status, McpStatus::solved) << ours.report.message;

    const auto ratio = [&](const VectorXd& r) {
      return belt.tension(contacts, factor.solve(H.transpose() * r - load)) / belt.weight;
    };
    VectorXd one_problem(n), boxes(n);
    for (int i = 0; i < contacts; ++i) {
      one_problem.segment<2>(2 * i) = reaction(ours.z, i);
      boxes[2 * i] = grip.solution.z[n + i];
      boxes[2 * i + 1] = grip.solution.z[3 * contacts + i];
    }
    const double half = 0.5 * pi / contacts, mu = belt.friction;
    const double closed = std::pow(
        (std::cos(half) + mu * std::sin(half)) / (std::cos(half) - mu * std::sin(half)), contacts);
    std::printf(
        "capstan, N %2d: ratio %.9f by Siconos, %.9f in one problem, %.9f by boxes, %.9f "
        "closed form\n",
        contacts, ratio(theirs.z), ratio(one_problem), ratio(boxes), closed);
    std::printf("capstan, N %2d: reactions differ by %.1e and %.1e\n", contacts,
                (theirs.z - one_problem).norm() / theirs.z.norm(),
                (theirs.z - boxes).norm() / theirs.z.norm());
    // rounding times the condition of W, 1e8
    EXPECT_LE((theirs.z - one_problem).norm(), 1e-6 * theirs.z.norm());
    EXPECT_LE((theirs.z - boxes).norm(), 1e-6 * theirs.z.norm());
    EXPECT_NEAR(ratio(theirs.z), closed, 3e-5);  // the springs
    EXPECT_NEAR(ratio(one_problem), closed, 3e-5);
  }
}

TEST(Siconos, BlockOnASlope) {
  const double g = standard_gravity, mu = 0.3;
  for (const double angle : {0.1, 0.28, 0.3, 0.5, 1.2}) {  // friction holds up to 0.2915
    SCOPED_TRACE(angle);
    const VectorXd q = vector({-g * std::cos(angle), g * std::sin(angle)});
    const MatrixXd W = MatrixXd::Identity(2, 2);
    const McpSolution ours = solve(coulomb_problem(W, q, mu));
    ASSERT_EQ(ours.report.status, McpStatus::solved);
    const siconos::Solution theirs = siconos::solve_friction(W, q, vector({mu}));
    ASSERT_EQ(theirs.info, 0);
    EXPECT_LE((theirs.z - reaction(ours.z, 0)).norm(), agreement * g);
    EXPECT_NEAR(theirs.w[1], std::max(0.0, g * (std::sin(angle) - mu * std::cos(angle))),
                agreement * g);
  }
}

}  // namespace
}  // namespace brainshift::test

#endif
