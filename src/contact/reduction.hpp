// Elimination of bilateral and active one-sided rows of nodes from the stiffness matrix.
//
// Each block i of unknowns is written dx_i = Q_i y_i + T_i dx_partner + c_i, docs/theory.md (9).
// The columns of Q_i span the directions its rows leave free (in node-local axes, so that the
// pattern of the matrix, and with it the symbolic factor, never changes), T_i carries an active
// pair row, and c_i is the particular solution of the rows. The reduced matrix is A = T^T K T,
// positive definite where K is on the admissible directions; steel or contact never enters it as a
// penalty.
#pragma once

#include <vector>

#include "linear/block_matrix.hpp"

namespace brainshift {

// A row  normal . (dx_block - dx_partner) = value  (partner -1: a row of one node).
struct NodeRow {
  Index block, partner;
  Vec3 normal;
  double value;
  std::size_t tag;  // the caller's name for the row
};

class Reduction {
 public:
  // rows: in order of precedence, pair rows last; a row that depends on earlier ones is left out
  // and gets multiplier 0. A block may stand in one pair row only.
  // like: choose the free axes as near to its as can be, so that a factor of the matrix it reduced
  // still serves (there is no choice of axes that is continuous in the normals by itself).
  Reduction(Index blocks, const std::vector<NodeRow>& rows, const Reduction* like = nullptr);

  // A = T^T K T into a matrix whose pattern holds the pairs; fixed directions get `diagonal`.
  void reduce(const BlockMatrix& K, double diagonal, BlockMatrix& A) const;
  // y-space right-hand side T^T v for a force v; fixed directions get 0.
  Eigen::VectorXd restrict_force(const Eigen::VectorXd& v) const;
  SparseColumns restrict_columns(const SparseColumns& forces) const;
  // dx = T y (homogeneous), and the particular solution c.
  Eigen::VectorXd expand(const Eigen::VectorXd& y) const;
  const Eigen::VectorXd& particular() const { return m_particular; }

  // The rows that hold a block, and which.
  struct Held {
    std::size_t tag;
    Index block;
  };
  std::vector<Held> held_rows() const;
  Indices held_blocks() const;
  bool holds(Index block) const { return m_place[std::size_t(block)] >= 0; }
  // The motions that T gains when these blocks let go all their rows but those tagged `kept`, one per
  // column: (9) with y beside them and c as it is reaches every motion then. tags: of those rows.
  SparseColumns released(const Indices& blocks, std::size_t kept, std::vector<std::size_t>& tags) const;

  // Multipliers of the rows (by tag) that balance the force `unbalanced` on their blocks:
  // unbalanced + sum multiplier * (gradient) = 0 along the rows. Others are left untouched.
  void multipliers(const Eigen::VectorXd& unbalanced, std::vector<double>& by_tag) const;
  // Removes from `force` what the rows (bilateral ones too) carry; what is left is out of balance.
  Eigen::VectorXd project(const Eigen::VectorXd& force) const;

 private:
  struct Block {   // that rows hold; Q = I for all others
    Index block;
    Mat3 q = Mat3::Identity();  // orthonormal; the first `held` columns are held by rows
    Mat3 lower = Mat3::Zero();  // row k: normal_k = sum_j lower(k, j) q_j
    Vec3 values = Vec3::Zero(); // right-hand sides of the held rows
    int held = 0;
    std::size_t tags[3] = {0, 0, 0};
    int pair = -1;  // which held row is a pair row
    Index partner = -1;
    Vec3 pair_normal = Vec3::Zero();
    Vec3 pair_response = Vec3::Zero();  // motion of the block for a unit value of the pair row
    Mat3 free() const;                  // q with the held columns zeroed
    Vec3 rest_of(const Vec3& normal, Vec3& along) const;
  };
  struct Side {   // dx of a block: from[k] times y of the blocks to[k]
    int count = 1;
    Index to[2] = {-1, -1};
    Mat3 from[2];
  };
  Side side(Index block, const Block* held) const;
  const Block* find(Index block) const;   // null: no row holds it
  Block& hold(Index block);
  void add_row(NodeRow row, const Reduction* like);
  void sort_blocks();
  void complete_axes(Block& b, const Reduction* like) const;
  void find_particular();
  Mat3 coupling(const Block& b) const;  // T_i Q_partner: from y of the partner to dx of the block

  std::vector<int> m_place;    // of each block in the next, -1 for most
  std::vector<Block> m_held;   // by number of the block
  Eigen::VectorXd m_particular;
};

}  // namespace brainshift
