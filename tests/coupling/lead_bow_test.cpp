// How much a bowed lead pulls its ends together: 8 b^2/3L for a parabola, which the arc of a circle
// is to the next order in b/L.
#include <cstdio>

#include <gtest/gtest.h>

#include "support/beams.hpp"

namespace brainshift::test {
namespace {

constexpr double EI = 5000.0, length = 75.0;  // mN mm^2, mm, mm
// 1e6 times the axial stiffness of a solid rod of that EI: the strain of the loads below is 1e-9.
const BeamSection section = round_section(EI, 1e6 * 4.0 * EI / (0.635 * 0.635), EI);

struct Bowed {
  double size, shortening, stretch;  // mm
};

// Hinged at both ends, one of which slides along the line between them.
Bowed bowed(Index elements, const Eigen::VectorXd& force) {
  const Beam beam = straight_beam(length, elements, section);
  BeamState state = beam.rest();
  const auto fixed = joined(dofs_of(0, {0, 1, 2, 3}), dofs_of(elements, {1, 2}));
  const BeamStaticsReport report = solve_statics(beam, {force, fixed}, state);
  EXPECT_TRUE(report.converged) << report.correction;
  const double chord = (state.x.row(elements) - state.x.row(0)).norm();
  return {bow(beam, state, 0.0, length).size, length - chord,
          curve_length(beam, state, 0.0, length) - length};
}

Bowed by_end_moments(Index elements, double moment) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(6 * (elements + 1));
  force[5] = -moment;
  force[6 * elements + 5] = moment;
  return bowed(elements, force);
}

// Half angle of the arc of this length with this bow: b = L (1 - cos a)/(2 a).
double half_angle(double wanted) {
  double a = 4.0 * wanted / length;
  for (int i = 0; i < 50; ++i) a *= wanted / (length * (1.0 - std::cos(a)) / (2.0 * a));
  return a;
}

TEST(BowedLead, ShortensAsAnArcDoes) {
  const double wanted = 2.5, a = half_angle(wanted), rule = 8.0 * wanted * wanted / (3.0 * length);
  const double arc = length * (1.0 - std::sin(a) / a);
  for (const Index elements : {8, 16, 38}) {
    const Bowed b = by_end_moments(elements, 2.0 * a / length * EI);
    std::printf(
        "bowed lead, %2d elements: bow %.6f mm, shortening %.6f mm, arc %.6f, 8b^2/3L %.6f, "
        "curve longer by %.1e\n",
        int(elements), b.size, b.shortening, arc, rule, b.stretch);
    EXPECT_NEAR(b.size, wanted, 1e-6 * wanted);
    EXPECT_NEAR(b.shortening, arc, 1e-5 * arc);
    // What the rule leaves out of the arc, to the next order: 7 a^2/60 = 28/15 (b/L)^2 = 2.1e-3.
    EXPECT_NEAR(b.shortening / rule - 1.0, 7.0 * a * a / 60.0, a * a * a * a);
    EXPECT_NEAR(b.shortening, 0.22, 0.005);
    EXPECT_LE(std::abs(b.stretch), 2e-4 * b.shortening);
  }
}

// Shortening of a shallow bow is c b^2/L, and c belongs to its shape: 8/3 for the parabola, 2.48686
// (17408/7000) for a load spread evenly. Ten times as shallow: (b/L)^2 = 1e-5.
TEST(BowedLead, TheFactorBelongsToTheShape) {
  const Index elements = 76;
  const double wanted = 0.25, load = wanted * 384.0 * EI / (5.0 * std::pow(length, 4));  // mN/mm
  Eigen::VectorXd force = Eigen::VectorXd::Zero(6 * (elements + 1));
  for (Index i = 0; i <= elements; ++i) {
    force[6 * i + 1] = load * length / elements * (i == 0 || i == elements ? 0.5 : 1.0);
  }
  const auto factor = [](const Bowed& b) { return b.shortening * length / (b.size * b.size); };
  const double even = factor(bowed(elements, force));
  const double parabola = factor(by_end_moments(elements, 2.0 * half_angle(wanted) / length * EI));
  std::printf(
      "bowed lead: shortening L/b^2 %.5f by end moments (8/3), %.5f under an even load "
      "(2.48686)\n",
      parabola, even);
  EXPECT_NEAR(parabola, 8.0 / 3.0, 1e-4 * 8.0 / 3.0);
  EXPECT_NEAR(even, 17408.0 / 7000.0, 2e-4 * 2.48686);
}

}  // namespace
}  // namespace brainshift::test
