// Surface: the smooth distance that contact sees.
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "brainshift/surface.hpp"
#include "contact/distance.hpp"
#include "support/expect_error.hpp"
#include "support/shapes.hpp"

namespace brainshift {
namespace {

using test::expect_error;
using test::make_box_surface;
using test::make_icosphere;
using test::make_sheet;

SurfaceOptions spaced(double spacing, double band = 25.0) {
  SurfaceOptions options;
  options.grid_spacing = spacing;
  options.band = band;
  return options;
}

Surface sphere_cavity(double radius, int subdivisions, const SurfaceOptions& options) {
  auto [points, triangles] = make_icosphere(radius, subdivisions);
  return Surface::cavity(std::move(points), std::move(triangles), options);
}

Vec3 random_direction(std::mt19937& generator) {
  std::normal_distribution<double> number;
  const double x = number(generator), y = number(generator), z = number(generator);
  return Vec3(x, y, z).normalized();
}

double degrees_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / EIGEN_PI;
}

TEST(Surface, OfAFlatSheetIsItsHeightWithUnitGradientEverywhere) {
  const auto sheet = make_sheet(20, 30, 4, 6);
  const Surface surface = Surface::sheet(sheet.points, sheet.triangles, spaced(2.5));
  // Splines reproduce linear functions; points far off the grid included.
  for (const Vec3& p : {Vec3(3, 4, 5), Vec3(10, 15, -20), Vec3(-7, 33, 0.1), Vec3(10, 15, 300),
                        Vec3(-400, 15, -300)}) {
    const auto s = surface.sample(p);
    EXPECT_NEAR(s.distance, p.z(), 1e-10);
    EXPECT_EQ(surface.distance(p), s.distance);
    EXPECT_LT((s.gradient - Vec3(0, 0, 1)).norm(), 1e-11);
    EXPECT_LT(s.hessian.norm(), 1e-11);
  }
}

TEST(Surface, IsExactAtGridPointsWithinTheBand) {
  const auto shape = make_icosphere(40, 3);
  const Surface surface = Surface::cavity(shape.points, shape.triangles, spaced(2.0, 8.0));
  const SurfaceDistance exact(shape.points, shape.triangles, SurfaceKind::cavity);
  // The grid lies symmetrically around the sphere with an even number of cells: its points are at
  // multiples of the spacing from the centre.
  int counted = 0;
  for (int i = -11; i <= 11; ++i)
    for (int j = -11; j <= 11; ++j)
      for (int k = -11; k <= 11; ++k) {
        const Vec3 p = 4.0 * Vec3(i, j, k);
        const double d = exact(p).distance;
        if (std::abs(d) > 8.0) continue;
        ++counted;
        EXPECT_NEAR(surface.distance(p), d, 1e-11);  // rounding in the equations of the spline
      }
  EXPECT_GT(counted, 2000);
}

TEST(Surface, GradientAndHessianAreThoseOfTheValue) {
  const Surface surface = sphere_cavity(30, 2, spaced(4.0));
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> radius(5.0, 36.0);
  for (int n = 0; n < 100; ++n) {
    const Vec3 p = radius(generator) * random_direction(generator);
    const auto s = surface.sample(p);
    EXPECT_EQ(s.hessian, Mat3(s.hessian.transpose()));
    const double h = 1e-4;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = h * Vec3::Unit(axis);
      const auto plus = surface.sample(p + step), minus = surface.sample(p - step);
      // h^2 times third derivatives of order 0.1; rounding 30 epsilon / h. The Hessian of a cubic
      // spline has kinks at cell borders: h times third derivatives.
      EXPECT_NEAR(s.gradient[axis], (plus.distance - minus.distance) / (2 * h), 1e-8);
      EXPECT_LT((s.hessian.col(axis) - (plus.gradient - minus.gradient) / (2 * h)).norm(), 5e-5);
    }
  }
}

TEST(Surface, IsTwiceContinuouslyDifferentiableAcrossCells) {
  const Surface surface = sphere_cavity(30, 2, spaced(4.0));
  const Vec3 direction = Vec3(1, 0.3, 0.2).normalized();
  auto last = surface.sample(4.0 * direction);
  const double step = 1e-3;
  for (double r = 4.0 + step; r < 38.0; r += step) {
    const auto s = surface.sample(r * direction);
    // Third derivatives of this field stay below 0.5 / mm^2 (distances of 1 mm over cells of 4).
    EXPECT_LT((s.hessian - last.hessian).norm(), 0.5 * step) << r;
    last = s;
  }
}

TEST(Surface, ForcesOnASphereTurnWithItAcrossTheEdgesOfTriangles) {
  const double radius = 60.0;
  const auto shape = make_icosphere(radius, 3);
  const Surface surface = Surface::cavity(shape.points, shape.triangles, spaced(2.5));
  std::mt19937 generator(2);
  for (int n = 0; n < 500; ++n) {
    const Vec3 p = (radius - 0.3) * random_direction(generator);
    EXPECT_LT(degrees_between(surface.sample(p).gradient, -p), 5.0);
  }
  // Facets turn by 4 to 5 degrees (edge / radius / sqrt(3)) from one to the next, at once. Along a
  // path across many of them, in steps of 0.006 mm, the direction takes no more than 1 % of that in
  // one step: it spreads the turn over a cell of the grid.
  const double step = 1e-4;
  double most = 0.0;
  Vec3 last = surface.sample(Vec3(radius - 0.3, 0, 0)).gradient;
  for (double angle = step; angle < 1.0; angle += step) {
    const Vec3 p = (radius - 0.3) * Vec3(std::cos(angle), std::sin(angle), 0.0);
    const Vec3 gradient = surface.sample(p).gradient;
    most = std::max(most, degrees_between(gradient, last));
    last = gradient;
  }
  EXPECT_LT(most, 0.05);
}

TEST(Surface, ErrorFallsWithTheOrderOfCubicSplines) {
  const double radius = 40.0;
  const auto shape = make_icosphere(radius, 6);  // sagitta 0.002 mm
  const auto worst = [&](double spacing) {
    const Surface surface = Surface::cavity(shape.points, shape.triangles, spaced(spacing));
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> depth(0.0, 20.0);
    Vec3 error = Vec3::Zero();  // of value (mm), gradient, Hessian (1/mm)
    for (int n = 0; n < 500; ++n) {
      const Vec3 normal = random_direction(generator);
      const double r = radius - depth(generator);
      const auto s = surface.sample(r * normal);
      const Mat3 hessian = -(Mat3::Identity() - normal * normal.transpose()) / r;
      error = error.cwiseMax(Vec3(std::abs(s.distance - (radius - r)), (s.gradient + normal).norm(),
                                  (s.hessian - hessian).norm()));
    }
    return error;
  };
  const Vec3 coarse = worst(10.0), fine = worst(5.0);
  // Orders 4, 3, 2 (Unser 1999), less half an order: the coarse grid is not in the limit yet.
  EXPECT_GT(std::log2(coarse[0] / fine[0]), 3.5);
  EXPECT_GT(std::log2(coarse[1] / fine[1]), 2.5);
  EXPECT_GT(std::log2(coarse[2] / fine[2]), 1.5);
}

TEST(Surface, ValueAndGradientGoOnWithoutAJumpOffTheGrid) {
  const Surface surface = sphere_cavity(30, 3, spaced(2.5));
  const Vec3 direction = Vec3(1, 0.4, -0.3).normalized();
  const double step = 0.01;
  auto last = surface.sample(30.0 * direction);
  for (double r = 30.0 + step; r < 60.0; r += step) {
    const auto s = surface.sample(r * direction);
    EXPECT_NEAR(s.distance, last.distance - step, 0.1 * step) << r;  // slope within 10 % of 1
    EXPECT_LT((s.gradient - last.gradient).norm(), 0.2 * step) << r;
    last = s;
  }
}

TEST(Surface, HasTheRightSignFarBeyondItsBand) {
  const Surface surface = sphere_cavity(60, 3, spaced(2.5, 5.0));
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> radius(0.0, 150.0);
  for (int n = 0; n < 1000; ++n) {
    const double r = radius(generator);
    const Vec3 p = r * random_direction(generator);
    if (std::abs(r - 60.0) < 1.0) continue;  // sagitta of the facets: 0.2 mm
    EXPECT_EQ(surface.distance(p) > 0.0, r < 60.0) << r;
  }
}

TEST(Surface, RefusesWhatIsNotACavityOrASheet) {
  const auto box = make_box_surface({10, 10, 10});
  const auto sheet = make_sheet(10, 10, 2, 2);
  expect_error(ErrorCode::surface_not_closed, {"the cavity is not closed: edge 0-1"},
               [&] { Surface::cavity(sheet.points, sheet.triangles); });
  Triangles inward = box.triangles;
  inward.col(0).swap(inward.col(1));
  expect_error(ErrorCode::invalid_argument, {"face inwards"},
               [&] { Surface::cavity(box.points, inward); });
  Triangles bad = sheet.triangles;
  bad(1, 0) = 77;
  expect_error(ErrorCode::index_out_of_range, {"triangle 1 of the sheet refers to point 77 of 9"},
               [&] { Surface::sheet(sheet.points, bad); });
  Points holes = sheet.points;
  holes(4, 1) = std::nan("");
  expect_error(ErrorCode::not_finite, {"row 4 of points of the sheet"},
               [&] { Surface::sheet(holes, sheet.triangles); });
}

TEST(Surface, RefusesOptionsOutOfRangeAndGridsThatWouldNotFitMemory) {
  const auto box = make_box_surface({150, 190, 150});
  const auto make = [&](double spacing, double band) {
    Surface::cavity(box.points, box.triangles, spaced(spacing, band));
  };
  expect_error(ErrorCode::invalid_argument, {"grid_spacing is 0"}, [&] { make(0.0, 25.0); });
  expect_error(ErrorCode::invalid_argument, {"grid_spacing is nan"},
               [&] { make(std::nan(""), 25.0); });
  expect_error(ErrorCode::invalid_argument, {"band is -1"}, [&] { make(2.5, -1.0); });
  expect_error(ErrorCode::invalid_argument, {"grid_spacing 0.1 mm needs", "150 x 190 x 150"},
               [&] { make(0.1, 25.0); });
  expect_error(ErrorCode::invalid_argument, {"grid points"}, [&] { make(1e-300, 25.0); });
}

}  // namespace
}  // namespace brainshift
