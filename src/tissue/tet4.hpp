// Linear tetrahedron: constant displacement gradient.
#pragma once

#include "brainshift/types.hpp"

namespace brainshift {

struct Tet4 {
  Eigen::Matrix<double, 4, 3> gradients;  // of the shape functions in the rest shape, 1/mm
  double volume;                          // mm^3

  Tet4(const Points& nodes, const Tets& tets, Index t);

  // G = sum_a u_a (grad N_a)^T for the displacements u of its nodes.
  Mat3 displacement_gradient(const Points& u, const Tets& tets, Index t) const {
    Mat3 g = Mat3::Zero();
    for (int a = 0; a < 4; ++a) g += u.row(tets(t, a)).transpose() * gradients.row(a);
    return g;
  }
};

}  // namespace brainshift
