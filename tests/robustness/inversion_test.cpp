// Steps so large that tets would turn inside out, turns of half a circle, bodies pressed flat.
#include <Eigen/Geometry>

#include "robustness/outcome.hpp"
#include "stepper/solve.hpp"
#include "support/laws.hpp"
#include "support/leaning_block.hpp"
#include "tissue/tissue.hpp"

namespace brainshift::test {
namespace {

// The linear step moves nodes by many times the size of a tet: it is cut, and cut again.
TEST(Inversion, I1_a_load_whose_first_step_goes_through_the_opposite_face) {
  for (const Law law : all_laws) {
    if (law == Law::linear) continue;  // its answer to such a load means nothing
    Scene scene = cube_on_base(law, {0, 0, -30.0 * standard_gravity});
    Stepper stepper(scene);
    stepper.begin_static();
    while (stepper.phase() == StepPhase::begun || stepper.phase() == StepPhase::updated) {
      stepper.linearise();
      stepper.solve();
      stepper.update();
      const Tissue tissue(scene.mesh, scene.materials);
      ASSERT_GT(tissue.jacobians(stepper.iterate()).minCoeff(), 0.0) << to_string(law);
    }
    expect_converged_or_failed(stepper.progress_report());
    stepper.reject();
    EXPECT_TRUE(stepper.displacement().isZero(0.0));
  }
}

// A step of the linear law far beyond its validity: never converged with det F <= 0.
TEST(Inversion, I1_the_linear_law_is_no_excuse) {
  Stepper stepper(cube_on_base(Law::linear, {0, 0, -100.0 * standard_gravity}));
  expect_converged_or_failed(stepper.solve_static());
}

TEST(Inversion, I2_a_solve_handed_an_inverted_state_recovers_or_names_the_tet) {
  for (const Law law : nonlinear_laws) {
    Scene scene = cube_on_base(law, {0, 0, -standard_gravity}, 2, 0.3);
    MechanicalState state{Points::Zero(27, 3), {}, {}};
    state.u(13, 0) = 14.0;  // the node in the middle, out through a side
    const StepperOptions options;
    FactorCache cache;
    Solve solve(Equilibrium(scene), {}, state, options, cache, {});
    while (solve.phase() == StepPhase::begun || solve.phase() == StepPhase::updated) {
      solve.linearise();
      solve.solve();
      solve.update();
    }
    if (solve.report().converged()) {
      expect_converged(solve.report());
    } else {
      EXPECT_NE(solve.report().message.find("tet "), std::string::npos) << solve.report().message;
    }
    EXPECT_EQ(solve.report().converged(), allows_inversion(law)) << to_string(law);
  }
}

TEST(Inversion, I3_a_rigid_turn_by_any_angle_stores_nothing) {
  const Mesh mesh = make_mesh(make_box({20, 20, 20}, 2, 2, 2));
  for (const Law law : nonlinear_laws) {
    const Tissue tissue(mesh, {{0, Material(law, 6.0, 0.45, 0.0)}});
    for (const double degrees : {10.0, 90.0, 179.9999999, 180.0, 270.0}) {
      for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(1, 2, 3)}) {
        const Mat3 R =
            Eigen::AngleAxisd(degrees * EIGEN_PI / 180.0, axis.normalized()).toRotationMatrix();
        const Points u = mesh.nodes() * (R - Mat3::Identity()).transpose();
        const Points force = tissue.response(u).force;
        EXPECT_LE(std::abs(tissue.energy(u)), 1e-20 * 6.0 * 8000.0 * 1e6) << to_string(law);
        EXPECT_LE(largest(force), 1e-12 * 6.0 * 20.0 * 20.0) << to_string(law) << degrees;
      }
    }
  }
}

// A cannula enters along its line and pushes nothing aside; what moves it against tissue is a change
// of load. That change is huge here: the lean of a whole g at once, against a rigid rod.
TEST(Inversion, I4_tissue_thrown_against_a_rigid_cannula) {
  Stepper stepper(leaning_block(0.0));
  const Points before = stepper.displacement();
  stepper.insert(make_device("cannula", device_length), {lead_tip, lead_outward}, whole());
  EXPECT_TRUE(same_bits(stepper.displacement(), before));
  for (const double lean : {0.05, 0.5}) {
    stepper.set_gravity(leaning(lean));
    const ShownState state(stepper);
    const SolveReport report = stepper.solve_static();
    expect_converged_or_failed(report);
    if (report.converged()) {
      EXPECT_LE(report.tie_gap, 1e-8);
    } else {
      EXPECT_TRUE(ShownState(stepper) == state);
    }
  }
}

// A ball of tissue pressed onto a floor by its weight, a quarter of it for its symmetry.
Scene ball_on_floor(Law law, double factor) {
  Scene scene{make_mesh(moved(make_ball(15.0, 4), {0, 0, 15.0})),
              {{0, Material(law, 6.0, 0.3, factor * tissue_density)}}};
  scene.balanced_reference = false;
  const auto on = [&](int axis) {
    return nodes_where(scene.mesh, [axis](const Vec3& x) { return std::abs(x[axis]) < 1e-9; });
  };
  scene.constraints.fix("x", on(0), {true, false, false});
  scene.constraints.fix("y", on(1), {false, true, false});
  const auto floor = moved(make_sheet(120, 120, 4, 4), {-60, -60, 0});
  scene.constraints.obstacle("floor", surface_nodes(scene.mesh),
                             Surface::sheet(floor.points, floor.triangles));
  return scene;
}

// The logarithmic law gets to half the height and below. The other two have a finite energy at J = 0,
// and a body that collapses has no equilibrium with them: said, at the part of the load that has.
TEST(Inversion, I5_a_ball_pressed_to_half_its_height) {
  for (const Law law : {Law::stable_neo_hookean, Law::log_neo_hookean, Law::st_venant_kirchhoff}) {
    double height = 30.0;
    bool failed = false;
    for (double factor = 1.0; factor < 2000.0 && height > 15.0 && !failed; factor *= 2.0) {
      Stepper stepper(ball_on_floor(law, factor));
      const SolveReport report = stepper.solve_static();
      failed = !report.converged();
      if (failed) {
        expect_failed(report);
        continue;
      }
      expect_converged(report);
      EXPECT_LE(report.violation, 1e-9 * 30.0);
      height = stepper.positions().col(2).maxCoeff();
      const double weight = stepper.gravity_force().col(2).sum();
      EXPECT_NEAR(stepper.contact(2).force.col(2).sum(), -weight, 1e-6 * std::abs(weight));
    }
    std::printf("I5: %s: least height %.1f of 30 mm%s\n", to_string(law), height,
                failed ? ", then no equilibrium" : "");
    EXPECT_TRUE(failed || height <= 15.0);
    EXPECT_EQ(failed, law != Law::log_neo_hookean) << to_string(law);
    EXPECT_LE(height, 26.0) << to_string(law);
  }
}

}  // namespace
}  // namespace brainshift::test
