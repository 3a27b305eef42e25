#include "brainshift/constraint_set.hpp"

#include <algorithm>
#include <cmath>

#include "brainshift/error.hpp"

namespace brainshift {
namespace {

void require_pairs(const std::string& name, const Indices& nodes, const Indices& partners) {
  if (nodes.size() != partners.size()) {
    throw Error(ErrorCode::size_mismatch, "constraint '" + name +
                                              "': " + std::to_string(nodes.size()) + " nodes and " +
                                              std::to_string(partners.size()) + " partners");
  }
}

// One value for all nodes, or one each.
Eigen::VectorXd per_node(const std::string& name, const Indices& nodes, Eigen::VectorXd values,
                         const std::string& what) {
  const auto count = Eigen::Index(nodes.size());
  if (values.size() != 1 && values.size() != count) {
    throw Error(ErrorCode::size_mismatch, "constraint '" + name + "': " + std::to_string(count) +
                                              " nodes and " + std::to_string(values.size()) + " " +
                                              what);
  }
  if (!values.allFinite()) {
    throw Error(ErrorCode::not_finite, "constraint '" + name + "': " + what + " are not finite");
  }
  if (values.size() != count) values = Eigen::VectorXd::Constant(count, values[0]).eval();
  return values;
}

void require(bool good, const std::string& name, const std::string& what) {
  if (!good) throw Error(ErrorCode::invalid_argument, "constraint '" + name + "': " + what);
}

}  // namespace

ConstraintId ConstraintSet::add(ConstraintGroup group) {
  if (group.nodes.empty()) {
    throw Error(ErrorCode::empty, "constraint '" + group.name + "' holds no node");
  }
  group.id = m_next;
  m_groups.push_back(std::move(group));
  return m_next++;
}

ConstraintId ConstraintSet::fix(std::string name, Indices nodes, std::array<bool, 3> axes) {
  ConstraintGroup group;
  group.kind = ConstraintKind::fixed;
  group.name = std::move(name);
  group.nodes = std::move(nodes);
  group.axes = axes;
  require(axes[0] || axes[1] || axes[2], group.name, "no axis is fixed");
  return add(std::move(group));
}

ConstraintId ConstraintSet::tie(std::string name, Indices nodes, Indices partners) {
  require_pairs(name, nodes, partners);
  ConstraintGroup group;
  group.kind = ConstraintKind::tied;
  group.name = std::move(name);
  group.nodes = std::move(nodes);
  group.partners = std::move(partners);
  return add(std::move(group));
}

ConstraintId ConstraintSet::support(std::string name, Indices nodes, Eigen::VectorXd stiffness) {
  ConstraintGroup group;
  group.kind = ConstraintKind::support;
  group.stiffness = per_node(name, nodes, std::move(stiffness), "stiffnesses");
  group.name = std::move(name);
  group.nodes = std::move(nodes);
  require(group.stiffness.size() == 0 || group.stiffness.minCoeff() >= 0.0, group.name,
          "a stiffness is negative");
  return add(std::move(group));
}

ConstraintId ConstraintSet::obstacle(std::string name, Indices nodes, Surface surface, double side,
                                     Eigen::VectorXd offsets) {
  require(side == 1.0 || side == -1.0, name, "side is neither 1 nor -1");
  if (offsets.size() == 0) offsets = Eigen::VectorXd::Zero(1);
  ConstraintGroup group;
  group.kind = ConstraintKind::obstacle;
  group.offsets = per_node(name, nodes, std::move(offsets), "offsets");
  group.name = std::move(name);
  group.nodes = std::move(nodes);
  group.surface = std::move(surface);
  group.side = side;
  return add(std::move(group));
}

ConstraintId ConstraintSet::opposing(std::string name, Indices nodes, Indices partners,
                                     Points normals) {
  require_pairs(name, nodes, partners);
  if (normals.rows() != Eigen::Index(nodes.size())) {
    throw Error(ErrorCode::size_mismatch, "constraint '" + name +
                                              "': " + std::to_string(nodes.size()) + " nodes and " +
                                              std::to_string(normals.rows()) + " normals");
  }
  for (Eigen::Index i = 0; i < normals.rows(); ++i) {
    require(std::abs(normals.row(i).norm() - 1.0) <= 1e-6, name,
            "normal " + std::to_string(i) + " is not of unit length");
  }
  ConstraintGroup group;
  group.kind = ConstraintKind::opposing;
  group.name = std::move(name);
  group.nodes = std::move(nodes);
  group.partners = std::move(partners);
  group.normals = std::move(normals);
  return add(std::move(group));
}

ConstraintGroup& ConstraintSet::find(ConstraintId id) {
  for (ConstraintGroup& group : m_groups) {
    if (group.id == id) return group;
  }
  throw Error(ErrorCode::invalid_argument,
              "there is no constraint with the id " + std::to_string(id));
}

const ConstraintGroup& ConstraintSet::group(ConstraintId id) const {
  return const_cast<ConstraintSet*>(this)->find(id);
}

void ConstraintSet::enable(ConstraintId id) { find(id).enabled = true; }

void ConstraintSet::disable(ConstraintId id) { find(id).enabled = false; }

void ConstraintSet::remove(ConstraintId id) {
  find(id);
  m_groups.erase(std::remove_if(m_groups.begin(), m_groups.end(),
                                [id](const ConstraintGroup& g) { return g.id == id; }),
                 m_groups.end());
}

}  // namespace brainshift
