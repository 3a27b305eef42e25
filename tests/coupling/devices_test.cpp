// Devices in a block of tissue that leans under gravity.
#include <cmath>

#include <gtest/gtest.h>

#include "support/expect_error.hpp"
#include "support/leaning_block.hpp"

namespace brainshift {
namespace {

using test::expect_error;
using test::lead;
using test::leaning;
using test::leaning_block;
using test::whole;
using test::wire;
using test::wire_only;

const Vec3 tip = test::lead_tip, outward = test::lead_outward;

double largest(const Points& p) { return p.rowwise().norm().maxCoeff(); }

TEST(Devices, InsertedAlongTheirLineMoveNothing) {
  Stepper stepper(leaning_block());
  ASSERT_TRUE(stepper.solve_static().converged());
  const Points before = stepper.displacement();
  EXPECT_GT(largest(before), 0.3);
  const DeviceId id = stepper.insert(lead(), {tip, outward}, wire_only());
  const SolveReport report = stepper.solve_static();
  ASSERT_TRUE(report.converged()) << report.message;
  EXPECT_LE(largest(stepper.displacement() - before), 1e-9);
  const DeviceState d = stepper.device(id);
  EXPECT_GE(d.path.rows(), 5);
  EXPECT_LE(largest(d.path_forces), 1e-6);   // mN, beside a weight of 1000 mN
  EXPECT_LE(d.bow, 1e-9);
}

// Three tets around an edge have five nodes and would hold four points of a track: ties that depend on
// each other, and contradict each other once the device bends.
TEST(Devices, LieInMeshesWithThreeTetsAroundAnEdge) {
  Scene scene = leaning_block(0.01);
  scene.mesh = test::make_mesh(
      test::split_at_centroids(test::make_box({40.0, 40.0, test::block_height}, 3, 3, 5)));
  scene.constraints = {};
  scene.constraints.fix(
      "base", test::nodes_where(scene.mesh, [](const Vec3& x) { return x.z() == 0.0; }));
  for (int i = 0; i < 16; ++i) {
    SCOPED_TRACE(i);
    Stepper stepper(scene);
    ASSERT_TRUE(stepper.solve_static().converged());
    const Vec3 direction = Vec3(0.3 * std::sin(i), 0.3 * std::cos(3 * i), 1.0).normalized();
    const DeviceId id =
        stepper.insert(make_device("cannula", test::device_length), {tip, direction}, whole());
    ASSERT_TRUE(stepper.solve_static().converged());
    stepper.exchange(id, lead(), wire_only());
    stepper.set_gravity(leaning(0.02));
    const SolveReport report = stepper.solve_static();
    ASSERT_TRUE(report.converged()) << report.message;
    EXPECT_EQ(report.coupling_rank, report.coupling_rows);
    EXPECT_GT(stepper.device(id).bow, 1e-3);
  }
}

TEST(Devices, ACannulaHoldsItsTrackAndItsRemovalReleasesIt) {
  Stepper with(leaning_block(0.01)), without(leaning_block(0.01));
  for (Stepper* s : {&with, &without}) ASSERT_TRUE(s->solve_static().converged());
  const DeviceId id = with.insert(make_device("cannula", 55.0), {tip, outward}, whole());
  for (Stepper* s : {&with, &without}) {
    s->set_gravity({0.02 * 9810.0, 0.0, 0.0});
    ASSERT_TRUE(s->solve_static().converged());
  }
  const DeviceState d = with.device(id);
  for (Eigen::Index p = 0; p < d.path.rows(); ++p) {
    const Vec3 off = d.path.row(p).transpose() - tip;
    EXPECT_LE((off - off.dot(outward) * outward).norm(), 1e-8) << p;   // still on the line
  }
  EXPECT_LT(d.path_forces.col(0).sum(), -1.0);   // it pushes against the lean
  EXPECT_GT(largest(with.displacement() - without.displacement()), 0.1);
  with.remove(id);
  ASSERT_TRUE(with.solve_static().converged());
  EXPECT_LE(largest(with.displacement() - without.displacement()), 1e-6);
}

TEST(Devices, ALeadBendsWhenItsCannulaLeavesAndLeastWhenStiffest) {
  double softer = std::numeric_limits<double>::infinity();
  for (double bending : {1e1, 1e3, 5e3, 1e5, 1e7}) {
    Stepper stepper(leaning_block(0.01));
    ASSERT_TRUE(stepper.solve_static().converged());
    const DeviceId id = stepper.insert(make_device("cannula", 55.0), {tip, outward}, whole());
    stepper.exchange(id, lead(bending), whole());
    stepper.set_gravity({0.02 * 9810.0, 0.0, 0.0});
    ASSERT_TRUE(stepper.solve_static().converged());
    EXPECT_LE(stepper.device(id).bow, 1e-9);
    stepper.set_hold(id, wire_only());
    const SolveReport report = stepper.solve_static();
    ASSERT_TRUE(report.converged()) << report.message;
    const DeviceState d = stepper.device(id);
    EXPECT_LE(d.largest_tie_gap, 1e-8);
    EXPECT_GT(d.bow, 0.0);
    EXPECT_LT(d.bow, softer);
    softer = d.bow;
  }
}

// A lead without stiffness leaves the tissue as it would be alone.
TEST(Devices, ALeadWithoutStiffnessLeavesTheTissueUndisturbed) {
  Stepper with(leaning_block(0.01)), without(leaning_block(0.01));
  for (Stepper* s : {&with, &without}) ASSERT_TRUE(s->solve_static().converged());
  with.insert(lead(1.0), {tip, outward}, wire_only());
  for (Stepper* s : {&with, &without}) {
    s->set_gravity({0.02 * 9810.0, 0.0, 0.0});
    ASSERT_TRUE(s->solve_static().converged());
  }
  // What is left is the wire's pull on the chord to its anchor, of the order of the bow squared.
  EXPECT_LE(largest(with.displacement() - without.displacement()),
            0.02 * largest(without.displacement()));
}

// A wire with slack gives way along its line until the slack is used up, never across.
TEST(Devices, AWireWithSlackIsHeldOnlyAtItsEnd) {
  const double bound = 0.05;   // kPa: tissue that moves along the wire takes it with it
  const Vec3 across = outward.unitOrthogonal();
  double last = 0.0;
  for (double slack : {0.0, 0.05, 0.1, 5.0}) {
    Scene scene = leaning_block(0.0);
    Stepper stepper(std::move(scene));
    TrackOptions track;
    track.shear_bound = bound;
    const DeviceId id = stepper.insert(lead(), {tip, outward}, wire_only(slack), track);
    stepper.set_gravity({0.0, 0.0, -0.05 * 9810.0});   // the block sinks along the wire
    const SolveReport report = stepper.solve_static();
    ASSERT_TRUE(report.converged()) << slack << report.message;
    const DeviceState d = stepper.device(id);
    Eigen::Index anchor;
    (stepper.device_model(id).arcs().array() - wire).abs().minCoeff(&anchor);
    const Vec3 moved = d.nodes.row(anchor).transpose() -
                       (tip + stepper.device_model(id).arcs()[anchor] * outward);
    EXPECT_LE(std::abs(moved.dot(across)), 1e-8);
    EXPECT_LE(-moved.dot(outward), slack + 1e-8);
    EXPECT_GE(-moved.dot(outward), last - 1e-8);
    last = -moved.dot(outward);
    if (slack > 0.0 && slack < 1.0) {   // used up, and the skull holds the rest
      EXPECT_NEAR(last, slack, 1e-8);
      EXPECT_GT(d.anchor_force.dot(outward), 1e-3);   // mN, of the skull on the wire
    }
    if (slack > 1.0) {
      EXPECT_LT(last, 4.0);
      EXPECT_LE(std::abs(d.anchor_force.dot(outward)), 1e-6);   // mN: carried along
    }
    std::printf("slack %.2f mm: the wire slid in by %.4f mm; the skull holds it with %.3f mN\n", slack,
                last, d.anchor_force.dot(outward));
  }
}

// Further down the same line: what is crossed there joins the track, the rest stays as it was.
TEST(Devices, ALeadGoesDeeperThroughItsCannula) {
  Stepper stepper(leaning_block(0.01));
  ASSERT_TRUE(stepper.solve_static().converged());
  const double depth = 12.0;
  const DeviceId id = stepper.insert(make_device("cannula", 45.0), {tip + depth * outward, outward},
                                     {0.0, wire - depth, false, 0.0});
  const Points short_track = stepper.device(id).path;
  stepper.exchange(id, lead(), {depth, wire, false, 0.0}, depth);
  const Points before = stepper.displacement();
  ASSERT_TRUE(stepper.solve_static().converged());
  EXPECT_LE(largest(stepper.displacement() - before), 1e-9);
  const DeviceState d = stepper.device(id);
  ASSERT_GT(d.path.rows(), short_track.rows());
  EXPECT_LE(largest(d.path.bottomRows(short_track.rows()) - short_track), 1e-9);
  EXPECT_LE((d.nodes.row(0).transpose() - tip).norm(), 1e-9);
  for (Eigen::Index p = 1; p < d.path_arcs.size(); ++p) EXPECT_GT(d.path_arcs[p], d.path_arcs[p - 1]);
  // Free below the cannula, held inside it.
  stepper.set_gravity(leaning(0.02));
  ASSERT_TRUE(stepper.solve_static().converged());
  const DeviceState bent = stepper.device(id);
  EXPECT_GT((bent.nodes.row(0).transpose() - tip).norm(), 0.005);
  for (Eigen::Index i = 0; i < bent.nodes.rows(); ++i) {
    const double arc = stepper.device_model(id).arcs()[i];
    if (arc < depth) continue;
    EXPECT_LE((bent.nodes.row(i).transpose() - tip - arc * outward).norm(), 1e-9) << arc;
  }
}

// A thinner device bears less friction than the one it takes over from: no solve may say otherwise.
TEST(Devices, FrictionCarriedOverStaysWithinTheNewBound) {
  Stepper stepper(leaning_block(0.0));
  TrackOptions track;
  track.shear_bound = 0.002;
  const BeamDevice cannula = make_device("cannula", 55.0);
  const DeviceId id = stepper.insert(cannula, {tip, outward}, whole(), track);
  stepper.set_gravity({0.0, 0.0, -0.05 * 9810.0});
  ASSERT_TRUE(stepper.solve_static().converged());
  const double before = stepper.device(id).anchor_force.dot(outward);
  stepper.exchange(id, lead(), whole());
  const SolveReport report = stepper.solve_static();
  ASSERT_TRUE(report.converged()) << report.message;
  EXPECT_LE(report.complementarity, 1e-8);
  const double after = stepper.device(id).anchor_force.dot(outward);
  // All rows slip, so that the forces are as the radii.
  EXPECT_NEAR(after / before, lead().radius_at(1.0) / cannula.radius_at(1.0), 1e-6);
}

TEST(Devices, BranchesFromOneSnapshotAreTheSameBits) {
  Stepper stepper(leaning_block(0.01));
  ASSERT_TRUE(stepper.solve_static().converged());
  const DeviceId id = stepper.insert(lead(), {tip, outward}, wire_only());
  ASSERT_TRUE(stepper.solve_static().converged());
  const auto before = stepper.snapshot();
  Points found[2];
  for (Points& nodes : found) {
    stepper.restore(before);
    stepper.set_gravity({0.02 * 9810.0, 0.0, 0.0});
    ASSERT_TRUE(stepper.solve_static().converged());
    nodes = stepper.device(id).nodes;
  }
  EXPECT_EQ(found[0], found[1]);
}

TEST(Devices, AreRefusedWhereTheyCannotBe) {
  Stepper stepper(leaning_block());
  expect_error(ErrorCode::invalid_argument, {"tip", "not in tissue"},
               [&] { stepper.insert(lead(), {Vec3(100, 0, 0), outward}, wire_only()); });
  expect_error(ErrorCode::invalid_argument, {"nothing holds"},
               [&] { stepper.insert(lead(), {tip, outward}, Hold{}); });
  expect_error(ErrorCode::invalid_argument, {"beyond the device", "55"},
               [&] { stepper.insert(lead(), {tip, outward}, {1000.0, wire, false, 0.0}); });
  expect_error(ErrorCode::invalid_argument, {"beyond the device"},
               [&] { stepper.insert(lead(), {tip, outward}, {0.0, 1000.0, false, 0.0}); });
  expect_error(ErrorCode::invalid_argument, {"slack"},
               [&] { stepper.insert(lead(), {tip, outward}, wire_only(-1.0)); });
  expect_error(ErrorCode::invalid_argument, {"unit length"},
               [&] { stepper.insert(lead(), {tip, 2.0 * outward}, wire_only()); });
  expect_error(ErrorCode::invalid_argument, {"id 7"}, [&] { stepper.remove(7); });
  const DeviceId id = stepper.insert(lead(), {tip, outward}, wire_only());
  expect_error(ErrorCode::invalid_argument, {"advance"},
               [&] { stepper.exchange(id, lead(), whole(), -1.0); });
  expect_error(ErrorCode::invalid_argument, {"tip", "not in tissue"},
               [&] { stepper.exchange(id, lead(), whole(), 30.0); });
}

}  // namespace
}  // namespace brainshift
