// Level, lost volume and air volume are each other's inverse.
#include <gtest/gtest.h>

#include "brainshift/error.hpp"
#include "fluid/fluid_scenes.hpp"

namespace brainshift {
namespace {

constexpr double volume_tolerance = 1e-3;   // mm^3: 1e-6 mL, asked for by the specification

TEST(Levels, AHeadSolvedFromAVolumeGivesThatVolumeBack) {
  test::BallInCavity scene;
  for (const Points& x : {scene.mesh.nodes(), test::shaken(scene.mesh, 1.0)}) {
    for (double part : {1e-6, 1e-3, 0.1, 0.5, 0.9, 0.999}) {
      Hydrostatics fluid(scene.mesh, scene.csf, test::gravity_down);
      const double volume = part * fluid.state(0, scene.mesh.nodes(),
                                               fluid.heads(scene.mesh.nodes())).fluid_volume;
      scene.csf.set_lost_volume(0, volume);
      fluid.configure(scene.csf, test::gravity_down);
      EXPECT_NEAR(fluid.state(0, x, fluid.heads(x)).lost_volume, volume, volume_tolerance) << part;
      scene.csf.set_air_volume(0, volume);
      fluid.configure(scene.csf, test::gravity_down);
      EXPECT_NEAR(fluid.state(0, x, fluid.heads(x)).air_volume, volume, volume_tolerance) << part;
      scene.csf.set_full(0);
    }
  }
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
  const Mesh mesh = test::make_mesh(test::make_box({10, 10, 10}, 2, 1, 1), {});
  const Mesh& m = mesh;
  Compartment left = test::make_compartment("left", test::box_wall({-5, -5, -5}, {15, 15, 15}),
                                            test::all_faces(m));
  Compartment right{"right", test::box_wall({15, -5, -5}, {35, 15, 15}).points,
                    test::box_wall({15, -5, -5}, {35, 15, 15}).triangles, {}, {}};
  // right holds no tissue
  EXPECT_NO_THROW({
    Csf csf(test::fluid_density, FluidModel::communicating, {left, right});
    csf.set_lost_volume(1, 400.0 * 8.0);
    const Hydrostatics fluid(m, csf, test::gravity_down);
    const std::vector<double> heads = fluid.heads(m.nodes());
    EXPECT_NEAR(heads[0], 15.0 - 8.0, 1e-12);
    EXPECT_EQ(heads[0], heads[1]);
    EXPECT_EQ(fluid.state(0, m.nodes(), heads).air_volume, 0.0);
    EXPECT_NEAR(fluid.state(1, m.nodes(), heads).air_volume, 3200.0, 1e-9);
    // The closed side is under suction above the head: not cut off.
    const Eigen::VectorXd p = fluid.nodal_pressure(m.nodes(), heads);
    EXPECT_NEAR(p[m.node_count() - 1], test::weight * (7.0 - 10.0), 1e-15);
  });
}

}  // namespace
}  // namespace brainshift
