// Unknowns of a scene: one block of three per node, tied nodes sharing one, in a fill-reducing order.
#pragma once

#include <vector>

#include "brainshift/constraint_set.hpp"
#include "brainshift/mesh.hpp"
#include "linear/block_matrix.hpp"

namespace brainshift {

class Blocks {
 public:
  // Ties and pairs of the enabled groups shape the pattern. Throws conflicting_constraints when a
  // node stands in two enabled pairs, index_out_of_range for nodes that are not there.
  Blocks(const Mesh& mesh, const std::vector<Indices>& node_adjacency, const ConstraintSet& set);

  Index count() const { return m_count; }
  const Indices& block_of() const { return m_block_of; }   // N
  BlockMatrix make_matrix() const { return BlockMatrix(m_adjacency); }

  Eigen::VectorXd gather(const Points& nodal) const;               // sums over tied nodes
  Eigen::VectorXd gather_motion(const Points& nodal) const;          // tied nodes move as one
  void scatter_add(const Eigen::VectorXd& blocks, double factor, Points& nodal) const;
  void move(Index block, const Vec3& by, Points& nodal) const;     // all nodes of one block

 private:
  Index m_count = 0;
  Indices m_block_of;
  std::vector<Indices> m_nodes_of;
  std::vector<Indices> m_adjacency;   // of blocks, in the new order
};

// Throws index_out_of_range when a group of `set` names a node that is not in the mesh.
void check_nodes(const ConstraintSet& set, Index node_count);

}  // namespace brainshift
