// Steps in time, the phases of a solve, the time limit, threads and the log.
#include <cstring>
#include <limits>

#include "brainshift/stepper.hpp"
#include "world.hpp"

namespace brainshift::test {
namespace {

class Solves : public testing::Test {
 protected:
  World w, other;
  brs_solve_report report;
  Solves() { brs_solve_report_init(&report, sizeof report); }

  std::int32_t phase() const {
    std::int32_t now = -1;
    w.good(brs_stepper_phase(w.stepper, &now));
    return now;
  }
  // The loop of the header, to its end.
  std::int32_t run_phases() const {
    std::int32_t now = phase();
    while (now == BRS_PHASE_BEGUN || now == BRS_PHASE_UPDATED) {
      w.good(brs_stepper_linearise(w.stepper));
      w.good(brs_stepper_solve(w.stepper));
      EXPECT_GE(brs_stepper_update(w.stepper, &now), 0) << w.message();
    }
    return now;
  }
};

TEST_F(Solves, PhaseByPhaseEndAtTheSameBits) {
  other.good(other.solve_after_loss(5000.0));
  w.good(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_LOST_VOLUME, 5000.0));
  w.good(brs_stepper_begin_static(w.stepper));
  EXPECT_EQ(phase(), BRS_PHASE_BEGUN);
  ASSERT_EQ(run_phases(), BRS_PHASE_CONVERGED);
  EXPECT_EQ(w.field(BRS_FIELD_ITERATE), other.field(BRS_FIELD_DISPLACEMENT));
  for (double u : w.field(BRS_FIELD_DISPLACEMENT)) EXPECT_EQ(u, 0.0);  // not yet
  w.good(brs_stepper_progress_report(w.stepper, &report));
  EXPECT_EQ(report.status, BRS_OK);
  w.good(brs_stepper_accept(w.stepper, &report));
  EXPECT_GT(report.iterations, 0);
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), other.field(BRS_FIELD_DISPLACEMENT));
  EXPECT_EQ(phase(), BRS_PHASE_IDLE);
}

TEST_F(Solves, AnAccuracyGivesTheTolerancesOfTheCppFace) {
  brs_stepper_options options;
  w.good(brs_stepper_options_init(&options, sizeof options));
  options.max_iterations = 17;
  w.good(brs_stepper_options_within(w.mesh, 0.5, &options));
  const StepperOptions loose = within(0.5, Mesh(w.block.points, w.block.tets));
  EXPECT_EQ(options.residual_tolerance, loose.residual_tolerance);
  EXPECT_EQ(options.complementarity_tolerance, loose.complementarity_tolerance);
  EXPECT_EQ(options.correction_tolerance, loose.correction_tolerance);
  EXPECT_EQ(options.max_iterations, 17);
  const brs_stepper_options before = options;
  for (const double accuracy : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(brs_stepper_options_within(w.mesh, accuracy, &options), BRS_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(w.message().find("accuracy"), std::string::npos) << w.message();
    EXPECT_EQ(std::memcmp(&options, &before, sizeof options), 0);
  }
}

TEST_F(Solves, MemoryIsKnownBeforeTheyBeginAndWhateverHasBeenDone) {
  brs_memory_estimate before, now;
  w.good(brs_memory_estimate_init(&before, sizeof before));
  w.good(brs_memory_estimate_init(&now, sizeof now));
  w.good(brs_stepper_memory_estimate(w.stepper, &before));
  EXPECT_GT(before.factor, 0);
  EXPECT_GT(before.border, 0);   // for contacts
  EXPECT_GT(before.compliance, 0);
  EXPECT_GT(before.rest, 0);
  EXPECT_EQ(before.total, before.factor + before.border + before.compliance + before.rest);
  const auto expect_the_same = [&](const char* when) {
    w.good(brs_stepper_memory_estimate(w.stepper, &now));
    EXPECT_EQ(now.total, before.total) << when;
    EXPECT_EQ(now.factor, before.factor) << when;
  };
  w.good(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_LOST_VOLUME, 5000.0));
  w.good(brs_stepper_begin_static(w.stepper));
  expect_the_same("begun");
  ASSERT_EQ(run_phases(), BRS_PHASE_CONVERGED);
  expect_the_same("converged");
  w.good(brs_stepper_accept(w.stepper, nullptr));
  expect_the_same("after the solve");
  other.good(other.solve_after_loss(5000.0));   // which nobody has asked for its memory
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), other.field(BRS_FIELD_DISPLACEMENT));
}

TEST_F(Solves, PhasesOutOfOrderAreRefusedByName) {
  const double* values = nullptr;
  EXPECT_EQ(brs_stepper_linearise(w.stepper), BRS_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(w.message().find("begun"), std::string::npos) << w.message();
  EXPECT_EQ(brs_stepper_reject(w.stepper), BRS_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(brs_stepper_accept(w.stepper, nullptr), BRS_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(brs_stepper_progress_report(w.stepper, &report), BRS_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(brs_stepper_field(w.stepper, BRS_FIELD_ITERATE, &values, nullptr, nullptr),
            BRS_ERROR_INVALID_ARGUMENT);
  w.good(brs_stepper_begin_static(w.stepper));
  EXPECT_EQ(brs_stepper_begin_step(w.stepper, 0.1), BRS_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(brs_stepper_solve_static(w.stepper, nullptr), BRS_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(brs_stepper_restore(w.stepper, w.snapshot), BRS_ERROR_INVALID_ARGUMENT);
  w.good(brs_stepper_reject(w.stepper));
  w.good(brs_stepper_restore(w.stepper, w.snapshot));
}

TEST_F(Solves, AStepThatIsCancelledInAPhaseLeavesTheStateAsItWas) {
  w.good(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_LOST_VOLUME, 5000.0));
  w.good(brs_context_set_cancel(w.context, 1));
  w.good(brs_stepper_begin_static(w.stepper));
  w.good(brs_stepper_linearise(w.stepper));
  w.good(brs_stepper_solve(w.stepper));
  std::int32_t now = -1;
  EXPECT_EQ(brs_stepper_update(w.stepper, &now), BRS_CANCELLED);
  EXPECT_EQ(now, BRS_PHASE_FAILED);
  EXPECT_NE(w.message(), "");
  w.good(brs_stepper_reject(w.stepper));
  for (double u : w.field(BRS_FIELD_DISPLACEMENT)) EXPECT_EQ(u, 0.0);
}

TEST_F(Solves, InTimeMoveWithInertiaAndComeToTheStaticBalance) {
  other.good(other.solve_after_loss(5000.0));
  const std::vector<double> balance = other.field(BRS_FIELD_DISPLACEMENT);
  w.good(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_LOST_VOLUME, 5000.0));
  w.good(brs_stepper_set_damping(w.stepper, 20.0, 0.0));
  w.good(brs_stepper_step(w.stepper, 0.01, &report));
  EXPECT_GT(report.kinetic_energy, 0.0);
  double fastest = 0.0;
  for (double v : w.field(BRS_FIELD_VELOCITY)) fastest = std::max(fastest, std::abs(v));
  EXPECT_GT(fastest, 0.0);
  // v1 = (u1 - u0) / dt from rest, to the rounding of the product
  const std::vector<double> u = w.field(BRS_FIELD_DISPLACEMENT), v = w.field(BRS_FIELD_VELOCITY);
  for (std::size_t i = 0; i < u.size(); ++i) EXPECT_NEAR(0.01 * v[i], u[i], 1e-12);
  for (int i = 0; i < 5; ++i) w.good(brs_stepper_step(w.stepper, 1e3, nullptr));
  const std::vector<double> end = w.field(BRS_FIELD_DISPLACEMENT);
  // a very long step ends where statics does, to the tolerance of the corrections
  for (std::size_t i = 0; i < end.size(); ++i) EXPECT_NEAR(end[i], balance[i], 1e-5);
}

TEST_F(Solves, InTimeRefuseWhatMakesNoSense) {
  for (double dt : {0.0, -1.0, double(NAN), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(brs_stepper_step(w.stepper, dt, nullptr), BRS_ERROR_INVALID_ARGUMENT) << dt;
    EXPECT_EQ(brs_stepper_begin_step(w.stepper, dt), BRS_ERROR_INVALID_ARGUMENT) << dt;
  }
  EXPECT_EQ(brs_stepper_set_damping(w.stepper, -1.0, 0.0), BRS_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(brs_stepper_set_damping(w.stepper, NAN, 0.0), BRS_ERROR_NOT_FINITE);
  const double one[3] = {1.0, 2.0, 3.0};
  EXPECT_EQ(brs_stepper_set_velocity(w.stepper, one, 1), BRS_ERROR_SIZE_MISMATCH);
  EXPECT_EQ(brs_stepper_set_velocity(w.stepper, nullptr, 64), BRS_ERROR_NULL);
  std::vector<double> all(std::size_t(3 * w.block.points.rows()), 1.5);
  w.good(brs_stepper_set_velocity(w.stepper, all.data(), w.block.points.rows()));
  EXPECT_EQ(w.field(BRS_FIELD_VELOCITY), all);
}

TEST_F(Solves, StopAtTheTimeLimitAndSayWhichItWas) {
  brs_stepper_options options;
  brs_stepper_options_init(&options, sizeof options);
  options.time_limit = 0.0;
  brs_stepper* late = nullptr;
  w.good(brs_stepper_create(w.scene, &options, &late));
  std::swap(late, w.stepper);
  brs_stepper_destroy(late);
  EXPECT_EQ(w.solve_after_loss(5000.0, &report), BRS_CANCELLED);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_NE(w.message().find("time limit of 0 s"), std::string::npos) << w.message();
  for (double u : w.field(BRS_FIELD_DISPLACEMENT)) EXPECT_EQ(u, 0.0);
  options.time_limit = NAN;
  EXPECT_EQ(brs_stepper_create(w.scene, &options, &late), BRS_ERROR_INVALID_ARGUMENT);
  options.time_limit = 1.0;
  options.threads = -1;
  EXPECT_EQ(brs_stepper_create(w.scene, &options, &late), BRS_ERROR_INVALID_ARGUMENT);
}

TEST_F(Solves, OnThreadsOfTheContextGiveTheSameBits) {
  EXPECT_EQ(brs_context_set_threads(w.context, 0), BRS_ERROR_INVALID_ARGUMENT);
  w.good(brs_context_set_threads(w.context, 3));
  brs_stepper_destroy(w.stepper);
  w.good(brs_stepper_create(w.scene, nullptr, &w.stepper));
  w.good(w.solve_after_loss(5000.0));
  other.good(other.solve_after_loss(5000.0));
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), other.field(BRS_FIELD_DISPLACEMENT));
}

struct Log {
  World* w;
  std::vector<std::pair<brs_status, std::string>> lines;
  bool throws = false;

  static void hear(brs_status status, const char* text, void* user) {
    Log& log = *static_cast<Log*>(user);
    log.lines.emplace_back(status, text);
    EXPECT_EQ(brs_stepper_solve_static(log.w->stepper, nullptr), BRS_ERROR_BUSY);
    if (log.throws) throw std::runtime_error("oops");
  }
};

TEST_F(Solves, AreHeardByTheLogWhichMayNeitherEnterNorFail) {
  Log log{&w, {}, false};
  w.good(brs_context_set_log(w.context, &Log::hear, &log));
  w.good(w.solve_after_loss(5000.0));
  ASSERT_EQ(log.lines.size(), 1u);
  EXPECT_EQ(log.lines[0].first, BRS_OK);
  EXPECT_EQ(log.lines[0].second.find("converged: residual"), 0u) << log.lines[0].second;
  EXPECT_EQ(w.message(), "");
  log.throws = true;
  EXPECT_EQ(brs_stepper_set_enabled(w.stepper, 77, 1), BRS_ERROR_INVALID_ARGUMENT);
  ASSERT_EQ(log.lines.size(), 2u);
  EXPECT_EQ(log.lines[1].first, BRS_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(log.lines[1].second, w.message());
  EXPECT_NE(w.message().find("77"), std::string::npos) << w.message();
  w.good(w.solve_after_loss(4000.0));
  EXPECT_EQ(log.lines.size(), 3u);
  w.good(brs_context_set_log(w.context, nullptr, nullptr));
  w.good(w.solve_after_loss(5000.0));
  EXPECT_EQ(log.lines.size(), 3u);
}

TEST_F(Solves, NeedWhatTheSettingsCheckAsksFor) {
  w.good(brs_stepper_check_settings(w.stepper));
  w.good(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_LOST_VOLUME, 1e9));
  const brs_status checked = brs_stepper_check_settings(w.stepper);
  EXPECT_EQ(checked, brs_stepper_solve_static(w.stepper, nullptr));
  EXPECT_EQ(checked, BRS_ERROR_FLUID_VOLUME);
}

}  // namespace
}  // namespace brainshift::test
