// Snapshots that are damaged, or another scene's.
#include "robustness/outcome.hpp"

namespace brainshift::test {
namespace {

Bytes bytes_after_loss(Stepper& stepper) {
  stepper.csf().set_lost_volume(0, 5000.0);
  expect_converged(stepper.solve_static());
  return bytes_of(*stepper.snapshot());
}

TEST(Snapshots, O8_a_bit_flipped_at_every_byte) {
  Stepper stepper(busy_scene(2, 0.3));
  const Bytes good = bytes_after_loss(stepper);
  const ShownState before(stepper);
  for (std::size_t i = 0; i < good.size(); ++i) {
    Bytes bad = good;
    bad[i] ^= std::uint8_t(1u << i % 8);
    try {
      stepper.read_snapshot(bad);
      ADD_FAILURE() << "read with byte " << i << " of " << good.size() << " changed";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::file) << i << ": " << error.what();
    }
  }
  EXPECT_TRUE(ShownState(stepper) == before);
  EXPECT_NO_THROW(stepper.read_snapshot(good));
}

TEST(Snapshots, O8_of_another_version) {
  Stepper stepper(busy_scene(2, 0.3));
  Bytes bytes = bytes_after_loss(stepper);
  const std::size_t version = 8 + 8;  // behind the magic and the kind
  ++bytes[version];
  expect_error(ErrorCode::file, {"version"}, [&] { stepper.read_snapshot(bytes); });
}

// The same numbers of nodes and tets, one node elsewhere; another mesh; other constraints.
TEST(Snapshots, O8_of_another_scene) {
  Stepper stepper(busy_scene(2, 0.3));
  const Bytes bytes = bytes_after_loss(stepper);
  const auto refused = [&](const Scene& scene) {
    Stepper other(scene);
    const ShownState before(other);
    EXPECT_THROW(
        {
          try {
            other.read_snapshot(bytes);
          } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::invalid_argument) << error.what();
            throw;
          }
        },
        Error);
    EXPECT_TRUE(ShownState(other) == before);
  };
  refused(busy_scene(3, 0.3));
  Scene moved_node = busy_scene(2, 0.3);
  Points nodes = moved_node.mesh.nodes();
  nodes(13, 0) += 1e-9;  // the one in the middle
  moved_node.mesh = Mesh(nodes, moved_node.mesh.tets());
  refused(moved_node);
  Scene held = busy_scene(2, 0.3);
  held.constraints.fix("one more", {0});
  refused(held);
}

}  // namespace
}  // namespace brainshift::test
