#include "brainshift/mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "brainshift/error.hpp"
#include "mesh/edge_nodes.hpp"
#include "mesh/quadratic_tet.hpp"
#include "mesh/surface_topology.hpp"
#include "mesh/tet_locator.hpp"
#include "text.hpp"

namespace brainshift {

struct Mesh::Data {
  Points nodes;
  Tets tets;
  EdgeNodes edge_nodes;  // none if linear
  Triangles surface_edge_nodes;
  std::vector<char> corner;
  double diameter = 0.0;
  Indices regions;
  Index reoriented = 0;
  BoundaryFaces boundary;
  Components bodies;

  double volume_of(Index t) const;

  // Made by the first call of locate(): most meshes are never asked.
  const TetLocator& locator() const {
    const std::lock_guard<std::mutex> lock(m_mutex);
    if (!m_locator) m_locator.emplace(nodes, tets, edge_nodes);
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
Index check_volumes(const Points& nodes, Tets& tets, EdgeNodes& edge_nodes, bool orient) {
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
                  tet_name(i) + " has negative volume " + text(volume, 3) + " mm^3 " +
                      node_list(tets, i) + "; turn it or set MeshOptions::orient");
    std::swap(tets(i, 2), tets(i, 3));
    if (edge_nodes.rows() > 0) {  // 12 <-> 13, 02 <-> 03
      std::swap(edge_nodes(i, 1), edge_nodes(i, 4));
      std::swap(edge_nodes(i, 2), edge_nodes(i, 3));
    }
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

void check_orphans(const Tets& tets, const EdgeNodes& edge_nodes, Index node_count) {
  std::vector<char> used(std::size_t(node_count), 0);
  for (Eigen::Index i = 0; i < tets.size(); ++i) used[std::size_t(tets.data()[i])] = 1;
  for (Eigen::Index i = 0; i < edge_nodes.size(); ++i) used[std::size_t(edge_nodes.data()[i])] = 1;
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

Mesh::Mesh(Points nodes, Tets tets, Indices regions, MeshOptions options)
    : m_data(make(std::move(nodes), std::move(tets), {}, std::move(regions), options)) {}

Mesh Mesh::with_edge_nodes(Points nodes, Tets tets, EdgeNodes edge_nodes, Indices regions,
                           MeshOptions options) {
  if (edge_nodes.rows() == 0) {
    throw Error(ErrorCode::empty, "the mesh of quadratic tets has no edge nodes");
  }
  return Mesh(make(std::move(nodes), std::move(tets), std::move(edge_nodes), std::move(regions),
                   options));
}

std::shared_ptr<const Mesh::Data> Mesh::make(Points nodes, Tets tets, EdgeNodes edge_nodes,
                                             Indices regions, MeshOptions options) {
  check_sizes(nodes, tets, regions);
  require_finite(nodes, "nodes");
  const Index count = Index(nodes.rows());
  check_indices(tets, count);
  if (edge_nodes.rows() > 0) check_edge_nodes(tets, edge_nodes, count);
  const auto data = std::make_shared<Data>();
  data->reoriented = check_volumes(nodes, tets, edge_nodes, options.orient);
  if (edge_nodes.rows() > 0) check_folds(nodes, tets, edge_nodes);
  check_duplicates(tets);
  check_orphans(tets, edge_nodes, count);
  data->boundary = boundary_faces(tets);
  data->bodies = brainshift::components(count, tets);
  data->corner.assign(std::size_t(count), 1);
  if (edge_nodes.rows() > 0) {
    data->bodies = brainshift::components(count, tets, edge_nodes);
    data->surface_edge_nodes =
        edge_nodes_of_faces(data->boundary.faces, data->boundary.tets, tets, edge_nodes);
    for (Eigen::Index i = 0; i < edge_nodes.size(); ++i) {
      data->corner[std::size_t(edge_nodes.data()[i])] = 0;
    }
  }
  if (regions.empty()) regions.assign(std::size_t(tets.rows()), 0);
  data->diameter = (nodes.colwise().maxCoeff() - nodes.colwise().minCoeff()).norm();
  data->nodes = std::move(nodes);
  data->tets = std::move(tets);
  data->edge_nodes = std::move(edge_nodes);
  data->regions = std::move(regions);
  return data;
}

Mesh Mesh::quadratic() const {
  if (is_quadratic()) return *this;
  const auto edges = edges_of(tets());
  const std::int64_t most = std::numeric_limits<Index>::max() / 3;
  const Index count =
      checked_count(std::int64_t(node_count()) + std::int64_t(edges.size()), "quadratic nodes", most);
  Points all(count, 3);
  all.topRows(node_count()) = nodes();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    all.row(node_count() + Eigen::Index(e)) =
        0.5 * (nodes().row(edges[e].first) + nodes().row(edges[e].second));
  }
  EdgeNodes on_edges = number_edges(tets(), edges).array() + node_count();
  return with_edge_nodes(std::move(all), tets(), std::move(on_edges), regions());
}

Index Mesh::node_count() const { return Index(m_data->nodes.rows()); }
Index Mesh::tet_count() const { return Index(m_data->tets.rows()); }
const Points& Mesh::nodes() const { return m_data->nodes; }
const Tets& Mesh::tets() const { return m_data->tets; }
bool Mesh::is_quadratic() const { return m_data->edge_nodes.rows() > 0; }
const EdgeNodes& Mesh::edge_nodes() const { return m_data->edge_nodes; }
bool Mesh::is_corner(Index node) const { return m_data->corner[std::size_t(node)] != 0; }
const Indices& Mesh::regions() const { return m_data->regions; }
Index Mesh::reoriented() const { return m_data->reoriented; }
const Triangles& Mesh::surface() const { return m_data->boundary.faces; }
const Triangles& Mesh::surface_edge_nodes() const { return m_data->surface_edge_nodes; }
const Indices& Mesh::surface_tets() const { return m_data->boundary.tets; }
const Indices& Mesh::components() const { return m_data->bodies.of_node; }
Index Mesh::component_count() const { return m_data->bodies.count; }

double Mesh::Data::volume_of(Index t) const {
  if (edge_nodes.rows() == 0) return Corners(nodes, tets, t).volume();
  const auto x = ten_rows(nodes, tets, edge_nodes, t);
  double sum = 0.0;
  for (const auto& point : tet_rule_5()) {
    sum += point.weight * quadratic_jacobian(x, point.L).determinant();
  }
  return sum / 6.0;
}

double Mesh::volume() const {
  double sum = 0.0;
  for (Index t = 0; t < tet_count(); ++t) sum += m_data->volume_of(t);
  return sum;
}

double Mesh::volume(Index region) const {
  double sum = 0.0;
  for (Index t = 0; t < tet_count(); ++t) {
    if (regions()[std::size_t(t)] == region) sum += m_data->volume_of(t);
  }
  return sum;
}

double Mesh::diameter() const { return m_data->diameter; }

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
  return TetLocator(positions, tets(), edge_nodes()).locate(points, tolerance);
}

Interpolation Mesh::interpolation(Index tet, const Eigen::Vector4d& weights) const {
  Interpolation result;
  if (!is_quadratic()) {
    result.count = 4;
    for (int a = 0; a < 4; ++a) {
      result.nodes[std::size_t(a)] = tets()(tet, a);
      result.weights[std::size_t(a)] = weights[a];
    }
    return result;
  }
  result.count = 10;
  result.nodes = ten_nodes(tets(), edge_nodes(), tet);
  Eigen::Map<TenWeights>(result.weights.data()) = quadratic_shape(weights);
  return result;
}

EdgeNodes from_gmsh_order(EdgeNodes edge_nodes) {
  edge_nodes.col(4).swap(edge_nodes.col(5));
  return edge_nodes;
}

Vec3 Interpolation::of(const Points& nodal) const {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < count; ++k) {
    sum += weights[std::size_t(k)] * nodal.row(nodes[std::size_t(k)]).transpose();
  }
  return sum;
}

}  // namespace brainshift
