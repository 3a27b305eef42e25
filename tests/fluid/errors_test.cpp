// What the fluid refuses, by code and by name of the culprit.
#include <gtest/gtest.h>

#include <cmath>

#include "brainshift/error.hpp"
#include "fluid/fluid_scenes.hpp"

namespace brainshift {
namespace {

template <class Call>
void expect_error(ErrorCode code, const std::string& word, Call&& call) {
  try {
    call();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& e) {
    EXPECT_EQ(to_string(e.code()), std::string(to_string(code))) << e.what();
    EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
  }
}

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

TEST(FluidErrors, DensityMustBePositiveAndFinite) {
  const test::BallInCavity s;
  for (double density : {0.0, -1.0, not_a_number}) {
    expect_error(ErrorCode::invalid_argument, "density",
                 [&] { Csf(density, FluidModel::separate, {s.csf.compartment(0)}); });
  }
}

TEST(FluidErrors, AtLeastOneCompartment) {
  expect_error(ErrorCode::empty, "compartment",
               [] { Csf(test::fluid_density, FluidModel::separate, {}); });
}

TEST(FluidErrors, TwoCompartmentsOfOneName) {
  const test::BallInCavity s;
  expect_error(ErrorCode::invalid_argument, "'all'", [&] {
    Csf(test::fluid_density, FluidModel::separate, {s.csf.compartment(0), s.csf.compartment(0)});
  });
}

TEST(FluidErrors, AnOpenWall) {
  const test::BallInCavity s;
  Compartment c = s.csf.compartment(0);
  c.wall_triangles = Triangles(c.wall_triangles.topRows(c.wall_triangles.rows() - 1));
  expect_error(ErrorCode::surface_not_closed, "'all'",
               [&] { Csf(test::fluid_density, FluidModel::separate, {c}); });
}

TEST(FluidErrors, AWallTurnedInsideOut) {
  const test::BallInCavity s;
  Compartment c = s.csf.compartment(0);
  c.wall_triangles.col(1).swap(c.wall_triangles.col(2));
  EXPECT_THROW(
      Hydrostatics(s.mesh, Csf(test::fluid_density, FluidModel::separate, {c}), test::gravity_down),
      Error);
}

TEST(FluidErrors, AnOpenBody) {
  const test::BallInCavity s;
  Compartment c = s.csf.compartment(0);
  c.body_faces.pop_back();
  const Csf csf(test::fluid_density, FluidModel::separate, {c});
  expect_error(ErrorCode::surface_not_closed, "'all'",
               [&] { Hydrostatics(s.mesh, csf, test::gravity_down); });
}

TEST(FluidErrors, AFaceThatIsNotThere) {
  const test::BallInCavity s;
  for (int which : {0, 1}) {
    Compartment c = s.csf.compartment(0);
    (which ? c.wetted_faces : c.body_faces).push_back(Index(s.mesh.surface().rows()));
    const Csf csf(test::fluid_density, FluidModel::separate, {c});
    expect_error(ErrorCode::index_out_of_range, "'all'",
                 [&] { Hydrostatics(s.mesh, csf, test::gravity_down); });
  }
}

TEST(FluidErrors, AReferenceHeadBelowTheTopOfTheCavity) {
  const test::BallInCavity s;
  const Csf csf(test::fluid_density, FluidModel::separate, {s.csf.compartment(0)}, 39.0);
  expect_error(ErrorCode::invalid_argument, "reference head",
               [&] { Hydrostatics(s.mesh, csf, test::gravity_down); });
}

TEST(FluidErrors, TissueLargerThanItsCavity) {
  const test::BallInCavity s(30.0, 4, 25.0);
  expect_error(ErrorCode::fluid_volume, "'all'",
               [&] { Hydrostatics(s.mesh, s.csf, test::gravity_down); });
}

TEST(FluidErrors, NoGravity) {
  const test::BallInCavity s;
  EXPECT_THROW(Hydrostatics(s.mesh, s.csf, Vec3::Zero()), Error);
  EXPECT_THROW(Hydrostatics(s.mesh, s.csf, Vec3(0, 0, not_a_number)), Error);
}

TEST(FluidErrors, AmountsThatCannotBe) {
  test::BallInCavity s;
  expect_error(ErrorCode::fluid_volume, "'all'", [&] { s.csf.set_air_volume(0, -1.0); });
  expect_error(ErrorCode::fluid_volume, "'all'", [&] { s.csf.set_air_volume(0, -1.0); });
  expect_error(ErrorCode::not_finite, "'all'", [&] { s.csf.set_level(0, not_a_number); });
  expect_error(ErrorCode::not_finite, "'all'", [&] { s.csf.set_lost_volume(0, not_a_number); });
  expect_error(ErrorCode::index_out_of_range, "7", [&] { s.csf.set_full(7); });
  expect_error(ErrorCode::index_out_of_range, "-1", [&] { s.csf.set_full(-1); });
  expect_error(ErrorCode::index_out_of_range, "1 of 1", [&] { s.csf.is_open(1); });
  expect_error(ErrorCode::index_out_of_range, "-2 of 1", [&] { s.csf.compartment(-2); });
  EXPECT_EQ(s.csf.law(0), FluidLaw::full);  // nothing was taken up
}

TEST(FluidErrors, MoreFluidThanThereIsLeavesTheLoadAsItWas) {
  test::BallInCavity s;
  Hydrostatics fluid(s.mesh, s.csf, test::gravity_down);
  for (bool air : {false, true}) {
    if (air) {
      s.csf.set_air_volume(0, 1e9);
    } else {
      s.csf.set_lost_volume(0, 1e9);
    }
    expect_error(ErrorCode::fluid_volume, "'all'",
                 [&] { fluid.configure(s.csf, test::gravity_down); });
    EXPECT_EQ(fluid.heads(s.mesh.nodes())[0], fluid.full_head());
  }
}

TEST(FluidErrors, MoreCommunicatingFluidThanTheOpenSideHolds) {
  const Mesh mesh = test::make_mesh(test::make_box({10, 10, 10}, 1, 1, 1));
  Csf csf(test::fluid_density, FluidModel::communicating,
          {test::make_compartment("closed", test::box_wall({-5, -5, -5}, {15, 15, 15}),
                                  test::all_faces(mesh)),
           test::make_compartment("open", test::box_wall({15, -5, -5}, {35, 15, 15}), {})});
  Hydrostatics fluid(mesh, csf, test::gravity_down);
  csf.set_lost_volume(1, 7999.0);  // of 8000 mm^3; the closed side keeps its 7000
  fluid.configure(csf, test::gravity_down);
  csf.set_lost_volume(1, 8001.0);
  expect_error(ErrorCode::fluid_volume, "'open'",
               [&] { fluid.configure(csf, test::gravity_down); });
  csf.open(0);
  fluid.configure(csf, test::gravity_down);
  csf.set_lost_volume(1, 15001.0);
  expect_error(ErrorCode::fluid_volume, "'closed' and 'open'",
               [&] { fluid.configure(csf, test::gravity_down); });
}

TEST(FluidErrors, ALevelAboveTheFullOne) {
  test::BallInCavity s;
  Hydrostatics fluid(s.mesh, s.csf, test::gravity_down);
  s.csf.set_level(0, 41.0);
  expect_error(ErrorCode::invalid_argument, "'all'",
               [&] { fluid.configure(s.csf, test::gravity_down); });
}

TEST(FluidErrors, AnUnknownName) {
  const test::BallInCavity s;
  EXPECT_EQ(s.csf.find("all"), 0);
  expect_error(ErrorCode::invalid_argument, "'nowhere'", [&] { s.csf.find("nowhere"); });
}

TEST(FluidErrors, AFaceWettedTwice) {
  const test::BallInCavity s;
  Compartment c = s.csf.compartment(0), other = c;
  other.name = "other";
  expect_error(ErrorCode::invalid_argument, "wetted twice", [&] {
    Hydrostatics(s.mesh, Csf(test::fluid_density, FluidModel::separate, {c, other}),
                 test::gravity_down);
  });
  c.wetted_faces.push_back(c.wetted_faces.front());
  expect_error(ErrorCode::invalid_argument, "wetted twice", [&] {
    Hydrostatics(s.mesh, Csf(test::fluid_density, FluidModel::separate, {c}), test::gravity_down);
  });
}

}  // namespace
}  // namespace brainshift
