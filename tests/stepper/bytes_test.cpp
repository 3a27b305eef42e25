// Snapshots and recordings as bytes: the same bits come back, and what is damaged does not.
#include <gtest/gtest.h>

#include "brainshift/error.hpp"
#include "stepper/bytes.hpp"
#include "stepper/scene_bytes.hpp"
#include "support/elements.hpp"
#include "support/expect_error.hpp"
#include "support/scenes.hpp"

namespace brainshift {
namespace {

using test::expect_error;
using test::same_bits;

// A scene with something of everything that is kept, in the middle of a step in time.
Scene everything() {
  Scene scene = test::busy_scene(3, 0.3);
  const Index first = scene.constraints.fix("gone", {0});
  scene.constraints.remove(first);
  const auto floor = test::moved(test::make_box_surface({60, 60, 20}), {-15, -15, -25});
  Triangles top(2, 3);
  top << 4, 5, 7, 4, 7, 6;
  const Surface sheet = Surface::sheet(floor.points, top);
  scene.constraints.obstacle("floor", {0, 1}, sheet, 1.0);
  scene.constraints.obstacle("off", {2, 3}, sheet, -1.0);
  scene.constraints.disable(scene.constraints.groups().back().id);
  scene.constraints.fix("line", {5}, {true, false, false});
  return scene;
}

Stepper busy_stepper() {
  StepperOptions options;
  options.residual_tolerance = 1e-9;
  Stepper s(everything(), options);
  s.csf().set_lost_volume(0, 2000.0);
  EXPECT_TRUE(s.solve_static().converged());
  TrackOptions track;
  track.shear_bound = 0.05;
  track.local_give = true;
  Hold hold;
  hold.anchor = 25.0;
  hold.slack = 1.0;
  s.insert(make_device("cannula", 20.0), {{9.0, 11.0, 12.0}, {0.0, 0.0, 1.0}}, {0.0});
  const DeviceId lead =
      s.insert(make_device("3389", 25.0), {{15.0, 15.0, 8.0}, {0.0, 0.0, 1.0}}, hold, track);
  s.csf().set_lost_volume(0, 9000.0);
  s.set_gravity(standard_gravity * Vec3(0.2, -0.3, -0.9));
  s.set_damping({5.0, 0.001});
  EXPECT_TRUE(s.step(0.02).converged());
  s.set_friction(lead, 0.02, 1.0);
  s.csf().set_air_volume(0, 3000.0);  // wanted, not solved for yet
  return s;
}

void expect_same_future(Stepper& a, Stepper& b) {
  EXPECT_TRUE(same_bits(a.displacement(), b.displacement()));
  EXPECT_TRUE(same_bits(a.velocity(), b.velocity()));
  EXPECT_TRUE(same_bits(a.external_force(), b.external_force()));
  EXPECT_EQ(a.csf().amount(0), b.csf().amount(0));
  for (int i = 0; i < 2; ++i) {
    const SolveReport ra = i == 0 ? a.step(0.05) : a.solve_static();
    const SolveReport rb = i == 0 ? b.step(0.05) : b.solve_static();
    EXPECT_EQ(ra.iterations, rb.iterations);
    EXPECT_TRUE(ra.converged());
    EXPECT_TRUE(same_bits(a.displacement(), b.displacement()));
    for (DeviceId id : {0, 1}) {
      EXPECT_TRUE(same_bits(a.device(id).nodes, b.device(id).nodes));
      EXPECT_TRUE(same_bits(a.device(id).path_forces, b.device(id).path_forces));
    }
    for (const ConstraintGroup& g : a.constraints().groups()) {
      EXPECT_EQ(g.enabled, b.constraints().group(g.id).enabled);
      EXPECT_TRUE(same_bits(a.contact(g.id).force, b.contact(g.id).force));
    }
  }
}

TEST(Bytes, OfASnapshotGoOnWithTheSameBitsInAnotherStepperOfTheScene) {
  Stepper a = busy_stepper(), b(everything(), a.options());
  const Bytes bytes = bytes_of(*a.snapshot());
  b.restore(b.read_snapshot(bytes));
  EXPECT_EQ(bytes_of(*b.snapshot()), bytes);
  expect_same_future(a, b);
}

TEST(Bytes, OfARecordingAreTheSceneItsOptionsAndItsState) {
  Stepper a = busy_stepper();
  const Bytes bytes = a.record();
  Stepper b = Stepper::replay(bytes);
  EXPECT_EQ(b.record(), bytes);
  EXPECT_EQ(b.options().residual_tolerance, 1e-9);
  expect_same_future(a, b);
}

TEST(Bytes, WithAnyByteDamagedOrMissingAreRefused) {
  Stepper s(test::busy_scene(1, 0.3));
  const Bytes bytes = s.record();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    Bytes damaged = bytes;
    damaged[i] ^= std::uint8_t(1u << i % 8);
    EXPECT_THROW(Stepper::replay(damaged), Error) << i;
    EXPECT_THROW(Stepper::replay(Bytes(bytes.begin(), bytes.begin() + std::ptrdiff_t(i))), Error)
        << i;
  }
  EXPECT_NO_THROW(Stepper::replay(bytes));
}

// Lengths and numbers that lie are refused before anything is allocated or read beyond the end, also
// where the checksum is right.
template <class Read>
int lies_refused(const Bytes& bytes, const Read& read) {
  constexpr std::size_t head = 32, seal = 8;
  int refused = 0;
  for (std::size_t i = head; i + seal < bytes.size(); i += 8) {
    Bytes lying = bytes;
    for (std::size_t k = 0; k < 8; ++k) lying[i + k] = 0x7f;
    const std::uint64_t sum = checksum(lying.data(), lying.size() - seal);
    for (std::size_t k = 0; k < 8; ++k) lying[lying.size() - seal + k] = std::uint8_t(sum >> 8 * k);
    try {
      read(lying);  // a coordinate may be any number
    } catch (const Error&) {
      ++refused;
    }
  }
  return refused;
}

TEST(Bytes, WithLyingContentAreRefusedWithoutHarm) {
  Scene scene = test::busy_scene(1, 0.3);
  Stepper s(scene);
  EXPECT_GT(lies_refused(bytes_of(*s.snapshot()), [&](const Bytes& lying) { s.read_snapshot(lying); }), 5);
  scene.constraints = {};   // a wall takes long to make
  scene.constraints.fix("base", {0, 1, 2});
  scene.constraints.support("stem", {3}, Eigen::VectorXd::Constant(1, 0.3));
  EXPECT_GT(lies_refused(Stepper(scene).record(), [](const Bytes& lying) { read_recording(lying); }), 20);
}

TEST(Bytes, OfARecordingKeepTheIdsOfGroupsHoweverManyAreGone) {
  Scene scene = test::busy_scene(1, 0.3);
  skip_ids(scene.constraints, 2000000000);
  const ConstraintId id = scene.constraints.fix("base", {0, 1, 2});
  const Scene read = read_recording(Stepper(scene).record()).scene;
  EXPECT_EQ(id, 2000000000);
  EXPECT_EQ(read.constraints.group(id).name, "base");
}

TEST(Bytes, OfAnotherSceneKindOrVersionAreRefusedByName) {
  Stepper a(test::busy_scene(2, 0.3)), b(test::busy_scene(2, 0.4)), c(test::busy_scene(3, 0.3));
  Bytes bytes = bytes_of(*a.snapshot());
  expect_error(ErrorCode::invalid_argument, {"other constraints"}, [&] { b.read_snapshot(bytes); });
  expect_error(ErrorCode::invalid_argument, {"another mesh"}, [&] { c.read_snapshot(bytes); });
  expect_error(ErrorCode::file, {"no recording"}, [&] { Stepper::replay(bytes); });
  expect_error(ErrorCode::file, {"no snapshot"}, [&] { a.read_snapshot(a.record()); });
  bytes[16] = 99;
  expect_error(ErrorCode::file, {"version 99"}, [&] { a.read_snapshot(bytes); });
  expect_error(ErrorCode::file, {"do not begin"}, [&] { a.read_snapshot({}); });
}

TEST(Bytes, KeepTheElementsOfAScene) {
  for (test::Element element : test::all_elements) {
    Stepper a(test::with_element(test::busy_scene(2, 0.3), element));
    a.csf().set_lost_volume(0, 2000.0);
    ASSERT_TRUE(a.solve_static().converged()) << test::name_of(element);
    Stepper b = Stepper::replay(a.record());
    EXPECT_EQ(b.mesh().is_quadratic(), element == test::Element::quadratic);
    EXPECT_TRUE(same_bits(a.displacement(), b.displacement()));
    for (Stepper* s : {&a, &b}) {
      s->csf().set_lost_volume(0, 5000.0);
      ASSERT_TRUE(s->solve_static().converged());
    }
    EXPECT_TRUE(same_bits(a.displacement(), b.displacement())) << test::name_of(element);
  }
}

}  // namespace
}  // namespace brainshift
