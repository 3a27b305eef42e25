// Shapes for tests: boxes and balls of tets, closed surfaces, sheets. Everything in mm.
//
// All of them are deterministic, positively oriented and conforming; the results unpack:
//   const auto [points, tets] = make_box({10, 20, 30}, 2, 4, 6);
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "brainshift/types.hpp"

namespace brainshift::test {

struct TetShape {
  Points points;
  Tets tets;
};

struct SurfaceShape {
  Points points;
  Triangles triangles;
};

// Which diagonal of each cell the six tets share (Kuhn 1960): from its lowest to its highest
// corner; its mirror image in x; or the one that points away from the middle of the box, mirrored
// from octant to octant, so that no tet has all its nodes on the boundary (even cell counts only).
enum class Diagonal { rising, mirrored, outward };

// Number of the node (i, j, k) of make_box, x fastest.
inline Index box_node(int nx, int ny, int i, int j, int k) {
  return Index(i + (nx + 1) * (j + (ny + 1) * k));
}

// Box [0, size] of nx x ny x nz cells with six tets each.
inline TetShape make_box(const Vec3& size, int nx, int ny, int nz,
                         Diagonal diagonal = Diagonal::rising) {
  TetShape box;
  box.points.resize(Eigen::Index(nx + 1) * (ny + 1) * (nz + 1), 3);
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i)
        box.points.row(box_node(nx, ny, i, j, k)) << size.x() * i / nx, size.y() * j / ny,
            size.z() * k / nz;

  box.tets.resize(Eigen::Index(6) * nx * ny * nz, 4);
  Eigen::Index row = 0;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        std::array<bool, 3> mirror{diagonal == Diagonal::mirrored, false, false};
        if (diagonal == Diagonal::outward) mirror = {2 * i < nx, 2 * j < ny, 2 * k < nz};
        const bool turned = (int(mirror[0]) + int(mirror[1]) + int(mirror[2])) % 2 == 1;
        std::array<int, 3> axes{0, 1, 2};
        do {  // one tet for each order in which a path along the edges climbs the diagonal
          std::array<int, 3> corner{0, 0, 0};
          std::array<Index, 4> tet{};
          for (int step = 0; step < 4; ++step) {
            tet[std::size_t(step)] =
                box_node(nx, ny, i + (corner[0] ^ int(mirror[0])), j + (corner[1] ^ int(mirror[1])),
                         k + (corner[2] ^ int(mirror[2])));
            if (step < 3) corner[std::size_t(axes[std::size_t(step)])] = 1;
          }
          const bool odd = (axes[0] > axes[1]) ^ (axes[0] > axes[2]) ^ (axes[1] > axes[2]);
          if (odd != turned) std::swap(tet[2], tet[3]);
          box.tets.row(row++) << tet[0], tet[1], tet[2], tet[3];
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
  return box;
}

// Ball around the origin: the Kuhn cube [-1, 1]^3 of n cells per edge (rounded up to even), mapped
// along its rays so that its surface becomes the sphere; 6 n^3 tets. Scale x, y, z for an ellipsoid.
inline TetShape make_ball(double radius, int n) {
  n += n % 2;
  TetShape ball = make_box(Vec3::Constant(2.0), n, n, n, Diagonal::outward);
  for (Eigen::Index i = 0; i < ball.points.rows(); ++i) {
    const Vec3 x = ball.points.row(i).transpose() - Vec3::Ones();
    const double cube = x.cwiseAbs().maxCoeff(), length = x.norm();
    // A cube in the middle, a sphere at the surface, a blend of the two between.
    const double scale = length > 0.0 ? 0.7 * (1.0 - cube) + cube * cube / length : 0.0;
    ball.points.row(i) = radius * scale * x.transpose();
  }
  return ball;
}

// Each tet cut into four at its centroid: three tets around each new edge.
inline TetShape split_at_centroids(const TetShape& coarse) {
  const Index nodes = Index(coarse.points.rows()), count = Index(coarse.tets.rows());
  TetShape fine{Points(nodes + count, 3), Tets(4 * count, 4)};
  fine.points.topRows(nodes) = coarse.points;
  for (Index t = 0; t < count; ++t) {
    Vec3 centroid = Vec3::Zero();
    for (int a = 0; a < 4; ++a) centroid += 0.25 * coarse.points.row(coarse.tets(t, a)).transpose();
    fine.points.row(nodes + t) = centroid.transpose();
    for (int a = 0; a < 4; ++a) {
      fine.tets.row(4 * t + a) = coarse.tets.row(t);
      fine.tets(4 * t + a, a) = nodes + t;
    }
  }
  return fine;
}

// Sphere around the origin with outward triangles: an icosahedron, each triangle split into four
// `subdivisions` times; 20 * 4^subdivisions triangles, all nodes on the sphere.
inline SurfaceShape make_icosphere(double radius, int subdivisions) {
  const double t = (1.0 + std::sqrt(5.0)) / 2.0;
  SurfaceShape sphere;
  sphere.points.resize(12, 3);
  sphere.points << -1, t, 0, 1, t, 0, -1, -t, 0, 1, -t, 0, 0, -1, t, 0, 1, t, 0, -1, -t, 0, 1, -t,
      t, 0, -1, t, 0, 1, -t, 0, -1, -t, 0, 1;
  sphere.triangles.resize(20, 3);
  sphere.triangles << 0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2,
      10, 7, 6, 7, 1, 8, 3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10,
      8, 6, 7, 9, 8, 1;
  sphere.points.rowwise().normalize();
  for (int level = 0; level < subdivisions; ++level) {
    const Triangles coarse = sphere.triangles;
    Eigen::Index count = sphere.points.rows();
    sphere.points.conservativeResize(count + coarse.rows() * 3 / 2, 3);
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [entry, fresh] = middles.try_emplace(std::minmax(a, b), Index(count));
      if (fresh)
        sphere.points.row(count++) = (sphere.points.row(a) + sphere.points.row(b)).normalized();
      return entry->second;
    };
    sphere.triangles.resize(4 * coarse.rows(), 3);
    for (Eigen::Index i = 0; i < coarse.rows(); ++i) {
      const Index a = coarse(i, 0), b = coarse(i, 1), c = coarse(i, 2);
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      sphere.triangles.middleRows<4>(4 * i) << a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca;
    }
  }
  sphere.points *= radius;
  return sphere;
}

// Surface of the box [0, size]: 8 points, 12 outward triangles.
inline SurfaceShape make_box_surface(const Vec3& size) {
  SurfaceShape box;
  box.points.resize(8, 3);
  for (int i = 0; i < 8; ++i)
    box.points.row(i) << size.x() * (i & 1), size.y() * ((i >> 1) & 1), size.z() * ((i >> 2) & 1);
  box.triangles.resize(12, 3);
  box.triangles << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6,
      0, 6, 2, 1, 3, 7, 1, 7, 5;
  return box;
}

// Flat sheet [0, lx] x [0, ly] in the plane z = 0, of nx x ny cells; its normal is +z.
inline SurfaceShape make_sheet(double lx, double ly, int nx, int ny) {
  SurfaceShape sheet;
  sheet.points.resize(Eigen::Index(nx + 1) * (ny + 1), 3);
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
      sheet.points.row(i + (nx + 1) * j) << lx * i / nx, ly * j / ny, 0.0;
  sheet.triangles.resize(Eigen::Index(2) * nx * ny, 3);
  Eigen::Index row = 0;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const Index a = Index(i + (nx + 1) * j), b = a + 1, c = b + nx + 1, d = a + nx + 1;
      sheet.triangles.row(row++) << a, b, c;
      sheet.triangles.row(row++) << a, c, d;
    }
  return sheet;
}

}  // namespace brainshift::test
