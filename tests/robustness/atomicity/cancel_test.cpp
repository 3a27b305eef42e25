// Cancelled at poll 1, 2, 3, ... until the solve is through: the state as it was each time, and the next
// good step that of an object that was never cancelled.
#include <functional>

#include "robustness/atomicity/world.hpp"

namespace brainshift::test {
namespace {

struct Cancelling {
  int polls = 0, allowed = 1 << 30;
  StepperOptions options() {
    StepperOptions result;
    result.progress = [this](const Progress&) { return ++polls < allowed; };
    return result;
  }
};

void cancel_at_each_poll(const char* name, const std::function<SolveReport(Stepper&)>& solve) {
  World untouched;
  const Points next = untouched.next();
  int cancelled = 0;
  for (int k = 1;; ++k) {
    Cancelling host;
    World w(host.options());
    const WorldState before(w.stepper);
    host.polls = 0;
    host.allowed = k;
    const SolveReport report = solve(w.stepper);
    host.allowed = 1 << 30;
    if (report.converged()) break;
    EXPECT_EQ(report.status, Status::cancelled);
    EXPECT_EQ(host.polls, k);
    EXPECT_LE(report.factorisations, 3 * k);  // polled in every iteration
    EXPECT_TRUE(WorldState(w.stepper) == before) << name << ", poll " << k;
    EXPECT_TRUE(same_bits(w.next(), next)) << name << ", poll " << k;
    ++cancelled;
  }
  std::printf("%s: cancelled at each of %d polls\n", name, cancelled);
  EXPECT_GT(cancelled, 2) << name;
}

TEST(Cancel, AtEveryPollOfASolve) {
  cancel_at_each_poll("solve_static", [](Stepper& s) { return s.solve_static(); });
}

TEST(Cancel, AtEveryPollOfAStep) {
  cancel_at_each_poll("step", [](Stepper& s) { return s.step(0.01); });
}

// What a callback throws goes through, and leaves the state, too.
TEST(Cancel, ACallbackThatThrows) {
  for (int k = 1; k < 4; ++k) {
    int polls = 0, thrown_at = 1 << 30;
    StepperOptions options;
    options.progress = [&](const Progress&) {
      if (++polls >= thrown_at) throw 17;
      return true;
    };
    World w(options);
    const WorldState before(w.stepper);
    polls = 0;
    thrown_at = k;
    EXPECT_THROW(w.stepper.solve_static(), int);
    thrown_at = 1 << 30;
    EXPECT_TRUE(WorldState(w.stepper) == before);
    World untouched;
    EXPECT_TRUE(same_bits(w.next(), untouched.next()));
  }
}

// A callback that wants more of the stepper it is called from is refused; the solve goes on.
TEST(Cancel, ACallbackThatCallsTheSolverIsRefused) {
  Stepper* stepper = nullptr;
  int refused = 0;
  StepperOptions options;
  options.progress = [&](const Progress&) {
    for (const auto& call : std::vector<std::function<void()>>{
             [&] { stepper->solve_static(); }, [&] { stepper->step(0.1); },
             [&] { stepper->reject(); }, [&] { stepper->remove(0); },
             [&] { stepper->restore(stepper->snapshot()); }}) {
      try {
        if (stepper) call();
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
        ++refused;
      }
    }
    return true;
  };
  World w(options), untouched;
  stepper = &w.stepper;
  EXPECT_TRUE(same_bits(w.next(), untouched.next()));
  EXPECT_GE(refused, 5);
}

}  // namespace
}  // namespace brainshift::test
