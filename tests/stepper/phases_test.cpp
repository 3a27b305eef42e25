// A solve driven phase by phase: the same bits as in one call, and every call in its place.
#include <functional>
#include <stdexcept>

#include <gtest/gtest.h>

#include "brainshift/brainshift.hpp"
#include "support/expect_error.hpp"
#include "support/scenes.hpp"

namespace brainshift {
namespace {

using test::expect_error;
using test::same_bits;

Scene busy_scene() { return test::busy_scene(3, 0.3); }

DeviceId insert_cannula(Stepper& stepper) {
  return stepper.insert(make_device("cannula", 40.0), {Vec3(14.3, 15.7, 9.1), Vec3::UnitZ()},
                        {0.0, 38.0, false});
}

// The loop of the header.
void run(Stepper& stepper) {
  while (stepper.phase() == StepPhase::begun || stepper.phase() == StepPhase::updated) {
    stepper.linearise();
    stepper.solve();
    stepper.update();
  }
}

TEST(Phases, ByHandGiveTheSameBitsAsInOneCall) {
  Stepper whole(busy_scene()), parts(busy_scene());
  DeviceId id = -1;
  for (Stepper* s : {&whole, &parts}) id = insert_cannula(*s);
  const auto compare = [&](const SolveReport& a, const SolveReport& b) {
    ASSERT_TRUE(a.converged()) << a.message;
    EXPECT_TRUE(same_bits(whole.displacement(), parts.displacement()));
    EXPECT_TRUE(same_bits(whole.velocity(), parts.velocity()));
    EXPECT_TRUE(same_bits(whole.contact(0).force, parts.contact(0).force));
    EXPECT_TRUE(same_bits(whole.device(id).nodes, parts.device(id).nodes));
    EXPECT_EQ(a.residual, b.residual);
    EXPECT_EQ(a.energy, b.energy);
    EXPECT_EQ(a.kinetic_energy, b.kinetic_energy);
    EXPECT_EQ(a.iterations, b.iterations);
    EXPECT_EQ(a.factorisations, b.factorisations);
    EXPECT_EQ(a.load_steps, b.load_steps);
    EXPECT_EQ(b.load_factor, 1.0);
  };
  for (double lost : {2000.0, 9000.0}) {
    for (Stepper* s : {&whole, &parts}) s->csf().set_lost_volume(0, lost);
    const SolveReport a = whole.solve_static();
    parts.begin_static();
    run(parts);
    ASSERT_EQ(parts.phase(), StepPhase::converged);
    compare(a, parts.accept());
  }
  for (Stepper* s : {&whole, &parts}) {
    s->csf().set_lost_volume(0, 3000.0);
    s->set_damping({1.0, 0.001});
  }
  for (int i = 0; i < 3; ++i) {
    const SolveReport a = whole.step(0.02);
    parts.begin_step(0.02);
    run(parts);
    ASSERT_EQ(parts.phase(), StepPhase::converged);
    compare(a, parts.accept());
  }
}

TEST(Phases, AFailureByHandIsTheFailureOfOneCall) {
  Scene scene = busy_scene();
  scene.materials = {{0, Material(Law::st_venant_kirchhoff, 6.0, 0.45, test::tissue_density)}};
  StepperOptions options;
  options.smallest_load_step = 1.0 / 32.0;
  Stepper whole(scene, options), parts(scene, options);
  for (Stepper* s : {&whole, &parts}) {
    s->csf().set_lost_volume(0, 9000.0);
    s->set_gravity(standard_gravity * Vec3(6.0, -1.0, -18.0));
  }
  const SolveReport a = whole.solve_static();
  parts.begin_static();
  run(parts);
  ASSERT_EQ(parts.phase(), StepPhase::failed);
  const SolveReport b = parts.progress_report();
  parts.reject();
  EXPECT_FALSE(a.converged());
  EXPECT_GT(a.load_factor, 0.0);  // some load steps were taken
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.message, b.message);
  EXPECT_EQ(a.load_factor, b.load_factor);
  EXPECT_EQ(a.load_steps, b.load_steps);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ(a.residual, b.residual);
}

TEST(Phases, ShowTheIterateAndKeepTheState) {
  Stepper stepper(busy_scene());
  stepper.csf().set_lost_volume(0, 9000.0);
  const Points before = stepper.displacement();
  stepper.begin_static();
  EXPECT_EQ(stepper.phase(), StepPhase::begun);
  EXPECT_TRUE(same_bits(stepper.iterate(), before));
  EXPECT_EQ(stepper.progress_report().status, Status::not_converged);
  EXPECT_EQ(stepper.progress_report().load_factor, 0.0);
  EXPECT_GT(stepper.progress_report().residual, 1e-8);
  stepper.linearise();
  EXPECT_EQ(stepper.phase(), StepPhase::linearised);
  stepper.solve();
  EXPECT_EQ(stepper.phase(), StepPhase::solved);
  EXPECT_EQ(stepper.update(), StepPhase::updated);
  EXPECT_EQ(stepper.progress_report().iterations, 1);
  EXPECT_FALSE(same_bits(stepper.iterate(), before));
  EXPECT_TRUE(same_bits(stepper.displacement(), before));
  run(stepper);
  EXPECT_TRUE(same_bits(stepper.displacement(), before));
  const Points found = stepper.iterate();
  const SolveReport report = stepper.accept();
  EXPECT_TRUE(report.converged());
  EXPECT_GT(report.seconds, 0.0);
  EXPECT_TRUE(same_bits(stepper.displacement(), found));
  EXPECT_EQ(stepper.phase(), StepPhase::idle);
}

TEST(Phases, RejectGivesTheIterateUpAtAnyTime) {
  Stepper stepper(busy_scene()), fresh(busy_scene());
  for (Stepper* s : {&stepper, &fresh}) s->csf().set_lost_volume(0, 9000.0);
  const Points before = stepper.displacement();
  for (int calls = 0; calls < 5; ++calls) {
    stepper.begin_static();
    if (calls > 0) stepper.linearise();
    if (calls > 1) stepper.solve();
    if (calls > 2) stepper.update();
    if (calls > 3) run(stepper);
    stepper.reject();
    EXPECT_EQ(stepper.phase(), StepPhase::idle);
    EXPECT_TRUE(same_bits(stepper.displacement(), before));
  }
  ASSERT_TRUE(stepper.solve_static().converged());
  ASSERT_TRUE(fresh.solve_static().converged());
  EXPECT_TRUE(same_bits(stepper.displacement(), fresh.displacement()));
}

TEST(Phases, ACallOutOfOrderNamesThePhaseItNeeds) {
  Stepper stepper(busy_scene());
  stepper.csf().set_lost_volume(0, 9000.0);
  const auto refused = [](const std::string& call, const std::string& needs, auto&& function) {
    expect_error(ErrorCode::invalid_argument, {call + "()", needs}, function);
  };
  const std::vector<std::pair<std::string, std::function<void()>>> calls = {
      {"linearise", [&] { stepper.linearise(); }},
      {"solve", [&] { stepper.solve(); }},
      {"update", [&] { stepper.update(); }},
      {"accept", [&] { stepper.accept(); }},
      {"begin_static", [&] { stepper.begin_static(); }},
      {"begin_step", [&] { stepper.begin_step(0.1); }}};
  const auto only = [&](const std::string& allowed, const std::string& phase) {
    for (const auto& [name, call] : calls) {
      if (allowed.find(name) != std::string::npos) continue;
      refused(name, phase, call);
    }
    EXPECT_EQ(to_string(stepper.phase()), phase);
  };
  only("begin_static begin_step", "idle");
  refused("reject", "idle", [&] { stepper.reject(); });
  refused("progress_report", "idle", [&] { stepper.progress_report(); });
  refused("iterate", "idle", [&] { stepper.iterate(); });
  stepper.begin_static();
  only("linearise", "begun");
  refused("begin_static", "idle", [&] { stepper.solve_static(); });
  refused("begin_step", "idle", [&] { stepper.step(0.1); });
  stepper.linearise();
  only("solve", "linearised");
  stepper.solve();
  only("update", "solved");
  stepper.update();
  only("linearise", "updated");
  run(stepper);
  only("accept", "converged");
  stepper.accept();
}

TEST(Phases, AnOpenSolveTakesNoNewStateAndNoNewSettings) {
  Stepper stepper(busy_scene()), fresh(busy_scene());
  for (Stepper* s : {&stepper, &fresh}) s->csf().set_lost_volume(0, 4000.0);
  const auto kept = stepper.snapshot();
  stepper.begin_static();
  const auto refused = [&](const std::string& call, auto&& function) {
    expect_error(ErrorCode::invalid_argument, {call + "()", "idle"}, function);
  };
  refused("restore", [&] { stepper.restore(kept); });
  refused("set_velocity", [&] { stepper.set_velocity(stepper.velocity()); });
  refused("insert", [&] { insert_cannula(stepper); });
  refused("remove", [&] { stepper.remove(0); });
  refused("set_friction", [&] { stepper.set_friction(0, 0.1); });
  refused("set_hold", [&] { stepper.set_hold(0, {0.0, 1.0, false}); });
  refused("exchange", [&] { stepper.exchange(0, make_device("3389", 40.0), {0.0, 1.0, false}); });
  stepper.csf().set_lost_volume(0, 9000.0);  // of the next begin
  stepper.set_gravity(Vec3(0, 0, -5000.0));
  run(stepper);
  ASSERT_TRUE(stepper.accept().converged());
  ASSERT_TRUE(fresh.solve_static().converged());
  EXPECT_TRUE(same_bits(stepper.displacement(), fresh.displacement()));
  EXPECT_TRUE(same_bits(stepper.gravity_force(), fresh.gravity_force()));
  EXPECT_EQ(stepper.csf().amount(0), 9000.0);
  fresh.csf().set_lost_volume(0, 9000.0);
  fresh.set_gravity(Vec3(0, 0, -5000.0));
  for (Stepper* s : {&stepper, &fresh}) ASSERT_TRUE(s->solve_static().converged());
  EXPECT_TRUE(same_bits(stepper.displacement(), fresh.displacement()));
}

TEST(Phases, AFailedSolveCanOnlyBeRejected) {
  StepperOptions options;
  options.progress = [](const Progress&) { return false; };
  Stepper stepper(busy_scene(), options);
  stepper.csf().set_lost_volume(0, 9000.0);
  stepper.begin_static();
  stepper.linearise();
  stepper.solve();
  EXPECT_EQ(stepper.update(), StepPhase::failed);
  EXPECT_EQ(stepper.progress_report().status, Status::cancelled);
  for (const std::function<void()>& call : std::vector<std::function<void()>>{
           [&] { stepper.linearise(); }, [&] { stepper.solve(); }, [&] { stepper.update(); },
           [&] { stepper.accept(); }, [&] { stepper.begin_static(); }}) {
    expect_error(ErrorCode::invalid_argument, {"failed"}, call);
  }
  stepper.reject();
  EXPECT_TRUE(stepper.displacement().isZero(0.0));
}

TEST(Phases, ACallbackThatThrowsOrMeddlesEndsTheSolveAlone) {
  Stepper* inside = nullptr;
  int way = 0;
  StepperOptions options;
  options.progress = [&](const Progress&) {
    if (way == 1) throw std::runtime_error("of the host");
    if (way == 2) inside->reject();
    if (way == 3) inside->solve_static();
    if (way == 4) inside->linearise();
    return true;
  };
  Stepper stepper(busy_scene(), options), fresh(busy_scene());
  inside = &stepper;
  for (Stepper* s : {&stepper, &fresh}) s->csf().set_lost_volume(0, 9000.0);
  way = 1;
  EXPECT_THROW(stepper.solve_static(), std::runtime_error);
  for (way = 2; way <= 4; ++way) {
    expect_error(ErrorCode::invalid_argument, {"a phase is being run"},
                 [&] { stepper.solve_static(); });
    EXPECT_EQ(stepper.phase(), StepPhase::idle);
  }
  way = 1;
  stepper.begin_static();
  stepper.linearise();
  stepper.solve();
  EXPECT_THROW(stepper.update(), std::runtime_error);
  EXPECT_EQ(stepper.phase(), StepPhase::failed);
  EXPECT_FALSE(stepper.progress_report().converged());
  stepper.reject();
  way = 0;
  for (Stepper* s : {&stepper, &fresh}) ASSERT_TRUE(s->solve_static().converged());
  EXPECT_TRUE(same_bits(stepper.displacement(), fresh.displacement()));
}

TEST(Phases, AnOpenSolveMovesWithItsStepper) {
  Stepper first(busy_scene()), fresh(busy_scene());
  for (Stepper* s : {&first, &fresh}) s->csf().set_lost_volume(0, 9000.0);
  first.begin_static();
  Stepper second = std::move(first);
  run(second);
  ASSERT_TRUE(second.accept().converged());
  ASSERT_TRUE(fresh.solve_static().converged());
  EXPECT_TRUE(same_bits(second.displacement(), fresh.displacement()));
}

}  // namespace
}  // namespace brainshift
