// Closed and manifold surfaces: what is accepted, and who is named when not.
#include <gtest/gtest.h>

#include "mesh/surface_topology.hpp"
#include "support/expect_error.hpp"
#include "support/shapes.hpp"

namespace brainshift {
namespace {

using test::expect_error;
using test::make_box_surface;
using test::make_icosphere;
using test::make_sheet;

Triangles without_row(const Triangles& triangles, Eigen::Index row) {
  Triangles rest(triangles.rows() - 1, 3);
  rest << triangles.topRows(row), triangles.bottomRows(triangles.rows() - row - 1);
  return rest;
}

// Two unit cubes with outward surfaces; those points of the second that `shared` lists become
// points of the first.
test::SurfaceShape two_cubes(const std::vector<std::pair<Index, Index>>& shared) {
  test::SurfaceShape pair = make_box_surface({1, 1, 1});
  const auto other = pair;
  pair.points.conservativeResize(16, 3);
  pair.points.bottomRows(8) = other.points.rowwise() + Eigen::RowVector3d(1, 1, 1);
  pair.triangles.conservativeResize(24, 3);
  pair.triangles.bottomRows(12) = other.triangles.array() + 8;
  for (const auto& [first, second] : shared)
    pair.triangles = (pair.triangles.array() == second + 8).select(first, pair.triangles);
  return pair;
}

TEST(RequireClosed, AcceptsAndMeasuresClosedSurfaces) {
  const auto box = make_box_surface({1, 2, 3});
  EXPECT_NO_THROW(require_closed(box.points, box.triangles, "box"));
  EXPECT_NO_THROW(require_manifold(8, box.triangles, "box"));
  EXPECT_NEAR(enclosed_volume(box.points, box.triangles), 6.0, 1e-14);  // rounding
}

TEST(RequireClosed, EnclosedVolumeDoesNotSufferFromADistantOrigin) {
  auto sphere = make_icosphere(1.0, 2);
  const double volume = enclosed_volume(sphere.points, sphere.triangles);
  sphere.points.rowwise() += Eigen::RowVector3d(1e6, 0, 0);
  // The points themselves are rounded to 1e-10 there; their triangles add up to 13 mm^2.
  EXPECT_NEAR(enclosed_volume(sphere.points, sphere.triangles), volume, 2e-9);
}

TEST(RequireClosed, NamesAFreeEdge) {
  const auto box = make_box_surface({1, 1, 1});
  const Triangles open = without_row(box.triangles, 0);  // 0 2 3
  expect_error(ErrorCode::surface_not_closed, {"the skull is not closed: edge 0-2", "triangle 8"},
               [&] { require_closed(box.points, open, "the skull"); });
}

TEST(RequireClosed, RefusesATriangleTurnedTheWrongWay) {
  auto box = make_box_surface({1, 1, 1});
  std::swap(box.triangles(0, 1), box.triangles(0, 2));
  expect_error(ErrorCode::surface_not_closed, {"edge 0-2", "do not turn alike"},
               [&] { require_closed(box.points, box.triangles, "the skull"); });
}

TEST(RequireClosed, AcceptsBodiesThatTouchInAnEdge) {
  const auto pair = two_cubes({{6, 0}, {7, 1}});
  EXPECT_NO_THROW(require_closed(pair.points, pair.triangles, "pair"));
  expect_error(ErrorCode::invalid_argument, {"4 triangles of pair meet in edge 6-7"},
               [&] { require_manifold(16, pair.triangles, "pair"); });
}

TEST(RequireManifold, NamesAPointWhereBodiesTouch) {
  const auto pair = two_cubes({{7, 0}});
  EXPECT_NO_THROW(require_closed(pair.points, pair.triangles, "pair"));
  expect_error(ErrorCode::invalid_argument, {"touch in point 7 only"},
               [&] { require_manifold(16, pair.triangles, "pair"); });
}

TEST(RequireManifold, AcceptsSheetsAndRefusesOnesThatDoNotTurnAlike) {
  auto sheet = make_sheet(2, 2, 2, 2);
  EXPECT_NO_THROW(require_manifold(9, sheet.triangles, "sheet"));
  std::swap(sheet.triangles(1, 0), sheet.triangles(1, 1));
  expect_error(ErrorCode::invalid_argument, {"triangles 0 and 1 of sheet do not turn alike"},
               [&] { require_manifold(9, sheet.triangles, "sheet"); });
}

TEST(RequireTriangles, NamesEveryKindOfCulprit) {
  const auto sheet = make_sheet(2, 2, 2, 2);
  const auto check = [](const Points& points, const Triangles& triangles) {
    require_triangles(points, triangles, "sheet");
  };
  expect_error(ErrorCode::empty, {"sheet has no points"},
               [&] { check(Points(0, 3), sheet.triangles); });
  expect_error(ErrorCode::empty, {"sheet has no triangles"},
               [&] { check(sheet.points, Triangles(0, 3)); });
  auto bad = sheet;
  bad.points(3, 0) = std::numeric_limits<double>::quiet_NaN();
  expect_error(ErrorCode::not_finite, {"row 3 of points of sheet"},
               [&] { check(bad.points, bad.triangles); });
  bad = sheet;
  bad.triangles(5, 2) = 9;
  expect_error(ErrorCode::index_out_of_range, {"triangle 5 of sheet refers to point 9 of 9"},
               [&] { check(bad.points, bad.triangles); });
  bad.triangles(5, 2) = bad.triangles(5, 1);
  expect_error(ErrorCode::degenerate_element, {"triangle 5 of sheet has no area"},
               [&] { check(bad.points, bad.triangles); });
}

TEST(Neighbours, AreAcrossTheSharedEdge) {
  const auto sheet = make_sheet(1, 1, 1, 1);  // 0 1 3 and 0 3 2
  Triangles expected(2, 3);
  expected << -1, -1, 1, 0, -1, -1;
  EXPECT_EQ(neighbours(4, sheet.triangles), expected);
}

TEST(Components, OfTrianglesCountTouchingBodiesOnce) {
  const auto apart = two_cubes({}), touching = two_cubes({{7, 0}});
  EXPECT_EQ(components(16, apart.triangles).count, 2);
  EXPECT_EQ(components(16, touching.triangles).count, 2);  // point 8 is left alone
  EXPECT_EQ(components(16, touching.triangles).of_node[15], 0);
}

}  // namespace
}  // namespace brainshift
