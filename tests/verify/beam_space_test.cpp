// Beams in space: 45 degree bend, shear of a rod bent and twisted, helix, independence of the path.
#include <cstdio>

#include <gtest/gtest.h>

#include "support/beams.hpp"
#include "support/reissner.hpp"

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

constexpr double bend_shear = 5e6, bend_torsion = 0.140577 * bend_shear;  // G = E/2, unit square

TEST(BeamBend45, StartsWhereAnArcOf45DegreesEnds) {
  const Beam beam = quarter_bend(8, bend_torsion, bend_shear);
  EXPECT_LE((tip_of(beam.rest()) - Vec3(70.710678, 29.289322, 0.0)).norm(), 1e-6);  // its digits
}

// Converged values of the geometrically exact (Reissner) beam, ten digits, by an independent
// method; torsion constant 0.140577 or polar (1/6), shear factor 1 or 5/6. Shooting gives them, too.
TEST(BeamBend45, TipMeetsTheGeometricallyExactBeam) {
  const double G = bend_shear, EI = 1e7 / 12.0, EA = 1e7, arc = 25.0 * pi;
  const struct {
    const char* name;
    double P, torsion, shear;
    Vec3 tip;
  } rows[] = {
      {"45 degree bend, P 300", 300, bend_torsion, G, {58.535932621, 22.112614520, 40.480261580}},
      {"45 degree bend, P 600", 600, bend_torsion, G, {46.891924781, 15.557785824, 53.607369266}},
      {"45 degree bend, P 600, polar, 5/6",
       600,
       G / 6.0,
       5.0 / 6.0 * G,
       {47.150096240, 15.684689479, 53.475477998}}};
  for (const auto& row : rows) {
    const ReissnerRod rod{arc, Vec3(1.0 / EA, 1.0 / row.shear, 1.0 / row.shear),
                          Vec3(1.0 / row.torsion, 1.0 / EI, 1.0 / EI), Vec3(0, 0, 0.01)};
    const Vec3 shot = rod.tip(Vec3(0, 0, row.P), Vec3::Zero(), row.tip);
    EXPECT_LE((shot - row.tip).norm(), 2e-9) << row.name;  // the digits printed, and of shooting
    const Convergence found = convergence(four_meshes(4), [&](Index n) {
      return (bend_tip(quarter_bend(n, row.torsion, row.shear), row.P, 1) - row.tip).norm();
    });
    found.print(row.name);
    EXPECT_NEAR(found.observed_order(), 4.0, order_tolerance) << row.name;
    EXPECT_LT(found.error.back(), 5e-6) << row.name;  // of 78 mm
  }
}

TEST(BeamBend45, OrderOfConvergenceWithoutShear) {
  const double rigid = std::numeric_limits<double>::infinity();
  const ReissnerRod rod{25.0 * pi, Vec3(1e-7, 0, 0), Vec3(1.0 / bend_torsion, 12e-7, 12e-7),
                        Vec3(0, 0, 0.01)};
  const Vec3 shot = rod.tip(Vec3(0, 0, 600), Vec3::Zero(), Vec3(46.9, 15.6, 53.6));
  const Convergence found = convergence(four_meshes(4), [&](Index n) {
    return (bend_tip(quarter_bend(n, bend_torsion, rigid), 600.0, 1) - shot).norm();
  });
  found.print("45 degree bend, P 600, no shear");
  EXPECT_NEAR(found.observed_order(), 4.0, order_tolerance);
}

// A straight rod under a force across and a torque, both dead: what shear adds to the displacement
// of the tip, in elements far longer than the length of shear (12 EI/GA)^1/2. Sections lean under
// the torque of a bent element as much as under the force: without the former a part is missing
// that no such mesh makes smaller.
TEST(BeamShear, TorqueInABentRodCausesShear) {
  const double length = 10.0, stiffness = 100.0, shear = 1e7;  // length of shear: 0.011
  const Vec3 force(0, 3.0, 0), torque(30.0, 0, 0);
  const auto tip = [&](Index elements, double section_shear) {
    BeamSection section = round_section(stiffness, 1e7, stiffness);
    section.shear = section_shear;
    const Beam beam = straight_beam(length, elements, section);
    BeamState state = beam.rest();
    EXPECT_TRUE(solve_statics(beam, cantilever(beam, force, torque), state).converged);
    return tip_of(state);
  };
  const auto exact = [&](double compliance) {
    const double soft = 1.0 / stiffness;
    const ReissnerRod rod{length, Vec3(1e-7, compliance, compliance), Vec3(soft, soft, soft)};
    return rod.tip(force, torque, tip(16, 1.0 / compliance));
  };
  const Vec3 expected = exact(1.0 / shear) - exact(0.0);
  const Convergence found = convergence({4, 6, 9, 14}, [&](Index n) {
    const Vec3 added = tip(n, shear) - tip(n, std::numeric_limits<double>::infinity());
    return (added - expected).norm() / expected.norm();
  });
  found.print("shear of a rod bent and twisted");
  // shear force and curvature are constant in an element: order 2
  EXPECT_NEAR(found.observed_order(), 2.0, order_tolerance);
  EXPECT_LT(found.error.back(), 5e-3);
}

TEST(BeamBend45, TipDoesNotDependOnTheLoadSteps) {
  const Beam beam = quarter_bend(16, bend_torsion, bend_shear);
  for (const double P : {300.0, 600.0}) {
    const Vec3 one = bend_tip(beam, P, 1);
    // tolerance of the solve, 1e-11, times the length of 78.5
    for (const int steps : {8, 60}) EXPECT_LT((bend_tip(beam, P, steps) - one).norm(), 1e-8);
  }
}

// Soft against shear, 5 % of it: the strain is the sine of the angle, not the angle itself, or short
// elements would end at another tip.
TEST(BeamShear, LargeShearMeetsReissnersStrains) {
  BeamSection section = round_section(100.0, 1e7, 100.0);
  section.shear = 100.0;
  const Vec3 force(0, 5.0, 0);
  const auto tip = [&](Index elements) {
    const Beam beam = straight_beam(10.0, elements, section);
    BeamState state = beam.rest();
    EXPECT_TRUE(solve_statics(beam, cantilever(beam, force), state).converged);
    return tip_of(state);
  };
  const ReissnerRod rod{10.0, Vec3(1e-7, 0.01, 0.01), Vec3(0.01, 0.01, 0.01)};
  const Vec3 shot = rod.tip(force, Vec3::Zero(), tip(16));
  const Convergence found =
      convergence(four_meshes(16), [&](Index n) { return (tip(n) - shot).norm(); });
  found.print("straight, large shear");
  EXPECT_NEAR(found.observed_order(), 2.0, order_tolerance);
}

// Bending is taken in the axes of the mean section: where the two stiffnesses differ and the section
// twists, and with it the torque along the element, order 2.
TEST(BeamUnevenSection, OrderOfConvergence) {
  BeamSection section = round_section(100.0, 1e7, 80.0);
  section.bending_3 = 400.0;
  const Vec3 force(0, 1.0, 1.0);
  const auto tip = [&](Index elements) {
    const Beam beam = straight_beam(10.0, elements, section);
    BeamState state = beam.rest();
    EXPECT_TRUE(solve_statics(beam, cantilever(beam, force), state).converged);
    return tip_of(state);
  };
  // d2 and d3 are y and z: a force along y bends about d3, by the stiffness of the plane (d1, d2)
  const ReissnerRod rod{
      10.0, Vec3(1e-7, 0, 0),
      Vec3(1.0 / section.torsion, 1.0 / section.bending_3, 1.0 / section.bending_2)};
  const Vec3 shot = rod.tip(force, Vec3::Zero(), tip(32));
  const Convergence found =
      convergence(four_meshes(4), [&](Index n) { return (tip(n) - shot).norm(); });
  found.print("uneven section, bent both ways");
  EXPECT_NEAR(found.observed_order(), 2.0, order_tolerance);
  EXPECT_LT(found.error.back(), 1e-4 * 10.0);
}

// Two forces in turn, in either order, and together: one equilibrium. Then both are taken away again.
TEST(BeamPath, TipDoesNotDependOnTheOrderOfTheLoads) {
  const Beam beam = quarter_bend(16, bend_torsion, bend_shear);
  const Vec3 up(0, 0, 400), sideways(0, -300, 0), none = Vec3::Zero();
  const auto follow = [&](const std::vector<Vec3>& path) {
    BeamState state = beam.rest();
    Eigen::VectorXd from;
    for (const Vec3& force : path) {
      const BeamLoad load = cantilever(beam, force);
      EXPECT_TRUE(solve_statics(beam, load, state, {}, from).converged);
      from = load.force;
    }
    return state;
  };
  const Vec3 tip = tip_of(follow({up + sideways}));
  // tolerance of the solve, 1e-11, times the length of 78.5
  EXPECT_LE((tip_of(follow({up, up + sideways})) - tip).norm(), 1e-8);
  EXPECT_LE((tip_of(follow({sideways, up + sideways})) - tip).norm(), 1e-8);
  const BeamState back = follow({up, up + sideways, sideways, none});
  for (Index i = 0; i < beam.node_count(); ++i) {
    const auto k = std::size_t(i);
    EXPECT_LE((back.x.row(i) - beam.rest().x.row(i)).norm(), 1e-8) << i;
    EXPECT_LE((back.R[k] - beam.rest().R[k]).norm(), 1e-10) << i;
  }
}

// Straight along x, clamped; a moment fixed in space about z and a force along z, both on the tip:
// up to ten turns of helix.
TEST(BeamHelix, TipMeetsTheGeometricallyExactBeam) {
  constexpr double length = 10.0, EA = 1e4, EI = 1e2;  // GA = EA, GJ = EI
  BeamSection section = round_section(EI, EA, EI);
  section.shear = EA;
  const ReissnerRod rod{length, Vec3::Constant(1.0 / EA), Vec3::Constant(1.0 / EI)};
  const struct {
    double lambda;
    Vec3 tip;
  } rows[] = {{0.1, {0.41020335, 0.05377090, -1.09172902}},
              {0.5, {0.01910699, 0.00057398, -0.22663744}},
              {1.0, {0.00480325, 0.00007250, -0.07644174}}};
  // an element of the coarsest mesh turns by 8, 38, 75 degrees
  const std::vector<Index> meshes{48, 72, 108, 162};
  Convergence found[3];
  for (const Index elements : meshes) {
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
      found[k].elements.push_back(elements);
      found[k].error.push_back((tip_of(state) - row.tip).norm());
    }
  }
  for (int k = 0; k < 3; ++k) {
    const double lambda = rows[k].lambda;
    const Vec3 shot =
        rod.tip(Vec3(0, 0, lambda * 50.0), Vec3(0, 0, lambda * 200.0 * pi), rows[k].tip, 4000);
    EXPECT_LE((shot - rows[k].tip).norm(), 2e-8) << lambda;  // the digits printed
    found[k].print("helix, lambda " + std::to_string(lambda).substr(0, 3));
    // shear is constant in an element
    EXPECT_NEAR(found[k].observed_order(), 2.0, order_tolerance) << lambda;
    EXPECT_LT(found[k].error.back(), 1e-3);
  }
}

}  // namespace
}  // namespace brainshift::test
