// The rings over which ties are spread: where they lie, what their means are, how they end at the surface.
#include <cmath>

#include <gtest/gtest.h>

#include "coupling/inserted_device.hpp"
#include "coupling/local_give.hpp"
#include "support/elements.hpp"
#include "support/scenes.hpp"

namespace brainshift::test {
namespace {

constexpr double radius = 0.635;

struct Ringed {
  Mesh mesh;
  Tissue tissue;
  Points positions;
  std::vector<PathPoint> path;

  Ringed(const Mesh& m, const Vec3& tip, const Vec3& outward, double length)
      : mesh(m), tissue(mesh, {{0, {Law::linear, 3.0, 0.45, 0.0}}}), positions(bent(mesh)) {
    path = cut_track(mesh, positions, tip, outward, length, 1.0);
    spread_ties(tissue, positions, outward, radius, path);
  }
  static Points bent(const Mesh& mesh) {
    Points x = mesh.nodes();
    for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, 0) += 0.002 * x(i, 2) * x(i, 2);
    return x;
  }
  Vec3 place(const TetPoint& p) const { return mesh.interpolation(p.tet, p.weights).of(positions); }
};

Mesh block(Element element) {
  const auto box = make_box({40.0, 40.0, 40.0}, 8, 8, 8);
  const Mesh mesh(box.points, box.tets, {}, {true});
  return element == Element::quadratic ? mesh.quadratic() : mesh;
}

// The mean of a ring is its middle, so that insertion opens no tie; the points of a ring lie across the device.
TEST(TieRing, IsRegularAcrossTheTrackWhereNodesAreNow) {
  for (Element element : {Element::linear, Element::quadratic}) {
    const Vec3 tip(20.3, 18.7, 12.1), outward = Vec3(0.1, 0.2, 1.0).normalized();
    const Ringed r(block(element), tip, outward, 16.0);
    ASSERT_GE(r.path.size(), 5u);
    for (const PathPoint& p : r.path) {
      ASSERT_EQ(p.ring.size(), 6u);
      EXPECT_GT(p.spread, radius);
      const Vec3 middle = tip + p.arc * outward;
      for (const TetPoint& q : p.ring) {
        const Vec3 arm = r.place(q) - middle;
        EXPECT_NEAR(arm.norm(), p.spread, 1e-9);
        EXPECT_NEAR(arm.dot(outward), 0.0, 1e-9);
      }
      EXPECT_LE((path_position(r.mesh, r.positions - r.mesh.nodes(), p) - middle).norm(), 1e-9);
    }
  }
}

// 2 mm beside a face, tets of 5 mm: a whole ring would stand out of it.
TEST(TieRing, IsSmallerNextToTheSurface) {
  const Vec3 outward = Vec3::UnitZ();
  const Ringed inside(block(Element::linear), {20.3, 18.7, 12.1}, outward, 16.0);
  const Ringed beside(block(Element::linear), {20.3, 2.0, 12.1}, outward, 16.0);
  for (const PathPoint& p : beside.path) {
    EXPECT_LE(p.spread, 2.0);
    EXPECT_LT(p.spread, 0.6 * inside.path.front().spread);
    for (const TetPoint& q : p.ring) EXPECT_GE(beside.place(q).y(), -1e-9);
  }
}

// Two blocks side by side, 0.1 mm between them: no ring reaches from one into the other.
TEST(TieRing, StaysInTheBodyOfTheTrack) {
  const auto box = make_box({40.0, 20.0, 40.0}, 8, 4, 8);
  const auto nodes = box.points.rows(), tets = box.tets.rows();
  Points points(2 * nodes, 3);
  points << box.points, box.points.rowwise() + Eigen::RowVector3d(0.0, 20.1, 0.0);
  Tets both(2 * tets, 4);
  both << box.tets, (box.tets.array() + Index(nodes)).matrix();
  const Ringed r(Mesh(points, both, {}, {true}), {20.3, 18.0, 12.1}, Vec3::UnitZ(), 16.0);
  for (const PathPoint& p : r.path) {
    EXPECT_LE(p.spread, 2.0);
    for (const TetPoint& q : p.ring) EXPECT_LT(q.tet, Index(tets));
  }
}

// Whatever is spread stays so when the device in the track is exchanged for another.
TEST(TieRing, IsKept) {
  Ringed r(block(Element::linear), {20.3, 18.7, 12.1}, Vec3::UnitZ(), 16.0);
  const std::vector<PathPoint> before = r.path;
  spread_ties(r.tissue, r.mesh.nodes(), Vec3::UnitX(), 4.0 * radius, r.path);
  for (std::size_t p = 0; p < before.size(); ++p) {
    EXPECT_EQ(r.path[p].spread, before[p].spread);
    EXPECT_EQ(r.path[p].ring[0].weights, before[p].ring[0].weights);
  }
}

}  // namespace
}  // namespace brainshift::test
