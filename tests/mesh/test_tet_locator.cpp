// Location of points in rest and deformed meshes.
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "brainshift/mesh.hpp"
#include "support/expect_error.hpp"
#include "support/shapes.hpp"

namespace brainshift {
namespace {

using test::expect_error;
using test::make_ball;
using test::make_box;

Points random_points(Eigen::Index count, double low, double high, unsigned seed = 1) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> number(low, high);
  Points points(count, 3);
  for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = number(generator);
  return points;
}

Vec3 interpolate(const Points& positions, const Tets& tets, const Location& at, Eigen::Index i) {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < 4; ++k)
    sum += at.weights(i, k) * positions.row(tets(at.tet[std::size_t(i)], k)).transpose();
  return sum;
}

// The lowest tet that holds the point, by trying all.
Index lowest_tet(const Points& nodes, const Tets& tets, const Vec3& point) {
  for (Eigen::Index i = 0; i < tets.rows(); ++i) {
    Eigen::Matrix4d system;
    for (int k = 0; k < 4; ++k) system.col(k) << nodes.row(tets(i, k)).transpose(), 1.0;
    const Eigen::Vector4d weights =
        system.fullPivLu().solve((Eigen::Vector4d() << point, 1.0).finished());
    if (weights.minCoeff() >= -1e-12) return Index(i);
  }
  return -1;
}

TEST(Locate, RandomPointsAreWhereAnExhaustiveSearchFindsThem) {
  const auto [nodes, tets] = make_ball(1.0, 6);
  const Mesh mesh(nodes, tets);
  const Points points = random_points(500, -1.0, 1.0);
  const Location at = mesh.locate(points);
  Index inside = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    EXPECT_EQ(at.tet[std::size_t(i)], lowest_tet(nodes, tets, points.row(i).transpose()));
    if (at.tet[std::size_t(i)] < 0) {
      EXPECT_TRUE(at.weights.row(i).isZero(0.0));
      continue;
    }
    ++inside;
    EXPECT_NEAR(at.weights.row(i).sum(), 1.0, 1e-15 * 4);  // four roundings
    const Vec3 back = interpolate(nodes, tets, at, i);
    EXPECT_LT((back - points.row(i).transpose()).norm(), 1e-13);  // rounding, thin tets included
  }
  EXPECT_GT(inside, 200);  // pi/6 of them, less what the flat faces cut off
}

TEST(Locate, NodesBelongToTheLowestTetThatUsesThem) {
  const auto [nodes, tets] = make_box({1, 1, 1}, 4, 4, 4);
  const Location at = Mesh(nodes, tets).locate(nodes);
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
    Eigen::Index lowest = 0;
    while ((tets.row(lowest).array() != Index(i)).all()) ++lowest;
    EXPECT_EQ(at.tet[std::size_t(i)], lowest);
    EXPECT_NEAR(at.weights.row(i).maxCoeff(), 1.0, 1e-12);  // the locator's own rounding
  }
}

TEST(Locate, PointsOnSharedFacesBelongToTheLowerTet) {
  const auto [nodes, tets] = make_ball(100.0, 4);
  const Mesh mesh(nodes, tets);
  Points centres(4 * tets.rows(), 3);
  for (Eigen::Index i = 0; i < tets.rows(); ++i)
    for (int k = 0; k < 4; ++k)
      centres.row(4 * i + k) = (nodes.row(tets(i, (k + 1) % 4)) + nodes.row(tets(i, (k + 2) % 4)) +
                                nodes.row(tets(i, (k + 3) % 4))) /
                               3.0;
  const Location at = mesh.locate(centres);
  for (Eigen::Index i = 0; i < centres.rows(); ++i)
    EXPECT_EQ(at.tet[std::size_t(i)], lowest_tet(nodes, tets, centres.row(i).transpose()));
}

TEST(Locate, ToleranceIsADistanceToTheMesh) {
  const auto [nodes, tets] = make_box({1, 1, 1}, 2, 2, 2);
  const Mesh mesh(nodes, tets);
  Points points(4, 3);
  points << 0.4, 0.3, 1.09, 0.4, 0.3, 1.11,  // off a side
      1.07, 1.07, 0.5, 1.08, 1.08, 0.5;      // off an edge: sqrt(2) times as far
  EXPECT_EQ(mesh.locate(points).tet, Indices(4, -1));
  const Location at = mesh.locate(points, 0.1);
  EXPECT_GE(at.tet[0], 0);
  EXPECT_EQ(at.tet[1], -1);
  EXPECT_GE(at.tet[2], 0);
  EXPECT_EQ(at.tet[3], -1);
  EXPECT_TRUE(interpolate(nodes, tets, at, 0).isApprox(Vec3(0.4, 0.3, 1.0), 1e-14));
  EXPECT_TRUE(interpolate(nodes, tets, at, 2).isApprox(Vec3(1.0, 1.0, 0.5), 1e-14));
}

TEST(Locate, AToleranceDoesNotChangeThePlaceOfPointsInside) {
  const auto [nodes, tets] = make_ball(1.0, 4);
  const Mesh mesh(nodes, tets);
  const Points points = random_points(300, -0.5, 0.5);
  const Location sharp = mesh.locate(points, 0.0), loose = mesh.locate(points, 0.5);
  EXPECT_EQ(sharp.tet, loose.tet);
  EXPECT_EQ(sharp.weights, loose.weights);
}

TEST(Locate, FollowsADeformedMesh) {
  const auto [nodes, tets] = make_ball(1.0, 6);
  const Mesh mesh(nodes, tets);
  Points moved = nodes;
  for (Eigen::Index i = 0; i < nodes.rows(); ++i)
    moved.row(i) << 10.0 + nodes(i, 0) + 0.3 * nodes(i, 1) * nodes(i, 1), 2.0 * nodes(i, 1),
        nodes(i, 2) - 0.2 * nodes(i, 0);
  const Points points = random_points(300, -0.5, 0.5);
  const Location rest = mesh.locate(points);
  Points images(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    images.row(i) = interpolate(moved, tets, rest, i);
  const Location deformed = mesh.locate_deformed(images, moved);
  EXPECT_EQ(deformed.tet, rest.tet);
  EXPECT_LT((deformed.weights - rest.weights).cwiseAbs().maxCoeff(), 1e-12);  // rounding at x = 10
}

TEST(Locate, WorksInAMeshTurnedInsideOut) {
  const auto [nodes, tets] = make_ball(1.0, 4);
  const Mesh mesh(nodes, tets);
  const Points points = random_points(100, -0.5, 0.5);
  const Location mirrored = mesh.locate_deformed(-points, -nodes);
  EXPECT_EQ(mirrored.tet, mesh.locate(points).tet);
}

TEST(Locate, RefusesBadInput) {
  const auto [nodes, tets] = make_box({1, 1, 1}, 1, 1, 1);
  const Mesh mesh(nodes, tets);
  Points points = Points::Zero(2, 3);
  expect_error(ErrorCode::invalid_argument, {"tolerance is -1"},
               [&] { mesh.locate(points, -1.0); });
  expect_error(ErrorCode::size_mismatch, {"2 positions for 8 nodes"},
               [&] { mesh.locate_deformed(points, points); });
  points(1, 2) = std::numeric_limits<double>::quiet_NaN();
  expect_error(ErrorCode::not_finite, {"row 1 of points"}, [&] { mesh.locate(points); });
  EXPECT_TRUE(mesh.locate(Points(0, 3)).tet.empty());
}

}  // namespace
}  // namespace brainshift
