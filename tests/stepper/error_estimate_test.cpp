// The error estimate: exact where the problem is linear, near the truth where it is not.
#include <cstdio>

#include <gtest/gtest.h>

#include "support/elements.hpp"
#include "support/expect_error.hpp"
#include "support/scenes.hpp"

namespace brainshift {
namespace {

Indices where_zero(const Mesh& mesh, int axis) {
  return test::nodes_where(mesh, [axis](const Vec3& x) { return x[axis] == 0.0; });
}

Scene bar(Law law, double gravity) {
  Scene scene{test::make_mesh(test::make_box({80, 20, 20}, 8, 2, 2)),
              {{0, Material(law, 6.0, 0.45, test::tissue_density)}},
              Vec3(0, 0, -gravity * standard_gravity),
              {},
              {}};
  scene.balanced_reference = false;
  scene.constraints.fix("wall", where_zero(scene.mesh, 0));
  return scene;
}

struct Compared {
  double error, estimate, left;  // mm at the tip: true, estimated, between the two corrections
};

Compared compare(const Scene& scene, const Vec3& point) {
  StepperOptions options;
  options.residual_tolerance = 1e-11;
  Stepper linear(scene, options), fine(quadratic(scene), options);
  EXPECT_TRUE(linear.solve_static().converged());
  EXPECT_TRUE(fine.solve_static().converged());
  const Points at = point.transpose();
  const ErrorEstimate estimate = linear.estimate_error(at);
  const Vec3 truth =
      (fine.displacement_at(at).values - linear.displacement_at(at).values).transpose();
  std::printf("estimate %.4f mm of %.4f mm, %d iterations\n", estimate.error[0], truth.norm(),
              estimate.iterations);
  return {truth.norm(), estimate.error[0], (estimate.correction.row(0).transpose() - truth).norm()};
}

TEST(ErrorEstimate, IsExactForALinearProblem) {
  for (VolumeStrain volume : {VolumeStrain::element, VolumeStrain::nodal}) {
    Scene scene = bar(Law::linear, 0.02);
    scene.volume_strain = volume;
    const Compared c = compare(scene, {80, 10, 10});
    EXPECT_GT(c.error, 0.1);
    EXPECT_LE(c.left, 1e-3 * c.error);  // conjugate gradients stop at 1e-4
  }
}

TEST(ErrorEstimate, CoversTheErrorOfAStronglyBentBarWithinAFactorOfTwo) {
  const Compared c = compare(bar(Law::corotational, 0.2), {80, 10, 10});
  EXPECT_LE(c.estimate, 2.0 * c.error);
  EXPECT_GE(c.estimate, 0.5 * c.error);
}

TEST(ErrorEstimate, SeesFluidAndContact) {
  Scene scene = test::busy_scene(4, 0.05);
  scene.balanced_reference = false;
  scene.gravity = Vec3(0, 0, -standard_gravity);
  scene.csf->set_lost_volume(0, 6000.0);
  // Corners and edge nodes do not touch in the same places: with the contacts of the linear tets the
  // estimate would be half of the error.
  const Compared c = compare(scene, {15, 15, 30});
  EXPECT_LE(c.estimate, 1.2 * c.error);
  EXPECT_GE(c.estimate, c.error / 1.2);
}

TEST(ErrorEstimate, NoErrorNoEstimate) {
  // Pressed evenly: linear tets are exact.
  Scene scene = bar(Law::linear, 0.0);
  Stepper stepper(scene);
  ASSERT_TRUE(stepper.solve_static().converged());
  Points at(2, 3);
  at << 80, 10, 10, 99, 99, 99;
  const ErrorEstimate estimate = stepper.estimate_error(at);
  EXPECT_EQ(estimate.error[0], 0.0);
  EXPECT_TRUE(std::isnan(estimate.error[1]));
}

TEST(ErrorEstimate, IsRefusedInMotion) {
  Stepper stepper(bar(Law::linear, 0.02));
  ASSERT_TRUE(stepper.step(0.01).converged());
  test::expect_error(ErrorCode::invalid_argument, {"at rest"},
                     [&] { stepper.estimate_error(Points::Zero(1, 3)); });
}

TEST(ErrorEstimate, IsRefusedOnQuadraticTets) {
  const Stepper stepper(quadratic(bar(Law::linear, 0.0)));
  test::expect_error(ErrorCode::invalid_argument, {"linear tets"},
                     [&] { stepper.estimate_error(Points::Zero(1, 3)); });
}

}  // namespace
}  // namespace brainshift
