// Structs and versions: what an older, a newer and a careless host may give.
#include "capi/structs.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "world.hpp"

// A struct that has grown by `added` since its first version.
struct GrownStruct {
  std::int64_t struct_size;
  double first, added;
};
template <>
inline constexpr std::int64_t brainshift::capi::first_size<GrownStruct> = 16;

namespace brainshift::test {
namespace {

template <class T>
void expect_sizes_checked(brs_status (*init)(T*, std::int64_t), const char* name) {
  T value;
  EXPECT_EQ(init(&value, sizeof value), BRS_OK) << name;
  EXPECT_EQ(value.struct_size, std::int64_t(sizeof value)) << name;
  // The size in the first version: a struct may only grow.
  EXPECT_GE(std::int64_t(sizeof value), capi::first_size<T>) << name;
  EXPECT_EQ(init(nullptr, sizeof value), BRS_ERROR_NULL) << name;
  for (std::int64_t size :
       {std::int64_t(-8), std::int64_t(0), std::int64_t(8), capi::first_size<T> - 8,
        std::int64_t(sizeof value) + 8, std::int64_t(sizeof value) - 1, INT64_MAX, INT64_MIN})
    EXPECT_EQ(init(&value, size), BRS_ERROR_STRUCT_SIZE) << name << " of size " << size;
}

TEST(Structs, InitKnowsItsSizes) {
  expect_sizes_checked(&brs_surface_options_init, "surface_options");
  expect_sizes_checked(&brs_material_init, "material");
  expect_sizes_checked(&brs_compartment_init, "compartment");
  expect_sizes_checked(&brs_stepper_options_init, "stepper_options");
  expect_sizes_checked(&brs_solve_report_init, "solve_report");
  expect_sizes_checked(&brs_compartment_state_init, "compartment_state");
  expect_sizes_checked(&brs_contact_state_init, "contact_state");
  expect_sizes_checked(&brs_mesh_info_init, "mesh_info");
  expect_sizes_checked(&brs_device_options_init, "device_options");
  expect_sizes_checked(&brs_device_entry_init, "device_entry");
  expect_sizes_checked(&brs_device_info_init, "device_info");
  expect_sizes_checked(&brs_hold_init, "hold");
  expect_sizes_checked(&brs_track_options_init, "track_options");
  expect_sizes_checked(&brs_device_state_init, "device_state");
  expect_sizes_checked(&brs_memory_estimate_init, "memory_estimate");
  expect_sizes_checked(&brs_mcp_options_init, "mcp_options");
  expect_sizes_checked(&brs_mcp_report_init, "mcp_report");
}

TEST(Structs, OfUnknownSizeAreRefusedByEveryFunction) {
  World w;
  brs_surface* surface = nullptr;
  brs_stepper* stepper = nullptr;
  for (std::int64_t size : {std::int64_t(0), std::int64_t(-1), std::int64_t(7), INT64_MAX}) {
    brs_surface_options surface_options{size, 1.0, 1.0};
    brs_material material = tissue();
    brs_compartment box = w.compartment();
    brs_stepper_options options{};
    brs_solve_report report{};
    brs_compartment_state state{};
    brs_contact_state contact{};
    material.struct_size = box.struct_size = options.struct_size = size;
    report.struct_size = state.struct_size = contact.struct_size = size;
    EXPECT_EQ(brs_surface_create(w.context, 0, w.wall.points.data(), 8, w.wall.triangles.data(), 12,
                                 &surface_options, &surface),
              BRS_ERROR_STRUCT_SIZE);
    EXPECT_EQ(brs_scene_set_material(w.scene, 0, &material), BRS_ERROR_STRUCT_SIZE);
    EXPECT_EQ(brs_scene_add_compartment(w.scene, &box, nullptr), BRS_ERROR_STRUCT_SIZE);
    EXPECT_EQ(brs_stepper_create(w.scene, &options, &stepper), BRS_ERROR_STRUCT_SIZE);
    EXPECT_EQ(brs_stepper_compartment(w.stepper, 0, &state), BRS_ERROR_STRUCT_SIZE);
    EXPECT_EQ(brs_stepper_contact(w.stepper, w.contact, &contact), BRS_ERROR_STRUCT_SIZE);
    // Before anything is solved.
    EXPECT_EQ(w.solve_after_loss(5000.0, &report), BRS_ERROR_STRUCT_SIZE);
    for (double u : w.field(BRS_FIELD_DISPLACEMENT)) EXPECT_EQ(u, 0.0);
    EXPECT_NE(w.message(), "struct_size");
  }
}

TEST(Structs, OfAnOlderHeaderKeepDefaultsForWhatItDoesNotKnow) {
  const GrownStruct defaults{sizeof(GrownStruct), 1.0, 2.0};
  const GrownStruct old{16, 5.0, 99.0}, present{24, 5.0, 6.0};
  EXPECT_EQ(capi::read(&old, defaults, "s").first, 5.0);
  EXPECT_EQ(capi::read(&old, defaults, "s").added, 2.0);
  EXPECT_EQ(capi::read(&present, defaults, "s").added, 6.0);
}

TEST(Structs, OfAnOlderHeaderAreNotWrittenBeyondTheirEnd) {
  GrownStruct out{16, 0.0, 99.0};
  capi::write(&out, GrownStruct{sizeof(GrownStruct), 1.0, 2.0}, "s");
  EXPECT_EQ(out.first, 1.0);
  EXPECT_EQ(out.added, 99.0);
  EXPECT_EQ(out.struct_size, 16);
  EXPECT_EQ(capi::init(&out, 16, GrownStruct{sizeof(GrownStruct), 3.0, 4.0}), BRS_OK);
  EXPECT_EQ(out.first, 3.0);
  EXPECT_EQ(out.added, 99.0);
}

TEST(Structs, DefaultsAreThoseOfTheLibrary) {
  const StepperOptions expected;
  brs_stepper_options options;
  ASSERT_EQ(brs_stepper_options_init(&options, sizeof options), BRS_OK);
  EXPECT_EQ(options.residual_tolerance, expected.residual_tolerance);
  EXPECT_EQ(options.complementarity_tolerance, expected.complementarity_tolerance);
  EXPECT_EQ(options.correction_tolerance, expected.correction_tolerance);
  EXPECT_EQ(options.max_iterations, expected.max_iterations);
  EXPECT_EQ(options.smallest_load_step, expected.smallest_load_step);
  EXPECT_EQ(options.initial_penetration, expected.initial_penetration);
  EXPECT_EQ(options.time_limit, expected.time_limit);
  EXPECT_EQ(options.threads, 0);
}

TEST(Versions, OfHeaderAndLibraryMustGoTogether) {
  brs_context* context = nullptr;
  for (std::int32_t version : {0, -1, BRS_VERSION + 1, BRS_VERSION + 1000, BRS_VERSION + 1000000,
                               BRS_VERSION - 1000, INT32_MAX, INT32_MIN}) {
    EXPECT_EQ(brs_context_create(version, &context), BRS_ERROR_VERSION) << version;
    EXPECT_EQ(context, nullptr);
  }
  EXPECT_EQ(brs_version(), BRS_VERSION);
  EXPECT_STREQ(brs_version_string(), BRAINSHIFT_PROJECT_VERSION);
  EXPECT_NE(std::strstr(brs_build_info(), BRAINSHIFT_PROJECT_VERSION), nullptr);
}

TEST(Statuses, AllHaveNames) {
  for (brs_status s = BRS_OK; s <= BRS_INFEASIBLE; ++s)
    EXPECT_EQ(std::string(brs_status_name(s)).substr(0, 4), "BRS_") << s;
  for (brs_status s = BRS_ERROR_NULL; s >= BRS_ERROR_INTERNAL; --s)
    EXPECT_EQ(std::string(brs_status_name(s)).substr(0, 10), "BRS_ERROR_") << s;
  for (brs_status s = BRS_ERROR_INVALID_ARGUMENT; s >= BRS_ERROR_FILE; --s)
    EXPECT_EQ(std::string(brs_status_name(s)).substr(0, 10), "BRS_ERROR_") << s;
  EXPECT_STREQ(brs_status_name(12345), "unknown status");
}

}  // namespace
}  // namespace brainshift::test
