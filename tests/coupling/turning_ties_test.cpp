// The second derivatives of the ties: how their forces turn with the device, against finite differences of
// the forces, and what they are worth to Newton's method.
#include <cmath>
#include <cstdio>
#include <random>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include "coupling/coupling.hpp"
#include "stepper/stepper_impl.hpp"
#include "support/leaning_block.hpp"

namespace brainshift::test {
namespace {

struct Direction {
  Points u;
  Eigen::VectorXd q;
};

// Tissue and one bent lead at a balance under strong ties.
class TurningTies : public ::testing::Test {
 protected:
  TurningTies() : m_stepper(block_on_base(Vec3::Zero())) {
    m_stepper.insert(lead(), {lead_tip, lead_outward}, wire_only());
    m_stepper.set_gravity(leaning(0.06));
    EXPECT_TRUE(m_stepper.solve_static().converged());
    m_devices = m_stepper.snapshot()->devices;
  }

  const Beam& beam() const { return m_devices.front().beam; }

  // Forces of all rows with the multipliers they have, at the state moved by `part` of a direction.
  Direction forces(const Direction& d, double part) const {
    std::vector<DeviceMotion> motions{m_devices.front().motion};
    beam().update(motions.front().beam, part * d.q);
    return forces_at(m_stepper.displacement() + part * d.u, motions);
  }

  Direction forces_at(const Points& u, const std::vector<DeviceMotion>& motions) const {
    const Coupling coupling(m_stepper.mesh(), m_devices, m_stepper.displacement());
    Direction f{Points::Zero(u.rows(), 3), Eigen::VectorXd::Zero(beam().dof_count())};
    DeviceVectors on_devices{f.q};
    coupling.add_forces(coupling.rows(u, motions), motions, f.u, on_devices);
    f.q = on_devices.front();
    return f;
  }

  // Takes out of a direction what would open a tie.
  void keep_closed(const Coupling& coupling, const std::vector<CouplingRow>& rows, Direction& d) const {
    const Eigen::Index n = d.u.size();
    Eigen::MatrixXd G(n + d.q.size(), Eigen::Index(rows.size()));
    G.setZero();
    Eigen::Index count = 0;
    for (const CouplingRow& row : rows) {
      if (row.kind != RowKind::across) continue;
      std::vector<DeviceMotion> one{m_devices.front().motion};
      for (Vec3& m : one.front().multipliers) m.setZero();
      multiplier_of(one.front(), row) = 1.0;
      Direction g{Points::Zero(d.u.rows(), 3), Eigen::VectorXd::Zero(d.q.size())};
      DeviceVectors on_devices{g.q};
      coupling.add_forces({row}, one, g.u, on_devices);
      G.col(count) << Eigen::Map<const Eigen::VectorXd>(g.u.data(), n), on_devices.front();
      ++count;
    }
    Eigen::VectorXd all(n + d.q.size());
    all << Eigen::Map<const Eigen::VectorXd>(d.u.data(), n), d.q;
    const auto used = G.leftCols(count);
    all -= used * used.colPivHouseholderQr().solve(all);
    d.u = Eigen::Map<const Points>(all.data(), d.u.rows(), 3);
    d.q = all.tail(d.q.size());
    coupling.hold(0, m_devices.front().motion.beam, d.q);
  }

  Stepper m_stepper;
  std::vector<InsertedDevice> m_devices;
};

TEST_F(TurningTies, SecondDerivativesAreThoseOfTheForces) {
  const std::vector<DeviceMotion> motions{m_devices.front().motion};
  const Coupling coupling(m_stepper.mesh(), m_devices, m_stepper.displacement());
  const auto rows = coupling.rows(m_stepper.displacement(), motions);
  const auto turns = coupling.turns(rows, motions);
  ASSERT_GE(turns.size(), 4u);
  BlockTridiagonal own(beam().node_count());
  coupling.add_tangent(rows, motions, 0, own);
  const auto slip = [&](const TieTurn& turn, const Direction& d) {
    const PathPoint& point = m_devices.front().path[turn.slip.point];
    Vec3 moved = Vec3::Zero();
    for (int a = 0; a < 4; ++a) {
      moved += point.weights[a] * d.u.row(m_stepper.mesh().tets()(point.tet, a)).transpose();
    }
    return turn.slip.direction.dot(moved) + coupling.device_gradient(turn.slip, motions).dot(d.q);
  };
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto any = [&] {
    Direction d{Points(m_stepper.mesh().node_count(), 3), Eigen::VectorXd(beam().dof_count())};
    for (Eigen::Index i = 0; i < d.u.size(); ++i) d.u.data()[i] = 0.3 * normal(random);
    for (Eigen::Index i = 0; i < d.q.size(); ++i) {
      d.q[i] = (i % 6 < 3 ? 0.3 : 0.05) * normal(random);   // mm, rad
    }
    keep_closed(coupling, rows, d);
    return d;
  };
  double worst = 0.0, largest = 0.0;
  for (int trial = 0; trial < 20; ++trial) {
    const Direction d = any(), e = any();
    const auto change = [&](const Direction& along, const Direction& seen) {
      const double h = 1e-5;
      const Direction plus = forces(along, h), minus = forces(along, -h);
      return ((plus.u - minus.u).cwiseProduct(seen.u).sum() + (plus.q - minus.q).dot(seen.q)) /
             (2.0 * h);
    };
    // Moments are seen in turned axes: the skew part of their change is no second derivative.
    const double measured = 0.5 * (change(d, e) + change(e, d));
    double expected = -e.q.dot(own.multiply(d.q));
    for (const TieTurn& turn : turns) {
      const double ad = turn.turn.dot(d.q), ae = turn.turn.dot(e.q);
      const double bd = slip(turn, d), be = slip(turn, e);
      expected -= ad * be + ae * bd + turn.curvature * bd * be;
    }
    worst = std::max(worst, std::abs(measured - expected));
    largest = std::max(largest, std::abs(expected));
  }
  std::printf("turning ties: second derivatives off by %.1e of %.3f mN/mm\n", worst, largest);
  EXPECT_GT(largest, 1.0);
  EXPECT_LE(worst, 1e-6 * largest);   // central differences: h^2 of order-one third derivatives
}

// A lead bent far: without those derivatives the residual falls by a constant factor per iteration in
// the end.
TEST(TurningTiesInNewton, ConvergeFast) {
  Stepper stepper(block_on_base(Vec3::Zero()));
  stepper.insert(lead(), {lead_tip, lead_outward}, wire_only());
  stepper.set_gravity(leaning(0.2));
  const SolveReport report = stepper.solve_static();
  ASSERT_TRUE(report.converged()) << report.message;
  std::printf("lead bent far: bow %.3f mm, %d iterations, %d load steps\n",
              stepper.device(0).bow, report.iterations, report.load_steps);
  EXPECT_LE(report.iterations, 13);   // 15 without them
}

}  // namespace
}  // namespace brainshift::test
