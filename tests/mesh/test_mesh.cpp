// Mesh: every refusal, and the answers about volume, surface, components and quality.
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "brainshift/mesh.hpp"
#include "mesh/surface_topology.hpp"
#include "support/expect_error.hpp"
#include "support/shapes.hpp"

namespace brainshift {
namespace {

using test::expect_error;
using test::make_ball;
using test::make_box;

// Sums of a few hundred products of order one: 1e3 epsilon.
constexpr double rounding = 1e-13;

test::TetShape one_tet() {
  test::TetShape tet;
  tet.points.resize(4, 3);
  tet.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  tet.tets.resize(1, 4);
  tet.tets << 0, 1, 2, 3;
  return tet;
}

TEST(MeshValidation, RefusesAMeshWithoutNodesOrTets) {
  const auto [points, tets] = one_tet();
  expect_error(ErrorCode::empty, {"no nodes"}, [&, &t = tets] { Mesh(Points(0, 3), t); });
  expect_error(ErrorCode::empty, {"no tets"}, [&, &p = points] { Mesh(p, Tets(0, 4)); });
}

TEST(MeshValidation, NamesTheRowThatIsNotFinite) {
  auto [points, tets] = one_tet();
  points(2, 1) = std::numeric_limits<double>::quiet_NaN();
  expect_error(ErrorCode::not_finite, {"row 2 of nodes", "nan"},
               [&p = points, &t = tets] { Mesh(p, t); });
  points(2, 1) = std::numeric_limits<double>::infinity();
  expect_error(ErrorCode::not_finite, {"row 2 of nodes", "inf"},
               [&p = points, &t = tets] { Mesh(p, t); });
}

TEST(MeshValidation, NamesTheTetAndTheNodeThatIsNotThere) {
  auto [points, tets] = one_tet();
  tets(0, 3) = 4;
  expect_error(ErrorCode::index_out_of_range, {"tet 0 refers to node 4 of 4"},
               [&p = points, &t = tets] { Mesh(p, t); });
  tets(0, 3) = -1;
  expect_error(ErrorCode::index_out_of_range, {"tet 0 refers to node -1 of 4"},
               [&p = points, &t = tets] { Mesh(p, t); });
}

TEST(MeshValidation, RefusesRegionsThatDoNotMatchTheTets) {
  const auto shape = one_tet();
  expect_error(ErrorCode::size_mismatch, {"2 regions for 1 tets"}, [&] {
    Mesh(shape.points, shape.tets, {1, 2});
  });
}

TEST(MeshValidation, RefusesTetsWithoutVolume) {
  auto shape = one_tet();
  shape.points.row(3) << 0.5, 0.25, 1e-15;  // below 1e-14 of the longest edge cubed
  expect_error(ErrorCode::degenerate_element, {"tet 0 has no volume (nodes 0 1 2 3)"},
               [&] { Mesh(shape.points, shape.tets); });
  shape.points.row(3) << 0.5, 0.25, 1e-12;  // thin, but not without volume
  EXPECT_NO_THROW(Mesh(shape.points, shape.tets));
  shape.tets(0, 3) = 1;
  expect_error(ErrorCode::degenerate_element, {"tet 0 uses node 1 twice (nodes 0 1 2 1)"},
               [&] { Mesh(shape.points, shape.tets); });
}

TEST(MeshValidation, TheLimitOfNoVolumeDoesNotDependOnTheUnitOfLength) {
  auto shape = one_tet();
  shape.points *= 1e-6;
  EXPECT_NO_THROW(Mesh(shape.points, shape.tets));
}

TEST(MeshValidation, RefusesOrTurnsInvertedTets) {
  auto [points, tets] = make_box({1, 2, 3}, 1, 1, 1);
  std::swap(tets(4, 0), tets(4, 1));
  expect_error(ErrorCode::inverted_element,
               {"tet 4 has negative volume -1 mm^3 (nodes", "MeshOptions::orient"},
               [&p = points, &t = tets] { Mesh(p, t); });
  MeshOptions options;
  options.orient = true;
  const Mesh mesh(points, tets, {}, options);
  EXPECT_EQ(mesh.reoriented(), 1);
  EXPECT_NEAR(mesh.volume(), 6.0, rounding);
}

TEST(MeshValidation, NamesBothTetsThatAreTheSame) {
  auto [points, tets] = make_box({1, 1, 1}, 1, 1, 1);
  tets.conservativeResize(7, 4);
  tets.row(6) << tets(2, 1), tets(2, 2), tets(2, 0), tets(2, 3);  // an even permutation
  expect_error(ErrorCode::duplicate_element, {"tets 2 and 6 are the same (nodes"},
               [&p = points, &t = tets] { Mesh(p, t); });
}

TEST(MeshValidation, RefusesThreeTetsAtOneFace) {
  auto [points, tets] = one_tet();
  points.conservativeResize(6, 3);
  points.row(4) << 0, 0, 2;
  points.row(5) << 0, 0, 3;
  tets.conservativeResize(3, 4);
  tets.row(1) << 0, 1, 2, 4;
  tets.row(2) << 0, 1, 2, 5;
  expect_error(ErrorCode::duplicate_element, {"tets 0, 1 and 2 share one face"},
               [&p = points, &t = tets] { Mesh(p, t); });
}

TEST(MeshValidation, NamesTheNodeThatNoTetUses) {
  auto [points, tets] = one_tet();
  points.conservativeResize(5, 3);
  points.row(4).setOnes();
  expect_error(ErrorCode::orphan_node, {"node 4 belongs to no tet"},
               [&p = points, &t = tets] { Mesh(p, t); });
}

TEST(MeshValidation, CountsThatDoNotFitAnIndexAreRefusedIn64Bit) {
  EXPECT_EQ(checked_count(2147483647, "nodes"), 2147483647);
  expect_error(ErrorCode::invalid_argument, {"nodes", "4294967296"},
               [] { checked_count(std::int64_t(1) << 32, "nodes"); });
}

TEST(Mesh, VolumeOfABoxIsExactForEveryDiagonal) {
  for (const auto diagonal :
       {test::Diagonal::rising, test::Diagonal::mirrored, test::Diagonal::outward}) {
    const auto [points, tets] = make_box({1, 2, 3}, 2, 4, 6, diagonal);
    const Mesh mesh(points, tets);
    EXPECT_NEAR(mesh.volume(), 6.0, rounding);
    EXPECT_NEAR(mesh.diameter(), std::sqrt(14.0), rounding);
  }
}

TEST(Mesh, VolumeOfRegionsAddsUp) {
  const auto [points, tets] = make_box({2, 1, 1}, 2, 1, 1);
  const Mesh mesh(points, tets, {7, 7, 7, 7, 7, 7, -3, -3, -3, -3, -3, -3});
  EXPECT_NEAR(mesh.volume(7), 1.0, rounding);
  EXPECT_NEAR(mesh.volume(-3), 1.0, rounding);
  EXPECT_EQ(mesh.volume(0), 0.0);
  EXPECT_EQ(mesh.faces_of_region(7).size(), 10u);  // five sides of two triangles
  EXPECT_TRUE(mesh.faces_of_region(0).empty());
}

TEST(Mesh, SurfaceOfABoxIsClosedAndHasItsAreaAndVolume) {
  const auto [points, tets] = make_box({1, 2, 3}, 2, 3, 4);
  const Mesh mesh(points, tets);
  EXPECT_EQ(mesh.surface().rows(), 2 * 2 * (2 * 3 + 3 * 4 + 4 * 2));
  EXPECT_NO_THROW(require_closed(mesh.nodes(), mesh.surface(), "surface"));
  EXPECT_NEAR(enclosed_volume(mesh.nodes(), mesh.surface()), 6.0, rounding);  // outward
  double area = 0.0;
  for (Eigen::Index i = 0; i < mesh.surface().rows(); ++i) {
    const Vec3 a = points.row(mesh.surface()(i, 0)), b = points.row(mesh.surface()(i, 1)),
               c = points.row(mesh.surface()(i, 2));
    area += (b - a).cross(c - a).norm() / 2.0;
  }
  EXPECT_NEAR(area, 22.0, 22.0 * rounding);
}

TEST(Mesh, EverySurfaceFaceBelongsToTheTetThatOwnsIt) {
  const auto [points, tets] = make_ball(1.0, 4);
  const Mesh mesh(points, tets);
  ASSERT_EQ(Eigen::Index(mesh.surface_tets().size()), mesh.surface().rows());
  for (Eigen::Index i = 0; i < mesh.surface().rows(); ++i) {
    const auto tet = mesh.tets().row(mesh.surface_tets()[std::size_t(i)]);
    const std::set<Index> nodes(tet.data(), tet.data() + 4);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(nodes.count(mesh.surface()(i, k)), 1u);
  }
}

TEST(Mesh, FacesWithinNodesAreThoseOfOneSide) {
  const auto [points, tets] = make_box({1, 1, 1}, 3, 3, 3);
  const Mesh mesh(points, tets);
  Indices top;
  for (Index i = 0; i < mesh.node_count(); ++i)
    if (points(i, 2) == 1.0) top.push_back(i);
  const Indices faces = mesh.faces_within(top);
  EXPECT_EQ(faces.size(), 18u);
  for (const Index face : faces)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(points(mesh.surface()(face, k), 2), 1.0);
  expect_error(ErrorCode::index_out_of_range, {"entry 1 of nodes refers to node 64 of 64"}, [&] {
    mesh.faces_within({0, 64});
  });
}

TEST(Mesh, ComponentsAreNumberedByTheirLowestNode) {
  auto [points, tets] = make_box({1, 1, 1}, 1, 1, 1);
  const Eigen::Index n = points.rows(), m = tets.rows();
  points.conservativeResize(2 * n, 3);
  points.bottomRows(n) = points.topRows(n).rowwise() + Eigen::RowVector3d(5, 0, 0);
  tets.conservativeResize(2 * m, 4);
  tets.bottomRows(m) = tets.topRows(m).array() + Index(n);
  const Mesh mesh(points, tets);
  ASSERT_EQ(mesh.component_count(), 2);
  for (Index i = 0; i < mesh.node_count(); ++i)
    EXPECT_EQ(mesh.components()[std::size_t(i)], i < n ? 0 : 1);
}

TEST(Mesh, SmallestDihedralsAreThoseOfKnownTets) {
  test::TetShape regular = one_tet();
  regular.points << 1, 1, 1, -1, 1, -1, 1, -1, -1, -1, -1, 1;
  const double degrees = 180.0 / EIGEN_PI;
  EXPECT_NEAR(Mesh(regular.points, regular.tets).smallest_dihedrals()[0],
              std::acos(1.0 / 3.0) * degrees, 180.0 * rounding);
  const auto corner = one_tet();
  EXPECT_NEAR(Mesh(corner.points, corner.tets).smallest_dihedrals()[0],
              std::acos(1.0 / std::sqrt(3.0)) * degrees, 180.0 * rounding);
  const auto [points, tets] = make_box({1, 1, 1}, 1, 1, 1);  // Kuhn tets: 45, 60, 90 degrees
  const Eigen::VectorXd angles = Mesh(points, tets).smallest_dihedrals();
  EXPECT_NEAR((angles.array() - 45.0).abs().maxCoeff(), 0.0, 180.0 * rounding);
}

TEST(Mesh, CopiesShareTheirData) {
  const auto [points, tets] = make_box({1, 1, 1}, 1, 1, 1);
  const Mesh mesh(points, tets), copy = mesh;
  EXPECT_EQ(&mesh.nodes(), &copy.nodes());
}

}  // namespace
}  // namespace brainshift
