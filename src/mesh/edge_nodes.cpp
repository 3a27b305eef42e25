#include "mesh/edge_nodes.hpp"

#include <algorithm>
#include <string>

#include <Eigen/LU>

#include "brainshift/error.hpp"
#include "mesh/quadratic_tet.hpp"

namespace brainshift {
namespace {

std::pair<Index, Index> edge(const Tets& tets, Eigen::Index t, int e) {
  return std::minmax(Index(tets(t, tet_edges[e][0])), Index(tets(t, tet_edges[e][1])));
}

std::string named(const std::pair<Index, Index>& edge) {
  return "edge " + std::to_string(edge.first) + "-" + std::to_string(edge.second);
}

}  // namespace

std::vector<std::pair<Index, Index>> edges_of(const Tets& tets) {
  std::vector<std::pair<Index, Index>> edges;
  edges.reserve(std::size_t(6 * tets.rows()));
  for (Eigen::Index t = 0; t < tets.rows(); ++t) {
    for (int e = 0; e < 6; ++e) edges.push_back(edge(tets, t, e));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

EdgeNodes number_edges(const Tets& tets, const std::vector<std::pair<Index, Index>>& edges) {
  EdgeNodes numbers(tets.rows(), 6);
  for (Eigen::Index t = 0; t < tets.rows(); ++t) {
    for (int e = 0; e < 6; ++e) {
      const auto found = std::lower_bound(edges.begin(), edges.end(), edge(tets, t, e));
      numbers(t, e) = Index(found - edges.begin());
    }
  }
  return numbers;
}

void check_edge_nodes(const Tets& tets, const EdgeNodes& edge_nodes, Index node_count) {
  if (edge_nodes.rows() != tets.rows()) {
    throw Error(ErrorCode::size_mismatch, "there are edge nodes for " +
                                              std::to_string(edge_nodes.rows()) + " of " +
                                              std::to_string(tets.rows()) + " tets");
  }
  const auto edges = edges_of(tets);
  const EdgeNodes number = number_edges(tets, edges);
  Indices node_of_edge(edges.size(), -1), edge_of_node(std::size_t(node_count), -1);
  std::vector<char> corner(std::size_t(node_count), 0);
  for (Eigen::Index i = 0; i < tets.size(); ++i) corner[std::size_t(tets.data()[i])] = 1;
  for (Eigen::Index t = 0; t < tets.rows(); ++t) {
    for (int e = 0; e < 6; ++e) {
      const Index node = edge_nodes(t, e), place = number(t, e);
      if (node < 0 || node >= node_count) {
        throw Error(ErrorCode::index_out_of_range, "tet " + std::to_string(t) + " refers to node " +
                                                       std::to_string(node) + " of " +
                                                       std::to_string(node_count));
      }
      Index& mine = node_of_edge[std::size_t(place)];
      Index& its = edge_of_node[std::size_t(node)];
      const std::string here = named(edges[std::size_t(place)]);
      if (corner[std::size_t(node)]) {
        throw Error(ErrorCode::invalid_argument,
                    "node " + std::to_string(node) + " on " + here + " is a corner of a tet");
      }
      if (mine >= 0 && mine != node) {
        throw Error(ErrorCode::invalid_argument, here + " has two nodes, " + std::to_string(mine) +
                                                     " and " + std::to_string(node));
      }
      if (its >= 0 && its != place) {
        throw Error(ErrorCode::invalid_argument, "node " + std::to_string(node) + " lies on " +
                                                     here + " and on " +
                                                     named(edges[std::size_t(its)]));
      }
      mine = node;
      its = place;
    }
  }
}

void check_folds(const Points& nodes, const Tets& tets, const EdgeNodes& edge_nodes) {
  for (Index t = 0; t < Index(tets.rows()); ++t) {
    const auto x = ten_rows(nodes, tets, edge_nodes, t);
    double least = quadratic_jacobian(x, Eigen::Vector4d::Unit(0)).determinant();
    for (int a = 1; a < 4; ++a) {
      least = std::min(least, quadratic_jacobian(x, Eigen::Vector4d::Unit(a)).determinant());
    }
    for (const auto& point : tet_rule_2()) {
      least = std::min(least, quadratic_jacobian(x, point.L).determinant());
    }
    if (least <= 0.0) {
      throw Error(ErrorCode::inverted_element, "quadratic tet " + std::to_string(t) +
                                                   " folds over itself (Jacobian " +
                                                   std::to_string(least) + " mm^3)");
    }
  }
}

Triangles edge_nodes_of_faces(const Triangles& faces, const Indices& owners, const Tets& tets,
                              const EdgeNodes& edge_nodes) {
  Triangles found(faces.rows(), 3);
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Index t = owners[std::size_t(f)];
    for (int k = 0; k < 3; ++k) {
      const std::pair<Index, Index> wanted =
          std::minmax(Index(faces(f, k)), Index(faces(f, (k + 1) % 3)));
      for (int e = 0; e < 6; ++e) {
        if (edge(tets, t, e) == wanted) found(f, k) = edge_nodes(t, e);
      }
    }
  }
  return found;
}

std::array<Index, 10> ten_nodes(const Tets& tets, const EdgeNodes& edge_nodes, Index t) {
  std::array<Index, 10> nodes;
  for (int a = 0; a < 4; ++a) nodes[std::size_t(a)] = tets(t, a);
  for (int e = 0; e < 6; ++e) nodes[std::size_t(4 + e)] = edge_nodes(t, e);
  return nodes;
}

Eigen::Matrix<double, 10, 3> ten_rows(const Points& nodal, const Tets& tets,
                                      const EdgeNodes& edge_nodes, Index t) {
  Eigen::Matrix<double, 10, 3> rows;
  const std::array<Index, 10> nodes = ten_nodes(tets, edge_nodes, t);
  for (int a = 0; a < 10; ++a) rows.row(a) = nodal.row(nodes[std::size_t(a)]);
  return rows;
}

}  // namespace brainshift
