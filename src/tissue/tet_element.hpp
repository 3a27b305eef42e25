// A tet as the assembly sees it: points of quadrature with the gradients of its shape functions.
#pragma once

#include "brainshift/mesh.hpp"

namespace brainshift {

template <int Nodes, int PointCount>
struct TetElement {
  static constexpr int nodes = Nodes;
  static constexpr int points = PointCount;
  static constexpr int blocks = Nodes * (Nodes + 1) / 2;  // of its stiffness, lower triangle
  using Rows = Eigen::Matrix<double, Nodes, 3>;

  Rows gradients[PointCount];  // of the shape functions in the rest shape, 1/mm
  double volumes[PointCount];  // mm^3; they sum to the volume of the tet

  TetElement(const Mesh& mesh, Index t);

  // G = sum_a u_a (grad N_a)^T at point q for the displacements u of its nodes.
  Mat3 displacement_gradient(const Points& u, const Index* node, int q) const {
    Mat3 g = Mat3::Zero();
    for (int a = 0; a < Nodes; ++a) g += u.row(node[a]).transpose() * gradients[q].row(a);
    return g;
  }
  double volume() const {
    double sum = 0.0;
    for (double v : volumes) sum += v;
    return sum;
  }
};

using Tet4 = TetElement<4, 1>;    // linear: constant strain
using Tet10 = TetElement<10, 4>;  // quadratic: linear strain, exact where edges are straight

}  // namespace brainshift
