// Eigenvalues and vectors of a symmetric 3 x 3 matrix by cyclic Jacobi rotations.
#pragma once

#include "brainshift/types.hpp"

namespace brainshift {

struct SymmetricEigen {
  Vec3 values;   // unordered
  Mat3 vectors;  // columns, det = +1
};

// Backward stable to a few ulp of the largest entry, also for equal eigenvalues, where closed
// forms (trigonometric) lose half the digits. Four to six sweeps; never fails: NaN in, NaN out.
SymmetricEigen symmetric_eigen(const Mat3& m);

}  // namespace brainshift
