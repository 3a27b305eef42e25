#include "tissue/tet4.hpp"

#include <Eigen/LU>

namespace brainshift {

Tet4::Tet4(const Points& nodes, const Tets& tets, Index t) {
  Mat3 edges;  // columns: p_a - p_0
  for (int a = 1; a < 4; ++a) {
    edges.col(a - 1) = (nodes.row(tets(t, a)) - nodes.row(tets(t, 0))).transpose();
  }
  volume = edges.determinant() / 6.0;
  gradients.bottomRows<3>() = edges.inverse();
  gradients.row(0) = -gradients.bottomRows<3>().colwise().sum();
}

}  // namespace brainshift
