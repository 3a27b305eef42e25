// Contact that grazes, repeats itself, contradicts itself, or is met at speed; and the
// complementarity problems under it.
#include <limits>
#include <random>

#include "brainshift/mcp.hpp"
#include "robustness/outcome.hpp"

namespace brainshift::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

McpSolution one_sided(const MatrixXd& M, const VectorXd& q, McpOptions options = {}) {
  return solve_mcp(M, q, VectorXd::Zero(q.size()), VectorXd::Constant(q.size(), infinity), options);
}

Surface floor_at(double z) {
  const auto sheet = moved(make_sheet(60, 60, 6, 6), {-20, -20, z});
  return Surface::sheet(sheet.points, sheet.triangles);
}

// Cube on a floor, held sideways by its planes of symmetry.
Scene on_floor(double z = 0.0, Law law = Law::corotational, double poisson = 0.45, int cells = 2) {
  Scene scene = cube_on_base(law, {0, 0, -standard_gravity}, cells, poisson);
  scene.constraints = {};
  for (int axis : {0, 1}) {
    std::array<bool, 3> axes{axis == 0, axis == 1, false};
    scene.constraints.fix(
        "plane", nodes_where(scene.mesh, [axis](const Vec3& x) { return x[axis] == 0.0; }), axes);
  }
  scene.constraints.obstacle("floor", bottom(scene.mesh), floor_at(z));
  return scene;
}

constexpr double weight = tissue_density * 8000.0 * standard_gravity;  // mN

TEST(ContactLimits, K1_grazing_rows_without_force) {
  Scene scene = on_floor();
  scene.gravity.setZero();
  Stepper stepper(scene);
  expect_converged(stepper.solve_static());
  EXPECT_TRUE(stepper.displacement().isZero(0.0));
  EXPECT_EQ(stepper.contact(2).active, 0);
  const int n = 12;  // lambda = w = 0 in every row
  const McpSolution s = one_sided(MatrixXd::Identity(n, n), VectorXd::Zero(n));
  EXPECT_EQ(s.report.status, McpStatus::solved);
  EXPECT_TRUE(s.z.isZero(0.0));
}

TEST(ContactLimits, K2_sixty_rows_of_rank_twenty) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  MatrixXd H(60, 20);
  for (Eigen::Index i = 0; i < 20 * 20; ++i) H(i % 20, i / 20) = normal(random);
  H.middleRows(20, 20) = H.topRows(20);
  H.bottomRows(20) = H.topRows(20);
  const VectorXd q = H * VectorXd::Constant(20, -1.0);
  const McpSolution many = one_sided(H * H.transpose(), q);
  const McpSolution few = one_sided(H.topRows(20) * H.topRows(20).transpose(), q.head(20));
  ASSERT_EQ(many.report.status, McpStatus::solved) << many.report.message;
  ASSERT_EQ(few.report.status, McpStatus::solved);
  EXPECT_FALSE(many.report.unique);
  const VectorXd a = H.transpose() * many.z, b = H.topRows(20).transpose() * few.z;
  EXPECT_LE((a - b).norm(), 1e-9 * b.norm());  // forces on the bodies
}

TEST(ContactLimits, K2_the_same_floor_twice_carries_the_weight_once) {
  Scene scene = on_floor();
  Stepper once(scene);
  expect_converged(once.solve_static());
  scene.constraints.obstacle("floor again", bottom(scene.mesh), floor_at(0.0));
  Stepper twice(scene);
  expect_converged(twice.solve_static());
  EXPECT_LE(largest_distance(once.displacement(), twice.displacement()), 1e-9);
  const double sum = twice.contact(2).force.col(2).sum() + twice.contact(3).force.col(2).sum();
  EXPECT_NEAR(sum, weight, 1e-6 * weight);
}

TEST(ContactLimits, K3_where_gauss_seidel_cycles) {
  MatrixXd M(3, 3);
  M << 1, 2, 0, 0, 1, 2, 2, 0, 1;
  const VectorXd q = VectorXd::Constant(3, -1.0);
  McpOptions cycling;
  cycling.method = McpMethod::gauss_seidel;
  EXPECT_EQ(one_sided(M, q, cycling).report.status, McpStatus::not_converged);
  const McpSolution s = one_sided(M, q);
  EXPECT_EQ(s.report.status, McpStatus::solved);
  EXPECT_LE((s.z - VectorXd::Constant(3, 1.0 / 3.0)).norm(), 1e-12);
}

TEST(ContactLimits, K4_rows_that_contradict_each_other_are_named) {
  const McpSolution s = one_sided(MatrixXd::Zero(1, 1), VectorXd::Constant(1, -1.0));
  EXPECT_EQ(s.report.status, McpStatus::infeasible);
  EXPECT_EQ(s.report.conflict, Indices{0});
  MatrixXd walls(3, 3);
  walls << 1, -1, 0, -1, 1, 0, 0, 0, 1;
  const McpSolution t = one_sided(walls, VectorXd::Constant(3, -1.0));
  EXPECT_EQ(t.report.status, McpStatus::infeasible);
  EXPECT_EQ(t.report.conflict, (Indices{0, 1}));
  // A floor above the ceiling of the same node: refused as what it is at the start.
  Scene scene = on_floor();
  const auto low = moved(make_sheet(60, 60, 6, 6), {-20, -20, -0.5});
  scene.constraints.obstacle("ceiling", bottom(scene.mesh),
                             Surface::sheet(low.points, low.triangles), -1.0);
  expect_error(ErrorCode::initial_penetration, {"'ceiling'"}, [&] { Stepper stepper(scene); });
}

TEST(ContactLimits, K5_what_is_not_finite_is_refused) {
  MatrixXd M = MatrixXd::Identity(2, 2);
  VectorXd q = VectorXd::Constant(2, -1.0);
  q[1] = nan;
  expect_error(ErrorCode::not_finite, {"q[1]"}, [&] { one_sided(M, q); });
  q[1] = -1.0;
  M(0, 1) = infinity;
  expect_error(ErrorCode::not_finite, {"M(0, 1)"}, [&] { one_sided(M, q); });
}

TEST(ContactLimits, K6_rows_of_very_different_size) {
  const Eigen::Index n = 13;
  VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale[i] = std::pow(10.0, double(i) - 6.0);
  MatrixXd M = MatrixXd::Constant(n, n, 0.2);
  M.diagonal().setOnes();
  const VectorXd q = VectorXd::Constant(n, -1.0);
  const McpSolution plain = one_sided(M, q);
  const McpSolution scaled =
      one_sided(scale.asDiagonal() * M * scale.asDiagonal(), scale.asDiagonal() * q);
  ASSERT_EQ(scaled.report.status, McpStatus::solved);
  for (Eigen::Index i = 0; i < n; ++i) {  // every row to the same relative accuracy
    EXPECT_NEAR(scaled.z[i] * scale[i], plain.z[i], 1e-9 * plain.z[i]) << i;
  }
}

// Two blocks with a thin sheet between them, both pushed through it by 5 mm if it were not there.
TEST(ContactLimits, K7_a_sheet_without_thickness_keeps_both_sides_apart) {
  for (const double push : {-1.0, 1.0}) {
    Scene scene = cube_on_base(Law::stable_neo_hookean, {push * 2.0 * standard_gravity, 0, 0});
    scene.mesh = make_mesh(joined(moved(make_box({20, 20, 20}, 2, 2, 2), {-20.2, 0, 0}),
                                  moved(make_box({20, 20, 20}, 2, 2, 2), {0.2, 0, 0})));
    scene.constraints = {};
    scene.constraints.fix("base", bottom(scene.mesh));
    auto sheet = make_sheet(60, 60, 6, 6);  // turned into the plane x = 0, its normal +x
    for (Eigen::Index i = 0; i < sheet.points.rows(); ++i) {
      const Vec3 flat = sheet.points.row(i);
      sheet.points.row(i) << 0.0, flat.x() - 20.0, flat.y() - 20.0;
    }
    const Surface falx = Surface::sheet(sheet.points, sheet.triangles);
    const double normal = falx.sample(Vec3(1, 0, 0)).gradient.x();
    const auto side = [&](double sign) {
      return nodes_where(scene.mesh,
                         [sign](const Vec3& x) { return std::abs(x.x() - sign * 0.2) < 1e-9; });
    };
    scene.constraints.obstacle("right", side(1.0), falx, normal > 0 ? 1.0 : -1.0);
    scene.constraints.obstacle("left", side(-1.0), falx, normal > 0 ? -1.0 : 1.0);
    Stepper free(scene);
    free.disable(1);
    free.disable(2);
    expect_converged(free.solve_static());
    ASSERT_GT(std::abs(free.displacement().col(0).mean()), 0.5);
    Stepper stepper(scene);
    const SolveReport report = stepper.solve_static();
    expect_converged(report);
    EXPECT_LE(report.violation, 1e-9);
    EXPECT_GT(report.active_contacts, 0);
    const Points x = stepper.positions();
    for (const Index i : side(1.0)) EXPECT_GE(x(i, 0), -1e-9);
    for (const Index i : side(-1.0)) EXPECT_LE(x(i, 0), 1e-9);
  }
}

TEST(ContactLimits, K8_a_body_thrown_at_a_sheet_does_not_pass_through) {
  Scene scene = on_floor(-1.0, Law::stable_neo_hookean);
  scene.constraints.disable(0);
  scene.constraints.disable(1);
  scene.constraints.remove(2);
  scene.constraints.obstacle("floor", all_nodes(scene.mesh), floor_at(-1.0));
  for (const double speed : {100.0, 1000.0}) {  // mm/s: 1 mm and 10 mm in a step
    Stepper stepper(scene);
    Points v = Points::Zero(27, 3);
    v.col(2).setConstant(-speed);
    stepper.set_velocity(v);
    for (int i = 0; i < 5; ++i) {
      const SolveReport report = stepper.step(0.01);
      expect_converged(report);
      EXPECT_LE(report.violation, 1e-8);
      EXPECT_GE(stepper.positions().col(2).minCoeff(), -1.0 - 1e-8);
    }
  }
}

TEST(ContactLimits, K9_a_penetration_from_the_start_is_named_with_its_depth) {
  expect_error(ErrorCode::initial_penetration, {"'floor'", "node", "mm inside"},
               [] { Stepper s(on_floor(3.0)); });
}

// Where triangles meet in an edge the distance is smooth: the normal turns, it does not jump.
TEST(ContactLimits, K10_the_normal_turns_smoothly_across_an_edge) {
  const auto box = box_wall({-30, -30, -30}, {30, 30, 30});
  const Surface wall = Surface::cavity(box.points, box.triangles);
  Vec3 before = wall.sample(Vec3(0, 24, 29)).gradient;
  double turned = 0.0;
  for (double s = 0.0; s <= 1.0; s += 0.002) {  // around the edge y = z = 30, 0.02 mm apart
    const double angle = 0.5 * EIGEN_PI * s;
    const Vec3 at(0.0, 30.0 - 6.0 * std::cos(angle), 30.0 - 6.0 * std::sin(angle));
    const Vec3 now = wall.sample(at).gradient;
    const double turn = std::acos(std::min(1.0, now.normalized().dot(before.normalized())));
    EXPECT_LE(turn, 5.0 * EIGEN_PI / 180.0);
    turned += turn;
    before = now;
  }
  EXPECT_GT(turned, 1.0);  // radians: from one wall to the other
}

// Contact of nodes is eliminated, not condensed: thousands of rows cost no dense matrix.
TEST(ContactLimits, K11_every_node_of_a_surface_in_contact) {
  Scene scene = busy_scene(10, 0.3);
  const auto wall = box_wall({0, 0, 0}, {30, 30, 30});
  scene.constraints.disable(0);
  Eigen::VectorXd touching(Eigen::Index(surface_nodes(scene.mesh).size()));
  const Surface cavity = Surface::cavity(wall.points, wall.triangles);
  const Indices outside = surface_nodes(scene.mesh);
  for (std::size_t i = 0; i < outside.size(); ++i)
    touching[Eigen::Index(i)] = cavity.distance(scene.mesh.nodes().row(outside[i]).transpose());
  const ConstraintId all = scene.constraints.obstacle("skull", outside, cavity, 1.0, touching);
  Stepper stepper(scene);
  stepper.csf().set_lost_volume(0, 9000.0);
  const MemoryEstimate memory = stepper.memory_estimate();   // before anything is taken
  EXPECT_LT(memory.compliance, 602 * 602 * 8);   // no dense matrix of all candidates
  EXPECT_LT(memory.total, 40e6);
  const SolveReport report = stepper.solve_static();
  expect_converged(report);
  EXPECT_EQ(stepper.contact(all).gap.size(), 602);
  EXPECT_GT(report.active_contacts, 100);
  EXPECT_LE(report.iterations, 30);
}

TEST(ContactLimits, K12_contacts_that_come_and_go_leave_no_trace) {
  Stepper stepper(on_floor(-0.5));
  expect_converged(stepper.solve_static());
  EXPECT_GT(stepper.contact(2).active, 0);
  const Points resting = stepper.displacement();
  stepper.set_gravity({0, 0, 0});  // springs back, and off the floor it hovers above
  const SolveReport off = stepper.solve_static();
  EXPECT_TRUE(!off.converged() || off.violation <= 1e-8);
  stepper.set_gravity({0, 0, -standard_gravity});
  expect_converged(stepper.solve_static());
  EXPECT_LE(largest_distance(stepper.displacement(), resting), 1e-8);
}

// Nothing but the floor below holds the cube: its tangent is singular until it is down, and whether a
// factor finds that out is left to rounding.
TEST(ContactLimits, K12_a_body_comes_down_onto_its_floor) {
  for (const Law law : {Law::linear, Law::corotational, Law::stable_neo_hookean}) {
    for (const int cells : {2, 3, 4}) {
      for (const double z : {-0.1, -0.5, -2.0, -20.0}) {
        SCOPED_TRACE(std::to_string(cells) + " cells, floor at " + std::to_string(z));
        Stepper stepper(on_floor(z, law, 0.45, cells));
        const SolveReport report = stepper.solve_static();
        expect_converged(report);
        EXPECT_LE(report.iterations, 30);
        EXPECT_NEAR(stepper.contact(2).force.col(2).sum(), weight, 1e-6 * weight);
      }
    }
  }
}

// A bar hanging from its top that would stretch by more than the floor leaves: with nu = 0 and linear,
// free length + weight/2 by E, and the floor takes E A / H of what is too much.
TEST(ContactLimits, K13_a_bar_on_an_obstacle_has_the_closed_form) {
  const double free = tissue_density * standard_gravity * 400.0 / (2.0 * 6.0);
  const double room = 0.4 * free;
  Scene scene = on_floor(-room, Law::linear, 0.0);
  scene.constraints.fix("top",
                        nodes_where(scene.mesh, [](const Vec3& x) { return x.z() == 20.0; }));
  Stepper stepper(scene);
  expect_converged(stepper.solve_static());
  const double expected = 6.0 * 400.0 / 20.0 * (free - room);
  // The lumped weight of the lowest layer of nodes is a quarter of the cube's height and more.
  EXPECT_NEAR(stepper.contact(2).force.col(2).sum(), expected, 0.02 * weight);
  for (const Index i : bottom(scene.mesh)) EXPECT_NEAR(stepper.displacement()(i, 2), -room, 1e-9);
}

TEST(ContactLimits, K14_a_held_node_in_contact_is_consistent_or_named) {
  Scene scene = on_floor();
  scene.constraints.fix("base", bottom(scene.mesh));
  Stepper stepper(scene);
  expect_converged(stepper.solve_static());
  for (const Index i : bottom(scene.mesh)) EXPECT_TRUE(stepper.displacement().row(i).isZero(1e-12));
  MatrixXd M = MatrixXd::Ones(2, 2);  // held at 0, and at least 1
  const VectorXd upper = VectorXd::Constant(2, infinity);
  const Eigen::Vector2d lower(-infinity, 0.0), q(0.0, -1.0);
  const McpSolution s = solve_mcp(M, q, lower, upper);
  EXPECT_EQ(s.report.status, McpStatus::infeasible);
  EXPECT_EQ(s.report.conflict, (Indices{0, 1}));
}

}  // namespace
}  // namespace brainshift::test
