// From bounds of any kind to the standard problem  w = M x + q, 0 <= w, x, w^T x = 0, and back.
#pragma once

#include "mcp/problem.hpp"

namespace brainshift::mcp {

// z = origin + T x. Per row of the mixed problem:
//   lower bound only   z = lower + x
//   upper bound only   z = upper - x, w changes its sign
//   box                z = lower + x, and one more unknown, the multiplier of upper - z >= 0
//   lower = upper      no unknown
//   free               eliminated where the free block is regular, otherwise z = x' - x''
// M_standard stays monotone (positive semidefinite) where M is.
struct StandardProblem {
  MatrixXd M;
  VectorXd q;
  MatrixXd T;
  VectorXd origin;
};

StandardProblem standard_form(const Problem& problem);

}  // namespace brainshift::mcp
