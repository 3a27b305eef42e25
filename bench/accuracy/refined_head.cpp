#include "refined_head.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace dbs {
namespace {

using Edge = std::pair<Index, Index>;

// The eight parts of a tet by its corners 0..3 and edge nodes 4..9 (01 12 02 03 13 23): four at the
// corners, and the octahedron in the middle cut along its shortest diagonal.
constexpr int corner_parts[4][4] = {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}};
// Diagonals between opposite edge nodes, and the four others around each, in turn.
constexpr int diagonals[3][2] = {{4, 9}, {5, 7}, {6, 8}};
constexpr int around[3][4] = {{5, 6, 7, 8}, {4, 6, 9, 8}, {4, 5, 9, 7}};

void add_parts(const Points& x, const Index (&n)[10], std::vector<Index>& tets) {
  for (const auto& part : corner_parts) {
    for (int k : part) tets.push_back(n[k]);
  }
  int best = 0;
  const auto length = [&](int d) {
    return (x.row(n[diagonals[d][0]]) - x.row(n[diagonals[d][1]])).squaredNorm();
  };
  for (int d = 1; d < 3; ++d) {
    if (length(d) < length(best)) best = d;
  }
  for (int k = 0; k < 4; ++k) {
    tets.push_back(n[diagonals[best][0]]);
    tets.push_back(n[diagonals[best][1]]);
    tets.push_back(n[around[best][k]]);
    tets.push_back(n[around[best][(k + 1) % 4]]);
  }
}

}  // namespace

Head refined(const Head& head) {
  const Mesh fine = head.brain.quadratic();
  std::map<Edge, Index> middle;
  std::vector<Index> flat;
  Indices regions;
  for (Index t = 0; t < fine.tet_count(); ++t) {
    constexpr int edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
    Index n[10];
    for (int a = 0; a < 4; ++a) n[a] = fine.tets()(t, a);
    for (int e = 0; e < 6; ++e) {
      n[4 + e] = fine.edge_nodes()(t, e);
      middle[std::minmax(n[edges[e][0]], n[edges[e][1]])] = n[4 + e];
    }
    add_parts(fine.nodes(), n, flat);
    regions.insert(regions.end(), 8, fine.regions()[std::size_t(t)]);
  }
  Head result = head;
  const Tets tets = Eigen::Map<const Tets>(flat.data(), Eigen::Index(flat.size() / 4), 4);
  result.brain = Mesh(fine.nodes(), tets, regions, {true});  // the octahedra's parts are turned

  const auto middle_of = [&](Index a, Index b) {
    const auto found = middle.find(std::minmax(a, b));
    return found == middle.end() ? Index(-1) : found->second;
  };
  result.pair.resize(std::size_t(result.brain.node_count()), -1);
  for (const auto& [edge, node] : middle) {
    const Index a = head.pair[std::size_t(edge.first)], b = head.pair[std::size_t(edge.second)];
    if (a >= 0 && b >= 0) result.pair[std::size_t(node)] = middle_of(a, b);
  }
  // A set takes in the nodes on the edges of surface faces between two of its own.
  std::vector<Edge> surface;
  for (Eigen::Index f = 0; f < head.brain.surface().rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      surface.push_back(std::minmax(Index(head.brain.surface()(f, k)),
                                    Index(head.brain.surface()(f, (k + 1) % 3))));
    }
  }
  std::sort(surface.begin(), surface.end());
  surface.erase(std::unique(surface.begin(), surface.end()), surface.end());
  const auto extend = [&](Indices& set, bool with_twins) {
    std::vector<char> in(std::size_t(head.brain.node_count()), 0);
    for (Index node : set) in[std::size_t(node)] = 1;
    for (const Edge& edge : surface) {
      if (!in[std::size_t(edge.first)] || !in[std::size_t(edge.second)]) continue;
      const Index node = middle_of(edge.first, edge.second);
      if (with_twins && result.pair[std::size_t(node)] < 0) continue;
      set.push_back(node);
    }
    std::sort(set.begin(), set.end());
  };
  extend(result.bridge, true);
  extend(result.falx, true);
  extend(result.stem, false);
  extend(result.optic, false);
  return result;
}

void let_touch(Scene& scene, ConstraintId skull) {
  const ConstraintGroup group = scene.constraints.group(skull);
  Eigen::VectorXd offsets = group.offsets;
  for (std::size_t i = 0; i < group.nodes.size(); ++i) {
    const Vec3 x = scene.mesh.nodes().row(group.nodes[i]).transpose();
    double& offset = offsets[Eigen::Index(i)];
    offset = std::min(offset, group.surface->distance(x));
  }
  scene.constraints.remove(skull);
  scene.constraints.obstacle(group.name, group.nodes, *group.surface, group.side, offsets);
}

}  // namespace dbs
