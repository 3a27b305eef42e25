// Plane bending far beyond small rotations: elastica, post-buckling, roll-up, linear limit.
#include <cstdio>

#include <gtest/gtest.h>

#include "support/beams.hpp"

namespace brainshift::test {
namespace {

constexpr double L = 1.0, EI = 1.0;
// Stretching of P/EA at most 2e-8 of the length: below every tolerance here.
constexpr double inextensible = 1e9;

// Equilibrium under a tip force, in one load step; with a `push` beside it first, then without.
BeamState bent(const Beam& beam, const Vec3& force, const Vec3& push = Vec3::Zero()) {
  BeamState state = beam.rest();
  const BeamLoad first = cantilever(beam, force + push), last = cantilever(beam, force);
  EXPECT_TRUE(solve_statics(beam, first, state).converged);
  if (!push.isZero()) {
    EXPECT_TRUE(solve_statics(beam, last, state, {}, first.force).converged);
  }
  return state;
}

// alpha = P L^2/EI; shortening and deflection over L, tip slope (rad), from elliptic integrals.
struct Elastica {
  double alpha, u, w, slope;
};
const Elastica elastica[] = {
    {0.2, 0.002646548341, 0.06636448214, 0.09963616}, {1, 0.05643323628, 0.3017207738, 0.46135195},
    {2, 0.1606417208, 0.4934574804, 0.78174983},      {4, 0.3289412422, 0.6699641813, 1.12123935},
    {5, 0.3876283607, 0.7137915236, 1.21536812},      {10, 0.5549955978, 0.8106090249, 1.43028554},
    {20, 0.6838855676, 0.8686958983, 1.53293496}};

double elastica_error(const Elastica& row, Index elements) {
  const Beam beam = straight_beam(L, elements, round_section(EI, inextensible));
  const BeamState state = bent(beam, Vec3(0, row.alpha * EI / (L * L), 0));
  const Vec3 tip = tip_of(state), along = state.R.back().col(0);
  return std::max({std::abs(L - tip.x() - row.u), std::abs(tip.y() - row.w),
                   std::abs(std::atan2(along.y(), along.x()) - row.slope)});
}

TEST(BeamElastica, TipMeetsEllipticIntegrals) {
  for (const Elastica& row : elastica) {
    double error[4];
    for (int k = 0; k < 4; ++k) error[k] = elastica_error(row, 4 << k);
    std::printf(
        "elastica alpha %5.1f: error with 4, 8, 16, 32 elements %.2e %.2e %.2e %.2e, "
        "orders %.2f %.2f\n",
        row.alpha, error[0], error[1], error[2], error[3], order(error[0], error[1]),
        order(error[1], error[2]));
    EXPECT_LT(error[2], 1e-5);  // 1e-3 asked for with 20 elements
    // order 4, until the digits of the table (1e-8) are reached
    if (error[2] > 1e-7) {
      EXPECT_GT(order(error[1], error[2]), 3.5);
    }
    EXPECT_LT(error[3], 1e-6);
  }
}

// The whole load in one step, from straight to a slope of 82 degrees: some ten iterations, whatever
// the stiffness against stretching (an energy line search alone takes hundreds, growing with it).
TEST(BeamElastica, OneStepInAFewIterations) {
  for (const double ratio : {1e3, 1e5, 1e9}) {
    const Beam beam = straight_beam(L, 20, round_section(EI, ratio));
    BeamState state = beam.rest();
    const auto report = solve_statics(beam, cantilever(beam, Vec3(0, 10.0, 0)), state);
    EXPECT_TRUE(report.converged);
    std::printf("elastica alpha 10 in one step, EA L^2/EI %.0e: %d iterations\n", ratio,
                report.iterations);
    EXPECT_LE(report.iterations, 40);
  }
}

// Cantilever under P along its axis, beyond P_cr = pi^2 EI/4L^2: tip slope, P/P_cr, x/L, y/L.
TEST(BeamElastica, PostBucklingMeetsEllipticIntegrals) {
  const struct {
    double slope, load, x, y;
  } rows[] = {{20, 1.01539687, 0.969730907, 0.219413042},
              {60, 1.15171962, 0.741019606, 0.593207646},
              {100, 1.51838879, 0.348989300, 0.791539497},
              {140, 2.54225837, -0.106923238, 0.750388366}};
  const double critical = 0.25 * pi * pi * EI / (L * L);
  for (const auto& row : rows) {
    double error[3];
    for (int k = 0; k < 3; ++k) {
      const Beam beam = straight_beam(L, 8 << k, round_section(EI, inextensible));
      const BeamState state = bent(beam, Vec3(-row.load * critical, 0, 0), Vec3(0, 0.5, 0));
      const Vec3 tip = tip_of(state);
      error[k] = std::hypot(tip.x() - row.x, std::abs(tip.y()) - row.y);
    }
    std::printf(
        "post-buckling %3.0f deg: error with 8, 16, 32 elements %.2e %.2e %.2e, order %.2f\n",
        row.slope, error[0], error[1], error[2], order(error[0], error[1]));
    // near the bifurcation the amplitude magnifies the error of the load (20 degrees: 30 times)
    EXPECT_LT(error[1], 1e-3);
    EXPECT_LT(error[2], 1e-4);
    EXPECT_GT(order(error[0], error[1]), 2.0);
  }
}

// M = lambda 2 pi EI/L bends a cantilever to an arc: exact at the nodes but for the chord of an
// element, whose series is cut after the second power of the half angle: theta^4/120, order 4.
TEST(BeamRollUp, EndMomentMakesACircle) {
  for (const double lambda : {0.5, 1.0, 2.0}) {
    double error[3];
    for (int k = 0; k < 3; ++k) {
      const Index elements = (lambda > 1.0 ? 16 : 8) << k;
      const Beam beam = straight_beam(L, elements, round_section(EI, inextensible));
      BeamState state = beam.rest();
      BeamStaticsOptions options;
      const BeamLoad load = cantilever(beam, Vec3::Zero(), Vec3(0, 0, lambda * 2.0 * pi * EI / L));
      const auto report = solve_statics(beam, load, state, options);
      EXPECT_TRUE(report.converged);
      const double angle = 2.0 * pi * lambda;
      const Vec3 exact(std::sin(angle) / angle, (1.0 - std::cos(angle)) / angle, 0.0);
      error[k] = (tip_of(state) - L * exact).norm() / L;
      const double theta = pi * lambda / elements;
      // relative error of each chord; the whole figure is scaled by it, plus the next term
      EXPECT_LT(error[k], 1.1 * std::pow(theta, 4) / 120.0 * exact.norm() + 1e-8) << elements;
      std::printf("roll-up lambda %.1f: %d elements, error %.2e L, %d iterations\n", lambda,
                  int(elements), error[k], report.iterations);
    }
  }
}

// Small load: PL^3/3EI + PL/(shear factor) GA, exact to rounding with one element.
TEST(BeamLinear, TipDeflectionOfACantilever) {
  for (const double shear : {std::numeric_limits<double>::infinity(), 50.0}) {
    BeamSection section = round_section(EI, 1e4);
    section.shear = shear;
    const double P = 1e-7, exact = P * L * L * L / (3.0 * EI) + P * L / shear;
    for (const Index elements : {1, 2, 7}) {
      const Beam beam = straight_beam(L, elements, section);
      // the next term of the elastica is (P L^2/EI)^2 smaller
      EXPECT_NEAR(tip_of(bent(beam, Vec3(0, 0, P))).z(), exact, 1e-10 * exact);
    }
  }
}

// Stiff steel and floppy lead, mm and mN, with the EA of a solid rod and a thousand times that: no
// membrane locking, the same accuracy over five decades.
TEST(BeamElastica, IndependentOfStiffnessAndOfAxialRatio) {
  const double length = 150.0, radius = 0.635;
  double worst = 0.0;
  for (const double bending : {1e3, 5e3, 1e5, 6.5e7}) {
    for (const double ratio : {4.0, 4000.0}) {
      const BeamSection section = round_section(bending, ratio * bending / (radius * radius));
      const Beam beam = straight_beam(length, 16, section);
      const BeamState state = bent(beam, Vec3(0, 10.0 * bending / (length * length), 0));
      worst = std::max(worst, std::abs(tip_of(state).y() / length - 0.8106090249));
    }
  }
  std::printf("elastica alpha 10, EI 1e3 to 6.5e7, L/r 236: worst error %.2e L\n", worst);
  // stretching: P/EA = 10 (r/L)^2/4 = 4.5e-5 for the solid rod
  EXPECT_LT(worst, 1.5e-4);
}

}  // namespace
}  // namespace brainshift::test
