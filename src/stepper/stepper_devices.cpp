// Stepper: devices in and out, and what became of them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "brainshift/error.hpp"
#include "coupling/coupling.hpp"
#include "stepper/stepper_impl.hpp"
#include "text.hpp"

namespace brainshift {
namespace {

void check_hold(const Hold& hold, double length) {
  const auto bad = [](double arc) { return std::isnan(arc) || arc < 0.0; };
  if (bad(hold.rigid_from) || bad(hold.anchor)) {
    throw Error(ErrorCode::invalid_argument, "Hold: an arc length is negative or not a number");
  }
  const auto beyond = [&](double arc) { return std::isfinite(arc) && arc > length * (1.0 + 1e-9); };
  if (beyond(hold.rigid_from) || beyond(hold.anchor)) {
    throw Error(ErrorCode::invalid_argument,
                "Hold: an arc length lies beyond the device, which is " + text(length) +
                    " mm long");
  }
  if (!(hold.slack >= 0.0) || std::isinf(hold.slack)) {
    throw Error(ErrorCode::invalid_argument, "Hold: slack is negative or not finite");
  }
  if (std::isinf(hold.rigid_from) && std::isinf(hold.anchor)) {
    throw Error(ErrorCode::invalid_argument,
                "Hold: neither rigid_from nor anchor is given, so nothing holds the device");
  }
}

void check_friction(double shear_bound, double tip_bound) {
  if (!(shear_bound >= 0.0) || !(tip_bound >= 0.0)) {
    throw Error(ErrorCode::invalid_argument, "a bound of friction is negative or not a number");
  }
}

}  // namespace

DeviceId Stepper::insert(const BeamDevice& device, const Placement& placement, const Hold& hold,
                         const TrackOptions& options) {
  m_impl->refuse_when_begun("insert");
  check_hold(hold, device.length());
  check_friction(options.shear_bound, options.tip_bound);
  if (!(options.least_spacing > 0.0)) {
    throw Error(ErrorCode::invalid_argument, "TrackOptions: least_spacing must be positive");
  }
  if (!placement.tip.allFinite() || !(std::abs(placement.outward.norm() - 1.0) <= 1e-6)) {
    throw Error(ErrorCode::invalid_argument,
                "Placement: the tip must be finite and outward of unit length");
  }
  Impl::State& state = m_impl->m_state;
  const Vec3 outward = placement.outward.normalized();
  std::vector<PathPoint> path = cut_track(m_impl->m_mesh, positions(), placement.tip, outward,
                                          device.length(), options.least_spacing);
  InsertedDevice next =
      place_device(state.next_device, device, {placement.tip, outward}, hold, options, std::move(path));
  m_impl->set_give(positions(), next);
  state.devices.push_back(std::move(next));   // last: whatever fails before leaves the devices as they are
  return state.next_device++;
}

void Stepper::exchange(DeviceId id, const BeamDevice& device, const Hold& hold, double advance) {
  m_impl->refuse_when_begun("exchange");
  check_hold(hold, device.length());
  if (!(advance >= 0.0) || !std::isfinite(advance)) {
    throw Error(ErrorCode::invalid_argument, "exchange: advance is negative or not finite");
  }
  InsertedDevice& old = m_impl->device(id);
  Placement placement = old.placement;
  std::vector<PathPoint> path = old.path;
  std::vector<Vec3> multipliers = old.motion.multipliers;
  if (advance > 0.0) {
    placement.tip -= advance * placement.outward;
    path = extend_track(m_impl->m_mesh, positions(), placement.tip, placement.outward, advance,
                        old.options.least_spacing, old.path);
    multipliers.insert(multipliers.begin(), path.size() - old.path.size(), Vec3::Zero());
  }
  InsertedDevice next = place_device(id, device, placement, hold, old.options, std::move(path));
  next.motion.multipliers = std::move(multipliers);
  clamp_friction(next);   // its radius may be smaller
  m_impl->set_give(positions(), next);
  old = std::move(next);
}

void Stepper::set_hold(DeviceId id, const Hold& hold) {
  m_impl->refuse_when_begun("set_hold");
  check_hold(hold, m_impl->device(id).beam.device().length());
  m_impl->device(id).hold = hold;
}

void Stepper::set_friction(DeviceId id, double shear_bound, double tip_bound) {
  m_impl->refuse_when_begun("set_friction");
  check_friction(shear_bound, tip_bound);
  InsertedDevice& device = m_impl->device(id);
  device.options.shear_bound = shear_bound;
  device.options.tip_bound = tip_bound;
  clamp_friction(device);
}

void Stepper::remove(DeviceId id) {
  m_impl->refuse_when_begun("remove");
  const InsertedDevice& device = m_impl->device(id);
  auto& devices = m_impl->m_state.devices;
  devices.erase(devices.begin() + (&device - devices.data()));
}

const BeamDevice& Stepper::device_model(DeviceId id) const {
  return m_impl->device(id).beam.device();
}

DeviceState Stepper::device(DeviceId id) const {
  const InsertedDevice& d = m_impl->device(id);
  const Points& u = m_impl->m_state.u;
  const Mesh& mesh = m_impl->m_mesh;
  const BeamState& beam = d.motion.beam;
  DeviceState s;
  s.name = d.beam.device().name();
  s.nodes = beam.x;
  s.frames = beam.R;
  const auto& contacts = d.beam.device().contacts();
  s.contact_centres.resize(Eigen::Index(contacts.size()), 3);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    s.contact_centres.row(Eigen::Index(c)) =
        position(d.beam, beam, place_at(d.beam, contacts[c].centre())).transpose();
  }
  const auto points = Eigen::Index(d.path.size());
  s.path.resize(points, 3);
  s.path_arcs.setConstant(points, std::numeric_limits<double>::quiet_NaN());
  s.path_forces.setZero(points, 3);
  for (Eigen::Index p = 0; p < points; ++p) {
    s.path.row(p) = path_position(mesh, u, d.path[std::size_t(p)]).transpose();
  }
  const Coupling coupling(mesh, m_impl->m_state.devices, u);
  for (const CouplingRow& row : coupling.rows(u, coupling.motions())) {
    if (coupling.devices()[row.device].id != id) continue;
    if (row.bilateral()) s.largest_tie_gap = std::max(s.largest_tie_gap, std::abs(row.gap));
    if (row.kind == RowKind::anchor_across || row.one_sided()) continue;
    const auto p = Eigen::Index(row.point);
    const double multiplier = multiplier_of(d.motion, row);
    s.path_arcs[p] = arc_of(d.beam, row.place);
    s.path_forces.row(p) += (multiplier * row.direction).transpose();
  }
  // The skull holds what tissue does not: all coupling forces add up to the anchor's.
  s.anchor_force = s.path_forces.colwise().sum().transpose();
  const Index anchored = d.anchor_node();
  if (anchored >= 0) {
    const Vec3 hole = d.placement.tip + d.beam.device().arcs()[anchored] * d.placement.outward;
    s.slide = (beam.x.row(anchored).transpose() - hole).dot(d.placement.outward);
  }
  const double wire = std::isfinite(d.hold.anchor) ? d.hold.anchor : d.beam.device().length();
  const Bow bent = bow(d.beam, beam, 0.0, std::min(wire, d.beam.device().length()));
  s.bow = bent.size;
  s.bow_arc = bent.arc;
  s.bow_direction = bent.direction;
  return s;
}

}  // namespace brainshift
