#include "mesh/tet_locator.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "brainshift/error.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/edge_nodes.hpp"
#include "mesh/quadratic_tet.hpp"
#include "mesh/surface_topology.hpp"

namespace brainshift {
namespace {

// Faces opposite to node k, all seen from the same side as the tet's orientation.
constexpr int opposite[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

// A quadratic tet lies within the hull of its corners and the control points of its edges, 2 x_e -
// (x_a + x_b) / 2 (its Bernstein form).
std::vector<Box> tet_boxes(const Points& positions, const Tets& tets, const EdgeNodes& edge_nodes) {
  std::vector<Box> boxes(std::size_t(tets.rows()));
  for (Eigen::Index i = 0; i < tets.rows(); ++i)
    for (int k = 0; k < 4; ++k) boxes[std::size_t(i)].include(Vec3(positions.row(tets(i, k))));
  for (Eigen::Index i = 0; i < edge_nodes.rows(); ++i)
    for (int e = 0; e < 6; ++e) {
      const auto a = positions.row(tets(i, tet_edges[e][0]));
      const auto b = positions.row(tets(i, tet_edges[e][1]));
      boxes[std::size_t(i)].include(Vec3(2.0 * positions.row(edge_nodes(i, e)) - 0.5 * (a + b)));
    }
  return boxes;
}

double diameter(const Points& positions) {
  return (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).norm();
}

}  // namespace

TetLocator::TetLocator(const Points& positions, const Tets& tets, const EdgeNodes& edge_nodes)
    : m_positions(positions),
      m_tets(tets),
      m_edge_nodes(edge_nodes),
      m_tree(tet_boxes(positions, tets, edge_nodes)),
      m_rounding(1e-12 * diameter(positions)) {}

Location TetLocator::locate(const Points& points, double tolerance) const {
  if (!(tolerance >= 0.0))
    throw Error(ErrorCode::invalid_argument,
                "tolerance is " + std::to_string(tolerance) + " mm, but must not be negative");
  checked_count(points.rows(), "points");
  require_finite(points, "points");
  Location result;
  result.tet.resize(std::size_t(points.rows()));
  result.weights.resize(points.rows(), 4);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vec3 point = points.row(i);
    Hit hit = holding(point);
    if (hit.tet < 0 && tolerance > 0.0) hit = nearest(point, tolerance);
    result.tet[std::size_t(i)] = hit.tet;
    result.weights.row(i) = hit.weights;
  }
  return result;
}

TetLocator::Hit TetLocator::holding(const Vec3& point) const {
  Hit best;
  Eigen::Vector4d weights;
  const double bound = m_rounding * m_rounding;
  m_tree.visit_near(point, bound, [&](Index position) {
    const Index tet = m_tree.items()[std::size_t(position)];
    if ((best.tet < 0 || tet < best.tet) && holds(tet, point, weights)) best = {tet, weights};
    return bound;
  });
  return best;
}

TetLocator::Hit TetLocator::nearest(const Vec3& point, double tolerance) const {
  Hit best;
  Eigen::Vector4d weights;
  double bound = tolerance * tolerance;
  m_tree.visit_near(point, bound, [&](Index position) {
    const Index tet = m_tree.items()[std::size_t(position)];
    const double distance = squared_distance(tet, point, weights);
    if (distance < bound || (distance == bound && (best.tet < 0 || tet < best.tet))) {
      bound = distance;
      best = {tet, weights};
    }
    return bound;
  });
  return best;
}

bool TetLocator::holds(Index tet, const Vec3& point, Eigen::Vector4d& weights) const {
  if (m_edge_nodes.rows() > 0) return holds_curved(tet, point, weights);
  Vec3 x[4];
  for (int k = 0; k < 4; ++k) x[k] = m_positions.row(m_tets(tet, k)).transpose() - point;
  const double volume = (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]);
  if (volume == 0.0) return false;
  for (int k = 0; k < 4; ++k) {
    const int* face = opposite[k];
    const Vec3 normal = (x[face[1]] - x[face[0]]).cross(x[face[2]] - x[face[0]]);
    weights[k] = normal.dot(x[face[0]]) / volume;
    // weight * height is the distance to the face; the height is |volume| / |normal|.
    if (weights[k] < 0.0 && -weights[k] * std::abs(volume) > m_rounding * normal.norm())
      return false;
  }
  weights /= weights.sum();
  return true;
}

bool TetLocator::invert(Index tet, const Vec3& point, Eigen::Vector4d& weights) const {
  const auto nodes = ten_rows(m_positions, m_tets, m_edge_nodes, tet);
  weights.setConstant(0.25);
  constexpr int most = 50;
  for (int i = 0; i < most; ++i) {
    const Vec3 off = point - Vec3(nodes.transpose() * quadratic_shape(weights));
    if (off.norm() <= 0.1 * m_rounding) return true;
    const Mat3 slope = quadratic_jacobian(nodes, weights);
    if (slope.determinant() == 0.0) return false;
    Vec3 step = slope.inverse() * off;
    if (!(step.norm() < 10.0)) return false;  // far outside, or where the map folds
    step *= std::min(1.0, 0.5 / step.cwiseAbs().maxCoeff());
    weights.tail<3>() += step;
    weights[0] = 1.0 - weights.tail<3>().sum();
    if (step.norm() <= 1e-15) return true;
  }
  return false;
}

bool TetLocator::holds_curved(Index tet, const Vec3& point, Eigen::Vector4d& weights) const {
  if (!invert(tet, point, weights)) return false;
  if (weights.minCoeff() >= 0.0) return true;
  const Eigen::Vector4d inside = weights.cwiseMax(0.0) / weights.cwiseMax(0.0).sum();
  const auto nodes = ten_rows(m_positions, m_tets, m_edge_nodes, tet);
  if ((Vec3(nodes.transpose() * quadratic_shape(inside)) - point).norm() > 10.0 * m_rounding)
    return false;
  weights = inside;
  return true;
}

// Of the point with the weights cut off at the faces: near enough for points just outside.
double TetLocator::squared_distance_curved(Index tet, const Vec3& point,
                                           Eigen::Vector4d& weights) const {
  if (!invert(tet, point, weights)) return std::numeric_limits<double>::infinity();
  weights = weights.cwiseMax(0.0).eval();
  weights /= weights.sum();
  const auto nodes = ten_rows(m_positions, m_tets, m_edge_nodes, tet);
  return (Vec3(nodes.transpose() * quadratic_shape(weights)) - point).squaredNorm();
}

double TetLocator::squared_distance(Index tet, const Vec3& point, Eigen::Vector4d& weights) const {
  if (m_edge_nodes.rows() > 0) return squared_distance_curved(tet, point, weights);
  double best = std::numeric_limits<double>::infinity();
  for (const int* face : opposite) {
    Vec3 x[3];
    for (int k = 0; k < 3; ++k) x[k] = m_positions.row(m_tets(tet, face[k]));
    const Vec3 near = closest_point(x[0], x[1], x[2], point).weights;
    const double distance =
        (x[0] * near[0] + x[1] * near[1] + x[2] * near[2] - point).squaredNorm();
    if (!(distance < best)) continue;
    best = distance;
    weights.setZero();
    for (int k = 0; k < 3; ++k) weights[face[k]] = near[k];
  }
  return best;
}

}  // namespace brainshift
