// Sparse Cholesky against Eigen's dense one.
#include "linear/spd_solver.hpp"

#include <filesystem>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "linear/matrices.hpp"
#include "support/expect_error.hpp"

namespace brainshift {
namespace {

TEST(SpdSolver, SolvesForSeveralRightHandSides) {
  for (Index n : {1, 2, 17, 150}) {
    const test::RandomMatrix random(n, unsigned(n));
    const auto solver = make_spd_solver();
    solver->analyse(random.blocks);
    ASSERT_TRUE(solver->factorise(random.blocks));
    EXPECT_GT(solver->factor_nonzeros(), 0.0);
    for (Index columns : {1, 4, 2}) {
      const Eigen::MatrixXd b = Eigen::MatrixXd::Random(3 * n, columns);
      Eigen::MatrixXd x = b;
      solver->solve(x);
      // diagonally dominant: condition below 1e2
      EXPECT_LT((random.dense * x - b).norm(), 1e-13 * b.norm()) << n;
      EXPECT_LT((x - random.dense.llt().solve(b)).norm(), 1e-13 * x.norm()) << n;
    }
  }
}

// A solve in single precision, 6e-8 for each rounding; the next factor is a whole one again.
TEST(SpdSolver, ARoundedFactorSolvesToSinglePrecisionUntilTheNext) {
  const test::RandomMatrix random(150, 3);
  const Eigen::MatrixXd b = 1e60 * Eigen::MatrixXd::Random(450, 2);   // beyond that range itself
  const Eigen::MatrixXd exact = random.dense.llt().solve(b);
  const auto solver = make_spd_solver();
  solver->analyse(random.blocks);
  const auto error = [&] {
    Eigen::MatrixXd x = b;
    solver->solve(x);
    return (x - exact).norm() / exact.norm();
  };
  ASSERT_TRUE(solver->factorise(random.blocks));
  if (!solver->round_factor()) GTEST_SKIP() << "this backend keeps its factor as it is";
  const double rounded = error();
  EXPECT_LT(rounded, 1e-5);
  EXPECT_GT(rounded, 1e-9);
  EXPECT_TRUE(solver->round_factor());
  EXPECT_EQ(error(), rounded);
  test::expect_error(ErrorCode::internal, {"rounded"}, [&] { solver->forward(b.col(0)); });
  ASSERT_TRUE(solver->factorise(random.blocks));
  EXPECT_LT(error(), 1e-13);
}

TEST(SpdSolver, AFactorOutOfSinglePrecisionsRangeStaysAsItIs) {
  for (const double scale : {1e80, 1e-80}) {
    const test::RandomMatrix random(20, 5);
    BlockMatrix scaled = random.blocks;
    scaled.set_zero();
    scaled.add(random.blocks, scale);
    const Eigen::MatrixXd b = Eigen::MatrixXd::Random(60, 1);
    const auto solver = make_spd_solver();
    solver->analyse(scaled);
    ASSERT_TRUE(solver->factorise(scaled));
    EXPECT_FALSE(solver->round_factor()) << scale;
    Eigen::MatrixXd x = b;
    solver->solve(x);
    EXPECT_LT((scale * random.dense * x - b).norm(), 1e-13 * b.norm()) << scale;
  }
}

// Each with a matrix of its own: neither may disturb the other, whatever the BLAS.
TEST(SpdSolver, InTwoThreadsEqualOneAlone) {
  const auto work = [](unsigned seed, int rounds) {
    const test::RandomMatrix random(200, seed);
    const auto solver = make_spd_solver();
    solver->analyse(random.blocks);
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    const Eigen::MatrixXd b =
        Eigen::MatrixXd::NullaryExpr(600, 40, [&] { return entry(engine); });
    std::vector<Eigen::MatrixXd> found;
    for (int round = 0; round < rounds; ++round) {
      if (!solver->factorise(random.blocks)) return found;
      for (int again = 0; again < 20; ++again) {
        Eigen::MatrixXd x = b;
        solver->solve(x);
        if (found.empty() || x != found.back()) found.push_back(x);
      }
    }
    return found;   // one entry where all were the same bits
  };
  const auto first = work(1, 1), second = work(2, 1);
  std::vector<Eigen::MatrixXd> beside;
  std::thread other([&] { beside = work(2, 40); });
  const auto here = work(1, 40);
  other.join();
  EXPECT_EQ(here, first);
  EXPECT_EQ(beside, second);
}

TEST(SpdSolver, SolvesOfManyColumnsDoNotDependOnThreads) {
  const test::RandomMatrix random(150, 5);
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(450, 75);
  Eigen::MatrixXd found[2];
  for (int threads : {1, 2}) {
    const auto solver = make_spd_solver();
    solver->set_threads(threads);
    solver->analyse(random.blocks);
    ASSERT_TRUE(solver->factorise(random.blocks));
    found[threads - 1] = b;
    solver->solve(found[threads - 1]);
  }
  EXPECT_EQ(found[0], found[1]);
  EXPECT_LT((random.dense * found[0] - b).norm(), 1e-13 * b.norm());
}

// Columns of one entry, of many, of one that another has too, and an empty one.
TEST(SpdSolver, TheComplianceIsThatOfDenseSolves) {
  const test::RandomMatrix random(150, 8);
  std::vector<Eigen::Triplet<double>> entries{{449, 0, 2.0}, {0, 1, 1.0}, {1, 1, -1.0}, {0, 3, 0.5}};
  for (int i = 0; i < 450; i += 7) entries.emplace_back(i, 4, 0.1 * i - 20.0);
  SparseColumns C(450, 5);
  C.setFromTriplets(entries.begin(), entries.end());
  const auto solver = make_spd_solver();
  solver->analyse(random.blocks);
  ASSERT_TRUE(solver->factorise(random.blocks));
  solver->append(C.leftCols(2));
  solver->append(C.rightCols(3));
  solver->keep(2);                   // and once more what has been forgotten
  solver->append(C.rightCols(3));
  const Eigen::MatrixXd found = solver->compliance();
  const Eigen::MatrixXd exact = C.transpose() * random.dense.ldlt().solve(Eigen::MatrixXd(C));
  EXPECT_LT((found - exact).norm(), 1e-13 * exact.norm());
  EXPECT_EQ(found, found.transpose());
  EXPECT_EQ(found.col(2).norm(), 0.0);
}

// Known from the pattern: at least what is there in the end, and not much more.
TEST(SpdSolver, TheSizeOfAFactorIsKnownFromItsAnalysis) {
  for (Index n : {1, 20, 150}) {
    const test::RandomMatrix random(n, 10);
    const auto solver = make_spd_solver();
    solver->analyse(random.blocks);
    const FactorSize size = solver->size();
    EXPECT_GT(size.work, 0);
    ASSERT_TRUE(solver->factorise(random.blocks));
    EXPECT_GE(double(size.factor), 8.0 * solver->factor_nonzeros()) << n;
    EXPECT_LE(double(size.factor), 2.0 * 8.0 * solver->factor_nonzeros() + 1e3) << n;   // squares for triangles
    EXPECT_EQ(solver->size().factor, size.factor);
  }
}

// One block that all others touch, eliminated first: the factor is dense, and beyond what int can number.
TEST(SpdSolver, AFactorThatIsTooLargeIsRefusedByItsAnalysis) {
  if (!WITH_CHOLMOD) GTEST_SKIP() << "Eigen numbers entries of a factor without a check";
  constexpr Index n = 22000;   // (3 n)^2 = 4.4e9 entries, 35 GB
  std::vector<Indices> star(std::size_t(n), Indices{0});
  star[0].clear();
  for (Index i = 1; i < n; ++i) star[0].push_back(i);
  const BlockMatrix matrix(star);
  const auto solver = make_spd_solver();
  test::expect_error(ErrorCode::linear_solver, {"CHOLMOD analysis", "2^31 entries"}, [&] { solver->analyse(matrix); });
}

TEST(SpdSolver, WhatAColumnReachesIsKnownFromTheAnalysis) {
  const test::RandomMatrix random(150, 8);
  std::vector<Eigen::Triplet<double>> entries{{449, 0, 2.0}, {0, 1, 1.0}, {220, 2, 1.0}, {222, 2, -1.0}};
  for (int i = 0; i < 450; i += 7) entries.emplace_back(i, 3, 1.0);
  SparseColumns C(450, 5);   // the last is empty
  C.setFromTriplets(entries.begin(), entries.end());
  const auto solver = make_spd_solver();
  solver->analyse(random.blocks);
  const std::vector<std::int64_t> reach = solver->reach(C);
  ASSERT_TRUE(solver->factorise(random.blocks));
  EXPECT_EQ(solver->reach(C), reach);
  ASSERT_EQ(reach.size(), 5u);
  for (int c = 0; c < 5; ++c) {
    const Eigen::VectorXd z = solver->forward(Eigen::VectorXd(C.col(c)));
    EXPECT_LE((z.array() != 0.0).count(), reach[std::size_t(c)]) << c;
    EXPECT_LE(reach[std::size_t(c)], 450) << c;
  }
}

TEST(SpdSolver, ASolveInTwoHalvesIsOne) {
  const test::RandomMatrix random(150, 9);
  std::vector<Eigen::Triplet<double>> entries{{449, 0, 2.0}, {0, 1, 1.0}, {1, 1, -1.0}, {200, 2, 0.5}};
  SparseColumns C(450, 3);
  C.setFromTriplets(entries.begin(), entries.end());
  const auto solver = make_spd_solver();
  solver->analyse(random.blocks);
  ASSERT_TRUE(solver->factorise(random.blocks));
  const Eigen::VectorXd b = Eigen::VectorXd::Random(450), a = Eigen::Vector3d(0.3, -2.0, 1.0);
  const Eigen::VectorXd z = solver->forward(b);
  const Eigen::VectorXd alone = solver->backward(z, {});
  solver->append(C);
  const Eigen::VectorXd both = solver->backward(z, a);
  EXPECT_LT((random.dense * alone - b).norm(), 1e-13 * b.norm());
  EXPECT_LT((random.dense * both - (b + C * a)).norm(), 1e-13 * b.norm());
  EXPECT_LT((solver->project(z) - C.transpose() * alone).norm(), 1e-13 * alone.norm());
}

TEST(SpdSolver, SaysWhenAMatrixIsNotPositiveDefiniteAndServesAgain) {
  const test::RandomMatrix good(40, 3), bad(40, 3, -5.0);
  const auto solver = make_spd_solver();
  solver->analyse(good.blocks);
  EXPECT_FALSE(solver->factorise(bad.blocks));
  ASSERT_TRUE(solver->factorise(good.blocks));
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(120, 1);
  Eigen::MatrixXd x = b;
  solver->solve(x);
  EXPECT_LT((good.dense * x - b).norm(), 1e-13 * b.norm());
}

TEST(SpdSolver, AMatrixWithOneNegativePivotAtTheEndIsNotDefinite) {
  test::RandomMatrix m(40, 4);
  Mat3 pull = Mat3::Zero();
  pull(2, 2) = -100.0;
  m.blocks.add_at(39, 39, pull);
  const auto solver = make_spd_solver();
  solver->analyse(m.blocks);
  EXPECT_FALSE(solver->factorise(m.blocks));
}

TEST(SpdSolver, ANumberThatIsNoneIsNotPositiveDefinite) {
  test::RandomMatrix m(20, 5);
  m.blocks.add_at(7, 7, Mat3::Constant(std::numeric_limits<double>::quiet_NaN()));
  const auto solver = make_spd_solver();
  solver->analyse(m.blocks);
  if (solver->factorise(m.blocks)) {  // then at least the answer must not look like one
    Eigen::MatrixXd x = Eigen::MatrixXd::Ones(60, 1);
    solver->solve(x);
    EXPECT_FALSE(x.allFinite());
  }
}

TEST(SpdSolver, TheUpperHalfOfDiagonalBlocksIsIgnored) {
  test::RandomMatrix m(20, 6);
  const auto solver = make_spd_solver();
  solver->analyse(m.blocks);
  Mat3 upper = Mat3::Zero();
  upper(0, 2) = 77.0;
  m.blocks.add(m.blocks.slot(4, 4), upper);
  ASSERT_TRUE(solver->factorise(m.blocks));
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(60, 1);
  Eigen::MatrixXd x = b;
  solver->solve(x);
  EXPECT_LT((m.dense * x - b).norm(), 1e-13 * b.norm());
}

#ifdef __linux__
// Supernodes of a dense block are large enough for the loops that CHOLMOD would share out.
TEST(SpdSolver, LeavesNoThreadBehind) {
  const auto threads = [] {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) {
      count += entry.exists();
    }
    return count;
  };
  const std::size_t before = threads();
  std::vector<Indices> near(600);
  for (Index i = 0; i < 600; ++i) {
    for (Index j = 0; j < 600; ++j) {
      if (i != j && std::abs(i - j) < 150) near[std::size_t(i)].push_back(j);
    }
  }
  BlockMatrix banded(near);
  for (Index i = 0; i < 600; ++i) banded.add_at(i, i, 400.0 * Mat3::Identity());
  const auto solver = make_spd_solver();
  solver->analyse(banded);
  ASSERT_TRUE(solver->factorise(banded));
  Eigen::MatrixXd x = Eigen::MatrixXd::Ones(1800, 40);
  solver->solve(x);
  EXPECT_EQ(threads(), before);
}
#endif

TEST(SpdSolver, TheSameMatrixGivesTheSameBits) {
  const test::RandomMatrix m(150, 7);
  Eigen::MatrixXd x[2];
  for (auto& result : x) {
    const auto solver = make_spd_solver();
    solver->analyse(m.blocks);
    ASSERT_TRUE(solver->factorise(m.blocks));
    result = Eigen::VectorXd::LinSpaced(450, 0.0, 1.0);
    solver->solve(result);
  }
  EXPECT_EQ((x[0] - x[1]).cwiseAbs().maxCoeff(), 0.0);
}

}  // namespace
}  // namespace brainshift
