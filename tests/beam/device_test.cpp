// What a device is made of, and the table of devices.
#include <gtest/gtest.h>

#include "beam/rigid_device.hpp"
#include "support/beams.hpp"
#include "support/expect_error.hpp"

namespace brainshift::test {
namespace {

const BeamSection good = round_section(5.0);

Points line(std::initializer_list<double> x) {
  Points nodes = Points::Zero(Eigen::Index(x.size()), 3);
  Eigen::Index i = 0;
  for (const double value : x) nodes(i++, 0) = value;
  return nodes;
}

TEST(BeamDevice, SteelCannulaByItsDiameters) {
  const BeamSection section = make_device("cannula", 200.0).section(0);
  // EI of 1.8/1.4 mm steel: 65 000 N mm^2 to two digits, the number commonly quoted
  EXPECT_NEAR(section.bending_2, 6.5e7, 0.05e7);
  EXPECT_NEAR(section.axial, 2e8 * pi / 4.0 * (1.8 * 1.8 - 1.4 * 1.4), 1.0);
  EXPECT_EQ(section.radius, 0.9);
  EXPECT_EQ(section.line_density, 0.0);
}

TEST(BeamDevice, LeadsHaveTheirContacts) {
  const struct {
    const char* name;
    std::size_t count;
    double tip, pitch;
  } rows[] = {{"3389", 4, 1.5, 2.0}, {"3387", 4, 1.5, 3.0}, {"vercise", 8, 1.1, 2.0}};
  for (const auto& row : rows) {
    const BeamDevice lead = make_device(row.name, 100.0);
    ASSERT_EQ(lead.contacts().size(), row.count);
    for (std::size_t k = 0; k < row.count; ++k) {
      EXPECT_NEAR(lead.contacts()[k].centre(), row.tip + 0.75 + double(k) * row.pitch, 1e-12);
    }
    const DeviceData& data = device_data(row.name);
    EXPECT_LE(data.bending_lowest, data.bending);
    EXPECT_GE(data.bending_highest, data.bending);
    EXPECT_EQ(lead.section(3).bending_2, data.bending);
  }
  DeviceOptions options;
  options.bending = 2e4;
  options.element_size = 3.0;
  const BeamDevice stiff = make_device("3389", 100.0, options);
  EXPECT_NEAR(stiff.section(0).bending_3, 2e4, 1e-8);
  EXPECT_EQ(stiff.element_count(), 34);
  EXPECT_EQ(stiff.length(), 100.0);
}

TEST(BeamDevice, SectionsByArcLength) {
  BeamSection soft = good, hard = good;
  soft.radius = 0.3, hard.radius = 0.7;
  const auto device = BeamDevice::straight("d", 10.0, 5, {{0.0, 4.0, soft}, {4.0, 10.0, hard}});
  EXPECT_EQ(device.radius_at(3.9), 0.3);
  EXPECT_EQ(device.radius_at(4.1), 0.7);
  EXPECT_EQ(device.radius_at(-5.0), 0.3);
  EXPECT_EQ(device.radius_at(50.0), 0.7);
  EXPECT_EQ(device.element_at(4.0), 1);
  expect_error(ErrorCode::invalid_argument, {"no section", "5"}, [&] {
    BeamDevice::straight("d", 10.0, 5, {{0.0, 4.0, soft}, {6.0, 10.0, hard}});
  });
}

// B4, B5, and the rest of what cannot be a beam.
TEST(BeamDevice, RefusesWhatIsNoDevice) {
  using E = ErrorCode;
  const auto make = [](Points nodes, BeamSection section) {
    return [=] { BeamDevice("lead", nodes, {section}); };
  };
  expect_error(E::empty, {"lead", "2 nodes"}, make(line({0.0}), good));
  expect_error(E::degenerate_element, {"lead", "nodes 1 and 2"}, make(line({0, 1, 1, 2}), good));
  expect_error(E::not_finite, {"lead", "node 1"}, make(line({0, NAN}), good));
  for (double BeamSection::*member :
       {&BeamSection::axial, &BeamSection::bending_2, &BeamSection::bending_3,
        &BeamSection::torsion, &BeamSection::radius, &BeamSection::shear}) {
    for (const double bad : {0.0, -1.0}) {
      BeamSection section = good;
      section.*member = bad;
      expect_error(E::invalid_argument, {"lead", "element 0"}, make(line({0, 1, 2}), section));
    }
    BeamSection section = good;
    section.*member = NAN;
    expect_error(E::not_finite, {"lead", "element 0"}, make(line({0, 1, 2}), section));
  }
  expect_error(E::size_mismatch, {"3 sections", "2 elements"}, [] {
    BeamDevice("lead", line({0, 1, 2}), {good, good, good});
  });
  expect_error(E::invalid_argument, {"contact 1"}, [] {
    BeamDevice("lead", line({0, 9}), {good}, {{1, 2}, {1.5, 3}});
  });
  expect_error(E::invalid_argument, {"contact 0"}, [] {
    BeamDevice("lead", line({0, 9}), {good}, {{8, 10}});
  });
  expect_error(E::invalid_argument, {"frame 1", "rotation"}, [] {
    BeamDevice("lead", line({0, 9}), {good}, {}, {Mat3::Identity(), 2.0 * Mat3::Identity()});
  });
  expect_error(E::invalid_argument, {"right angle"}, [] {
    const Mat3 back = rotation_exp(Vec3(0, 0, 3.0));
    BeamDevice("lead", line({0, 9}), {good}, {}, {back, back});
  });
  expect_error(E::invalid_argument, {"3388", "3389", "3387", "vercise", "cannula"},
               [] { make_device("3388", 100.0); });
  expect_error(E::invalid_argument, {"length"}, [] { make_device("3389", 0.0); });
  expect_error(E::invalid_argument, {"contact"}, [] { make_device("3389", 5.0); });
  expect_error(E::invalid_argument, {"element_size"}, [] { make_device("3389", 100.0, {1e-9}); });
  expect_error(E::invalid_argument, {"bending"}, [] { make_device("3389", 100.0, {2.0, -1.0}); });
  expect_error(E::invalid_argument, {"outer"}, [] { tube_section(1.0, 1.0, 1.0, 0.3); });
}

// B8: no direction is special for the frame of a straight device.
TEST(BeamDevice, FramesAlongTheAxes) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Points nodes(3, 3);
      for (int i = 0; i < 3; ++i) nodes.row(i) = sign * i * Vec3::Unit(axis).transpose();
      const BeamDevice device("lead", nodes, {good});
      for (const Mat3& R : device.frames()) {
        EXPECT_TRUE(R.isUnitary(1e-15));
        EXPECT_NEAR(R.determinant(), 1.0, 1e-15);
        EXPECT_LE((R.col(0) - sign * Vec3::Unit(axis)).norm(), 1e-15);
      }
      EXPECT_TRUE(any_frame(sign * Vec3::Unit(axis)).isUnitary(1e-15));
    }
  }
}

// An arc through three nodes and more: exact tangents, and arc length to the order of the chord.
TEST(BeamDevice, CurvedRestShapeIsFreeOfLoad) {
  const Index elements = 12;
  Points nodes(elements + 1, 3);
  for (Index i = 0; i <= elements; ++i) {
    const double angle = 0.1 * i;
    nodes.row(i) << 0.0, 20.0 * std::sin(angle), 20.0 * (1.0 - std::cos(angle));
  }
  const BeamDevice device("arc", nodes, {good});
  for (Index i = 0; i <= elements; ++i) {
    const Vec3 tangent(0.0, std::cos(0.1 * i), std::sin(0.1 * i));
    EXPECT_LE((device.frames()[std::size_t(i)].col(0) - tangent).norm(), 1e-13);
  }
  EXPECT_NEAR(device.length(), 24.0, 24.0 * std::pow(0.05, 4) / 100.0);
  const Beam beam(device, Vec3(1, 2, 3), rotation_exp(Vec3(1, 1, 1)));
  Eigen::VectorXd gradient;
  BlockTridiagonal K;
  EXPECT_LE(beam.tangent(beam.rest(), gradient, K), 1e-20 * good.axial);
  EXPECT_LE(gradient.cwiseAbs().maxCoeff(), 1e-12 * good.axial);
}

TEST(RigidDevice, PoseAndPoints) {
  RigidDevice cannula(Vec3(1, 2, 3), Vec3(0, 0, 2), 200.0, 0.9);
  EXPECT_TRUE(cannula.point(10.0).isApprox(Vec3(1, 2, 13)));
  EXPECT_NEAR(cannula.arc_of(Vec3(5, 5, 8)), 5.0, 1e-14);
  EXPECT_TRUE(cannula.frame().isUnitary(1e-15));
  Eigen::Matrix<double, 6, 1> step;
  step << 1e-6, -2e-6, 3e-6, 2e-6, 1e-6, -1e-6;
  RigidDevice ahead = cannula, behind = cannula;
  ahead.update(step);
  behind.update(-step);
  const Vec3 difference = 0.5 * (ahead.point(50.0) - behind.point(50.0));
  EXPECT_LE((difference - cannula.point_derivative(50.0) * step).norm(), 1e-14 * 50.0);
  expect_error(ErrorCode::invalid_argument, {"direction"},
               [] { RigidDevice(Vec3::Zero(), Vec3::Zero(), 1.0, 1.0); });
  expect_error(ErrorCode::invalid_argument, {"radius"},
               [] { RigidDevice(Vec3::Zero(), Vec3::UnitX(), 1.0, 0.0); });
}

}  // namespace
}  // namespace brainshift::test
