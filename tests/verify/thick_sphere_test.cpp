// Thick sphere under internal pressure (Lame): order of convergence of linear tets.
// a = 1, b = 2, E = 1000, p = 1, nu = 0.3: u(a) = 8.0e-4, u(b) = 3.0e-4.
#include <cstdio>

#include <gtest/gtest.h>

#include "mesh/quadratic_tet.hpp"
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

// The octant with quadratic tets, its edges bent onto the spheres.
Mesh bent_shell(int n) {
  const test::TetShape shape = octant_shell(n);
  const Mesh straight = Mesh(shape.points, shape.tets).quadratic();
  Points nodes = straight.nodes();
  for (Index t = 0; t < straight.tet_count(); ++t) {
    for (int e = 0; e < 6; ++e) {
      const Vec3 a = nodes.row(straight.tets()(t, tet_edges[e][0])).transpose();
      const Vec3 b = nodes.row(straight.tets()(t, tet_edges[e][1])).transpose();
      const Vec3 direction = a.normalized() + b.normalized();
      nodes.row(straight.edge_nodes()(t, e)) =
          0.5 * (a.norm() + b.norm()) * direction.normalized().transpose();
    }
  }
  return Mesh::with_edge_nodes(nodes, straight.tets(), straight.edge_nodes());
}

// u(a), u(b) of Lame's solution with E = 1000 and p = 1 inside.
double lame(double poisson, double r) {
  const double a = 1.0, b = 2.0, E = 1000.0;
  return a * a * a / (E * (b * b * b - a * a * a)) *
         ((1.0 - 2.0 * poisson) * r + (1.0 + poisson) * b * b * b / (2.0 * r * r));
}

struct Errors {
  double inner, outer;  // relative, of the mean radial displacement
  Index nodes;
};

Errors solve(const Mesh& mesh, double poisson, VolumeStrain volume = VolumeStrain::element) {
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
              {{0, Material(Law::linear, 1000.0, poisson, 0.0)}},
              Vec3(0, 0, -standard_gravity),
              Csf(density, FluidModel::separate, {c}, head),
              {}};
  scene.balanced_reference = false;
  scene.volume_strain = volume;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<bool, 3> axes{axis == 0, axis == 1, axis == 2};
    scene.constraints.fix(
        "plane",
        test::nodes_where(mesh, [axis](const Vec3& x) { return std::abs(x[axis]) < 1e-12; }), axes);
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
  return {std::abs(mean_at(1.0) / lame(poisson, 1.0) - 1.0),
          std::abs(mean_at(2.0) / lame(poisson, 2.0) - 1.0), mesh.node_count()};
}

Mesh linear_shell(int n) {
  const test::TetShape shape = octant_shell(n);
  return Mesh(shape.points, shape.tets);
}

void report(const char* what, double poisson, const Errors& e) {
  std::printf("Lame sphere, nu = %g, %s, %d nodes: %.3f %% inside, %.3f %% outside\n", poisson,
              what, int(e.nodes), 100.0 * e.inner, 100.0 * e.outer);
}

TEST(ThickSphere, LinearTetsConvergeToLameToOrderTwo) {
  const Errors a = solve(linear_shell(4), 0.3), b = solve(linear_shell(8), 0.3),
               c = solve(linear_shell(16), 0.3);
  // O(h^2): a factor 4 in the limit
  EXPECT_GT(b.inner / c.inner, 3.2) << a.inner << " " << b.inner << " " << c.inner;
  EXPECT_GT(b.outer / c.outer, 3.2) << a.outer << " " << b.outer << " " << c.outer;
  EXPECT_LT(c.inner, 0.02);
  EXPECT_LT(c.outer, 0.02);
}

// The figures a planner would be wrong by: at most 10 000 nodes each.
TEST(ThickSphere, AtPoissonRatio0499QuadraticAndNodalTetsDoNotLock) {
  const Errors linear = solve(linear_shell(14), 0.499);
  const Errors nodal = solve(linear_shell(14), 0.499, VolumeStrain::nodal);
  const Errors quadratic = solve(bent_shell(7), 0.499);
  report("linear", 0.499, linear);
  report("nodal volume", 0.499, nodal);
  report("quadratic", 0.499, quadratic);
  EXPECT_LE(std::max(linear.nodes, quadratic.nodes), 10000);
  EXPECT_GT(linear.inner, 0.1);  // locks: that is what the others are for
  EXPECT_LE(std::max(nodal.inner, nodal.outer), 0.02);
  EXPECT_LE(std::max(quadratic.inner, quadratic.outer), 0.002);
}

}  // namespace
}  // namespace brainshift
