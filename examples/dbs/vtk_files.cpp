// VTK files of the brain and of the devices.
#include <cmath>
#include <set>

#include "brainshift/io.hpp"
#include "results.hpp"

namespace dbs {
namespace {

constexpr double pi = 3.14159265358979323846;

Eigen::MatrixXd contact_forces(const Procedure& procedure) {
  Points force = Points::Zero(procedure.stepper().mesh().node_count(), 3);
  const auto add = [&](ConstraintId id, const Indices& nodes, const Indices* partners) {
    const ContactState c = procedure.stepper().contact(id);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      force.row(nodes[i]) += c.force.row(Eigen::Index(i));
      if (partners) force.row((*partners)[i]) -= c.force.row(Eigen::Index(i));
    }
  };
  const SceneIds& ids = procedure.ids();
  for (ConstraintId id : {ids.skull, ids.falx[left], ids.falx[right], ids.opposing}) {
    if (id < 0) continue;
    const ConstraintGroup& group = procedure.stepper().constraints().group(id);
    add(id, group.nodes, id == ids.opposing ? &group.partners : nullptr);
  }
  return force;
}

// Arc lengths at which the tube gets a ring: nodes, and both ends of every contact.
std::vector<double> stations(const BeamDevice& device) {
  std::set<double> arcs(device.arcs().data(), device.arcs().data() + device.arcs().size());
  for (const Contact& c : device.contacts()) arcs.insert({c.from, c.to});
  return {arcs.begin(), arcs.end()};
}

Vec3 point_at(const BeamDevice& device, const Points& nodes, double arc) {
  const Index e = device.element_at(arc);
  const double from = device.arcs()[e], to = device.arcs()[e + 1];
  const double part = (arc - from) / (to - from);
  return ((1.0 - part) * nodes.row(e) + part * nodes.row(e + 1)).transpose();
}

// Number of the contact that holds the arc length, from 1; 0 between contacts.
int contact_at(const BeamDevice& device, double arc) {
  const auto& contacts = device.contacts();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (arc > contacts[c].from && arc < contacts[c].to) return int(c) + 1;
  }
  return 0;
}

io::Grid tube(const BeamDevice& device, const Points& nodes) {
  constexpr int sides = 16;
  const std::vector<double> arcs = stations(device);
  const auto rings = Eigen::Index(arcs.size());
  io::Grid grid;
  grid.points.resize(rings * sides, 3);
  grid.triangles.resize((rings - 1) * sides * 2, 3);
  Eigen::MatrixXd arc(rings * sides, 1), contact(grid.triangles.rows(), 1);
  for (Eigen::Index r = 0; r < rings; ++r) {
    const Eigen::Index low = std::max<Eigen::Index>(r - 1, 0), high = std::min(r + 1, rings - 1);
    const Vec3 along = (point_at(device, nodes, arcs[std::size_t(high)]) -
                        point_at(device, nodes, arcs[std::size_t(low)])).normalized();
    const Vec3 first = along.cross(Vec3::UnitX()).normalized(), second = along.cross(first);
    const double here = arcs[std::size_t(r)];
    for (int k = 0; k < sides; ++k) {
      const double angle = 2.0 * pi * k / sides;
      grid.points.row(r * sides + k) =
          (point_at(device, nodes, here) +
           device.radius_at(here) * (std::cos(angle) * first + std::sin(angle) * second)).transpose();
      arc(r * sides + k, 0) = here;
      if (r + 1 == rings) continue;
      const auto a = Index(r * sides + k), b = Index(r * sides + (k + 1) % sides);
      const Eigen::Index t = 2 * (r * sides + k);
      grid.triangles.row(t) << a, b, a + sides;
      grid.triangles.row(t + 1) << b, b + sides, a + sides;
      const double middle = 0.5 * (here + arcs[std::size_t(r + 1)]);
      contact(t, 0) = contact(t + 1, 0) = contact_at(device, middle);
    }
  }
  grid.node_fields = {{"arc_mm", arc, false}};
  grid.cell_fields = {{"contact", contact, true}};
  return grid;
}

io::Grid track(const DeviceState& d) {
  io::Grid grid;
  grid.points = d.path;
  grid.lines.resize(d.path.rows() - 1, 2);
  for (Eigen::Index i = 0; i + 1 < d.path.rows(); ++i) grid.lines.row(i) << Index(i), Index(i + 1);
  // Points below the tip are on no arc length of the device.
  const Eigen::VectorXd arcs = d.path_arcs.unaryExpr([](double a) { return std::isnan(a) ? -1.0 : a; });
  grid.node_fields = {{"arc_mm", arcs, false}, {"force_on_tissue", d.path_forces, false}};
  return grid;
}

}  // namespace

std::string write_stage(const std::string& folder, const Head& head, const Procedure& procedure,
                        const std::string& label) {
  const Stepper& stepper = procedure.stepper();
  const Eigen::VectorXd pressure = stepper.fluid_pressure();
  Eigen::VectorXd regions(head.brain.tet_count());
  for (Index t = 0; t < head.brain.tet_count(); ++t) {
    regions[t] = head.brain.regions()[std::size_t(t)];
  }
  io::Grid grid;
  grid.points = stepper.positions();   // deformed
  grid.tets = stepper.mesh().tets();
  grid.edge_nodes = stepper.mesh().edge_nodes();
  grid.node_fields = {{"displacement", procedure.shift(), false},
                      {"pressure", pressure, false},
                      {"wetted", (pressure.array() != 0.0).cast<double>().matrix(), true},
                      {"contact_force", contact_forces(procedure), false}};
  grid.cell_fields = {{"region", regions, true}, {"jacobian", stepper.jacobians(), false}};
  const std::string name = "stage_" + label + ".vtu";
  io::write_vtu(folder + "/" + name, grid);
  return name;
}

std::vector<std::string> write_electrodes(const std::string& folder, const Procedure& procedure,
                                          const StageResult& stage) {
  std::vector<std::string> names;
  for (int side : {right, left}) {
    if (!stage.lead[side]) continue;
    const std::string name = "stage_" + stage.label + "_" + name_of(side);
    const DeviceState& d = stage.lead[side]->state;
    io::write_vtp(folder + "/" + name + ".vtp", tube(procedure.device_model(side), d.nodes));
    io::write_vtp(folder + "/" + name + "_track.vtp", track(d));
    names.push_back(name + ".vtp");
    names.push_back(name + "_track.vtp");
  }
  return names;
}

}  // namespace dbs
