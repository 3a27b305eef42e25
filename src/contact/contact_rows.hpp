// One-sided rows of a ConstraintSet, laid out for the solver.
#pragma once

#include <vector>

#include "brainshift/constraint_set.hpp"

namespace brainshift {

struct ContactRow {
  Index node;               // block of the first node in the reduced system
  Index partner;            // block of the second node, or -1
  std::size_t group, item;  // where the row comes from
};

struct GapSample {
  double gap;   // mm
  Vec3 normal;  // gradient with respect to the node; the partner's is its negative
};

class ContactRows {
 public:
  ContactRows() = default;
  // block_of[node]: reduced block. Keeps a copy of the set (surfaces are shared inside). No rows are
  // made for nodes with a mark in `silent`: the corners of quadratic tets. A constant pressure puts no
  // force on them, so that bounds there would let one multiplier after the other go; a group of
  // silent nodes alone is refused (invalid_argument).
  ContactRows(const ConstraintSet& set, const Indices& block_of, const Points& rest,
              const std::vector<char>& silent = {});

  std::size_t size() const { return m_rows.size(); }
  const ContactRow& row(std::size_t r) const { return m_rows[r]; }
  const ConstraintGroup& group_of(std::size_t r) const { return m_groups[m_rows[r].group]; }

  // Gap and gradient of each row; u: displacements of the mesh nodes (N x 3).
  void sample(const Points& u, std::vector<GapSample>& samples) const;
  GapSample sample(std::size_t r, const Points& u) const;
  // Second derivative of the gap with respect to the node; zero for pairs.
  Mat3 hessian(std::size_t r, const Points& u) const;
  Index mesh_node(std::size_t r) const;

 private:
  Vec3 position(Index node, const Points& u) const {
    return (m_rest.row(node) + u.row(node)).transpose();
  }

  std::vector<ConstraintGroup> m_groups;  // the enabled one-sided ones
  std::vector<ContactRow> m_rows;
  Points m_rest;
};

}  // namespace brainshift
