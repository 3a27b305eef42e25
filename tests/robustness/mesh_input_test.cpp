// Meshes that are wrong, or odd: refused by name, or taken for what they are.
#include <limits>

#include "mesh/surface_topology.hpp"
#include "robustness/outcome.hpp"

namespace brainshift::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TetShape box() { return make_box({20, 20, 20}, 2, 2, 2); }

Mesh mesh_of(const TetShape& shape, MeshOptions options = {}) {
  return Mesh(shape.points, shape.tets, {}, options);
}

// One tet cut into four at a point `height` (part of its own height) above one of its faces.
TetShape with_sliver(double height) {
  TetShape shape = make_box({20, 20, 20}, 3, 3, 3);
  constexpr Eigen::Index tet = 80;
  const Eigen::Matrix<Index, 1, 4> corners = shape.tets.row(tet);
  Vec3 face = Vec3::Zero();
  for (int a = 0; a < 3; ++a) face += shape.points.row(corners[a]).transpose() / 3.0;
  const Index added = Index(shape.points.rows());
  shape.points.conservativeResize(added + 1, 3);
  const Vec3 apex = shape.points.row(corners[3]).transpose();
  shape.points.row(added) = (face + height * (apex - face)).transpose();
  const Eigen::Index count = shape.tets.rows();
  shape.tets.conservativeResize(count + 3, 4);
  for (int a = 0; a < 4; ++a) {
    const Eigen::Index row = a < 3 ? count + a : tet;
    shape.tets.row(row) = corners;
    shape.tets(row, a) = added;
  }
  return shape;
}

TEST(MeshInput, M1_a_tet_turned_inside_out_is_named_or_turned_on_request) {
  TetShape shape = box();
  std::swap(shape.tets(5, 0), shape.tets(5, 1));
  expect_error(ErrorCode::inverted_element, {"tet 5", "orient"}, [&] { mesh_of(shape); });
  MeshOptions turn;
  turn.orient = true;
  const Mesh mesh = mesh_of(shape, turn);
  EXPECT_EQ(mesh.reoriented(), 1);
  EXPECT_NEAR(mesh.volume(), 8000.0, 1e-9);
}

TEST(MeshInput, M2_a_flat_tet_is_named) {
  TetShape shape = box();
  shape.tets.row(7) << 0, 1, 3, 4;  // a square of the base
  expect_error(ErrorCode::degenerate_element, {"tet 7"}, [&] { mesh_of(shape); });
}

// Accepted down to where rounding takes over; the worst angle is there for the host to ask. A solve on
// such a mesh converges and its answer is that of the mesh without the sliver, or it says that it
// does not: the noise of a tet so thin may be above the tolerance.
TEST(MeshInput, M3_a_sliver_solves_or_says_so) {
  Scene scene = cube_on_base(Law::corotational, {0, 0, -standard_gravity}, 3);
  Stepper plain(scene);
  ASSERT_TRUE(plain.solve_static().converged());
  for (const double height : {1e-1, 1e-3, 1e-6, 1e-9, 1e-12}) {
    scene.mesh = make_mesh(with_sliver(height));
    EXPECT_LE(scene.mesh.smallest_dihedrals().minCoeff(), 200.0 * height) << "degrees";
    Stepper stepper(scene);
    const SolveReport report = stepper.solve_static();
    std::printf("M3: height %.0e: %s, residual %.1e\n", height, to_string(report.status),
                report.residual);
    expect_converged_or_failed(report);
    EXPECT_TRUE(report.converged() || height < 1e-6) << height << report.message;
    if (!report.converged()) continue;
    const Points u = stepper.displacement().topRows(plain.displacement().rows());
    // One tet of 162 made softer by its new node.
    EXPECT_LE(largest_distance(u, plain.displacement()), 0.02 * largest(plain.displacement()));
  }
  expect_error(ErrorCode::degenerate_element, {"tet 80"}, [] { make_mesh(with_sliver(1e-15)); });
}

TEST(MeshInput, M4_repeated_node_in_a_tet) {
  TetShape shape = box();
  shape.tets(3, 2) = shape.tets(3, 0);
  expect_error(ErrorCode::degenerate_element, {"tet 3", "twice"}, [&] { mesh_of(shape); });
}

TEST(MeshInput, M5_indices_outside_the_nodes) {
  constexpr Index most = std::numeric_limits<Index>::max();
  for (const Index node : {Index(-1), Index(27), Index(27 + 12345), most, Index(-most - 1)}) {
    TetShape shape = box();
    shape.tets(11, 3) = node;
    expect_error(ErrorCode::index_out_of_range, {"tet 11", std::to_string(node) + " of 27"},
                 [&] { mesh_of(shape); });
  }
}

TEST(MeshInput, M6_a_node_without_a_tet_is_named) {
  TetShape shape = box();
  shape.points.conservativeResize(28, 3);
  shape.points.row(27) << 50, 50, 50;
  expect_error(ErrorCode::orphan_node, {"node 27"}, [&] { mesh_of(shape); });
}

TEST(MeshInput, M7_a_body_that_nothing_holds_has_no_rest_but_moves_in_time) {
  Scene scene = cube_on_base(Law::corotational);
  scene.mesh = make_mesh(joined(box(), moved(box(), {30, 0, 0})));
  scene.constraints = {};
  scene.constraints.fix(
      "base", nodes_where(scene.mesh, [](const Vec3& x) { return x.z() == 0.0 && x.x() < 25.0; }));
  Stepper stepper(scene);
  const ShownState before(stepper);
  expect_error(ErrorCode::rigid_mode, {"body 1", "6 rigid"}, [&] { stepper.solve_static(); });
  EXPECT_TRUE(ShownState(stepper) == before);
  expect_converged(stepper.step(0.01));
  // Free fall: one step of backward Euler falls by g dt^2.
  const double fall = standard_gravity * 0.01 * 0.01;
  EXPECT_NEAR(stepper.displacement().bottomRows(27).col(2).mean(), -fall, 1e-9);
}

TEST(MeshInput, M8_the_same_tet_twice) {
  TetShape shape = box();
  shape.tets.row(20) << shape.tets(4, 1), shape.tets(4, 2), shape.tets(4, 0), shape.tets(4, 3);
  expect_error(ErrorCode::duplicate_element, {"tets 4 and 20"}, [&] { mesh_of(shape); });
}

// A warning would be wrong here: matching interfaces, such as the seam between two hemispheres, are
// made of nodes that coincide. A crack shows in the number of components, and a half that is held by
// nothing else ends in rigid_mode.
TEST(MeshInput, M9_coincident_nodes_are_two_bodies) {
  const TetShape cracked = joined(box(), moved(box(), {20, 0, 0}));
  Scene scene = cube_on_base(Law::corotational);
  scene.mesh = make_mesh(cracked);
  EXPECT_EQ(scene.mesh.component_count(), 2);
  EXPECT_EQ(scene.mesh.surface().rows(), 2 * mesh_of(box()).surface().rows());
  scene.constraints = {};
  scene.constraints.fix("side",
                        nodes_where(scene.mesh, [](const Vec3& x) { return x.x() == 0.0; }));
  expect_error(ErrorCode::rigid_mode, {"body 1"}, [&] { Stepper(scene).solve_static(); });
}

// Tets that meet in a vertex or an edge only: normals come from the owning tet, so the surface
// encloses the volume; the hinge has no stiffness, which a solve survives or reports.
TEST(MeshInput, M10_bodies_that_hang_together_by_a_vertex_or_an_edge) {
  for (const Index shared : {1, 2}) {
    TetShape shape{Points(8 - shared, 3), Tets(2, 4)};
    shape.points.topRows<5>() << 0, 0, 0, 10, 0, 0, 0, 10, 0, 0, 0, 10, -10, 0, 0;
    if (shared == 1) shape.points.bottomRows<2>() << 0, -10, 0, 0, 0, -10;
    if (shared == 2) shape.points.row(5) << 0, -10, 0;
    shape.tets.row(0) << 0, 1, 2, 3;
    if (shared == 1) shape.tets.row(1) << 0, 4, 5, 6;
    if (shared == 2) shape.tets.row(1) << 0, 4, 5, 3;
    MeshOptions turn;
    turn.orient = true;
    const Mesh mesh = mesh_of(shape, turn);
    EXPECT_EQ(mesh.component_count(), 1);
    EXPECT_EQ(mesh.surface().rows(), 8);
    EXPECT_NEAR(enclosed_volume(mesh.nodes(), mesh.surface()), mesh.volume(), 1e-10);
    Scene scene{mesh, {{0, Material(Law::corotational, 6.0, 0.45, tissue_density)}}};
    scene.balanced_reference = false;
    scene.constraints.fix("one of them", {0, 1, 2, 3});
    Stepper stepper(scene);
    const SolveReport report = stepper.solve_static();
    std::printf("M10: %d shared: %s, moved by %.2e mm\n", int(shared), to_string(report.status),
                largest(stepper.displacement()));
    expect_converged_or_failed(report);
    expect_converged(stepper.step(0.001));
  }
}

TEST(MeshInput, M11_coordinates_that_are_no_length) {
  for (const double bad : {nan, infinity, -infinity}) {
    TetShape shape = box();
    shape.points(13, 1) = bad;
    expect_error(ErrorCode::not_finite, {"nodes", "13"}, [&] { mesh_of(shape); });
  }
  for (const double far : {1e300, 1e160, 1e110, -1e155}) {  // volumes beyond double
    TetShape shape = box();
    shape.points(13, 1) = far;
    EXPECT_THROW(mesh_of(shape), Error) << far;
    shape = box();
    shape.points *= std::abs(far);
    EXPECT_THROW(mesh_of(shape), Error) << far;
  }
  TetShape shape = box();
  shape.points *= 1e-310;
  expect_error(ErrorCode::degenerate_element, {"tet 0"}, [&] { mesh_of(shape); });
  shape = box();
  shape.points(0, 0) = 1e-310;  // as good as zero
  EXPECT_NEAR(mesh_of(shape).volume(), 8000.0, 1e-9);
}

// A check of plausibility is the host's: the core has no notion of a head. What it owes is that no
// absolute length or force is hidden in it: the same body in metres gives the same shape.
TEST(MeshInput, M12_no_absolute_size_is_hidden) {
  const auto solve = [](double length, double force) {
    Scene scene = cube_on_base(Law::stable_neo_hookean);
    TetShape shape = box();
    shape.points *= length;
    scene.mesh = make_mesh(shape);
    const double young = 6.0 * force;
    scene.materials = {
        {0, Material(Law::stable_neo_hookean, young, 0.45, tissue_density * force / length)}};
    Stepper stepper(scene);
    expect_converged(stepper.solve_static());
    return Points(stepper.displacement() / length);
  };
  const Points plain = solve(1.0, 1.0);
  EXPECT_GT(largest(plain), 0.1);
  EXPECT_LE(largest_distance(solve(1e-3, 1.0), plain), 1e-9);
  EXPECT_LE(largest_distance(solve(1e3, 1e3), plain), 1e-9);
  EXPECT_LE(largest_distance(solve(1e-6, 1e12), plain), 1e-9);
}

TEST(MeshInput, M13_no_tet_one_tet_and_more_than_can_be_counted) {
  expect_error(ErrorCode::empty, {"no nodes"}, [] { Mesh(Points(0, 3), Tets(0, 4)); });
  expect_error(ErrorCode::empty, {"no tets"}, [] { Mesh(Points::Zero(4, 3), Tets(0, 4)); });
  TetShape one{Points(4, 3), Tets(1, 4)};
  one.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  one.tets << 0, 1, 2, 3;
  EXPECT_EQ(mesh_of(one).surface().rows(), 4);
  // Counted in 64 bits, before anything is allocated.
  expect_error(ErrorCode::invalid_argument, {"tets"},
               [] { checked_count(std::int64_t(1) << 31, "tets"); });
  EXPECT_EQ(checked_count((std::int64_t(1) << 31) - 1, "tets"), 2147483647);
}

// Faces are rows of Mesh::surface(), outward by the tet that owns them: a face that is not on the
// boundary or inward cannot be said; a row that is not there is refused.
TEST(MeshInput, M14_faces_are_turned_by_their_tets) {
  TetShape shape = box();
  for (Eigen::Index t = 0; t < shape.tets.rows(); ++t) {  // another order of each, as well turned
    const Eigen::Matrix<Index, 1, 4> old = shape.tets.row(t);
    shape.tets.row(t) << old[1], old[2], old[0], old[3];
  }
  const Mesh mesh = mesh_of(shape);
  EXPECT_NEAR(enclosed_volume(mesh.nodes(), mesh.surface()), 8000.0, 1e-9);
  Scene scene = cube_on_base(Law::linear);
  Compartment all = make_compartment("all", box_wall({-5, -5, -5}, {25, 25, 25}), all_faces(mesh));
  all.wetted_faces.push_back(Index(mesh.surface().rows()));
  scene.csf.emplace(fluid_density, FluidModel::separate, std::vector<Compartment>{all});
  expect_error(ErrorCode::index_out_of_range, {"'all'"}, [&] { Stepper s(scene); });
}

// The diagonals of a grid of cells lean to one side, and so does a body made of it: the mirror image
// of the grid leans as much to the other side.
TEST(MeshInput, M15_the_mirrored_grid_gives_the_mirrored_answer) {
  const auto solve = [](Diagonal diagonal) {
    Scene scene = cube_on_base(Law::corotational);
    scene.mesh = make_mesh(make_box({20, 20, 40}, 2, 2, 4, diagonal));
    scene.constraints = {};
    scene.constraints.fix("base", bottom(scene.mesh));
    Stepper stepper(scene);
    expect_converged(stepper.solve_static());
    return stepper.displacement();
  };
  double worst = 0.0;
  const Points rising = solve(Diagonal::rising), mirrored = solve(Diagonal::mirrored);
  for (int k = 0; k <= 4; ++k)
    for (int j = 0; j <= 2; ++j)
      for (int i = 0; i <= 2; ++i) {
        Vec3 a = rising.row(box_node(2, 2, i, j, k)), b = mirrored.row(box_node(2, 2, 2 - i, j, k));
        b.x() = -b.x();
        worst = std::max(worst, (a - b).norm());
      }
  EXPECT_LE(worst, 1e-9);
  EXPECT_GT(largest(rising), 0.5);
}

}  // namespace
}  // namespace brainshift::test
