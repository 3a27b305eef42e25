// Gaps and gradients of one-sided rows.
#include "contact/contact_rows.hpp"

#include <gtest/gtest.h>

#include "support/scenes.hpp"

namespace brainshift {
namespace {

Points two_nodes() {
  Points p(2, 3);
  p << 1, 2, 3, 1.5, 2, 5;
  return p;
}

Surface plane() {
  const auto sheet = test::moved(test::make_sheet(20, 20, 4, 4), {-10, -10, 1});
  return Surface::sheet(sheet.points, sheet.triangles);
}

TEST(ContactRows, AnObstacleMeasuresTheDistanceLessTheOffsetOnItsSide) {
  for (double side : {1.0, -1.0}) {
    ConstraintSet set;
    set.obstacle("plane", {0, 1}, plane(), side, Eigen::Vector2d(0.25, -0.5));
    const ContactRows rows(set, {0, 1}, two_nodes());
    ASSERT_EQ(rows.size(), 2u);
    Points u = Points::Zero(2, 3);
    u(1, 2) = -1.0;
    // The grid reproduces a plane to round-off of its splines.
    EXPECT_NEAR(rows.sample(0, u).gap, side * 2.0 - 0.25, 1e-6);
    EXPECT_NEAR(rows.sample(1, u).gap, side * 3.0 + 0.5, 1e-6);
    EXPECT_LT((rows.sample(0, u).normal - Vec3(0, 0, side)).norm(), 1e-6);
  }
}

TEST(ContactRows, GradientAndHessianMatchDifferencesOfTheGap) {
  const auto sphere = test::make_icosphere(20.0, 2);
  ConstraintSet set;
  set.obstacle("sphere", {0, 1}, Surface::cavity(sphere.points, sphere.triangles));
  Points rest = two_nodes();
  rest.row(0) << 12, 9, 8;
  rest.row(1) << -3, 16, 5;
  const ContactRows rows(set, {0, 1}, rest);
  const double h = 1e-4;
  for (std::size_t r = 0; r < 2; ++r) {
    const Points u = Points::Zero(2, 3);
    const GapSample s = rows.sample(r, u);
    const Mat3 H = rows.hessian(r, u);
    for (int axis = 0; axis < 3; ++axis) {
      Points plus = u, minus = u;
      plus(Eigen::Index(r), axis) += h;
      minus(Eigen::Index(r), axis) -= h;
      const GapSample a = rows.sample(r, plus), b = rows.sample(r, minus);
      EXPECT_NEAR((a.gap - b.gap) / (2 * h), s.normal[axis], 1e-7);
      // cubic splines: the third derivative jumps, so the difference is good to h times it
      EXPECT_LT(((a.normal - b.normal) / (2 * h) - H.col(axis)).norm(), 1e-5);
    }
  }
}

TEST(ContactRows, APairMeasuresAlongItsNormalAndSeesBothNodes) {
  ConstraintSet set;
  Points normal(1, 3);
  normal << 0, 0, 1;
  set.opposing("pair", {1}, {0}, normal);
  const ContactRows rows(set, {4, 7}, two_nodes());
  EXPECT_EQ(rows.row(0).node, 7);
  EXPECT_EQ(rows.row(0).partner, 4);
  Points u = Points::Zero(2, 3);
  u(0, 2) = 0.5;
  u(1, 2) = -0.25;
  EXPECT_NEAR(rows.sample(0, u).gap, 2.0 - 0.75, 1e-15);
  EXPECT_TRUE(rows.hessian(0, u).isZero(0.0));
}

TEST(ContactRows, DisabledGroupsHaveNoRows) {
  ConstraintSet set;
  const ConstraintId id = set.obstacle("plane", {0}, plane());
  set.fix("held", {1});
  set.disable(id);
  EXPECT_EQ(ContactRows(set, {0, 1}, two_nodes()).size(), 0u);
  set.enable(id);
  EXPECT_EQ(ContactRows(set, {0, 1}, two_nodes()).size(), 1u);
}

}  // namespace
}  // namespace brainshift
