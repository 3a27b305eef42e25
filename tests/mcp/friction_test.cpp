// Friction as boxes: pull-out of a chain, and a belt round a post (capstan) in N contacts; with
// Coulomb's law in the problem: a block on a slope.
#include <cstdio>

#include "friction.hpp"

namespace brainshift::test {
namespace {

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

// A block of unit mass on a slope: velocity after a second from rest, so that it is an acceleration,
// normal and down the slope. Sticks where tan(angle) <= mu, else a = g (sin - mu cos).
TEST(Slope, BlockSticksUpToTheAngleOfFriction) {
  const double g = standard_gravity, mu = 0.3, critical = std::atan(mu);
  for (const double angle : {0.0, 0.5 * critical, critical - 1e-6, critical + 1e-6, 0.5, 1.2}) {
    SCOPED_TRACE(angle);
    const Eigen::Vector2d free(-g * std::cos(angle), g * std::sin(angle));
    const double expected = std::max(0.0, g * (std::sin(angle) - mu * std::cos(angle)));
    EXPECT_EQ(expected == 0.0, std::tan(angle) <= mu);
    const Case c = coulomb_problem(MatrixXd::Identity(2, 2), free, mu);
    for (const McpMethod method : {McpMethod::automatic, McpMethod::pivoting}) {
      SCOPED_TRACE(name(method));
      const McpSolution s = solve(c, method);
      expect_solved(c, s);
      const Eigen::Vector2d r = reaction(s.z, 0), v = free + r;
      // 1e-10 of g, the residual that counts as solved
      EXPECT_NEAR(v[0], 0.0, 1e-10 * g);
      EXPECT_NEAR(v[1], expected, 1e-10 * g);
      EXPECT_NEAR(r[0], g * std::cos(angle), 1e-10 * g);
      EXPECT_NEAR(r[1], -std::min(mu * r[0], g * std::sin(angle)), 1e-10 * g);
    }
    // with the normal force known, friction is a box
    Case box = one_sided(MatrixXd::Identity(1, 1), vector({free[1]}));
    box.upper[0] = mu * g * std::cos(angle), box.lower[0] = -box.upper[0];
    EXPECT_NEAR(solve(box).w[0], expected, 1e-10 * g);
  }
}

}  // namespace
}  // namespace brainshift::test
