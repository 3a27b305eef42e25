// What a host may do wrong with the C face, case by case; tests/capi has each at more length, for every
// function and struct.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <cstddef>
#include <cstdio>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <utility>

#include "capi/world.hpp"

namespace brainshift::test {
namespace {

// Bytes of everything in a stepper.
std::vector<std::uint8_t> record(const World& w, brs_stepper* stepper) {
  std::int64_t count = 0;
  w.good(brs_stepper_record(stepper, nullptr, 0, &count));
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(count));
  w.good(brs_stepper_record(stepper, bytes.data(), count, &count));
  return bytes;
}

std::vector<std::uint8_t> record(const World& w) { return record(w, w.stepper); }

TEST(CMisuse, P1_null_handles_and_arrays) {
  World w;
  const std::vector<std::uint8_t> before = record(w);
  double value[3] = {1.0, 1.0, 1.0};
  EXPECT_EQ(brs_stepper_solve_static(nullptr, nullptr), BRS_ERROR_NULL);
  EXPECT_EQ(brs_stepper_displacement_at(w.stepper, nullptr, 1, value, nullptr), BRS_ERROR_NULL);
  EXPECT_EQ(brs_stepper_displacement_at(w.stepper, value, 1, nullptr, nullptr), BRS_ERROR_NULL);
  EXPECT_NE(w.message().find("NULL"), std::string::npos) << w.message();
  EXPECT_EQ(brs_stepper_displacement_at(w.stepper, nullptr, 0, nullptr, nullptr), BRS_OK);
  EXPECT_EQ(record(w), before);
}

// What is undefined stays undefined: use after destroy. NULL is fine, and memory that never was a handle
// is refused.
TEST(CMisuse, P2_destroying_nothing_and_what_is_no_handle) {
  EXPECT_EQ(brs_stepper_destroy(nullptr), BRS_OK);
  EXPECT_EQ(brs_mesh_destroy(nullptr), BRS_OK);
  EXPECT_EQ(brs_context_destroy(nullptr), BRS_OK);
  alignas(16) unsigned char memory[256];
  for (const int fill : {0x00, 0xa5, 0xff}) {
    std::memset(memory, fill, sizeof memory);
    EXPECT_EQ(brs_stepper_destroy(reinterpret_cast<brs_stepper*>(memory)), BRS_ERROR_HANDLE) << fill;
    EXPECT_EQ(brs_stepper_solve_static(reinterpret_cast<brs_stepper*>(memory), nullptr),
              BRS_ERROR_HANDLE)
        << fill;
    for (const unsigned char byte : memory) ASSERT_EQ(byte, fill);
  }
}

TEST(CMisuse, P3_a_handle_of_another_type) {
  World w;
  brs_scene* scene = nullptr;
  EXPECT_EQ(brs_stepper_solve_static(reinterpret_cast<brs_stepper*>(w.mesh), nullptr), BRS_ERROR_HANDLE);
  EXPECT_NE(w.message().find("a mesh is given where a stepper is expected"), std::string::npos)
      << w.message();
  EXPECT_EQ(brs_scene_create(w.context, reinterpret_cast<brs_mesh*>(w.scene), &scene),
            BRS_ERROR_HANDLE);
  EXPECT_EQ(scene, nullptr);
  EXPECT_EQ(brs_mesh_destroy(reinterpret_cast<brs_mesh*>(w.device)), BRS_ERROR_HANDLE);
  w.good(w.solve_after_loss(5000.0));
}

// Three times the last count is beyond 64 bits, three times the one before beyond 32.
TEST(CMisuse, P4_counts_below_zero_and_beyond_what_indices_reach) {
  World w;
  double value[3] = {1.0, 1.0, 1.0};
  brs_mesh* mesh = nullptr;
  for (const std::int64_t count :
       {std::int64_t(-1), INT64_MIN, std::int64_t(INT32_MAX) + 1, INT64_MAX / 2, INT64_MAX}) {
    EXPECT_EQ(brs_stepper_displacement_at(w.stepper, value, count, value, nullptr), BRS_ERROR_SIZE)
        << count;
    EXPECT_NE(w.message().find(std::to_string(count)), std::string::npos) << w.message();
    EXPECT_EQ(brs_mesh_create(w.context, w.block.points.data(), count, w.block.tets.data(), 1,
                              nullptr, 0, &mesh),
              BRS_ERROR_SIZE)
        << count;
    EXPECT_EQ(mesh, nullptr);
  }
}

TEST(CMisuse, P5_the_same_array_in_and_out_and_arrays_at_odd_addresses) {
  World w;
  w.good(w.solve_after_loss(5000.0));
  const std::vector<double> points = {10.0, 10.0, 20.0, 21.0, 7.0, 29.0};
  const auto bytes = points.size() * sizeof(double);
  std::vector<double> apart(points.size()), together = points;
  w.good(brs_stepper_displacement_at(w.stepper, points.data(), 2, apart.data(), nullptr));
  w.good(brs_stepper_displacement_at(w.stepper, together.data(), 2, together.data(), nullptr));
  EXPECT_EQ(together, apart);
  EXPECT_NE(apart, points);
  std::vector<unsigned char> odd_in(bytes + 1), odd_out(bytes + 1);
  std::memcpy(odd_in.data() + 1, points.data(), bytes);
  w.good(brs_stepper_displacement_at(w.stepper, reinterpret_cast<const double*>(odd_in.data() + 1), 2,
                                     reinterpret_cast<double*>(odd_out.data() + 1), nullptr));
  EXPECT_EQ(std::memcmp(odd_out.data() + 1, apart.data(), bytes), 0);
}

// What a progress callback does in the midst of a solve.
struct Callback {
  std::function<std::int32_t()> act;
  static std::int32_t call(const brs_progress*, void* user) {
    return static_cast<Callback*>(user)->act();
  }
  Callback(World& w, std::function<std::int32_t()> what) : act(std::move(what)) {
    w.good(brs_context_set_progress(w.context, &Callback::call, this));
  }
};

TEST(CMisuse, P6_calls_out_of_a_callback_are_busy) {
  World w, alone;
  int called = 0;
  const Callback callback(w, [&] {
    ++called;
    EXPECT_EQ(brs_stepper_step(w.stepper, 0.1, nullptr), BRS_ERROR_BUSY);
    EXPECT_EQ(brs_stepper_destroy(w.stepper), BRS_ERROR_BUSY);
    EXPECT_EQ(brs_context_destroy(w.context), BRS_ERROR_BUSY);
    return 0;
  });
  w.good(w.solve_after_loss(5000.0));
  EXPECT_GT(called, 0);
  alone.good(alone.solve_after_loss(5000.0));
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), alone.field(BRS_FIELD_DISPLACEMENT));
}

TEST(CMisuse, P7_a_callback_that_asks_to_stop_or_throws) {
  World w;
  w.good(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_LOST_VOLUME, 5000.0));
  const std::vector<std::uint8_t> before = record(w);
  {
    const Callback stops(w, [] { return 1; });
    EXPECT_EQ(brs_stepper_solve_static(w.stepper, nullptr), BRS_CANCELLED);
    EXPECT_EQ(record(w), before);
  }
  {
    const Callback throws(w, []() -> std::int32_t { throw std::runtime_error("oops"); });
    EXPECT_EQ(brs_stepper_solve_static(w.stepper, nullptr), BRS_ERROR_CALLBACK);
    EXPECT_EQ(record(w), before);
  }
  w.good(brs_context_set_progress(w.context, nullptr, nullptr));
  w.good(brs_stepper_solve_static(w.stepper, nullptr));
}

// The report has grown since its first version, by what comes after seconds_line_search.
TEST(CMisuse, P8_structs_of_an_older_header_and_of_a_newer_one) {
  World w;
  brs_solve_report report;
  std::memset(&report, 0x5a, sizeof report);
  const auto old = std::int64_t(offsetof(brs_solve_report, kinetic_energy));
  w.good(brs_solve_report_init(&report, old));
  w.good(w.solve_after_loss(5000.0, &report));
  EXPECT_EQ(report.struct_size, old);
  EXPECT_GT(report.iterations, 0);
  const auto* tail = reinterpret_cast<const unsigned char*>(&report) + old;
  for (std::size_t i = 0; i < sizeof report - std::size_t(old); ++i) ASSERT_EQ(tail[i], 0x5a) << i;

  brs_stepper_options options;
  std::memset(&options, 0x5a, sizeof options);   // a time limit that means nothing, which is not read
  w.good(brs_stepper_options_init(&options, offsetof(brs_stepper_options, threads)));
  brs_stepper* stepper = nullptr;
  w.good(brs_stepper_create(w.scene, &options, &stepper));
  brs_stepper_destroy(stepper);
  options.struct_size = sizeof options + 8;
  EXPECT_EQ(brs_stepper_create(w.scene, &options, &stepper), BRS_ERROR_STRUCT_SIZE);
}

TEST(CMisuse, P9_a_struct_that_was_never_initialised) {
  World w;
  const std::vector<std::uint8_t> before = record(w);
  for (const int fill : {0x00, 0x5a, 0xff}) {
    brs_solve_report report;
    std::memset(&report, fill, sizeof report);
    EXPECT_EQ(brs_stepper_solve_static(w.stepper, &report), BRS_ERROR_STRUCT_SIZE) << fill;
    EXPECT_NE(w.message().find("_init"), std::string::npos) << w.message();
  }
  EXPECT_EQ(record(w), before);
}

TEST(CMisuse, P10_results_before_the_first_solve_and_after_one_that_failed) {
  World w;
  for (const double u : w.field(BRS_FIELD_DISPLACEMENT)) EXPECT_EQ(u, 0.0);
  for (const double j : w.field(BRS_FIELD_JACOBIAN)) EXPECT_EQ(j, 1.0);
  const double* values = nullptr;
  for (const std::int32_t field : {BRS_FIELD_ITERATE, BRS_FIELD_FARTHEST}) {
    EXPECT_EQ(brs_stepper_field(w.stepper, field, &values, nullptr, nullptr),
              BRS_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(values, nullptr);
  }
  w.good(w.solve_after_loss(5000.0));
  const std::vector<double> good = w.field(BRS_FIELD_DISPLACEMENT);
  w.good(brs_context_set_cancel(w.context, 1));
  brs_solve_report report;
  w.good(brs_solve_report_init(&report, sizeof report));
  EXPECT_EQ(w.solve_after_loss(6000.0, &report), BRS_CANCELLED);
  EXPECT_EQ(report.status, BRS_CANCELLED);
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), good);
  // Cancelled before a part of the load was in balance: it came no farther than where it began.
  EXPECT_EQ(report.load_factor, 0.0);
  EXPECT_EQ(w.field(BRS_FIELD_FARTHEST), good);
}

// Bytes of address space that the process has now.
std::size_t address_space() {
  std::size_t pages = 0;
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file && std::fscanf(file, "%zu", &pages) != 1) pages = 0;
  if (file) std::fclose(file);
  return pages * std::size_t(sysconf(_SC_PAGESIZE));
}

// A block heavy enough for a factor of some tens of MB.
brs_stepper* make_large_stepper(const World& w) {
  constexpr int cells = 14;
  const TetShape shape = make_box({30, 30, 30}, cells, cells, cells);
  Indices base;
  for (Index i = 0; i < (cells + 1) * (cells + 1); ++i) base.push_back(i);
  const brs_material material = tissue();
  brs_mesh* mesh = nullptr;
  brs_scene* scene = nullptr;
  brs_stepper* stepper = nullptr;
  w.good(brs_mesh_create(w.context, shape.points.data(), shape.points.rows(), shape.tets.data(),
                         shape.tets.rows(), nullptr, 0, &mesh));
  w.good(brs_scene_create(w.context, mesh, &scene));
  w.good(brs_scene_set_material(scene, 0, &material));
  w.good(brs_scene_set_balanced_reference(scene, 0));
  w.good(brs_scene_add_fixed(scene, "base", base.data(), std::int64_t(base.size()), BRS_AXES, nullptr));
  w.good(brs_stepper_create(scene, nullptr, &stepper));
  brs_scene_destroy(scene);
  brs_mesh_destroy(mesh);
  return stepper;
}

// The system gives half of what the factor takes: a status, and the state as it was; with all of it the solve
// goes through. In a child, whose limit is its own; true where all is as it should be.
bool survives_too_little_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 17);   // what is freed goes back, and is not there for the factor
#endif
  World w;
  w.good(w.solve_after_loss(5000.0));   // other libraries have made their tables
  brs_stepper* const asked = make_large_stepper(w);   // an estimate may make room for the factor
  brs_memory_estimate estimate;
  w.good(brs_memory_estimate_init(&estimate, sizeof estimate));
  w.good(brs_stepper_memory_estimate(asked, &estimate));
  brs_stepper_destroy(asked);
  brs_stepper* const large = make_large_stepper(w);
  const std::vector<std::uint8_t> before = record(w, large);
  rlimit limit;
  getrlimit(RLIMIT_AS, &limit);
  const rlim_t all = std::exchange(limit.rlim_cur, address_space() + std::size_t(estimate.factor) / 2);
  setrlimit(RLIMIT_AS, &limit);
  const brs_status refused = brs_stepper_solve_static(large, nullptr);
  limit.rlim_cur = all;
  setrlimit(RLIMIT_AS, &limit);
  EXPECT_TRUE(refused == BRS_ERROR_MEMORY || refused == BRS_ERROR_LINEAR_SOLVER)
      << brs_status_name(refused) << ": " << w.message();
  EXPECT_NE(w.message().find("memory"), std::string::npos) << w.message();
  EXPECT_EQ(record(w, large), before);
  EXPECT_EQ(brs_stepper_solve_static(large, nullptr), BRS_OK) << w.message();
  brs_stepper_destroy(large);
  return !testing::Test::HasFailure();
}

TEST(CMisuse, P14_no_more_memory_from_the_system) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the address space belongs to the sanitizer";
#endif
  const pid_t child = fork();
  if (child == 0) {
    alarm(120);
    _exit(survives_too_little_memory() ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

// Gmsh has the last two edges of a tet the other way round than VTK: every edge node at its place, or none is
// taken.
TEST(CMisuse, O10_edge_nodes_in_the_order_of_another_program) {
  World w;
  brs_mesh* quadratic = nullptr;
  w.good(brs_mesh_quadratic(w.mesh, &quadratic));
  brs_mesh_info info;
  w.good(brs_mesh_info_init(&info, sizeof info));
  w.good(brs_mesh_describe(quadratic, &info));
  const auto create = [&](std::int64_t tets, std::int32_t edges, brs_mesh** mesh) {
    return brs_mesh_create_quadratic(w.context, info.nodes, info.node_count, info.tets, info.edge_nodes, tets,
                                     edges, nullptr, 0, mesh);
  };
  brs_mesh* mesh = nullptr;
  w.good(create(info.tet_count, BRS_EDGES_VTK, &mesh));
  brs_mesh_destroy(mesh);
  EXPECT_LT(create(info.tet_count, BRS_EDGES_GMSH, &mesh), 0);
  EXPECT_EQ(mesh, nullptr);
  EXPECT_NE(w.message().find("edge"), std::string::npos) << w.message();

  // One tet alone, where no neighbour contradicts.
  const double points[] = {0, 0, 0, 10, 0, 0, 0, 10, 0, 0, 0, 10, 5, 0, 0, 5, 5, 0, 0, 5, 0, 0, 0, 5,
                           5, 0, 5, 0, 5, 5};
  const std::int32_t corners[] = {0, 1, 2, 3}, on_edges[] = {4, 5, 6, 7, 8, 9};
  w.good(brs_mesh_create_quadratic(w.context, points, 10, corners, on_edges, 1, BRS_EDGES_VTK, nullptr, 0, &mesh));
  brs_mesh_destroy(mesh);
  EXPECT_EQ(brs_mesh_create_quadratic(w.context, points, 10, corners, on_edges, 1, BRS_EDGES_GMSH, nullptr, 0, &mesh),
            BRS_ERROR_INVERTED_ELEMENT)
      << w.message();
  brs_mesh_destroy(quadratic);
}

TEST(CMisuse, P15_a_header_of_another_version) {
  brs_context* context = nullptr;
  for (const std::int32_t version : {0, -1, BRS_VERSION + 1, BRS_VERSION + 1000, BRS_VERSION + 1000000,
                                     BRS_VERSION - 1000, INT32_MAX, INT32_MIN}) {
    EXPECT_EQ(brs_context_create(version, &context), BRS_ERROR_VERSION) << version;
    EXPECT_EQ(context, nullptr);
  }
  EXPECT_EQ(brs_version(), BRS_VERSION);
  EXPECT_EQ(brs_context_create(brs_version(), &context), BRS_OK);
  brs_context_destroy(context);
}

}  // namespace
}  // namespace brainshift::test
