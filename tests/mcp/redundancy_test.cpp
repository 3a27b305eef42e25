// Dependent rows: duplicated contacts, too many legs, ties that repeat each other.
#include "problems.hpp"

namespace brainshift::test {
namespace {

TEST(Redundancy, one_of_many_is_returned_and_said_to_be_so) {
  Case c = one_sided(MatrixXd::Ones(2, 2), vector({-1, -1}));
  for (const McpMethod method : exact_methods) {
    SCOPED_TRACE(name(method));
    const McpSolution s = solve(c, method);
    expect_solved(c, s);
    EXPECT_NEAR(s.z.sum(), 1.0, 1e-12);
    EXPECT_FALSE(s.report.unique);
  }
  const McpSolution newton = solve(c);
  EXPECT_NEAR(newton.z[0], 0.5, 1e-12);  // least norm
  EXPECT_EQ(newton.report.rank, 1);
}

TEST(Redundancy, a_ray_of_solutions) {
  Case c = one_sided(MatrixXd(2, 2), vector({1, -1}));
  c.M << 1, -1, -1, 1;
  for (const McpMethod method : exact_methods) {
    SCOPED_TRACE(name(method));
    const McpSolution s = solve(c, method);
    expect_solved(c, s);
    EXPECT_NEAR(s.z[1], s.z[0] + 1.0, 1e-12);
    EXPECT_FALSE(s.report.unique);
  }
}

// Two ties that repeat each other, their gaps known to rounding only.
TEST(Redundancy, noise_is_no_contradiction) {
  Case c = one_sided(MatrixXd::Ones(2, 2), vector({1e-14, -3e-14}));
  c.lower = vector({-inf, -inf});
  McpOptions options;
  EXPECT_EQ(solve_mcp(c.M, c.q, c.lower, c.upper, options).report.status, McpStatus::infeasible);
  options.noise = 1e-13;
  EXPECT_EQ(solve_mcp(c.M, c.q, c.lower, c.upper, options).report.status, McpStatus::solved);
  c.q = vector({1.0, 1.0 + 1e-14});  // beside what is known the noise is nothing
  const McpSolution s = solve_mcp(c.M, c.q, c.lower, c.upper, options);
  EXPECT_EQ(s.report.status, McpStatus::solved);
  EXPECT_NEAR(s.z.sum(), -1.0, 1e-12);
  c.q = vector({1e-14, -3e-12});  // more than noise
  EXPECT_EQ(solve_mcp(c.M, c.q, c.lower, c.upper, options).report.status, McpStatus::infeasible);
}

// Two equal contacts that just touch: dependent rows, but neither may pull while the other pushes.
TEST(Redundancy, dependent_rows_at_their_bounds_can_still_have_one_answer) {
  Case c = one_sided(MatrixXd::Ones(2, 2), vector({0, 0}));
  EXPECT_TRUE(solve(c).report.unique);
  c.M << 1, -1, -1, 1;  // opposite ones may push against each other: (t, t)
  EXPECT_FALSE(solve(c).report.unique);
}

TEST(Redundancy, table_on_four_legs_shares_the_weight) {
  // a plate of mass m: vertical motion and two tilts; contact at the corners
  const double mass = 20.0, a = 300.0, b = 200.0, weight = mass * standard_gravity;
  MatrixXd H(4, 3);
  H << 1, a, b, 1, a, -b, 1, -a, b, 1, -a, -b;
  const Eigen::Vector3d inertia(mass, mass * b * b / 3.0, mass * a * a / 3.0);
  const MatrixXd W = H * inertia.cwiseInverse().asDiagonal() * H.transpose();
  const Case c = one_sided(W, VectorXd::Constant(4, -standard_gravity));
  for (const McpMethod method : exact_methods) {
    SCOPED_TRACE(name(method));
    const McpSolution s = solve(c, method);
    expect_solved(c, s);
    EXPECT_NEAR(s.z.sum(), weight, 1e-9 * weight);
    EXPECT_FALSE(s.report.unique);
  }
  const McpSolution newton = solve(c, McpMethod::newton);
  EXPECT_EQ(newton.report.rank, 3);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(newton.z[i], weight / 4.0, 1e-9 * weight);
}

// Twenty contacts on the lower faces of a free block: six equations for twenty forces.
TEST(Redundancy, twenty_contacts_of_rank_six_balance_the_load) {
  std::mt19937 generator(11);
  for (int trial = 0; trial < 30; ++trial) {
    SCOPED_TRACE(trial);
    const MatrixXd H = random_matrix(20, 6, generator);  // M = I: u = H^T z + f
    const VectorXd z_known = random_matrix(20, 1, generator).cwiseMax(0.0);
    VectorXd gap = random_matrix(20, 1, generator).cwiseMax(0.0);
    for (int i = 0; i < 20; ++i) gap[i] = z_known[i] > 0.0 ? 0.0 : gap[i];
    const Case c = one_sided(H * H.transpose(), gap - H * (H.transpose() * z_known));
    for (const McpMethod method : exact_methods) {
      SCOPED_TRACE(name(method));
      const McpSolution s = solve(c, method);
      expect_solved(c, s);
      const VectorXd balance = H.transpose() * (s.z - z_known);
      EXPECT_LE(balance.norm(), 1e-8 * (H.transpose() * z_known).norm());
    }
  }
}

// A block pushed into a corner: twenty contacts on three of its faces, their wrenches of rank six.
// The forces are many, their sum is one: it balances the load.
TEST(Redundancy, block_in_a_corner_on_twenty_contacts) {
  std::mt19937 generator(15);
  std::uniform_real_distribution<double> uniform(0.1, 0.9);
  const Eigen::Vector3d size(60.0, 40.0, 20.0), centre = 0.5 * size;
  MatrixXd H(20, 6);  // unit normal force on the block: force and moment about its centre
  for (int i = 0; i < 20; ++i) {
    const int axis = i % 3;
    Eigen::Vector3d point(uniform(generator), uniform(generator), uniform(generator));
    point = point.cwiseProduct(size);
    point[axis] = 0.0;
    const Eigen::Vector3d normal = Eigen::Vector3d::Unit(axis);
    H.row(i).head<3>() = normal;
    H.row(i).tail<3>() = (point - centre).cross(normal);
  }
  const double mass = 0.05;
  VectorXd inertia(6);  // of a solid block
  inertia << mass, mass, mass, mass / 12.0 * (1600.0 + 400.0), mass / 12.0 * (3600.0 + 400.0),
      mass / 12.0 * (3600.0 + 1600.0);
  VectorXd load = VectorXd::Zero(6);  // weight, leaning into the corner
  load.head<3>() = -mass * standard_gravity * Eigen::Vector3d(1.0, 2.0, 3.0).normalized();
  const MatrixXd compliance = inertia.cwiseInverse().asDiagonal();
  const Case c = one_sided(H * compliance * H.transpose(), H * compliance * load);
  for (const McpMethod method : exact_methods) {
    SCOPED_TRACE(name(method));
    const McpSolution s = solve(c, method);
    expect_solved(c, s);
    const VectorXd balance = H.transpose() * s.z + load;
    EXPECT_LE(balance.head<3>().norm(), 1e-9 * load.norm());
    EXPECT_LE(balance.tail<3>().norm(), 1e-9 * load.norm() * size.norm());
    EXPECT_FALSE(s.report.unique);
    EXPECT_LE(s.report.rank, 6);
  }
  EXPECT_EQ(solve(c).report.rank, 6);
}

// n = 60 of rank 20: every contact three times, with gaps that differ by nothing or by little.
TEST(Redundancy, contacts_given_three_times) {
  std::mt19937 generator(12);
  for (const double spread : {0.0, 1e-3, 0.3}) {
    SCOPED_TRACE(spread);
    const MatrixXd B = random_matrix(20, 20, generator);
    const MatrixXd W = B * B.transpose() / 20.0 + 0.1 * MatrixXd::Identity(20, 20);
    const VectorXd q = random_matrix(20, 1, generator);
    const McpSolution single = solve(one_sided(W, q));
    Case c = one_sided(W.replicate(3, 3), q.replicate(3, 1));
    c.q.segment(20, 20).array() += spread;  // the copies open a little wider: they carry nothing
    c.q.segment(40, 20).array() += 2.0 * spread;
    for (const McpMethod method : exact_methods) {
      SCOPED_TRACE(name(method));
      const McpSolution s = solve(c, method);
      expect_solved(c, s);
      const VectorXd sum = s.z.head(20) + s.z.segment(20, 20) + s.z.tail(20);
      EXPECT_LE((sum - single.z).norm(), 1e-8 * single.z.norm());
      EXPECT_EQ(s.report.unique, spread > 0.0);
    }
  }
}

TEST(Redundancy, bilateral_rows_given_twice_converge_when_they_agree) {
  std::mt19937 generator(13);
  const MatrixXd H = random_matrix(6, 10, generator);
  MatrixXd twice(12, 10);
  twice << H, H;
  const VectorXd q = random_matrix(6, 1, generator);
  Case c{twice * twice.transpose(), q.replicate(2, 1), VectorXd::Constant(12, -inf),
         VectorXd::Constant(12, inf)};
  const McpSolution s = solve(c);
  expect_solved(c, s);
  EXPECT_EQ(s.report.rank, 6);
  EXPECT_FALSE(s.report.unique);
  EXPECT_LE((s.z.head(6) - s.z.tail(6)).norm(), 1e-10 * s.z.norm());
}

// The copies of a compliance matrix differ by the accuracy of the solves it came from.
TEST(Redundancy, almost_equal_copies) {
  std::mt19937 generator(14);
  const MatrixXd B = random_matrix(10, 10, generator);
  const MatrixXd W = B * B.transpose() + MatrixXd::Identity(10, 10);
  const VectorXd q = -random_matrix(10, 1, generator).cwiseAbs();
  MatrixXd noise = 1e-13 * random_matrix(20, 20, generator);
  noise = (noise + noise.transpose()).eval();
  const Case c = one_sided(W.replicate(2, 2) + noise, q.replicate(2, 1));
  const McpSolution single = solve(one_sided(W, q));
  const McpSolution s = solve(c);
  expect_solved(c, s);
  EXPECT_LE((s.z.head(10) + s.z.tail(10) - single.z).norm(), 1e-8 * single.z.norm());
}

}  // namespace
}  // namespace brainshift::test
