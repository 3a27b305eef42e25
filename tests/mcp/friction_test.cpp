// Friction as boxes: pull-out of a chain, and a belt round a post (capstan) in N contacts.
#include <cstdio>

#include "problems.hpp"

namespace brainshift::test {
namespace {

constexpr double pi = 3.14159265358979323846;

// A rod of n nodes in tissue, one friction box (+- bound) per node, pulled out at node 0 by a hand
// that moves through a spring of the same stiffness. M is the compliance, q the way without friction.
struct Rod {
  Eigen::Index n;
  double stiffness, bound, hand;  // mN/mm, mN, mm

  Case problem() const {
    MatrixXd K = MatrixXd::Zero(n, n);
    K(0, 0) = stiffness;
    for (Eigen::Index i = 0; i + 1 < n; ++i) {
      K(i, i) += stiffness, K(i + 1, i + 1) += stiffness;
      K(i, i + 1) -= stiffness, K(i + 1, i) -= stiffness;
    }
    return {K.inverse(), VectorXd::Constant(n, hand), VectorXd::Constant(n, -bound),
            VectorXd::Constant(n, bound)};
  }
  double force(const McpSolution& s) const { return stiffness * (hand - s.w[0]); }
};

// All nodes slip once the hand's force exceeds n bounds: 2 pi r L tau, whatever the stiffness.
TEST(PullOutChain, ForceIsTheSumOfTheBounds) {
  const double radius = 0.635, length = 40.0, shear_bound = 0.3;  // mm, mm, kPa
  const double expected = 2.0 * pi * radius * length * shear_bound;
  for (const Eigen::Index n : {4, 16, 64}) {
    for (const double stiffness : {1.0, 1e3}) {
      // The hand goes twice as far as the last node needs to start.
      const double start = expected / stiffness * double(n + 1) / 2.0;
      const Rod rod{n, stiffness, expected / double(n), 2.0 * start};
      for (const McpMethod method : {McpMethod::automatic, McpMethod::pivoting}) {
        SCOPED_TRACE(name(method));
        const McpSolution s = solve(rod.problem(), method);
        expect_solved(rod.problem(), s);
        EXPECT_GT(s.w.minCoeff(), 0.0);  // every node slips
        EXPECT_NEAR(rod.force(s), expected, 1e-10 * expected);
        if (method == McpMethod::automatic) {
          std::printf("pull-out chain, n %2d, k %4.0f: %.12f mN, 2 pi r L tau %.12f\n", int(n),
                      stiffness, rod.force(s), expected);
        }
      }
    }
  }
}

// Hand force F = (m + 1/2) bounds: m nodes slip at their bounds, the next carries the other half and
// stays where it is, and so do all behind it. m = 0: nothing slips.
TEST(PullOutChain, SlipsAsFarAsTheForceReaches) {
  const double k = 50.0, bound = 0.7;
  const Eigen::Index n = 12;
  for (Eigen::Index m = 0; m < n; ++m) {
    SCOPED_TRACE(m);
    const double force = (double(m) + 0.5) * bound;
    // Node 0 follows from the stretch of the springs between it and node m, which stands still.
    double hand = force / k;
    for (Eigen::Index i = 0; i < m; ++i) hand += (force - double(i + 1) * bound) / k;
    const Rod rod{n, k, bound, hand};
    for (const McpMethod method : exact_methods) {
      SCOPED_TRACE(name(method));
      const McpSolution s = solve(rod.problem(), method);
      expect_solved(rod.problem(), s);
      EXPECT_NEAR(rod.force(s), force, 1e-10);
      for (Eigen::Index i = 0; i < n; ++i) {
        EXPECT_NEAR(s.z[i], i < m ? -bound : i == m ? -0.5 * bound : 0.0, 1e-10) << i;
        if (i < m) {
          EXPECT_GT(s.w[i], 1e-4) << i;
        } else {
          EXPECT_LE(std::abs(s.w[i]), 1e-12) << i;
        }
      }
    }
  }
}

// A belt over `angle` of a round post in N contacts: the polygon turns by angle/N at each, so that
// its two strands leave a contact at half of that from the tangent. Unknowns: tangential and outward
// displacement of every contact (free rows), then normal force (one-sided) and friction (box) of
// each. Strand 0 hangs on a weight T0, strand N on a hand that pulls `hand` mm.
struct Belt {
  int contacts;
  double angle, friction;
  double weight = 1.0, stiffness = 100.0, hand = 1.0;

  // Elongation of strand i (between contacts i - 1 and i, the last one to the hand) by the unknowns.
  VectorXd strand(int i) const {
    const double half = 0.5 * angle / contacts, c = std::cos(half), s = std::sin(half);
    VectorXd g = VectorXd::Zero(4 * contacts);
    if (i < contacts) g.segment<2>(2 * i) = Eigen::Vector2d(c, s);
    if (i > 0) g.segment<2>(2 * (i - 1)) = Eigen::Vector2d(-c, s);
    return g;
  }
  double tension(int i, const VectorXd& z) const {
    if (i == 0) return weight;
    return stiffness * (strand(i).dot(z) + (i == contacts ? hand : 0.0));
  }
  // The forces on the contacts are -dE/dx + C^T lambda: w of the free rows is minus that.
  Case problem(const VectorXd& bounds) const {
    const int n = contacts;
    Case c{MatrixXd::Zero(4 * n, 4 * n), VectorXd::Zero(4 * n), VectorXd::Constant(4 * n, -inf),
           VectorXd::Constant(4 * n, inf)};
    c.q = weight * strand(0);
    for (int i = 1; i <= n; ++i) {
      c.M += stiffness * strand(i) * strand(i).transpose();
      if (i == n) c.q += stiffness * hand * strand(i);
    }
    for (int i = 0; i < n; ++i) {
      const int along = 2 * i, outward = along + 1, normal = 2 * n + i, rub = 3 * n + i;
      c.M(normal, outward) = 1.0, c.M(outward, normal) = -1.0;
      c.M(rub, along) = 1.0, c.M(along, rub) = -1.0;
      c.lower[normal] = 0.0;
      c.lower[rub] = -bounds[i], c.upper[rub] = bounds[i];
    }
    return c;
  }
};

struct Grip {
  McpSolution solution;
  int rounds = 0;
};

// The bound of each box is friction times the normal force of the round before.
Grip coulomb(const Belt& belt, McpMethod method) {
  const int n = belt.contacts;
  VectorXd bounds = VectorXd::Zero(n);
  for (Grip grip;;) {
    grip.solution = solve(belt.problem(bounds), method);
    expect_solved(belt.problem(bounds), grip.solution);
    const VectorXd next = belt.friction * grip.solution.z.segment(2 * n, n);
    ++grip.rounds;
    const double change = (next - bounds).cwiseAbs().maxCoeff();
    bounds = next;
    if (change <= 1e-13 * next.maxCoeff() || grip.rounds == 100) return grip;
  }
}

TEST(Capstan, TensionRatioOfAPolygon) {
  const struct {
    int contacts;
    double ratio;  // the closed form, to the digits printed
  } rows[] = {{8, 2.601050}, {16, 2.574854}};
  for (const auto& row : rows) {
    const double half = 0.5 * pi / row.contacts, mu = 0.3;
    const double closed =
        std::pow((std::cos(half) + mu * std::sin(half)) / (std::cos(half) - mu * std::sin(half)),
                 row.contacts);
    for (const McpMethod method : {McpMethod::automatic, McpMethod::pivoting}) {
      SCOPED_TRACE(name(method));
      const Belt belt{row.contacts, pi, mu};
      const Grip grip = coulomb(belt, method);
      const VectorXd& z = grip.solution.z;
      const double ratio = belt.tension(belt.contacts, z) / belt.tension(0, z);
      std::printf("capstan, N %2d, %s: ratio %.9f, closed form %.9f, %d rounds, residual %.1e\n",
                  row.contacts, name(method).c_str(), ratio, closed, grip.rounds,
                  grip.solution.report.residual);
      EXPECT_LT(grip.rounds, 100);
      EXPECT_NEAR(ratio, row.ratio, 5e-7);
      EXPECT_NEAR(ratio, closed, 1e-9);
      EXPECT_GT(z.segment(2 * belt.contacts, belt.contacts).minCoeff(), 0.0);  // all press
      for (int i = 0; i < belt.contacts; ++i) EXPECT_GT(z[2 * i], 1e-4) << i;  // all slip
    }
  }
  std::printf("capstan, smooth post: exp(mu pi) = %.6f\n", std::exp(0.3 * pi));
}

}  // namespace
}  // namespace brainshift::test
