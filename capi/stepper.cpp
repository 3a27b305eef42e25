// Stepper: settings, solve, snapshot.
#include <limits>

#include "arrays.hpp"
#include "structs.hpp"

using namespace brainshift;
using namespace brainshift::capi;

namespace {

brs_stepper_options options_defaults() {
  const StepperOptions d;
  return {sizeof(brs_stepper_options), d.residual_tolerance, d.complementarity_tolerance,
          d.correction_tolerance,      d.max_iterations,     d.smallest_load_step,
          d.initial_penetration};
}

// What StepperOptions::progress asks: shall the solve go on?
bool keep_going(const Context& context, const Progress& p) {
  if (context.cancel) return false;
  if (!context.progress) return true;
  const brs_progress progress{sizeof progress, p.load_factor, p.iteration, p.residual};
  try {
    return context.progress(&progress, context.user) == 0;
  } catch (...) {
    throw Refusal(BRS_ERROR_CALLBACK, "the progress callback let an exception out");
  }
}

StepperOptions options_of(const brs_stepper_options& given, std::shared_ptr<Context> context) {
  if (given.max_iterations < 0 || given.max_iterations > std::numeric_limits<int>::max())
    throw Refusal(BRS_ERROR_INVALID_ARGUMENT, "options->max_iterations is " +
                                                  std::to_string(given.max_iterations) +
                                                  ", negative or too large");
  StepperOptions options;
  options.residual_tolerance = given.residual_tolerance;
  options.complementarity_tolerance = given.complementarity_tolerance;
  options.correction_tolerance = given.correction_tolerance;
  options.max_iterations = int(given.max_iterations);
  options.smallest_load_step = given.smallest_load_step;
  options.initial_penetration = given.initial_penetration;
  options.progress = [context](const Progress& p) { return keep_going(*context, p); };
  return options;
}

brs_status status_of(Status status) {
  switch (status) {
    case Status::converged: return BRS_OK;
    case Status::no_equilibrium: return BRS_NO_EQUILIBRIUM;
    case Status::not_converged: return BRS_NOT_CONVERGED;
    case Status::cancelled: return BRS_CANCELLED;
  }
  return BRS_ERROR_INTERNAL;
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
          r.seconds_line_search};
}

void set_csf(Csf& csf, int32_t compartment, int32_t law, double amount) {
  switch (law) {
    case BRS_CSF_FULL: return csf.set_full(compartment);
    case BRS_CSF_OPEN: return csf.open(compartment);
    case BRS_CSF_LEVEL: return csf.set_level(compartment, amount);
    case BRS_CSF_LOST_VOLUME: return csf.set_lost_volume(compartment, amount);
    case BRS_CSF_AIR_VOLUME: return csf.set_air_volume(compartment, amount);
    default:
      throw Refusal(BRS_ERROR_INVALID_ARGUMENT,
                    "there is no law of the CSF with the number " + std::to_string(law));
  }
}

}  // namespace

brs_status brs_stepper_options_init(brs_stepper_options* options, int64_t struct_size) {
  return init(options, struct_size, options_defaults());
}

brs_status brs_stepper_create(brs_scene* scene, const brs_stepper_options* options,
                              brs_stepper** stepper) {
  return create(scene, stepper, "stepper", [&](brs_scene& s) {
    brs_stepper_options given = options_defaults();
    if (options) given = read(options, given, "options");
    Scene value = s.value;
    if (s.csf)
      value.csf.emplace(s.csf->density, s.csf->model, s.compartments, s.csf->reference_head);
    return new brs_stepper(s.context, Stepper(std::move(value), options_of(given, s.context)));
  });
}

brs_status brs_stepper_destroy(brs_stepper* stepper) { return destroy(stepper); }

brs_status brs_stepper_set_gravity(brs_stepper* stepper, const double* gravity) {
  return guard(stepper, [&](brs_stepper& s) { s.value.set_gravity(vector3(gravity, "gravity")); });
}

brs_status brs_stepper_set_enabled(brs_stepper* stepper, int32_t id, int32_t on) {
  return guard(stepper, [&](brs_stepper& s) { on ? s.value.enable(id) : s.value.disable(id); });
}

brs_status brs_stepper_set_csf(brs_stepper* stepper, int32_t compartment, int32_t law,
                               double amount) {
  return guard(stepper, [&](brs_stepper& s) { set_csf(s.value.csf(), compartment, law, amount); });
}

brs_status brs_solve_report_init(brs_solve_report* report, int64_t struct_size) {
  return init(report, struct_size, report_of(SolveReport()));
}

brs_status brs_stepper_solve_static(brs_stepper* stepper, brs_solve_report* report) {
  return guard(stepper, [&](brs_stepper& s) {
    if (report) checked_size(report, "report");  // before the state changes
    const SolveReport solved = s.value.solve_static();
    if (report) write(report, report_of(solved), "report");
    s.context->say(solved.message.c_str());
    return status_of(solved.status);
  });
}

brs_status brs_stepper_snapshot(brs_stepper* stepper, brs_snapshot** snapshot) {
  return create(stepper, snapshot, "snapshot",
                [](brs_stepper& s) { return new brs_snapshot(s.context, s.value.snapshot()); });
}

brs_status brs_stepper_restore(brs_stepper* stepper, brs_snapshot* snapshot) {
  return guard(stepper, [&](brs_stepper& s) { s.value.restore(checked(snapshot).value); });
}

brs_status brs_snapshot_destroy(brs_snapshot* snapshot) { return destroy_immutable(snapshot); }
