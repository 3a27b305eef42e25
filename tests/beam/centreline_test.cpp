// The curve between the nodes: derivatives, closest point, bow.
#include <gtest/gtest.h>

#include "support/beams.hpp"

namespace brainshift::test {
namespace {

// Arc of a given bow over a chord along x, bending towards +y, as nodal positions and frames.
BeamState arc(const Beam& beam, double radius) {
  BeamState state = beam.rest();
  for (Index i = 0; i < beam.node_count(); ++i) {
    const double angle = (beam.device().arcs()[i] - 0.5 * beam.device().length()) / radius;
    state.x.row(i) << radius * std::sin(angle), radius * std::cos(angle), 0.0;
    state.R[std::size_t(i)] = rotation_exp(Vec3(0, 0, -angle));
  }
  return state;
}

TEST(Centreline, DerivativesByCentralDifferences) {
  const Beam beam = straight_beam(6.0, 3, round_section(5.0));
  const BeamState state = shaken(beam, 0.2, 0.4, 2);
  const double h = 1e-6;
  for (const double xi : {0.0, 0.3, 1.0}) {
    const BeamPoint place{1, xi};
    const Mat3x12 dx = position_derivative(beam, state, place);
    const Mat3x12 dt = unit_tangent_derivative(beam, state, place);
    for (int k = 0; k < 12; ++k) {
      Eigen::VectorXd step = Eigen::VectorXd::Zero(beam.dof_count());
      step[6 + k] = h;
      BeamState ahead = state, behind = state;
      beam.update(ahead, step);
      beam.update(behind, -step);
      const Vec3 position_change =
          (position(beam, ahead, place) - position(beam, behind, place)) / (2.0 * h);
      const Vec3 tangent_change =
          (unit_tangent(beam, ahead, place) - unit_tangent(beam, behind, place)) / (2.0 * h);
      // truncation h^2, rounding 1e-16/h, of entries of order 1
      EXPECT_LE((dx.col(k) - position_change).norm(), 1e-8);
      EXPECT_LE((dt.col(k) - tangent_change).norm(), 1e-8);
    }
  }
}

TEST(Centreline, ArcLengthAndPlace) {
  const Beam beam = straight_beam(9.0, 4, round_section(5.0));
  for (const double s : {0.0, 1.0, 2.25, 5.0, 9.0}) {
    const BeamPoint place = place_at(beam, s);
    EXPECT_NEAR(arc_of(beam, place), s, 1e-14);
    EXPECT_LE((position(beam, beam.rest(), place) - Vec3(s, 0, 0)).norm(), 1e-14);
  }
  EXPECT_EQ(place_at(beam, -1.0).xi, 0.0);
  EXPECT_EQ(place_at(beam, 99.0).element, 3);
  EXPECT_NEAR(curve_length(beam, beam.rest(), 1.0, 7.5), 6.5, 1e-13);
}

TEST(Centreline, ArcOfACircle) {
  // elements of 0.1 rad: the cubic is off by angle^4/1000 of the radius
  const Beam beam = straight_beam(20.0, 10, round_section(5.0));
  const BeamState state = arc(beam, 20.0);
  EXPECT_NEAR(curve_length(beam, state, 0.0, 20.0), 20.0, 1e-5);
  const Bow found = bow(beam, state, 0.0, 20.0);
  EXPECT_NEAR(found.size, 20.0 * (1.0 - std::cos(0.5)), 1e-5);
  EXPECT_NEAR(found.arc, 10.0, 1e-3);  // flat there: the square root of the accuracy of the size
  EXPECT_LE((found.direction - Vec3::UnitY()).norm(), 1e-6);
  const Bow part = bow(beam, state, 4.0, 10.0);
  EXPECT_NEAR(part.size, 20.0 * (1.0 - std::cos(0.15)), 1e-5);
  const Bow none = bow(beam, beam.rest(), 0.0, 20.0);
  EXPECT_LE(none.size, 1e-14);
}

TEST(Centreline, ClosestPointOfACircle) {
  const Beam beam = straight_beam(20.0, 10, round_section(5.0));
  const BeamState state = arc(beam, 20.0);
  for (const double angle : {-0.45, -0.2, 0.0, 0.013, 0.3}) {
    for (const double radius : {5.0, 19.0, 20.0, 26.0}) {
      const Vec3 outwards(std::sin(angle), std::cos(angle), 0.0);
      const auto found = closest_point(beam, state, radius * outwards + Vec3(0, 0, 1.5));
      // at radius 5 the foot moves by 4 times the error of the normal, angle^3/100 per element
      EXPECT_LE((found.position - 20.0 * outwards).norm(), 1e-3) << angle << " " << radius;
      EXPECT_NEAR(found.distance, std::hypot(radius - 20.0, 1.5), 1e-5);
      EXPECT_EQ(found.beyond, CurveEnd::none);
    }
  }
}

// B10: points beyond the ends give the end, and say so.
TEST(Centreline, ClosestPointIsClampedToTheEnds) {
  const Beam beam = straight_beam(9.0, 4, round_section(5.0));
  const auto ask = [&](double x) { return closest_point(beam, beam.rest(), Vec3(x, 1, 0)); };
  EXPECT_EQ(ask(-2.0).beyond, CurveEnd::tip);
  EXPECT_EQ(ask(-2.0).place.element, 0);
  EXPECT_EQ(ask(-2.0).place.xi, 0.0);
  EXPECT_EQ(ask(11.0).beyond, CurveEnd::wire);
  EXPECT_EQ(ask(11.0).place.element, 3);
  EXPECT_EQ(ask(11.0).place.xi, 1.0);
  for (const double x : {0.0, 2.25, 4.4, 9.0}) {
    EXPECT_EQ(ask(x).beyond, CurveEnd::none) << x;
    EXPECT_NEAR(arc_of(beam, ask(x).place), x, 1e-9);
    EXPECT_NEAR(ask(x).distance, 1.0, 1e-14);
  }
}

}  // namespace
}  // namespace brainshift::test
