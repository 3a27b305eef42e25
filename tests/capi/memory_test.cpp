// Every allocation of every call fails once: a status, no leak, and the state as it was.
//
// A program of its own: it replaces operator new for itself and for the library it loads. What Eigen
// and CHOLMOD take from malloc directly is not covered.
#include <cstdlib>
#include <new>
#include <utility>

#include "world.hpp"

namespace {
long countdown = -1;  // allocations until the one that fails; negative: none fails
}  // namespace

// Not inlined: the compiler would see a malloc() and its delete, and warn of what is meant.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (countdown >= 0 && countdown-- == 0) throw std::bad_alloc();
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace brainshift::test {
namespace {

// Lets allocation 0, 1, 2, ... of the call fail until it goes through; returns how many there are.
template <class Call>
long fail_each_allocation(const char* name, Call&& call) {
  for (long n = 0; n < 100000; ++n) {
    countdown = n;
    const brs_status status = call();
    const bool survived = countdown >= 0;
    countdown = -1;
    if (survived) {
      EXPECT_EQ(status, BRS_OK) << name;
      return n;
    }
    // A call may do without what it did not get; it may not do half of what it was asked.
    if (status != BRS_OK) {
      EXPECT_EQ(status, BRS_ERROR_MEMORY) << name << ", allocation " << n;
    }
  }
  ADD_FAILURE() << name << " does not end";
  return 0;
}

TEST(Memory, RunningOutWhileAHandleIsMadeIsAStatus) {
  World w;
  const auto& b = w.block;
  brs_context* context = nullptr;
  brs_mesh* mesh = nullptr;
  brs_scene* scene = nullptr;
  brs_stepper* stepper = nullptr;
  brs_snapshot* snapshot = nullptr;
  EXPECT_GT(fail_each_allocation("context",
                                 [&] {
                                   brs_context_destroy(context);
                                   return brs_context_create(BRS_VERSION, &context);
                                 }),
            0);
  fail_each_allocation("mesh", [&] {
    brs_mesh_destroy(mesh);
    return brs_mesh_create(w.context, b.points.data(), b.points.rows(), b.tets.data(),
                           b.tets.rows(), nullptr, 0, &mesh);
  });
  fail_each_allocation("scene", [&] {
    brs_scene_destroy(scene);
    return brs_scene_create(w.context, w.mesh, &scene);
  });
  fail_each_allocation("stepper", [&] {
    brs_stepper_destroy(stepper);
    return brs_stepper_create(w.scene, nullptr, &stepper);
  });
  fail_each_allocation("snapshot", [&] {
    brs_snapshot_destroy(snapshot);
    return brs_stepper_snapshot(w.stepper, &snapshot);
  });
  brs_snapshot_destroy(snapshot);
  brs_stepper_destroy(stepper);
  brs_scene_destroy(scene);
  brs_mesh_destroy(mesh);
  brs_context_destroy(context);
}

TEST(Memory, RunningOutWhileSolvingLeavesTheStateAsItWas) {
  World w, undisturbed;
  undisturbed.good(undisturbed.solve_after_loss(5000.0));
  w.good(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_LOST_VOLUME, 5000.0));
  const std::vector<double> rest = w.field(BRS_FIELD_DISPLACEMENT);
  const std::vector<double> fluid = w.field(BRS_FIELD_FLUID_FORCE);
  const long count = fail_each_allocation("solve", [&] {
    const brs_status status = brs_stepper_solve_static(w.stepper, nullptr);
    const long left = std::exchange(countdown, -1);
    if (status != BRS_OK) {
      EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), rest);
      EXPECT_EQ(w.field(BRS_FIELD_FLUID_FORCE), fluid);
    }
    w.good(status == BRS_OK && left < 0 ? brs_stepper_restore(w.stepper, w.snapshot) : BRS_OK);
    w.good(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_LOST_VOLUME, 5000.0));
    countdown = left;
    return status;
  });
  EXPECT_GT(count, 10);
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), undisturbed.field(BRS_FIELD_DISPLACEMENT));
}

// A device goes in, the state goes on in time, and what was recorded comes back: every call whole, or
// not at all.
TEST(Memory, RunningOutWithADeviceInTimeOrInBytesLeavesTheStateAsItWas) {
  World w;
  const double tip[] = {15.0, 15.0, 8.0}, outward[] = {0.0, 0.0, 1.0};
  brs_hold hold;
  brs_hold_init(&hold, sizeof hold);
  hold.rigid_from = 0.0;
  std::int32_t id = -1;
  fail_each_allocation("insert", [&] {
    return brs_stepper_insert(w.stepper, w.device, tip, outward, &hold, nullptr, &id);
  });
  EXPECT_EQ(id, 0);  // no number was lost
  brs_device_state state;
  brs_device_state_init(&state, sizeof state);
  fail_each_allocation("device", [&] { return brs_stepper_device(w.stepper, id, &state); });
  fail_each_allocation("exchange",
                       [&] { return brs_stepper_exchange(w.stepper, id, w.device, &hold, 0.0); });
  w.good(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_LOST_VOLUME, 5000.0));
  const std::vector<double> rest = w.field(BRS_FIELD_DISPLACEMENT);
  fail_each_allocation("step", [&] {
    const brs_status status = brs_stepper_step(w.stepper, 0.02, nullptr);
    const long left = std::exchange(countdown, -1);
    if (status != BRS_OK) {
      EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), rest);
    }
    std::int32_t phase = -1;
    w.good(brs_stepper_phase(w.stepper, &phase));
    EXPECT_EQ(phase, BRS_PHASE_IDLE);
    // A step that went through where an allocation had failed inside it is taken back.
    if (status == BRS_OK && left < 0) {
      w.good(brs_stepper_restore(w.stepper, w.snapshot));
      w.good(brs_stepper_insert(w.stepper, w.device, tip, outward, &hold, nullptr, &id));
      w.good(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_LOST_VOLUME, 5000.0));
    }
    countdown = left;
    return status;
  });
  const std::vector<double> moved = w.field(BRS_FIELD_DISPLACEMENT);
  EXPECT_NE(moved, rest);

  std::int64_t count = 0;
  w.good(brs_stepper_record(w.stepper, nullptr, 0, &count));
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(count));
  brs_stepper* replayed = nullptr;
  w.good(brs_stepper_record(w.stepper, bytes.data(), count, &count));
  // A sample: each attempt makes the distance grid of the obstacle anew.
  for (long n : {0L, 1L, 7L, 30L, 100L, 300L, 1000L}) {
    countdown = n;
    const brs_status status = brs_stepper_replay(w.context, bytes.data(), count, &replayed);
    countdown = -1;
    EXPECT_TRUE(status == BRS_OK || (status == BRS_ERROR_MEMORY && !replayed)) << n;
    brs_stepper_destroy(replayed);
  }
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), moved);
}

TEST(Memory, RunningOutOnTheWayToQuadraticTetsIsAStatus) {
  World w;
  brs_mesh* mesh = nullptr;
  brs_scene* scene = nullptr;
  EXPECT_GT(fail_each_allocation("mesh",
                                 [&] {
                                   brs_mesh_destroy(mesh);
                                   return brs_mesh_quadratic(w.mesh, &mesh);
                                 }),
            0);
  EXPECT_GT(fail_each_allocation("scene",
                                 [&] {
                                   brs_scene_destroy(scene);
                                   return brs_scene_quadratic(w.scene, &scene);
                                 }),
            0);
  brs_scene_destroy(scene);
  brs_mesh_destroy(mesh);
}

TEST(Memory, RunningOutWhileAnswersAreComputedLeavesTheStateAsItWas) {
  World w;
  w.good(w.solve_after_loss(5000.0));
  const std::vector<double> before = w.field(BRS_FIELD_DISPLACEMENT);
  const double point[] = {15.0, 15.0, 29.0};
  double error = -1.0;
  // A sample: each attempt factorises.
  for (long n : {0L, 1L, 7L, 30L, 100L, 300L, 100000L}) {
    countdown = n;
    const brs_status status = brs_stepper_estimate_error(w.stepper, point, 1, &error, nullptr);
    countdown = -1;
    EXPECT_EQ(status, n < 100000 ? BRS_ERROR_MEMORY : BRS_OK) << n;
    EXPECT_EQ(error == -1.0, status != BRS_OK) << n;
  }
  EXPECT_GT(error, 0.0);
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), before);
  brs_memory_estimate memory;
  w.good(brs_memory_estimate_init(&memory, sizeof memory));
  fail_each_allocation("memory estimate", [&] { return brs_stepper_memory_estimate(w.stepper, &memory); });
  w.good(w.solve_after_loss(5000.0));   // whatever is left of the failures
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), before);
  const double matrix[] = {2.0, 1.0, 1.0, 2.0}, q[] = {-1.0, -2.0}, lower[] = {0.0, 0.0},
               upper[] = {9.0, 9.0};
  double z[2] = {};
  fail_each_allocation("mcp", [&] {
    return brs_mcp_solve(w.context, matrix, q, lower, upper, 2, nullptr, z, nullptr, nullptr,
                         nullptr);
  });
  EXPECT_NEAR(z[1], 1.0, 1e-12);
}

TEST(Memory, RunningOutWhileAConstraintIsAddedAddsNone) {
  World w;
  std::int32_t first = -1, last = -1;
  w.good(brs_scene_add_fixed(w.scene, "x", w.base.data(), 9, BRS_AXES, &first));
  fail_each_allocation("fixed", [&] {
    return brs_scene_add_fixed(w.scene, "a name that is too long for the string itself",
                               w.base.data(), 9, BRS_AXES, &last);
  });
  w.good(brs_stepper_destroy(w.stepper));
  w.stepper = nullptr;
  w.good(brs_stepper_create(w.scene, nullptr, &w.stepper));
}

}  // namespace
}  // namespace brainshift::test
