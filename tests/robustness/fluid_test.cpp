// Fluid whose level cuts faces, touches nodes, is absurd, or comes and goes.
#include <limits>

#include "fluid/fluid_scenes.hpp"
#include "mesh/surface_topology.hpp"
#include "robustness/outcome.hpp"

namespace brainshift::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A ball of 30 mm in a cavity of 40 mm, held at its middle; the level is set to `head`.
Scene ball_scene(int cells = 4) {
  const BallInCavity s(30.0, cells);
  Scene scene{
      s.mesh, {{0, Material(Law::corotational, 6.0, 0.45, tissue_density)}}, gravity_down, s.csf};
  scene.constraints.fix("middle",
                        nodes_where(s.mesh, [](const Vec3& x) { return x.norm() < 16.0; }));
  return scene;
}

Points pushed(const BallInCavity& s, const Vec3& down, double head) {
  Hydrostatics fluid(s.mesh, s.csf, down);
  Points force = Points::Zero(s.mesh.node_count(), 3);
  fluid.add_force(s.mesh.nodes(), {head}, 1.0, force);
  return force;
}

TEST(FluidLimits, F1_buoyancy_is_that_of_the_part_below_at_any_level) {
  const BallInCavity s(30.0, 4);
  double before = 0.0;
  for (double head = -29.9; head < 30.0; head += 0.37) {
    const Points force = pushed(s, gravity_down, head);
    const double expected = weight * volume_below(s.mesh, s.mesh.nodes(), head);
    EXPECT_NEAR(force.col(2).sum(), expected, 1e-12 * weight * 113000.0) << head;
    EXPECT_GE(force.col(2).sum(), before);
    before = force.col(2).sum();
  }
}

TEST(FluidLimits, F2_full_immersion_turns_nothing) {
  const BallInCavity s(30.0, 4);
  const Points force = pushed(s, gravity_down, 40.0);
  Vec3 net = Vec3(0, 0, -weight * s.mesh.volume()), moment = Vec3::Zero(), centre;
  volume_below(s.mesh, s.mesh.nodes(), 100.0, &centre);
  centre /= s.mesh.volume();
  for (Eigen::Index i = 0; i < force.rows(); ++i) {
    const Vec3 f = force.row(i).transpose(), x = s.mesh.nodes().row(i).transpose();
    net += f;
    moment += (x - centre).cross(f);
  }
  const double scale = weight * s.mesh.volume();
  EXPECT_LE(net.norm(), 1e-12 * scale);
  EXPECT_LE(moment.norm(), 1e-12 * scale * 30.0);
}

TEST(FluidLimits, F3_a_level_exactly_at_nodes_and_at_a_level_face) {
  Scene scene = busy_scene(3, 0.3);
  for (const double level : {30.0, 20.0, 10.0, 0.0}) {  // nodes; the top and bottom faces
    Stepper stepper(scene);
    stepper.csf().set_level(0, level);
    expect_converged(stepper.solve_static());
    EXPECT_TRUE(stepper.fluid_pressure().allFinite());
    EXPECT_GE(stepper.fluid_pressure().minCoeff(), 0.0);
  }
  const Mesh& mesh = scene.mesh;
  Hydrostatics fluid(mesh, *scene.csf, gravity_down);
  double before = -1.0;
  for (const double level : {std::nextafter(20.0, 0.0), 20.0, std::nextafter(20.0, 30.0)}) {
    const double lift = force_at(fluid, mesh.nodes(), {level}).col(2).sum();
    EXPECT_TRUE(std::isfinite(lift));
    EXPECT_TRUE(before < 0.0 || std::abs(lift - before) <= 1e-12 * lift);
    before = lift;
  }
}

TEST(FluidLimits, F4_levels_below_above_and_beyond) {
  Stepper stepper(busy_scene(2, 0.3));
  for (const double level : {-1.0, -3.0, -1e9}) {
    stepper.csf().set_level(0, level);
    const SolveReport report = stepper.solve_static();
    expect_converged(report);
    EXPECT_TRUE(stepper.fluid_force().isZero(0.0)) << level;
  }
  for (const double bad : {nan, std::numeric_limits<double>::infinity()})
    expect_error(ErrorCode::not_finite, {"'all'"}, [&] { stepper.csf().set_level(0, bad); });
  const ShownState before(stepper);
  stepper.csf().set_level(0, 1e9);
  expect_error(ErrorCode::invalid_argument, {"'all'"}, [&] { stepper.solve_static(); });
  EXPECT_TRUE(ShownState(stepper) == before);
  for (const double lost : {1e9, -1e9}) {
    stepper.csf().set_lost_volume(0, lost);
    expect_error(ErrorCode::fluid_volume, {"'all'"}, [&] { stepper.solve_static(); });
    EXPECT_TRUE(ShownState(stepper) == before);
  }
}

TEST(FluidLimits, F5_a_hole_in_the_body_is_refused) {
  Scene scene = ball_scene();
  Compartment c = scene.csf->compartment(0);
  c.body_faces.erase(c.body_faces.begin() + 7);
  scene.csf.emplace(fluid_density, FluidModel::separate, std::vector<Compartment>{c});
  expect_error(ErrorCode::surface_not_closed, {"'all'"}, [&] { Stepper s(scene); });
}

TEST(FluidLimits, F6_down_and_up_again_is_where_it_began) {
  Stepper stepper(busy_scene(3, 0.3));
  const std::vector<double> levels{30.0, 24.0, 15.0, 6.0, -2.0, 6.0, 15.0, 24.0, 30.0};
  std::vector<Points> u;
  for (const double level : levels) {
    stepper.csf().set_level(0, level);
    expect_converged(stepper.solve_static());
    u.push_back(stepper.displacement());
  }
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LE(largest_distance(u[i], u[levels.size() - 1 - i]), 1e-6) << levels[i];
  }
  stepper.csf().set_full(0);
  expect_converged(stepper.solve_static());
  EXPECT_LE(largest(stepper.displacement()), 1e-6);
}

// With the follower load in the tangent Newton's method keeps its quadratic end.
TEST(FluidLimits, F7_the_follower_load_costs_no_iterations) {
  Stepper stepper(busy_scene(3, 0.3));
  stepper.csf().set_level(0, 10.0);
  const SolveReport report = stepper.solve_static();
  expect_converged(report);
  EXPECT_EQ(report.load_steps, 1);
  EXPECT_LE(report.iterations, 12);
}

// A box with a cube left out of its middle: fluid inside pushes outwards, and both together lift by
// what the tissue alone displaces.
TEST(FluidLimits, F8_a_cavity_inside_is_pushed_from_within) {
  TetShape shape = make_box({30, 30, 30}, 3, 3, 3);
  Tets kept(shape.tets.rows() - 6, 4);
  kept << shape.tets.topRows(6 * 13), shape.tets.bottomRows(6 * 13);  // without the middle cell
  const Mesh mesh(shape.points, kept);
  EXPECT_NEAR(mesh.volume(), 26000.0, 1e-8);
  EXPECT_NEAR(enclosed_volume(mesh.nodes(), mesh.surface()), 26000.0, 1e-8);
  const Csf csf(fluid_density, FluidModel::separate,
                {make_compartment("all", box_wall({-3, -3, -3}, {33, 33, 34}), all_faces(mesh))});
  Hydrostatics fluid(mesh, csf, gravity_down);
  Points force = force_at(fluid, mesh.nodes(), {34.0});
  EXPECT_NEAR(force.col(2).sum(), weight * 26000.0, 1e-9);
  double outward = 0.0;  // on the eight nodes of the inner cube
  for (const Index i : nodes_where(mesh, [](const Vec3& x) {
         return (x - Vec3(15, 15, 15)).cwiseAbs().maxCoeff() < 6.0;
       })) {
    outward += force.row(i).dot((mesh.nodes().row(i).transpose() - Vec3(15, 15, 15)).transpose());
  }
  EXPECT_GT(outward, 0.0);
}

TEST(FluidLimits, F9_heights_turn_with_gravity) {
  const BallInCavity s(30.0, 4);
  for (const Vec3& down : {Vec3(0, 0, -1), Vec3(0, -0.97, -0.26), Vec3(1, 0, 0), Vec3(1, 2, -3)}) {
    const Vec3 g = standard_gravity * down.normalized();
    const Vec3 net = pushed(s, g, 5.0).colwise().sum().transpose();
    EXPECT_LE(net.cross(g).norm(), 1e-10 * net.norm() * g.norm());
    EXPECT_LT(net.dot(g), 0.0);
  }
}

// Two compartments that share one body, full on one side and half empty on the other: the difference
// pushes sideways, by the weight of the fluid on the projected area.
TEST(FluidLimits, F10_unequal_levels_push_sideways_by_the_closed_form) {
  const Mesh mesh = make_mesh(make_box({20, 20, 20}, 2, 2, 2));
  Indices left, right;
  for (Index f = 0; f < Index(mesh.surface().rows()); ++f) {
    double x = 0.0;
    for (int k = 0; k < 3; ++k) x += mesh.nodes()(mesh.surface()(f, k), 0) / 3.0;
    (x < 10.0 ? left : right).push_back(f);
  }
  std::vector<Compartment> sides{
      make_compartment("left", box_wall({-10, -5, -5}, {10, 25, 25}), left),
      make_compartment("right", box_wall({10, -5, -5}, {30, 25, 25}), right)};
  for (Compartment& c : sides) c.body_faces.clear();  // volumes do not matter here
  const Csf csf(fluid_density, FluidModel::separate, sides);
  Hydrostatics fluid(mesh, csf, gravity_down);
  const Vec3 net = force_at(fluid, mesh.nodes(), {20.0, 10.0}).colwise().sum().transpose();
  const double sideways = weight * 20.0 * (20.0 * 20.0 - 10.0 * 10.0) / 2.0;
  EXPECT_NEAR(net.x(), sideways, 1e-9 * sideways);
  EXPECT_NEAR(net.y(), 0.0, 1e-9 * sideways);
}

}  // namespace
}  // namespace brainshift::test
