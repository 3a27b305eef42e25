// Devices far stiffer, or far lighter, than the tissue they are in.
#include "robustness/outcome.hpp"
#include "support/leaning_block.hpp"

namespace brainshift::test {
namespace {

// Bending stiffness from that of tissue to far beyond any metal: the block 40 mm wide has EI of about
// 6 * 40^4 / 12 = 1e6 mN mm^2. 1e11 is a ratio of moduli of 1e11; steel has 2e7. Stiff enough, a lead is
// a rigid rod, and the answer no longer changes. Beyond, it still converges, in ever more iterations:
// 144 at 1e13, thousands at 1e16.
TEST(StiffnessRatio, X1_a_lead_from_as_soft_as_tissue_to_rigid) {
  Points last;
  for (const double bending : {1e1, 1e4, 1e7, 1e10, 1e11}) {
    Stepper stepper(leaning_block(0.0));
    const DeviceId id = stepper.insert(lead(bending), {lead_tip, lead_outward}, wire_only());
    stepper.set_gravity(leaning(0.02));
    const SolveReport report = stepper.solve_static();
    std::printf("X1: EI %.0e mN mm^2: %s, %d iterations, residual %.1e, tie gap %.1e mm\n", bending,
                to_string(report.status), report.iterations, report.residual, report.tie_gap);
    expect_converged(report);
    EXPECT_LE(report.iterations, 60);
    EXPECT_LE(report.tie_gap, 1e-8);
    EXPECT_TRUE(stepper.device(id).path_forces.allFinite());
    if (bending > 1e10) {
      EXPECT_LE(largest_distance(stepper.displacement(), last), 1e-2 * largest(last)) << bending;
    }
    last = stepper.displacement();
  }
}

// Regions of one mesh: stiffness and softness side by side, the residual of the certificate being that
// of the forces themselves.
TEST(StiffnessRatio, X1_a_stiff_inclusion_in_the_mesh) {
  const TetShape shape = make_box({30, 30, 30}, 3, 3, 3);
  Indices regions(std::size_t(shape.tets.rows()), 0);
  for (int t = 6 * 13; t < 6 * 14; ++t) regions[std::size_t(t)] = 1;  // the cell in the middle
  for (const double ratio : {2e3, 2e5, 2e7, 2e9, 2e13}) {
    Scene scene{make_mesh(shape, regions),
                {{0, Material(Law::corotational, 6.0, 0.45, tissue_density)},
                 {1, Material(Law::corotational, 6.0 * ratio, 0.45, tissue_density)}},
                {0.1 * standard_gravity, 0, -0.3 * standard_gravity}};
    scene.balanced_reference = false;
    scene.constraints.fix("base", bottom(scene.mesh));
    Stepper stepper(scene);
    const SolveReport report = stepper.solve_static();
    std::printf("X1: inclusion %.0e: %s, residual %.1e\n", ratio, to_string(report.status),
                report.residual);
    expect_converged_or_failed(report);
    EXPECT_TRUE(report.converged() || ratio > 1e6) << ratio << ": " << report.message;
  }
}

// No penalty anywhere: ties are closed to rounding and forces balance, at any stiffness.
TEST(StiffnessRatio, X2_reported_forces_balance) {
  for (const double bending : {1e3, 1e9}) {
    Stepper stepper(leaning_block(0.0));
    const DeviceId id = stepper.insert(lead(bending), {lead_tip, lead_outward}, wire_only());
    stepper.set_gravity(leaning(0.02));
    expect_converged(stepper.solve_static());
    const DeviceState d = stepper.device(id);
    const Vec3 sum = d.path_forces.colwise().sum().transpose();
    EXPECT_LE((sum - d.anchor_force).norm(), 1e-8 * 1000.0) << bending;
    // Tissue: weight, base and device in balance along the lean.
    const Points base = stepper.internal_force() - stepper.external_force();
    double held = 0.0;
    for (const Index i : bottom(stepper.mesh())) held += base(i, 0);
    const double lean = stepper.gravity_force().col(0).sum();
    EXPECT_NEAR(held + lean + sum.x(), 0.0, 1e-6 * lean) << bending;
  }
}

TEST(StiffnessRatio, X3_light_tissue_heavy_steel_short_steps) {
  for (const double density : {0.0, 8e-6, 1e-2}) {
    DeviceOptions options;
    options.density = density;
    Stepper stepper(leaning_block(0.02));
    stepper.insert(make_device("cannula", device_length, options), {lead_tip, lead_outward},
                   wire_only());
    for (const double dt : {1e-4, 1e-2, 1e-4}) {
      const SolveReport report = stepper.step(dt);
      expect_converged(report);
    }
  }
}

// Tissue and device are solved for together: no added-mass instability, however stiff, light or slow.
TEST(StiffnessRatio, X4_coupled_motion_dies_out) {
  for (const double bending : {1e2, 1e8}) {
    DeviceOptions options;
    options.bending = bending;
    options.density = 1e-9;  // far lighter than the tissue it displaces
    Stepper stepper(leaning_block(0.02)), rest(leaning_block(0.02));
    const BeamDevice device = make_device("3389", device_length, options);
    for (Stepper* s : {&stepper, &rest}) s->insert(device, {lead_tip, lead_outward}, wire_only());
    double before = 0.0;
    for (int i = 0; i < 30; ++i) {
      const SolveReport report = stepper.step(0.02);
      expect_converged(report);
      const double now = total_energy(stepper, report);
      EXPECT_LE(now, before + 1e-9 * (report.energy + report.kinetic_energy)) << i;
      before = now;
    }
    for (int i = 0; i < 5; ++i) expect_converged(stepper.step(10.0));
    expect_converged(rest.solve_static());
    EXPECT_LE(largest_distance(stepper.displacement(), rest.displacement()), 1e-5);
  }
}

}  // namespace
}  // namespace brainshift::test
