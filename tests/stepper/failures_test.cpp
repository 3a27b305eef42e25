// Scenes that cannot be, and solves that cannot end: which error, naming whom.
#include <gtest/gtest.h>

#include "brainshift/error.hpp"
#include "support/scenes.hpp"

namespace brainshift {
namespace {

Scene block() {
  Scene scene{test::make_mesh(test::make_box({20, 20, 20}, 2, 2, 2)),
              {{0, Material(Law::corotational, 6.0, 0.45, test::tissue_density)}},
              Vec3(0, 0, -standard_gravity),
              {},
              {}};
  scene.balanced_reference = false;
  return scene;
}

Indices bottom(const Mesh& mesh) {
  return test::nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; });
}

template <class Call>
void expect_error(ErrorCode code, const std::string& word, Call&& call) {
  try {
    call();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& e) {
    EXPECT_EQ(to_string(e.code()), std::string(to_string(code))) << e.what();
    EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
  }
}

// Rounding of the forces in a hard inclusion grows with its modulus; the load of the soft part must not be
// taken for such rounding before anything has moved.
TEST(Failures, ALoadIsNotHiddenByAHardInclusion) {
  const test::TetShape shape = test::make_box({30, 30, 30}, 3, 3, 3);
  Indices regions(std::size_t(shape.tets.rows()), 0);
  for (std::size_t t = 6 * 13; t < 6 * 14; ++t) regions[t] = 1;  // the cell in the middle
  for (const double ratio : {1e4, 1e8, 1e14, 1e16}) {
    for (const bool fine : {false, true}) {
      Scene scene{test::make_mesh(shape, regions),
                  {{0, Material(Law::linear, 6.0, 0.45, test::tissue_density)},
                   {1, Material(Law::linear, 6.0 * ratio, 0.45, test::tissue_density)}},
                  Vec3(1e3, 0, -3e3)};
      scene.balanced_reference = false;
      scene.constraints.fix("base", bottom(scene.mesh));
      Stepper stepper(fine ? quadratic(scene) : scene);
      const SolveReport report = stepper.solve_static();
      const double moved = stepper.displacement().cwiseAbs().maxCoeff();
      EXPECT_TRUE(report.converged() || ratio > 1e8) << report.message;
      EXPECT_NEAR(moved, report.converged() ? (fine ? 0.4 : 0.27) : 0.0, 0.02) << ratio;
    }
  }
}

TEST(Failures, ABodyThatNothingHolds) {
  expect_error(ErrorCode::rigid_mode, "6 rigid", [] { Stepper(block()).solve_static(); });
}

TEST(Failures, ABodyHeldAtOnePointTurns) {
  Scene scene = block();
  scene.constraints.fix("point", {0});
  expect_error(ErrorCode::rigid_mode, "3 rigid", [&] { Stepper(scene).solve_static(); });
}

TEST(Failures, ABodyHeldAlongALineTurnsAboutIt) {
  Scene scene = block();
  scene.constraints.fix("edge", test::nodes_where(scene.mesh, [](const Vec3& x) {
                          return x.x() == 0.0 && x.y() == 0.0;
                        }));
  expect_error(ErrorCode::rigid_mode, "1 rigid", [&] { Stepper(scene).solve_static(); });
}

TEST(Failures, TheSecondBodyIsNamedWhenItIsLoose) {
  Scene scene = block();
  scene.mesh =
      test::make_mesh(test::joined(test::make_box({20, 20, 20}, 2, 2, 2),
                                   test::moved(test::make_box({20, 20, 20}, 2, 2, 2), {30, 0, 0})));
  scene.constraints.fix("base", test::nodes_where(scene.mesh, [](const Vec3& x) {
                          return x.z() == 0.0 && x.x() < 25.0;
                        }));
  expect_error(ErrorCode::rigid_mode, "body 1", [&] { Stepper(scene).solve_static(); });
}

TEST(Failures, ATieHoldsTheSecondBody) {
  Scene scene = block();
  scene.mesh =
      test::make_mesh(test::joined(test::make_box({20, 20, 20}, 2, 2, 2),
                                   test::moved(test::make_box({20, 20, 20}, 2, 2, 2), {20, 0, 0})));
  scene.constraints.fix("base", test::nodes_where(scene.mesh, [](const Vec3& x) {
                          return x.z() == 0.0 && x.x() < 15.0;
                        }));
  const auto [left, right] = test::seam(scene.mesh, 27);
  const ConstraintId tie = scene.constraints.tie("seam", left, right);
  Stepper stepper(scene);
  EXPECT_TRUE(stepper.solve_static().converged());
  // Without it the solve refuses and leaves the state as it was.
  const Points u = stepper.displacement();
  stepper.disable(tie);
  expect_error(ErrorCode::rigid_mode, "body 1", [&] { stepper.solve_static(); });
  EXPECT_TRUE(test::same_bits(u, stepper.displacement()));
  stepper.enable(tie);
  EXPECT_TRUE(stepper.solve_static().converged());
  EXPECT_LE(test::largest_distance(u, stepper.displacement()), 1e-9);
}

TEST(Failures, ARegionWithoutMaterialIsNamed) {
  Scene scene = block();
  Indices regions(48, 0);
  regions[7] = 3;
  scene.mesh = test::make_mesh(test::make_box({20, 20, 20}, 2, 2, 2), regions);
  scene.constraints.fix("base", bottom(scene.mesh));
  expect_error(ErrorCode::invalid_argument, "region 3", [&] { Stepper s(scene); });
}

TEST(Failures, ARegionGivenTwoMaterialsIsNamed) {
  Scene scene = block();
  scene.constraints.fix("base", bottom(scene.mesh));
  scene.materials.push_back(scene.materials.front());
  expect_error(ErrorCode::invalid_argument, "region 0", [&] { Stepper s(scene); });
}

TEST(Failures, AConstraintOnANodeThatIsNotThere) {
  for (Index node : {-1, 27}) {
    Scene scene = block();
    scene.constraints.fix("culprit", {0, node});
    expect_error(ErrorCode::index_out_of_range, "'culprit'", [&] { Stepper s(scene); });
  }
}

// Enabled where tissue has sunk meanwhile: refused, and nothing has changed.
TEST(Failures, AnObstacleEnabledInsideTissueNamesTheNode) {
  Scene scene = block();
  scene.constraints.fix("top",
                        test::nodes_where(scene.mesh, [](const Vec3& x) { return x.z() == 20.0; }));
  const auto floor = test::moved(test::make_sheet(60, 60, 6, 6), {-20, -20, -0.1});
  const ConstraintId id = scene.constraints.obstacle("floor", bottom(scene.mesh),
                                                     Surface::sheet(floor.points, floor.triangles));
  Stepper stepper(scene);
  stepper.disable(id);
  ASSERT_TRUE(stepper.solve_static().converged());
  const Points sunk = stepper.displacement();
  ASSERT_LT(sunk.col(2).minCoeff(), -0.2);
  stepper.enable(id);
  expect_error(ErrorCode::initial_penetration, "'floor'", [&] { stepper.check_settings(); });
  expect_error(ErrorCode::initial_penetration, "'floor'", [&] { stepper.solve_static(); });
  EXPECT_EQ(stepper.displacement(), sunk);
  stepper.disable(id);
  EXPECT_TRUE(stepper.solve_static().converged());
}

TEST(Failures, AnInitialPenetrationNamesTheNode) {
  Scene scene = block();
  scene.constraints.fix("top",
                        test::nodes_where(scene.mesh, [](const Vec3& x) { return x.z() == 20.0; }));
  const auto floor = test::moved(test::make_sheet(60, 60, 6, 6), {-20, -20, 0.5});
  scene.constraints.obstacle("floor", bottom(scene.mesh),
                             Surface::sheet(floor.points, floor.triangles));
  expect_error(ErrorCode::initial_penetration, "node 0", [&] { Stepper s(scene); });
}

TEST(Failures, ANodeInTwoPairsConflicts) {
  Scene scene = block();
  scene.constraints.fix("base", bottom(scene.mesh));
  Points up(2, 3);
  up << 0, 0, 1, 0, 0, 1;
  scene.constraints.opposing("culprit", {18, 18}, {9, 10}, up);
  expect_error(ErrorCode::conflicting_constraints, "'culprit'", [&] { Stepper s(scene); });
}

TEST(Failures, TwoNodesOfATetTiedToEachOtherConflict) {
  Scene scene = block();
  scene.constraints.fix("base", bottom(scene.mesh));
  scene.constraints.tie("culprit", {9}, {18});
  expect_error(ErrorCode::conflicting_constraints, "tied", [&] { Stepper s(scene); });
}

TEST(Failures, GravityMustBeFinite) {
  Scene scene = block();
  scene.constraints.fix("base", bottom(scene.mesh));
  Stepper stepper(scene);
  expect_error(ErrorCode::not_finite, "gravity",
               [&] { stepper.set_gravity(Vec3(0, 0, std::numeric_limits<double>::quiet_NaN())); });
  scene.gravity.x() = std::numeric_limits<double>::infinity();
  expect_error(ErrorCode::not_finite, "gravity", [&] { Stepper s(scene); });
}

TEST(Failures, WithoutFluidThereIsNoneToSet) {
  Scene scene = block();
  scene.constraints.fix("base", bottom(scene.mesh));
  Stepper stepper(scene);
  EXPECT_THROW(stepper.csf(), Error);
  EXPECT_THROW(stepper.compartment(0), Error);
  EXPECT_TRUE(stepper.fluid_pressure().isZero(0.0));
}

TEST(Failures, ASnapshotOfAnotherMeshIsRefused) {
  Scene scene = block();
  scene.constraints.fix("base", bottom(scene.mesh));
  Stepper a(scene);
  scene.mesh = test::make_mesh(test::make_box({20, 20, 20}, 3, 3, 3));
  Stepper b(scene);
  EXPECT_THROW(a.restore(b.snapshot()), Error);
  EXPECT_THROW(a.restore(nullptr), Error);
}

TEST(Failures, AFailedRestoreLeavesTheState) {
  // The snapshot of a scene with fluid offered to one without, on the same mesh.
  Scene scene = block();
  scene.constraints.fix("base", bottom(scene.mesh));
  Stepper dry(scene);
  ASSERT_TRUE(dry.solve_static().converged());
  const Points u = dry.displacement();
  scene.csf.emplace(
      test::fluid_density, FluidModel::separate,
      std::vector<Compartment>{test::make_compartment(
          "all", test::box_wall({-5, -5, -5}, {25, 25, 25}), test::all_faces(scene.mesh))});
  Stepper wet(scene);
  EXPECT_THROW(wet.restore(dry.snapshot()), Error);
  EXPECT_THROW(dry.restore(wet.snapshot()), Error);
  EXPECT_TRUE(test::same_bits(u, dry.displacement()));
}

TEST(Failures, OptionsThatMakeNoSenseAreRefused) {
  Scene scene = block();
  scene.constraints.fix("base", bottom(scene.mesh));
  StepperOptions options;
  options.residual_tolerance = -1.0;
  EXPECT_THROW(Stepper(scene, options), Error);
  options = {};
  options.max_iterations = 0;
  EXPECT_THROW(Stepper(scene, options), Error);
  options = {};
  options.smallest_load_step = 0.0;
  EXPECT_THROW(Stepper(scene, options), Error);
}

TEST(Failures, AFixedNodeThatTouchesAnObstacleStaysWhereItIs) {
  // The penetration is within what is accepted at the start; the fixed row wins.
  Scene scene = block();
  scene.constraints.fix("base", bottom(scene.mesh));
  const auto floor = test::moved(test::make_sheet(60, 60, 6, 6), {-20, -20, 1e-6});
  scene.constraints.obstacle("floor", bottom(scene.mesh),
                             Surface::sheet(floor.points, floor.triangles));
  Stepper stepper(scene);
  const SolveReport report = stepper.solve_static();
  EXPECT_TRUE(report.converged()) << report.message;
  for (Index i : bottom(scene.mesh)) {
    EXPECT_LE(stepper.displacement().row(i).norm(), 1e-12);
  }
}

TEST(Failures, AnOverturnedBlockThatContactCannotHoldSaysSo) {
  // Gravity pulls it away from its only contact.
  Scene scene = block();
  scene.gravity = Vec3(0, 0, standard_gravity);
  const auto floor = test::moved(test::make_sheet(60, 60, 6, 6), {-20, -20, 0});
  scene.constraints.obstacle("floor", bottom(scene.mesh),
                             Surface::sheet(floor.points, floor.triangles));
  Stepper stepper(scene);
  SolveReport report;
  try {
    report = stepper.solve_static();
    EXPECT_FALSE(report.converged());
    EXPECT_FALSE(report.message.empty());
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::rigid_mode);
  }
  EXPECT_TRUE(stepper.displacement().isZero(0.0));
}

}  // namespace
}  // namespace brainshift
