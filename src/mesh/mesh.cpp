#include "brainshift/mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "brainshift/error.hpp"
#include "mesh/surface_topology.hpp"
#include "mesh/tet_locator.hpp"

namespace brainshift {

struct Mesh::Data {
  Points nodes;
  Tets tets;
  Indices regions;
  Index reoriented = 0;
  BoundaryFaces boundary;
  Components bodies;

  // Made by the first call of locate(): most meshes are never asked.
  const TetLocator& locator() const {
    const std::lock_guard<std::mutex> lock(m_mutex);
    if (!m_locator) m_locator.emplace(nodes, tets);
    return *m_locator;
  }

 private:
  mutable std::mutex m_mutex;
  mutable std::optional<TetLocator> m_locator;
};

namespace {

struct Corners {
  Vec3 x[4];
  Corners(const Points& nodes, const Tets& tets, Eigen::Index tet) {
    for (int k = 0; k < 4; ++k) x[k] = nodes.row(tets(tet, k));
  }
  double volume() const { return (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]) / 6.0; }
  double longest_edge() const {
    double longest = 0.0;
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b) longest = std::max(longest, (x[a] - x[b]).squaredNorm());
    return std::sqrt(longest);
  }
};

std::string tet_name(Eigen::Index tet) { return "tet " + std::to_string(tet); }

std::string node_list(const Tets& tets, Eigen::Index tet) {
  std::string list = "(nodes";
  for (int k = 0; k < 4; ++k) list += " " + std::to_string(tets(tet, k));
  return list + ")";
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

void check_sizes(const Points& nodes, const Tets& tets, const Indices& regions) {
  if (nodes.rows() == 0) throw Error(ErrorCode::empty, "the mesh has no nodes");
  if (tets.rows() == 0) throw Error(ErrorCode::empty, "the mesh has no tets");
  constexpr std::int64_t most = std::numeric_limits<Index>::max();
  checked_count(nodes.rows(), "nodes", most / 3);  // dofs are numbered
  checked_count(tets.rows(), "tets", most / 4);    // faces are numbered
  if (!regions.empty() && std::int64_t(regions.size()) != tets.rows())
    throw Error(ErrorCode::size_mismatch, "there are " + std::to_string(regions.size()) +
                                              " regions for " + std::to_string(tets.rows()) +
                                              " tets");
}

void check_indices(const Tets& tets, Index node_count) {
  for (Eigen::Index i = 0; i < tets.rows(); ++i)
    for (int k = 0; k < 4; ++k)
      if (tets(i, k) < 0 || tets(i, k) >= node_count)
        throw Error(ErrorCode::index_out_of_range, tet_name(i) + " refers to node " +
                                                       std::to_string(tets(i, k)) + " of " +
                                                       std::to_string(node_count));
}

// Refuses flat tets; turns or refuses inverted ones. Returns how many were turned.
Index check_volumes(const Points& nodes, Tets& tets, bool orient) {
  Index turned = 0;
  for (Eigen::Index i = 0; i < tets.rows(); ++i) {
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b)
        if (tets(i, a) == tets(i, b))
          throw Error(ErrorCode::degenerate_element, tet_name(i) + " uses node " +
                                                         std::to_string(tets(i, a)) + " twice " +
                                                         node_list(tets, i));
    const Corners corners(nodes, tets, i);
    const double volume = corners.volume();
    const double edge = corners.longest_edge();
    if (std::abs(volume) <= 1e-14 * edge * edge * edge)
      throw Error(ErrorCode::degenerate_element,
                  tet_name(i) + " has no volume " + node_list(tets, i));
    if (volume > 0.0) continue;
    if (!orient)
      throw Error(ErrorCode::inverted_element,
                  tet_name(i) + " has negative volume " + short_number(volume) + " mm^3 " +
                      node_list(tets, i) + "; turn it or set MeshOptions::orient");
    std::swap(tets(i, 2), tets(i, 3));
    ++turned;
  }
  return turned;
}

void check_duplicates(const Tets& tets) {
  struct Key {
    std::array<Index, 4> nodes;
    Index tet;
  };
  std::vector<Key> keys(std::size_t(tets.rows()));
  for (Eigen::Index i = 0; i < tets.rows(); ++i) {
    Key& key = keys[std::size_t(i)];
    key = {{tets(i, 0), tets(i, 1), tets(i, 2), tets(i, 3)}, Index(i)};
    std::sort(key.nodes.begin(), key.nodes.end());
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return a.nodes != b.nodes ? a.nodes < b.nodes : a.tet < b.tet;
  });
  for (std::size_t i = 1; i < keys.size(); ++i)
    if (keys[i].nodes == keys[i - 1].nodes)
      throw Error(ErrorCode::duplicate_element, "tets " + std::to_string(keys[i - 1].tet) +
                                                    " and " + std::to_string(keys[i].tet) +
                                                    " are the same " +
                                                    node_list(tets, keys[i].tet));
}

void check_orphans(const Tets& tets, Index node_count) {
  std::vector<char> used(std::size_t(node_count), 0);
  for (Eigen::Index i = 0; i < tets.size(); ++i) used[std::size_t(tets.data()[i])] = 1;
  const auto orphan = std::find(used.begin(), used.end(), 0);
  if (orphan != used.end())
    throw Error(ErrorCode::orphan_node,
                "node " + std::to_string(orphan - used.begin()) + " belongs to no tet");
}

// Angle between the faces that meet in the edge from..to, seen along the edge.
double dihedral(const Corners& tet, int from, int to, int left, int right) {
  const Vec3 edge = tet.x[to] - tet.x[from];
  const Vec3 a = edge.cross(tet.x[left] - tet.x[from]), b = edge.cross(tet.x[right] - tet.x[from]);
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

Mesh::Mesh(Points nodes, Tets tets, Indices regions, MeshOptions options) {
  check_sizes(nodes, tets, regions);
  require_finite(nodes, "nodes");
  const Index count = Index(nodes.rows());
  check_indices(tets, count);
  const auto data = std::make_shared<Data>();
  data->reoriented = check_volumes(nodes, tets, options.orient);
  check_duplicates(tets);
  check_orphans(tets, count);
  data->boundary = boundary_faces(tets);
  data->bodies = brainshift::components(count, tets);
  if (regions.empty()) regions.assign(std::size_t(tets.rows()), 0);
  data->nodes = std::move(nodes);
  data->tets = std::move(tets);
  data->regions = std::move(regions);
  m_data = data;
}

Index Mesh::node_count() const { return Index(m_data->nodes.rows()); }
Index Mesh::tet_count() const { return Index(m_data->tets.rows()); }
const Points& Mesh::nodes() const { return m_data->nodes; }
const Tets& Mesh::tets() const { return m_data->tets; }
const Indices& Mesh::regions() const { return m_data->regions; }
Index Mesh::reoriented() const { return m_data->reoriented; }
const Triangles& Mesh::surface() const { return m_data->boundary.faces; }
const Indices& Mesh::surface_tets() const { return m_data->boundary.tets; }
const Indices& Mesh::components() const { return m_data->bodies.of_node; }
Index Mesh::component_count() const { return m_data->bodies.count; }

double Mesh::volume() const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < tets().rows(); ++i) sum += Corners(nodes(), tets(), i).volume();
  return sum;
}

double Mesh::volume(Index region) const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < tets().rows(); ++i)
    if (regions()[std::size_t(i)] == region) sum += Corners(nodes(), tets(), i).volume();
  return sum;
}

double Mesh::diameter() const {
  return (nodes().colwise().maxCoeff() - nodes().colwise().minCoeff()).norm();
}

Indices Mesh::faces_of_region(Index region) const {
  Indices faces;
  for (std::size_t i = 0; i < surface_tets().size(); ++i)
    if (regions()[std::size_t(surface_tets()[i])] == region) faces.push_back(Index(i));
  return faces;
}

Indices Mesh::faces_within(const Indices& chosen) const {
  std::vector<char> within(std::size_t(node_count()), 0);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i] < 0 || chosen[i] >= node_count())
      throw Error(ErrorCode::index_out_of_range,
                  "entry " + std::to_string(i) + " of nodes refers to node " +
                      std::to_string(chosen[i]) + " of " + std::to_string(node_count()));
    within[std::size_t(chosen[i])] = 1;
  }
  Indices faces;
  for (Eigen::Index i = 0; i < surface().rows(); ++i)
    if (within[std::size_t(surface()(i, 0))] && within[std::size_t(surface()(i, 1))] &&
        within[std::size_t(surface()(i, 2))])
      faces.push_back(Index(i));
  return faces;
}

Eigen::VectorXd Mesh::smallest_dihedrals() const {
  Eigen::VectorXd smallest(tets().rows());
  for (Eigen::Index i = 0; i < tets().rows(); ++i) {
    const Corners tet(nodes(), tets(), i);
    const double radians =
        std::min({dihedral(tet, 0, 1, 2, 3), dihedral(tet, 0, 2, 1, 3), dihedral(tet, 0, 3, 1, 2),
                  dihedral(tet, 1, 2, 0, 3), dihedral(tet, 1, 3, 0, 2), dihedral(tet, 2, 3, 0, 1)});
    smallest[i] = radians * 180.0 / EIGEN_PI;
  }
  return smallest;
}

Location Mesh::locate(const Points& points, double tolerance) const {
  return m_data->locator().locate(points, tolerance);
}

Location Mesh::locate_deformed(const Points& points, const Points& positions,
                               double tolerance) const {
  if (positions.rows() != node_count())
    throw Error(ErrorCode::size_mismatch, "there are " + std::to_string(positions.rows()) +
                                              " positions for " + std::to_string(node_count()) +
                                              " nodes");
  require_finite(positions, "positions");
  return TetLocator(positions, tets()).locate(points, tolerance);
}

}  // namespace brainshift
