// Shape functions of the quadratic tet in barycentric coordinates L: L_a (2 L_a - 1) at the corners,
// 4 L_a L_b in the middles of the edges; docs/theory.md (21). And rules of quadrature for tets.
#pragma once

#include <array>

#include "brainshift/types.hpp"

namespace brainshift {

// Corners of the edges, in the order of EdgeNodes.
constexpr int tet_edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};

using TenWeights = Eigen::Matrix<double, 10, 1>;

inline TenWeights quadratic_shape(const Eigen::Vector4d& L) {
  TenWeights N;
  for (int a = 0; a < 4; ++a) N[a] = L[a] * (2.0 * L[a] - 1.0);
  for (int e = 0; e < 6; ++e) N[4 + e] = 4.0 * L[tet_edges[e][0]] * L[tet_edges[e][1]];
  return N;
}

// Derivatives with respect to L_0 .. L_3 as if they were independent, 10 x 4.
inline Eigen::Matrix<double, 10, 4> quadratic_shape_slopes(const Eigen::Vector4d& L) {
  Eigen::Matrix<double, 10, 4> d = Eigen::Matrix<double, 10, 4>::Zero();
  for (int a = 0; a < 4; ++a) d(a, a) = 4.0 * L[a] - 1.0;
  for (int e = 0; e < 6; ++e) {
    d(4 + e, tet_edges[e][0]) = 4.0 * L[tet_edges[e][1]];
    d(4 + e, tet_edges[e][1]) = 4.0 * L[tet_edges[e][0]];
  }
  return d;
}

// dx/d(L_1, L_2, L_3) with L_0 = 1 - L_1 - L_2 - L_3; nodes: 10 x 3.
inline Mat3 quadratic_jacobian(const Eigen::Matrix<double, 10, 3>& nodes,
                               const Eigen::Vector4d& L) {
  const Eigen::Matrix<double, 3, 4> slopes = nodes.transpose() * quadratic_shape_slopes(L);
  return slopes.rightCols<3>().colwise() - slopes.col(0);
}

struct TetQuadraturePoint {
  Eigen::Vector4d L;
  double weight;  // the weights of a rule sum to 1
};

// Exact for polynomials of degree 2 (four points) and 5 (fourteen; Walkington 2000).
const std::array<TetQuadraturePoint, 4>& tet_rule_2();
const std::array<TetQuadraturePoint, 14>& tet_rule_5();

}  // namespace brainshift
