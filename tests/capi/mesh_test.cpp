// What meshes and scenes answer, and what the functions beside the main way refuse.
#include <cstring>
#include <limits>

#include "brainshift/brainshift.hpp"
#include "world.hpp"

namespace brainshift::test {
namespace {

TEST(Meshes, DescribeThemselvesAsInCpp) {
  World w;
  const Mesh cpp(w.block.points, w.block.tets);
  brs_mesh_info info;
  brs_mesh_info_init(&info, sizeof info);
  w.good(brs_mesh_describe(w.mesh, &info));
  ASSERT_EQ(info.node_count, cpp.node_count());
  ASSERT_EQ(info.tet_count, cpp.tet_count());
  EXPECT_EQ(info.component_count, 1);
  EXPECT_EQ(info.reoriented, 0);
  EXPECT_EQ(info.volume, cpp.volume());
  EXPECT_EQ(info.diameter, cpp.diameter());
  EXPECT_EQ(std::memcmp(info.nodes, cpp.nodes().data(), sizeof(double) * 3 * info.node_count), 0);
  EXPECT_EQ(std::memcmp(info.tets, cpp.tets().data(), sizeof(Index) * 4 * info.tet_count), 0);
  EXPECT_EQ(info.regions[0], 0);
  EXPECT_EQ(info.components[info.node_count - 1], 0);

  std::int64_t count = 0;
  w.good(brs_mesh_dihedrals(w.mesh, nullptr, 0, &count));
  ASSERT_EQ(count, info.tet_count);
  std::vector<double> angles(std::size_t(count), -1.0);
  w.good(brs_mesh_dihedrals(w.mesh, angles.data(), 2, &count));
  EXPECT_EQ(angles[1], cpp.smallest_dihedrals()[1]);
  EXPECT_EQ(angles[2], -1.0);   // no more than there is room for
}

TEST(Meshes, LocatePointsWithTheirWeights) {
  World w;
  const double points[] = {10.0, 11.0, 12.0, -99.0, 0.0, 0.0};
  std::int32_t tets[2] = {-7, -7};
  double weights[8] = {};
  EXPECT_EQ(brs_mesh_locate(w.mesh, points, 2, tets, weights), BRS_OUTSIDE);
  EXPECT_NE(w.message().find("1 of 2 points"), std::string::npos) << w.message();
  EXPECT_EQ(tets[1], -1);
  ASSERT_GE(tets[0], 0);
  double x = 0.0;
  for (int a = 0; a < 4; ++a) x += weights[a] * w.block.points(w.block.tets(tets[0], a), 0);
  EXPECT_NEAR(x, 10.0, 1e-12);
  EXPECT_EQ(brs_mesh_locate(w.mesh, points, 1, tets, nullptr), BRS_OK);
  const double nan[] = {NAN, 0.0, 0.0};
  EXPECT_EQ(brs_mesh_locate(w.mesh, nan, 1, tets, nullptr), BRS_ERROR_NOT_FINITE);
  EXPECT_EQ(brs_mesh_locate(w.mesh, points, 1, nullptr, nullptr), BRS_ERROR_NULL);
}

TEST(Scenes, ConstraintsMayBeDisabledAndRemovedBeforeAStepperIsMade) {
  World w;
  std::int32_t id = -1;
  const double inside = 5.0;   // mm to be kept from the wall: the block is closer
  w.good(brs_scene_add_obstacle(w.scene, "tight", w.sides.data(), std::int64_t(w.sides.size()),
                                w.surface, 1, &inside, 1, &id));
  brs_stepper* made = nullptr;
  EXPECT_EQ(brs_stepper_create(w.scene, nullptr, &made), BRS_ERROR_INITIAL_PENETRATION);
  w.good(brs_scene_set_enabled(w.scene, id, 0));
  w.good(brs_stepper_create(w.scene, nullptr, &made));
  w.good(brs_stepper_destroy(made));
  w.good(brs_scene_set_enabled(w.scene, id, 1));
  EXPECT_EQ(brs_stepper_create(w.scene, nullptr, &made), BRS_ERROR_INITIAL_PENETRATION);
  w.good(brs_scene_remove_constraint(w.scene, id));
  w.good(brs_stepper_create(w.scene, nullptr, &made));
  w.good(brs_stepper_destroy(made));
  EXPECT_EQ(brs_scene_remove_constraint(w.scene, id), BRS_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(brs_scene_set_enabled(w.scene, 99, 1), BRS_ERROR_INVALID_ARGUMENT);
}

TEST(Sizes, BelowZeroOrBeyondTheIndexRangeAreRefusedByTheNewerFunctionsToo) {
  World w;
  double value = 0.0;
  std::int32_t tet = 0;
  std::uint8_t byte = 0;
  std::int64_t found = 0;
  brs_device* device = nullptr;
  brs_snapshot* snapshot = nullptr;
  brs_stepper* stepper = nullptr;
  for (std::int64_t count : {std::int64_t(-1), std::int64_t(1) << 31, INT64_MAX, INT64_MIN}) {
    EXPECT_EQ(brs_mesh_locate(w.mesh, &value, count, &tet, nullptr), BRS_ERROR_SIZE);
    EXPECT_EQ(brs_mesh_dihedrals(w.mesh, &value, count, &found), BRS_ERROR_SIZE);
    EXPECT_EQ(brs_stepper_set_velocity(w.stepper, &value, count), BRS_ERROR_SIZE);
    EXPECT_EQ(brs_snapshot_bytes(w.snapshot, &byte, count, &found), BRS_ERROR_SIZE);
    EXPECT_EQ(brs_stepper_record(w.stepper, &byte, count, &found), BRS_ERROR_SIZE);
    EXPECT_EQ(brs_stepper_read_snapshot(w.stepper, &byte, count, &snapshot), BRS_ERROR_SIZE);
    EXPECT_EQ(brs_stepper_replay(w.context, &byte, count, &stepper), BRS_ERROR_SIZE);
    for (int which = 0; which < 4; ++which) {
      const auto n = [&](int i) { return i == which ? count : std::int64_t(0); };
      EXPECT_EQ(brs_device_create(w.context, "x", &value, n(0), &value, n(1), &value, n(2), &value,
                                  n(3), &device),
                BRS_ERROR_SIZE)
          << which;
    }
  }
}

TEST(Structs, OfUnknownSizeAreRefusedByTheNewerFunctionsToo) {
  World w;
  brs_device* device = nullptr;
  std::int32_t id = -1;
  const double tip[] = {15.0, 15.0, 8.0}, outward[] = {0.0, 0.0, 1.0};
  for (std::int64_t size : {std::int64_t(0), std::int64_t(-8), std::int64_t(12), INT64_MAX}) {
    brs_mesh_info mesh{};
    brs_device_options options{};
    brs_device_entry entry{};
    brs_device_info info{};
    brs_hold hold{};
    brs_track_options track{};
    brs_device_state state{};
    brs_solve_report report{};
    mesh.struct_size = options.struct_size = entry.struct_size = info.struct_size = size;
    track.struct_size = state.struct_size = report.struct_size = hold.struct_size = size;
    EXPECT_EQ(brs_mesh_describe(w.mesh, &mesh), BRS_ERROR_STRUCT_SIZE);
    EXPECT_EQ(brs_device_create_named(w.context, "3389", 20.0, &options, &device),
              BRS_ERROR_STRUCT_SIZE);
    EXPECT_EQ(brs_device_table(w.context, 0, &entry), BRS_ERROR_STRUCT_SIZE);
    EXPECT_EQ(brs_device_describe(w.device, &info), BRS_ERROR_STRUCT_SIZE);
    EXPECT_EQ(brs_stepper_insert(w.stepper, w.device, tip, outward, &hold, nullptr, &id),
              BRS_ERROR_STRUCT_SIZE);
    brs_hold_init(&hold, sizeof hold);
    hold.rigid_from = 0.0;
    EXPECT_EQ(brs_stepper_insert(w.stepper, w.device, tip, outward, &hold, &track, &id),
              BRS_ERROR_STRUCT_SIZE);
    EXPECT_EQ(brs_stepper_device(w.stepper, 0, &state), BRS_ERROR_STRUCT_SIZE);
    EXPECT_EQ(brs_stepper_step(w.stepper, 0.1, &report), BRS_ERROR_STRUCT_SIZE);
    EXPECT_EQ(brs_stepper_progress_report(w.stepper, &report), BRS_ERROR_STRUCT_SIZE);
    for (double v : w.field(BRS_FIELD_VELOCITY)) ASSERT_EQ(v, 0.0);   // before anything is solved
  }
}

}  // namespace
}  // namespace brainshift::test
