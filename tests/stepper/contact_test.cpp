// One-sided contact from end to end: closed forms, balance of forces, complementarity.
#include <gtest/gtest.h>

#include "support/laws.hpp"
#include "support/scenes.hpp"

namespace brainshift {
namespace {

constexpr double size = 20.0;

Scene block_scene(Law law, double poisson, int cells = 3, double density = test::tissue_density) {
  Scene scene{test::make_mesh(test::make_box({size, size, size}, cells, cells, cells)),
              {{0, Material(law, 6.0, poisson, density)}},
              Vec3(0, 0, -standard_gravity),
              {},
              {}};
  scene.balanced_reference = false;
  return scene;
}

// A flat floor far wider than the block, its normal +z, at height z.
Surface floor_at(double z) {
  return Surface::sheet(test::moved(test::make_sheet(60, 60, 6, 6), {-20, -20, z}).points,
                        test::make_sheet(60, 60, 6, 6).triangles);
}

Indices bottom(const Mesh& mesh) {
  return test::nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; });
}

// Holds a block sideways without hindering it: two faces slide in their planes.
void hold_sideways(Scene& scene) {
  const Mesh& mesh = scene.mesh;
  scene.constraints.fix("x", test::nodes_where(mesh, [](const Vec3& x) { return x.x() == 0.0; }),
                        {true, false, false});
  scene.constraints.fix("y", test::nodes_where(mesh, [](const Vec3& x) { return x.y() == 0.0; }),
                        {false, true, false});
}

void expect_complementary(const ContactState& c, double length, double force) {
  for (Eigen::Index i = 0; i < c.gap.size(); ++i) {
    EXPECT_GE(c.gap[i], -1e-9 * length);
    EXPECT_GE(c.multiplier[i], 0.0);
    EXPECT_LE(std::min(c.gap[i] / length, c.multiplier[i] / force), 1e-8) << i;
  }
}

TEST(Contact, MultipliersOfABlockOnAFloorCarryItsWeight) {
  for (Law law : test::all_laws) {
    Scene scene = block_scene(law, 0.45);
    hold_sideways(scene);
    const ConstraintId floor =
        scene.constraints.obstacle("floor", bottom(scene.mesh), floor_at(0.0));
    Stepper stepper(scene);
    const SolveReport report = stepper.solve_static();
    ASSERT_TRUE(report.converged()) << to_string(law) << ": " << report.message;
    const ContactState c = stepper.contact(floor);
    const double weight = test::tissue_density * size * size * size * standard_gravity;
    // residual tolerance 1e-8 of the largest nodal force
    EXPECT_NEAR(c.force.col(2).sum(), weight, 1e-7 * weight) << to_string(law);
    EXPECT_NEAR(c.multiplier.sum(), weight, 1e-6 * weight) << to_string(law);  // gradient ~ unit
    EXPECT_LT(c.force.leftCols<2>().cwiseAbs().maxCoeff(), 1e-6 * weight);     // no friction
    EXPECT_EQ(c.active, report.active_contacts);
    EXPECT_LE(report.residual, 1e-8);
    EXPECT_LE(report.complementarity, 1e-8);
    expect_complementary(c, size, weight);
  }
}

TEST(Contact, ALinearBlockUnderItsWeightOnASmoothFloorHasTheClosedForm) {
  // nu = 0 keeps plane sections plane: u_z(top) = -density g H^2 / 2E; 2 % of discretisation.
  Scene scene = block_scene(Law::linear, 0.0, 6);
  hold_sideways(scene);
  scene.constraints.obstacle("floor", bottom(scene.mesh), floor_at(0.0));
  Stepper stepper(scene);
  ASSERT_TRUE(stepper.solve_static().converged());
  const Indices top = test::nodes_where(scene.mesh, [](const Vec3& x) { return x.z() == size; });
  const double expected = -test::tissue_density * standard_gravity * size * size / (2.0 * 6.0);
  EXPECT_NEAR(test::mean_row(stepper.displacement(), top).z(), expected, 0.02 * std::abs(expected));
}

TEST(Contact, ABlockLoweredOntoTheFloorSinksUntilItRests) {
  // The floor lies 1 mm below; nothing holds the block but the floor (and sideways supports).
  Scene scene = block_scene(Law::corotational, 0.45);
  hold_sideways(scene);
  const ConstraintId floor =
      scene.constraints.obstacle("floor", bottom(scene.mesh), floor_at(-1.0));
  Stepper stepper(scene);
  const SolveReport report = stepper.solve_static();
  ASSERT_TRUE(report.converged()) << report.message;
  const double weight = test::tissue_density * size * size * size * standard_gravity;
  EXPECT_NEAR(stepper.contact(floor).force.col(2).sum(), weight, 1e-7 * weight);
  EXPECT_NEAR(test::mean_row(stepper.displacement(), bottom(scene.mesh)).z(), -1.0, 0.05);
}

TEST(Contact, OffsetKeepsTheDistance) {
  Scene scene = block_scene(Law::corotational, 0.45);
  hold_sideways(scene);
  scene.constraints.obstacle("floor", bottom(scene.mesh), floor_at(-1.0), 1.0,
                             Eigen::VectorXd::Constant(1, 0.75));
  Stepper stepper(scene);
  ASSERT_TRUE(stepper.solve_static().converged());
  double lowest = 0.0;
  for (Index i : bottom(scene.mesh)) lowest = std::min(lowest, stepper.displacement()(i, 2));
  EXPECT_NEAR(lowest, -0.25, 1e-6);
}

TEST(Contact, ABlockPressedIntoACornerOfThreeWallsRests) {
  // Three one-sided walls and gravity into the corner: nodes with one, two and three active rows.
  Scene scene = block_scene(Law::corotational, 0.3);
  scene.gravity = standard_gravity * Vec3(-1, -1, -1).normalized();
  const auto wall = [](int axis) {
    const test::SurfaceShape sheet = test::moved(test::make_sheet(60, 60, 6, 6), {-20, -20, 0});
    Points p = sheet.points;
    for (Eigen::Index i = 0; i < p.rows(); ++i) {  // cyclic: z -> axis, keeps the turn
      const Vec3 q = sheet.points.row(i).transpose();
      p(i, axis) = q.z();
      p(i, (axis + 1) % 3) = q.x();
      p(i, (axis + 2) % 3) = q.y();
    }
    return Surface::sheet(p, sheet.triangles);
  };
  ConstraintId id[3];
  for (int axis = 0; axis < 3; ++axis) {
    id[axis] = scene.constraints.obstacle(
        "wall", test::nodes_where(scene.mesh, [axis](const Vec3& x) { return x[axis] == 0.0; }),
        wall(axis));
  }
  Stepper stepper(scene);
  const SolveReport report = stepper.solve_static();
  ASSERT_TRUE(report.converged()) << report.message;
  const double weight =
      test::tissue_density * size * size * size * standard_gravity / std::sqrt(3.0);
  for (int axis = 0; axis < 3; ++axis) {
    const ContactState c = stepper.contact(id[axis]);
    EXPECT_NEAR(c.force.col(axis).sum(), weight, 1e-6 * weight) << axis;
    expect_complementary(c, size, weight);
  }
}

TEST(Contact, ABallDropsInASphericalCavityAndIsCarried) {
  const Mesh mesh = test::make_mesh(test::make_ball(30.0, 6));
  const auto sphere = test::make_icosphere(33.0, 3);
  Scene scene{mesh,
              {{0, Material(Law::corotational, 6.0, 0.45, test::tissue_density)}},
              Vec3(0, 0, -standard_gravity),
              {},
              {}};
  scene.balanced_reference = false;
  const ConstraintId skull = scene.constraints.obstacle(
      "skull", test::surface_nodes(mesh), Surface::cavity(sphere.points, sphere.triangles));
  // Only the turning about the axes is free otherwise: springs far softer than the tissue.
  scene.constraints.support("soft", test::all_nodes(mesh), Eigen::VectorXd::Constant(1, 1e-4));
  Stepper stepper(scene);
  const SolveReport report = stepper.solve_static();
  ASSERT_TRUE(report.converged()) << report.message;
  const ContactState c = stepper.contact(skull);
  const double weight = mesh.volume() * test::tissue_density * standard_gravity;
  double springs = 0.0;
  for (Index i = 0; i < mesh.node_count(); ++i) springs -= 1e-4 * stepper.displacement()(i, 2);
  EXPECT_NEAR(c.force.col(2).sum() + springs, weight, 1e-6 * weight);
  EXPECT_GT(c.active, 3);
  EXPECT_LT(test::mean_row(stepper.displacement(), test::all_nodes(mesh)).z(), -2.0);
  expect_complementary(c, 60.0, weight);
  // Centred: the cavity has no preferred side
  EXPECT_LT(std::abs(test::mean_row(stepper.displacement(), test::all_nodes(mesh)).x()), 0.1);
}

TEST(Contact, NodesKeepTheirSideOfATwoSidedSheet) {
  // Two blocks with a stiff sheet between them, gravity pushing one towards it.
  const auto left = test::moved(test::make_box({10, 10, 10}, 2, 2, 2), {-11, 0, 0});
  const auto right = test::moved(test::make_box({10, 10, 10}, 2, 2, 2), {1, 0, 0});
  const Mesh mesh = test::make_mesh(test::joined(left, right));
  Scene scene{mesh,
              {{0, Material(Law::corotational, 1.0, 0.45, 3e-6)}},
              Vec3(standard_gravity, 0, 0),
              {},
              {}};
  scene.balanced_reference = false;
  // The sheet x = 0 with normal +x.
  const test::SurfaceShape flat = test::make_sheet(40, 40, 8, 8);
  Points p(flat.points.rows(), 3);
  for (Eigen::Index i = 0; i < p.rows(); ++i) {
    p.row(i) << 0.0, flat.points(i, 0) - 15.0, flat.points(i, 1) - 15.0;
  }
  const Surface sheet = Surface::sheet(p, flat.triangles);
  const Indices of_left = test::nodes_where(mesh, [](const Vec3& x) { return x.x() < 0.0; });
  const Indices of_right = test::nodes_where(mesh, [](const Vec3& x) { return x.x() > 0.0; });
  scene.constraints.fix("ends",
                        test::nodes_where(mesh,
                                          [](const Vec3& x) {
                                            return x.x() == 11.0 ||
                                                   (x.y() == 0.0 && x.z() == 0.0 && x.x() == -11.0);
                                          }),
                        {false, true, true});
  scene.constraints.fix("right end",
                        test::nodes_where(mesh, [](const Vec3& x) { return x.x() == 11.0; }));
  scene.constraints.support("soft", of_left, Eigen::VectorXd::Constant(1, 1e-2));
  const ConstraintId l = scene.constraints.obstacle("left", of_left, sheet, -1.0);
  const ConstraintId r = scene.constraints.obstacle("right", of_right, sheet, 1.0);
  Stepper stepper(scene);
  ASSERT_TRUE(stepper.solve_static().converged());
  EXPECT_GT(stepper.contact(l).active, 0);
  EXPECT_EQ(stepper.contact(r).active, 0);
  for (Index i : of_left) EXPECT_LE(stepper.positions()(i, 0), 1e-7);
  for (Index i : of_right) EXPECT_GE(stepper.positions()(i, 0), -1e-7);
  // Now the other way: the right block is held, so the left falls away from the sheet.
  stepper.set_gravity(Vec3(-standard_gravity, 0, 0));
  ASSERT_TRUE(stepper.solve_static().converged());
  EXPECT_EQ(stepper.contact(l).active, 0);
}

// Two blocks, one on the other, meeting node to node.
struct Stack {
  Scene scene;
  Indices upper, lower;  // the interface, node by node
  Stack(bool upper_is_node)
      : scene{test::make_mesh(
                  test::joined(test::make_box({10, 10, 10}, 2, 2, 2),
                               test::moved(test::make_box({10, 10, 10}, 2, 2, 2), {0, 0, 10}))),
              {{0, Material(Law::corotational, 6.0, 0.3, test::tissue_density)}},
              Vec3(0, 0, -standard_gravity),
              {},
              {}} {
    scene.balanced_reference = false;
    const Mesh& mesh = scene.mesh;
    const Index half = mesh.node_count() / 2;
    for (Index i = 0; i < half; ++i) {
      if (mesh.nodes()(i, 2) != 10.0) continue;
      for (Index j = half; j < mesh.node_count(); ++j) {
        if ((mesh.nodes().row(i) - mesh.nodes().row(j)).norm() < 1e-12) {
          lower.push_back(i);
          upper.push_back(j);
        }
      }
    }
    scene.constraints.fix("floor",
                          test::nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; }));
    Points up(Eigen::Index(upper.size()), 3);
    up.rowwise() = Vec3(0, 0, upper_is_node ? 1.0 : -1.0).transpose();
    if (upper_is_node) {
      pair = scene.constraints.opposing("interface", upper, lower, up);
    } else {
      pair = scene.constraints.opposing("interface", lower, upper, up);
    }
    // The upper block slides freely: hold it at its corner and against turning.
    scene.constraints.support("soft",
                              test::nodes_where(mesh, [](const Vec3& x) { return x.z() == 20.0; }),
                              Eigen::VectorXd::Constant(1, 1e-5));
  }
  ConstraintId pair;
};

TEST(Contact, OpposingPairsCarryTheUpperOfTwoBlocks) {
  for (bool upper_is_node : {true, false}) {
    Stack stack(upper_is_node);
    Stepper stepper(stack.scene);
    const SolveReport report = stepper.solve_static();
    ASSERT_TRUE(report.converged()) << report.message;
    const ContactState c = stepper.contact(stack.pair);
    const double weight = test::tissue_density * 1000.0 * standard_gravity;
    EXPECT_NEAR(c.multiplier.sum(), weight, 1e-3 * weight);  // springs carry the rest
    expect_complementary(c, 20.0, weight);
    for (std::size_t i = 0; i < stack.upper.size(); ++i) {
      EXPECT_GE(stepper.positions()(stack.upper[i], 2),
                stepper.positions()(stack.lower[i], 2) - 1e-7);
    }
  }
}

TEST(Contact, OpposingPairsLetGoWhenPulledApart) {
  Stack stack(true);
  stack.scene.gravity = Vec3(0, 0, -0.01 * standard_gravity);
  Stepper stepper(stack.scene);
  ASSERT_TRUE(stepper.solve_static().converged());
  stepper.set_gravity(Vec3(0, 0, 1e-5 * standard_gravity));
  ASSERT_TRUE(stepper.solve_static().converged());
  const ContactState c = stepper.contact(stack.pair);
  EXPECT_EQ(c.active, 0);
  EXPECT_GT(c.gap.minCoeff(), 0.0);
}

TEST(Contact, AHeldNodeStillHoldsItsPartnerUp) {
  // The lower block wholly fixed, listed first or second in the pair: the upper must not fall through.
  for (bool upper_is_node : {true, false}) {
    Stack stack(upper_is_node);
    const Mesh& mesh = stack.scene.mesh;
    Indices below;
    for (Index i = 0; i < mesh.node_count() / 2; ++i) below.push_back(i);
    stack.scene.constraints.fix("all of the lower", below);
    Stepper stepper(stack.scene);
    const SolveReport report = stepper.solve_static();
    ASSERT_TRUE(report.converged()) << upper_is_node << ": " << report.message;
    const double weight = test::tissue_density * 1000.0 * standard_gravity;
    EXPECT_NEAR(stepper.contact(stack.pair).multiplier.sum(), weight, 1e-3 * weight);
    EXPECT_GE(stepper.contact(stack.pair).gap.minCoeff(), -1e-7);
  }
}

TEST(Contact, ABodyHeldOnlyAsTheSecondOfAPairCountsAsHeld) {
  Stack stack(false);
  EXPECT_NO_THROW(Stepper{stack.scene});
  Scene without = stack.scene;
  without.constraints.remove(without.constraints.groups().back().id);  // the soft springs
  EXPECT_NO_THROW(Stepper{without});
}

}  // namespace
}  // namespace brainshift
