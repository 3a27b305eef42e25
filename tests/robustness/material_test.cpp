// Materials at and beyond the end of their range.
#include <limits>

#include "robustness/outcome.hpp"
#include "stepper/solve.hpp"
#include "support/laws.hpp"

namespace brainshift::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

Material material(double young, double poisson, double density = tissue_density) {
  return Material(Law::corotational, young, poisson, density);
}

TEST(MaterialLimits, A1_poisson_of_one_half_is_refused) {
  expect_error(ErrorCode::invalid_argument, {"poisson", "0.5"}, [] { material(6.0, 0.5); });
}

// There is no list of warnings: what a linear tet does near 0.5 is under Limits in README.md. The
// certificate says what the arithmetic was worth.
TEST(MaterialLimits, A2_next_to_one_half_the_certificate_still_holds) {
  for (const double poisson : {0.45, 0.49, 0.499, 0.49999, 0.4999999999}) {
    Stepper stepper(cube_on_base(Law::corotational, {0, 0, -standard_gravity}, 3, poisson));
    const SolveReport report = stepper.solve_static();
    expect_converged_or_failed(report);
    EXPECT_TRUE(report.converged() || poisson > 0.49999) << poisson << ": " << report.message;
    // What rounding leaves is not called a limit point.
    EXPECT_NE(report.status, Status::no_equilibrium);
  }
}

TEST(MaterialLimits, A3_parameters_outside_their_range) {
  for (const double poisson : {-1.0, -1.2, 0.6, 0.5, infinity, nan})
    EXPECT_THROW(material(6.0, poisson), Error) << poisson;
  for (const double young : {0.0, -0.0, -1.0, infinity, nan})
    EXPECT_THROW(material(young, 0.45), Error) << young;
  for (const double density : {-1e-12, infinity, nan})
    EXPECT_THROW(material(6.0, 0.45, density), Error) << density;
  EXPECT_NO_THROW(material(6.0, 0.45, 0.0));  // massless tissue has a use in statics
}

TEST(MaterialLimits, A4_no_modulus_is_too_small_or_too_large_or_it_says_so) {
  const auto solve = [](double factor) {
    Scene scene = cube_on_base(Law::corotational);
    scene.materials = {{0, material(6.0 * factor, 0.45, tissue_density * factor)}};
    Stepper stepper(scene);
    return std::make_pair(stepper.solve_static(), stepper.displacement());
  };
  const Points plain = solve(1.0).second;
  for (const double factor : {1e-6, 1e-3, 1e3, 1e12}) {
    const auto [report, u] = solve(factor);
    expect_converged(report);
    EXPECT_LE(largest_distance(u, plain), 1e-12 * 20.0 * 10.0) << factor;
  }
  for (const double factor : {1e-300, 1e300}) expect_converged_or_failed(solve(factor).first);
  EXPECT_THROW(material(1e308, 0.499999), Error);  // lambda is beyond double
}

// Confined: P(l) = (lambda + 2 mu) (l^3 - l)/2, exact to 0.7 and beyond its least value at 1/sqrt(3).
TEST(MaterialLimits, A5_st_venant_kirchhoff_around_its_limit_point) {
  const Material m(Law::st_venant_kirchhoff, 6.0, 0.45, 0.0);
  const double modulus = m.lambda() + 2.0 * m.mu();
  for (const double l : {0.9, 0.7, 0.6, 0.5, 0.3}) {
    Mat3 G = Mat3::Zero();
    G(2, 2) = l - 1.0;
    EXPECT_NEAR(m.stress(G)(2, 2), 0.5 * modulus * (l * l * l - l), 1e-13 * modulus) << l;
    const double tangent = m.tangent(G)(8, 8);
    EXPECT_EQ(tangent > 0.0, l > 1.0 / std::sqrt(3.0)) << l;
  }
}

// A block held at its base under more and more weight: balance with every tet the right way round, or
// no_equilibrium with the part that was reached; never an inverted one called converged.
TEST(MaterialLimits, A6_a_block_pressed_too_far_is_never_a_success_with_inverted_tets) {
  int failed = 0;
  for (const int cells : {2, 4}) {
    for (const double factor : {2.0, 4.0, 8.0, 16.0}) {
      Stepper stepper(
          cube_on_base(Law::st_venant_kirchhoff, {0, 0, -factor * standard_gravity}, cells, 0.3));
      const SolveReport report = stepper.solve_static();
      expect_converged_or_failed(report);
      if (report.converged()) continue;
      ++failed;
      EXPECT_TRUE(stepper.displacement().isZero(0.0));
    }
  }
  EXPECT_GT(failed, 0);
}

TEST(MaterialLimits, A7_a_bar_without_equilibrium_gets_the_part_it_reached_and_a_hint) {
  Scene scene = cube_on_base(Law::st_venant_kirchhoff);
  scene.mesh = make_mesh(make_box({20, 20, 100}, 2, 2, 10));
  scene.constraints = {};
  scene.constraints.fix("base", bottom(scene.mesh));
  Stepper stepper(scene);
  const SolveReport report = stepper.solve_static();
  EXPECT_EQ(report.status, Status::no_equilibrium);
  EXPECT_GT(report.load_factor, 0.05);  // measured elsewhere: 0.09 to 0.2 by the mesh
  EXPECT_LT(report.load_factor, 0.5);
  for (const char* word : {"neo_hookean", "support", "contact", "beyond"})
    EXPECT_NE(report.message.find(word), std::string::npos) << report.message;
  // The part it names can be had.
  stepper.set_gravity({0, 0, -0.99 * report.load_factor * standard_gravity});
  expect_converged(stepper.solve_static());
}

TEST(MaterialLimits, A8_a_step_to_where_the_law_has_no_energy_is_cut) {
  const Material m(Law::log_neo_hookean, 6.0, 0.45, 0.0);
  Mat3 G = Mat3::Zero();
  for (const double l : {0.0, -0.5}) {
    G(2, 2) = l - 1.0;
    EXPECT_EQ(m.energy(G), infinity) << l;
  }
  Stepper stepper(cube_on_base(Law::log_neo_hookean, {0, 0, -8.0 * standard_gravity}));
  expect_converged(stepper.solve_static());  // the linear step would go far through the floor
}

// Uniform stress goes through a jump of stiffness as theory says: pulled along z in series, with nu = 0,
// each half stretches by its own sigma/E.
TEST(MaterialLimits, A9_stiffness_that_jumps_between_neighbours) {
  for (const double ratio : {10.0, 1e3, 1e6}) {
    const TetShape shape = make_box({10, 10, 20}, 2, 2, 4);
    Indices regions(std::size_t(shape.tets.rows()), 0);
    for (Eigen::Index t = shape.tets.rows() / 2; t < shape.tets.rows(); ++t)
      regions[std::size_t(t)] = 1;
    Scene scene{make_mesh(shape, regions),
                {{0, Material(Law::linear, 6.0, 0.0, tissue_density)},
                 {1, Material(Law::linear, 6.0 * ratio, 0.0, 0.0)}},
                {0, 0, -standard_gravity}};
    scene.balanced_reference = false;
    scene.constraints.fix("base", bottom(scene.mesh));
    Stepper stepper(scene);
    expect_converged(stepper.solve_static());
    const Points& u = stepper.displacement();
    const auto mean = [&](double z) {
      return mean_row(u, nodes_where(scene.mesh, [z](const Vec3& x) { return x.z() == z; })).z();
    };
    // Nothing heavy above: the stiff half is carried down as it is.
    EXPECT_NEAR(mean(20.0), mean(10.0), 1e-8 * std::abs(mean(10.0)) + 1e-3 / ratio);
    EXPECT_LT(mean(10.0), -0.05);
  }
}

// One tet pushed through its base comes back, and no law leaves NaN where two singular values are
// the same.
TEST(MaterialLimits, A10_an_inverted_tet_returns) {
  TetShape one{Points(4, 3), Tets(1, 4)};
  one.points << 0, 0, 0, 10, 0, 0, 0, 10, 0, 0, 0, 10;
  one.tets << 0, 1, 2, 3;
  for (const Law law : all_laws) {
    Scene scene{make_mesh(one), {{0, Material(law, 6.0, 0.3, tissue_density)}}, Vec3::Zero()};
    scene.constraints.fix("base", {0, 1, 2});
    MechanicalState state{Points::Zero(4, 3), {}, {}};
    state.u(3, 2) = -15.0;  // z from 10 to -5
    const StepperOptions options;
    FactorCache cache;
    Solve solve(Equilibrium(scene), {}, state, options, cache, {});
    while (solve.phase() == StepPhase::begun || solve.phase() == StepPhase::updated) {
      solve.linearise();
      solve.solve();
      solve.update();
      ASSERT_TRUE(solve.iterate().allFinite()) << to_string(law);
    }
    const SolveReport& report = solve.report();
    if (allows_inversion(law)) {
      // Saint-Venant-Kirchhoff's energy does not see a reflection: there it is in balance, which
      // is no answer.
      const bool mirrored = law == Law::st_venant_kirchhoff;
      EXPECT_EQ(report.converged(), !mirrored) << to_string(law) << ": " << report.message;
      EXPECT_NEAR(report.smallest_jacobian, mirrored ? -1.0 : 1.0, 1e-8) << to_string(law);
      EXPECT_EQ(report.message.find("tet 0 inverted") != std::string::npos, mirrored);
    } else {
      EXPECT_EQ(report.status, Status::no_equilibrium) << to_string(law);
    }
    for (const Vec3& s : {Vec3(1, 1, -1), Vec3(1, -1, -1), Vec3(0, 0, 0), Vec3(2, 0, 0),
                          Vec3(-1, -1, -1), Vec3(1, 1e-9, -1e-9)}) {
      const Mat3 G = Mat3(s.asDiagonal()) - Mat3::Identity();
      const Material m(law, 6.0, 0.3, 0.0);
      EXPECT_FALSE(std::isnan(m.energy(G))) << to_string(law) << s.transpose();
      EXPECT_FALSE(m.stress(G).array().isNaN().any()) << to_string(law) << s.transpose();
      EXPECT_FALSE(m.tangent(G, true).array().isNaN().any()) << to_string(law) << s.transpose();
    }
  }
}

TEST(MaterialLimits, A11_a_corotational_bar_under_its_full_weight) {
  for (const int cells : {1, 2}) {
    Scene scene = cube_on_base(Law::corotational);
    scene.mesh = make_mesh(make_box({20, 20, 100}, cells, cells, 5 * cells));
    scene.constraints = {};
    scene.constraints.fix("base", bottom(scene.mesh));
    Stepper stepper(scene);
    const SolveReport report = stepper.solve_static();
    std::printf("A11: %d cells: %s at %.3f of the load, min J %.3f\n", cells,
                to_string(report.status), report.load_factor, report.smallest_jacobian);
    expect_converged_or_failed(report);
  }
}

// A material belongs to its scene and never changes; a second stepper on the same mesh knows
// nothing of the first.
TEST(MaterialLimits, A12_nothing_of_another_material_is_reused) {
  const auto solve = [](const Scene& scene) {
    Stepper stepper(scene);
    expect_converged(stepper.solve_static());
    return stepper.displacement();
  };
  Scene soft = cube_on_base(Law::corotational), stiff = soft;
  stiff.materials = {{0, material(9.0, 0.4)}};
  const Points fresh = solve(stiff), other = solve(soft);
  EXPECT_TRUE(same_bits(solve(stiff), fresh));
  EXPECT_GT(largest_distance(other, fresh), 0.05);
}

}  // namespace
}  // namespace brainshift::test
