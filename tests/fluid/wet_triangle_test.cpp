// Moments over the wet part of a triangle: exact, and continuous in the head.
#include "fluid/wet_triangle.hpp"

#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace brainshift {
namespace {

// Sums over n^2 small triangles of the parent triangle (area 1/2), each dry or wet by its middle.
WetMoments by_subdivision(const Vec3& heights, double head, int n) {
  WetMoments m;
  const double area = 0.5 / (n * n);
  const auto add = [&](double a, double b) {
    const Vec3 N(1.0 - a - b, a, b);
    if (N.dot(heights) >= head) return;
    m.L += area * N;
    m.M += area * N * N.transpose();
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      add((i + 1.0 / 3.0) / n, (j + 1.0 / 3.0) / n);
      if (i + j + 1 < n) add((i + 2.0 / 3.0) / n, (j + 2.0 / 3.0) / n);
    }
  }
  return m;
}

TEST(WetTriangle, MomentsOfTheWholeTriangleAreTheTextbookOnes) {
  const WetMoments m = wet_moments({0, 1, 2}, 3.0, true);
  EXPECT_TRUE(m.L.isApproxToConstant(1.0 / 6.0, 1e-15));
  EXPECT_TRUE(m.M.isApprox((Mat3::Ones() + Mat3::Identity()) / 24.0, 1e-15));
}

TEST(WetTriangle, MomentsAgreeWithSubdivision) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> height(-1.0, 1.0);
  for (int i = 0; i < 20; ++i) {
    const Vec3 z(height(random), height(random), height(random));
    const double head = height(random);
    const WetMoments exact = wet_moments(z, head, true), sums = by_subdivision(z, head, 1000);
    // The cut cells, a strip of width 1/1000, are taken whole or not at all: ~1e-3 * area / sqrt(n)
    EXPECT_LT((exact.L - sums.L).cwiseAbs().maxCoeff(), 2e-5);
    EXPECT_LT((exact.M - sums.M).cwiseAbs().maxCoeff(), 2e-5);
  }
}

TEST(WetTriangle, MomentsOfAHalfWetTriangleAreExact) {
  // Heights (0, 1, 1), head 1/2: the wet part is the corner triangle of half the size at corner 0,
  // with corners e0, (e0+e1)/2, (e0+e2)/2 and area 1/8. L = area/3 * sum of corners.
  const WetMoments m = wet_moments({0, 1, 1}, 0.5, true);
  EXPECT_LT((m.L - Vec3(2.0, 0.5, 0.5) / 24.0).norm(), 1e-16);
  // M = area/12 (sum of squares + square of the sum): M_00 = (1 + 1/4 + 1/4 + 4)/96
  EXPECT_NEAR(m.M(0, 0), 5.5 / 96.0, 1e-16);
  EXPECT_NEAR(m.M(0, 1), (0.25 + 1.0) / 96.0, 1e-16);
  EXPECT_NEAR(m.M(1, 2), 0.25 / 96.0, 1e-16);
}

TEST(WetTriangle, TheThreeCornersCountAlike) {
  const Vec3 z(0.3, -0.2, 0.9);
  const WetMoments m = wet_moments(z, 0.4, true);
  const WetMoments turned = wet_moments({z[1], z[2], z[0]}, 0.4, true);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(turned.L[i], m.L[(i + 1) % 3], 1e-16);
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(turned.M(i, j), m.M((i + 1) % 3, (j + 1) % 3), 1e-16);
  }
}

TEST(WetTriangle, MomentsAreContinuousOverAThousandHeads) {
  const Vec3 z(0.0, 0.31, 1.0);
  const double step = 1.2 / 1000.0;
  WetMoments last = wet_moments(z, -0.1, true);
  for (int i = 1; i <= 1000; ++i) {
    const WetMoments m = wet_moments(z, -0.1 + i * step, true);
    // The widest section of the parent triangle along the height is below 1: dL/dhead <= 1.
    EXPECT_LE((m.L - last.L).cwiseAbs().maxCoeff(), step) << i;
    EXPECT_LE((m.M - last.M).cwiseAbs().maxCoeff(), step) << i;
    EXPECT_GE((m.L - last.L).minCoeff(), -1e-15) << i;
    last = m;
  }
}

TEST(WetTriangle, MomentsAreContinuousWhereTheWaterlineMeetsACorner) {
  const Vec3 z(0.0, 0.31, 1.0);
  for (double corner : {0.0, 0.31, 1.0}) {
    const WetMoments below = wet_moments(z, corner - 1e-12, true);
    const WetMoments at = wet_moments(z, corner, true);
    const WetMoments above = wet_moments(z, corner + 1e-12, true);
    EXPECT_LT((below.L - at.L).norm(), 1e-11);
    EXPECT_LT((above.L - at.L).norm(), 1e-11);
    EXPECT_LT((below.M - above.M).norm(), 1e-11);
  }
}

TEST(WetTriangle, ALevelTriangleIsWetOrDryAsAWhole) {
  EXPECT_TRUE(wet_moments({1, 1, 1}, 0.999, true).dry());
  EXPECT_NEAR(wet_moments({1, 1, 1}, 1.001, true).L.sum(), 0.5, 1e-15);
  // At the head itself the pressure is zero, so both are right.
  EXPECT_EQ(wet_moments({1, 1, 1}, 1.0, true).depth({1, 1, 1}, 1.0).norm(), 0.0);
}

TEST(WetTriangle, WithoutClippingADryTriangleIsUnderSuction) {
  const Vec3 z(1, 2, 3);
  const WetMoments m = wet_moments(z, 0.0, false);
  EXPECT_NEAR(m.depth(z, 0.0).sum(), -0.5 * 2.0, 1e-15);  // area * mean depth
}

TEST(WetTriangle, AreaDerivativeMatchesDifferences) {
  const Vec3 x[3] = {{0.1, 0.2, 0.3}, {1.1, -0.2, 0.5}, {0.4, 0.9, -0.7}};
  const auto area = [](const Vec3& a, const Vec3& b, const Vec3& c) -> Vec3 {
    return (b - a).cross(c - a);
  };
  for (int k = 0; k < 3; ++k) {
    const Mat3 D = area_derivative(x[0], x[1], x[2], k);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 plus[3] = {x[0], x[1], x[2]}, minus[3] = {x[0], x[1], x[2]};
      plus[k][axis] += 0.5;
      minus[k][axis] -= 0.5;
      // The area vector is affine in each corner: differences are exact.
      const Vec3 slope = area(plus[0], plus[1], plus[2]) - area(minus[0], minus[1], minus[2]);
      EXPECT_LT((D.col(axis) - slope).norm(), 1e-15);
    }
  }
}

}  // namespace
}  // namespace brainshift
