// A column under its own weight, laterally confined: the solver from end to end
// against closed forms. M = lambda + 2 mu, c = density g H / M; only M enters them.
//
// nu = 0.2: a confined Saint-Venant-Kirchhoff body also buckles in vertical shear, where
// mu l^2 + lambda (l^2 - 1)/2 = 0 for the vertical stretch l. At nu = 0.45 that happens at l = 0.90
// (c = 0.08), long before the limit point at l = 1/sqrt(3) this is about; at nu = 0.2 never before.
#include <gtest/gtest.h>

#include "support/scenes.hpp"
#include "tissue/tissue.hpp"

namespace brainshift {
namespace {

constexpr double height = 100.0, width = 20.0, young = 6.0, poisson = 0.2;

// A column whose weight makes the given c.
Scene column(Law law, double c, int layers) {
  const Mesh mesh = test::make_mesh(test::make_box({width, width, height}, 2, 2, layers));
  const Material unit(law, young, poisson, 0.0);
  const double modulus = unit.lambda() + 2.0 * unit.mu();
  const double density = c * modulus / (standard_gravity * height);
  Scene scene{
      mesh, {{0, Material(law, young, poisson, density)}}, Vec3(0, 0, -standard_gravity), {}, {}};
  scene.balanced_reference = false;
  scene.constraints.fix("no lateral motion", test::all_nodes(mesh), {true, true, false});
  scene.constraints.fix("base",
                        test::nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; }));
  return scene;
}

// Mean settlement of the top over the height.
double tip(const Stepper& stepper) {
  const Indices top =
      test::nodes_where(stepper.mesh(), [](const Vec3& x) { return x.z() == height; });
  return test::mean_row(stepper.displacement(), top).z() / height;
}

TEST(GravityColumn, LinearLawSettlesByHalfC) {
  // u_z(H)/H = -c/2; the mean over the top is good to O(h^2), 1/20^2 of a parabola's part.
  Stepper stepper(column(Law::linear, 0.1, 20));
  const SolveReport report = stepper.solve_static();
  ASSERT_TRUE(report.converged()) << report.message;
  EXPECT_NEAR(tip(stepper), -0.05, 5e-5);
}

TEST(GravityColumn, LinearLawFollowsTheParabolaAtEveryHeight) {
  Stepper stepper(column(Law::linear, 0.1, 20));
  ASSERT_TRUE(stepper.solve_static().converged());
  for (Index i = 0; i < stepper.mesh().node_count(); ++i) {
    const double z = stepper.mesh().nodes()(i, 2) / height;
    // 1 % of the tip's settlement: at the lateral faces the load of a node is not that of its height
    EXPECT_NEAR(stepper.displacement()(i, 2) / height, -0.1 * (z - 0.5 * z * z), 1e-2 * 0.05);
  }
}

TEST(GravityColumn, StVenantKirchhoffSettlesByTheClosedForm) {
  const double table[][2] = {
      {0.05, -0.02639442}, {0.10, -0.05638490}, {0.15, -0.09226708}, {0.19, -0.13070422}};
  for (const auto& [c, settled] : table) {
    Stepper stepper(column(Law::st_venant_kirchhoff, c, 40));
    const SolveReport report = stepper.solve_static();
    ASSERT_TRUE(report.converged()) << c << ": " << report.message;
    EXPECT_NEAR(tip(stepper), settled, 2e-3 * std::abs(settled)) << c;
    EXPECT_LE(report.residual, 1e-8);
    EXPECT_GT(report.smallest_jacobian, 0.57) << c;  // 1/sqrt(3) is the limit point
  }
}

TEST(GravityColumn, StVenantKirchhoffErrorFallsWithTheSquareOfTheLayer) {
  double error[3];
  const int layers[3] = {10, 20, 40};
  for (int i = 0; i < 3; ++i) {
    Stepper stepper(column(Law::st_venant_kirchhoff, 0.10, layers[i]));
    ASSERT_TRUE(stepper.solve_static().converged());
    error[i] = std::abs(tip(stepper) + 0.05638490);
  }
  EXPECT_GT(error[0] / error[1], 3.0);
  EXPECT_GT(error[1] / error[2], 3.0);
}

TEST(GravityColumn, BeyondTheLimitPointThereIsNoEquilibriumAndTheStateStays) {
  // Closed form: no solution for c > 1/(3 sqrt 3) = 0.19245.
  Stepper stepper(column(Law::st_venant_kirchhoff, 0.20, 20));
  const Points before = stepper.displacement();
  const SolveReport report = stepper.solve_static();
  EXPECT_EQ(report.status, Status::no_equilibrium) << to_string(report.status);
  EXPECT_FALSE(report.message.empty());
  EXPECT_GT(report.load_factor, 0.85);  // 0.19245 / 0.20 = 0.96, less a coarse mesh's share
  EXPECT_LT(report.load_factor, 1.0);
  EXPECT_TRUE(test::same_bits(before, stepper.displacement()));
}

TEST(GravityColumn, FarBeyondTheLimitPointNothingIsNaN) {
  Stepper stepper(column(Law::st_venant_kirchhoff, 2.0, 10));
  const SolveReport report = stepper.solve_static();
  EXPECT_FALSE(report.converged());
  EXPECT_TRUE(stepper.displacement().isZero(0.0));
  EXPECT_TRUE(std::isfinite(report.residual));
}

// Pulled so hard that the first Newton step, of stretch 1e78, has an energy beyond double (it grows
// with the fourth power of the stretch): no iterate may be there.
TEST(GravityColumn, AStepOfInfiniteEnergyIsNeverTaken) {
  Scene scene = column(Law::st_venant_kirchhoff, 1.0, 4);
  scene.gravity *= -1e78;
  const Tissue tissue(scene.mesh, scene.materials);
  Stepper stepper(scene);
  stepper.begin_static();
  while (stepper.phase() == StepPhase::begun || stepper.phase() == StepPhase::updated) {
    ASSERT_TRUE(std::isfinite(tissue.energy(stepper.iterate())));
    stepper.linearise();
    stepper.solve();
    stepper.update();
  }
  EXPECT_EQ(stepper.phase(), StepPhase::failed);
}

TEST(GravityColumn, LateralConfinementHasNoLimitPointForStableNeoHookean) {
  Stepper stepper(column(Law::stable_neo_hookean, 0.4, 10));
  const SolveReport report = stepper.solve_static();
  EXPECT_TRUE(report.converged()) << report.message;
}

// P(l) = mu (l - 1/l) + lambda ln l / l of the vertical stretch l carries what stands above:
// P(l(Z)) = -c M (1 - Z), and the top sinks by the mean of 1 - l.
double log_neo_hookean_settlement(double c) {
  const Material unit(Law::log_neo_hookean, young, poisson, 0.0);
  const double mu = unit.mu(), lambda = unit.lambda(), modulus = lambda + 2.0 * mu;
  constexpr int points = 2000;  // midpoint rule, error 1e-7
  double sum = 0.0;
  for (int i = 0; i < points; ++i) {
    const double carried = c * modulus * (1.0 - (i + 0.5) / points);
    double low = 1e-9, high = 1.0;  // P grows with l below l = e
    for (int k = 0; k < 100; ++k) {
      const double l = 0.5 * (low + high);
      const double P = mu * (l - 1.0 / l) + lambda * std::log(l) / l;
      (P < -carried ? low : high) = l;
    }
    sum += low - 1.0;
  }
  return sum / points;
}

TEST(GravityColumn, LogNeoHookeanSettlesByTheClosedFormAtAnyLoad) {
  for (const double c : {0.1, 0.4, 2.0, 10.0}) {
    Stepper stepper(column(Law::log_neo_hookean, c, 40));
    const SolveReport report = stepper.solve_static();
    ASSERT_TRUE(report.converged()) << c << ": " << report.message;
    const double settled = log_neo_hookean_settlement(c);
    // the bound of the table above, where the same layers carry an error of O(h^2)
    EXPECT_NEAR(tip(stepper), settled, 2e-3 * std::abs(settled)) << c;
    EXPECT_LE(report.residual, 1e-8);
    EXPECT_GT(report.smallest_jacobian, 0.0);
  }
}

// Loads under which the volume all but vanishes: balance, or a status that says there is none; and no
// iterate on the way without volume or without a finite energy.
TEST(GravityColumn, NoLoadMakesALogarithmicLawInvertOrNaN) {
  for (const double c : {1e2, 1e4, 1e8, 1e16, 1e150}) {
    const Scene scene = column(Law::log_neo_hookean, c, 5);
    const Tissue tissue(scene.mesh, scene.materials);
    Stepper stepper(scene);
    stepper.begin_static();
    while (stepper.phase() == StepPhase::begun || stepper.phase() == StepPhase::updated) {
      ASSERT_GT(tissue.jacobians(stepper.iterate()).minCoeff(), 0.0) << c;
      ASSERT_TRUE(std::isfinite(tissue.energy(stepper.iterate()))) << c;
      stepper.linearise();
      stepper.solve();
      stepper.update();
    }
    const SolveReport& report = stepper.progress_report();
    ASSERT_FALSE(std::isnan(report.residual)) << c;
    if (stepper.phase() == StepPhase::converged) {
      EXPECT_LE(report.residual, 1e-8) << c;
      EXPECT_GT(report.smallest_jacobian, 0.0) << c;
    } else {
      EXPECT_FALSE(report.converged()) << c;
      EXPECT_FALSE(report.message.empty()) << c;
    }
    stepper.reject();
    EXPECT_TRUE(stepper.displacement().isZero(0.0)) << c;
  }
}

}  // namespace
}  // namespace brainshift
