// Level, lost volume and air volume are each other's inverse.
#include <gtest/gtest.h>

#include "brainshift/error.hpp"
#include "fluid/fluid_scenes.hpp"

namespace brainshift {
namespace {

constexpr double volume_tolerance = 1e-3;  // mm^3: 1e-6 mL

TEST(Levels, AHeadSolvedFromAVolumeGivesThatVolumeBack) {
  test::BallInCavity scene;
  Hydrostatics fluid(scene.mesh, scene.csf, test::gravity_down);
  const Points rest = scene.mesh.nodes();
  const double all = fluid.state(0, rest, fluid.heads(rest)).fluid_volume;
  const auto check = [&](const Points& x, double part) {
    const double volume = part * all;
    scene.csf.set_lost_volume(0, volume);
    fluid.configure(scene.csf, test::gravity_down);
    EXPECT_NEAR(fluid.state(0, x, fluid.heads(x)).lost_volume, volume, volume_tolerance) << part;
    scene.csf.set_air_volume(0, volume);
    fluid.configure(scene.csf, test::gravity_down);
    EXPECT_NEAR(fluid.state(0, x, fluid.heads(x)).air_volume, volume, volume_tolerance) << part;
  };
  for (double part : {1e-6, 1e-3, 0.1, 0.5, 0.9, 0.999}) check(rest, part);
  // A deformed body; losses beyond the change of its own volume, 1 % of the fluid
  for (double part : {0.05, 0.5, 0.9}) check(test::shaken(scene.mesh, 1.0), part);
}

TEST(Levels, AVolumeReadAtALevelGivesThatLevelBack) {
  test::BallInCavity scene;
  const Points x = test::shaken(scene.mesh, 1.0);
  Hydrostatics fluid(scene.mesh, scene.csf, test::gravity_down);
  for (double level : {-35.0, -12.0, 0.0, 7.7, 39.0}) {
    scene.csf.set_level(0, level);
    fluid.configure(scene.csf, test::gravity_down);
    const CompartmentState at = fluid.state(0, x, fluid.heads(x));
    EXPECT_EQ(at.head, level);
    scene.csf.set_air_volume(0, at.air_volume);
    fluid.configure(scene.csf, test::gravity_down);
    EXPECT_NEAR(fluid.heads(x)[0], level, 1e-8) << level;
    if (at.lost_volume < 0.0) continue;
    scene.csf.set_lost_volume(0, at.lost_volume);
    fluid.configure(scene.csf, test::gravity_down);
    EXPECT_NEAR(fluid.heads(x)[0], level, 1e-8) << level;
  }
}

TEST(Levels, VolumesAddUpToTheCavity) {
  test::BallInCavity scene;
  const auto wall = test::make_icosphere(40.0, 3);
  double cavity = 0.0;
  for (Eigen::Index f = 0; f < wall.triangles.rows(); ++f) {
    const Vec3 a = wall.points.row(wall.triangles(f, 0)), b = wall.points.row(wall.triangles(f, 1)),
               c = wall.points.row(wall.triangles(f, 2));
    cavity += a.dot(b.cross(c)) / 6.0;
  }
  const Points x = test::shaken(scene.mesh, 1.0);
  scene.csf.set_level(0, 5.0);
  const Hydrostatics fluid(scene.mesh, scene.csf, test::gravity_down);
  const CompartmentState s = fluid.state(0, x, fluid.heads(x));
  EXPECT_NEAR(s.fluid_volume + s.air_volume + s.tissue_volume, cavity, 1e-12 * cavity);
  EXPECT_NEAR(s.tissue_volume, test::volume_below(scene.mesh, x, 1e3), 1e-12 * cavity);
  const double rest = test::volume_below(scene.mesh, scene.mesh.nodes(), 1e3);
  EXPECT_NEAR(s.lost_volume, cavity - rest - s.fluid_volume, 1e-12 * cavity);
  EXPECT_TRUE(s.open);
}

TEST(Levels, TheAirAboveAnEmptyBoxIsItsHeightTimesItsSection) {
  // No tissue in the way of the upper half: box 20 x 20 x 20, tissue at its bottom.
  const Mesh mesh = test::make_mesh(test::make_box({10, 10, 5}, 2, 2, 1));
  Csf csf(test::fluid_density, FluidModel::separate,
          {test::make_compartment("box", test::box_wall({-5, -5, -1}, {15, 15, 19}),
                                  test::all_faces(mesh))});
  csf.set_lost_volume(0, 400.0 * 3.0);
  const Hydrostatics fluid(mesh, csf, test::gravity_down);
  EXPECT_NEAR(fluid.heads(mesh.nodes())[0], 19.0 - 3.0, 1e-12);
  EXPECT_NEAR(fluid.full_head(), 19.0, 0.0);
}

TEST(Levels, NothingLostIsFull) {
  test::BallInCavity scene;
  scene.csf.open(0);
  const Hydrostatics fluid(scene.mesh, scene.csf, test::gravity_down);
  // Near the top the section vanishes: round-off of the volume, 1e-15, is 1e-7 of the height.
  EXPECT_NEAR(fluid.heads(scene.mesh.nodes())[0], 40.0, 1e-5);
}

TEST(Levels, TheReferenceHeadMayBeAboveTheCavity) {
  const Mesh mesh = test::make_mesh(test::make_box({10, 10, 5}, 1, 1, 1));
  const Csf csf(test::fluid_density, FluidModel::separate,
                {test::make_compartment("box", test::box_wall({-5, -5, -1}, {15, 15, 19}),
                                        test::all_faces(mesh))},
                100.0);
  const Hydrostatics fluid(mesh, csf, test::gravity_down);
  EXPECT_EQ(fluid.heads(mesh.nodes())[0], 100.0);
  EXPECT_NEAR(fluid.nodal_pressure(mesh.nodes(), {100.0})[0], test::weight * 100.0, 1e-15);
}

TEST(Levels, InTheCommunicatingFluidOneHeadServesAllAndOnlyOpenedSidesHoldAir) {
  const Mesh mesh = test::make_mesh(test::make_box({10, 10, 10}, 2, 1, 1));
  const auto empty = test::box_wall({15, -5, -5}, {35, 15, 15});
  Csf csf(test::fluid_density, FluidModel::communicating,
          {test::make_compartment("tissue", test::box_wall({-5, -5, -5}, {15, 15, 15}),
                                  test::all_faces(mesh)),
           test::make_compartment("fluid alone", empty, {})});
  csf.set_lost_volume(1, 400.0 * 8.0);
  const Hydrostatics fluid(mesh, csf, test::gravity_down);
  const std::vector<double> heads = fluid.heads(mesh.nodes());
  EXPECT_NEAR(heads[0], 15.0 - 8.0, 1e-12);
  EXPECT_EQ(heads[0], heads[1]);
  EXPECT_EQ(fluid.state(0, mesh.nodes(), heads).air_volume, 0.0);
  EXPECT_NEAR(fluid.state(1, mesh.nodes(), heads).air_volume, 3200.0, 1e-9);
  // The closed side is under suction above the head: not cut off.
  const Eigen::VectorXd p = fluid.nodal_pressure(mesh.nodes(), heads);
  EXPECT_NEAR(p[mesh.node_count() - 1], test::weight * (7.0 - 10.0), 1e-15);
}

TEST(Levels, InTheSeparateFluidASideThatIsNotOpenStaysFull) {
  const Mesh mesh = test::make_mesh(test::make_box({10, 10, 10}, 2, 1, 1));
  const auto empty = test::box_wall({15, -5, -5}, {35, 15, 15});
  Csf csf(test::fluid_density, FluidModel::separate,
          {test::make_compartment("tissue", test::box_wall({-5, -5, -5}, {15, 15, 15}),
                                  test::all_faces(mesh)),
           test::make_compartment("fluid alone", empty, {})});
  csf.set_lost_volume(1, 400.0 * 8.0);
  const Hydrostatics fluid(mesh, csf, test::gravity_down);
  const std::vector<double> heads = fluid.heads(mesh.nodes());
  EXPECT_EQ(heads[0], 15.0);
  EXPECT_NEAR(heads[1], 15.0 - 8.0, 1e-12);
}

TEST(Levels, AmountsCountForAllOpenSidesTogetherInTheCommunicatingFluid) {
  const Mesh mesh = test::make_mesh(test::make_box({10, 10, 10}, 2, 1, 1));
  const auto empty = test::box_wall({15, -5, -5}, {35, 15, 15});
  Csf csf(test::fluid_density, FluidModel::communicating,
          {test::make_compartment("tissue", test::box_wall({-5, -5, -5}, {15, 15, 15}),
                                  test::all_faces(mesh)),
           test::make_compartment("fluid alone", empty, {})});
  csf.set_lost_volume(1, 800.0 * 4.0);
  csf.open(0);
  EXPECT_EQ(csf.amount(0), 3200.0);
  const Hydrostatics fluid(mesh, csf, test::gravity_down);
  EXPECT_NEAR(fluid.heads(mesh.nodes())[0], 15.0 - 4.0, 1e-12);
}

TEST(Levels, UnequalLevelsActOnTheirOwnFaces) {
  // Two compartments of one body: the left half of its surface in one, the right in the other.
  const Mesh mesh = test::make_mesh(test::make_box({20, 10, 10}, 4, 2, 2));
  Compartment left{"left", {}, {}, {}, {}}, right = left;
  right.name = "right";
  for (Index f : test::all_faces(mesh)) {
    double x = 0.0;
    for (int k = 0; k < 3; ++k) x += mesh.nodes()(mesh.surface()(f, k), 0) / 3.0;
    (x < 10.0 ? left : right).wetted_faces.push_back(f);
  }
  const auto walls = {test::box_wall({-5, -5, -5}, {10, 15, 15}),
                      test::box_wall({10, -5, -5}, {25, 15, 15})};
  left.wall_points = walls.begin()->points;
  left.wall_triangles = walls.begin()->triangles;
  right.wall_points = (walls.begin() + 1)->points;
  right.wall_triangles = (walls.begin() + 1)->triangles;
  Csf csf(test::fluid_density, FluidModel::separate, {left, right});
  csf.set_level(0, 3.0);
  csf.set_level(1, 12.0);
  const Hydrostatics fluid(mesh, csf, test::gravity_down);
  const Points& x = mesh.nodes();
  const Points force = test::force_at(fluid, x, fluid.heads(x));
  const double w = test::weight;
  // Ends 10 wide: left end pushed right by w 10 (3^2)/2, right end pushed left by
  // w 10 (12 * 10 - 10^2/2); bottoms of 10 x 10 lifted by w 3 and w 12; the right top pushed by w 2.
  const Vec3 expected(w * 10 * (4.5 - 70.0), 0.0, w * 100 * (3.0 + 12.0 - 2.0));
  EXPECT_LT((force.colwise().sum().transpose() - expected).norm(), 1e-12 * expected.norm());
}

}  // namespace
}  // namespace brainshift
