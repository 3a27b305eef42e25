// Rows that repeat or contradict each other.
#include "brainshift/mcp.hpp"
#include "robustness/outcome.hpp"
#include "support/leaning_block.hpp"

namespace brainshift::test {
namespace {

TEST(RedundantRows, R1_the_same_node_held_twice) {
  Scene scene = cube_on_base(Law::corotational);
  Stepper once(scene);
  expect_converged(once.solve_static());
  scene.constraints.fix("base again", bottom(scene.mesh));
  Indices repeated = bottom(scene.mesh);
  repeated.insert(repeated.end(), repeated.begin(), repeated.begin() + 4);
  scene.constraints.fix("and within one group", repeated, {true, false, true});
  Stepper more(scene);
  expect_converged(more.solve_static());
  EXPECT_LE(largest_distance(once.displacement(), more.displacement()), 1e-12);
}

TEST(RedundantRows, R1_ties_in_a_ring) {
  Scene scene = cube_on_base(Law::corotational);
  scene.mesh = make_mesh(
      joined(make_box({20, 20, 20}, 2, 2, 2), moved(make_box({20, 20, 20}, 2, 2, 2), {20, 0, 0})));
  scene.constraints = {};
  scene.constraints.fix("base",
                        nodes_where(scene.mesh, [](const Vec3& x) { return x.x() == 0.0; }));
  const auto [left, right] = seam(scene.mesh, 27);
  scene.constraints.tie("there", left, right);
  Stepper once(scene);
  expect_converged(once.solve_static());
  scene.constraints.tie("and back", right, left);
  Stepper twice(scene);
  expect_converged(twice.solve_static());
  EXPECT_LE(largest_distance(once.displacement(), twice.displacement()), 1e-12);
}

// A held node has the displacement zero and no other: two values for one dof cannot be said. What can
// contradict is found by the complementarity problem.
TEST(RedundantRows, R2_two_values_for_one_unknown_are_a_named_conflict) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd open = Eigen::VectorXd::Constant(2, infinity);
  const McpSolution s = solve_mcp(Eigen::MatrixXd::Ones(2, 2), Eigen::Vector2d(1, 2), -open, open);
  EXPECT_EQ(s.report.status, McpStatus::infeasible);
  EXPECT_EQ(s.report.conflict, (Indices{0, 1}));
  Scene scene = cube_on_base(Law::corotational);
  scene.constraints.tie("culprit", {9}, {18});  // two nodes of one tet
  expect_error(ErrorCode::conflicting_constraints, {"tied"}, [&] { Stepper stepper(scene); });
}

// There is no saddle-point matrix to factor: rows of nodes are eliminated, rows of devices meet in a
// small dense problem. A zero pivot cannot arise; the gap and the balance are those of the certificate.
TEST(RedundantRows, R3_ties_of_a_device_close_to_rounding) {
  Stepper stepper(leaning_block(0.0));
  stepper.insert(lead(), {lead_tip, lead_outward}, whole());
  stepper.set_gravity(leaning(0.02));
  const SolveReport report = stepper.solve_static();
  expect_converged(report);
  EXPECT_EQ(report.coupling_rank, report.coupling_rows);
  EXPECT_TRUE(report.coupling_unique);
  EXPECT_LE(report.tie_gap, 4e-11 * stepper.mesh().diameter());
}

TEST(RedundantRows, R4_more_rows_than_the_track_has_freedoms_are_reported) {
  Stepper one(leaning_block(0.0)), two(leaning_block(0.0));
  for (Stepper* s : {&one, &two, &two})
    s->insert(make_device("cannula", device_length), {lead_tip, lead_outward}, whole());
  for (Stepper* s : {&one, &two}) s->set_gravity(leaning(0.02));
  const SolveReport a = one.solve_static(), b = two.solve_static();
  expect_converged(a);
  expect_converged(b);
  EXPECT_EQ(b.coupling_rows, 2 * a.coupling_rows);
  EXPECT_EQ(b.coupling_rank, a.coupling_rank);
  EXPECT_FALSE(b.coupling_unique);
  EXPECT_LE(largest_distance(one.displacement(), two.displacement()), 1e-9);
}

// A lead held along its track by friction, fixed to the skull at its wire, clamped there as well.
TEST(RedundantRows, R5_a_closed_loop_of_rows) {
  for (const bool clamped : {false, true}) {
    Stepper stepper(leaning_block(0.01));
    expect_converged(stepper.solve_static());
    TrackOptions track;
    track.shear_bound = 0.01;
    track.tip_bound = 1.0;
    const DeviceId id =
        stepper.insert(lead(), {lead_tip, lead_outward},
                       {std::numeric_limits<double>::infinity(), wire, clamped, 0.0}, track);
    stepper.set_gravity(leaning(0.02));
    const SolveReport report = stepper.solve_static();
    expect_converged(report);
    const DeviceState d = stepper.device(id);
    EXPECT_LE(d.path_forces.rowwise().norm().maxCoeff(), 1e3);  // the block weighs 1000 mN
    const Vec3 sum = d.path_forces.colwise().sum().transpose();
    EXPECT_LE((sum - d.anchor_force).norm(), 1e-6 * (1.0 + sum.norm()));
  }
}

TEST(RedundantRows, R6_rows_that_hold_nothing_are_refused) {
  ConstraintSet set;
  expect_error(ErrorCode::empty, {"'none'"}, [&] { set.fix("none", {}); });
  expect_error(ErrorCode::invalid_argument, {"'none'"}, [&] {
    set.fix("none", {0}, {false, false, false});
  });
  EXPECT_TRUE(set.groups().empty());
  Stepper stepper(leaning_block());
  expect_error(ErrorCode::invalid_argument, {"not in tissue"}, [&] {
    stepper.insert(lead(), {Vec3(19, 19, -5.0), Vec3::UnitZ()}, whole());
  });
}

}  // namespace
}  // namespace brainshift::test
