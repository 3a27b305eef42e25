#include "tissue/tet_element.hpp"

#include <Eigen/LU>

#include "mesh/edge_nodes.hpp"
#include "mesh/quadratic_tet.hpp"

namespace brainshift {

template <>
Tet4::TetElement(const Mesh& mesh, Index t) {
  const auto x = [&](int a) -> Vec3 { return mesh.nodes().row(mesh.tets()(t, a)).transpose(); };
  Mat3 edges;  // columns: p_a - p_0
  for (int a = 1; a < 4; ++a) edges.col(a - 1) = x(a) - x(0);
  volumes[0] = edges.determinant() / 6.0;
  gradients[0].bottomRows<3>() = edges.inverse();
  gradients[0].row(0) = -gradients[0].bottomRows<3>().colwise().sum();
}

template <>
Tet10::TetElement(const Mesh& mesh, Index t) {
  const Rows x = ten_rows(mesh.nodes(), mesh.tets(), mesh.edge_nodes(), t);
  for (int q = 0; q < points; ++q) {
    const TetQuadraturePoint& point = tet_rule_2()[std::size_t(q)];
    const Mat3 J = quadratic_jacobian(x, point.L);
    const Eigen::Matrix<double, 10, 4> slopes = quadratic_shape_slopes(point.L);
    const Rows local = slopes.rightCols<3>().colwise() - slopes.col(0);
    gradients[q] = local * J.inverse();
    volumes[q] = point.weight * J.determinant() / 6.0;
  }
}

}  // namespace brainshift
