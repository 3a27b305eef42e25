// Tissue and device moved together: no row opens and no force arises, however far they are turned.
#include <cstdio>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "coupling/coupling.hpp"
#include "stepper/newton.hpp"
#include "support/beams.hpp"
#include "support/leaning_block.hpp"

namespace brainshift::test {
namespace {

struct Motion {
  Mat3 R;
  Vec3 shift;

  Vec3 operator()(const Vec3& x) const { return R * x + shift; }
  // Displacements that take mesh nodes displaced by u along.
  Points operator()(const Mesh& mesh, const Points& u) const {
    return ((mesh.nodes() + u) * R.transpose()).rowwise() + shift.transpose() - mesh.nodes();
  }
};

Motion turned(double degrees) {
  const Vec3 axis = Vec3(0.3, -0.5, 0.8).normalized();
  return {Eigen::AngleAxisd(degrees * pi / 180.0, axis).toRotationMatrix(), Vec3(70, -40, 25)};
}

std::vector<InsertedDevice> one_device(const Mesh& mesh, const BeamDevice& device, const Hold& hold,
                                       double shear_bound = 0.0) {
  const Points unmoved = mesh.nodes();
  TrackOptions options;
  options.shear_bound = shear_bound;
  return {place_device(
      0, device, {lead_tip, lead_outward}, hold, options,
      cut_track(mesh, unmoved, lead_tip, lead_outward, device.length(), options.least_spacing))};
}

// Free of any hold; Stepper refuses it, the equations do not.
Hold none() { return {}; }

double largest(const Eigen::VectorXd& v) { return v.size() ? v.cwiseAbs().maxCoeff() : 0.0; }

// Straight and unloaded: after the motion there is nothing out of balance, with multipliers of zero.
TEST(RigidMotion, OpensNoRowAndMakesNoForce) {
  const Scene scene = block_on_base(Vec3::Zero());
  const Equilibrium equilibrium(scene);
  const Points u0 = Points::Zero(scene.mesh.node_count(), 3);
  for (const char* name : {"3389", "cannula"}) {
    const std::vector<InsertedDevice> devices =
        one_device(scene.mesh, make_device(name, device_length), none(), 1.0);
    const Coupling coupling(scene.mesh, devices, u0);
    for (const double degrees : {0.0, 45.0, 180.0}) {
      const Motion motion = turned(degrees);
      MechanicalState state{motion(scene.mesh, u0), {}, coupling.motions()};
      state.devices[0].beam = moved(devices[0].motion.beam, motion.R, motion.shift);
      double gap = 0.0;
      for (const CouplingRow& row : coupling.rows(state.u, state.devices)) {
        gap = std::max(gap, std::abs(row.gap));
      }
      FactorCache cache;
      SolveReport report;
      const StepperOptions options;
      Newton newton(equilibrium, coupling, options, cache, report);
      const Offset unbalanced = newton.unbalanced(state);
      const BeamSection& section = devices[0].beam.device().section(0);
      const double tissue = largest(unbalanced.tissue), beam = largest(unbalanced.devices[0]);
      std::printf("rigid motion, %s, %3.0f degrees: gap %.1e mm, tissue %.1e mN, device %.1e mN\n",
                  name, degrees, gap, tissue, beam);
      EXPECT_LE(gap, 1e-12);                   // mm, at coordinates of 150 mm
      EXPECT_LE(tissue, 1e-11);                // E l = 60 mN/mm times 1e-13 mm
      EXPECT_LE(beam, 1e-13 * section.axial);  // strain of rounding
    }
  }
}

// Deformed and loaded: gaps stay, and all forces turn with the motion.
TEST(RigidMotion, TurnsRowsAndForcesOfALoadedStateAlong) {
  const Scene scene = block_on_base(Vec3::Zero());
  const Mesh& mesh = scene.mesh;
  std::vector<InsertedDevice> devices = one_device(mesh, lead(), none(), 1.0);
  std::mt19937 random(5);
  Points u(mesh.node_count(), 3);
  for (Eigen::Index i = 0; i < u.rows(); ++i) u.row(i) = random_vector(random, 0.5).transpose();
  for (Vec3& multipliers : devices[0].motion.multipliers) multipliers = random_vector(random, 3.0);
  devices[0].motion.beam = shaken(devices[0].beam, 0.1, 0.02, 6);
  const Coupling coupling(mesh, devices, u);
  const auto forces = [&](const Points& at, const std::vector<DeviceMotion>& motions,
                          Eigen::VectorXd& gaps) {
    const std::vector<CouplingRow> rows = coupling.rows(at, motions);
    gaps.resize(Eigen::Index(rows.size()));
    for (std::size_t r = 0; r < rows.size(); ++r) gaps[Eigen::Index(r)] = rows[r].gap;
    Points nodal = Points::Zero(mesh.node_count(), 3);
    DeviceVectors on_device{Eigen::VectorXd::Zero(devices[0].beam.dof_count())};
    coupling.add_forces(rows, motions, nodal, on_device);
    Points all(nodal.rows() + 2 * devices[0].beam.node_count(), 3);
    all << nodal,
        Eigen::Map<const Points>(on_device[0].data(), 2 * devices[0].beam.node_count(), 3);
    return all;
  };
  Eigen::VectorXd gaps0, gaps;
  const Points before = forces(u, coupling.motions(), gaps0);
  ASSERT_GT(gaps0.size(), 12);
  EXPECT_GT(largest(gaps0), 0.05);
  for (const double degrees : {45.0, 180.0}) {
    const Motion motion = turned(degrees);
    std::vector<DeviceMotion> motions = coupling.motions();
    motions[0].beam = moved(motions[0].beam, motion.R, motion.shift);
    const Points after = forces(motion(mesh, u), motions, gaps);
    ASSERT_EQ(gaps.size(), gaps0.size());
    const double force = largest_distance(after, before * motion.R.transpose());
    std::printf(
        "rigid motion of a loaded state, %3.0f degrees: gaps change by %.1e mm, forces by "
        "%.1e of %.1f mN\n",
        degrees, largest(gaps - gaps0), force, before.rowwise().norm().maxCoeff());
    EXPECT_LE(largest(gaps - gaps0), 1e-12);
    EXPECT_LE(force, 1e-11 * before.rowwise().norm().maxCoeff());
  }
}

// A body on springs in proportion to its mass sinks as a whole when gravity sets in. A device that
// nothing but tissue holds goes along, and no row carries anything. Stepper refuses such a device; the
// equations do not, and no proximal term is left in the step that would hold it back.
struct Sunk {
  double way, tissue_off, device_off, multiplier, weight;  // mm, mm, mm, mN, mN
  int iterations;
};

Sunk sink(const BeamDevice& device, double per_mass) {  // 1/s^2
  const Vec3 gravity(300.0, -200.0, 400.0), expected = gravity / per_mass;
  Scene scene = block_on_base(gravity);
  const Mesh& mesh = scene.mesh;
  const Eigen::VectorXd masses = Tissue(mesh, scene.materials).gravity_force(Vec3::UnitX()).col(0);
  scene.constraints = {};
  scene.constraints.support("springs", all_nodes(mesh), per_mass * masses);
  const Equilibrium equilibrium(scene);
  const Points u0 = Points::Zero(mesh.node_count(), 3);
  const std::vector<InsertedDevice> devices = one_device(mesh, device, none(), 1.0);
  const Coupling coupling(mesh, devices, u0);
  FactorCache cache;
  SolveReport report;
  const StepperOptions options;
  Newton newton(equilibrium, coupling, options, cache, report);
  MechanicalState state{u0, {}, coupling.motions()};
  const Offset nothing{Eigen::VectorXd::Zero(3 * mesh.node_count()),
                       {Eigen::VectorXd::Zero(devices[0].beam.dof_count())}};
  Newton::Outcome outcome = newton.begin(state, nothing, 1.0);
  while (outcome == Newton::Outcome::ongoing) {
    newton.linearise();
    newton.solve();
    outcome = newton.update();
  }
  EXPECT_EQ(int(outcome), int(Newton::Outcome::converged));
  state = newton.iterate();
  double multiplier = 0.0;
  for (const Vec3& m : state.devices[0].multipliers) multiplier = std::max(multiplier, largest(m));
  const auto off = [&](const Points& moves) {
    return (moves.rowwise() - expected.transpose()).rowwise().norm().maxCoeff();
  };
  return {expected.norm(),
          off(state.u),
          off(state.devices[0].beam.x - devices[0].motion.beam.x),
          multiplier,
          masses.sum() * gravity.norm(),
          report.iterations};
}

TEST(RigidMotion, ADeviceThatOnlyTissueHoldsGoesAlong) {
  const struct {
    const char* device;
    double per_mass;
  } rows[] = {{"3389", 60.0}, {"cannula", 60.0}, {"cannula", 600.0}};
  for (const auto& row : rows) {
    const Sunk s = sink(make_device(row.device, device_length), row.per_mass);
    std::printf(
        "rigid motion by %.2f mm, %s: tissue off by %.1e mm, device by %.1e mm, largest "
        "multiplier %.1e mN, weight %.0f mN, %d iterations\n",
        s.way, row.device, s.tissue_off, s.device_off, s.multiplier, s.weight, s.iterations);
    EXPECT_LE(s.tissue_off, 1e-8);
    EXPECT_LE(s.device_off, 1e-8);
    EXPECT_LE(s.multiplier, 1e-8 * s.weight);
    EXPECT_LE(s.iterations, 7);  // 2, 5 and 3
  }
}

}  // namespace
}  // namespace brainshift::test
