// Poisson's ratio near one half, with the element there is: linear tets.
#include "robustness/outcome.hpp"
#include "tissue/tissue.hpp"

namespace brainshift::test {
namespace {

// No warning: that linear tets lock is under Limits in README.md, by how much in docs/numbers.md and
// tests/verify (ThickSphere). What a solve owes is a certificate that holds on the way there.
TEST(Incompressibility, N1_the_certificate_holds_up_to_0_499) {
  for (const double poisson : {0.45, 0.49, 0.499}) {
    Scene scene = busy_scene(3, 0.3);
    scene.materials = {{0, Material(Law::corotational, 6.0, poisson, tissue_density)}};
    Stepper stepper(scene);
    stepper.csf().set_lost_volume(0, 9000.0);
    expect_converged(stepper.solve_static());
  }
}

// Cook's membrane, 48 mm wide, 44 mm to 60 mm high, leaning under a load along its free side.
TEST(Incompressibility, N2_cooks_membrane_converges_and_locks) {
  double above = 1e9;
  for (const double poisson : {0.3, 0.49, 0.4999}) {
    TetShape shape = make_box({1, 1, 1}, 6, 6, 1);
    for (Eigen::Index i = 0; i < shape.points.rows(); ++i) {
      const double s = shape.points(i, 0), t = shape.points(i, 1);
      shape.points.row(i) << 48.0 * s, 44.0 * s + t * (44.0 - 28.0 * s), 8.0 * shape.points(i, 2);
    }
    Scene scene{make_mesh(shape),
                {{0, Material(Law::stable_neo_hookean, 6.0, poisson, tissue_density)}},
                {0, 0.1 * standard_gravity, 0}};
    scene.balanced_reference = false;
    scene.constraints.fix("wall",
                          nodes_where(scene.mesh, [](const Vec3& x) { return x.x() == 0.0; }));
    scene.constraints.fix("plane strain", all_nodes(scene.mesh), {false, false, true});
    Stepper stepper(scene);
    expect_converged(stepper.solve_static());
    const double tip = stepper.displacement().col(1).maxCoeff();
    EXPECT_GT(tip, 0.0);
    EXPECT_LT(tip, above) << poisson;
    above = tip;
  }
}

// Pressure alone squeezes a compressible body; the reference state takes that squeeze for what the
// image already shows.
TEST(Incompressibility, N3_hydrostatic_squeeze_is_not_taken_for_shift) {
  Scene scene = busy_scene(3, 0.3);
  const double volume = scene.mesh.volume();
  const auto change = [&](bool balanced) {
    scene.balanced_reference = balanced;
    scene.constraints.disable(0);  // the case would hold it
    Stepper stepper(scene);
    expect_converged(stepper.solve_static());
    return Mesh(stepper.positions(), scene.mesh.tets()).volume() / volume - 1.0;
  };
  EXPECT_EQ(change(true), 0.0);
  EXPECT_LT(change(false), -1e-4);
}

// Every node held: no unknown is left, and the load is carried without motion.
TEST(Incompressibility, N4_a_boundary_that_is_held_everywhere) {
  for (const double poisson : {0.45, 0.4999}) {
    Scene scene = cube_on_base(Law::corotational, {0, 0, -standard_gravity}, 3, poisson);
    scene.constraints.fix("surface", surface_nodes(scene.mesh));
    Stepper stepper(scene);
    expect_converged(stepper.solve_static());
    EXPECT_GT(largest(stepper.displacement()), 0.0);
    scene.constraints.fix("all", all_nodes(scene.mesh));
    Stepper all(scene);
    expect_converged(all.solve_static());
    EXPECT_LE(largest(all.displacement()), 1e-12);
  }
}

// N5 (checkerboard pressure) is about elements with a pressure of their own; in a linear tet the
// pressure follows from the displacement. What can be asked of it: under a uniform squeeze every
// inner node is in balance, whatever the mesh.
TEST(Incompressibility, N5_a_uniform_squeeze_is_in_balance_inside) {
  const Mesh mesh = make_mesh(make_ball(15.0, 4));
  const Tissue tissue(mesh, {{0, Material(Law::corotational, 6.0, 0.4999, 0.0)}});
  Points force = tissue.response(-1e-3 * mesh.nodes()).force;
  const double boundary = largest(force);
  for (const Index i : surface_nodes(mesh)) force.row(i).setZero();
  EXPECT_GT(boundary, 1.0);
  EXPECT_LE(largest(force), 1e-9 * boundary);
}

}  // namespace
}  // namespace brainshift::test
