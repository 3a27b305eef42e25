#include "contact/contact_rows.hpp"

#include "brainshift/error.hpp"

namespace brainshift {

ContactRows::ContactRows(const ConstraintSet& set, const Indices& block_of, const Points& rest,
                         const std::vector<char>& silent)
    : m_rest(rest) {
  for (const ConstraintGroup& group : set.groups()) {
    const bool pair = group.kind == ConstraintKind::opposing;
    if (!group.enabled || (group.kind != ConstraintKind::obstacle && !pair)) continue;
    m_groups.push_back(group);
    const std::size_t before = m_rows.size();
    for (std::size_t i = 0; i < group.nodes.size(); ++i) {
      if (!silent.empty() && silent[std::size_t(group.nodes[i])]) continue;
      const Index partner = pair ? block_of[std::size_t(group.partners[i])] : -1;
      m_rows.push_back({block_of[std::size_t(group.nodes[i])], partner, m_groups.size() - 1, i});
    }
    if (m_rows.size() == before) {
      throw Error(ErrorCode::invalid_argument,
                  "constraint '" + group.name + "' names corners only; contact of quadratic tets is "
                  "held at the nodes on their edges");
    }
  }
}

GapSample ContactRows::sample(std::size_t r, const Points& u) const {
  const ConstraintGroup& group = group_of(r);
  const std::size_t i = m_rows[r].item;
  const Index node = group.nodes[i];
  if (group.kind == ConstraintKind::opposing) {
    const Vec3 n = group.normals.row(Eigen::Index(i)).transpose();
    const Index partner = group.partners[i];
    const Vec3 rest = (m_rest.row(node) - m_rest.row(partner)).transpose();
    const Vec3 parted = (u.row(node) - u.row(partner)).transpose();
    return {n.dot(rest) + n.dot(parted), n};
  }
  const Surface::Sample s = group.surface->sample(position(node, u));
  return {group.side * s.distance - group.offsets[Eigen::Index(i)], group.side * s.gradient};
}

void ContactRows::sample(const Points& u, std::vector<GapSample>& samples) const {
  samples.resize(m_rows.size());
  for (std::size_t r = 0; r < m_rows.size(); ++r) samples[r] = sample(r, u);
}

Mat3 ContactRows::hessian(std::size_t r, const Points& u) const {
  const ConstraintGroup& group = group_of(r);
  if (group.kind == ConstraintKind::opposing) return Mat3::Zero();
  return group.side * group.surface->sample(position(mesh_node(r), u)).hessian;
}

Index ContactRows::mesh_node(std::size_t r) const { return group_of(r).nodes[m_rows[r].item]; }

}  // namespace brainshift
