// Finds the tets that hold given points, for rest or deformed positions of the nodes.
#pragma once

#include "brainshift/mesh.hpp"
#include "mesh/box_tree.hpp"

namespace brainshift {

class TetLocator {
 public:
  // Keeps references: positions, tets and edge nodes (no rows: linear tets) must outlive the locator.
  // Tets may be inverted or flat; a flat one holds no point.
  TetLocator(const Points& positions, const Tets& tets, const EdgeNodes& edge_nodes);

  // The lowest tet that holds a point to rounding (1e-12 of the mesh's diameter); failing that the
  // tet nearest to it within `tolerance` (mm), with the weights of its nearest point.
  Location locate(const Points& points, double tolerance) const;

 private:
  struct Hit {
    Index tet = -1;
    Eigen::Vector4d weights = Eigen::Vector4d::Zero();
  };
  Hit holding(const Vec3& point) const;
  Hit nearest(const Vec3& point, double tolerance) const;
  bool holds(Index tet, const Vec3& point, Eigen::Vector4d& weights) const;
  bool holds_curved(Index tet, const Vec3& point, Eigen::Vector4d& weights) const;
  double squared_distance(Index tet, const Vec3& point, Eigen::Vector4d& weights) const;
  double squared_distance_curved(Index tet, const Vec3& point, Eigen::Vector4d& weights) const;
  // Natural coordinates of a point by Newton's method from the middle; false: it did not converge.
  bool invert(Index tet, const Vec3& point, Eigen::Vector4d& weights) const;

  const Points& m_positions;
  const Tets& m_tets;
  const EdgeNodes& m_edge_nodes;
  BoxTree m_tree;
  double m_rounding;  // mm
};

}  // namespace brainshift
