// Backward Euler: against the modes of a linear body, free flight, the static limit, contact, devices.
#include <cmath>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "brainshift/brainshift.hpp"
#include "stepper/backward_euler.hpp"
#include "support/expect_error.hpp"
#include "support/scenes.hpp"

namespace brainshift {
namespace {

using test::expect_error;
using test::largest_distance;
using test::same_bits;

// Keeps the largest figure of a test in its report (--gtest_output=xml).
class Worst {
 public:
  explicit Worst(std::string name) : m_name(std::move(name)) {}
  ~Worst() {
    const char* test = testing::UnitTest::GetInstance()->current_test_info()->name();
    std::printf("%s: %s at most %.1e\n", test, m_name.c_str(), m_value);
  }
  double operator()(double value) {
    m_value = std::max(m_value, value);
    return value;
  }

 private:
  std::string m_name;
  double m_value = 0.0;
};

double largest(const Points& p) { return p.rowwise().norm().maxCoeff(); }

Points random_points(Eigen::Index rows, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> entry(-size, size);
  Points p(rows, 3);
  for (Eigen::Index i = 0; i < p.size(); ++i) p.data()[i] = entry(random);
  return p;
}

// Cube of 20 mm without load; held at its base unless it floats.
Scene cube(Law law, bool floating = false) {
  const Mesh mesh = test::make_mesh(test::make_box({20, 20, 20}, 2, 2, 2));
  Scene scene{mesh, {{0, Material(law, 6.0, 0.45, test::tissue_density)}}, Vec3::Zero(), {}, {}};
  scene.balanced_reference = false;
  if (!floating) {
    scene.constraints.fix("base",
                          test::nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; }));
  }
  return scene;
}

// Modes of the linear cube: K phi = w^2 M phi with phi^T M phi = 1, zero on the base.
struct Modes {
  Eigen::VectorXd w;       // rad/s
  Eigen::MatrixXd shapes;  // 3N x modes, 3 i + axis
  Eigen::VectorXd masses;  // 3N

  explicit Modes(const Scene& scene) {
    const Tissue tissue(scene.mesh, scene.materials);
    const Index n = scene.mesh.node_count();
    std::vector<Index> dofs;
    for (Index i = 0; i < n; ++i) {
      for (int a = 0; a < 3 && scene.mesh.nodes()(i, 2) > 0.0; ++a) dofs.push_back(3 * i + a);
    }
    masses.resize(3 * n);
    for (Index i = 0; i < n; ++i) masses.segment<3>(3 * i).setConstant(tissue.node_masses()[i]);
    const auto count = Eigen::Index(dofs.size());
    Eigen::MatrixXd K(count, count), M = Eigen::MatrixXd::Zero(count, count);
    for (Eigen::Index c = 0; c < count; ++c) {
      Points u = Points::Zero(n, 3);
      u.data()[dofs[std::size_t(c)]] = 1.0;
      const Points force = tissue.response(u).force;
      for (Eigen::Index r = 0; r < count; ++r) K(r, c) = force.data()[dofs[std::size_t(r)]];
      M(c, c) = masses[dofs[std::size_t(c)]];
    }
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> found(K, M);
    w = found.eigenvalues().cwiseSqrt();
    shapes.setZero(3 * n, count);
    for (Eigen::Index r = 0; r < count; ++r) {
      shapes.row(dofs[std::size_t(r)]) = found.eigenvectors().row(r);
    }
  }

  Points shape(Eigen::Index mode) const {
    Points p(shapes.rows() / 3, 3);
    Eigen::Map<Eigen::VectorXd>(p.data(), p.size()) = shapes.col(mode);
    return p;
  }
  double coordinate(Eigen::Index mode, const Points& p) const {
    const Eigen::Map<const Eigen::VectorXd> all(p.data(), p.size());
    return shapes.col(mode).dot(masses.cwiseProduct(all));
  }
};

TEST(Dynamics, ConvergesToTheExactMotionWithOrderOne) {
  const Scene scene = cube(Law::linear);
  const Modes modes(scene);
  const double end = 0.5 * 3.14159265358979 / modes.w[0];
  Points v0 = Points::Zero(scene.mesh.node_count(), 3), exact = v0;
  for (Eigen::Index m : {0, 2, 5}) {
    v0 += modes.shape(m);
    exact += std::sin(modes.w[m] * end) / modes.w[m] * modes.shape(m);
  }
  double coarser = 0.0;
  for (int steps : {64, 128, 256, 512}) {
    Stepper stepper(scene);
    stepper.set_velocity(v0);
    for (int i = 0; i < steps; ++i) ASSERT_TRUE(stepper.step(end / steps).converged());
    const double error = (stepper.displacement() - exact).norm() / exact.norm();
    if (coarser > 0.0) {
      const double order = std::log2(coarser / error);
      std::printf("%d steps: error %.2e, order %.3f\n", steps, error, order);
      EXPECT_NEAR(order, 1.0, 0.1) << steps << " steps, error " << error;
    }
    coarser = error;
  }
  EXPECT_LT(coarser, 0.01);
}

// q'' + c q' + w^2 q = 0 has the eigenvalues mu = -c/2 +- i sqrt(w^2 - c^2/4); q' - conj(mu) q is
// multiplied by 1/(1 - h mu) in a step, of modulus 1/sqrt(1 + c h + (w h)^2), c = alpha + beta w^2.
TEST(Dynamics, AModeIsDampedByTheClosedFormInEveryStep) {
  const Scene scene = cube(Law::linear);
  const Modes modes(scene);
  Worst worst("relative error");
  for (Eigen::Index m : {0, 4}) {
    const double w = modes.w[m];
    for (const Damping& damping :
         {Damping{}, Damping{0.7 * w, 0.0}, Damping{0.0, 0.5 / w}, Damping{0.4 * w, 0.3 / w}}) {
      const double c = damping.alpha + damping.beta * w * w;
      const double real = -0.5 * c, imaginary = std::sqrt(w * w - 0.25 * c * c);
      const auto size = [&](const Stepper& s) {
        const double q = modes.coordinate(m, s.displacement());
        return std::hypot(modes.coordinate(m, s.velocity()) - real * q, imaginary * q);
      };
      for (double wh : {0.1, 1.0, 10.0}) {
        Stepper stepper(scene);
        stepper.set_damping(damping);
        stepper.set_velocity(modes.shape(m));
        for (int i = 0; i < 3; ++i) {
          const double before = size(stepper), h = wh / w;
          ASSERT_TRUE(stepper.step(h).converged());
          const double factor = size(stepper) / before * std::sqrt(1.0 + c * h + wh * wh);
          EXPECT_LE(worst(std::abs(factor - 1.0)), 1e-7)
              << "mode " << m << ", w h = " << wh << ", c/w = " << c / w;
        }
      }
    }
  }
}

TEST(Dynamics, AFreeBodyFallsAndKeepsItsMomentum) {
  Scene scene = cube(Law::stable_neo_hookean, true);
  Stepper stepper(scene);
  expect_error(ErrorCode::rigid_mode, {"6 rigid"}, [&] { stepper.solve_static(); });
  expect_error(ErrorCode::rigid_mode, {"6 rigid"}, [&] { stepper.check_settings(); });
  const Vec3 gravity(300.0, -200.0, -standard_gravity);
  stepper.set_gravity(gravity);
  const Points v0 = random_points(scene.mesh.node_count(), 40.0, 1);
  stepper.set_velocity(v0);
  const Tissue tissue(scene.mesh, scene.materials);
  const Eigen::VectorXd masses = tissue.node_masses();
  const Vec3 start = v0.transpose() * masses;
  const double dt = 0.004;
  Worst worst("relative error of momentum");
  for (int i = 1; i <= 10; ++i) {
    const SolveReport report = stepper.step(dt);
    ASSERT_TRUE(report.converged()) << report.message;
    const Vec3 momentum = stepper.velocity().transpose() * masses;
    const Vec3 expected = start + i * dt * tissue.mass() * gravity;
    EXPECT_LE(worst((momentum - expected).norm() / expected.norm()), 1e-7) << i;
    const double kinetic = 0.5 * masses.dot(stepper.velocity().rowwise().squaredNorm());
    EXPECT_NEAR(report.kinetic_energy, kinetic, 1e-12 * kinetic);
  }
  const Vec3 fallen = stepper.displacement().transpose() * masses / tissue.mass();
  const Vec3 expected = 10 * dt * start / tissue.mass() + 0.5 * 10 * 11 * dt * dt * gravity;
  EXPECT_LE((fallen - expected).norm(), 1e-7 * expected.norm());
}

Scene busy_scene() { return test::busy_scene(2, 3.0); }

TEST(Dynamics, ComesToRestInTheStaticStateWhateverTheStep) {
  Stepper rest(busy_scene());
  rest.csf().set_lost_volume(0, 9000.0);
  ASSERT_TRUE(rest.solve_static().converged());
  EXPECT_GT(rest.contact(0).active, 0);
  Worst worst("distance from static state");
  for (double dt : {0.03, 0.3, 3.0}) {
    Stepper stepper(busy_scene());
    stepper.csf().set_lost_volume(0, 9000.0);
    stepper.set_damping({20.0, 0.01});
    int steps = 0;
    for (bool still = false; !still && steps < 200; ++steps) {
      const SolveReport report = stepper.step(dt);
      ASSERT_TRUE(report.converged()) << dt << " " << steps << " " << report.message;
      EXPECT_LE(report.residual, 1e-8);
      still = largest(stepper.velocity()) * dt < 1e-10 && steps > 0;
    }
    EXPECT_LT(steps, 200) << dt;
    std::printf("dt %.2f s: at rest after %d steps\n", dt, steps);
    EXPECT_LE(worst(largest_distance(stepper.displacement(), rest.displacement())), 1e-7) << dt;
    EXPECT_EQ(stepper.contact(0).active, rest.contact(0).active);
  }
}

TEST(Dynamics, AVeryLongStepIsTheStaticSolve) {
  Stepper rest(busy_scene()), stepper(busy_scene());
  for (Stepper* s : {&rest, &stepper}) s->csf().set_lost_volume(0, 9000.0);
  ASSERT_TRUE(rest.solve_static().converged());
  ASSERT_TRUE(stepper.step(1e6).converged());
  Worst worst("distance from static state");
  EXPECT_LE(worst(largest_distance(stepper.displacement(), rest.displacement())), 1e-9);
  EXPECT_LE(largest(stepper.velocity()), 1e-5);
  ASSERT_TRUE(stepper.solve_static().converged());
  EXPECT_TRUE(stepper.velocity().isZero(0.0));
}

// Residual of the step with inertia, damping, supports and curved contact; on blocks.
struct StepForces {
  Equilibrium eq;
  Coupling coupling;
  MechanicalState start;
  BackwardEuler euler;
  std::vector<double> multipliers;

  StepForces(const Scene& scene, const MechanicalState& from, const Motion& motion,
             const std::vector<InsertedDevice>& devices)
      : eq(scene),
        coupling(eq.mesh(), devices, from.u),
        start(from),
        euler(eq, coupling, start, motion) {
    for (std::size_t r = 0; r < eq.contacts().size(); ++r)
      multipliers.push_back(1.0 + 0.1 * double(r));
  }
  Eigen::VectorXd residual(const Points& u) const {
    const Forces f = eq.forces(u);
    return eq.blocks().gather(f.internal - f.external) - eq.contact_force(f, multipliers) -
           euler.inertia(u) - euler.damping(u);
  }
};

Scene contact_scene() {
  Scene scene = cube(Law::stable_neo_hookean);
  auto ball = test::moved(test::make_icosphere(25.0, 2), {10, 10, 10});
  scene.constraints.obstacle("ball", {20, 24, 26}, Surface::cavity(ball.points, ball.triangles));
  scene.constraints.support("springs", {9, 10, 11}, Eigen::VectorXd::Constant(1, 5.0));
  return scene;
}

TEST(Dynamics, TheTangentIsTheDerivativeOfTheResidual) {
  const Scene scene = contact_scene();
  const Index n = scene.mesh.node_count();
  Worst worst("relative error");
  for (double dt : {1e-4, 1e-2, 1.0}) {
    const Motion motion{dt, {8.0, 0.004}, random_points(n, 30.0, 2)};
    const StepForces forces(scene, {random_points(n, 0.3, 3), {}, {}}, motion, {});
    const Points u = forces.start.u + random_points(n, 0.3, 4);
    const Blocks& blocks = forces.eq.blocks();
    BlockMatrix K = blocks.make_matrix();
    forces.eq.tangent(u, forces.eq.forces(u), forces.multipliers, false, K);
    forces.euler.add_tangent(K);
    for (unsigned seed : {5u, 6u, 7u}) {
      const Points d = random_points(n, 1.0, seed);
      const double e = 1e-5;
      Eigen::VectorXd product;
      K.multiply(blocks.gather_motion(d), product);
      const Eigen::VectorXd difference =
          (forces.residual(u + e * d) - forces.residual(u - e * d)) / (2.0 * e);
      EXPECT_LE(worst((product - difference).norm() / product.norm()), 1e-7) << dt;
    }
  }
}

TEST(Dynamics, TheForcesAreTheGradientOfTheIncrementalPotential) {
  const Scene scene = cube(Law::corotational);
  const Index n = scene.mesh.node_count();
  DeviceOptions heavy;
  heavy.density = 8e-6;
  InsertedDevice device =
      place_device(0, make_device("3389", 30.0, heavy), {Vec3(10, 10, 2), Vec3::UnitZ()},
                   {0.0, 30.0, false}, {}, {});
  const auto nodes = device.motion.beam.x.rows();
  device.motion.velocity = random_points(nodes, 20.0, 8);
  const Motion motion{0.01, {8.0, 0.004}, random_points(n, 30.0, 2)};
  const std::vector<InsertedDevice> devices{device};
  const MechanicalState start{random_points(n, 0.3, 3), {}, {device.motion}};
  const StepForces forces(scene, start, motion, devices);

  const Points u = start.u + random_points(n, 0.3, 4), d = random_points(n, 1.0, 5);
  std::vector<DeviceMotion> moved{device.motion};
  moved[0].beam.x += random_points(nodes, 0.2, 9);
  const Points across = random_points(nodes, 1.0, 10);
  const double e = 1e-4;
  const auto potential = [&](double t) {
    std::vector<DeviceMotion> at = moved;
    at[0].beam.x += t * across;
    return forces.euler.potential(u + t * d, at);
  };
  const BlockMatrix pattern = forces.eq.blocks().make_matrix();
  double slope =
      -(forces.euler.inertia(u) + forces.euler.damping(u)).dot(forces.eq.blocks().gather_motion(d));
  Eigen::VectorXd load = Eigen::VectorXd::Zero(device.beam.dof_count());
  forces.euler.add_force(0, moved[0].beam, load);
  BlockTridiagonal K(device.beam.node_count());
  forces.euler.add_tangent(0, K);
  std::vector<DeviceMotion> shifted = moved;
  shifted[0].beam.x += across;
  Eigen::VectorXd load_there = Eigen::VectorXd::Zero(load.size()), step = load_there;
  forces.euler.add_force(0, shifted[0].beam, load_there);
  for (Eigen::Index i = 0; i < nodes; ++i) {
    slope -= load.segment<3>(6 * i).dot(across.row(i));
    step.segment<3>(6 * i) = across.row(i).transpose();
  }
  EXPECT_NEAR((potential(e) - potential(-e)) / (2 * e), slope, 1e-8 * std::abs(slope));
  EXPECT_LE((K.multiply(step) + load_there - load).norm(), 1e-10 * load.norm());
}

TEST(Dynamics, LargeStepsOntoAFloorNeverGainEnergy) {
  Scene scene = cube(Law::stable_neo_hookean, true);
  scene.gravity = Vec3(500.0, 0.0, -standard_gravity);
  const auto floor = test::moved(test::make_sheet(200, 200, 4, 4), {-90, -90, -1.0});
  scene.constraints.obstacle("floor", test::surface_nodes(scene.mesh),
                             Surface::sheet(floor.points, floor.triangles));
  const Eigen::VectorXd masses = Tissue(scene.mesh, scene.materials).node_masses();
  Worst worst("gain of energy, uJ,");
  for (double dt : {0.002, 0.02, 0.1}) {
    Stepper stepper(scene);
    stepper.set_velocity(Points::Zero(scene.mesh.node_count(), 3).rowwise() +
                         Eigen::RowVector3d(20.0, 0.0, -400.0));
    double before = std::numeric_limits<double>::infinity();
    bool touched = false;
    for (int i = 0; i < 12; ++i) {
      const SolveReport r = stepper.step(dt);
      ASSERT_TRUE(r.converged()) << dt << " " << i << " " << r.message;
      EXPECT_LE(r.violation, 1e-8);
      touched = touched || r.active_contacts > 0;
      const double height = scene.gravity.dot(stepper.displacement().transpose() * masses);
      const double now = r.energy + r.kinetic_energy - height;
      EXPECT_LE(worst(now - before), 1e-9 * (r.energy + r.kinetic_energy)) << dt << " " << i;
      before = now;
    }
    EXPECT_TRUE(touched) << dt;
  }
}

TEST(Dynamics, TiedBodiesShareTheirMomentum) {
  Scene scene = cube(Law::corotational, true);
  scene.mesh =
      test::make_mesh(test::joined(test::make_box({20, 20, 20}, 2, 2, 2),
                                   test::moved(test::make_box({20, 20, 20}, 2, 2, 2), {20, 0, 0})));
  const auto [left, right] = test::seam(scene.mesh, 27);
  scene.constraints.tie("seam", left, right);
  Stepper stepper(scene);
  stepper.set_damping({0.0, 1e-3});
  Points v = Points::Zero(54, 3);
  v.topRows(27).col(1).setConstant(50.0);  // they meet at different speeds
  stepper.set_velocity(v);
  const Eigen::VectorXd masses = Tissue(scene.mesh, scene.materials).node_masses();
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(stepper.step(0.005).converged());
  EXPECT_LE((stepper.velocity() - v).transpose().operator*(masses).norm(),
            1e-8 * (v.transpose() * masses).norm());
  for (std::size_t k = 0; k < left.size(); ++k) {
    EXPECT_EQ(stepper.displacement().row(left[k]), stepper.displacement().row(right[k]));
  }
}

// Block 40 x 40 x 60 mm, held at its base, that leans when gravity turns.
Scene leaning_block() {
  const Mesh mesh = test::make_mesh(test::make_box({40.0, 40.0, 60.0}, 2, 2, 3));
  Scene scene{mesh,
              {{0, Material(Law::corotational, 6.0, 0.45, test::tissue_density)}},
              Vec3(0.02 * standard_gravity, 0, 0),
              {},
              {}};
  scene.balanced_reference = false;
  scene.constraints.fix("base",
                        test::nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; }));
  return scene;
}

DeviceId insert_lead(Stepper& stepper, double density, double shear_bound = 0.0) {
  DeviceOptions options;
  options.density = density;
  TrackOptions track;
  track.shear_bound = shear_bound;
  return stepper.insert(make_device("3389", 55.0, options),
                        {Vec3(19.3, 20.7, 22.1), Vec3(0.1, 0.05, 1.0).normalized()},
                        {std::numeric_limits<double>::infinity(), 50.0, false}, track);
}

TEST(Dynamics, AMasslessLeadIsInBalanceAtEveryInstant) {
  Worst worst("tie gap mm");
  for (double shear_bound : {0.0, 0.05}) {  // without and with friction along it
    Stepper stepper(leaning_block()), alone(leaning_block());
    const DeviceId id = insert_lead(stepper, 0.0, shear_bound);
    for (int i = 0; i < 5; ++i) {
      const SolveReport report = stepper.step(0.01);
      ASSERT_TRUE(report.converged()) << report.message;
      EXPECT_LE(report.residual, 1e-8);
      EXPECT_LE(worst(stepper.device(id).largest_tie_gap), 1e-8);
      ASSERT_TRUE(alone.step(0.01).converged());
    }
    EXPECT_GT(largest_distance(stepper.displacement(), alone.displacement()), 1e-3);
    EXPECT_GT(stepper.device(id).bow, 0.0);
  }
}

TEST(Dynamics, ALeadWithMassMovesWithItAndRestsWithoutIt) {
  const double dt = 0.01;
  Stepper light(leaning_block()), heavy(leaning_block()), rest(leaning_block());
  insert_lead(light, 0.0);
  insert_lead(rest, 0.0);
  const DeviceId id = insert_lead(heavy, 1e-3);  // far heavier than steel, to be seen
  const Eigen::VectorXd masses = Tissue(heavy.mesh(), leaning_block().materials).node_masses();
  DeviceOptions options;
  options.density = 1e-3;
  const BeamDevice device = make_device("3389", 55.0, options);
  for (int i = 0; i < 4; ++i) {
    const Points before = heavy.device(id).nodes;
    ASSERT_TRUE(light.step(dt).converged());
    const SolveReport report = heavy.step(dt);
    ASSERT_TRUE(report.converged()) << report.message;
    EXPECT_LE(heavy.device(id).largest_tie_gap, 1e-8);
    const Points w = (heavy.device(id).nodes - before) / dt;
    double kinetic = 0.5 * masses.dot(heavy.velocity().rowwise().squaredNorm());
    for (Index e = 0; e < device.element_count(); ++e) {
      const double half =
          0.5 * device.section(e).line_density * (device.arcs()[e + 1] - device.arcs()[e]);
      kinetic += 0.5 * half * (w.row(e).squaredNorm() + w.row(e + 1).squaredNorm());
    }
    EXPECT_NEAR(report.kinetic_energy, kinetic, 1e-8 * kinetic);
  }
  EXPECT_GT(largest_distance(light.displacement(), heavy.displacement()), 1e-3);
  heavy.set_damping({50.0, 0.0});
  for (int i = 0; i < 12; ++i) ASSERT_TRUE(heavy.step(10.0).converged());
  ASSERT_TRUE(rest.solve_static().converged());
  EXPECT_LE(largest_distance(rest.displacement(), heavy.displacement()), 1e-7);
}

TEST(Dynamics, BranchesFromOneSnapshotAreTheSameBitsWithVelocity) {
  Stepper stepper(leaning_block());
  insert_lead(stepper, 8e-6);
  stepper.set_damping({3.0, 0.001});
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(stepper.step(0.01).converged());
  const auto kept = stepper.snapshot();
  const Points at = stepper.velocity();
  Points u[2], v[2];
  for (int branch = 0; branch < 2; ++branch) {
    stepper.restore(kept);
    EXPECT_TRUE(same_bits(at, stepper.velocity()));
    EXPECT_EQ(stepper.damping().alpha, 3.0);
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(stepper.step(0.01).converged());
    u[branch] = stepper.displacement();
    v[branch] = stepper.velocity();
    stepper.set_damping({});
    stepper.set_gravity(Vec3::Zero());
    ASSERT_TRUE(stepper.solve_static().converged());
  }
  EXPECT_TRUE(same_bits(u[0], u[1]));
  EXPECT_TRUE(same_bits(v[0], v[1]));
}

TEST(Dynamics, AFailedStepLeavesStateAndSettingsAsTheyWere) {
  bool go_on = true;
  StepperOptions options;
  options.progress = [&](const Progress&) { return go_on; };
  Stepper stepper(busy_scene(), options);
  stepper.csf().set_lost_volume(0, 4000.0);
  stepper.set_damping({2.0, 0.0});
  ASSERT_TRUE(stepper.step(0.05).converged());
  const Points u = stepper.displacement(), v = stepper.velocity(), f = stepper.external_force();
  stepper.csf().set_lost_volume(0, 9000.0);
  go_on = false;
  EXPECT_EQ(stepper.step(0.05).status, Status::cancelled);
  stepper.csf().set_lost_volume(0, 1e9);
  EXPECT_THROW(stepper.step(0.05), Error);
  EXPECT_EQ(stepper.phase(), StepPhase::idle);
  EXPECT_TRUE(same_bits(u, stepper.displacement()));
  EXPECT_TRUE(same_bits(v, stepper.velocity()));
  EXPECT_TRUE(same_bits(f, stepper.external_force()));
  EXPECT_EQ(stepper.damping().alpha, 2.0);
  // and the next step is that of an object that never failed
  go_on = true;
  stepper.csf().set_lost_volume(0, 6000.0);
  ASSERT_TRUE(stepper.step(0.05).converged());
  Stepper fresh(busy_scene());
  fresh.set_damping({2.0, 0.0});
  for (double lost : {4000.0, 6000.0}) {
    fresh.csf().set_lost_volume(0, lost);
    ASSERT_TRUE(fresh.step(0.05).converged());
  }
  EXPECT_TRUE(same_bits(fresh.displacement(), stepper.displacement()));
  EXPECT_TRUE(same_bits(fresh.velocity(), stepper.velocity()));
}

TEST(Dynamics, RoundingLimitsShortStepsHonestly) {
  Scene scene = cube(Law::stable_neo_hookean, true);
  scene.gravity = Vec3(0, 0, -standard_gravity);
  for (double dt : {1e-1, 1e-3, 1e-5, 1e-9, 1e-160, 1e-200, 1e-307, 1e200}) {
    Stepper stepper(scene);
    stepper.set_velocity(random_points(scene.mesh.node_count(), 5.0, 1));
    for (int i = 0; i < 3; ++i) {
      const SolveReport report = stepper.step(dt);
      EXPECT_TRUE(report.converged() || dt < 1e-5 || dt > 1.0) << dt << " " << report.message;
      if (report.converged()) {
        EXPECT_LE(report.residual, 1e-8) << dt;
      } else {
        EXPECT_NE(report.message.find("time step"), std::string::npos) << report.message;
      }
    }
  }
}

TEST(Dynamics, NonsenseIsRefusedByName) {
  Stepper stepper(cube(Law::linear));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (double dt : {0.0, -1e-9, nan, infinity}) {
    expect_error(ErrorCode::invalid_argument, {"time step", "dt"}, [&] { stepper.step(dt); });
    expect_error(ErrorCode::invalid_argument, {"time step", "dt"}, [&] { stepper.begin_step(dt); });
  }
  EXPECT_EQ(stepper.phase(), StepPhase::idle);
  expect_error(ErrorCode::invalid_argument, {"alpha", "negative"}, [&] {
    stepper.set_damping({-1e-12, 0.0});
  });
  expect_error(ErrorCode::invalid_argument, {"beta", "negative"}, [&] {
    stepper.set_damping({0.0, -2.0});
  });
  expect_error(ErrorCode::not_finite, {"alpha"}, [&] { stepper.set_damping({nan, 0.0}); });
  expect_error(ErrorCode::not_finite, {"beta"}, [&] { stepper.set_damping({0.0, infinity}); });
  EXPECT_EQ(stepper.damping().alpha, 0.0);
  EXPECT_EQ(stepper.damping().beta, 0.0);
  expect_error(ErrorCode::size_mismatch, {"26 rows"},
               [&] { stepper.set_velocity(Points::Zero(26, 3)); });
  Points v = Points::Zero(27, 3);
  v(5, 1) = nan;
  expect_error(ErrorCode::not_finite, {"node 5"}, [&] { stepper.set_velocity(v); });
  EXPECT_TRUE(stepper.velocity().isZero(0.0));
}

}  // namespace
}  // namespace brainshift
