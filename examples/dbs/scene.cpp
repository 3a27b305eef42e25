#include "scene.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace dbs {
namespace {

constexpr double pi = 3.14159265358979323846;

std::vector<char> mask(const Indices& nodes, Index count) {
  std::vector<char> in(std::size_t(count), 0);
  for (Index node : nodes) in[std::size_t(node)] = 1;
  return in;
}

Indices of_side(const Head& head, const Indices& nodes, int side) {
  std::vector<char> mine(std::size_t(head.brain.node_count()), 0);
  for (Index t = 0; t < head.brain.tet_count(); ++t) {
    if (head.brain.regions()[std::size_t(t)] != Head::region(side)) continue;
    for (int a = 0; a < 4; ++a) mine[std::size_t(head.brain.tets()(t, a))] = 1;
  }
  Indices some;
  for (Index node : nodes) {
    if (mine[std::size_t(node)]) some.push_back(node);
  }
  return some;
}

// Sum of the outward area vectors of the faces at each node (thirds), over the given faces.
Points area_vectors(const Mesh& mesh, const Indices& faces) {
  Points area = Points::Zero(mesh.node_count(), 3);
  for (Index f : faces) {
    const auto nodes = mesh.surface().row(f);
    const Vec3 x0 = mesh.nodes().row(nodes[0]), x1 = mesh.nodes().row(nodes[1]),
               x2 = mesh.nodes().row(nodes[2]);
    const Vec3 third = (x1 - x0).cross(x2 - x0) / 6.0;
    for (int k = 0; k < 3; ++k) area.row(nodes[k]) += third.transpose();
  }
  return area;
}

// Fluid wets all of a hemisphere but the seam of the bridge and the cut of the brainstem, where
// tissue goes on.
Compartment make_compartment(const Head& head, int side) {
  const Indices seam = head.brain.faces_within(head.bridge);
  const Indices cut = head.brain.faces_within(head.stem);
  Compartment c{name_of(side), head.wall_points, head.wall[side], {}, {}};
  c.body_faces = head.brain.faces_of_region(Head::region(side));
  for (Index f : c.body_faces) {
    const bool dry = std::binary_search(seam.begin(), seam.end(), f) ||
                     std::binary_search(cut.begin(), cut.end(), f);
    if (!dry) c.wetted_faces.push_back(f);
  }
  return c;
}

// Per node: mean of Young's modulus over the tets behind the given faces; exact where they have one.
Eigen::VectorXd young_behind(const BrainMaterials& brain, const Indices& faces) {
  Eigen::VectorXd young = Eigen::VectorXd::Zero(brain.mesh.node_count()), count = young;
  for (Index f : faces) {
    const double here = brain.of_tet(brain.mesh.surface_tets()[std::size_t(f)]).young();
    for (Index node : brain.mesh.surface().row(f)) {
      count[node] += 1.0;
      young[node] += (here - young[node]) / count[node];
    }
  }
  return young;
}

void hold_stem(const Head& head, const BrainMaterials& brain, const Options& o, ConstraintSet& set) {
  if (o.support.rfind("fixed", 0) == 0) {
    set.fix("brainstem", head.stem);
  } else {
    // The cord below goes on for some 20 mm before its ligaments hold it: a column of the brain's
    // own stiffness, E / 20 mm per area of the cut.
    const Indices cut = head.brain.faces_within(head.stem);
    const Points area = area_vectors(head.brain, cut);
    const Eigen::VectorXd young = young_behind(brain, cut);
    Eigen::VectorXd stiffness(Eigen::Index(head.stem.size()));
    for (std::size_t i = 0; i < head.stem.size(); ++i) {
      stiffness[Eigen::Index(i)] = young[head.stem[i]] / 20.0 * area.row(head.stem[i]).norm();
    }
    set.support("brainstem", head.stem, stiffness);
  }
  if (o.support.find("optic") != std::string::npos) set.fix("optic nerves", head.optic);
}

// What runs through the fluid between brain and skull (arachnoid, veins), as springs per area.
void add_tether(const Head& head, double per_area, ConstraintSet& set) {
  const Mesh& brain = head.brain;
  Indices outer;
  for (Index f = 0; f < brain.surface().rows(); ++f) {
    const auto nodes = brain.surface().row(f);
    const auto medial = [&](int k) { return head.pair[std::size_t(nodes[k])] >= 0; };
    if (!(medial(0) && medial(1) && medial(2))) outer.push_back(f);
  }
  const Points area = area_vectors(brain, outer);
  Indices nodes;
  for (Index i = 0; i < brain.node_count(); ++i) {
    if (area.row(i).norm() > 0.0) nodes.push_back(i);
  }
  Eigen::VectorXd stiffness(Eigen::Index(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    stiffness[Eigen::Index(i)] = per_area * area.row(nodes[i]).norm();
  }
  set.support("tether", nodes, stiffness);
}

void add_contact(const Head& head, const Options& o, ConstraintSet& set, SceneIds& ids) {
  const Mesh& brain = head.brain;
  const std::vector<char> bridge = mask(head.bridge, brain.node_count());
  const std::vector<char> falx = mask(head.falx, brain.node_count());
  const std::vector<char> stem = mask(head.stem, brain.node_count());
  if (o.skull) {
    std::vector<char> outside(std::size_t(brain.node_count()), 0);
    for (Eigen::Index f = 0; f < brain.surface().rows(); ++f) {
      for (int k = 0; k < 3; ++k) outside[std::size_t(brain.surface()(f, k))] = 1;
    }
    Indices nodes;
    for (Index i = 0; i < brain.node_count(); ++i) {
      const auto n = std::size_t(i);
      if (outside[n] && !stem[n] && !bridge[n]) nodes.push_back(i);
    }
    ids.skull = set.obstacle("skull", nodes, Surface::cavity(head.wall_points, head.skull));
  }
  if (o.falx) {
    const Surface sheet = Surface::sheet(head.falx_points, head.falx_triangles);
    for (int side : {left, right}) {
      const Indices nodes = of_side(head, head.falx, side);
      const double sign = side == right ? 1.0 : -1.0;
      // The halves touch the falx in the image: each node starts at its own distance.
      Eigen::VectorXd offsets(Eigen::Index(nodes.size()));
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        offsets[Eigen::Index(i)] = sign * sheet.distance(brain.nodes().row(nodes[i]).transpose());
      }
      ids.falx[side] = set.obstacle(std::string("falx, ") + name_of(side), nodes, sheet, sign,
                                    offsets);
    }
  }
  // Hemisphere against hemisphere where neither bridge nor falx lies between them.
  Indices medial;
  for (Index i = 0; i < brain.node_count(); ++i) {
    if (head.pair[std::size_t(i)] >= 0) medial.push_back(i);
  }
  const Points area = area_vectors(brain, brain.faces_within(medial));
  Indices nodes, partners;
  for (Index i : of_side(head, medial, right)) {
    const auto n = std::size_t(i);
    if (bridge[n] || (o.falx && falx[n])) continue;
    nodes.push_back(i);
    partners.push_back(head.pair[n]);
  }
  Points normals(Eigen::Index(nodes.size()), 3);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    normals.row(Eigen::Index(i)) = -area.row(nodes[i]).normalized();
  }
  if (!nodes.empty()) ids.opposing = set.opposing("hemispheres", nodes, partners, normals);
}

}  // namespace

double imaging_elevation(const Options& o) {
  return std::isnan(o.imaging_elevation) ? o.elevation : o.imaging_elevation;
}

Vec3 gravity_of(double degrees) {
  const double angle = degrees * pi / 180.0;
  return standard_gravity * Vec3(0.0, -std::cos(angle), -std::sin(angle));
}

double full_level(const Head& head, const Vec3& gravity) {
  return (head.wall_points * -gravity.normalized()).maxCoeff();
}

double density_of(const Head& head, const Options& o) {
  return o.mass > 0.0 ? o.mass / head.brain.volume() : o.density * 1e-9;
}

Scene make_scene(const Head& head, const Options& o, SceneIds& ids) {
  const BrainMaterials brain = materials_of(head, o);
  Scene scene{brain.mesh, brain.of_region};
  scene.gravity = gravity_of(imaging_elevation(o));
  scene.balanced_reference = o.balanced;
  const FluidModel model =
      o.fluid == "separate" ? FluidModel::separate : FluidModel::communicating;
  scene.csf.emplace(o.csf_density * 1e-9, model,
                    std::vector<Compartment>{make_compartment(head, left),
                                             make_compartment(head, right)});
  Indices twins;
  for (Index node : head.bridge) twins.push_back(head.pair[std::size_t(node)]);
  scene.constraints.tie("bridge", head.bridge, twins);
  hold_stem(head, brain, o, scene.constraints);
  if (!o.still.empty()) {
    const int side = o.still == "left" ? left : right;
    Indices all(std::size_t(head.brain.node_count()));
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = Index(i);
    scene.constraints.fix("half held still", of_side(head, all, side));
  }
  if (o.tether > 0.0) add_tether(head, o.tether, scene.constraints);
  add_contact(head, o, scene.constraints, ids);
  if (o.element == "nodal") scene.volume_strain = VolumeStrain::nodal;
  return o.element == "quadratic" ? quadratic(scene) : scene;
}

}  // namespace dbs
