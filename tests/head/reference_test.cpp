// The image is in balance with gravity and full CSF; losing fluid moves the brain, and restoring it
// brings every node back.
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "head_scene.hpp"

namespace dbs {
namespace {

TEST(Reference, NetLoadOfTheFullHeadIsNothing) {
  HeadStepper h(quiet_options());
  const Points weight = h.stepper.gravity_force(), fluid = h.stepper.fluid_force();
  const double total = weight.colwise().sum().norm();
  const double net = h.stepper.external_force().cwiseAbs().maxCoeff();
  // Both loads again, from the mesh alone: a quarter of each tet's weight on its corners, and the
  // full fluid's pressure on each wetted face by its own quadrature (edge midpoints, exact for
  // pressure times shape function).
  const Options o = quiet_options();
  const Vec3 g = gravity_of(o.elevation), up = -g.normalized();
  const Mesh& mesh = shipped_head().brain;
  Points w0 = Points::Zero(mesh.node_count(), 3), p0 = w0;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    Vec3 x[4];
    for (int a = 0; a < 4; ++a) x[a] = mesh.nodes().row(mesh.tets()(t, a)).transpose();
    const double volume = (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]) / 6.0;
    for (int a = 0; a < 4; ++a) {
      w0.row(mesh.tets()(t, a)) += (0.25 * volume * o.density * 1e-9 * g).transpose();
    }
  }
  for (int side : {left, right}) {
    for (Index f : h.stepper.csf().compartment(h.compartment(side)).wetted_faces) {
      Vec3 x[3];
      for (int k = 0; k < 3; ++k) x[k] = mesh.nodes().row(mesh.surface()(f, k)).transpose();
      const Vec3 area = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]);
      for (int k = 0; k < 3; ++k) {
        const Vec3 middle = 0.5 * (x[k] + x[(k + 1) % 3]);
        const double pressure = o.csf_density * 1e-9 * g.norm() * (h.full - middle.dot(up));
        for (int end : {k, (k + 1) % 3}) {
          p0.row(mesh.surface()(f, end)) -= (pressure / 6.0 * area).transpose();
        }
      }
    }
  }
  const double apart = (weight + fluid - w0 - p0).cwiseAbs().maxCoeff();
  std::printf("assembled by the library and apart from it: %.1e of the weight\n", apart / total);
  EXPECT_LE(apart, 1e-12 * total);
  std::printf(
      "weight %.3f N, fluid on wetted faces %.3f N, net load at stage 0: %.1e of the "
      "weight\n",
      total / 1000.0, fluid.colwise().sum().norm() / 1000.0, net / total);
  EXPECT_GT(fluid.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_LE(net, 1e-12 * total);
}

TEST(Reference, IsReachedAgainWhenTheFluidIsRestored) {
  HeadStepper h(quiet_options());
  const Index side = h.compartment(right);
  h.stepper.csf().set_lost_volume(side, 5.0 * mm3_per_ml);
  ASSERT_TRUE(h.stepper.solve_static().converged());
  const double moved = largest_motion(h.stepper.displacement());
  EXPECT_GT(moved, 0.01);  // mm: far above any tolerance of the solve
  h.stepper.csf().set_full(side);
  const SolveReport report = h.stepper.solve_static();
  ASSERT_TRUE(report.converged()) << report.message;
  const double left_over = largest_motion(h.stepper.displacement());
  std::printf("5 mL lost moves %.3f mm; restored: %.1e mm left, last correction %.1e mm\n", moved,
              left_over, report.last_correction);
  EXPECT_LE(report.last_correction, 1e-8);
  EXPECT_LE(left_over, 1e-6);
}

}  // namespace
}  // namespace dbs
