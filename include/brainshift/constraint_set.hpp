// What holds the tissue: fixed, tied and elastically supported nodes, one-sided contact.
//
// One-sided rows obey gap >= 0, multiplier >= 0, gap * multiplier = 0; the multiplier (mN) pushes
// along the gradient of the gap. Rows come in groups; each group has an id that stays valid while
// others are added or removed.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "brainshift/surface.hpp"
#include "brainshift/types.hpp"

namespace brainshift {

using ConstraintId = std::int32_t;

enum class ConstraintKind { fixed, tied, support, obstacle, opposing };

struct ConstraintGroup {
  ConstraintId id = -1;
  ConstraintKind kind = ConstraintKind::fixed;
  std::string name;
  bool enabled = true;
  Indices nodes;                               // fixed, support, obstacle; first node of a pair
  Indices partners;                            // tied, opposing: second node of a pair
  std::array<bool, 3> axes{true, true, true};  // fixed: x, y, z
  Eigen::VectorXd stiffness;                   // support: mN/mm per node
  std::optional<Surface> surface;              // obstacle
  double side = 1.0;                           // obstacle: gap = side * distance - offset
  Eigen::VectorXd offsets;                     // obstacle: mm, per node
  Points normals;                              // opposing: unit normals, from partner to node
};

class Mesh;

class ConstraintSet {
 public:
  // Displacement of the nodes is zero along the chosen axes.
  ConstraintId fix(std::string name, Indices nodes, std::array<bool, 3> axes = {true, true, true});
  // Nodes and partners move together (same displacement), row by row.
  ConstraintId tie(std::string name, Indices nodes, Indices partners);
  // Springs to the rest position, isotropic; stiffness per node (mN/mm), one value or one per node.
  ConstraintId support(std::string name, Indices nodes, Eigen::VectorXd stiffness);
  // Nodes stay on the positive side of the surface (side = -1: on the negative side), without
  // friction. offsets: distance kept (mm); none, one for all, or one per node. The node's own
  // distance at rest makes it touch from the beginning.
  ConstraintId obstacle(std::string name, Indices nodes, Surface surface, double side = 1.0,
                        Eigen::VectorXd offsets = {});
  // Node and partner of a matching interface may part and slide, but not pass through each other:
  // gap = normal . (x_node - x_partner). Normals are unit, constant, from partner to node; made
  // for sliding that is small beside the radius of curvature of the interface.
  ConstraintId opposing(std::string name, Indices nodes, Indices partners, Points normals);

  void enable(ConstraintId id);
  void disable(ConstraintId id);
  void remove(ConstraintId id);

  const std::vector<ConstraintGroup>& groups() const { return m_groups; }
  const ConstraintGroup& group(ConstraintId id) const;  // throws invalid_argument

 private:
  friend void skip_ids(ConstraintSet& set, ConstraintId next);   // of groups that a recording has not
  friend ConstraintSet quadratic(const ConstraintSet& set, const Mesh& linear, const Mesh& quadratic);
  ConstraintId add(ConstraintGroup group);
  ConstraintGroup& find(ConstraintId id);

  std::vector<ConstraintGroup> m_groups;
  ConstraintId m_next = 0;
};

// The set for the same mesh with quadratic tets, see quadratic(const Scene&).
ConstraintSet quadratic(const ConstraintSet& set, const Mesh& linear, const Mesh& quadratic);

// What a solve found for a group of one-sided rows, in the order of its nodes.
struct ContactState {
  Eigen::VectorXd gap;         // mm
  Eigen::VectorXd multiplier;  // mN
  Points force;                // mN, on `nodes` (opposing: the partner feels the opposite)
  Index active = 0;            // rows with a positive multiplier
};

}  // namespace brainshift
