// A track is cut at the faces of the tets: no tet holds more than two of its points, wherever they lie,
// so that the rows of three points of one tet, which depend on each other, never come up.
#include <algorithm>
#include <cstdio>

#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include "coupling/track.hpp"
#include "support/beams.hpp"
#include "support/scenes.hpp"

namespace brainshift::test {
namespace {

// Box with its inner nodes moved at random, no two tets alike.
Mesh irregular_mesh(std::mt19937& random) {
  const int n = 5;
  TetShape box = make_box({40.0, 40.0, 40.0}, n, n, n);
  for (Eigen::Index i = 0; i < box.points.rows(); ++i) {
    const Vec3 x = box.points.row(i);
    if (x.minCoeff() > 0.0 && x.maxCoeff() < 40.0) {
      box.points.row(i) += random_vector(random, 1.5).transpose();
    }
  }
  return make_mesh(box);
}

// Least barycentric weight of x in a tet: at least 0 inside.
double depth_in(const Mesh& mesh, const Points& positions, Index t, const Vec3& x) {
  Eigen::Matrix4d corners;
  for (int a = 0; a < 4; ++a) corners.col(a) << positions.row(mesh.tets()(t, a)).transpose(), 1.0;
  return (corners.inverse() * Eigen::Vector4d(x.x(), x.y(), x.z(), 1.0)).minCoeff();
}

Vec3 at(const Mesh& mesh, const Points& positions, const PathPoint& p) {
  Vec3 x = Vec3::Zero();
  for (int a = 0; a < 4; ++a) x += p.weights[a] * positions.row(mesh.tets()(p.tet, a)).transpose();
  return x;
}

struct Counted {
  int most = 0;         // points of one track in one tet
  int tets_of_two = 0;  // tets that hold two
  int points = 0;
};

void count(const Mesh& mesh, const Points& positions, const std::vector<PathPoint>& path,
           Counted& counted) {
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    int inside = 0;
    for (const PathPoint& p : path) {
      inside += depth_in(mesh, positions, t, at(mesh, positions, p)) >= -1e-11;
    }
    counted.most = std::max(counted.most, inside);
    counted.tets_of_two += inside == 2;
  }
  counted.points += int(path.size());
}

// The points lie on the line, in order, each in its own tet, and stand for all of the track.
void expect_sound(const Mesh& mesh, const Points& positions, const std::vector<PathPoint>& path,
                  const Vec3& tip, const Vec3& outward) {
  double arc = 0.0, length = 0.0;
  for (const PathPoint& p : path) {
    EXPECT_GT(p.arc, arc);
    EXPECT_GE(p.weights.minCoeff(), 0.0);
    EXPECT_LE((at(mesh, positions, p) - (tip + p.arc * outward)).norm(), 1e-11);
    arc = p.arc;
    length += p.length;
  }
  EXPECT_NEAR(length, arc, 1e-10);  // the last point is where the line leaves the tissue
}

TEST(Track, NoTetHoldsThreePoints) {
  std::mt19937 random(41);
  const Mesh mesh = irregular_mesh(random);
  Counted dense, spaced;
  int neighbours = 0;
  const int tracks = 240;
  for (int trial = 0; trial < tracks; ++trial) {
    SCOPED_TRACE(trial);
    Points positions = mesh.nodes();  // every other track through a deformed mesh
    if (trial % 2) {
      for (Eigen::Index i = 0; i < positions.rows(); ++i) {
        const Vec3 x = positions.row(i);
        positions.row(i) += 0.05 * Vec3(x.y(), -x.z(), 0.3 * x.x()).transpose();
      }
    }
    Vec3 tip = Vec3::Constant(20.0) + random_vector(random, 8.0);
    if (trial % 2) tip += 0.05 * Vec3(tip.y(), -tip.z(), 0.3 * tip.x());
    const Vec3 outward = random_vector(random, 1.0).normalized();
    // With next to no least spacing every face counts.
    const std::vector<PathPoint> path =
        cut_track(mesh, positions, tip, outward, 200.0, trial % 3 ? 1e-6 : 1.0);
    if (trial % 3 == 0) {
      count(mesh, positions, path, spaced);
      continue;
    }
    expect_sound(mesh, positions, path, tip, outward);
    count(mesh, positions, path, dense);
    neighbours += int(path.size()) - 1;
  }
  std::printf(
      "track: %d tracks, %d points with every face and %d with 1 mm between them: at most %d "
      "and %d in one tet, two in %d tets for %d pairs of neighbours\n",
      tracks, dense.points, spaced.points, dense.most, spaced.most, dense.tets_of_two, neighbours);
  EXPECT_EQ(dense.most, 2);
  EXPECT_LE(spaced.most, 2);
  EXPECT_EQ(dense.tets_of_two, neighbours);  // one tet between any two neighbours
  EXPECT_GT(neighbours, 1000);
}

// Along edges and through nodes many tets meet; there, too.
TEST(Track, NorAlongEdgesAndThroughNodes) {
  const Mesh mesh = make_mesh(make_box({40.0, 40.0, 40.0}, 4, 4, 4));
  Counted counted;
  for (const Vec3& direction : {Vec3(0, 0, 1), Vec3(1, 1, 1), Vec3(0, 1, 1), Vec3(1, 2, 1)}) {
    for (const Vec3& tip : {Vec3(10, 10, 10), Vec3(12, 12, 12), Vec3(10, 15, 10)}) {
      const Vec3 outward = direction.normalized();
      const std::vector<PathPoint> path = cut_track(mesh, mesh.nodes(), tip, outward, 200.0, 1.0);
      count(mesh, mesh.nodes(), path, counted);
    }
  }
  std::printf("track along edges: at most %d in one tet\n", counted.most);
  EXPECT_LE(counted.most, 2);
}

// Rank of the weights of the path points over the nodes, by rows scaled to length 1.
Eigen::Index rank_of(const Mesh& mesh, const std::vector<PathPoint>& path) {
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(Eigen::Index(path.size()), mesh.node_count());
  for (std::size_t p = 0; p < path.size(); ++p) {
    for (int a = 0; a < 4; ++a) {
      weights(Eigen::Index(p), mesh.tets()(path[p].tet, a)) += path[p].weights[a];
    }
  }
  weights.rowwise().normalize();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(weights);
  qr.setThreshold(1e-6);
  return qr.rank();
}

// Three tets around an edge have five nodes; a line through all of them would meet four of their faces.
TEST(Track, PointsAreIndependentWhereThreeTetsShareAnEdge) {
  std::mt19937 random(43);
  const Mesh mesh = make_mesh(split_at_centroids(make_box({40.0, 40.0, 40.0}, 3, 3, 3)));
  Eigen::Index points = 0, more = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Vec3 tip = Vec3::Constant(20.0) + random_vector(random, 8.0);
    const Vec3 outward = random_vector(random, 1.0).normalized();
    const auto path = cut_track(mesh, mesh.nodes(), tip, outward, 200.0, 0.1);
    EXPECT_EQ(rank_of(mesh, path), Eigen::Index(path.size())) << trial;
    points += Eigen::Index(path.size());
    const auto longer =
        extend_track(mesh, mesh.nodes(), tip - 6.0 * outward, outward, 6.0, 0.1, path);
    EXPECT_EQ(rank_of(mesh, longer), Eigen::Index(longer.size())) << trial;
    more += Eigen::Index(longer.size() - path.size());
  }
  std::printf("tracks through rings of three tets: %d points, all independent\n", int(points));
  EXPECT_GT(points, 300);
  EXPECT_GT(more, 60);
}

}  // namespace
}  // namespace brainshift::test
