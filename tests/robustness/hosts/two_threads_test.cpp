// One scene, two threads. A Stepper of C++ is an object like any other: whoever shares it locks it. The
// C face, whose hosts may not know, refuses the second thread.
#include <atomic>
#include <thread>

#include "capi/world.hpp"

namespace brainshift::test {
namespace {

// Runs `call` in the midst of a solve, from its progress callback.
std::int32_t in_between(const brs_progress*, void* call) {
  (*static_cast<std::function<void()>*>(call))();
  return 0;
}

TEST(Hosts, H2_the_same_scene_from_a_second_thread_is_busy) {
  World w, alone;
  int tried = 0;
  std::function<void()> second = [&] {
    std::thread([&] {
      ++tried;
      const double* values = nullptr;
      EXPECT_EQ(brs_stepper_solve_static(w.stepper, nullptr), BRS_ERROR_BUSY);
      EXPECT_EQ(brs_stepper_step(w.stepper, 0.1, nullptr), BRS_ERROR_BUSY);
      EXPECT_EQ(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_LOST_VOLUME, 1.0), BRS_ERROR_BUSY);
      EXPECT_EQ(brs_stepper_restore(w.stepper, w.snapshot), BRS_ERROR_BUSY);
      EXPECT_EQ(brs_stepper_field(w.stepper, BRS_FIELD_DISPLACEMENT, &values, nullptr, nullptr),
                BRS_ERROR_BUSY);
      EXPECT_EQ(brs_stepper_destroy(w.stepper), BRS_ERROR_BUSY);
    }).join();
  };
  w.good(brs_context_set_progress(w.context, in_between, &second));
  w.good(w.solve_after_loss(5000.0));
  EXPECT_GT(tried, 0);
  alone.good(alone.solve_after_loss(5000.0));
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), alone.field(BRS_FIELD_DISPLACEMENT));
}

// Both at once, again and again: each call is done whole or not at all.
TEST(Hosts, H2_two_threads_that_do_not_wait_for_each_other) {
  World w, alone;
  w.good(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_LOST_VOLUME, 5000.0));
  std::atomic<int> done{0}, other{0};
  const auto solve_often = [&] {
    for (int i = 0; i < 50; ++i) {
      const brs_status status = brs_stepper_solve_static(w.stepper, nullptr);
      if (status == BRS_OK) ++done;
      if (status != BRS_OK && status != BRS_ERROR_BUSY) ++other;
    }
  };
  std::thread a(solve_often), b(solve_often);
  a.join();
  b.join();
  EXPECT_GT(int(done), 0);
  EXPECT_EQ(int(other), 0);
  alone.good(brs_stepper_set_csf(alone.stepper, 0, BRS_CSF_LOST_VOLUME, 5000.0));
  for (int i = 0; i < done; ++i) alone.good(brs_stepper_solve_static(alone.stepper, nullptr));
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), alone.field(BRS_FIELD_DISPLACEMENT));
}

}  // namespace
}  // namespace brainshift::test
