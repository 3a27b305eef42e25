// Exact signed distance to triangulated surfaces.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "contact/distance.hpp"
#include "mesh/closest_point.hpp"
#include "support/shapes.hpp"

namespace brainshift {
namespace {

using test::make_box_surface;
using test::make_icosphere;
using test::make_sheet;

// Distances of order 1 to 100 mm from a handful of operations.
constexpr double rounding = 1e-12;

Vec3 random_point(std::mt19937& generator, double low, double high) {
  std::uniform_real_distribution<double> number(low, high);
  const double x = number(generator), y = number(generator), z = number(generator);
  return {x, y, z};
}

// Positive inside the box [0, size].
double box_distance(const Vec3& size, const Vec3& p) {
  const Vec3 beyond = (-p).cwiseMax(p - size);
  return beyond.maxCoeff() <= 0.0 ? -beyond.maxCoeff() : -beyond.cwiseMax(0.0).norm();
}

TEST(ClosestPoint, IsNoFartherThanAnyPointOfTheTriangleInAllSevenRegions) {
  std::mt19937 generator(1);
  int seen[7] = {};
  for (int n = 0; n < 500; ++n) {
    const Vec3 a(0, 0, 0), b(2, 0, 0.5), c(0.5, 1.5, 0), p = random_point(generator, -2, 3);
    const TrianglePoint near = closest_point(a, b, c, p);
    ++seen[int(near.feature)];
    EXPECT_GE(near.weights.minCoeff(), 0.0);
    EXPECT_NEAR(near.weights.sum(), 1.0, rounding);
    const auto distance = [&](double u, double v) {
      return ((1 - u - v) * a + u * b + v * c - p).norm();
    };
    const double found = distance(near.weights[1], near.weights[2]);
    for (int i = 0; i <= 20; ++i)
      for (int j = 0; i + j <= 20; ++j) EXPECT_LE(found, distance(i / 20.0, j / 20.0) + rounding);
  }
  for (const int count : seen) EXPECT_GT(count, 0);
}

TEST(SurfaceDistance, OfABoxIsExactInsideOutsideAndAtEdgesAndCorners) {
  const Vec3 size(10, 20, 30);
  const auto box = make_box_surface(size);
  const SurfaceDistance distance(box.points, box.triangles, SurfaceKind::cavity);
  std::mt19937 generator(2);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p = random_point(generator, -10, 40);
    EXPECT_NEAR(distance(p).distance, box_distance(size, p), rounding) << p.transpose();
  }
}

TEST(SurfaceDistance, SignIsRightAllAroundEdgesAndCornersWhereNormalsOfTrianglesDisagree) {
  const Vec3 size(10, 10, 10);
  const auto box = make_box_surface(size);
  const SurfaceDistance distance(box.points, box.triangles, SurfaceKind::cavity);
  std::mt19937 generator(3);
  for (const Vec3& centre : {Vec3(10, 10, 5), Vec3(10, 10, 10), Vec3(0, 0, 0), Vec3(0, 10, 3)})
    for (int n = 0; n < 500; ++n) {
      const Vec3 p = centre + random_point(generator, -1e-3, 1e-3);
      EXPECT_NEAR(distance(p).distance, box_distance(size, p), rounding) << p.transpose();
    }
}

// A slender tet, one side and the base cut into forty triangles each. At its sharp edges the normal
// of one triangle has the wrong sign for part of the points nearest to them; at its tip and corners
// so has the plain mean of the normals, which forty triangles of one side outvote.
TEST(SurfaceDistance, SignIsRightAtSharpEdgesAndTipsHoweverTheirSidesAreCut) {
  const Vec3 a(0, 0, 0), b(2, 0, 0), c(0, 2, 0), tip(0.3, 0.3, 12);
  const Index pieces = 40;
  Points points(pieces + 3, 3);  // a .. b, c, tip
  for (Index i = 0; i <= pieces; ++i) points.row(i) = a + (b - a) * (double(i) / pieces);
  points.bottomRows<2>() << c.transpose(), tip.transpose();
  const Index at_b = pieces, at_c = pieces + 1, at_tip = pieces + 2;
  Triangles triangles(2 * pieces + 2, 3);
  for (Index i = 0; i < pieces; ++i) {
    triangles.row(2 * i) << i, i + 1, at_tip;
    triangles.row(2 * i + 1) << i + 1, i, at_c;
  }
  triangles.bottomRows<2>() << at_b, at_c, at_tip, at_c, 0, at_tip;
  const SurfaceDistance distance(points, triangles, SurfaceKind::cavity);

  const Vec3 sides[4][3] = {{a, b, tip}, {b, a, c}, {b, c, tip}, {c, a, tip}};
  std::mt19937 generator(4);
  for (const Vec3& centre : {a, b, c, tip, Vec3(1, 1, 0), Vec3(0.15, 0.15, 6), Vec3(1, 0, 3)})
    for (int n = 0; n < 500; ++n) {
      const Vec3 p = centre + random_point(generator, -1, 1);
      bool inside = true;
      for (const auto& side : sides)
        inside &= (side[1] - side[0]).cross(side[2] - side[0]).dot(p - side[0]) < 0.0;
      EXPECT_EQ(distance(p).distance > 0.0, inside) << p.transpose();
    }
}

TEST(SurfaceDistance, OfASphereDiffersByNoMoreThanItsFacetsFromTheRoundOne) {
  const double radius = 50.0;
  const auto sphere = make_icosphere(radius, 4);
  const SurfaceDistance distance(sphere.points, sphere.triangles, SurfaceKind::cavity);
  double sagitta = 0.0;  // how far the middle of a facet lies inside the sphere
  for (Eigen::Index i = 0; i < sphere.triangles.rows(); ++i) {
    Vec3 middle = Vec3::Zero();
    for (int k = 0; k < 3; ++k) middle += sphere.points.row(sphere.triangles(i, k)) / 3.0;
    sagitta = std::max(sagitta, radius - middle.norm());
  }
  std::mt19937 generator(5);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 p = random_point(generator, -60, 60);
    const double error = distance(p).distance - (radius - p.norm());
    EXPECT_LE(error, rounding);
    EXPECT_GE(error, -sagitta - rounding);
  }
}

TEST(SurfaceDistance, EqualsThatOfAnExhaustiveSearchWhateverTheHint) {
  auto sphere = make_icosphere(30.0, 3);
  sphere.points.col(0) *= 2.0;
  const SurfaceDistance distance(sphere.points, sphere.triangles, SurfaceKind::cavity);
  std::mt19937 generator(6);
  Index hint = 0;
  for (int n = 0; n < 200; ++n) {
    const Vec3 p = random_point(generator, -70, 70);
    double best = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < sphere.triangles.rows(); ++i) {
      Vec3 x[3];
      for (int k = 0; k < 3; ++k) x[k] = sphere.points.row(sphere.triangles(i, k));
      const Vec3 w = closest_point(x[0], x[1], x[2], p).weights;
      best = std::min(best, (w[0] * x[0] + w[1] * x[1] + w[2] * x[2] - p).norm());
    }
    const auto hinted = distance(p, hint), plain = distance(p);
    EXPECT_NEAR(hinted.reach, best, rounding);
    EXPECT_EQ(hinted.distance, plain.distance);
    EXPECT_NEAR((hinted.nearest - p).norm(), best, rounding);
    hint = hinted.hint;
  }
}

TEST(SheetDistance, OfAFlatSheetIsTheHeightAboveItsPlaneAlsoBeyondItsBorder) {
  const auto sheet = make_sheet(20, 10, 4, 2);
  const SurfaceDistance distance(sheet.points, sheet.triangles, SurfaceKind::sheet);
  std::mt19937 generator(7);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 p = random_point(generator, -20, 40);
    const auto result = distance(p);
    EXPECT_NEAR(result.distance, p.z(), rounding);
    const Vec3 nearest(std::clamp(p.x(), 0.0, 20.0), std::clamp(p.y(), 0.0, 10.0), 0.0);
    EXPECT_NEAR(result.reach, (p - nearest).norm(), rounding);
  }
}

// A sheet bent to a cylinder of radius 40 over a quarter turn.
test::SurfaceShape bent_sheet() {
  auto sheet = make_sheet(1.0, 30.0, 24, 12);
  for (Eigen::Index i = 0; i < sheet.points.rows(); ++i) {
    const double angle = sheet.points(i, 0) * EIGEN_PI / 2.0;
    sheet.points.row(i) << 40.0 * std::sin(angle), sheet.points(i, 1), 40.0 * std::cos(angle);
  }
  return sheet;
}

TEST(SheetDistance, OfABentSheetIsTheExactDistanceInsideItsBorder) {
  const auto sheet = bent_sheet();
  const SurfaceDistance distance(sheet.points, sheet.triangles, SurfaceKind::sheet);
  std::mt19937 generator(8);
  int counted = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p = random_point(generator, 0, 50);
    const auto result = distance(p);
    const double radius = std::hypot(p.x(), p.z()), angle = std::atan2(p.x(), p.z());
    if (radius < 20.0 || angle < 0.1 || angle > 1.4 || p.y() < 0.0 || p.y() > 30.0) continue;
    ++counted;
    // A chord of a 24th of the quarter turn stays within 40 (1 - cos(pi/96)) of the arc.
    EXPECT_NEAR(result.distance, radius - 40.0, 0.022);
    EXPECT_EQ(std::abs(result.distance), result.reach);
  }
  EXPECT_GT(counted, 400);
}

TEST(SheetDistance, DoesNotJumpOnTheWayAroundAFreeEdge) {
  const auto sheet = bent_sheet();
  const SurfaceDistance distance(sheet.points, sheet.triangles, SurfaceKind::sheet);
  // Circles around points of the border: the straight edge x = 0, the bent one y = 0, a corner.
  const double bent = EIGEN_PI / 4.0 + 0.01;
  const Vec3 centres[] = {{0, 15, 40}, {40 * std::sin(bent), 0, 40 * std::cos(bent)}, {0, 0, 40}};
  const Vec3 outward[] = {{-1, 0, 0}, {0, -1, 0}, Vec3(-1, -1, 0).normalized()};
  for (int c = 0; c < 3; ++c) {
    const Vec3 up(centres[c].x() / 40.0, 0, centres[c].z() / 40.0);
    const double radius = 3.0;
    const int steps = 2000;
    double last = 0.0, lowest = 0.0, highest = 0.0;
    for (int i = 0; i <= steps; ++i) {
      const double angle = (i / double(steps) - 0.5) * EIGEN_PI;  // from below, past, to above
      const Vec3 p = centres[c] + radius * (std::sin(angle) * up + std::cos(angle) * outward[c]);
      const double d = distance(p).distance;
      // The slope of a distance is 1; where normals of neighbours differ by up to pi/48, heights
      // past the border may differ by 1 - cos(pi/48) of the radius.
      const double most = 1.1 * radius * EIGEN_PI / steps + 0.0022 * radius;
      EXPECT_LT(i > 0 ? std::abs(d - last) : 0.0, most) << c;
      last = d;
      lowest = std::min(lowest, d);
      highest = std::max(highest, d);
    }
    EXPECT_NEAR(highest, radius, 0.05 * radius);
    EXPECT_NEAR(lowest, -radius, 0.05 * radius);
  }
}

}  // namespace
}  // namespace brainshift
