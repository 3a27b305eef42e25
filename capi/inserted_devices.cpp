// Devices that are inserted into a stepper.
#include "arrays.hpp"
#include "structs.hpp"

using namespace brainshift;
using namespace brainshift::capi;

namespace {

brs_hold hold_defaults() {
  const Hold d;
  return {sizeof(brs_hold), d.rigid_from, d.anchor, d.slack, d.clamped ? 1 : 0};
}

Hold hold_of(const brs_hold* given) {
  const brs_hold h = read(given, hold_defaults(), "hold");
  return {h.rigid_from, h.anchor, h.clamped != 0, h.slack};
}

brs_track_options track_defaults() {
  const TrackOptions d;
  return {sizeof(brs_track_options), d.shear_bound, d.tip_bound, d.least_spacing,
          d.local_give ? 1 : 0};
}

TrackOptions track_of(const brs_track_options* given) {
  brs_track_options t = track_defaults();
  if (given) t = read(given, t, "options");
  return {t.shear_bound, t.tip_bound, t.least_spacing, t.local_give != 0};
}

brs_device_state state_of(const DeviceState& d) {
  const Vec3 &f = d.anchor_force, &b = d.bow_direction;
  return {sizeof(brs_device_state),
          d.name.c_str(),
          d.nodes.rows(),
          d.contact_centres.rows(),
          d.path.rows(),
          d.nodes.data(),
          view_of_frames(d.frames),
          d.contact_centres.data(),
          d.path.data(),
          d.path_arcs.data(),
          d.path_forces.data(),
          {f[0], f[1], f[2]},
          d.slide,
          d.bow,
          d.bow_arc,
          {b[0], b[1], b[2]},
          d.largest_tie_gap};
}

}  // namespace

brs_status brs_hold_init(brs_hold* hold, int64_t struct_size) {
  return init(hold, struct_size, hold_defaults());
}

brs_status brs_track_options_init(brs_track_options* options, int64_t struct_size) {
  return init(options, struct_size, track_defaults());
}

brs_status brs_stepper_insert(brs_stepper* stepper, brs_device* device, const double* tip,
                              const double* outward, const brs_hold* hold,
                              const brs_track_options* options, int32_t* id) {
  return guard(stepper, [&](brs_stepper& s) {
    const BeamDevice& model = checked(device).value;
    const Placement placement{vector3(tip, "tip"), vector3(outward, "outward")};
    int32_t& place = result(id, "id");
    place = s.value.insert(model, placement, hold_of(hold), track_of(options));
  });
}

brs_status brs_stepper_exchange(brs_stepper* stepper, int32_t id, brs_device* device,
                                const brs_hold* hold, double advance) {
  return guard(stepper, [&](brs_stepper& s) {
    s.value.exchange(id, checked(device).value, hold_of(hold), advance);
  });
}

brs_status brs_stepper_set_hold(brs_stepper* stepper, int32_t id, const brs_hold* hold) {
  return guard(stepper, [&](brs_stepper& s) { s.value.set_hold(id, hold_of(hold)); });
}

brs_status brs_stepper_set_friction(brs_stepper* stepper, int32_t id, double shear_bound,
                                    double tip_bound) {
  return guard(stepper, [&](brs_stepper& s) { s.value.set_friction(id, shear_bound, tip_bound); });
}

brs_status brs_stepper_remove_device(brs_stepper* stepper, int32_t id) {
  return guard(stepper, [&](brs_stepper& s) { s.value.remove(id); });
}

brs_status brs_device_state_init(brs_device_state* state, int64_t struct_size) {
  return init(state, struct_size, brs_device_state{});
}

brs_status brs_stepper_device(brs_stepper* stepper, int32_t id, brs_device_state* state) {
  return guard(stepper, [&](brs_stepper& s) {
    checked_size(state, "state");
    DeviceState found = s.value.device(id);
    DeviceState& kept = s.devices[id];
    kept = std::move(found);
    write(state, state_of(kept), "state");
  });
}

brs_status brs_stepper_device_model(brs_stepper* stepper, int32_t id, brs_device** device) {
  return create(stepper, device, "device", [&](brs_stepper& s) {
    return new brs_device(s.context, s.value.device_model(id));
  });
}
