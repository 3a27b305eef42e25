// Thick sphere under internal pressure (Lame): order of convergence of linear tets.
// a = 1, b = 2, E = 1000, p = 1, nu = 0.3: u(a) = 8.0e-4, u(b) = 3.0e-4.
#include <gtest/gtest.h>

#include "support/scenes.hpp"

namespace brainshift {
namespace {

// An octant: patches of the sphere's surface through r, from the cube's three faces, split as boxes.
test::TetShape octant_shell(int n) {
  // (s, t) on a cube face mapped onto the sphere, r from 1 to 2; three faces meet at (1,1,1).
  test::TetShape shell;
  std::map<std::array<long, 3>, Index> known;
  std::vector<Vec3> points;
  std::vector<std::array<Index, 4>> tets;
  const auto node = [&](const Vec3& p) {
    const std::array<long, 3> key{std::lround(p.x() * 1e7), std::lround(p.y() * 1e7),
                                  std::lround(p.z() * 1e7)};
    const auto [entry, fresh] = known.try_emplace(key, Index(points.size()));
    if (fresh) points.push_back(p);
    return entry->second;
  };
  const auto box = test::make_box({1, 1, 1}, n, n, n);
  for (int face = 0; face < 3; ++face) {
    std::vector<Index> number;
    for (Eigen::Index i = 0; i < box.points.rows(); ++i) {
      Vec3 direction;
      direction[face] = 1.0;
      direction[(face + 1) % 3] = std::tan(0.25 * M_PI * box.points(i, 0));
      direction[(face + 2) % 3] = std::tan(0.25 * M_PI * box.points(i, 1));
      Vec3 p = (1.0 + box.points(i, 2)) * direction.normalized();
      for (int k = 0; k < 3; ++k) {
        if (std::abs(p[k]) < 1e-12) p[k] = 0.0;
      }
      number.push_back(node(p));
    }
    for (Eigen::Index t = 0; t < box.tets.rows(); ++t) {
      std::array<Index, 4> tet;
      for (int a = 0; a < 4; ++a) tet[std::size_t(a)] = number[std::size_t(box.tets(t, a))];
      tets.push_back(tet);
    }
  }
  shell.points.resize(Eigen::Index(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) shell.points.row(Eigen::Index(i)) = points[i];
  shell.tets.resize(Eigen::Index(tets.size()), 4);
  for (std::size_t t = 0; t < tets.size(); ++t) {
    for (int a = 0; a < 4; ++a) shell.tets(Eigen::Index(t), a) = tets[t][std::size_t(a)];
  }
  return shell;
}

struct Errors {
  double inner, outer;  // relative, of the mean radial displacement
};

Errors solve(int n) {
  const test::TetShape shape = octant_shell(n);
  const Mesh mesh(shape.points, shape.tets);
  // The pressure: a fluid far above, wetting the inner face alone. Its gradient is 1e-8 of it; the
  // follower effect is of the order of the strain, so p is scaled down and the result up by 1e6.
  const double scale = 1e-6, head = 1e8;
  const double density = scale / (standard_gravity * head);
  Compartment c;
  c.name = "inside";
  const auto wall = test::box_wall({-3, -3, -3}, {3, 3, 3});
  c.wall_points = wall.points;
  c.wall_triangles = wall.triangles;
  c.wetted_faces = mesh.faces_within(
      test::nodes_where(mesh, [](const Vec3& x) { return std::abs(x.norm() - 1.0) < 1e-9; }));
  Scene scene{mesh,
              {{0, Material(Law::linear, 1000.0, 0.3, 0.0)}},
              Vec3(0, 0, -standard_gravity),
              Csf(density, FluidModel::separate, {c}, head),
              {}};
  scene.balanced_reference = false;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<bool, 3> axes{axis == 0, axis == 1, axis == 2};
    scene.constraints.fix(
        "plane", test::nodes_where(mesh, [axis](const Vec3& x) { return x[axis] == 0.0; }), axes);
  }
  StepperOptions options;
  options.residual_tolerance = 1e-12;  // the load is small beside E L^2
  Stepper stepper(scene, options);
  const SolveReport report = stepper.solve_static();
  EXPECT_TRUE(report.converged()) << report.message;
  const auto mean_at = [&](double radius) {
    double sum = 0.0;
    int count = 0;
    for (Index i = 0; i < mesh.node_count(); ++i) {
      const Vec3 p = mesh.nodes().row(i).transpose();
      if (std::abs(p.norm() - radius) > 1e-9) continue;
      sum += stepper.displacement().row(i).dot(p.transpose()) / radius;
      ++count;
    }
    return sum / count / scale;
  };
  return {std::abs(mean_at(1.0) / 8.0e-4 - 1.0), std::abs(mean_at(2.0) / 3.0e-4 - 1.0)};
}

TEST(ThickSphere, LinearTetsConvergeToLameToOrderTwo) {
  const Errors a = solve(4), b = solve(8), c = solve(16);
  // O(h^2): a factor 4 in the limit
  EXPECT_GT(b.inner / c.inner, 3.2) << a.inner << " " << b.inner << " " << c.inner;
  EXPECT_GT(b.outer / c.outer, 3.2) << a.outer << " " << b.outer << " " << c.outer;
  EXPECT_LT(c.inner, 0.02);
  EXPECT_LT(c.outer, 0.02);
}

}  // namespace
}  // namespace brainshift
