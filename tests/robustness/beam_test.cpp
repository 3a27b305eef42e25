// Devices bent round, twisted, degenerate, or put where they cannot be.
#include <Eigen/Geometry>

#include "beam/rotation.hpp"
#include "robustness/outcome.hpp"
#include "support/beams.hpp"
#include "support/leaning_block.hpp"

namespace brainshift::test {
namespace {

constexpr double L = 100.0, EI = 5000.0;

TEST(BeamLimits, B1_elastica_at_ten_times_the_bending_stiffness) {
  const Beam beam = straight_beam(L, 20, round_section(EI, 1e9));
  BeamState state = beam.rest();
  const double force = 10.0 * EI / (L * L);
  ASSERT_TRUE(solve_statics(beam, cantilever(beam, {0, force, 0}), state).converged);
  EXPECT_NEAR(tip_of(state).y() / L, 0.81061, 1e-3);
  EXPECT_NEAR(1.0 - tip_of(state).x() / L, 0.55500, 1e-3);
}

TEST(BeamLimits, B2_rolled_up_into_a_circle_and_into_two) {
  for (const int turns : {1, 2}) {
    const Beam beam = straight_beam(L, 40, round_section(EI, 1e9));
    BeamState state = beam.rest();
    const double moment = turns * 2.0 * pi * EI / L;
    BeamStaticsOptions options;
    options.load_steps = 8;
    const auto load = cantilever(beam, Vec3::Zero(), {0, 0, moment});
    ASSERT_TRUE(solve_statics(beam, load, state, options).converged) << turns;
    EXPECT_LE(tip_of(state).norm(), 1e-3 * L) << turns;
  }
}

TEST(BeamLimits, B3_spins_of_half_and_whole_turns) {
  const Beam beam = straight_beam(L, 4, round_section(EI));
  for (const double angle : {0.0, 1e-300, 1e-9, pi, 2.0 * pi, 3.0 * pi, 1e6}) {
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 1)}) {
      BeamState state = beam.rest();
      Eigen::VectorXd step = Eigen::VectorXd::Zero(beam.dof_count());
      for (Index i = 0; i < beam.node_count(); ++i) step.segment<3>(6 * i + 3) = angle * axis;
      beam.update(state, step);
      for (const Mat3& R : state.R) {
        ASSERT_TRUE(R.allFinite()) << angle;
        EXPECT_LE((R.transpose() * R - Mat3::Identity()).norm(), 1e-9) << angle;
      }
      Eigen::VectorXd gradient;
      BlockTridiagonal K;
      EXPECT_FALSE(std::isnan(beam.tangent(state, gradient, K))) << angle;
      EXPECT_FALSE(gradient.array().isNaN().any()) << angle;
    }
  }
}

TEST(BeamLimits, B4_devices_without_length) {
  const BeamSection section = round_section(EI);
  Points one(1, 3), same(3, 3);
  one << 0, 0, 0;
  same << 0, 0, 0, 1, 0, 0, 1, 0, 0;
  EXPECT_THROW(BeamDevice("d", Points(0, 3), {section}), Error);
  EXPECT_THROW(BeamDevice("d", one, {section}), Error);
  expect_error(ErrorCode::degenerate_element, {"1"}, [&] { BeamDevice("d", same, {section}); });
  EXPECT_THROW(BeamDevice::straight("d", 0.0, 4, section), Error);
  EXPECT_THROW(BeamDevice::straight("d", -5.0, 4, section), Error);
  EXPECT_THROW(BeamDevice::straight("d", 5.0, 0, section), Error);
  EXPECT_THROW(BeamDevice::straight("d", std::nan(""), 4, section), Error);
}

TEST(BeamLimits, B5_no_stiffness_is_refused_and_steel_balances_tissue) {
  for (double BeamSection::*const quantity :
       {&BeamSection::axial, &BeamSection::bending_2, &BeamSection::bending_3,
        &BeamSection::torsion, &BeamSection::radius}) {
    for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
      BeamSection section = round_section(EI);
      section.*quantity = bad;
      EXPECT_THROW(BeamDevice::straight("d", L, 4, section), Error) << bad;
    }
  }
  // A steel rod, E = 2e8 kPa beside 6 kPa.
  const BeamDevice steel =
      BeamDevice::straight("steel", device_length, 28, tube_section(1.2, 0.0, 2e8, 0.3));
  Stepper stepper(leaning_block(0.0));
  const DeviceId id = stepper.insert(steel, {lead_tip, lead_outward}, wire_only());
  stepper.set_gravity(leaning(0.02));
  expect_converged(stepper.solve_static());
  const DeviceState d = stepper.device(id);
  const Vec3 on_tissue = d.path_forces.colwise().sum().transpose();
  ASSERT_GT(on_tissue.norm(), 0.1);
  EXPECT_LE((on_tissue - d.anchor_force).norm(), 1e-8 * 1000.0);  // of the block's weight, mN
}

// L/r = 300: stretching is 1e6 times as stiff as bending, and locks nothing.
TEST(BeamLimits, B6_a_hair_bends_as_beam_theory_says) {
  const double radius = L / 300.0, young = 1e6;
  const BeamSection section = tube_section(2.0 * radius, 0.0, young, 0.3);
  for (const Index elements : {1, 10, 40}) {
    const Beam beam = straight_beam(L, elements, section);
    BeamState state = beam.rest();
    const double force = 1e-3 * 3.0 * section.bending_2 / (L * L);  // deflection L/1000
    ASSERT_TRUE(solve_statics(beam, cantilever(beam, {0, force, 0}), state).converged);
    EXPECT_NEAR(tip_of(state).y(), 1e-3 * L, 1e-5 * 1e-3 * L * 10.0) << elements;
  }
}

TEST(BeamLimits, B7_ten_turns_of_twist_are_counted) {
  const Index last = 40;
  const BeamSection section = round_section(EI, 1e6, EI);
  const Beam beam = straight_beam(L, last, section);
  BeamState state = beam.rest();
  const double angle = 20.0 * pi;
  Eigen::VectorXd step = Eigen::VectorXd::Zero(beam.dof_count());
  for (Index i = 0; i <= last; ++i) step[6 * i + 3] = angle * i / last;
  beam.update(state, step);
  const double energy = 0.5 * EI / L * angle * angle;
  EXPECT_NEAR(beam.energy(state), energy, 1e-9 * energy);
  beam.update(state, -step);
  EXPECT_NEAR(beam.energy(state), 0.0, 1e-9 * energy);
  step.setZero();
  step[6 * last + 3] = angle;  // all of it in one element, in one step
  beam.update(state, step);
  EXPECT_NEAR(beam.energy(state), last * energy, 1e-9 * last * energy);
}

TEST(BeamLimits, B8_no_axis_is_special_for_the_frames) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Points nodes = Points::Zero(5, 3);
      for (int i = 0; i < 5; ++i) nodes(i, axis) = sign * 10.0 * i;
      const BeamDevice device("d", nodes, {round_section(EI)});
      for (const Mat3& R : device.frames()) {
        ASSERT_TRUE(R.allFinite());
        EXPECT_LE((R.transpose() * R - Mat3::Identity()).norm(), 1e-12);
        EXPECT_NEAR(R(axis, 0), sign, 1e-12);
      }
      Stepper stepper(block_on_base(leaning(0.02)));
      const Vec3 tip = Vec3(20.3, 20.7, 30.1), outward = sign * Vec3::Unit(axis);
      const DeviceId id = stepper.insert(make_device("3389", 45.0), {tip, outward}, {0.0, 40.0});
      expect_converged(stepper.solve_static());
      EXPECT_TRUE(stepper.device(id).nodes.allFinite());
    }
  }
}

TEST(BeamLimits, B9_a_cannula_that_carries_much_is_taken_away_at_once) {
  Stepper stepper(leaning_block(0.0)), without(leaning_block(0.3));
  const DeviceId id =
      stepper.insert(make_device("cannula", device_length), {lead_tip, lead_outward}, whole());
  stepper.set_gravity(leaning(0.3));
  expect_converged(stepper.solve_static());
  EXPECT_GT(stepper.device(id).anchor_force.norm(), 100.0);  // mN
  stepper.remove(id);
  expect_converged(stepper.solve_static());
  expect_converged(without.solve_static());
  EXPECT_LE(largest_distance(stepper.displacement(), without.displacement()), 1e-6);
}

// Tissue that moves past the tip is let go and taken up again; its arc is NaN meanwhile.
TEST(BeamLimits, B10_tissue_leaves_the_tip_and_comes_back) {
  Stepper stepper(leaning_block(0.0));
  const Vec3 down(0, 0, -1);
  TrackOptions track;
  track.least_spacing = 0.01;
  const DeviceId id = stepper.insert(make_device("cannula", device_length),
                                     {Vec3(20.3, 20.7, 30.1), -down}, whole(), track);
  const auto beyond = [&] {
    const Eigen::VectorXd arcs = stepper.device(id).path_arcs;
    return arcs.array().isNaN().count();
  };
  stepper.set_gravity(0.5 * standard_gravity * down);
  expect_converged(stepper.solve_static());
  EXPECT_GE(beyond(), 1);
  EXPECT_TRUE(stepper.device(id).path_forces.allFinite());
  stepper.set_gravity(Vec3::Zero());
  expect_converged(stepper.solve_static());
  EXPECT_EQ(beyond(), 0);
  EXPECT_LE(largest(stepper.displacement()), 1e-8);
}

// Exactly through nodes, along edges, within faces of the mesh.
TEST(BeamLimits, B11_a_line_through_nodes_edges_and_faces) {
  for (const Vec3& tip : {Vec3(20, 20, 20), Vec3(20, 20, 25), Vec3(20, 25, 20), Vec3(25, 25, 20)}) {
    for (const Vec3& outward : {Vec3(0, 0, 1), Vec3(1, 1, 1), Vec3(0, 1, 1), Vec3(1, 0, 0)}) {
      Points u[2];
      for (Points& result : u) {
        Stepper stepper(block_on_base(leaning(0.01)));
        const DeviceId id = stepper.insert(make_device("3389", 60.0), {tip, outward.normalized()},
                                           {std::numeric_limits<double>::infinity(), 55.0});
        const SolveReport report = stepper.solve_static();
        expect_converged(report);
        EXPECT_GE(stepper.device(id).path.rows(), 2);
        EXPECT_LE(report.tie_gap, 1e-8);
        result = stepper.displacement();
      }
      EXPECT_TRUE(same_bits(u[0], u[1]));
    }
  }
}

// No iterative solver: tissue and device never share a matrix, and no ratio stalls anything.
TEST(BeamLimits, B12_iterations_do_not_grow_with_the_ratio) {
  int most = 0;
  for (const double bending : {1e2, 1e6, 1e10}) {
    Stepper stepper(leaning_block(0.0));
    stepper.insert(lead(bending), {lead_tip, lead_outward}, wire_only());
    stepper.set_gravity(leaning(0.02));
    const SolveReport report = stepper.solve_static();
    expect_converged(report);
    most = std::max(most, report.iterations);
  }
  EXPECT_LE(most, 20);
}

}  // namespace
}  // namespace brainshift::test
