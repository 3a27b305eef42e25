// Scenes on quadratic tets: constraints reach the nodes on edges, and solves do what they do on linear ones.
#include <algorithm>

#include <gtest/gtest.h>

#include "brainshift/error.hpp"
#include "support/elements.hpp"
#include "support/expect_error.hpp"
#include "support/scenes.hpp"

namespace brainshift {
namespace {

const ConstraintGroup& group_named(const Scene& scene, const std::string& name) {
  for (const ConstraintGroup& g : scene.constraints.groups()) {
    if (g.name == name) return g;
  }
  throw std::runtime_error("no group " + name);
}

// Two blocks side by side with matching nodes at x = 0: tied in their lower half, opposing above.
Scene two_blocks() {
  const auto half = test::make_box({10, 20, 20}, 2, 4, 4);
  const Mesh mesh = test::make_mesh(test::joined(test::moved(half, {-10, 0, 0}), half));
  const auto [nodes, partners] = test::seam(mesh, Index(half.points.rows()));
  Scene scene{mesh,
              {{0, Material(Law::corotational, 6.0, 0.45, test::tissue_density)}},
              Vec3(0, 0, -standard_gravity),
              {},
              {}};
  scene.balanced_reference = false;
  Indices low, low_partners, high, high_partners;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const bool below = mesh.nodes()(nodes[i], 2) < 9.0;
    (below ? low : high).push_back(nodes[i]);
    (below ? low_partners : high_partners).push_back(partners[i]);
  }
  Points normals(Eigen::Index(high.size()), 3);
  normals.rowwise() = Eigen::RowVector3d(-1, 0, 0);  // from the right block to the left
  scene.constraints.tie("bridge", low, low_partners);
  scene.constraints.opposing("halves", high, high_partners, normals);
  scene.constraints.fix("base",
                        test::nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; }));
  return scene;
}

TEST(QuadraticScene, EveryPairOfMatchingEdgeNodesOnTheSeamIsTiedOrOpposing) {
  const Scene scene = quadratic(two_blocks());
  Indices seam;  // edge nodes of the left block at x = 0
  for (Index i = 0; i < scene.mesh.node_count(); ++i) {
    const bool left = scene.mesh.components()[std::size_t(i)] == 0;
    if (left && !scene.mesh.is_corner(i) && scene.mesh.nodes()(i, 0) == 0.0) seam.push_back(i);
  }
  ASSERT_GT(seam.size(), 20u);
  std::size_t paired = 0;
  for (const char* name : {"bridge", "halves"}) {
    const ConstraintGroup& group = group_named(scene, name);
    EXPECT_EQ(group.nodes.size(), group.partners.size());
    for (std::size_t i = 0; i < group.nodes.size(); ++i) {
      EXPECT_EQ((scene.mesh.nodes().row(group.nodes[i]) - scene.mesh.nodes().row(group.partners[i]))
                    .norm(),
                0.0);
      paired += std::count(seam.begin(), seam.end(), group.nodes[i]);
    }
  }
  EXPECT_EQ(paired, seam.size());
  const ConstraintGroup& halves = group_named(scene, "halves");
  EXPECT_EQ(halves.normals.rows(), Eigen::Index(halves.nodes.size()));
  EXPECT_LE((halves.normals.col(0).array() + 1.0).abs().maxCoeff(), 1e-15);
}

// Pushed together by gravity from the side, the halves must not pass through each other.
TEST(QuadraticScene, HalvesPressOnEachOtherAsLinearOnesDo) {
  double moved[3];
  for (test::Element element : test::all_elements) {
    Scene scene = two_blocks();
    scene.gravity = Vec3(0.05 * standard_gravity, 0, 0);
    Stepper stepper(test::with_element(scene, element));
    const SolveReport report = stepper.solve_static();
    ASSERT_TRUE(report.converged()) << test::name_of(element) << ": " << report.message;
    EXPECT_GE(report.violation, -1e-9);
    Points top(2, 3);
    top << -0.001, 10, 20, 0.001, 10, 20;
    const Points u = stepper.displacement_at(top).values;
    moved[int(element)] = u(0, 0);
    EXPECT_LE(u(0, 0) - u(1, 0), 0.05) << "corners between closed edges may stand out a little";
  }
  // Four linear tets across bend half as far as quadratic ones; those that do not lock, further.
  EXPECT_GT(moved[0], 0.5 * moved[2]);
  EXPECT_GT(moved[1], moved[0]);
  EXPECT_GT(moved[2], moved[1]);
}

TEST(QuadraticScene, FixedFacesTakeInTheirEdgesAndNothingElse) {
  const Scene scene = quadratic(two_blocks());
  const ConstraintGroup& base = group_named(scene, "base");
  const Indices at_base = test::nodes_where(scene.mesh, [](const Vec3& x) { return x.z() == 0.0; });
  Indices sorted = base.nodes;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(sorted, at_base);
}

TEST(QuadraticScene, ASupportKeepsItsStiffnessAndObstaclesTheirTouch) {
  Scene linear = test::busy_scene(3, 0.05);
  const Surface skull = *group_named(linear, "skull").surface;
  const Indices bottom = test::nodes_where(linear.mesh, [](const Vec3& x) { return x.z() == 0.0; });
  Eigen::VectorXd touching(Eigen::Index(bottom.size()));
  for (std::size_t i = 0; i < bottom.size(); ++i) {
    touching[Eigen::Index(i)] = skull.distance(linear.mesh.nodes().row(bottom[i]).transpose());
  }
  linear.constraints.obstacle("touching", bottom, skull, 1.0, touching);
  const Scene scene = quadratic(linear);
  EXPECT_NEAR(group_named(scene, "stem").stiffness.sum(),
              group_named(linear, "stem").stiffness.sum(), 1e-12);
  for (Index node : group_named(scene, "stem").nodes) EXPECT_FALSE(scene.mesh.is_corner(node));
  const ConstraintGroup& group = group_named(scene, "touching");
  ASSERT_GT(group.nodes.size(), bottom.size());
  for (std::size_t i = 0; i < group.nodes.size(); ++i) {
    EXPECT_NEAR(group.offsets[Eigen::Index(i)],
                skull.distance(scene.mesh.nodes().row(group.nodes[i]).transpose()), 1e-12);
  }
}

TEST(QuadraticScene, FluidGravityAndContactSolveTogetherAndComeBack) {
  Stepper stepper(quadratic(test::busy_scene(3, 0.05)));
  stepper.csf().set_lost_volume(0, 4000.0);
  const SolveReport report = stepper.solve_static();
  ASSERT_TRUE(report.converged()) << report.message;
  EXPECT_NEAR(stepper.compartment(0).lost_volume, 4000.0, 1e-6);
  EXPECT_GT(stepper.displacement().rowwise().norm().maxCoeff(), 0.01);
  stepper.csf().set_full(0);
  ASSERT_TRUE(stepper.solve_static().converged());
  EXPECT_LE(stepper.displacement().rowwise().norm().maxCoeff(), 1e-6);
}

TEST(QuadraticScene, GroupsOfCornersAloneAreRefusedForContact) {
  Scene scene = test::busy_scene(2, 0.05);
  scene.mesh = scene.mesh.quadratic();  // without taking the constraints along
  test::expect_error(ErrorCode::invalid_argument, {"skull", "corners only"},
                     [&] { Stepper stepper(scene); });
}

TEST(QuadraticScene, NodalVolumesAreForLinearTets) {
  Scene scene = quadratic(test::busy_scene(2, 0.05));
  scene.volume_strain = VolumeStrain::nodal;
  test::expect_error(ErrorCode::invalid_argument, {"linear tets"}, [&] { Stepper stepper(scene); });
}

}  // namespace
}  // namespace brainshift
