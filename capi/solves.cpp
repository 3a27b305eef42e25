// Stepper: solves, whole and phase by phase.
#include <charconv>
#include <cstdio>

#include "arrays.hpp"
#include "structs.hpp"

using namespace brainshift;
using namespace brainshift::capi;

namespace {

brs_status status_of(Status status) {
  switch (status) {
    case Status::converged: return BRS_OK;
    case Status::no_equilibrium: return BRS_NO_EQUILIBRIUM;
    case Status::not_converged: return BRS_NOT_CONVERGED;
    case Status::cancelled: return BRS_CANCELLED;
  }
  return BRS_ERROR_INTERNAL;
}

int64_t number_of(Definiteness tangent) {
  static_assert(int64_t(Definiteness::not_examined) == BRS_TANGENT_NOT_EXAMINED &&
                int64_t(Definiteness::positive_definite) == BRS_TANGENT_POSITIVE_DEFINITE &&
                int64_t(Definiteness::indefinite) == BRS_TANGENT_INDEFINITE);
  return int64_t(tangent);
}

brs_solve_report report_of(const SolveReport& r) {
  return {sizeof(brs_solve_report),
          status_of(r.status),
          r.residual,
          r.complementarity,
          r.violation,
          r.last_correction,
          r.smallest_jacobian,
          r.energy,
          r.load_factor,
          r.load_steps,
          r.iterations,
          r.factorisations,
          r.shifted_factorisations,
          r.active_contacts,
          r.seconds,
          r.seconds_assembly,
          r.seconds_factor,
          r.seconds_line_search,
          r.kinetic_energy,
          r.tie_gap,
          r.coupling_rows,
          r.coupling_rank,
          r.coupling_unique ? 1 : 0,
          number_of(r.tangent),
          r.blas_threads};
}

brs_memory_estimate memory_of(const MemoryEstimate& m) {
  return {sizeof(brs_memory_estimate), m.factor, m.border, m.compliance, m.rest, m.total};
}

// Four digits of a number, whatever the locale of the host; without memory.
struct Digits {
  char text[16] = {};
  explicit Digits(double value) {
    std::to_chars(text, text + sizeof text - 1, value, std::chars_format::general, 4);
  }
};

// What is said of a solve that has ended; needs no memory, for the state may have changed.
brs_status said(Context& context, const SolveReport& r) noexcept {
  if (!r.converged()) context.say(r.message.c_str());
  (void)std::snprintf(context.note, sizeof context.note,  // cut where it is too long
                "%s: residual %s, smallest det F %s, %d iterations, %d factorisations, %s s%s%s",
                to_string(r.status), Digits(r.residual).text, Digits(r.smallest_jacobian).text,
                r.iterations, r.factorisations, Digits(r.seconds).text, r.message.empty() ? "" : "; ",
                r.message.c_str());
  return status_of(r.status);
}

// Runs solve(stepper), which returns a report.
template <class Solve>
brs_status solved(brs_stepper* stepper, brs_solve_report* report, Solve&& solve) noexcept {
  return guard(stepper, [&](brs_stepper& s) {
    if (report) checked_size(report, "report");  // before the state changes
    const SolveReport found = solve(s.value);
    if (report) write(report, report_of(found), "report");
    return said(*s.context, found);
  });
}

int32_t number_of(StepPhase phase) {
  static_assert(int32_t(StepPhase::idle) == BRS_PHASE_IDLE &&
                int32_t(StepPhase::begun) == BRS_PHASE_BEGUN &&
                int32_t(StepPhase::linearised) == BRS_PHASE_LINEARISED &&
                int32_t(StepPhase::solved) == BRS_PHASE_SOLVED &&
                int32_t(StepPhase::updated) == BRS_PHASE_UPDATED &&
                int32_t(StepPhase::converged) == BRS_PHASE_CONVERGED &&
                int32_t(StepPhase::failed) == BRS_PHASE_FAILED);
  return int32_t(phase);
}

}  // namespace

brs_status brs_memory_estimate_init(brs_memory_estimate* estimate, int64_t struct_size) {
  return init(estimate, struct_size, memory_of(MemoryEstimate()));
}

brs_status brs_stepper_memory_estimate(brs_stepper* stepper, brs_memory_estimate* estimate) {
  return guard(stepper, [&](brs_stepper& s) {
    checked_size(estimate, "estimate");
    write(estimate, memory_of(s.value.memory_estimate()), "estimate");
  });
}

brs_status brs_solve_report_init(brs_solve_report* report, int64_t struct_size) {
  return init(report, struct_size, report_of(SolveReport()));
}

brs_status brs_stepper_solve_static(brs_stepper* stepper, brs_solve_report* report) {
  return solved(stepper, report, [](Stepper& s) { return s.solve_static(); });
}

brs_status brs_stepper_step(brs_stepper* stepper, double dt, brs_solve_report* report) {
  return solved(stepper, report, [dt](Stepper& s) { return s.step(dt); });
}

brs_status brs_stepper_begin_static(brs_stepper* stepper) {
  return guard(stepper, [](brs_stepper& s) { s.value.begin_static(); });
}

brs_status brs_stepper_begin_step(brs_stepper* stepper, double dt) {
  return guard(stepper, [dt](brs_stepper& s) { s.value.begin_step(dt); });
}

brs_status brs_stepper_linearise(brs_stepper* stepper) {
  return guard(stepper, [](brs_stepper& s) { s.value.linearise(); });
}

brs_status brs_stepper_solve(brs_stepper* stepper) {
  return guard(stepper, [](brs_stepper& s) { s.value.solve(); });
}

brs_status brs_stepper_update(brs_stepper* stepper, int32_t* phase) {
  return guard(stepper, [&](brs_stepper& s) -> brs_status {
    const StepPhase now = s.value.update();
    if (phase) *phase = number_of(now);
    return now == StepPhase::failed ? said(*s.context, s.value.progress_report()) : BRS_OK;
  });
}

brs_status brs_stepper_accept(brs_stepper* stepper, brs_solve_report* report) {
  return solved(stepper, report, [](Stepper& s) { return s.accept(); });
}

brs_status brs_stepper_reject(brs_stepper* stepper) {
  return guard(stepper, [](brs_stepper& s) { s.value.reject(); });
}

brs_status brs_stepper_phase(brs_stepper* stepper, int32_t* phase) {
  return guard(stepper,
               [&](brs_stepper& s) { result(phase, "phase") = number_of(s.value.phase()); });
}

brs_status brs_stepper_progress_report(brs_stepper* stepper, brs_solve_report* report) {
  return guard(stepper, [&](brs_stepper& s) {
    checked_size(report, "report");
    write(report, report_of(s.value.progress_report()), "report");
  });
}
