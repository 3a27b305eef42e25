// A factor of one active set serves another: its steps beside a dense solve of the whole system
//   [K + U V^T, -G^T; G, 0] [dx; m] = [f; v].
#include "stepper/linearised_tissue.hpp"

#include <algorithm>
#include <memory>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>

namespace brainshift {
namespace {

constexpr Index blocks = 150;
constexpr std::size_t untagged = 8;   // of the rows that never change

const Indices all_blocks = [] {
  Indices all(blocks);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = Index(i);
  return all;
}();

class Problem {
 public:
  Problem() : K(complete_graph()) {
    const Eigen::MatrixXd half = random(3 * blocks, 4 * blocks);
    dense = half * half.transpose() / double(blocks);
    for (Index i = 0; i < blocks; ++i) {
      for (Index j = 0; j <= i; ++j) K.add_at(i, j, dense.block<3, 3>(3 * i, 3 * j));
    }
    columns = 0.2 * random(3 * blocks, 2);
    terms = 0.2 * random(3 * blocks, 2);
    force = random(3 * blocks, 1);
    std::vector<Eigen::Triplet<double>> entries;
    for (int c = 0; c < 4; ++c) {
      for (int i = 0; i < 5; ++i) entries.emplace_back(7 * c + 31 * i, c, number(m_random));
    }
    path.resize(3 * blocks, 4);
    path.setFromTriplets(entries.begin(), entries.end());
    // Two rows of one block that a fixed row shares, rows of two more, and pairs: one with a block that
    // holds a row, one whose partner does.
    add(3, -1, untagged);
    add(20, -1, untagged);
    add(3, -1, 0);
    add(3, -1, 1);
    add(5, -1, 2);
    add(7, -1, 3);
    add(9, -1, 4);
    add(10, 11, 5);
    add(12, 5, 6);
    add(7, 14, 7);
  }

  std::vector<NodeRow> rows_of(const std::vector<int>& set) const {
    std::vector<NodeRow> chosen;
    for (const NodeRow& row : m_rows) {
      if (row.tag == untagged || std::count(set.begin(), set.end(), int(row.tag))) chosen.push_back(row);
    }
    return chosen;
  }

  Eigen::VectorXd exact(const std::vector<NodeRow>& rows, const Eigen::VectorXd& f) const {
    const auto n = dense.rows(), m = Eigen::Index(rows.size());
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n + m, n + m);
    Eigen::VectorXd right(n + m);
    all.topLeftCorner(n, n) = dense + columns * terms.transpose();
    right.head(n) = f;
    for (Eigen::Index r = 0; r < m; ++r) {
      const NodeRow& row = rows[std::size_t(r)];
      all.block<1, 3>(n + r, 3 * row.block) += row.normal.transpose();
      if (row.partner >= 0) all.block<1, 3>(n + r, 3 * row.partner) -= row.normal.transpose();
      right[n + r] = row.value;
    }
    all.topRightCorner(n, m) = -all.bottomLeftCorner(m, n).transpose();
    return all.partialPivLu().solve(right).head(n);
  }

  BlockMatrix K;
  Eigen::MatrixXd dense, columns, terms;
  Eigen::VectorXd force;
  SparseColumns path;

 private:
  static std::vector<Indices> complete_graph() {
    std::vector<Indices> near(blocks);
    for (Index i = 0; i < blocks; ++i) {
      for (Index j = 0; j < blocks; ++j) {
        if (i != j) near[std::size_t(i)].push_back(j);
      }
    }
    return near;
  }
  Eigen::MatrixXd random(Eigen::Index rows, Eigen::Index cols) {
    return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return number(m_random); });
  }
  void add(Index block, Index partner, std::size_t tag) {
    const Vec3 normal(number(m_random), number(m_random), number(m_random));
    m_rows.push_back({block, partner, normal.normalized(), 0.3 * number(m_random), tag});
  }

  std::mt19937 m_random{3};
  std::normal_distribution<double> number;
  std::vector<NodeRow> m_rows;
};

class Served {
 public:
  Served(const Problem& p, const std::vector<int>& factored)
      : m_p(p), m_solver(make_spd_solver()), m_base(blocks, p.rows_of(factored)), tissue(p.K, *m_solver, p.path) {
    BlockMatrix A = p.K;
    tissue.set_terms(p.columns, p.terms);
    m_base.reduce(p.K, p.K.mean_diagonal(), A);
    m_solver->analyse(A);
    EXPECT_TRUE(m_solver->factorise(A));
    tissue.take_factor(m_base);
    const std::vector<double> no_multipliers(untagged + 1, 0.0);
    tissue.begin(p.rows_of(factored), p.rows_of(factored), no_multipliers, p.force);
  }

  void expect_exact(const std::vector<int>& set) {
    const std::vector<NodeRow> rows = m_p.rows_of(set);
    ASSERT_TRUE(tissue.serve(Reduction(blocks, rows), rows, untagged));
    const Eigen::VectorXd alone = tissue.step({}), expected = m_p.exact(rows, m_p.force);
    EXPECT_LE((alone - expected).norm(), 1e-11 * expected.norm());
    EXPECT_LE((tissue.free_motion() - m_p.path.transpose() * expected).norm(), 1e-11 * expected.norm());
    const Eigen::Vector4d along(1.0, -2.0, 0.5, 3.0);
    const Eigen::VectorXd pushed = m_p.exact(rows, m_p.force + m_p.path * along);
    EXPECT_LE((tissue.step(along) - pushed).norm(), 1e-11 * pushed.norm());
    const Eigen::VectorXd motion = tissue.free_motion() + tissue.compliance() * along;
    EXPECT_LE((motion - m_p.path.transpose() * pushed).norm(), 1e-11 * pushed.norm());
    const Eigen::VectorXd product = (m_p.dense + m_p.columns * m_p.terms.transpose()) * pushed;
    EXPECT_LE((tissue.times(pushed, all_blocks) - product).norm(), 1e-12 * product.norm());
  }

 private:
  const Problem& m_p;
  std::unique_ptr<SpdSolver> m_solver;
  Reduction m_base;

 public:
  LinearisedTissue tissue;
};

TEST(LinearisedTissue, ServesItsOwnSet) {
  const Problem p;
  Served served(p, {0, 1, 2, 5});
  served.expect_exact({0, 1, 2, 5});
}

TEST(LinearisedTissue, ServesOtherSetsInAnyOrder) {
  const Problem p;
  const std::vector<std::vector<int>> sets{{},     {0},    {0, 1},       {2, 5},                  {5, 6},
                                           {2, 6}, {3, 7}, {1, 3, 4, 7}, {0, 1, 2, 3, 4, 5, 6, 7}};
  for (const std::vector<int>& factored : sets) {
    Served served(p, factored);
    for (const std::vector<int>& set : sets) {
      SCOPED_TRACE(testing::PrintToString(factored) + " for " + testing::PrintToString(set));
      served.expect_exact(set);
    }
  }
}

using Sets = std::pair<std::vector<int>, std::vector<int>>;   // of the factor, to be served
class LinearisedTissueKept : public testing::TestWithParam<Sets> {};

// The rows turn while factor and columns are kept, as in a solve: what the steps end at obeys the rows of
// today and is balanced by them, whatever the columns were made of.
TEST_P(LinearisedTissueKept, EndsAtTheBalanceOfRowsThatHaveTurned) {
  const Problem p;
  const auto& [factored, set] = GetParam();
  Served served(p, factored);
  ASSERT_TRUE(served.tissue.serve(Reduction(blocks, p.rows_of(set)), p.rows_of(set), untagged));
  const auto turned = [&p](const std::vector<int>& of) {
    std::vector<NodeRow> rows = p.rows_of(of);
    for (NodeRow& row : rows) {
      if (row.tag != untagged) row.normal = (row.normal + 0.02 * Vec3(1.0, -1.0, 0.5)).normalized();
    }
    return rows;
  };
  const Eigen::Vector4d along(1.0, -2.0, 0.5, 3.0);
  const Eigen::VectorXd expected = p.exact(turned(set), p.force + p.path * along);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(3 * blocks);
  std::vector<double> multipliers(untagged + 1, 0.0);
  for (int i = 0; i < 30; ++i) {
    std::vector<NodeRow> rows = turned(set), base = turned(factored);
    for (auto* some : {&rows, &base}) {
      for (NodeRow& row : *some) {
        Vec3 motion = x.segment<3>(3 * row.block);
        if (row.partner >= 0) motion -= x.segment<3>(3 * row.partner);
        row.value -= row.normal.dot(motion);
      }
    }
    const Eigen::VectorXd load = p.force - served.tissue.times(x, all_blocks);
    served.tissue.begin(base, rows, multipliers, load);
    const Reduction wanted(blocks, rows);
    ASSERT_TRUE(served.tissue.serve(wanted, rows, untagged));
    x += served.tissue.step(along);
    wanted.multipliers(p.force + p.path * along - served.tissue.times(x, wanted.held_blocks()), multipliers);
  }
  EXPECT_LE((x - expected).norm(), 1e-12 * expected.norm());
}

INSTANTIATE_TEST_SUITE_P(, LinearisedTissueKept,
                         testing::Values(Sets{{0, 2, 5}, {0, 2, 5}}, Sets{{0, 2, 5}, {0, 1, 3, 5}},
                                         Sets{{2}, {2, 4}}, Sets{{2, 4}, {4, 5}}, Sets{{5}, {4}},
                                         Sets{{0, 1}, {0}}, Sets{{0}, {0, 1}}, Sets{{5, 6}, {2, 6}},
                                         Sets{{0, 1}, {1, 4, 7}}));

TEST(LinearisedTissue, LeavesToANewFactorWhatIsNotPositive) {
  Problem p;
  // Held by row 2 alone: without it the direction gives way.
  const std::vector<NodeRow> held = p.rows_of({2});
  const Vec3 n = held.back().normal;
  p.K.add_at(5, 5, -30.0 * n * n.transpose());
  Served served(p, {2});
  const std::vector<NodeRow> rows = p.rows_of({});
  EXPECT_FALSE(served.tissue.serve(Reduction(blocks, rows), rows, untagged));
}

}  // namespace
}  // namespace brainshift
