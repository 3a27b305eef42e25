// The reference load: full fluid along the reference gravity.
#include <gtest/gtest.h>

#include "fluid/fluid_scenes.hpp"

namespace brainshift {
namespace {

TEST(ReferenceLoad, EqualsThatOfTheFullFluidBitForBitAtAnyPosition) {
  const test::BallInCavity scene;
  const Hydrostatics fluid(scene.mesh, scene.csf, test::gravity_down);
  for (const Points& x : {scene.mesh.nodes(), test::shaken(scene.mesh, 1.0)}) {
    Points reference = Points::Zero(x.rows(), 3);
    fluid.add_reference_force(x, 1.0, reference);
    EXPECT_TRUE(test::same_bits(reference, test::force_at(fluid, x, fluid.heads(x))));
  }
}

TEST(ReferenceLoad, StaysWhenGravityTurns) {
  test::BallInCavity scene;
  Hydrostatics fluid(scene.mesh, scene.csf, test::gravity_down);
  const Points& x = scene.mesh.nodes();
  Points before = Points::Zero(x.rows(), 3), after = before;
  fluid.add_reference_force(x, 1.0, before);
  fluid.configure(scene.csf, standard_gravity * Vec3(0, -0.6, -0.8));
  fluid.add_reference_force(x, 1.0, after);
  EXPECT_TRUE(test::same_bits(before, after));
  // and the present load follows the new direction
  const Points force = test::force_at(fluid, x, fluid.heads(x));
  const double lift = test::weight * scene.mesh.volume();
  EXPECT_LT((force.colwise().sum().transpose() - lift * Vec3(0, 0.6, 0.8)).norm(), 1e-11 * lift);
}

TEST(ReferenceLoad, AnotherPostureKeepsThePressureAtTheTopOfTheCavity) {
  const Mesh mesh = test::make_mesh(test::make_box({10, 10, 10}, 2, 2, 2));
  const Csf csf(test::fluid_density, FluidModel::separate,
                {test::make_compartment("box", test::box_wall({-5, -5, -5}, {15, 35, 15}),
                                        test::all_faces(mesh))},
                18.0);  // 3 mm above the top at 15
  Hydrostatics fluid(mesh, csf, test::gravity_down);
  EXPECT_EQ(fluid.full_head(), 18.0);
  fluid.configure(csf, Vec3(0, -standard_gravity, 0));  // now y is up, its top at 35
  EXPECT_NEAR(fluid.full_head(), 38.0, 1e-12);
}

}  // namespace
}  // namespace brainshift
