// The block matrix against a dense one.
#include "linear/block_matrix.hpp"

#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>
#include <Eigen/SparseCore>

#include "brainshift/error.hpp"
#include "linear/matrices.hpp"

namespace brainshift {
namespace {

TEST(BlockMatrix, HoldsTheLowerTriangleOfItsPatternDiagonalFirst) {
  const BlockMatrix K({{1, 3}, {0, 2}, {1}, {0}});
  EXPECT_EQ(K.blocks(), 4);
  EXPECT_EQ(K.block_nonzeros(), 4 + 3);
  EXPECT_EQ(Indices(K.rows_begin(0), K.rows_end(0)), (Indices{0, 1, 3}));
  EXPECT_EQ(Indices(K.rows_begin(1), K.rows_end(1)), (Indices{1, 2}));
  EXPECT_EQ(K.scalar_columns().size(), 13u);
  EXPECT_EQ(K.scalar_rows().size(), 9u * 7u);
  EXPECT_EQ(K.values().size(), 9u * 7u);
}

TEST(BlockMatrix, ScalarColumnsAreWhatSparseSolversRead) {
  const test::RandomMatrix random(9, 1);
  const BlockMatrix& K = random.blocks;
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::ColMajor, int>> sparse(
      27, 27, Eigen::Index(K.values().size()), K.scalar_columns().data(), K.scalar_rows().data(),
      K.values().data());
  const Eigen::MatrixXd lower = Eigen::MatrixXd(sparse).triangularView<Eigen::Lower>();
  EXPECT_EQ((lower - Eigen::MatrixXd(random.dense.triangularView<Eigen::Lower>())).norm(), 0.0);
  for (Index j = 0; j < 27; ++j) {  // rows ascend within a column
    for (int k = K.scalar_columns()[std::size_t(j)] + 1; k < K.scalar_columns()[std::size_t(j) + 1];
         ++k) {
      EXPECT_LT(K.scalar_rows()[std::size_t(k) - 1], K.scalar_rows()[std::size_t(k)]);
    }
  }
}

TEST(BlockMatrix, MultipliesAsTheSymmetricMatrixItStandsFor) {
  const test::RandomMatrix random(12, 2);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(36, -1.0, 2.0);
  Eigen::VectorXd y = Eigen::VectorXd::Constant(5, 99.0);  // whatever was there
  random.blocks.multiply(x, y);
  EXPECT_LT((y - random.dense * x).norm(), 1e-13 * y.norm());
}

TEST(BlockMatrix, MultipliesSomeOfItsRows) {
  const test::RandomMatrix random(12, 2);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(36, -1.0, 2.0), all = random.dense * x;
  const Indices rows = {11, 0, 5};
  Eigen::VectorXd y = Eigen::VectorXd::Constant(5, 99.0), expected = Eigen::VectorXd::Zero(36);
  for (const Index i : rows) expected.segment<3>(3 * i) = all.segment<3>(3 * i);
  random.blocks.multiply(x, rows, y);
  EXPECT_LT((y - expected).norm(), 1e-13 * all.norm());
}

TEST(BlockMatrix, AddsABlockOrItsTransposeIntoTheLowerTriangle) {
  BlockMatrix K({{1}, {0}});
  Mat3 A;
  A << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  K.add_at(1, 0, A);
  EXPECT_EQ(K.get(K.slot(1, 0)), A);
  K.add_at(0, 1, A);
  EXPECT_EQ(K.get(K.slot(1, 0)), Mat3(A + A.transpose()));
  K.set_zero();
  EXPECT_TRUE(K.get(K.slot(1, 0)).isZero(0.0));
}

TEST(BlockMatrix, ABlockOutsideThePatternIsRefused) {
  BlockMatrix K({{1}, {0}, {}});
  EXPECT_THROW(K.slot(2, 0), Error);
  EXPECT_THROW(K.add_at(0, 2, Mat3::Identity()), Error);
}

TEST(BlockMatrix, AddsToTheDiagonalAndKnowsItsMean) {
  BlockMatrix K({{1}, {0}});
  EXPECT_EQ(K.mean_diagonal(), 0.0);
  K.add_to_diagonal(2.5);
  EXPECT_EQ(K.mean_diagonal(), 2.5);
  EXPECT_EQ(K.get(K.slot(1, 1)), Mat3(2.5 * Mat3::Identity()));
  EXPECT_TRUE(K.get(K.slot(1, 0)).isZero(0.0));
}

TEST(BlockMatrix, AnEmptyOneIsFine) {
  const BlockMatrix K{std::vector<Indices>{}};
  Eigen::VectorXd y;
  K.multiply(Eigen::VectorXd(), y);
  EXPECT_EQ(y.size(), 0);
}

}  // namespace
}  // namespace brainshift
