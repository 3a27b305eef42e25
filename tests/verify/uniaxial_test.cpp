// A bar under a weight that slides on it without friction: uniaxial stress, sides free. Every law
// meets its closed form (E = 1, nominal stress P, stretch l, lateral stretch l_t).
#include <ostream>

#include <gtest/gtest.h>

#include "support/scenes.hpp"

namespace brainshift {
namespace {

struct Bar {
  Law law;
  double poisson, stretch, stress, lateral;
};

std::ostream& operator<<(std::ostream& out, const Bar& bar) {
  return out << to_string(bar.law) << " nu " << bar.poisson << " stretch " << bar.stretch;
}

class Uniaxial : public ::testing::TestWithParam<Bar> {};

TEST_P(Uniaxial, MeetsTheClosedForm) {
  const Bar& bar = GetParam();
  const double side = 10.0, length = 20.0, stiff = 1e7;
  const auto box = test::make_box({side, side, length}, 2, 2, 4);
  const auto weight = test::moved(test::make_box({side, side, 5.0}, 2, 2, 1), {0, 0, length});
  Indices regions(std::size_t(box.tets.rows() + weight.tets.rows()), 0);
  std::fill(regions.begin() + box.tets.rows(), regions.end(), 1);
  const Mesh mesh = test::make_mesh(test::joined(box, weight), regions);
  const Index count = Index(box.points.rows());
  const double density = std::abs(bar.stress) / (5.0 * standard_gravity);
  const bool pressed = bar.stress < 0.0;
  Scene scene{mesh,
              {{0, Material(bar.law, 1.0, bar.poisson, 0.0)},
               {1, Material(Law::linear, stiff, 0.0, density)}},
              Vec3(0, 0, pressed ? -standard_gravity : standard_gravity),
              {},
              {}};
  scene.balanced_reference = false;
  const auto on_plane = [&](int axis) {
    return test::nodes_where(mesh, [axis](const Vec3& x) { return x[axis] == 0.0; });
  };
  for (int axis = 0; axis < 3; ++axis) {
    std::array<bool, 3> axes{axis == 0, axis == 1, axis == 2};
    scene.constraints.fix("plane", on_plane(axis), axes);
  }
  Indices top, base, all_of_weight;
  for (Index i = 0; i < count; ++i) {
    if (mesh.nodes()(i, 2) == length) top.push_back(i);
  }
  for (Index i = count; i < mesh.node_count(); ++i) {
    all_of_weight.push_back(i);
    if (mesh.nodes()(i, 2) == length) base.push_back(i);
  }
  scene.constraints.fix("guide", all_of_weight, {true, true, false});
  // The pair holds the weight up on the bar, or (gravity upwards) down under the bar's top face.
  Points normal = Points::Zero(Eigen::Index(top.size()), 3);
  normal.col(2).setConstant(pressed ? 1.0 : -1.0);
  const ConstraintId pair = scene.constraints.opposing("hook", base, top, normal);
  StepperOptions options;
  options.residual_tolerance = 1e-10;
  Stepper stepper(scene, options);
  const SolveReport report = stepper.solve_static();
  ASSERT_TRUE(report.converged()) << report.message;
  // Linear tets hold a uniform strain exactly; what is left is the weight's own softness, 1/stiff,
  // and the tolerance of the solve, measured against the weight's stiffness.
  EXPECT_NEAR(stepper.contact(pair).multiplier.sum(), std::abs(bar.stress) * side * side, 1e-6);
  for (Index i = 0; i < count; ++i) {
    const Vec3 rest = mesh.nodes().row(i).transpose();
    const Vec3 expected(rest.x() * bar.lateral, rest.y() * bar.lateral, rest.z() * bar.stretch);
    EXPECT_LT((stepper.positions().row(i).transpose() - expected).norm(), 1e-5 * length);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table, Uniaxial,
    ::testing::Values(Bar{Law::linear, 0.45, 0.9, -0.1, 1.045},
                      Bar{Law::linear, 0.45, 1.1, 0.1, 0.955},
                      Bar{Law::corotational, 0.45, 0.9, -0.1, 1.045},
                      Bar{Law::corotational, 0.45, 0.7, -0.3, 1.135},
                      Bar{Law::corotational, 0.45, 1.3, 0.3, 0.865},
                      Bar{Law::st_venant_kirchhoff, 0.45, 0.9, -0.0855, 1.04187331},
                      Bar{Law::st_venant_kirchhoff, 0.45, 0.7, -0.1785, 1.10882821},
                      Bar{Law::st_venant_kirchhoff, 0.45, 1.3, 0.4485, 0.83036137},
                      Bar{Law::stable_neo_hookean, 0.45, 0.9, -0.11063810, 1.04822013},
                      Bar{Law::stable_neo_hookean, 0.45, 0.7, -0.43219061, 1.16933611},
                      Bar{Law::stable_neo_hookean, 0.45, 1.3, 0.23952726, 0.88712020},
                      Bar{Law::stable_neo_hookean, 0.499, 0.7, -0.44665345, 1.19471626},
                      Bar{Law::log_neo_hookean, 0.45, 0.7, -0.43393876, 1.17085255},
                      Bar{Law::log_neo_hookean, 0.45, 1.3, 0.23936327, 0.88746858},
                      Bar{Law::log_neo_hookean, 0.3, 0.5, -0.93535206, 1.21076739}));

}  // namespace
}  // namespace brainshift
