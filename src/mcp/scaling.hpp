// Row and column scaling to entries of order one.
#pragma once

#include "mcp/problem.hpp"

namespace brainshift::mcp {

// Scaled problem: M_s = R M C, q_s = R q, z = C z_s, w_s = R w, with R, C > 0 diagonal, which
// leaves complementarity as it is.
struct Scaling {
  VectorXd row, column;
};

// 1/sqrt(M_ii) where the diagonal is positive: forces and gaps of contact then share one unit,
// sqrt(energy), whatever the unit of each row, and a semidefinite M has no entry above 1. What
// that leaves (unsymmetric row scales, zero diagonals) a few sweeps of Ruiz (2001, equilibration
// in the maximum norm) bring to order.
Scaling scaling_of(const MatrixXd& M);

Problem scaled(const Problem& original, const Scaling& scaling);

}  // namespace brainshift::mcp
