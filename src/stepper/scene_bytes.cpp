// Scenes as bytes, and recordings: a scene with the options and the state of its stepper.
#include "stepper/scene_bytes.hpp"

#include <algorithm>
#include <limits>

#include "stepper/stepper_impl.hpp"

namespace brainshift {
namespace {

// Groups may share a surface, which takes long to make: each is written once.
std::vector<Surface> surfaces_of(const ConstraintSet& set) {
  std::vector<Surface> all;
  for (const ConstraintGroup& group : set.groups()) {
    if (!group.surface) continue;
    const auto same = [&](const Surface& s) { return &s.points() == &group.surface->points(); };
    if (std::none_of(all.begin(), all.end(), same)) all.push_back(*group.surface);
  }
  return all;
}

void put(ByteWriter& w, const Surface& surface) {
  w.put(surface.is_cavity());
  w.put(surface.points());
  w.put(surface.triangles());
  w.put(surface.options().grid_spacing);
  w.put(surface.options().band);
}

Surface get_surface(ByteReader& r) {
  const bool cavity = r.get<bool>();
  auto points = r.matrix<Points>();
  auto triangles = r.matrix<Triangles>();
  SurfaceOptions options;
  options.grid_spacing = r.get<double>();
  options.band = r.get<double>();
  return cavity ? Surface::cavity(std::move(points), std::move(triangles), options)
                : Surface::sheet(std::move(points), std::move(triangles), options);
}

Mesh get_mesh(ByteReader& r) {
  auto nodes = r.matrix<Points>();
  auto tets = r.matrix<Tets>();
  auto edge_nodes = r.matrix<EdgeNodes>();
  auto regions = r.list<Index>();
  if (edge_nodes.rows() == 0) return Mesh(std::move(nodes), std::move(tets), std::move(regions));
  return Mesh::with_edge_nodes(std::move(nodes), std::move(tets), std::move(edge_nodes),
                               std::move(regions));
}

ConstraintId add_group(ByteReader& r, const std::vector<Surface>& surfaces, ConstraintSet& set) {
  const auto kind = r.get<ConstraintKind>();
  auto name = r.get<std::string>();
  auto nodes = r.list<Index>();
  auto partners = r.list<Index>();
  std::array<bool, 3> axes;
  for (bool& axis : axes) axis = r.get<bool>();
  auto values = r.matrix<Eigen::VectorXd>();   // stiffness or offsets
  auto normals = r.matrix<Points>();
  const auto side = r.get<double>();
  const auto surface = r.get<std::uint32_t>();
  switch (kind) {
    case ConstraintKind::fixed: return set.fix(std::move(name), std::move(nodes), axes);
    case ConstraintKind::tied:
      return set.tie(std::move(name), std::move(nodes), std::move(partners));
    case ConstraintKind::support:
      return set.support(std::move(name), std::move(nodes), std::move(values));
    case ConstraintKind::obstacle:
      if (surface >= surfaces.size()) r.fail("a surface is missing");
      return set.obstacle(std::move(name), std::move(nodes), surfaces[surface], side,
                          std::move(values));
    case ConstraintKind::opposing:
      return set.opposing(std::move(name), std::move(nodes), std::move(partners),
                          std::move(normals));
  }
  r.fail("there is no such kind of constraint");
}

}  // namespace

void skip_ids(ConstraintSet& set, ConstraintId next) { set.m_next = next; }

namespace {

ConstraintSet get_constraints(ByteReader& r) {
  std::vector<Surface> surfaces;
  for (std::size_t left = r.count(8); left > 0; --left) surfaces.push_back(get_surface(r));
  ConstraintSet set;
  ConstraintId next = 0;
  for (std::size_t left = r.count(8); left > 0; --left) {
    const auto id = r.get<ConstraintId>();
    if (id < next || id == std::numeric_limits<ConstraintId>::max()) r.fail("the ids of constraints do not rise");
    skip_ids(set, id);   // those in between were of groups that have been removed
    next = add_group(r, surfaces, set) + 1;
  }
  return set;
}

Csf get_fluid(ByteReader& r) {
  const auto density = r.get<double>();
  const auto model = r.get<FluidModel>();
  const auto reference_head = r.get<double>();
  std::vector<Compartment> compartments(r.count(8));
  for (Compartment& c : compartments) {
    c.name = r.get<std::string>();
    c.wall_points = r.matrix<Points>();
    c.wall_triangles = r.matrix<Triangles>();
    c.body_faces = r.list<Index>();
    c.wetted_faces = r.list<Index>();
  }
  return Csf(density, model, std::move(compartments), reference_head);
}

void put_scene(ByteWriter& w, const Scene& scene) {
  put_mesh(w, scene.mesh);
  w.put(scene.materials.size());
  for (const auto& [region, material] : scene.materials) {
    w.put(region);
    w.put(std::string(to_string(material.law())));
    for (double value : {material.young(), material.poisson(), material.density()}) w.put(value);
  }
  w.put(scene.gravity);
  w.put(scene.balanced_reference);
  w.put(scene.volume_strain);
  w.put(scene.csf.has_value());
  if (scene.csf) {
    put_fluid(w, *scene.csf);
    put_fluid_settings(w, *scene.csf);
  }
  put_constraints(w, scene.constraints);
  for (const ConstraintGroup& group : scene.constraints.groups()) w.put(group.enabled);
}

Scene get_scene(ByteReader& r) {
  Scene scene{get_mesh(r), {}};
  for (std::size_t left = r.count(8); left > 0; --left) {
    const auto region = r.get<Index>();
    const Law law = law_from_name(r.get<std::string>());
    const auto young = r.get<double>(), poisson = r.get<double>(), density = r.get<double>();
    scene.materials.emplace_back(region, Material(law, young, poisson, density));
  }
  scene.gravity = r.matrix<Vec3>();
  scene.balanced_reference = r.get<bool>();
  scene.volume_strain = r.get<VolumeStrain>();
  if (scene.volume_strain != VolumeStrain::element && scene.volume_strain != VolumeStrain::nodal) {
    r.fail("there is no such volume strain");
  }
  if (r.get<bool>()) {
    scene.csf = get_fluid(r);
    get_fluid_settings(r, *scene.csf);
  }
  scene.constraints = get_constraints(r);
  const std::vector<ConstraintGroup> groups = scene.constraints.groups();
  for (const ConstraintGroup& group : groups) {
    if (!r.get<bool>()) scene.constraints.disable(group.id);
  }
  return scene;
}

// All but the callback, which is the host's.
void put_options(ByteWriter& w, const StepperOptions& o) {
  for (double value : {o.residual_tolerance, o.complementarity_tolerance, o.correction_tolerance,
                       o.smallest_load_step, o.initial_penetration, o.time_limit}) {
    w.put(value);
  }
  w.put(o.max_iterations);
  w.put(o.threads);
}

StepperOptions get_options(ByteReader& r) {
  StepperOptions o;
  for (double* value : {&o.residual_tolerance, &o.complementarity_tolerance,
                        &o.correction_tolerance, &o.smallest_load_step, &o.initial_penetration,
                        &o.time_limit}) {
    *value = r.get<double>();
  }
  o.max_iterations = r.get<int>();
  o.threads = r.get<int>();
  return o;
}

}  // namespace

void put_mesh(ByteWriter& w, const Mesh& mesh) {
  w.put(mesh.nodes());
  w.put(mesh.tets());
  w.put(mesh.edge_nodes());
  w.put(mesh.regions());
}

void put_constraints(ByteWriter& w, const ConstraintSet& set) {
  const std::vector<Surface> surfaces = surfaces_of(set);
  w.put(surfaces.size());
  for (const Surface& surface : surfaces) put(w, surface);
  w.put(set.groups().size());
  for (const ConstraintGroup& g : set.groups()) {
    w.put(g.id);
    w.put(g.kind);
    w.put(g.name);
    w.put(g.nodes);
    w.put(g.partners);
    for (bool axis : g.axes) w.put(axis);
    w.put(g.kind == ConstraintKind::obstacle ? g.offsets : g.stiffness);
    w.put(g.normals);
    w.put(g.side);
    std::size_t surface = 0;
    while (g.surface && &surfaces[surface].points() != &g.surface->points()) ++surface;
    w.put(surface);
  }
}

void put_fluid(ByteWriter& w, const Csf& csf) {
  w.put(csf.density());
  w.put(csf.model());
  w.put(csf.reference_head());
  w.put(csf.compartment_count());
  for (Index i = 0; i < csf.compartment_count(); ++i) {
    const Compartment& c = csf.compartment(i);
    w.put(c.name);
    w.put(c.wall_points);
    w.put(c.wall_triangles);
    w.put(c.body_faces);
    w.put(c.wetted_faces);
  }
}

void put_fluid_settings(ByteWriter& w, const Csf& csf) {
  for (Index i = 0; i < csf.compartment_count(); ++i) {
    w.put(csf.law(i));
    w.put(csf.amount(i));
  }
}

void get_fluid_settings(ByteReader& r, Csf& csf) {
  for (Index i = 0; i < csf.compartment_count(); ++i) csf.set_full(i);
  for (Index i = 0; i < csf.compartment_count(); ++i) {
    const auto law = r.get<FluidLaw>();
    const auto amount = r.get<double>();
    switch (law) {
      case FluidLaw::full: break;
      case FluidLaw::level: csf.set_level(i, amount); break;
      case FluidLaw::lost_volume: csf.set_lost_volume(i, amount); break;
      case FluidLaw::air_volume: csf.set_air_volume(i, amount); break;
      default: r.fail("there is no such law of the fluid");
    }
  }
}

Bytes Stepper::record() const {
  ByteWriter w;
  put_scene(w, m_impl->m_scene);
  put_options(w, m_impl->m_options);
  w.put(bytes_of(m_impl->m_state));
  return w.sealed(BytesKind::recording);
}

Recording read_recording(const Bytes& bytes) {
  ByteReader r(bytes, BytesKind::recording);
  Scene scene = get_scene(r);
  StepperOptions options = get_options(r);
  auto state = r.get<Bytes>();
  r.expect_end();
  return {std::move(scene), std::move(options), std::move(state)};
}

Stepper Stepper::replay(const Bytes& bytes, std::function<bool(const Progress&)> progress) {
  Recording recording = read_recording(bytes);
  recording.options.progress = std::move(progress);
  Stepper stepper(std::move(recording.scene), std::move(recording.options));
  stepper.restore(stepper.read_snapshot(recording.state));
  return stepper;
}

}  // namespace brainshift
