// Problems of friction: a belt round a post, and Coulomb's law as one complementarity problem.
#pragma once

#include "problems.hpp"

namespace brainshift::test {

constexpr double pi = 3.14159265358979323846;

// A belt over `angle` of a round post in N contacts: the polygon turns by angle/N at each, so that
// its two strands leave a contact at half of that from the tangent. Unknowns: tangential and outward
// displacement of every contact (free rows), then normal force (one-sided) and friction (box) of
// each. Strand 0 hangs on a weight T0, strand N on a hand that pulls `hand` mm. `ground`: a spring of
// every contact in either direction, for those who need a regular stiffness (0: none).
struct Belt {
  int contacts;
  double angle, friction;
  double weight = 1.0, stiffness = 100.0, hand = 1.0, ground = 0.0;

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
    c.M.diagonal().head(2 * n).setConstant(ground);
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
inline Grip coulomb(const Belt& belt, McpMethod method) {
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

// Contacts in the plane with Coulomb's law, without boxes: velocity W r + q, rows (normal,
// tangential) of each contact. Unknowns per contact: N, the two ways of friction f+ and f-, and the
// speed of sliding s (Stewart and Trinkle 1996):
//   0 <= N  _|_ v_n,   0 <= f+ _|_ v_t + s,   0 <= f- _|_ s - v_t,   0 <= s _|_ mu N - f+ - f-.
inline Case coulomb_problem(const MatrixXd& W, const VectorXd& q, double friction) {
  const Eigen::Index contacts = q.size() / 2;
  MatrixXd E = MatrixXd::Zero(q.size(), 4 * contacts);  // r = E z
  for (Eigen::Index i = 0; i < contacts; ++i) {
    E(2 * i, 4 * i) = 1.0;
    E(2 * i + 1, 4 * i + 1) = 1.0;
    E(2 * i + 1, 4 * i + 2) = -1.0;
  }
  Case c = one_sided(E.transpose() * W * E, E.transpose() * q);
  for (Eigen::Index k = 0; k < 4 * contacts; k += 4) {
    c.M(k + 1, k + 3) = c.M(k + 2, k + 3) = 1.0;
    c.M(k + 3, k) = friction;
    c.M(k + 3, k + 1) = c.M(k + 3, k + 2) = -1.0;
  }
  return c;
}

// Reaction (normal, tangential) of contact i in a solution of that.
inline Eigen::Vector2d reaction(const VectorXd& z, Eigen::Index i) {
  return {z[4 * i], z[4 * i + 1] - z[4 * i + 2]};
}

}  // namespace brainshift::test
