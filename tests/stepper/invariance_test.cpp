// A solve does not depend on units, labels or the axes the scene is written in.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "support/scenes.hpp"

namespace brainshift {
namespace {

// How a scene is written down: units by powers of ten or two, a rotation about z, labels.
struct Writing {
  double length = 1.0, mass = 1.0, time = 1.0;
  double angle = 0.0;
  unsigned shuffle = 0;  // seed; 0: labels as they come
};

struct Written {
  Scene scene;
  Indices label;  // of each node
};

// A tissue block in a box of fluid, over a floor and before a wall, half of the fluid gone, tilted gravity.
Written write(const Writing& w) {
  const auto rotation = Eigen::AngleAxisd(w.angle, Vec3::UnitZ()).toRotationMatrix();
  const auto turned = [&](const Points& p) {
    return Points(w.length * (p * rotation.transpose()));
  };
  auto shape = test::make_box({30, 24, 30}, 3, 3, 3);
  const Index n = Index(shape.points.rows());
  Indices label(static_cast<std::size_t>(n));
  std::iota(label.begin(), label.end(), 0);
  std::mt19937 random(w.shuffle);
  if (w.shuffle) std::shuffle(label.begin(), label.end(), random);
  test::TetShape relabelled = shape;
  for (Index i = 0; i < n; ++i) relabelled.points.row(label[std::size_t(i)]) = shape.points.row(i);
  for (Eigen::Index t = 0; t < shape.tets.rows(); ++t) {
    for (int a = 0; a < 4; ++a) {
      const int b = w.shuffle && t % 2 ? (a < 3 ? (a + 1) % 3 : 3) : a;  // turned, same orientation
      relabelled.tets(t, a) = label[std::size_t(shape.tets(t, b))];
    }
  }
  relabelled.points = turned(relabelled.points);
  const Mesh mesh = test::make_mesh(relabelled);

  const double pressure = w.mass / (w.length * w.time * w.time);
  const double density = w.mass / (w.length * w.length * w.length);
  const auto wall = test::box_wall({-3, -3, -3}, {33, 27, 34});
  // A floor and a wall: planes, which the distance grid holds exactly however it lies to them.
  const auto sheet = test::moved(test::make_sheet(90, 90, 9, 9), {-30, -30, 0});
  Points floor = sheet.points, behind = sheet.points;
  floor.col(2).array() -= 0.2;
  for (Eigen::Index i = 0; i < behind.rows(); ++i) {  // x -> z, y -> x: its normal is +y
    behind.row(i) << sheet.points(i, 1), -0.1, sheet.points(i, 0);
  }
  Scene scene{
      mesh,
      {{0, Material(Law::corotational, 6.0 * pressure, 0.45, test::tissue_density * density)}},
      Vec3(rotation * Vec3(0, -0.4, -1.0)) * standard_gravity * w.length / (w.time * w.time),
      Csf(test::fluid_density * density, FluidModel::separate,
          {test::make_compartment("all", {turned(wall.points), wall.triangles},
                                  test::all_faces(mesh))}),
      {}};
  scene.csf->set_lost_volume(0, 8000.0 * w.length * w.length * w.length);
  SurfaceOptions grid;
  grid.grid_spacing *= w.length;
  grid.band *= w.length;
  for (const Points& points : {floor, behind}) {
    scene.constraints.obstacle("skull", test::surface_nodes(mesh),
                               Surface::sheet(turned(points), sheet.triangles, grid));
  }
  Indices low;
  for (Index i = 0; i < n; ++i) {
    if (shape.points(i, 2) == 0.0) low.push_back(label[std::size_t(i)]);
  }
  scene.constraints.support("stem", low,
                            Eigen::VectorXd::Constant(1, 0.3 * w.mass / (w.time * w.time)));
  scene.balanced_reference = true;
  return {scene, label};
}

struct Outcome {
  Points u;  // of the nodes as first labelled, mm, in unrotated axes
  SolveReport report;
};

Outcome solve(const Writing& w) {
  const Written written = write(w);
  Scene full = written.scene;
  full.csf->set_full(0);
  Stepper stepper(full);
  stepper.csf().set_lost_volume(0, written.scene.csf->amount(0));
  Outcome o;
  o.report = stepper.solve_static();
  EXPECT_TRUE(o.report.converged()) << o.report.message;
  const Mat3 rotation = Eigen::AngleAxisd(w.angle, Vec3::UnitZ()).toRotationMatrix();
  o.u.resize(stepper.mesh().node_count(), 3);
  for (Eigen::Index i = 0; i < o.u.rows(); ++i) {
    o.u.row(i) = stepper.displacement().row(written.label[std::size_t(i)]) * rotation / w.length;
  }
  return o;
}

TEST(Invariance, UnitsThatDifferByPowersOfTwoGiveTheSameBits) {
  const Outcome mm = solve({});
  for (const Writing& w : {Writing{1024.0}, Writing{1.0 / 64, 4096.0, 0.125}}) {
    const Outcome other = solve(w);
    EXPECT_TRUE(test::same_bits(mm.u, other.u)) << test::largest_distance(mm.u, other.u);
    EXPECT_EQ(mm.report.iterations, other.report.iterations);
    EXPECT_EQ(mm.report.residual, other.report.residual);
  }
}

TEST(Invariance, MetresGiveTheResultOfMillimetres) {
  const Outcome mm = solve({}), m = solve({1e-3});
  EXPECT_LE(test::largest_distance(mm.u, m.u), 1e-9 * mm.u.cwiseAbs().maxCoeff());
  EXPECT_LE(std::abs(mm.report.iterations - m.report.iterations), 1);
}

TEST(Invariance, LabelsOfNodesAndCornersDoNotMatter) {
  const Outcome a = solve({}), b = solve({1.0, 1.0, 1.0, 0.0, 17});
  EXPECT_LE(test::largest_distance(a.u, b.u), 1e-9 * 30.0);
}

TEST(Invariance, ASceneTurnedByTenDegreesGivesTheTurnedResult) {
  Writing turned;
  turned.angle = 10.0 * M_PI / 180.0;
  const Outcome a = solve({}), b = solve(turned);
  // planes on a turned grid: single digits of the splines' round-off over 90 mm, and the solve's own
  EXPECT_LE(test::largest_distance(a.u, b.u), 1e-6 * a.u.rowwise().norm().maxCoeff());
  EXPECT_EQ(a.report.active_contacts, b.report.active_contacts);
  EXPECT_GT(a.report.active_contacts, 0);
}

}  // namespace
}  // namespace brainshift
