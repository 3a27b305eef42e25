// What every element owes on whole scenes: contact that passes a constant pressure on, a neutrally
// buoyant body, a grid without a bias, Cook's membrane.
#include <cstdio>

#include <gtest/gtest.h>

#include "support/elements.hpp"
#include "support/laws.hpp"
#include "support/scenes.hpp"

namespace brainshift {
namespace {

std::array<bool, 3> only(int axis) { return {axis == 0, axis == 1, axis == 2}; }

Indices where_zero(const Mesh& mesh, int axis) {
  return test::nodes_where(mesh, [axis](const Vec3& x) { return std::abs(x[axis]) < 1e-12; });
}

// A fluid whose level is so far above that its pressure p is constant to 1e-9 of itself.
Csf constant_pressure(double p, const Mesh& mesh, Indices faces) {
  const double head = 1e10;
  Compartment c;
  c.name = "press";
  const auto wall = test::box_wall({-100, -100, -100}, {100, 100, 100});
  c.wall_points = wall.points;
  c.wall_triangles = wall.triangles;
  c.wetted_faces = std::move(faces);
  (void)mesh;
  return Csf(p / (standard_gravity * head), FluidModel::separate, {c}, head);
}

// Contact patch test: a block of irregular tets, pressed from above, stands on a rigid floor that may
// push only. Its stress is constant: u_z is linear in z and the floor carries p on every patch.
TEST(ContactPatch, EveryElementPassesAConstantPressureOn) {
  auto box = test::make_box({20, 20, 20}, 3, 3, 3);
  for (Eigen::Index i = 0; i < box.points.rows(); ++i) {  // inner nodes off the grid
    const auto x = box.points.row(i);
    if (x.minCoeff() > 0.0 && x.maxCoeff() < 20.0)
      box.points.row(i) += Vec3(0.9, -1.1, 0.7).transpose();
  }
  const Mesh mesh = test::make_mesh(box);
  const auto floor = test::moved(test::make_sheet(60, 60, 6, 6), {-20, -20, 0});
  const double p = 0.06;  // kPa, a hundredth of E
  for (Law law : {Law::linear, Law::corotational, Law::stable_neo_hookean}) {
    for (test::Element element : test::all_elements) {
      Scene scene{mesh,
                  {{0, Material(law, 6.0, 0.45, 0.0)}},
                  Vec3(0, 0, -standard_gravity),
                  constant_pressure(p, mesh,
                                    mesh.faces_within(test::nodes_where(
                                        mesh, [](const Vec3& x) { return x.z() == 20.0; }))),
                  {}};
      scene.balanced_reference = false;
      scene.constraints.fix("x", where_zero(mesh, 0), only(0));
      scene.constraints.fix("y", where_zero(mesh, 1), only(1));
      const ConstraintId contact = scene.constraints.obstacle(
          "floor", where_zero(mesh, 2), Surface::sheet(floor.points, floor.triangles));
      Stepper stepper(test::with_element(scene, element));
      const SolveReport report = stepper.solve_static();
      const std::string what = test::name_of(element) + ", " + to_string(law);
      ASSERT_TRUE(report.converged()) << what << ": " << report.message;
      // The stretch, from any node of the top; then the whole field by it.
      const Points& u = stepper.displacement();
      const Mesh& m = stepper.mesh();
      const Indices corner =
          test::nodes_where(m, [](const Vec3& x) { return x == Vec3(20, 20, 20); });
      const Vec3 stretch = u.row(corner.front()).transpose() / 20.0;
      double off = 0.0;
      for (Index i = 0; i < m.node_count(); ++i) {
        const Vec3 affine = stretch.cwiseProduct(m.nodes().row(i).transpose());
        off = std::max(off, (u.row(i).transpose() - affine).norm());
      }
      EXPECT_LE(off, 1e-7) << what;  // of 0.2 mm; residual 1e-8, gradient of p 1e-9
      const ContactState c = stepper.contact(contact);
      // Under a follower load the top shrinks or grows with the stretch.
      const double area = 400.0 * (law == Law::linear ? (1 + stretch.x()) * (1 + stretch.y())
                                                      : (1 + stretch.x()) * (1 + stretch.y()));
      EXPECT_NEAR(c.multiplier.sum(), p * area, 1e-6 * p * area) << what;
      EXPECT_GE(c.multiplier.minCoeff(), 0.0);
      if (element == test::Element::quadratic) {
        for (std::size_t i = 0; i < stepper.constraints().group(contact).nodes.size(); ++i) {
          const Index node = stepper.constraints().group(contact).nodes[i];
          if (m.is_corner(node)) {
            EXPECT_EQ(c.multiplier[Eigen::Index(i)], 0.0);
          } else {
            EXPECT_GT(c.multiplier[Eigen::Index(i)], 0.0) << node;
          }
        }
      }
    }
  }
}

// p = rho g (h - z) on all faces of a body of the same density, linear law: u = (phi x, phi y,
// a z + b (z^2 - x^2 - y^2) / 2), phi = a + b z, a = -rho g h / 3K, b = rho g / 3K. Quadratic tets
// hold it exactly, linear ones to O(h^2).
TEST(NeutrallyBuoyant, QuadraticTetsAreExactAndLinearOnesAreNot) {
  const double h = 60.0, K = Material(Law::linear, 6.0, 0.45, 0.0).bulk();
  // So light that the motion of the faces in the pressure (1e-9 of it) does not count.
  const double density = 1e-15, weight = density * standard_gravity;
  const double a = -weight * h / (3.0 * K), b = weight / (3.0 * K);
  const auto exact = [&](const Vec3& x) {
    const double phi = a + b * x.z();
    return Vec3(phi * x.x(), phi * x.y(),
                a * x.z() + 0.5 * b * (x.z() * x.z() - x.x() * x.x() - x.y() * x.y()));
  };
  double errors[3];
  for (test::Element element : test::all_elements) {
    const auto shape = test::make_box({30, 30, 30}, 3, 3, 3);
    const Mesh mesh = test::make_mesh(shape);
    const Csf csf(density, FluidModel::separate,
                  {test::make_compartment("all", test::box_wall({-5, -5, -5}, {35, 35, h}),
                                          test::all_faces(mesh))},
                  h);
    Scene scene{mesh,
                {{0, Material(Law::linear, 6.0, 0.45, density)}},
                Vec3(0, 0, -standard_gravity),
                csf,
                {}};
    scene.balanced_reference = false;
    const auto at = [&](const Vec3& p) {
      return test::nodes_where(mesh, [&](const Vec3& x) { return (x - p).norm() < 1e-9; });
    };
    scene.constraints.fix("origin", at({0, 0, 0}));
    scene.constraints.fix("above", at({0, 0, 30}), {true, true, false});
    scene.constraints.fix("beside", at({30, 0, 0}), {false, true, false});
    StepperOptions options;
    options.residual_tolerance = 1e-13;
    Stepper stepper(test::with_element(scene, element), options);
    const SolveReport report = stepper.solve_static();
    ASSERT_TRUE(report.converged()) << test::name_of(element) << ": " << report.message;
    double largest = 0.0, scale = 0.0;
    for (Index i = 0; i < stepper.mesh().node_count(); ++i) {
      const Vec3 u = exact(stepper.mesh().nodes().row(i).transpose());
      largest = std::max(largest, (stepper.displacement().row(i).transpose() - u).norm());
      scale = std::max(scale, u.norm());
    }
    errors[int(element)] = largest / scale;
  }
  std::printf(
      "neutrally buoyant body: relative error %.1e linear, %.1e nodal volume, %.1e quadratic\n",
      errors[0], errors[1], errors[2]);
  EXPECT_LE(errors[2], 1e-8);  // the motion of the faces
  EXPECT_GT(errors[0], 1e-3);
}

// Kuhn's division of a grid has a direction; a bar bending under its weight in the plane of symmetry
// must not drift out of it.
TEST(KuhnGrid, ABarThatSagsDoesNotDriftSideways) {
  const Mesh mesh = test::make_mesh(test::make_box({200, 40, 40}, 20, 4, 4));
  double drift[3];
  for (test::Element element : test::all_elements) {
    Scene scene{mesh,
                {{0, Material(Law::corotational, 6.0, 0.45, test::tissue_density)}},
                Vec3(0, 0, -0.04 * standard_gravity),
                {},
                {}};
    scene.balanced_reference = false;
    scene.constraints.fix("wall", where_zero(mesh, 0));
    Stepper stepper(test::with_element(scene, element));
    const SolveReport report = stepper.solve_static();
    ASSERT_TRUE(report.converged()) << report.message;
    Points tip(1, 3);
    tip << 200, 20, 20;
    const auto u = stepper.displacement_at(tip).values;
    drift[int(element)] = std::abs(u(0, 1) / u(0, 2));
    std::printf("Kuhn grid, %s: sag %.3f mm, drift %.3f %% of it\n", test::name_of(element).c_str(),
                -u(0, 2), 100.0 * drift[int(element)]);
  }
  EXPECT_LE(drift[int(test::Element::quadratic)], 0.005);
  EXPECT_GT(drift[int(test::Element::linear)], 0.05);
}

// Cook's membrane in plane strain, E = 240.565, F = 100 spread over the right edge as a shear. There
// is no traction in a scene, so the load is the membrane's own weight, and the reference is that of
// the finest quadratic mesh: locking shows in how far a coarse mesh is off.
TEST(CooksMembrane, CoarseMeshesThatDoNotLockAreNearTheFineOne) {
  const auto tip_sag = [](int n, test::Element element) {
    auto box = test::make_box({1, 1, 0.05}, n, n, 1);
    for (Eigen::Index i = 0; i < box.points.rows(); ++i) {
      const double s = box.points(i, 0), t = box.points(i, 1);
      box.points.row(i) << 48 * s, 44 * s + t * (44 - 28 * s), 48 * box.points(i, 2);
    }
    const Mesh mesh = test::make_mesh(box);
    Scene scene{mesh,
                {{0, Material(Law::linear, 240.565, 0.4999, 1e-7)}},
                Vec3(0, standard_gravity, 0),
                {},
                {}};
    scene.balanced_reference = false;
    scene.constraints.fix("wall", where_zero(mesh, 0));
    scene.constraints.fix("plane", test::all_nodes(mesh), only(2));
    Stepper stepper(test::with_element(scene, element));
    EXPECT_TRUE(stepper.solve_static().converged());
    Points tip(1, 3);
    tip << 48, 52, 1.2;
    return stepper.displacement_at(tip).values(0, 1);
  };
  const double reference = tip_sag(32, test::Element::quadratic);
  double off[3][2];
  for (test::Element element : test::all_elements) {
    for (int i : {0, 1}) {
      const int n = i == 0 ? 8 : 16;
      off[int(element)][i] = std::abs(tip_sag(n, element) / reference - 1.0);
      std::printf("Cook's membrane, nu = 0.4999, %d x %d cells, %s: %.2f %% off\n", n, n,
                  test::name_of(element).c_str(), 100.0 * off[int(element)][i]);
    }
  }
  // Refined, the others halve what they are off by at least twice over; locked tets do not.
  EXPECT_GT(off[int(test::Element::linear)][1], 0.3);
  for (test::Element element : {test::Element::nodal_volume, test::Element::quadratic}) {
    EXPECT_LT(off[int(element)][1], 0.5 * off[int(element)][0]) << test::name_of(element);
  }
  EXPECT_LT(off[int(test::Element::nodal_volume)][1], 0.15);
  EXPECT_LT(off[int(test::Element::quadratic)][1], 0.04);
}

}  // namespace
}  // namespace brainshift
