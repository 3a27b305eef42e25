// A scene on quadratic tets: constraints take in the nodes on edges.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Geometry>

#include "brainshift/stepper.hpp"
#include "contact/blocks.hpp"
#include "mesh/edge_nodes.hpp"

namespace brainshift {
namespace {

using Edge = std::pair<Index, Index>;

class Elevation {
 public:
  Elevation(const Mesh& linear, const Mesh& quadratic)
      : m_linear(linear), m_nodes(quadratic.nodes()) {
    const auto edges = edges_of(linear.tets());
    for (std::size_t e = 0; e < edges.size(); ++e) {
      m_middle[edges[e]] = linear.node_count() + Index(e);
    }
  }

  void fixed(ConstraintGroup& group) const {
    const std::vector<char> in = marked(group.nodes);
    Indices middles;
    for (Eigen::Index t = 0; t < m_linear.tets().rows(); ++t) {
      for (int left_out = 0; left_out < 4; ++left_out) {
        Index face[3];
        int n = 0;
        for (int a = 0; a < 4; ++a) {
          if (a != left_out) face[n++] = m_linear.tets()(t, a);
        }
        if (!in[std::size_t(face[0])] || !in[std::size_t(face[1])] || !in[std::size_t(face[2])]) {
          continue;
        }
        for (int k = 0; k < 3; ++k) middles.push_back(middle(face[k], face[(k + 1) % 3]));
      }
    }
    append_unique(std::move(middles), group.nodes);
  }

  void tied(ConstraintGroup& group) const {
    std::map<Index, std::size_t> place;
    for (std::size_t i = 0; i < group.nodes.size(); ++i) place[group.nodes[i]] = i;
    for (const auto& [edge, node] : m_middle) {
      const auto a = place.find(edge.first), b = place.find(edge.second);
      if (a == place.end() || b == place.end()) continue;
      const Index other = middle(group.partners[a->second], group.partners[b->second]);
      if (other < 0) continue;
      group.nodes.push_back(node);
      group.partners.push_back(other);
    }
  }

  // partner_of: of every node in a pair of any group, also a tied one: an edge from a tied pair to an
  // opposing one is held apart, too.
  void opposing(ConstraintGroup& group, const std::map<Index, Index>& partner_of) const {
    std::map<Index, std::size_t> place;
    for (std::size_t i = 0; i < group.nodes.size(); ++i) place[group.nodes[i]] = i;
    std::vector<Vec3> normals;
    for (const auto& [edge, node] : m_middle) {
      const auto a = place.find(edge.first), b = place.find(edge.second);
      const auto pa = partner_of.find(edge.first), pb = partner_of.find(edge.second);
      if (a == place.end() && b == place.end()) continue;
      if (pa == partner_of.end() || pb == partner_of.end()) continue;
      const Index other = middle(pa->second, pb->second);
      if (other < 0) continue;
      Vec3 normal = Vec3::Zero();
      for (const auto& end : {a, b}) {
        if (end != place.end()) {
          normal += group.normals.row(Eigen::Index(end->second)).transpose();
        }
      }
      group.nodes.push_back(node);
      group.partners.push_back(other);
      normals.push_back(normal.normalized());
    }
    const Eigen::Index before = group.normals.rows();
    group.normals.conservativeResize(before + Eigen::Index(normals.size()), 3);
    for (std::size_t i = 0; i < normals.size(); ++i) {
      group.normals.row(before + Eigen::Index(i)) = normals[i].transpose();
    }
  }

  void obstacle(ConstraintGroup& group) const {
    std::map<Index, std::size_t> place;
    for (std::size_t i = 0; i < group.nodes.size(); ++i) place[group.nodes[i]] = i;
    const auto distance = [&](Index node) {
      return group.side * group.surface->distance(m_nodes.row(node).transpose());
    };
    const double touching = 1e-9 * m_linear.diameter();
    std::vector<double> offsets;
    for (const Edge& edge : surface_edges()) {
      const auto a = place.find(edge.first), b = place.find(edge.second);
      if (a == place.end() || b == place.end()) continue;
      const Index node = middle(edge.first, edge.second);
      const double first = group.offsets[Eigen::Index(a->second)];
      const double second = group.offsets[Eigen::Index(b->second)];
      const bool at_rest = std::abs(distance(edge.first) - first) <= touching &&
                           std::abs(distance(edge.second) - second) <= touching;
      group.nodes.push_back(node);
      // The middle of a chord may stand in an obstacle that its ends are free of: it touches then.
      const double middle_gap = distance(node);
      offsets.push_back(at_rest ? middle_gap : std::min(middle_gap, 0.5 * (first + second)));
    }
    const Eigen::Index before = group.offsets.size();
    group.offsets.conservativeResize(before + Eigen::Index(offsets.size()));
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      group.offsets[before + Eigen::Index(i)] = offsets[i];
    }
  }

  void support(ConstraintGroup& group) const {
    std::map<Index, double> stiffness;
    for (std::size_t i = 0; i < group.nodes.size(); ++i) {
      stiffness[group.nodes[i]] += group.stiffness[Eigen::Index(i)];
    }
    std::map<Index, double> area;  // of the whole faces around a node
    const Indices faces = m_linear.faces_within(group.nodes);
    for (Index f : faces) {
      for (int k = 0; k < 3; ++k) area[m_linear.surface()(f, k)] += face_area(f);
    }
    std::map<Index, double> moved;
    for (const auto& [node, k] : stiffness) {
      if (area.find(node) == area.end()) moved[node] = k;
    }
    for (Index f : faces) {
      double share = 0.0;
      for (int k = 0; k < 3; ++k) {
        const Index node = m_linear.surface()(f, k);
        share += stiffness[node] * face_area(f) / area[node];
      }
      for (int k = 0; k < 3; ++k) {
        moved[middle(m_linear.surface()(f, k), m_linear.surface()(f, (k + 1) % 3))] += share / 3.0;
      }
    }
    group.nodes.clear();
    group.stiffness.resize(Eigen::Index(moved.size()));
    for (const auto& [node, k] : moved) {
      group.stiffness[Eigen::Index(group.nodes.size())] = k;
      group.nodes.push_back(node);
    }
  }

 private:
  Index middle(Index a, Index b) const {
    const auto found = m_middle.find(std::minmax(a, b));
    return found == m_middle.end() ? -1 : found->second;
  }
  std::vector<char> marked(const Indices& nodes) const {
    std::vector<char> marks(std::size_t(m_linear.node_count()), 0);
    for (Index node : nodes) marks[std::size_t(node)] = 1;
    return marks;
  }
  static void append_unique(Indices more, Indices& nodes) {
    std::sort(more.begin(), more.end());
    more.erase(std::unique(more.begin(), more.end()), more.end());
    nodes.insert(nodes.end(), more.begin(), more.end());
  }
  std::vector<Edge> surface_edges() const {
    std::vector<Edge> edges;
    for (Eigen::Index f = 0; f < m_linear.surface().rows(); ++f) {
      for (int k = 0; k < 3; ++k) {
        edges.push_back(std::minmax(Index(m_linear.surface()(f, k)),
                                    Index(m_linear.surface()(f, (k + 1) % 3))));
      }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
  }
  double face_area(Index f) const {
    Vec3 x[3];
    for (int k = 0; k < 3; ++k) x[k] = m_nodes.row(m_linear.surface()(f, k)).transpose();
    return 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
  }

  const Mesh& m_linear;
  const Points& m_nodes;
  std::map<Edge, Index> m_middle;
};

}  // namespace

ConstraintSet quadratic(const ConstraintSet& set, const Mesh& linear, const Mesh& quadratic) {
  const Elevation elevation(linear, quadratic);
  std::map<Index, Index> partner_of;
  for (const ConstraintGroup& group : set.groups()) {
    for (std::size_t i = 0; group.enabled && i < group.partners.size(); ++i) {
      partner_of[group.nodes[i]] = group.partners[i];
    }
  }
  ConstraintSet result = set;
  for (ConstraintGroup& group : result.m_groups) {
    switch (group.kind) {
      case ConstraintKind::fixed: elevation.fixed(group); break;
      case ConstraintKind::tied: elevation.tied(group); break;
      case ConstraintKind::support: elevation.support(group); break;
      case ConstraintKind::obstacle: elevation.obstacle(group); break;
      case ConstraintKind::opposing: elevation.opposing(group, partner_of); break;
    }
  }
  return result;
}

Scene quadratic(const Scene& scene) {
  if (scene.mesh.is_quadratic()) return scene;
  Scene result = scene;
  result.mesh = scene.mesh.quadratic();
  check_nodes(scene.constraints, scene.mesh.node_count());
  result.constraints = quadratic(scene.constraints, scene.mesh, result.mesh);
  result.volume_strain = VolumeStrain::element;
  return result;
}

}  // namespace brainshift
