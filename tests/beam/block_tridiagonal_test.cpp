#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "beam/block_tridiagonal.hpp"
#include "support/beams.hpp"

namespace brainshift::test {
namespace {

// Elements with random symmetric matrices; `definite`: positive definite with a spread of 1e8.
BlockTridiagonal random_matrix(Index blocks, bool definite) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  BlockTridiagonal matrix(blocks);
  for (Index e = 0; e + 1 < blocks; ++e) {
    Mat12 A;
    for (int k = 0; k < 144; ++k) A.data()[k] = normal(random);
    Vec12 scale;
    for (int k = 0; k < 12; ++k) scale[k] = std::pow(10.0, 4.0 * (k % 6) / 5.0);
    const Mat12 scaled = scale.asDiagonal() * A;
    matrix.add_element(e, definite ? Mat12(scaled * scaled.transpose()) : Mat12(A + A.transpose()));
  }
  return matrix;
}

TEST(BlockTridiagonal, SolvesManyRightHandSides) {
  for (const Index blocks : {2, 3, 40}) {
    for (const bool definite : {true, false}) {
      const BlockTridiagonal A = random_matrix(blocks, definite);
      BlockTridiagonalFactor factor;
      ASSERT_TRUE(factor.factorise(A));
      const Eigen::MatrixXd dense = A.dense();
      const Eigen::MatrixXd b = Eigen::MatrixXd::Random(A.rows(), 7);
      Eigen::MatrixXd x = b;
      factor.solve(x);
      // backward error of elimination; without pivoting an indefinite one may grow some digits
      const double bound = (definite ? 1e-13 : 1e-9) * dense.norm() * x.norm();
      EXPECT_LE((dense * x - b).norm(), bound) << blocks;
      EXPECT_LE((A.multiply(x.col(3)) - dense * x.col(3)).norm(), 1e-14 * dense.norm() * x.norm());
    }
  }
}

TEST(BlockTridiagonal, CountsNegativeEigenvalues) {
  for (const bool definite : {true, false}) {
    const BlockTridiagonal A = random_matrix(12, definite);
    BlockTridiagonalFactor factor;
    ASSERT_TRUE(factor.factorise(A));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A.dense());
    EXPECT_EQ(factor.negative_pivots(), (eigen.eigenvalues().array() < 0.0).count());
    EXPECT_EQ(factor.positive(), definite);
  }
}

TEST(BlockTridiagonal, RefusesASingularMatrix) {
  const Beam beam = straight_beam(10.0, 5, round_section(3.0));
  Eigen::VectorXd gradient;
  BlockTridiagonal K;
  beam.tangent(beam.rest(), gradient, K);
  BlockTridiagonalFactor factor;
  EXPECT_FALSE(factor.factorise(BlockTridiagonal(4)));
  // a beam that nothing holds: rounding decides the sign of its last pivots, unless one vanishes
  EXPECT_FALSE(factor.factorise(K) && factor.positive() && K.dense().ldlt().rcond() > 1e-12);
  for (const Index dof : dofs_of(0)) K.fix(dof);
  EXPECT_TRUE(factor.factorise(K));
  EXPECT_TRUE(factor.positive());
}

TEST(BlockTridiagonal, FixedDofsStay) {
  BlockTridiagonal A = random_matrix(5, true);
  const Eigen::MatrixXd before = A.dense();
  A.fix(13);
  BlockTridiagonalFactor factor;
  ASSERT_TRUE(factor.factorise(A));
  Eigen::VectorXd x = Eigen::VectorXd::Ones(A.rows());
  x[13] = 0.0;
  const Eigen::VectorXd b = x;
  factor.solve(x);
  EXPECT_EQ(x[13], 0.0);
  Eigen::VectorXd rest = before * x - b;
  rest[13] = 0.0;
  EXPECT_LE(rest.norm(), 1e-12 * before.norm() * x.norm());
}

}  // namespace
}  // namespace brainshift::test
