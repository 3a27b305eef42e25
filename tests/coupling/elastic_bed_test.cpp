// A device on an elastic bed of stiffness k per length, tied to it as to tissue: points along its
// curve, a bilateral row each, the bed's compliance and the device's in one complementarity problem.
// A force P across the end of a semi-infinite beam moves it by w = 2 P beta/k, beta = (k/4EI)^1/4
// (Hetenyi, Beams on Elastic Foundation, 1946, section 7).
#include <cstdio>

#include <gtest/gtest.h>

#include "brainshift/mcp.hpp"
#include "support/beams.hpp"

namespace brainshift::test {
namespace {

struct Bed {
  double bending, stiffness;  // EI (mN mm^2), k (mN/mm^2)
  double beta() const { return std::pow(stiffness / (4.0 * bending), 0.25); }
};

struct Pushed {
  double tip;         // mm
  double resultant;   // mN, of the bed
  double unbalanced;  // mN; largest force left on the beam
};

// Held far away, where nothing moves; `ties` of the bed, each at the middle of the length it stands for.
Pushed push(const Bed& bed, double length, Index elements, Index ties, double force) {
  const Beam beam = straight_beam(length, elements, round_section(bed.bending, bed.bending));
  BeamState state = beam.rest();
  Eigen::VectorXd load = Eigen::VectorXd::Zero(beam.dof_count());
  load[1] = force;
  Eigen::VectorXd gradient;
  BlockTridiagonal K(beam.node_count());
  beam.tangent(state, gradient, K);
  const BlockTridiagonal free_tangent = K;
  for (const Index dof : dofs_of(elements)) K.fix(dof);
  BlockTridiagonalFactor factor;
  EXPECT_TRUE(factor.factorise(K) && factor.positive());

  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(beam.dof_count(), ties);
  for (Index i = 0; i < ties; ++i) {
    const BeamPoint place = place_at(beam, (i + 0.5) * length / ties);
    D.block<12, 1>(6 * place.element, i) =
        -position_derivative(beam, state, place).transpose() * Vec3::UnitY();
  }
  for (const Index dof : dofs_of(elements)) D.row(dof).setZero();
  Eigen::MatrixXd Y = D, free = load;
  factor.solve(Y);
  factor.solve(free);
  const double share = bed.stiffness * length / ties;
  Eigen::MatrixXd W = D.transpose() * Y;
  W.diagonal().array() += 1.0 / share;
  const Eigen::VectorXd q = D.transpose() * free, open = Eigen::VectorXd::Constant(ties, INFINITY);
  const McpSolution found = solve_mcp(W, q, -open, open);
  EXPECT_EQ(found.report.status, McpStatus::solved);
  EXPECT_EQ(found.report.rank, ties);
  EXPECT_TRUE(found.report.unique);
  const Eigen::VectorXd step = free.col(0) + Y * found.z;
  Eigen::VectorXd rest = load + D * found.z - free_tangent.multiply(step);
  rest.tail<6>().setZero();
  return {step[1], found.z.sum(), rest.cwiseAbs().maxCoeff()};
}

TEST(ElasticBed, TipOfASemiInfiniteDevice) {
  const double young = 6.0, poisson = 0.45;
  const double k = 3.34 * young / (2.0 * (1.0 + poisson));
  for (const double bending : {5.0e3, 6.5e7}) {
    const Bed bed{bending, k};
    const double beta = bed.beta(), length = 8.0 / beta, force = 1e-3;
    const double exact = 2.0 * force * beta / k;
    double error[4];
    for (int level = 0; level < 4; ++level) {
      const Index elements = 16 << level;
      const Pushed p = push(bed, length, elements, elements, force);
      error[level] = std::abs(p.tip / exact - 1.0);
      std::printf(
          "elastic bed, EI %.0f: bending length %.2f mm, device %.0f mm, %3d elements of "
          "%.3f bending lengths: w %.9e mm, 2P beta/k %.9e, error %.2e\n",
          bending, 1.0 / beta, length, int(elements), 8.0 / elements, p.tip, exact, error[level]);
      // All of the force is in the bed, but for exp(-8) at the far end; what is left on the beam is
      // rounding times the condition of a cantilever, its number of elements to the fourth.
      EXPECT_NEAR(p.resultant, force, 1e-3 * force);
      EXPECT_LE(p.unbalanced, 1e-7 * force);
    }
    std::printf("elastic bed, EI %.0f: orders %.2f %.2f %.2f\n", bending, order(error[0], error[1]),
                order(error[1], error[2]), order(error[2], error[3]));
    EXPECT_LE(error[2], 5e-3);
    EXPECT_LE(error[3], 1e-3);
    for (int level = 0; level < 3; ++level) {
      EXPECT_NEAR(order(error[level], error[level + 1]), 2.0, 0.2) << level;  // midpoint rule
    }
  }
}

// The elements themselves cost little: with ties as dense as can be, four per element, elements of
// one bending length are good enough.
TEST(ElasticBed, ElementsOfOneBendingLengthAreEnough) {
  const Bed bed{5.0e3, 6.91};
  const double beta = bed.beta(), length = 8.0 / beta, exact = 2.0 * beta / bed.stiffness;
  const double coarse = push(bed, length, 8, 256, 1.0).tip / exact - 1.0;
  const double fine = push(bed, length, 32, 256, 1.0).tip / exact - 1.0;
  std::printf(
      "elastic bed, 256 ties: error %.2e with elements of a bending length, %.2e of a "
      "quarter\n",
      coarse, fine);
  EXPECT_LE(std::abs(coarse), 5e-3);
  EXPECT_LE(std::abs(fine), 1e-3);
}

}  // namespace
}  // namespace brainshift::test
