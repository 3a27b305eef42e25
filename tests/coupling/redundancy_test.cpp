// Rows that depend on each other: found out, said, and harmless.
#include <cstdio>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "brainshift/mcp.hpp"
#include "stepper/equilibrium.hpp"
#include "support/leaning_block.hpp"

namespace brainshift::test {
namespace {

// A free block pushed by a rigid needle: its tangent, and ties of collinear points in one of its tets.
struct Ties {
  Eigen::MatrixXd C;    // columns: gradients of the rows on the nodes
  Eigen::VectorXd gap;  // mm
  std::vector<double> place;
};

struct Block {
  Scene scene = block_on_base(Vec3::Zero(), {3, 3, 4});
  Equilibrium equilibrium{scene};
  Eigen::LLT<Eigen::MatrixXd> factor;

  Block() {
    const Points u = Points::Zero(scene.mesh.node_count(), 3);
    BlockMatrix K = equilibrium.blocks().make_matrix();
    equilibrium.tangent(u, equilibrium.forces(u), {}, false, K);
    Eigen::MatrixXd A(3 * K.blocks(), 3 * K.blocks());
    for (Eigen::Index i = 0; i < A.cols(); ++i) {
      Eigen::VectorXd column;
      K.multiply(Eigen::VectorXd::Unit(A.cols(), i), column);
      A.col(i) = column;
    }
    for (const NodeRow& row : equilibrium.fixed_rows()) {
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Index dof = 3 * row.block + axis;
        A.row(dof).setZero(), A.col(dof).setZero();
        A(dof, dof) = 1.0;
      }
    }
    factor.compute(A);
  }

  // Two rows across the needle per point at `places` (0 to 1) between two points of a tet; the needle
  // stands off by a gap that is linear along it, as a rigid one does.
  Ties tie(Index tet, const std::vector<double>& places) const {
    const Eigen::Vector4d from(0.6, 0.1, 0.2, 0.1), to(0.1, 0.5, 0.1, 0.3);
    const Vec3 across[] = {Vec3(0.8, -0.6, 0.0), Vec3(0.36, 0.48, -0.8)};
    Ties ties{Eigen::MatrixXd::Zero(factor.cols(), 2 * Eigen::Index(places.size())),
              Eigen::VectorXd(2 * Eigen::Index(places.size())), places};
    for (std::size_t p = 0; p < places.size(); ++p) {
      const Eigen::Vector4d weights = (1.0 - places[p]) * from + places[p] * to;
      for (int axis = 0; axis < 2; ++axis) {
        const Eigen::Index row = 2 * Eigen::Index(p) + axis;
        for (int a = 0; a < 4; ++a) {
          const Index node = scene.mesh.tets()(tet, a);
          const Index block = equilibrium.blocks().block_of()[std::size_t(node)];
          ties.C.col(row).segment<3>(3 * block) = weights[a] * across[axis];
        }
        ties.gap[row] = axis == 0 ? -0.3 - 0.2 * places[p] : 0.1 - 0.4 * places[p];
      }
    }
    return ties;
  }

  McpSolution solve(const Ties& ties) const {
    const Eigen::MatrixXd W = ties.C.transpose() * factor.solve(ties.C);
    const Eigen::VectorXd open = Eigen::VectorXd::Constant(ties.gap.size(), INFINITY);
    return solve_mcp(W, ties.gap, -open, open);
  }
};

// Sums of the forces across, and their moments about the first place.
Eigen::Vector4d resultants(const Ties& ties, const Eigen::VectorXd& z) {
  Eigen::Vector4d r = Eigen::Vector4d::Zero();
  for (std::size_t p = 0; p < ties.place.size(); ++p) {
    const auto forces = z.segment<2>(2 * Eigen::Index(p));
    r.head<2>() += forces;
    r.tail<2>() += ties.place[p] * forces;
  }
  return r;
}

TEST(Redundancy, ThreeCollinearPointsInOneTet) {
  const Block block;
  Index tet = -1;  // clear of the fixed base
  for (Index t = 0; t < block.scene.mesh.tet_count() && tet < 0; ++t) {
    bool clear = true;
    for (int a = 0; a < 4; ++a) {
      clear &= block.scene.mesh.nodes()(block.scene.mesh.tets()(t, a), 2) > 1.0;
    }
    if (clear) tet = t;
  }
  const Ties two = block.tie(tet, {0.0, 1.0});
  const McpSolution plain = block.solve(two);
  ASSERT_EQ(plain.report.status, McpStatus::solved);
  EXPECT_TRUE(plain.report.unique);
  EXPECT_EQ(plain.report.rank, 4);
  for (const std::vector<double>& places :
       {std::vector<double>{0.0, 0.4, 1.0}, std::vector<double>{0.0, 0.3, 0.35, 0.8, 1.0}}) {
    const Ties many = block.tie(tet, places);
    const McpSolution s = block.solve(many);
    ASSERT_EQ(s.report.status, McpStatus::solved) << s.report.message;
    const double sum = (resultants(many, s.z) - resultants(two, plain.z)).cwiseAbs().maxCoeff() /
                       plain.z.cwiseAbs().maxCoeff();
    const double nodal = (many.C * s.z - two.C * plain.z).norm() / (two.C * plain.z).norm();
    std::printf(
        "redundancy: %d collinear points in a tet: rank %d of %d, unique %d, gap left %.1e "
        "mm, resultants off by %.1e, nodal forces by %.1e\n",
        int(places.size()), int(s.report.rank), int(s.z.size()), int(s.report.unique),
        s.w.cwiseAbs().maxCoeff(), sum, nodal);
    EXPECT_FALSE(s.report.unique);
    EXPECT_EQ(s.report.rank, 4);
    EXPECT_LE(s.w.cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LE(sum, 1e-9);
    EXPECT_LE(nodal, 1e-9);
  }
}

struct Held {
  SolveReport report;
  Points u, forces;  // forces of all devices on the points of the track
};

// So many cannulas, held whole, in one and the same track of the leaning block.
Held hold(int devices) {
  Stepper stepper(leaning_block(0.0));
  std::vector<DeviceId> ids;
  for (int d = 0; d < devices; ++d) {
    ids.push_back(
        stepper.insert(make_device("cannula", device_length), {lead_tip, lead_outward}, whole()));
  }
  stepper.set_gravity(leaning(0.02));
  Held held{stepper.solve_static(), stepper.displacement(), {}};
  EXPECT_TRUE(held.report.converged()) << held.report.message;
  for (const DeviceId id : ids) {
    const Points forces = stepper.device(id).path_forces;
    held.forces = held.forces.size() ? Points(held.forces + forces) : forces;
  }
  return held;
}

TEST(Redundancy, TwoDevicesInOneTrackShareItsForces) {
  const Held one = hold(1);
  EXPECT_TRUE(one.report.coupling_unique);
  EXPECT_EQ(one.report.coupling_rank, one.report.coupling_rows);
  const double largest = one.forces.rowwise().norm().maxCoeff();
  EXPECT_GT(largest, 1.0);
  for (const int devices : {2, 3}) {
    const Held more = hold(devices);
    const double force = largest_distance(more.forces, one.forces) / largest;
    const double motion = largest_distance(more.u, one.u);
    std::printf(
        "redundancy: %d devices in one track: rank %d of %d rows, unique %d; forces off by "
        "%.1e of %.2f mN, motion by %.1e mm, %d iterations (one device: %d)\n",
        devices, int(more.report.coupling_rank), int(more.report.coupling_rows),
        int(more.report.coupling_unique), force, largest, motion, more.report.iterations,
        one.report.iterations);
    EXPECT_FALSE(more.report.coupling_unique);
    EXPECT_EQ(more.report.coupling_rows, devices * one.report.coupling_rows);
    EXPECT_EQ(more.report.coupling_rank, one.report.coupling_rank);
    EXPECT_LE(force, 1e-8);
    EXPECT_LE(motion, 1e-9);
  }
}

}  // namespace
}  // namespace brainshift::test
