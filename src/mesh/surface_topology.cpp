#include "mesh/surface_topology.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>

#include "brainshift/error.hpp"
#include "text.hpp"

namespace brainshift {
namespace {

// A face (or edge) by its ascending nodes, with the place it comes from.
template <std::size_t n>
struct Key {
  std::array<Index, n> nodes;
  Index place;
  friend bool operator<(const Key& a, const Key& b) {
    return a.nodes != b.nodes ? a.nodes < b.nodes : a.place < b.place;
  }
};

// Sorts keys in two steps: counted into buckets by their first node, then within each bucket.
template <std::size_t n>
std::vector<Key<n>> sorted(const std::vector<Key<n>>& keys, Index node_count) {
  std::vector<std::size_t> start(std::size_t(node_count) + 1, 0);
  for (const auto& key : keys) ++start[std::size_t(key.nodes[0]) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<Key<n>> result(keys.size());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for (const auto& key : keys) result[next[std::size_t(key.nodes[0])]++] = key;
  for (std::size_t i = 0; i < std::size_t(node_count); ++i)
    std::sort(result.begin() + std::ptrdiff_t(start[i]),
              result.begin() + std::ptrdiff_t(start[i + 1]));
  return result;
}

// Local faces of a tet, outward; the order is also that of the rows of boundary_faces().
constexpr int tet_faces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

// Directed edges of the triangles; place = 3 * triangle + corner, ascending within an edge.
std::vector<Key<2>> sorted_edges(Index point_count, const Triangles& triangles) {
  std::vector<Key<2>> edges;
  edges.reserve(std::size_t(triangles.rows()) * 3);
  for (Eigen::Index i = 0; i < triangles.rows(); ++i)
    for (int corner = 0; corner < 3; ++corner) {
      const Index a = triangles(i, corner), b = triangles(i, (corner + 1) % 3);
      edges.push_back({{std::min(a, b), std::max(a, b)}, Index(3 * i + corner)});
    }
  return sorted(edges, point_count);
}

bool rises(const Key<2>& edge, const Triangles& triangles) {
  return triangles(edge.place / 3, edge.place % 3) == edge.nodes[0];
}

std::string name(const Key<2>& edge) {
  return std::to_string(edge.nodes[0]) + "-" + std::to_string(edge.nodes[1]);
}

Index root(Indices& parent, Index i) {
  while (parent[std::size_t(i)] != i)
    i = parent[std::size_t(i)] = parent[std::size_t(parent[std::size_t(i)])];
  return i;
}

// The lower number becomes the root, so that components are numbered by their lowest member.
void join(Indices& parent, Index a, Index b) {
  a = root(parent, a);
  b = root(parent, b);
  parent[std::size_t(std::max(a, b))] = std::min(a, b);
}

template <class Cells>
Components components_of(Index node_count, const Cells& cells) {
  Components result;
  Indices parent(static_cast<std::size_t>(node_count));
  std::iota(parent.begin(), parent.end(), Index(0));
  for (Eigen::Index i = 0; i < cells.rows(); ++i)
    for (Eigen::Index k = 1; k < cells.cols(); ++k) join(parent, cells(i, 0), cells(i, k));
  result.of_node.resize(parent.size());
  for (Index i = 0; i < node_count; ++i) {
    const Index first = root(parent, i);
    result.of_node[std::size_t(i)] =
        first == i ? result.count++ : result.of_node[std::size_t(first)];
  }
  return result;
}

}  // namespace

Index checked_count(std::int64_t rows, const std::string& what, std::int64_t limit) {
  if (rows > limit)
    throw Error(ErrorCode::invalid_argument, what + " has " + std::to_string(rows) +
                                                 " rows, more than the " + std::to_string(limit) +
                                                 " that can be numbered");
  return Index(rows);
}

void require_finite(const Points& points, const std::string& what) {
  if (points.allFinite()) return;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (!points.row(i).allFinite())
      throw Error(ErrorCode::not_finite, "row " + std::to_string(i) + " of " + what + " holds (" +
                                             text(points(i, 0)) + ", " +
                                             text(points(i, 1)) + ", " +
                                             text(points(i, 2)) + ")");
}

void require_triangles(const Points& points, const Triangles& triangles, const std::string& what) {
  const Index count = checked_count(points.rows(), "points of " + what);
  checked_count(triangles.rows(), "triangles of " + what, std::numeric_limits<Index>::max() / 3);
  if (count == 0) throw Error(ErrorCode::empty, what + " has no points");
  if (triangles.rows() == 0) throw Error(ErrorCode::empty, what + " has no triangles");
  require_finite(points, "points of " + what);
  for (Eigen::Index i = 0; i < triangles.rows(); ++i) {
    const auto triangle = [&] { return "triangle " + std::to_string(i) + " of " + what; };
    for (int k = 0; k < 3; ++k)
      if (triangles(i, k) < 0 || triangles(i, k) >= count)
        throw Error(ErrorCode::index_out_of_range, triangle() + " refers to point " +
                                                       std::to_string(triangles(i, k)) + " of " +
                                                       std::to_string(count));
    const Vec3 a = points.row(triangles(i, 0)), b = points.row(triangles(i, 1)),
               c = points.row(triangles(i, 2));
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    if ((b - a).cross(c - a).norm() <= 1e-14 * longest)
      throw Error(ErrorCode::degenerate_element, triangle() + " has no area");
  }
}

void require_closed(const Points& points, const Triangles& triangles, const std::string& what) {
  require_triangles(points, triangles, what);
  const auto edges = sorted_edges(Index(points.rows()), triangles);
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    int sum = 0;
    for (end = i; end < edges.size() && edges[end].nodes == edges[i].nodes; ++end)
      sum += rises(edges[end], triangles) ? 1 : -1;
    if (sum == 0) continue;
    const std::string triangle = std::to_string(edges[i].place / 3);
    if (end - i == 1)
      throw Error(ErrorCode::surface_not_closed, what + " is not closed: edge " + name(edges[i]) +
                                                     " belongs to triangle " + triangle + " alone");
    throw Error(ErrorCode::surface_not_closed,
                what + " is not closed: the " + std::to_string(end - i) + " triangles at edge " +
                    name(edges[i]) + ", triangle " + triangle + " among them, do not turn alike");
  }
}

void require_manifold(Index point_count, const Triangles& triangles, const std::string& what) {
  const auto edges = sorted_edges(point_count, triangles);
  // Corners (3 * triangle + corner) that meet across an edge belong to one fan around their point.
  Indices fan(std::size_t(triangles.rows()) * 3);
  std::iota(fan.begin(), fan.end(), Index(0));
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    for (end = i; end < edges.size() && edges[end].nodes == edges[i].nodes;) ++end;
    if (end - i == 1) continue;
    if (end - i > 2)
      throw Error(ErrorCode::invalid_argument, std::to_string(end - i) + " triangles of " + what +
                                                   " meet in edge " + name(edges[i]) +
                                                   ", where its two sides cannot be told apart");
    const Key<2>&p = edges[i], &q = edges[i + 1];
    if (rises(p, triangles) == rises(q, triangles))
      throw Error(ErrorCode::invalid_argument, "triangles " + std::to_string(p.place / 3) +
                                                   " and " + std::to_string(q.place / 3) + " of " +
                                                   what + " do not turn alike");
    const auto next = [](Index place) { return place % 3 == 2 ? place - 2 : place + 1; };
    join(fan, p.place, next(q.place));
    join(fan, next(p.place), q.place);
  }
  Indices fan_of_point(std::size_t(point_count), -1);
  for (Eigen::Index place = 0; place < triangles.size(); ++place) {
    const Index point = triangles(place / 3, place % 3), number = root(fan, Index(place));
    Index& known = fan_of_point[std::size_t(point)];
    if (known < 0) known = number;
    if (known != number)
      throw Error(ErrorCode::invalid_argument,
                  "triangles " + std::to_string(known / 3) + " and " + std::to_string(number / 3) +
                      " of " + what + " touch in point " + std::to_string(point) + " only");
  }
}

Triangles neighbours(Index point_count, const Triangles& triangles) {
  Triangles across = Triangles::Constant(triangles.rows(), 3, -1);
  const auto edges = sorted_edges(point_count, triangles);
  for (std::size_t i = 1; i < edges.size(); ++i) {
    if (edges[i].nodes != edges[i - 1].nodes) continue;
    const Index p = edges[i - 1].place, q = edges[i].place;
    across(p / 3, p % 3) = q / 3;
    across(q / 3, q % 3) = p / 3;
  }
  return across;
}

double enclosed_volume(const Points& points, const Triangles& triangles) {
  const Vec3 origin = points.row(triangles(0, 0));  // near the surface: no cancellation far away
  double volume = 0.0;
  for (Eigen::Index i = 0; i < triangles.rows(); ++i) {
    const Vec3 a = points.row(triangles(i, 0)), b = points.row(triangles(i, 1)),
               c = points.row(triangles(i, 2));
    volume += (a - origin).dot((b - origin).cross(c - origin)) / 6.0;
  }
  return volume;
}

BoundaryFaces boundary_faces(const Tets& tets) {
  std::vector<Key<3>> keys;
  keys.reserve(std::size_t(tets.rows()) * 4);
  for (Eigen::Index i = 0; i < tets.rows(); ++i)
    for (int k = 0; k < 4; ++k) {
      const int* face = tet_faces[k];
      Key<3> key{{tets(i, face[0]), tets(i, face[1]), tets(i, face[2])}, Index(4 * i + k)};
      std::sort(key.nodes.begin(), key.nodes.end());
      keys.push_back(key);
    }
  keys = sorted(keys, tets.size() > 0 ? tets.maxCoeff() + 1 : 0);
  Indices places;
  for (std::size_t i = 0, end = 0; i < keys.size(); i = end) {
    for (end = i; end < keys.size() && keys[end].nodes == keys[i].nodes;) ++end;
    if (end - i == 1) places.push_back(keys[i].place);
    if (end - i > 2)
      throw Error(ErrorCode::duplicate_element,
                  "tets " + std::to_string(keys[i].place / 4) + ", " +
                      std::to_string(keys[i + 1].place / 4) + " and " +
                      std::to_string(keys[i + 2].place / 4) +
                      " share one face, so that some of them overlap");
  }
  std::sort(places.begin(), places.end());
  BoundaryFaces result;
  result.faces.resize(Eigen::Index(places.size()), 3);
  result.tets.reserve(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Index tet = places[i] / 4;
    const int* face = tet_faces[places[i] % 4];
    result.faces.row(Eigen::Index(i)) << tets(tet, face[0]), tets(tet, face[1]), tets(tet, face[2]);
    result.tets.push_back(tet);
  }
  return result;
}

Components components(Index node_count, const Tets& tets) {
  return components_of(node_count, tets);
}

Components components(Index node_count, const Tets& tets, const EdgeNodes& edge_nodes) {
  Eigen::Matrix<Index, Eigen::Dynamic, 10, Eigen::RowMajor> cells(tets.rows(), 10);
  cells << tets, edge_nodes;
  return components_of(node_count, cells);
}

Components components(Index node_count, const Triangles& triangles) {
  return components_of(node_count, triangles);
}

}  // namespace brainshift
