// Stepper: options, settings, snapshots, bytes.
#include <functional>

#include "arrays.hpp"
#include "structs.hpp"

using namespace brainshift;
using namespace brainshift::capi;

namespace {

brs_stepper_options options_defaults() {
  const StepperOptions d;
  return {sizeof(brs_stepper_options),
          d.residual_tolerance,
          d.complementarity_tolerance,
          d.correction_tolerance,
          d.max_iterations,
          d.smallest_load_step,
          d.initial_penetration,
          0,
          d.time_limit};
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

std::function<bool(const Progress&)> progress_of(std::shared_ptr<Context> context) {
  return [context = std::move(context)](const Progress& p) { return keep_going(*context, p); };
}

StepperOptions options_of(const brs_stepper_options& given, std::shared_ptr<Context> context) {
  StepperOptions options;
  const int threads = checked_int(given.threads, "options->threads");
  options.threads = threads > 0 ? threads : context->threads;
  options.time_limit = given.time_limit;
  options.residual_tolerance = given.residual_tolerance;
  options.complementarity_tolerance = given.complementarity_tolerance;
  options.correction_tolerance = given.correction_tolerance;
  options.max_iterations = checked_int(given.max_iterations, "options->max_iterations");
  options.smallest_load_step = given.smallest_load_step;
  options.initial_penetration = given.initial_penetration;
  options.progress = progress_of(std::move(context));
  return options;
}

Bytes bytes_given(const std::uint8_t* bytes, std::int64_t count) {
  const Index size = checked_count(count, "bytes");
  require_array(bytes, count, "bytes");
  return Bytes(bytes, bytes + size);
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

brs_status brs_stepper_options_within(brs_mesh* mesh, double accuracy, brs_stepper_options* options) {
  return guard(mesh, [&](brs_mesh& m) {
    brs_stepper_options given = read(options, options_defaults(), "options");
    const StepperOptions loose = within(accuracy, m.value);
    given.residual_tolerance = loose.residual_tolerance;
    given.complementarity_tolerance = loose.complementarity_tolerance;
    given.correction_tolerance = loose.correction_tolerance;
    write(options, given, "options");
  });
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

brs_status brs_stepper_mesh(brs_stepper* stepper, brs_mesh** mesh) {
  return create(stepper, mesh, "mesh",
                [](brs_stepper& s) { return new brs_mesh(s.context, s.value.mesh()); });
}

brs_status brs_stepper_set_gravity(brs_stepper* stepper, const double* gravity) {
  return guard(stepper, [&](brs_stepper& s) { s.value.set_gravity(vector3(gravity, "gravity")); });
}

brs_status brs_stepper_set_damping(brs_stepper* stepper, double alpha, double beta) {
  return guard(stepper, [&](brs_stepper& s) { s.value.set_damping({alpha, beta}); });
}

brs_status brs_stepper_set_velocity(brs_stepper* stepper, const double* velocity, int64_t count) {
  return guard(stepper, [&](brs_stepper& s) {
    s.value.set_velocity(rows<Points>(velocity, count, "velocities"));
  });
}

brs_status brs_stepper_check_settings(brs_stepper* stepper) {
  return guard(stepper, [&](brs_stepper& s) { s.value.check_settings(); });
}

brs_status brs_stepper_set_enabled(brs_stepper* stepper, int32_t id, int32_t on) {
  return guard(stepper, [&](brs_stepper& s) { on ? s.value.enable(id) : s.value.disable(id); });
}

brs_status brs_stepper_set_csf(brs_stepper* stepper, int32_t compartment, int32_t law,
                               double amount) {
  return guard(stepper, [&](brs_stepper& s) { set_csf(s.value.csf(), compartment, law, amount); });
}

brs_status brs_stepper_snapshot(brs_stepper* stepper, brs_snapshot** snapshot) {
  return create(stepper, snapshot, "snapshot",
                [](brs_stepper& s) { return new brs_snapshot(s.context, s.value.snapshot()); });
}

brs_status brs_stepper_restore(brs_stepper* stepper, brs_snapshot* snapshot) {
  return guard(stepper, [&](brs_stepper& s) { s.value.restore(checked(snapshot).value); });
}

brs_status brs_snapshot_destroy(brs_snapshot* snapshot) { return destroy_immutable(snapshot); }

brs_status brs_snapshot_bytes(brs_snapshot* snapshot, uint8_t* bytes, int64_t capacity,
                              int64_t* count) {
  return guard(snapshot, [&](brs_snapshot& s) {
    const Bytes all = bytes_of(*s.value);
    write_list(all.data(), all.size(), bytes, capacity, count, "bytes");
  });
}

brs_status brs_stepper_read_snapshot(brs_stepper* stepper, const uint8_t* bytes, int64_t count,
                                     brs_snapshot** snapshot) {
  return create(stepper, snapshot, "snapshot", [&](brs_stepper& s) {
    return new brs_snapshot(s.context, s.value.read_snapshot(bytes_given(bytes, count)));
  });
}

brs_status brs_stepper_record(brs_stepper* stepper, uint8_t* bytes, int64_t capacity,
                              int64_t* count) {
  return guard(stepper, [&](brs_stepper& s) {
    const Bytes all = s.value.record();
    write_list(all.data(), all.size(), bytes, capacity, count, "bytes");
  });
}

brs_status brs_stepper_replay(brs_context* context, const uint8_t* bytes, int64_t count,
                              brs_stepper** stepper) {
  return create(context, stepper, "stepper", [&](brs_context& c) {
    return new brs_stepper(c.context,
                           Stepper::replay(bytes_given(bytes, count), progress_of(c.context)));
  });
}
