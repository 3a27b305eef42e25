// The fluid on quadratic faces: where edges are straight it is that on linear ones, to rounding.
#include <gtest/gtest.h>

#include "fluid/fluid_scenes.hpp"

namespace brainshift {
namespace {

struct Loads {
  Vec3 force, moment;
};

Loads loads(const test::BallInCavity& scene, double head, const Points& x) {
  const Hydrostatics fluid(scene.mesh, scene.csf, test::gravity_down);
  const Points f = test::force_at(fluid, x, {head});
  Loads sum{Vec3::Zero(), Vec3::Zero()};
  for (Eigen::Index i = 0; i < f.rows(); ++i) {
    sum.force += f.row(i).transpose();
    sum.moment += Vec3(x.row(i).transpose()).cross(Vec3(f.row(i).transpose()));
  }
  return sum;
}

TEST(QuadraticFace, CarriesWhatLinearFacesCarryAtEveryLevel) {
  const test::BallInCavity linear(30.0, 4), quadratic(30.0, 4, 40.0, true);
  const double scale = test::weight * linear.mesh.volume();
  for (double head : {40.0, 29.0, 17.3, 5.0, 0.0, -8.1, -25.0, -31.0}) {
    const Loads a = loads(linear, head, linear.mesh.nodes());
    const Loads b = loads(quadratic, head, quadratic.mesh.nodes());
    EXPECT_LE((a.force - b.force).norm(), 1e-12 * scale) << head;
    EXPECT_LE((a.moment - b.moment).norm(), 1e-12 * scale * 30.0) << head;
  }
}

TEST(QuadraticFace, BuoyancyOfAFullySubmergedBodyIsTheWeightOfItsVolume) {
  const test::BallInCavity scene(30.0, 4, 40.0, true);
  const Loads l = loads(scene, 40.0, scene.mesh.nodes());
  const double weight = test::weight * scene.mesh.volume();
  EXPECT_LE((l.force - Vec3(0, 0, weight)).norm(), 1e-12 * weight);
  EXPECT_LE(l.moment.norm(), 1e-12 * weight * 30.0);
}

// A constant pressure on a flat face: nothing on its corners, a third on each edge.
TEST(QuadraticFace, AConstantPressureLeavesTheCornersFree) {
  const auto box = test::make_box({10, 10, 10}, 1, 1, 1);
  const Mesh mesh = test::make_mesh(box).quadratic();
  const double head = 1e7;
  const Csf csf(test::fluid_density, FluidModel::separate,
                {test::make_compartment("all", test::box_wall({-1, -1, -1}, {11, 11, 11}),
                                        test::all_faces(mesh))},
                head);
  const Hydrostatics fluid(mesh, csf, test::gravity_down);
  const Points f = test::force_at(fluid, mesh.nodes(), {head});
  const double pressure = test::weight * head;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    if (mesh.is_corner(i)) {
      EXPECT_LE(f.row(i).norm(), 1e-5 * pressure * 100.0);  // the gradient alone: 10 mm of 1e7
      continue;
    }
    const Vec3 x = mesh.nodes().row(i).transpose();
    for (int axis = 0; axis < 3; ++axis) {
      const bool on_face = x[axis] == 0.0 || x[axis] == 10.0;
      if (!on_face) {
        EXPECT_LE(std::abs(f(i, axis)), 1e-5 * pressure * 100.0);
      }
    }
  }
}

// Sweeping the level through bent faces: neither the force nor its slope jumps.
TEST(QuadraticFace, ForceAndSlopeAreContinuousInTheLevel) {
  const test::BallInCavity scene(30.0, 2, 40.0, true);
  const Points x = test::shaken(scene.mesh, 1.0);
  const Hydrostatics fluid(scene.mesh, scene.csf, test::gravity_down);
  const int steps = 1000;
  const double from = -33.0, to = 33.0, step = (to - from) / steps;
  const auto at = [&](int i) {
    const Points f = test::force_at(fluid, x, {from + step * i});
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(f.data(), f.size()));
  };
  Eigen::VectorXd before = at(0), slope_before = Eigen::VectorXd::Zero(before.size());
  double largest_slope = 0.0, largest_turn = 0.0;
  for (int i = 1; i <= steps; ++i) {
    const Eigen::VectorXd now = at(i), slope = (now - before) / step;
    largest_slope = std::max(largest_slope, slope.cwiseAbs().maxCoeff());
    largest_turn = std::max(largest_turn, (slope - slope_before).cwiseAbs().maxCoeff());
    before = now;
    slope_before = slope;
  }
  // A jump of the force would be a slope of 1/step, one of the slope as large as the slope itself.
  EXPECT_LT(largest_slope, test::weight * 4.0 * 900.0);  // less than the ball's surface at once
  EXPECT_LT(largest_turn, 0.05 * largest_slope);
}

}  // namespace
}  // namespace brainshift
