// Progress, cancel, and calls that come while another one runs.
#include <atomic>
#include <stdexcept>
#include <thread>

#include "world.hpp"

namespace brainshift::test {
namespace {

// What the callback of a test does, and what it saw.
struct Host {
  World w;
  int calls = 0;
  std::function<std::int32_t(const brs_progress&)> answer = [](const brs_progress&) { return 0; };

  Host() { w.good(brs_context_set_progress(w.context, &Host::callback, this)); }

  static std::int32_t callback(const brs_progress* progress, void* user) {
    Host& host = *static_cast<Host*>(user);
    ++host.calls;
    return host.answer(*progress);
  }

  void expect_untouched() {
    for (double u : w.field(BRS_FIELD_DISPLACEMENT)) EXPECT_EQ(u, 0.0);
  }
};

TEST(Progress, IsCalledAfterEveryNewtonIteration) {
  Host host;
  std::int64_t last = 0;
  host.answer = [&](const brs_progress& p) {
    EXPECT_EQ(p.struct_size, std::int64_t(sizeof p));
    EXPECT_GE(p.load_factor, 0.0);
    EXPECT_LE(p.load_factor, 1.0);
    last = p.iteration;
    return 0;
  };
  brs_solve_report report;
  brs_solve_report_init(&report, sizeof report);
  host.w.good(host.w.solve_after_loss(5000.0, &report));
  EXPECT_GT(host.calls, 0);
  EXPECT_EQ(last, report.iterations);
}

TEST(Progress, WhenItSaysStopTheSolveIsCancelledAndTheStateUnchanged) {
  Host host;
  host.answer = [](const brs_progress&) { return 7; };
  brs_solve_report report;
  brs_solve_report_init(&report, sizeof report);
  const std::vector<double> fluid = host.w.field(BRS_FIELD_FLUID_FORCE);
  EXPECT_EQ(host.w.solve_after_loss(5000.0, &report), BRS_CANCELLED);
  EXPECT_NE(host.w.message(), "");
  EXPECT_EQ(report.status, BRS_CANCELLED);
  EXPECT_EQ(host.calls, 1);
  EXPECT_EQ(host.w.field(BRS_FIELD_FLUID_FORCE), fluid);
  host.expect_untouched();
}

TEST(Progress, ThatThrowsEndsTheCallNotTheProgram) {
  Host host;
  host.answer = [](const brs_progress&) -> std::int32_t { throw std::runtime_error("oops"); };
  const std::vector<double> fluid = host.w.field(BRS_FIELD_FLUID_FORCE);
  EXPECT_EQ(host.w.solve_after_loss(5000.0), BRS_ERROR_CALLBACK);
  EXPECT_NE(host.w.message().find("callback"), std::string::npos);
  host.expect_untouched();
  EXPECT_EQ(host.w.field(BRS_FIELD_FLUID_FORCE), fluid);
  host.answer = [](const brs_progress&) { return 0; };
  EXPECT_EQ(host.w.solve_after_loss(5000.0), BRS_OK);
}

TEST(Progress, ThatThrowsAtAnyPollLeavesTheStateUnchanged) {
  Host host;
  int polls = 0;
  host.answer = [&](const brs_progress&) { return ++polls, 0; };
  host.w.good(host.w.solve_after_loss(5000.0));
  host.w.good(brs_stepper_restore(host.w.stepper, host.w.snapshot));
  ASSERT_GT(polls, 1);
  for (int poll = 1; poll <= polls; ++poll) {
    host.calls = 0;
    host.answer = [&](const brs_progress&) -> std::int32_t {
      if (host.calls == poll) throw poll;
      return 0;
    };
    EXPECT_EQ(host.w.solve_after_loss(5000.0), BRS_ERROR_CALLBACK) << "poll " << poll;
    EXPECT_EQ(host.calls, poll);
    host.expect_untouched();
  }
}

TEST(Progress, MayNotCallBackIntoItsContext) {
  Host host;
  World& w = host.w;
  host.answer = [&](const brs_progress&) {
    const double* values = nullptr;
    brs_mesh* mesh = nullptr;
    EXPECT_EQ(brs_stepper_solve_static(w.stepper, nullptr), BRS_ERROR_BUSY);
    EXPECT_NE(w.message().find("callback"), std::string::npos);
    EXPECT_EQ(brs_stepper_destroy(w.stepper), BRS_ERROR_BUSY);
    EXPECT_EQ(brs_context_destroy(w.context), BRS_ERROR_BUSY);
    EXPECT_EQ(brs_stepper_restore(w.stepper, w.snapshot), BRS_ERROR_BUSY);
    EXPECT_EQ(brs_stepper_field(w.stepper, 0, &values, nullptr, nullptr), BRS_ERROR_BUSY);
    EXPECT_EQ(brs_context_set_progress(w.context, nullptr, nullptr), BRS_ERROR_BUSY);
    EXPECT_EQ(brs_mesh_create(w.context, w.block.points.data(), w.block.points.rows(),
                              w.block.tets.data(), w.block.tets.rows(), nullptr, 0, &mesh),
              BRS_ERROR_BUSY);
    EXPECT_EQ(mesh, nullptr);
    return 0;
  };
  w.good(w.solve_after_loss(5000.0));
  const std::vector<double> u = w.field(BRS_FIELD_DISPLACEMENT);
  World undisturbed;
  undisturbed.good(undisturbed.solve_after_loss(5000.0));
  EXPECT_EQ(u, undisturbed.field(BRS_FIELD_DISPLACEMENT));
}

TEST(Progress, MayUseOtherContextsAndDestroyWhatNeverChanges) {
  Host host;
  World other;
  brs_snapshot* spare = nullptr;
  host.w.good(brs_stepper_snapshot(host.w.stepper, &spare));
  bool first = true;
  host.answer = [&](const brs_progress&) {
    if (!first) return 0;
    first = false;
    other.good(other.solve_after_loss(5000.0));
    EXPECT_EQ(brs_snapshot_destroy(spare), BRS_OK);
    EXPECT_EQ(brs_mesh_destroy(host.w.mesh), BRS_OK);  // the stepper keeps its own share
    host.w.mesh = nullptr;
    return 0;
  };
  host.w.good(host.w.solve_after_loss(5000.0));
  EXPECT_EQ(host.w.field(BRS_FIELD_DISPLACEMENT), other.field(BRS_FIELD_DISPLACEMENT));
}

TEST(Cancel, StaysUntilItIsWithdrawn) {
  World w;
  w.good(brs_context_set_cancel(w.context, 1));
  EXPECT_EQ(w.solve_after_loss(5000.0), BRS_CANCELLED);
  EXPECT_EQ(w.solve_after_loss(5000.0), BRS_CANCELLED);
  for (double u : w.field(BRS_FIELD_DISPLACEMENT)) EXPECT_EQ(u, 0.0);
  w.good(brs_context_set_cancel(w.context, 0));
  w.good(w.solve_after_loss(5000.0));
}

TEST(Cancel, FromAnotherThreadAtEveryPollLeavesTheStateUnchanged) {
  Host host;
  int polls = 0;
  host.answer = [&](const brs_progress&) { return ++polls, 0; };
  host.w.good(host.w.solve_after_loss(5000.0));
  host.w.good(brs_stepper_restore(host.w.stepper, host.w.snapshot));
  ASSERT_GT(polls, 1);
  // Cancel set during poll i is seen at poll i + 1; after the last one it comes too late.
  for (int poll = 1; poll < polls; ++poll) {
    host.calls = 0;
    host.answer = [&](const brs_progress&) {
      if (host.calls == poll)
        std::thread([&] { brs_context_set_cancel(host.w.context, 1); }).join();
      return 0;
    };
    EXPECT_EQ(host.w.solve_after_loss(5000.0), BRS_CANCELLED) << "poll " << poll;
    EXPECT_EQ(host.calls, poll);
    host.expect_untouched();
    host.w.good(brs_context_set_cancel(host.w.context, 0));
  }
}

// The same with a device and in time: nothing of tissue, fluid, device or velocity has moved.
TEST(Cancel, OfAStepWithADeviceAtEveryPollLeavesTheStateUnchanged) {
  Host host;
  World& w = host.w;
  const double tip[] = {15.0, 15.0, 8.0}, outward[] = {0.0, 0.0, 1.0};
  brs_hold hold;
  brs_device_state state;
  brs_hold_init(&hold, sizeof hold);
  brs_device_state_init(&state, sizeof state);
  hold.anchor = 20.0;
  std::int32_t id = -1;
  w.good(brs_stepper_insert(w.stepper, w.device, tip, outward, &hold, nullptr, &id));
  w.good(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_LOST_VOLUME, 5000.0));
  const auto snapshot_bytes = [&] {
    brs_snapshot* now = nullptr;
    std::int64_t count = 0;
    w.good(brs_stepper_snapshot(w.stepper, &now));
    w.good(brs_snapshot_bytes(now, nullptr, 0, &count));
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(count));
    w.good(brs_snapshot_bytes(now, bytes.data(), count, &count));
    brs_snapshot_destroy(now);
    return bytes;
  };
  const std::vector<std::uint8_t> before = snapshot_bytes();
  int polls = 1;
  for (int poll = 1; polls > 0 && poll < 100; ++poll) {
    host.calls = 0;
    host.answer = [&](const brs_progress&) { return host.calls == poll ? 1 : 0; };
    const brs_status status = brs_stepper_step(w.stepper, 0.02, nullptr);
    if (status == BRS_OK) break;   // it was over before this poll
    EXPECT_EQ(status, BRS_CANCELLED) << w.message();
    EXPECT_EQ(snapshot_bytes(), before) << "poll " << poll;
    polls = poll;
  }
  EXPECT_GT(polls, 1);
  EXPECT_NE(snapshot_bytes(), before);
}

TEST(Threads, ASecondOneIsRefusedWhileACallRuns) {
  Host host;
  std::atomic<brs_status> seen{BRS_OK};
  host.answer = [&](const brs_progress&) {
    std::thread([&] { seen = brs_stepper_solve_static(host.w.stepper, nullptr); }).join();
    return 0;
  };
  host.w.good(host.w.solve_after_loss(5000.0));
  EXPECT_EQ(seen, BRS_ERROR_BUSY);
}

TEST(Threads, ContextsAreIndependent) {
  World alone, first, second;
  alone.good(alone.solve_after_loss(5000.0));
  std::thread a([&] { first.good(first.solve_after_loss(5000.0)); });
  std::thread b([&] { second.good(second.solve_after_loss(5000.0)); });
  a.join();
  b.join();
  EXPECT_EQ(first.field(BRS_FIELD_DISPLACEMENT), alone.field(BRS_FIELD_DISPLACEMENT));
  EXPECT_EQ(second.field(BRS_FIELD_DISPLACEMENT), alone.field(BRS_FIELD_DISPLACEMENT));
}

}  // namespace
}  // namespace brainshift::test
