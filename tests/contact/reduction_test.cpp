// Elimination of rows against a dense solve of the whole KKT system
//   [K G^T; G 0] [dx; -m] = [f; v],   G dx = v,   K dx = f + G^T m.
#include "contact/reduction.hpp"

#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "linear/spd_solver.hpp"

namespace brainshift {
namespace {

constexpr Index blocks = 8;

std::vector<Indices> complete_graph() {
  std::vector<Indices> near(blocks);
  for (Index i = 0; i < blocks; ++i) {
    for (Index j = 0; j < blocks; ++j) {
      if (i != j) near[std::size_t(i)].push_back(j);
    }
  }
  return near;
}

struct Problem {
  std::mt19937 random;
  BlockMatrix K{complete_graph()};
  Eigen::MatrixXd dense;
  Eigen::VectorXd force;
  std::vector<NodeRow> rows;

  explicit Problem(unsigned seed, bool definite = true) : random(seed) {
    std::normal_distribution<double> normal;
    Eigen::MatrixXd half(3 * blocks, definite ? 4 * blocks : 3 * blocks - 4);
    for (Eigen::Index i = 0; i < half.size(); ++i) half.data()[i] = normal(random);
    dense = half * half.transpose();
    for (Index i = 0; i < blocks; ++i) {
      for (Index j = 0; j <= i; ++j) K.add_at(i, j, dense.block<3, 3>(3 * i, 3 * j));
    }
    force = Eigen::VectorXd::NullaryExpr(3 * blocks, [&] { return normal(random); });
  }
  Vec3 direction() {
    std::normal_distribution<double> normal;
    return Vec3(normal(random), normal(random), normal(random));
  }
  void row(Index block, Vec3 normal, Index partner = -1) {
    std::normal_distribution<double> value;
    rows.push_back({block, partner, normal, value(random), rows.size()});
  }
  Eigen::MatrixXd gradients() const {
    Eigen::MatrixXd G = Eigen::MatrixXd::Zero(Eigen::Index(rows.size()), 3 * blocks);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      G.block<1, 3>(Eigen::Index(r), 3 * rows[r].block) += rows[r].normal.transpose();
      if (rows[r].partner >= 0) {
        G.block<1, 3>(Eigen::Index(r), 3 * rows[r].partner) -= rows[r].normal.transpose();
      }
    }
    return G;
  }
};

struct Solution {
  Eigen::VectorXd dx;
  std::vector<double> multipliers;
};

// As Newton uses the class.
Solution by_reduction(const Problem& p) {
  const Reduction reduction(blocks, p.rows);
  BlockMatrix A(complete_graph());
  reduction.reduce(p.K, p.K.mean_diagonal(), A);
  const auto solver = make_spd_solver();
  solver->analyse(A);
  EXPECT_TRUE(solver->factorise(A));
  Eigen::VectorXd product;
  p.K.multiply(reduction.particular(), product);
  Eigen::MatrixXd y = reduction.restrict_force(p.force - product);
  solver->solve(y);
  Solution s;
  s.dx = reduction.expand(y.col(0)) + reduction.particular();
  p.K.multiply(s.dx, product);
  s.multipliers.assign(p.rows.size(), 0.0);
  reduction.multipliers(p.force - product, s.multipliers);
  return s;
}

Solution by_kkt(const Problem& p) {
  const Eigen::MatrixXd G = p.gradients();
  const Eigen::Index n = G.cols(), m = G.rows();
  Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n + m, n + m);
  kkt.topLeftCorner(n, n) = p.dense;
  kkt.topRightCorner(n, m) = -G.transpose();
  kkt.bottomLeftCorner(m, n) = G;
  Eigen::VectorXd rhs(n + m);
  rhs.head(n) = p.force;
  for (Eigen::Index r = 0; r < m; ++r) rhs[n + r] = p.rows[std::size_t(r)].value;
  const Eigen::VectorXd x = kkt.fullPivLu().solve(rhs);
  return {x.head(n), std::vector<double>(x.data() + n, x.data() + n + m)};
}

// Condition numbers here are below 1e4: agreement to 1e-10 leaves no room for a wrong term.
void expect_same(const Problem& p, const char* what) {
  const Solution a = by_reduction(p), b = by_kkt(p);
  EXPECT_LT((a.dx - b.dx).norm(), 1e-10 * b.dx.norm()) << what;
  double scale = 0.0;
  for (double m : b.multipliers) scale = std::max(scale, std::abs(m));
  for (std::size_t r = 0; r < p.rows.size(); ++r) {
    EXPECT_NEAR(a.multipliers[r], b.multipliers[r], 1e-9 * scale) << what << " row " << r;
  }
}

TEST(Reduction, WithoutRowsIsTheMatrixItself) {
  const Problem p(1);
  expect_same(p, "none");
}

TEST(Reduction, SingleRowsAgreeWithTheKktSystem) {
  Problem p(2);
  p.row(1, p.direction());
  p.row(5, Vec3::UnitX());
  expect_same(p, "single");
}

TEST(Reduction, AFixedNodeAgreesWithTheKktSystem) {
  Problem p(3);
  for (int axis = 0; axis < 3; ++axis) p.row(4, Vec3::Unit(axis));
  expect_same(p, "fixed");
}

TEST(Reduction, TwoAndThreeObliqueRowsOfANodeAgreeWithTheKktSystem) {
  Problem p(4);
  p.row(2, p.direction());
  p.row(2, p.direction());
  for (int k = 0; k < 3; ++k) p.row(6, p.direction());
  expect_same(p, "oblique");
}

TEST(Reduction, RowsAtASmallAngleAgreeWithTheKktSystem) {
  Problem p(5);
  const Vec3 n = p.direction().normalized();
  p.row(2, n);
  p.row(2, (n + 1e-2 * p.direction()).normalized());
  expect_same(p, "small angle");
}

TEST(Reduction, PairRowsAgreeWithTheKktSystem) {
  Problem p(6);
  p.row(0, p.direction(), 7);
  p.row(5, p.direction(), 2);
  expect_same(p, "pairs");
}

TEST(Reduction, PairsOfNeighboursWhosePartnersAreNeighboursAgree) {
  // All blocks touch: K_ij of two pairs is felt by both partners.
  Problem p(7);
  for (Index i = 0; i < 4; ++i) p.row(i, p.direction(), i + 4);
  expect_same(p, "all paired");
}

TEST(Reduction, ANodeWithSkullAndPairRowsAgrees) {
  Problem p(8);
  p.row(3, p.direction());  // skull at the node
  p.row(6, p.direction());  // and at the partner
  p.row(1, p.direction());
  p.row(1, p.direction());
  p.row(3, p.direction(), 6);
  p.row(1, p.direction(), 0);
  expect_same(p, "skull and pair");
}

TEST(Reduction, APairWhoseNodeIsHeldHoldsItsPartner) {
  Problem p(9);
  for (int axis = 0; axis < 3; ++axis) p.row(3, Vec3::Unit(axis));  // all of the node
  p.row(5, Vec3::UnitZ());                                          // only along the pair
  p.row(3, p.direction(), 6);
  p.row(5, Vec3::UnitZ(), 0);
  expect_same(p, "held node");
}

TEST(Reduction, APairNearlyAlongAHeldDirectionKeepsItsDigits) {
  Problem p(10);
  p.row(3, Vec3::UnitZ());
  p.row(3, Vec3(1e-5, 0, 1).normalized(), 6);
  expect_same(p, "nearly held");
}

TEST(Reduction, APairWhosePartnerIsHeldAgrees) {
  Problem p(11);
  for (int axis = 0; axis < 3; ++axis) p.row(6, Vec3::Unit(axis));
  p.row(3, p.direction(), 6);
  expect_same(p, "held partner");
}

TEST(Reduction, RedundantRowsGetNoMultiplierAndChangeNothing) {
  Problem once(12), twice(12);
  const Vec3 n(0.6, 0.8, 0.0);
  for (Problem* p : {&once, &twice}) {
    p->rows = {{2, -1, n, 0.3, 0}, {4, -1, Vec3::UnitX(), 0.1, 1}};
  }
  twice.rows.push_back({2, -1, n, 0.3, 2});
  const Solution a = by_reduction(once), b = by_reduction(twice);
  EXPECT_EQ((a.dx - b.dx).norm(), 0.0);
  EXPECT_EQ(b.multipliers[2], 0.0);
  EXPECT_EQ(a.multipliers[0], b.multipliers[0]);
}

TEST(Reduction, AFourthRowOfANodeIsLeftOut) {
  Problem p(13);
  for (int axis = 0; axis < 3; ++axis) p.row(4, Vec3::Unit(axis));
  const Solution three = by_reduction(p);
  p.row(4, p.direction());
  const Solution four = by_reduction(p);
  EXPECT_EQ((three.dx - four.dx).norm(), 0.0);
  EXPECT_EQ(four.multipliers[3], 0.0);
}

TEST(Reduction, AMatrixSingularWithoutItsRowsIsDefiniteOnThem) {
  Problem p(14, false);  // rank 3 n - 4
  for (int axis = 0; axis < 3; ++axis) p.row(0, Vec3::Unit(axis));
  p.row(1, p.direction());
  p.row(2, p.direction(), 5);
  const Solution a = by_reduction(p), b = by_kkt(p);
  EXPECT_LT((a.dx - b.dx).norm(), 1e-8 * b.dx.norm());
}

TEST(Reduction, ProjectLeavesWhatTheRowsDoNotCarry) {
  Problem p(15);
  p.row(3, p.direction());
  p.row(1, p.direction());
  p.row(1, p.direction(), 0);
  const Reduction reduction(blocks, p.rows);
  // A force made of the rows' gradients alone is carried whole.
  const Eigen::VectorXd carried = p.gradients().transpose() * Eigen::Vector3d(1.3, -0.4, 0.7);
  EXPECT_LT(reduction.project(carried).norm(), 1e-14);
  EXPECT_GT(reduction.project(carried + Eigen::VectorXd::Unit(3 * blocks, 20)).norm(), 0.9);
  // and at the solution nothing is left
  const Solution s = by_reduction(p);
  Eigen::VectorXd product;
  p.K.multiply(s.dx, product);
  EXPECT_LT(reduction.project(p.force - product).norm(), 1e-12 * p.force.norm());
}

TEST(Reduction, AxesFollowAFormerReductionSoThatItsFactorServesAgain) {
  // Normals at the ties where any rule for a second axis must jump; turned by a hair.
  for (const Vec3& n : {Vec3(Vec3::UnitZ()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitX()),
                        Vec3(Vec3::Ones().normalized()), Vec3(Vec3(1, 1, 0).normalized())}) {
    for (int axis = 0; axis < 6; ++axis) {
      Problem p(16);
      p.row(3, n);
      const Reduction before(blocks, p.rows);
      p.rows[0].normal = (n + (axis < 3 ? 1e-12 : -1e-12) * Vec3::Unit(axis % 3)).normalized();
      const Reduction after(blocks, p.rows, &before);
      BlockMatrix A(complete_graph()), B(complete_graph());
      before.reduce(p.K, 1.0, A);
      after.reduce(p.K, 1.0, B);
      double largest = 0.0;
      for (std::size_t i = 0; i < A.values().size(); ++i) {
        largest = std::max(largest, std::abs(A.values()[i] - B.values()[i]));
      }
      EXPECT_LT(largest, 1e-9);
    }
  }
}

// Forces in sparse columns are restricted like any others, those on both sides of a pair among them.
TEST(Reduction, RestrictsColumnsAsItRestrictsForces) {
  Problem p(11);
  p.row(0, p.direction());
  p.row(1, p.direction());
  p.row(1, p.direction());
  p.row(2, p.direction(), 3);
  const Reduction reduction(blocks, p.rows);
  const Eigen::MatrixXd forces = Eigen::MatrixXd::Random(3 * blocks, 4);
  const Eigen::MatrixXd found = reduction.restrict_columns(SparseColumns(forces.sparseView()));
  for (Eigen::Index c = 0; c < forces.cols(); ++c) {
    const Eigen::VectorXd exact = reduction.restrict_force(forces.col(c));
    EXPECT_LT((found.col(c) - exact).norm(), 1e-14 * exact.norm());
  }
}

}  // namespace
}  // namespace brainshift
