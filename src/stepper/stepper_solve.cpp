// Stepper: the phases of a solve, and the two solves that run through them.
#include <cmath>
#include <string>

#include "brainshift/error.hpp"
#include "stepper/stepper_impl.hpp"
#include "stepper/stopwatch.hpp"
#include "text.hpp"

namespace brainshift {

const char* to_string(StepPhase phase) {
  switch (phase) {
    case StepPhase::idle: return "idle";
    case StepPhase::begun: return "begun";
    case StepPhase::linearised: return "linearised";
    case StepPhase::solved: return "solved";
    case StepPhase::updated: return "updated";
    case StepPhase::converged: return "converged";
    case StepPhase::failed: return "failed";
  }
  return "unknown";
}

void Stepper::Impl::require(const char* call, std::initializer_list<StepPhase> needed) const {
  for (StepPhase p : needed) {
    if (p == phase() && !m_in_phase) return;  // before any allocation: reject() must not fail
  }
  std::string names;
  for (StepPhase p : needed) {
    names += (names.empty() ? "" : " or ") + std::string(to_string(p));
  }
  throw Error(
      ErrorCode::invalid_argument,
      std::string(call) + "() needs the phase " + names + ", and " +
          (m_in_phase ? "a phase is being run" : "it is " + std::string(to_string(phase()))));
}

void Stepper::Impl::refuse_when_begun(const char* call) const { require(call, {StepPhase::idle}); }

const Solve& Stepper::Impl::open(const char* call) const {
  if (m_open) return m_open->solve;
  throw Error(ErrorCode::invalid_argument,
              std::string(call) + "() needs a solve that is begun, and the phase is idle");
}

void Stepper::Impl::begin(const std::optional<double>& dt) {
  double seconds = 0.0;
  {
    const Stopwatch watch(seconds);
    Equilibrium trial = m_equilibrium;  // whatever fails leaves the present one as it is
    configure(trial, m_state.wanted);
    refuse_penetration(trial);
    if (!dt) trial.check_supported();
    std::optional<Motion> motion;
    if (dt) motion = Motion{*dt, m_state.wanted.damping, m_state.velocity};
    MechanicalState start = mechanical(trial.contacts());
    m_open.reset(new OpenSolve{
        m_state.wanted,
        Solve(std::move(trial), m_state.devices, std::move(start), m_options, m_cache, motion)});
  }
  m_farthest.reset();
  m_open->solve.seconds() += seconds;
}

template <class Phase>
void Stepper::Impl::run_phase(const char* call, std::initializer_list<StepPhase> needed,
                              Phase&& phase) {
  require(call, needed);
  const Stopwatch watch(m_open->solve.seconds());
  m_in_phase = true;
  try {
    phase(m_open->solve);
  } catch (...) {
    m_in_phase = false;
    m_open->solve.fail_by_exception(call);
    throw;
  }
  m_in_phase = false;
}

void Stepper::begin_static() {
  m_impl->require("begin_static", {StepPhase::idle});
  m_impl->begin(std::nullopt);
}

void Stepper::begin_step(double dt) {
  m_impl->require("begin_step", {StepPhase::idle});
  if (!(dt > 0.0) || !std::isfinite(dt)) {
    throw Error(ErrorCode::invalid_argument,
                "the time step dt = " + text(dt) + " s is not positive and finite");
  }
  m_impl->begin(dt);
}

void Stepper::linearise() {
  m_impl->run_phase("linearise", {StepPhase::begun, StepPhase::updated},
                    [](Solve& solve) { solve.linearise(); });
}

void Stepper::solve() {
  m_impl->run_phase("solve", {StepPhase::linearised}, [](Solve& solve) { solve.solve(); });
}

StepPhase Stepper::update() {
  m_impl->run_phase("update", {StepPhase::solved}, [](Solve& solve) { solve.update(); });
  return phase();
}

SolveReport Stepper::accept() {
  m_impl->require("accept", {StepPhase::converged});
  Impl::OpenSolve& open = *m_impl->m_open;
  SolveReport report = progress_report();
  Impl::State next = m_impl->solved(open);
  std::swap(m_impl->m_state, next);
  m_impl->m_equilibrium = std::move(open.solve.equilibrium());
  m_impl->m_open.reset();
  return report;
}

void Stepper::reject() {
  m_impl->require("reject", {StepPhase::begun, StepPhase::linearised, StepPhase::solved,
                             StepPhase::updated, StepPhase::converged, StepPhase::failed});
  if (phase() == StepPhase::failed) m_impl->m_farthest = m_impl->m_open->solve.take_farthest();
  m_impl->m_open.reset();
}

const Farthest& Stepper::farthest() const {
  if (m_impl->m_farthest) return *m_impl->m_farthest;
  throw Error(ErrorCode::invalid_argument,
              "farthest() needs a solve that has failed, and the last one has not");
}

StepPhase Stepper::phase() const { return m_impl->phase(); }

const SolveReport& Stepper::progress_report() const {
  return m_impl->open("progress_report").report();
}

const Points& Stepper::iterate() const { return m_impl->open("iterate").iterate(); }

namespace {

// The loop of the header's comment.
SolveReport run(Stepper& stepper) {
  try {
    while (stepper.phase() == StepPhase::begun || stepper.phase() == StepPhase::updated) {
      stepper.linearise();
      stepper.solve();
      stepper.update();
    }
    if (stepper.phase() == StepPhase::converged) return stepper.accept();
  } catch (...) {
    stepper.reject();
    throw;
  }
  SolveReport report = stepper.progress_report();
  stepper.reject();
  return report;
}

}  // namespace

SolveReport Stepper::solve_static() {
  begin_static();
  return run(*this);
}

SolveReport Stepper::step(double dt) {
  begin_step(dt);
  return run(*this);
}

}  // namespace brainshift
