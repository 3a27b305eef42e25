// Uniform pressure all round that follows the surface: a fluid whose level is far above the body.
// nu = 0.45, p = K/10; stretch s per law.
#include <gtest/gtest.h>

#include "support/scenes.hpp"

namespace brainshift {
namespace {

double stretch(Law law) {
  const Mesh mesh = test::make_mesh(test::make_box({1, 1, 1}, 2, 2, 2));
  const Material material(law, 6.0, 0.45, 0.0);
  const double p = 0.1 * material.bulk();
  // density g head = p; over the height of the body the pressure changes by 1e-9 of itself. It has to
  // be that little: at p = K/10 the Saint-Venant-Kirchhoff cube is next to losing its shear stiffness
  // (mu s = 2.001 against p = 2) and shows any unevenness 300 times larger.
  const double head = 1e9;
  const double density = p / (standard_gravity * head);
  Scene scene{mesh,
              {{0, material}},
              Vec3(0, 0, -standard_gravity),
              Csf(density, FluidModel::separate,
                  {test::make_compartment("all", test::box_wall({-2, -2, -2}, {3, 3, 3}),
                                          test::all_faces(mesh))},
                  head),
              {}};
  scene.balanced_reference = false;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<bool, 3> axes{axis == 0, axis == 1, axis == 2};
    scene.constraints.fix(
        "plane", test::nodes_where(mesh, [axis](const Vec3& x) { return x[axis] == 0.0; }), axes);
  }
  Stepper stepper(scene);
  const SolveReport report = stepper.solve_static();
  EXPECT_TRUE(report.converged()) << report.message;
  const Indices far = test::nodes_where(mesh, [](const Vec3& x) { return x == Vec3(1, 1, 1); });
  return 1.0 + test::mean_row(stepper.displacement(), far).mean();
}

// 1e-9 * 300 of unevenness, and the digits of the table
TEST(FollowerPressure, StVenantKirchhoff) {
  EXPECT_NEAR(stretch(Law::st_venant_kirchhoff), 0.96722207, 1e-6);
}
TEST(FollowerPressure, Corotational) { EXPECT_NEAR(stretch(Law::corotational), 0.96871942, 1e-6); }
TEST(FollowerPressure, StableNeoHookean) {
  EXPECT_NEAR(stretch(Law::stable_neo_hookean), 0.96539973, 1e-6);
}
TEST(FollowerPressure, LogNeoHookean) {
  EXPECT_NEAR(stretch(Law::log_neo_hookean), 0.96997687, 1e-6);
}
TEST(FollowerPressure, LinearLawFeelsThePressureOnItsShrunkenFaces) {
  // Small strain with a following load: 3K(1 - s) = p s^2, between the dead load's 0.96666667 and 1.
  const double s = (-3.0 + std::sqrt(9.0 + 4.0 * 0.1 * 3.0)) / (2.0 * 0.1);
  EXPECT_NEAR(stretch(Law::linear), s, 1e-6);
}

}  // namespace
}  // namespace brainshift
