#include "contact/blocks.hpp"

#include <algorithm>
#include <numeric>
#include <string>

#include "brainshift/error.hpp"
#include "linear/ordering.hpp"

namespace brainshift {
namespace {

Index root_of(Indices& parent, Index i) {
  while (parent[std::size_t(i)] != i) {
    parent[std::size_t(i)] = parent[std::size_t(parent[std::size_t(i)])];
    i = parent[std::size_t(i)];
  }
  return i;
}

// Number of the block of each node before ordering: tied nodes share one.
Indices merge_ties(Index node_count, const ConstraintSet& set, Index& blocks) {
  Indices parent(static_cast<std::size_t>(node_count));
  std::iota(parent.begin(), parent.end(), 0);
  for (const ConstraintGroup& group : set.groups()) {
    if (!group.enabled || group.kind != ConstraintKind::tied) continue;
    for (std::size_t i = 0; i < group.nodes.size(); ++i) {
      const Index a = root_of(parent, group.nodes[i]), b = root_of(parent, group.partners[i]);
      parent[std::size_t(std::max(a, b))] = std::min(a, b);
    }
  }
  Indices number(parent.size(), -1), result(parent.size());
  blocks = 0;
  for (Index i = 0; i < node_count; ++i) {
    Index& n = number[std::size_t(root_of(parent, i))];
    if (n < 0) n = blocks++;
    result[std::size_t(i)] = n;
  }
  return result;
}

void sort_unique(std::vector<Indices>& lists) {
  for (std::size_t i = 0; i < lists.size(); ++i) {
    Indices& list = lists[i];
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    list.erase(std::remove(list.begin(), list.end(), Index(i)), list.end());
  }
}

// Partner of each block through the pair rows, or -1.
Indices find_partners(const ConstraintSet& set, const Indices& block_of, Index blocks) {
  Indices partner(std::size_t(blocks), -1);
  std::vector<bool> used(std::size_t(blocks), false);
  for (const ConstraintGroup& group : set.groups()) {
    if (!group.enabled || group.kind != ConstraintKind::opposing) continue;
    for (std::size_t i = 0; i < group.nodes.size(); ++i) {
      const Index a = block_of[std::size_t(group.nodes[i])];
      const Index b = block_of[std::size_t(group.partners[i])];
      if (a == b || used[std::size_t(a)] || used[std::size_t(b)]) {
        throw Error(ErrorCode::conflicting_constraints,
                    "constraint '" + group.name + "': nodes " + std::to_string(group.nodes[i]) +
                        " and " + std::to_string(group.partners[i]) +
                        (a == b ? " are tied to each other" : " stand in another pair already"));
      }
      used[std::size_t(a)] = used[std::size_t(b)] = true;
      partner[std::size_t(a)] = b;   // either may follow the other
      partner[std::size_t(b)] = a;
    }
  }
  return partner;
}

// An active pair makes a block's rows appear at its partner: the pattern must have room for it.
void add_pair_fill(const Indices& partner, std::vector<Indices>& near) {
  const std::vector<Indices> before = near;
  const auto link = [&near](Index a, Index b) {
    if (a == b) return;
    near[std::size_t(a)].push_back(b);
    near[std::size_t(b)].push_back(a);
  };
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Index p = partner[i];
    if (p < 0) continue;
    link(Index(i), p);
    for (Index k : before[i]) {
      link(p, k);
      if (partner[std::size_t(k)] >= 0) link(p, partner[std::size_t(k)]);
    }
  }
  sort_unique(near);
}

}  // namespace

void check_nodes(const ConstraintSet& set, Index node_count) {
  const auto check = [node_count](const ConstraintGroup& group, const Indices& nodes) {
    for (Index node : nodes) {
      if (node < 0 || node >= node_count) {
        throw Error(ErrorCode::index_out_of_range,
                    "constraint '" + group.name + "' refers to node " + std::to_string(node) +
                        " of " + std::to_string(node_count));
      }
    }
  };
  for (const ConstraintGroup& group : set.groups()) {
    check(group, group.nodes);
    check(group, group.partners);
  }
}

Blocks::Blocks(const Mesh& mesh, const std::vector<Indices>& node_adjacency,
               const ConstraintSet& set) {
  check_nodes(set, mesh.node_count());
  const Indices merged = merge_ties(mesh.node_count(), set, m_count);
  std::vector<Indices> near(static_cast<std::size_t>(m_count));
  for (std::size_t i = 0; i < node_adjacency.size(); ++i) {
    for (Index k : node_adjacency[i]) {
      near[std::size_t(merged[i])].push_back(merged[std::size_t(k)]);
    }
  }
  sort_unique(near);
  add_pair_fill(find_partners(set, merged, m_count), near);

  const Indices position = nested_dissection(near);
  m_block_of.resize(merged.size());
  m_nodes_of.resize(std::size_t(m_count));
  for (std::size_t i = 0; i < merged.size(); ++i) {
    m_block_of[i] = position[std::size_t(merged[i])];
    m_nodes_of[std::size_t(m_block_of[i])].push_back(Index(i));
  }
  m_adjacency.resize(std::size_t(m_count));
  for (std::size_t i = 0; i < near.size(); ++i) {
    Indices& list = m_adjacency[std::size_t(position[i])];
    for (Index k : near[i]) list.push_back(position[std::size_t(k)]);
    std::sort(list.begin(), list.end());
  }
}

Eigen::VectorXd Blocks::gather(const Points& nodal) const {
  Eigen::VectorXd v = Eigen::VectorXd::Zero(3 * m_count);
  for (std::size_t i = 0; i < m_block_of.size(); ++i) {
    v.segment<3>(3 * m_block_of[i]) += nodal.row(Eigen::Index(i)).transpose();
  }
  return v;
}

Eigen::VectorXd Blocks::gather_motion(const Points& nodal) const {
  Eigen::VectorXd v(3 * m_count);
  for (std::size_t b = 0; b < m_nodes_of.size(); ++b) {
    v.segment<3>(3 * Eigen::Index(b)) = nodal.row(m_nodes_of[b].front()).transpose();
  }
  return v;
}

void Blocks::scatter_add(const Eigen::VectorXd& blocks, double factor, Points& nodal) const {
  for (std::size_t i = 0; i < m_block_of.size(); ++i) {
    nodal.row(Eigen::Index(i)) += factor * blocks.segment<3>(3 * m_block_of[i]).transpose();
  }
}

void Blocks::move(Index block, const Vec3& by, Points& nodal) const {
  for (Index node : m_nodes_of[std::size_t(block)]) nodal.row(node) += by.transpose();
}

}  // namespace brainshift
