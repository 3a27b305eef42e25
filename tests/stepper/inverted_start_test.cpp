// A solve that is handed a state without volume.
#include <limits>

#include <gtest/gtest.h>

#include "stepper/solve.hpp"
#include "support/laws.hpp"
#include "support/scenes.hpp"

namespace brainshift {
namespace {

// A cube held at its base, of which the node in the middle has been moved out through the top.
struct Inverted {
  Scene scene;
  MechanicalState state;

  explicit Inverted(Law law)
      : scene{test::make_mesh(test::make_box({20, 20, 20}, 2, 2, 2)),
              {{0, Material(law, 6.0, 0.3, test::tissue_density)}},
              Vec3(0, 0, -standard_gravity),
              {},
              {}} {
    scene.constraints.fix(
        "base", test::nodes_where(scene.mesh, [](const Vec3& x) { return x.z() == 0.0; }));
    state.u = Points::Zero(scene.mesh.node_count(), 3);
    const Indices middle =
        test::nodes_where(scene.mesh, [](const Vec3& x) { return x == Vec3(10, 10, 10); });
    state.u(middle.front(), 2) = 15.0;
  }
};

SolveReport run(const Inverted& start) {
  const StepperOptions options;
  FactorCache cache;
  Solve solve(Equilibrium(start.scene), {}, start.state, options, cache, {});
  while (solve.phase() == StepPhase::begun || solve.phase() == StepPhase::updated) {
    solve.linearise();
    solve.solve();
    solve.update();
  }
  return solve.report();
}

TEST(InvertedStart, RecoversWithLawsThatAllowInversion) {
  for (const Law law : test::all_laws) {
    if (!test::allows_inversion(law)) continue;
    const SolveReport report = run(Inverted(law));
    EXPECT_TRUE(report.converged()) << to_string(law) << ": " << report.message;
    EXPECT_GT(report.smallest_jacobian, 0.0) << to_string(law);
  }
}

TEST(InvertedStart, IsRefusedWhereTheLawHasNoEnergyAndTheTetIsNamed) {
  const Inverted start(Law::log_neo_hookean);
  const SolveReport report = run(start);
  EXPECT_EQ(report.status, Status::no_equilibrium);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(report.residual, std::numeric_limits<double>::infinity());
  EXPECT_EQ(report.energy, std::numeric_limits<double>::infinity());
  Eigen::Index tet;
  const Tissue tissue(start.scene.mesh, start.scene.materials);
  EXPECT_EQ(report.smallest_jacobian, tissue.jacobians(start.state.u).minCoeff(&tet));
  EXPECT_LT(report.smallest_jacobian, 0.0);
  EXPECT_NE(report.message.find("tet " + std::to_string(tet) + ","), std::string::npos)
      << report.message;
}

}  // namespace
}  // namespace brainshift
