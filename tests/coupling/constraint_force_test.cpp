// Are the forces of the ties right, or only their gaps? The error of the multipliers a solve leaves
// behind, as the full linearised system sees it: formed here densely and solved at once, without the
// library's way of eliminating tissue and devices one after the other.
//
//   [ A   0  -C ] [ du ]   [ tissue out of balance ]      A, B: tangents of tissue and device,
//   [ 0   B  -D ] [ dq ] = [ device out of balance ]      C, D: columns are the gradients of the
//   [ C^T D^T 0 ] [ dl ]   [ -gaps                 ]            rows on tissue and device
#include <cstdio>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "stepper/stepper_impl.hpp"
#include "support/leaning_block.hpp"

namespace brainshift::test {
namespace {

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

// The linearised system of one device in tissue at the state of a stepper.
struct Linearised {
  LongMatrix matrix;
  LongVector right;
  Eigen::Index tissue, device, rows;
  double largest_multiplier = 0.0;
  double tissue_residual() const { return double(right.head(tissue).cwiseAbs().maxCoeff()); }
  double device_residual() const {
    return double(right.segment(tissue, device).cwiseAbs().maxCoeff());
  }
  double gap() const { return double(right.tail(rows).cwiseAbs().maxCoeff()); }
};

Eigen::MatrixXd dense(const BlockMatrix& K) {
  const Eigen::Index n = 3 * K.blocks();
  Eigen::MatrixXd full(n, n);
  Eigen::VectorXd column;
  for (Eigen::Index i = 0; i < n; ++i) {
    K.multiply(Eigen::VectorXd::Unit(n, i), column);
    full.col(i) = column;
  }
  return full;
}

// Rows and columns of dofs that are held become those of the identity, the residual zero.
void fix(LongMatrix& matrix, LongVector& right, Eigen::Index dof) {
  matrix.row(dof).setZero();
  matrix.col(dof).setZero();
  matrix(dof, dof) = 1.0L;
  right[dof] = 0.0L;
}

// `wrong`: multipliers spoilt by this part of each, for the test of the test.
Linearised linearise(const Scene& scene, const Stepper& stepper, double wrong = 0.0) {
  const Equilibrium equilibrium(scene);
  const auto snapshot = stepper.snapshot();
  const Coupling coupling(scene.mesh, snapshot->devices, snapshot->u);
  const std::vector<DeviceMotion> motions = coupling.motions();
  const std::vector<CouplingRow> rows = coupling.rows(snapshot->u, motions);
  const Blocks& blocks = equilibrium.blocks();
  const Beam& beam = snapshot->devices.front().beam;

  Linearised l;
  l.tissue = 3 * blocks.count(), l.device = beam.dof_count(), l.rows = Eigen::Index(rows.size());
  const Eigen::Index n = l.tissue + l.device + l.rows;
  l.matrix = LongMatrix::Zero(n, n);
  l.right = LongVector::Zero(n);

  const Forces forces = equilibrium.forces(snapshot->u);
  BlockMatrix A = blocks.make_matrix();
  equilibrium.tangent(snapshot->u, forces, {}, false, A);
  l.matrix.topLeftCorner(l.tissue, l.tissue) = dense(A).cast<long double>();
  l.right.head(l.tissue) = blocks.gather(forces.external - forces.internal).cast<long double>();
  Eigen::VectorXd gradient;
  BlockTridiagonal B(beam.node_count());
  beam.tangent(motions.front().beam, gradient, B);
  l.matrix.block(l.tissue, l.tissue, l.device, l.device) = B.dense().cast<long double>();
  l.right.segment(l.tissue, l.device) = -gradient.cast<long double>();

  const Eigen::MatrixXd path = coupling.path_columns(blocks);
  for (Eigen::Index r = 0; r < l.rows; ++r) {
    const CouplingRow& row = rows[std::size_t(r)];
    const long double multiplier =
        (1.0L + wrong) * motions.front().multipliers[row.point][row.axis];
    LongVector both(l.tissue + l.device);
    const Eigen::VectorXd on_tissue = path.middleCols<3>(coupling.path_column(row)) * row.direction;
    both << on_tissue.cast<long double>(),
        coupling.device_gradient(row, motions).cast<long double>();
    const Eigen::Index at = l.tissue + l.device + r;
    l.matrix.col(at).head(both.size()) = -both;
    l.matrix.row(at).head(both.size()) = both.transpose();
    l.right.head(both.size()) += multiplier * both;
    l.right[at] = -row.gap;
    l.largest_multiplier = std::max(l.largest_multiplier, double(std::abs(multiplier)));
  }
  for (const NodeRow& row : equilibrium.fixed_rows()) {
    Eigen::Index axis = 0;
    row.normal.cwiseAbs().maxCoeff(&axis);
    fix(l.matrix, l.right, 3 * row.block + axis);
  }
  const InsertedDevice& device = snapshot->devices.front();
  for (const Index dof : device.held_dofs()) fix(l.matrix, l.right, l.tissue + dof);
  const Index anchor = device.anchor_node();  // hinged: no spin about the tangent there
  LongVector spin = LongVector::Zero(l.right.size());
  spin.segment<3>(l.tissue + 6 * anchor + 3) =
      device.motion.beam.R[std::size_t(anchor)].col(0).cast<long double>();
  l.right -= spin * spin.dot(l.right);
  l.matrix -= spin * (spin.transpose() * l.matrix).eval();
  l.matrix -= (l.matrix * spin).eval() * spin.transpose();
  l.matrix += spin * spin.transpose();
  return l;
}

struct ForceError {
  double relative;  // of the largest multiplier
  double multiplier, gap, tissue_residual, device_residual;
  int iterations;
};

ForceError force_error(const BeamDevice& device) {
  Scene scene = block_on_base(leaning(0.02), {3, 3, 4});
  Scene unloaded = scene;
  unloaded.gravity.setZero();
  Stepper stepper(unloaded);
  stepper.insert(device, {lead_tip, lead_outward}, wire_only());
  stepper.set_gravity(scene.gravity);
  const SolveReport report = stepper.solve_static();
  EXPECT_TRUE(report.converged()) << report.message;
  EXPECT_TRUE(report.coupling_unique);
  EXPECT_EQ(report.coupling_rank, report.coupling_rows);
  const Linearised l = linearise(scene, stepper);
  EXPECT_EQ(l.rows, report.coupling_rows);
  const LongVector correction = l.matrix.fullPivLu().solve(l.right);
  EXPECT_LE(double((l.matrix * correction - l.right).cwiseAbs().maxCoeff()), 1e-14);
  const Linearised spoilt = linearise(scene, stepper, 1e-6);
  const LongVector back = spoilt.matrix.fullPivLu().solve(spoilt.right).tail(l.rows);
  EXPECT_NEAR(double(back.cwiseAbs().maxCoeff()) / l.largest_multiplier, 1e-6, 1e-8);
  return {double(correction.tail(l.rows).cwiseAbs().maxCoeff()) / l.largest_multiplier,
          l.largest_multiplier,
          l.gap(),
          l.tissue_residual(),
          l.device_residual(),
          report.iterations};
}

TEST(ConstraintForce, OfASoftLeadIsAsSureAsOfSteel) {
  const BeamDevice steel = make_device("cannula", device_length);
  const struct {
    const char* name;
    BeamDevice device;
  } rows[] = {{"lead", lead(5.0e3)}, {"steel", steel}};
  for (const auto& row : rows) {
    const BeamSection& section = row.device.section(0);
    const ForceError e = force_error(row.device);
    std::printf(
        "constraint force, %s, EI %.3g N mm^2: correction of the multipliers %.1e of the "
        "largest (%.4f mN); gap %.1e mm, out of balance: tissue %.1e, device %.1e mN; "
        "%d iterations\n",
        row.name, 1e-3 * section.bending_2, e.relative, e.multiplier, e.gap, e.tissue_residual,
        e.device_residual, e.iterations);
    EXPECT_LE(e.relative, 1e-8);
    EXPECT_LE(e.tissue_residual, 1e-8 * e.multiplier);
    // A device's nodes are known to the rounding of their positions times its axial stiffness.
    EXPECT_LE(e.device_residual, 1e-8 * e.multiplier + 1e-14 * section.axial);
  }
}

}  // namespace
}  // namespace brainshift::test
