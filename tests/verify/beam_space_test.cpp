// Beams in space: 45 degree bend, helix.
#include <cstdio>

#include <gtest/gtest.h>

#include "support/beams.hpp"

namespace brainshift::test {
namespace {

// Arc of 45 degrees, radius 100, square section of side 1, E = 1e7, nu = 0, from the origin along +x.
// Tip load along z.
Beam quarter_bend(Index elements, double torsion, double shear) {
  constexpr double radius = 100.0, E = 1e7, I = 1.0 / 12.0;
  BeamSection section = round_section(E * I, E, torsion);
  section.shear = shear;
  Points nodes(elements + 1, 3);
  std::vector<Mat3> frames;
  for (Index i = 0; i <= elements; ++i) {
    const double angle = 0.25 * pi * i / elements;
    nodes.row(i) << radius * std::sin(angle), radius * (1.0 - std::cos(angle)), 0.0;
    frames.push_back(rotation_exp(Vec3(0, 0, angle)));
  }
  return Beam(BeamDevice("bend", nodes, {section}, {}, frames), Vec3::Zero(), Mat3::Identity());
}

Vec3 bend_tip(const Beam& beam, double P, int load_steps) {
  BeamState state = beam.rest();
  BeamStaticsOptions options;
  options.load_steps = load_steps;
  const auto report = solve_statics(beam, cantilever(beam, Vec3(0, 0, P)), state, options);
  EXPECT_TRUE(report.converged);
  return tip_of(state);
}

// Converged values of the geometrically exact (Reissner) beam, ten digits, by an independent
// method; G = E/2, torsion constant 0.140577 or polar (1/6), shear factor 1 or 5/6.
TEST(BeamBend45, TipMeetsTheGeometricallyExactBeam) {
  const double G = 5e6;
  const struct {
    double P, torsion, shear;
    Vec3 tip;
  } rows[] = {{300, 0.1405770150 * G, G, {58.535932621, 22.112614520, 40.480261580}},
              {600, 0.1405770150 * G, G, {46.891924781, 15.557785824, 53.607369266}},
              {600, G / 6.0, 5.0 / 6.0 * G, {47.150096240, 15.684689479, 53.475477998}}};
  for (const auto& row : rows) {
    double error[4];
    for (int k = 0; k < 4; ++k) {
      error[k] =
          (bend_tip(quarter_bend(4 << k, row.torsion, row.shear), row.P, 1) - row.tip).norm();
    }
    std::printf(
        "45 degree bend P %.0f: error with 4, 8, 16, 32 elements %.2e %.2e %.2e %.2e, "
        "orders %.2f %.2f\n",
        row.P, error[0], error[1], error[2], error[3], order(error[0], error[1]),
        order(error[1], error[2]));
    // Order 4 where sections turn with the curve; shear, which is 0.006 mm here, is found as the
    // elements become shorter than (12 EI/GA)^1/2 = 1.4 mm.
    EXPECT_GT(order(error[0], error[1]), 3.0);
    EXPECT_LT(error[1], 2e-3);
    EXPECT_LT(error[3], 5e-4);
  }
}

// Without shear the order shows: three meshes against each other.
TEST(BeamBend45, OrderOfConvergenceWithoutShear) {
  Vec3 tip[4];
  for (int k = 0; k < 4; ++k) {
    const double rigid = std::numeric_limits<double>::infinity();
    tip[k] = bend_tip(quarter_bend(4 << k, 0.1405770150 * 5e6, rigid), 600.0, 1);
  }
  const double first = (tip[1] - tip[0]).norm(), second = (tip[2] - tip[1]).norm(),
               third = (tip[3] - tip[2]).norm();
  std::printf("45 degree bend, no shear: changes %.2e %.2e %.2e, orders %.2f %.2f\n", first, second,
              third, order(first, second), order(second, third));
  EXPECT_GT(order(first, second), 3.5);
  EXPECT_GT(order(second, third), 3.5);
}

TEST(BeamBend45, TipDoesNotDependOnTheLoadSteps) {
  const Beam beam = quarter_bend(16, 0.1405770150 * 5e6, 5e6);
  for (const double P : {300.0, 600.0}) {
    const Vec3 one = bend_tip(beam, P, 1);
    // tolerance of the solve, 1e-11, times the length of 78.5
    for (const int steps : {8, 60}) EXPECT_LT((bend_tip(beam, P, steps) - one).norm(), 1e-8);
  }
}

// Straight along x, clamped; a moment fixed in space about z and a force along z, both on the tip:
// up to ten turns of helix.
TEST(BeamHelix, TipMeetsTheGeometricallyExactBeam) {
  double error[3][3];
  int mesh = 0;
  constexpr double length = 10.0;
  BeamSection section = round_section(1e2, 1e4, 1e2);
  section.shear = 1e4;
  const struct {
    double lambda;
    Vec3 tip;
  } rows[] = {{0.1, {0.41020335, 0.05377090, -1.09172902}},
              {0.5, {0.01910699, 0.00057398, -0.22663744}},
              {1.0, {0.00480325, 0.00007250, -0.07644174}}};
  for (const Index elements : {50, 100, 200}) {
    const Beam beam = straight_beam(length, elements, section);
    BeamState state = beam.rest();
    Eigen::VectorXd from;
    for (int k = 0; k < 3; ++k) {
      const auto& row = rows[k];
      const BeamLoad load =
          cantilever(beam, Vec3(0, 0, row.lambda * 50.0), Vec3(0, 0, row.lambda * 200.0 * pi));
      BeamStaticsOptions options;
      options.load_steps = k == 0 ? 10 : 40;
      const auto report = solve_statics(beam, load, state, options, from);
      ASSERT_TRUE(report.converged) << row.lambda;
      from = load.force;
      const Vec3 tip = tip_of(state);
      error[mesh][k] = (tip - row.tip).norm();
      std::printf("helix lambda %.1f, %d elements: tip %.8f %.8f %.8f, error %.2e, %d iterations\n",
                  row.lambda, int(elements), tip.x(), tip.y(), tip.z(), error[mesh][k],
                  report.iterations);
    }
    ++mesh;
  }
  for (int k = 0; k < 3; ++k) {
    // an element of the coarsest mesh turns by 7, 36, 72 degrees
    EXPECT_GT(order(error[0][k], error[1][k]), 1.8) << rows[k].lambda;
    EXPECT_GT(order(error[1][k], error[2][k]), 1.9) << rows[k].lambda;
    EXPECT_LT(error[2][k], 1e-3);
  }
}

}  // namespace
}  // namespace brainshift::test
