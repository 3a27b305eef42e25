// Critical loads and frequencies: eigenvalues of the exact tangent.
#include <cstdio>
#include <functional>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "support/beams.hpp"

namespace brainshift::test {
namespace {

constexpr double EI = 1.0, L = 1.0;
// Axial strain at the critical load 4 pi^2 EI/(EA L^2) = 4e-8: far below the tolerances.
constexpr double axial = 1e9;

bool stable(const Beam& beam, const BeamState& state, const std::vector<Index>& fixed) {
  Eigen::VectorXd gradient;
  BlockTridiagonal K;
  beam.tangent(state, gradient, K);
  for (const Index dof : fixed) K.fix(dof);
  BlockTridiagonalFactor factor;
  return factor.factorise(K) && factor.positive();
}

// Smallest factor of the load at which the state loses stability.
double critical(double low, double high, const std::function<bool(double)>& stable_at) {
  EXPECT_TRUE(stable_at(low));
  EXPECT_FALSE(stable_at(high));
  while (high - low > 1e-10 * high) {
    const double middle = 0.5 * (low + high);
    (stable_at(middle) ? low : high) = middle;
  }
  return low;
}

// Straight beam pressed to the strain -P/EA.
BeamState pressed(const Beam& beam, double P) {
  BeamState state = beam.rest();
  state.x.col(0) *= 1.0 - P / axial;
  return state;
}

TEST(BeamStability, EulerLoadsWithEightElements) {
  const struct {
    const char* name;
    std::vector<Index> near, far;  // fixed dofs at either end
    double load;
  } rows[] = {{"cantilever", {0, 1, 2, 3, 4, 5}, {}, 0.25 * pi * pi},
              {"pinned", {0, 1, 2, 3}, {1, 2}, pi * pi},
              {"clamped-pinned", {0, 1, 2, 3, 4, 5}, {1, 2}, 20.1907285564},
              {"clamped-clamped", {0, 1, 2, 3, 4, 5}, {1, 2, 3, 4, 5}, 4.0 * pi * pi}};
  for (const auto& row : rows) {
    double error[3];
    for (int k = 0; k < 3; ++k) {
      const Beam beam = straight_beam(L, 4 << k, round_section(EI, axial));
      std::vector<Index> fixed = row.near;
      for (const Index dof : row.far) fixed.push_back(6 * beam.element_count() + dof);
      const double found = critical(0.1 * row.load, 2.0 * row.load, [&](double P) {
        return stable(beam, pressed(beam, P), fixed);
      });
      error[k] = std::abs(found / row.load - 1.0);
    }
    std::printf("Euler load, %s: error with 4, 8, 16 elements %.2e %.2e %.2e, orders %.2f %.2f\n",
                row.name, error[0], error[1], error[2], order(error[0], error[1]),
                order(error[1], error[2]));
    EXPECT_LT(error[1], 5e-3) << row.name;                  // the bound asked for
    EXPECT_GT(order(error[0], error[1]), 3.5) << row.name;  // cubic deflection: order 4
  }
}

// Twisted by an angle between a clamp and an end that turns and slides along the axis only.
TEST(BeamStability, TorsionalBuckling) {
  const double exact = 8.98681891582;  // T L/EI
  double error[3];
  for (int k = 0; k < 3; ++k) {
    const Beam beam = straight_beam(L, 8 << k, round_section(EI, axial));
    const Index last = beam.element_count();
    const auto fixed = joined(dofs_of(0), dofs_of(last, {1, 2, 3, 4, 5}));
    const double found = critical(0.1 * exact, 2.0 * exact, [&](double torque) {
      BeamState state = beam.rest();
      Eigen::VectorXd twist = Eigen::VectorXd::Zero(beam.dof_count());
      for (Index i = 0; i <= last; ++i) twist[6 * i + 3] = torque / EI * i / last;  // GJ = EI
      beam.update(state, twist);
      return stable(beam, state, fixed);
    });
    error[k] = std::abs(found / exact - 1.0);
  }
  std::printf(
      "torsional buckling: error with 8, 16, 32 elements %.2e %.2e %.2e, orders %.2f %.2f\n",
      error[0], error[1], error[2], order(error[0], error[1]), order(error[1], error[2]));
  EXPECT_LT(error[0], 5e-3);
  EXPECT_GT(order(error[0], error[1]), 2.0);
}

// A mast under its own weight q per length: q L^3/EI = 7.837347.
TEST(BeamStability, SelfWeightColumn) {
  const double exact = 7.83734743894;
  double error[3];
  for (int k = 0; k < 3; ++k) {
    BeamSection section = round_section(EI, axial);
    section.line_density = 1.0;
    const Beam beam = straight_beam(L, 8 << k, section);
    const double found = critical(0.1 * exact, 2.0 * exact, [&](double q) {
      BeamState state = beam.rest();
      const Eigen::VectorXd weight = beam.weight(Vec3(-q, 0, 0));
      double force = weight.sum();  // on the element, from what lies above it
      for (Index i = 0; i < beam.element_count(); ++i) {
        force -= weight[6 * i];
        state.x(i + 1, 0) = state.x(i, 0) + beam.element(i).length() * (1.0 + force / axial);
      }
      return stable(beam, state, dofs_of(0));
    });
    error[k] = std::abs(found / exact - 1.0);
  }
  std::printf("self-weight column: error with 8, 16, 32 elements %.2e %.2e %.2e, order %.2f\n",
              error[0], error[1], error[2], order(error[0], error[1]));
  EXPECT_LT(error[1], 5e-3);
  EXPECT_GT(order(error[0], error[1]), 1.9);  // weight in lumps on the nodes: order 2
}

// Bending frequencies (beta L)^4 = omega^2 m L^4/EI.
double beta(const Beam& beam, const std::vector<Index>& fixed, int mode) {
  Eigen::VectorXd gradient;
  BlockTridiagonal K;
  beam.tangent(beam.rest(), gradient, K);
  const Eigen::MatrixXd stiffness = K.dense(), mass = beam.mass(beam.rest()).dense();
  std::vector<Index> free;
  for (Index i = 0; i < beam.node_count(); ++i) {
    for (const Index dof : {6 * i + 1, 6 * i + 5}) {  // in the plane (x, y)
      if (std::find(fixed.begin(), fixed.end(), dof) == fixed.end()) free.push_back(dof);
    }
  }
  const auto count = Eigen::Index(free.size());
  Eigen::MatrixXd k(count, count), m(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      k(i, j) = stiffness(free[std::size_t(i)], free[std::size_t(j)]);
      m(i, j) = mass(free[std::size_t(i)], free[std::size_t(j)]);
    }
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(k, m);
  return std::pow(solver.eigenvalues()[mode], 0.25);
}

TEST(BeamFrequencies, ConsistentMass) {
  BeamSection section = round_section(EI, axial);
  section.line_density = 1.0;
  section.radius = 1e-4;  // rotary inertia: (beta r/L)^2/8, below every tolerance
  const struct {
    bool clamped_end;
    int mode;
    double beta;
  } rows[] = {{false, 0, 1.875104068712},
              {false, 1, 4.694091132974},
              {false, 2, 7.854757438238},
              {true, 0, 4.730040744863}};
  for (const auto& row : rows) {
    double error[2];
    for (int k = 0; k < 2; ++k) {
      const Beam beam = straight_beam(L, 8 << k, section);
      auto fixed = dofs_of(0);
      if (row.clamped_end) fixed = joined(fixed, dofs_of(beam.element_count()));
      error[k] = std::abs(beta(beam, fixed, row.mode) / row.beta - 1.0);
    }
    std::printf("beta L = %.4f: error with 8, 16 elements %.2e %.2e, order %.2f\n", row.beta,
                error[0], error[1], order(error[0], error[1]));
    // a wave of this number spans 8 pi/beta elements; (beta/8)^4/720 each
    EXPECT_LT(error[0], 1.1 * std::pow(row.beta / 8.0, 4) / 720.0 * 2.5);
    // cubic: order 4, until rounding of the eigenvalues (EA/EI makes no part of them: 1e-9)
    if (error[1] > 1e-8) {
      EXPECT_GT(order(error[0], error[1]), 3.5);
    }
  }
}

}  // namespace
}  // namespace brainshift::test
