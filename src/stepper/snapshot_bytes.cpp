// Snapshots as bytes: state and settings. What never changes in a stepper (mesh, constraint groups,
// compartments) is not among them but its fingerprint is.
#include <string>

#include "stepper/scene_bytes.hpp"
#include "stepper/stepper_impl.hpp"

namespace brainshift {
namespace {

void put(ByteWriter& w, const BeamDevice& device) {
  w.put(device.name());
  w.put(device.nodes());
  w.put(std::size_t(device.element_count()));
  for (Index e = 0; e < device.element_count(); ++e) {
    const BeamSection& s = device.section(e);
    for (double value : {s.axial, s.bending_2, s.bending_3, s.torsion, s.radius, s.shear,
                         s.line_density}) {
      w.put(value);
    }
  }
  w.put(device.contacts().size());
  for (const Contact& c : device.contacts()) {
    w.put(c.from);
    w.put(c.to);
  }
  for (const Mat3& frame : device.frames()) w.put(frame);
}

BeamDevice get_device(ByteReader& r) {
  auto name = r.get<std::string>();
  auto nodes = r.matrix<Points>();
  std::vector<BeamSection> sections(r.count(7 * 8));
  for (BeamSection& s : sections) {
    for (double* value : {&s.axial, &s.bending_2, &s.bending_3, &s.torsion, &s.radius, &s.shear,
                          &s.line_density}) {
      *value = r.get<double>();
    }
  }
  std::vector<Contact> contacts(r.count(2 * 8));
  for (Contact& c : contacts) {
    c.from = r.get<double>();
    c.to = r.get<double>();
  }
  std::vector<Mat3> frames(std::size_t(nodes.rows()));
  for (Mat3& frame : frames) frame = r.matrix<Mat3>();
  return BeamDevice(std::move(name), std::move(nodes), std::move(sections), std::move(contacts),
                    std::move(frames));
}

void put(ByteWriter& w, const InsertedDevice& d) {
  w.put(d.id);
  put(w, d.beam.device());
  w.put(d.placement.tip);
  w.put(d.placement.outward);
  for (double value : {d.hold.rigid_from, d.hold.anchor, d.hold.slack}) w.put(value);
  w.put(d.hold.clamped);
  w.put(d.options.local_give);
  for (double value : {d.options.shear_bound, d.options.tip_bound, d.options.least_spacing}) {
    w.put(value);
  }
  w.put(d.path.size());
  for (std::size_t p = 0; p < d.path.size(); ++p) {
    w.put(d.path[p].tet);
    w.put(d.path[p].weights);
    w.put(d.path[p].arc);
    w.put(d.path[p].length);
    w.put(d.path[p].give);
    w.put(d.path[p].spread);
    w.put(d.path[p].ring.size());
    for (const TetPoint& point : d.path[p].ring) {
      w.put(point.tet);
      w.put(point.weights);
    }
    w.put(d.motion.multipliers[p]);
  }
  w.put(d.motion.beam.x);
  for (const Mat3& frame : d.motion.beam.R) w.put(frame);
  w.put(d.motion.beam.turns);
  for (double force : d.motion.anchor) w.put(force);
  w.put(d.motion.velocity);
}

InsertedDevice get_inserted(ByteReader& r, const Mesh& mesh) {
  const auto id = r.get<DeviceId>();
  const BeamDevice model = get_device(r);
  Placement placement;
  placement.tip = r.matrix<Vec3>();
  placement.outward = r.matrix<Vec3>();
  Hold hold;
  for (double* value : {&hold.rigid_from, &hold.anchor, &hold.slack}) *value = r.get<double>();
  hold.clamped = r.get<bool>();
  TrackOptions options;
  options.local_give = r.get<bool>();
  for (double* value : {&options.shear_bound, &options.tip_bound, &options.least_spacing}) {
    *value = r.get<double>();
  }
  std::vector<PathPoint> path(r.count(15 * 8));
  std::vector<Vec3> multipliers(path.size());
  for (std::size_t p = 0; p < path.size(); ++p) {
    path[p].tet = r.get<Index>();
    if (path[p].tet < 0 || path[p].tet >= mesh.tet_count()) r.fail("a track leaves the mesh");
    path[p].weights = r.matrix<Eigen::Vector4d>();
    path[p].arc = r.get<double>();
    path[p].length = r.get<double>();
    path[p].give = r.get<double>();
    path[p].spread = r.get<double>();
    path[p].ring.resize(r.count(6 * 8));
    for (TetPoint& point : path[p].ring) {
      point.tet = r.get<Index>();
      if (point.tet < 0 || point.tet >= mesh.tet_count()) r.fail("a track leaves the mesh");
      point.weights = r.matrix<Eigen::Vector4d>();
    }
    multipliers[p] = r.matrix<Vec3>();
  }
  InsertedDevice d = place_device(id, model, placement, hold, options, std::move(path));
  d.motion.multipliers = std::move(multipliers);
  d.motion.beam.x = r.matrix<Points>();
  for (Mat3& frame : d.motion.beam.R) frame = r.matrix<Mat3>();
  d.motion.beam.turns = r.list<int>();
  for (double& force : d.motion.anchor) force = r.get<double>();
  d.motion.velocity = r.matrix<Points>();
  if (d.motion.beam.x.rows() != model.node_count() ||
      d.motion.velocity.rows() != model.node_count() ||
      Index(d.motion.beam.turns.size()) != model.element_count()) {
    r.fail("a device has another number of nodes");
  }
  return d;
}

void put(ByteWriter& w, const Settings& s) {
  w.put(s.gravity);
  w.put(s.damping.alpha);
  w.put(s.damping.beta);
  for (const ConstraintGroup& group : s.constraints.groups()) w.put(group.enabled);
  if (s.csf) put_fluid_settings(w, *s.csf);
}

// `like`: settings of the same constraints and compartments.
Settings get_settings(ByteReader& r, const Settings& like) {
  Settings s = like;
  s.gravity = r.matrix<Vec3>();
  s.damping.alpha = r.get<double>();
  s.damping.beta = r.get<double>();
  for (const ConstraintGroup& group : like.constraints.groups()) {
    r.get<bool>() ? s.constraints.enable(group.id) : s.constraints.disable(group.id);
  }
  if (s.csf) get_fluid_settings(r, *s.csf);
  return s;
}

std::uint64_t fingerprint(const Mesh& mesh, const Settings& settings) {
  ByteWriter w;
  put_mesh(w, mesh);
  w.put(settings.csf.has_value());
  if (settings.csf) put_fluid(w, *settings.csf);
  put_constraints(w, settings.constraints);
  return checksum(w.content().data(), w.content().size());
}

}  // namespace

Bytes bytes_of(const Stepper::Snapshot& s) {
  ByteWriter w;
  w.put(fingerprint(s.mesh, s.wanted));
  w.put(s.u);
  w.put(s.velocity);
  w.put(s.multipliers.size());
  for (const auto& [id, forces] : s.multipliers) {
    w.put(id);
    w.put(forces);
  }
  w.put(s.devices.size());
  for (const InsertedDevice& d : s.devices) put(w, d);
  w.put(s.next_device);
  put(w, s.wanted);
  put(w, s.solved);
  w.put(s.open_force);
  w.put(s.open_tie);
  return w.sealed(BytesKind::snapshot);
}

std::shared_ptr<const Stepper::Snapshot> Stepper::read_snapshot(const Bytes& bytes) const {
  ByteReader r(bytes, BytesKind::snapshot);
  const Mesh& mesh = m_impl->m_mesh;
  const Settings& like = m_impl->m_state.wanted;
  if (r.get<std::uint64_t>() != fingerprint(mesh, like)) {
    throw Error(ErrorCode::invalid_argument,
                "the snapshot is of another mesh, or of other constraints or compartments");
  }
  auto s = std::make_shared<Snapshot>(mesh);
  s->u = r.matrix<Points>();
  s->velocity = r.matrix<Points>();
  if (s->u.rows() != mesh.node_count() || s->velocity.rows() != mesh.node_count()) {
    r.fail("they hold another number of nodes");
  }
  for (std::size_t left = r.count(2 * 8); left > 0; --left) {
    const ConstraintGroup& group = like.constraints.group(r.get<ConstraintId>());
    auto forces = r.matrix<Eigen::VectorXd>();
    if (forces.size() != Eigen::Index(group.nodes.size())) {
      r.fail("constraint '" + group.name + "' has another number of nodes");
    }
    s->multipliers[group.id] = std::move(forces);
  }
  for (std::size_t left = r.count(8); left > 0; --left) {
    s->devices.push_back(get_inserted(r, mesh));
  }
  s->next_device = r.get<DeviceId>();
  s->wanted = get_settings(r, like);
  s->solved = get_settings(r, like);
  s->open_force = r.get<double>();
  s->open_tie = r.get<double>();
  r.expect_end();
  return s;
}

}  // namespace brainshift
