// Builds with CHOLMOD and without have the same results: both are held to the numbers recorded here, by
// the build with CHOLMOD (Debian 12), to half of 1e-9 relative to the largest motion.
#include <cmath>
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>

#include "support/scenes.hpp"

namespace brainshift {
namespace {

TEST(Builds, WithEverySolverHaveTheSameResults) {
  StepperOptions options;
  options.residual_tolerance = options.complementarity_tolerance = 1e-12;
  options.correction_tolerance = 1e-13;
  Stepper s(test::busy_scene(4, 0.3), options);
  s.csf().set_lost_volume(0, 4000.0);
  s.set_gravity(standard_gravity * Vec3(0.2, -0.3, -0.9));
  ASSERT_TRUE(s.solve_static().converged());
  const Hold wire{std::numeric_limits<double>::infinity(), 25.0};
  const DeviceId id =
      s.insert(make_device("3389", 25.0), {{14.0, 16.0, 8.0}, {0.0, 0.0, 1.0}}, wire);
  s.csf().set_lost_volume(0, 9000.0);
  const SolveReport report = s.solve_static();
  ASSERT_TRUE(report.converged()) << report.message;
  EXPECT_LE(report.residual, 1e-12);

  const Points points = (Points(3, 3) << 5, 5, 5, 15, 15, 15, 26, 14, 29).finished();
  const Points u = s.displacement_at(points).values;
  const DeviceState d = s.device(id);
  const double found[] = {u(0, 0),       u(0, 1),       u(0, 2),      u(1, 0), u(1, 1),
                          u(1, 2),       u(2, 0),       u(2, 1),      u(2, 2), d.bow,
                          d.nodes(0, 0), d.nodes(0, 1), d.nodes(0, 2)};
  const double recorded[] = {0.151489475683164,  -0.36946737745207,  -0.21775375848342,
                             0.282336672771449,  -0.397566090099756, -0.302439826462567,
                             0.346695998121032,  -0.471921465960777, -0.358889056505309,
                             0.0756665571341301, 14.0039725855623,   15.9754931494046,
                             8.00061731944649};
  const double tolerance = 0.5e-9 * s.displacement().cwiseAbs().maxCoeff();
  for (std::size_t i = 0; i < std::size(found); ++i) {
    EXPECT_NEAR(found[i], recorded[i], tolerance) << i;
  }
  if (testing::Test::HasFailure()) {
    for (double value : found) std::printf("%.15g,\n", value);
  }
}

}  // namespace
}  // namespace brainshift
