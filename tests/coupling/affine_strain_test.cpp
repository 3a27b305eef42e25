// A lead without stiffness leaves a uniform strain of the tissue as it is.
//
// A block on rollers under the pressure of a fluid on its top: the strain is uniform, and the middle of
// its base stays where it is. The devices are held there and nowhere else: a wire fixed outside the
// tissue would be drawn along by it and pull it off, however soft.
#include <cstdio>

#include <gtest/gtest.h>

#include "support/elements.hpp"
#include "support/leaning_block.hpp"

namespace brainshift::test {
namespace {

constexpr double side = 40.0, height = 40.0, young = 6.0, poisson = 0.45;  // mm, kPa
constexpr double strain = -0.03;
const Vec3 middle(0.5 * side, 0.5 * side, 0.0);

// Rollers on the base and on the two middle planes. The head is that of the pressed top's pressure,
// P = E strain (law, uniaxial: corotational is linear in the stretch).
Scene pressed_block() {
  const Mesh mesh = make_mesh(make_box({side, side, height}, 4, 4, 4));
  Indices top;
  for (const Index f : all_faces(mesh)) {
    bool on_top = true;
    for (int k = 0; k < 3; ++k) on_top &= mesh.nodes()(mesh.surface()(f, k), 2) == height;
    if (on_top) top.push_back(f);
  }
  const double lateral = 1.0 - poisson * strain, pressure = -young * strain / (lateral * lateral);
  const double head = height * (1.0 + strain) + pressure / (fluid_density * standard_gravity);
  const SurfaceShape wall = box_wall({-5, -5, -5}, {side + 5, side + 5, height + 5});
  Compartment fluid = make_compartment("fluid", wall, all_faces(mesh));
  fluid.wetted_faces = top;
  Scene scene{mesh,
              {{0, Material(Law::corotational, young, poisson, 0.0)}},
              Vec3(0, 0, -standard_gravity),
              Csf(fluid_density, FluidModel::separate, {fluid}, head),
              {}};
  scene.balanced_reference = false;
  for (int axis = 0; axis < 3; ++axis) {
    const Indices nodes = nodes_where(mesh, [&](const Vec3& x) { return x[axis] == middle[axis]; });
    scene.constraints.fix("rollers", nodes, {axis == 0, axis == 1, axis == 2});
  }
  return scene;
}

// The device lies along the line through the middle of the base, its tip in tissue; the wire goes on
// below. It is fixed to the point of the base that does not move.
const Vec3 outward = Vec3(-0.3, -0.2, -1.0).normalized();
constexpr double depth = 30.0, past = 6.0;  // mm of the device above and below the base

struct Pressed {
  Points u;
  SolveReport report;
  double gap = 0.0;
};

Pressed squeeze(const BeamDevice* device, bool clamped, Element element = Element::linear) {
  StepperOptions options;
  options.residual_tolerance = 1e-11;
  Stepper stepper(with_element(pressed_block(), element), options);
  DeviceId id = -1;
  if (device) {
    const Hold hold{std::numeric_limits<double>::infinity(), depth, clamped};
    id = stepper.insert(*device, {middle - depth * outward, outward}, hold);
  }
  Pressed result;
  result.report = stepper.solve_static();
  EXPECT_TRUE(result.report.converged()) << result.report.message;
  result.u = stepper.displacement();
  if (device) result.gap = stepper.device(id).largest_tie_gap;
  return result;
}

BeamDevice wire_of(double bending) {  // mN mm^2; a node where it is held
  return BeamDevice::straight("wire", depth + past, 18, rod_section(1.27, bending, 0.3));
}

double difference(const Pressed& a, const Pressed& b) {
  return largest_distance(a.u, b.u) / b.u.rowwise().norm().maxCoeff();
}

TEST(AffineStrain, OfTheBlockAloneIsUniform) {
  const Pressed alone = squeeze(nullptr, false);
  const Mesh mesh = pressed_block().mesh;
  const Vec3 strains(-poisson * strain, -poisson * strain, strain);
  double off = 0.0;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    const Vec3 x = mesh.nodes().row(i).transpose() - middle;
    off = std::max(off, (alone.u.row(i).transpose() - strains.cwiseProduct(x)).norm());
  }
  std::printf("affine strain: %.3f along, off by %.1e of %.1f mm\n", strain, off, -strain * height);
  EXPECT_LE(off, 1e-9);
}

// Free to turn where it is held, a straight device turns with its line and stays straight: whatever
// its stiffness, it does nothing.
TEST(AffineStrain, AHingedDeviceOfAnyStiffnessLeavesItAsItIs) {
  for (const Element element : all_elements) {
    const Pressed alone = squeeze(nullptr, false, element);
    for (const double bending : {1.0, 5e3, 1e6}) {
      const BeamDevice device = wire_of(bending);
      const Pressed with = squeeze(&device, false, element);
      const double error = difference(with, alone);
      std::printf("affine strain, %s, hinged, EI %.0e mN mm^2: disturbance %.1e\n",
                  name_of(element).c_str(), bending, error);
      EXPECT_LE(error, 1e-9);
    }
  }
}

// Clamped, it must bend to follow: what it does to the tissue goes to zero with its stiffness.
TEST(AffineStrain, TheDisturbanceByAClampedDeviceGoesToZeroWithItsStiffness) {
  const Pressed alone = squeeze(nullptr, false);
  double before = 0.0, error = 0.0;
  for (const double bending : {1e4, 1e3, 1e2, 1e1, 1e0, 1e-1, 1e-2, 1e-3, 1e-4}) {
    const BeamDevice device = wire_of(bending);
    const Pressed with = squeeze(&device, true);
    error = difference(with, alone);
    std::printf(
        "affine strain, clamped, EI %.0e mN mm^2: disturbance %.3e, %.2f of the one "
        "before; gap %.1e mm, %d iterations\n",
        bending, error, before > 0.0 ? error / before : 0.0, with.gap, with.report.iterations);
    if (bending <= 0.1) {
      EXPECT_NEAR(error / before, 0.1, 0.005) << bending;  // linear in EI
    }
    before = error;
  }
  EXPECT_LE(error, 1e-8);
}

}  // namespace
}  // namespace brainshift::test
