// What a stepper promises about its state: snapshots, failures, cancelling, repeatability, points.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "brainshift/error.hpp"
#include "support/laws.hpp"
#include "support/scenes.hpp"

namespace brainshift {
namespace {

Scene busy_scene() { return test::busy_scene(3, 0.3); }

TEST(State, RestoreBringsBackTheSameBits) {
  Stepper stepper(busy_scene());
  stepper.csf().set_lost_volume(0, 2000.0);
  ASSERT_TRUE(stepper.solve_static().converged());
  const auto kept = stepper.snapshot();
  const Points u = stepper.displacement(), f = stepper.external_force();
  const ContactState contact = stepper.contact(0);
  stepper.csf().set_lost_volume(0, 9000.0);
  stepper.set_gravity(standard_gravity * Vec3(0, -0.3, -0.9));
  ASSERT_TRUE(stepper.solve_static().converged());
  ASSERT_FALSE(test::same_bits(u, stepper.displacement()));
  stepper.restore(kept);
  EXPECT_TRUE(test::same_bits(u, stepper.displacement()));
  EXPECT_TRUE(test::same_bits(f, stepper.external_force()));
  EXPECT_EQ(stepper.csf().amount(0), 2000.0);
  EXPECT_TRUE(test::same_bits(contact.force, stepper.contact(0).force));
}

TEST(State, ASolveThatBeginsWhereTheLastOneEndedIsEnded) {
  const Scene scene = busy_scene();
  for (const bool loose : {false, true}) {
    Stepper stepper(scene, loose ? within(0.1, scene.mesh) : StepperOptions{});
    stepper.csf().set_lost_volume(0, 9000.0);
    ASSERT_TRUE(stepper.solve_static().converged());
    const Points u = stepper.displacement();
    const Bytes kept = bytes_of(*stepper.snapshot());
    EXPECT_EQ(stepper.solve_static().iterations, 0);
    EXPECT_TRUE(test::same_bits(u, stepper.displacement()));
    Stepper other(scene, loose ? within(0.1, scene.mesh) : StepperOptions{});
    other.restore(other.read_snapshot(kept));   // it knows so from its bytes too
    EXPECT_EQ(other.solve_static().iterations, 0);
  }
}

// Changes too small for the tolerance of one solve are not lost: they add up.
TEST(State, SmallChangesAddUp) {
  const Scene scene = busy_scene();
  Stepper exact(scene), loose(scene, within(0.1, scene.mesh));
  const int parts = 400;
  for (int i = 0; i <= parts; ++i) {
    const Vec3 gravity = standard_gravity * Vec3(0.6 * i / parts, 0.0, -1.0);
    loose.set_gravity(gravity);
    const SolveReport report = loose.solve_static();
    ASSERT_TRUE(report.converged()) << report.message;
    exact.set_gravity(gravity);
  }
  ASSERT_TRUE(exact.solve_static().converged());
  EXPECT_GT(exact.displacement().cwiseAbs().maxCoeff(), 0.2);
  EXPECT_LE((loose.displacement() - exact.displacement()).cwiseAbs().maxCoeff(), 0.1);
}

TEST(State, WithinAnAccuracy) {
  const Scene scene = busy_scene();
  Stepper exact(scene);
  exact.csf().set_lost_volume(0, 9000.0);
  const SolveReport far = exact.solve_static();
  for (const double accuracy : {1.0, 0.1, 0.01}) {
    Stepper stepper(scene, within(accuracy, scene.mesh));
    stepper.csf().set_lost_volume(0, 9000.0);
    const SolveReport report = stepper.solve_static();
    ASSERT_TRUE(report.converged()) << report.message;
    EXPECT_LE((stepper.displacement() - exact.displacement()).rowwise().norm().maxCoeff(), accuracy);
    EXPECT_LT(report.iterations, far.iterations);
  }
  for (const double bad : {0.0, -0.1, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(within(bad, scene.mesh), Error);
  }
}

TEST(State, ASolveAfterRestoreIsTheSolveItWouldHaveBeen) {
  Stepper stepper(busy_scene());
  stepper.csf().set_lost_volume(0, 2000.0);
  ASSERT_TRUE(stepper.solve_static().converged());
  const auto kept = stepper.snapshot();
  stepper.csf().set_lost_volume(0, 6000.0);
  ASSERT_TRUE(stepper.solve_static().converged());
  const Points first = stepper.displacement();
  stepper.restore(kept);
  stepper.csf().set_lost_volume(0, 6000.0);
  ASSERT_TRUE(stepper.solve_static().converged());
  EXPECT_TRUE(test::same_bits(first, stepper.displacement()));
}

TEST(State, ASnapshotServesAnotherStepperOfTheSameScene) {
  Stepper a(busy_scene()), b(busy_scene());
  a.csf().set_lost_volume(0, 2000.0);
  ASSERT_TRUE(a.solve_static().converged());
  b.restore(a.snapshot());
  EXPECT_TRUE(test::same_bits(a.displacement(), b.displacement()));
}

TEST(State, ASnapshotOfAnotherMeshIsRefused) {
  const auto block = [](int nx, int ny) {   // as many nodes either way round
    Scene scene{test::make_mesh(test::make_box({20, 20, 20}, nx, ny, 2)),
                {{0, Material(Law::linear, 6.0, 0.45, test::tissue_density)}}};
    scene.constraints.fix("base", {0, 1, 2, 3, 4, 5});
    return scene;
  };
  Stepper one(block(2, 3)), other(block(3, 2));
  ASSERT_EQ(one.mesh().node_count(), other.mesh().node_count());
  EXPECT_THROW(one.restore(other.snapshot()), Error);
  EXPECT_NO_THROW(one.restore(Stepper(block(2, 3)).snapshot()));
}

TEST(State, SolvingAgainWithoutAChangeMovesNothing) {
  Stepper stepper(busy_scene());
  stepper.csf().set_lost_volume(0, 2000.0);
  ASSERT_TRUE(stepper.solve_static().converged());
  const Points u = stepper.displacement();
  ASSERT_TRUE(stepper.solve_static().converged());
  EXPECT_LE(test::largest_distance(u, stepper.displacement()), 1e-9);
}

TEST(State, TwoRunsGiveTheSameBits) {
  Points u[2];
  for (Points& result : u) {
    Stepper stepper(busy_scene());
    stepper.csf().set_lost_volume(0, 5000.0);
    ASSERT_TRUE(stepper.solve_static().converged());
    result = stepper.displacement();
  }
  EXPECT_TRUE(test::same_bits(u[0], u[1]));
}

TEST(State, CancellingLeavesTheStateAsItWas) {
  int calls = 0, allowed = 1 << 30;
  StepperOptions options;
  options.progress = [&](const Progress& p) {
    EXPECT_GE(p.residual, 0.0);
    EXPECT_GT(p.iteration, 0);
    EXPECT_GT(p.load_factor, 0.0);
    return ++calls < allowed;
  };
  Stepper stepper(busy_scene(), options);
  stepper.csf().set_lost_volume(0, 2000.0);
  ASSERT_TRUE(stepper.solve_static().converged());
  EXPECT_GT(calls, 0);
  const Points before = stepper.displacement();
  const ContactState contact = stepper.contact(0);
  calls = 0;
  allowed = 1;
  stepper.csf().set_lost_volume(0, 9000.0);
  const SolveReport report = stepper.solve_static();
  EXPECT_EQ(report.status, Status::cancelled);
  EXPECT_EQ(calls, 1);
  EXPECT_TRUE(test::same_bits(before, stepper.displacement()));
  EXPECT_TRUE(test::same_bits(contact.force, stepper.contact(0).force));
  // and the next solve is that of an object that was never cancelled
  allowed = 1 << 30;
  ASSERT_TRUE(stepper.solve_static().converged());
  Stepper fresh(busy_scene());
  fresh.csf().set_lost_volume(0, 2000.0);
  ASSERT_TRUE(fresh.solve_static().converged());
  fresh.csf().set_lost_volume(0, 9000.0);
  ASSERT_TRUE(fresh.solve_static().converged());
  EXPECT_TRUE(test::same_bits(fresh.displacement(), stepper.displacement()));
}

TEST(State, AFailedSolveLeavesNoTraceInTheNext) {
  Stepper stepper(busy_scene());
  stepper.csf().set_lost_volume(0, 2000.0);
  ASSERT_TRUE(stepper.solve_static().converged());
  const Points before = stepper.displacement();
  const CompartmentState at = stepper.compartment(0);
  stepper.csf().set_lost_volume(0, 1e9);
  EXPECT_THROW(stepper.solve_static(), Error);
  EXPECT_TRUE(test::same_bits(before, stepper.displacement()));
  EXPECT_EQ(stepper.compartment(0).head, at.head);
  stepper.csf().set_lost_volume(0, 4000.0);
  ASSERT_TRUE(stepper.solve_static().converged());
  Stepper fresh(busy_scene());
  for (double lost : {2000.0, 4000.0}) {
    fresh.csf().set_lost_volume(0, lost);
    ASSERT_TRUE(fresh.solve_static().converged());
  }
  EXPECT_TRUE(test::same_bits(fresh.displacement(), stepper.displacement()));
}

TEST(State, TheCertificateHoldsForEveryLaw) {
  for (Law law : test::all_laws) {
    Scene scene = busy_scene();
    scene.materials = {{0, Material(law, 6.0, 0.45, test::tissue_density)}};
    Stepper stepper(scene);
    stepper.csf().set_lost_volume(0, 9000.0);
    const SolveReport r = stepper.solve_static();
    ASSERT_TRUE(r.converged()) << to_string(law) << r.message;
    EXPECT_LE(r.residual, 1e-8);
    EXPECT_LE(r.complementarity, 1e-8);
    EXPECT_LE(r.violation, 1e-8 * stepper.mesh().diameter());
    EXPECT_GT(r.smallest_jacobian, 0.0);
    EXPECT_NEAR(r.smallest_jacobian, stepper.jacobians().minCoeff(), 1e-12);
    EXPECT_GT(r.energy, 0.0);
    EXPECT_EQ(r.load_factor, 1.0);
    EXPECT_GE(r.factorisations, 1);
    // The residual again, from the public forces alone: contact, springs in internal_force.
    const Points rest = stepper.external_force() - stepper.internal_force() + [&] {
      Points contact = Points::Zero(stepper.mesh().node_count(), 3);
      const ContactState c = stepper.contact(0);
      const Indices& nodes = scene.constraints.group(0).nodes;
      for (std::size_t i = 0; i < nodes.size(); ++i)
        contact.row(nodes[i]) += c.force.row(Eigen::Index(i));
      return contact;
    }();
    const double scale = std::max(stepper.external_force().cwiseAbs().maxCoeff(),
                                  stepper.internal_force().cwiseAbs().maxCoeff());
    EXPECT_LE(rest.cwiseAbs().maxCoeff(), 2e-8 * scale) << to_string(law);
  }
}

TEST(Points, DisplacementAtAndRestPointsOfAreInverse) {
  Stepper stepper(busy_scene());
  stepper.csf().set_lost_volume(0, 9000.0);
  ASSERT_TRUE(stepper.solve_static().converged());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> inside(0.5, 29.5);
  Points rest(200, 3);
  for (Eigen::Index i = 0; i < rest.size(); ++i) rest.data()[i] = inside(random);
  const PointValues u = stepper.displacement_at(rest);
  const PointValues back = stepper.rest_points_of(rest + u.values);
  // barycentric weights: round-off of the size of the mesh
  EXPECT_LE(test::largest_distance(back.values, rest), 1e-11);
  for (std::size_t i = 0; i < u.tet.size(); ++i) EXPECT_GE(u.tet[i], 0);
}

TEST(Points, NodesAreGivenTheirOwnDisplacement) {
  Stepper stepper(busy_scene());
  stepper.csf().set_lost_volume(0, 9000.0);
  ASSERT_TRUE(stepper.solve_static().converged());
  const PointValues at = stepper.displacement_at(stepper.mesh().nodes());
  EXPECT_LE(test::largest_distance(at.values, stepper.displacement()), 1e-12);
}

TEST(Points, OutsideIsNotANumberAndSaysSo) {
  Stepper stepper(busy_scene());
  Points far(2, 3);
  far << 15, 15, 15, 100, 0, 0;
  for (const PointValues& v : {stepper.displacement_at(far), stepper.rest_points_of(far)}) {
    EXPECT_GE(v.tet[0], 0);
    EXPECT_EQ(v.tet[1], -1);
    EXPECT_TRUE(v.values.row(0).allFinite());
    EXPECT_TRUE(std::isnan(v.values(1, 0)));
  }
}

}  // namespace
}  // namespace brainshift
