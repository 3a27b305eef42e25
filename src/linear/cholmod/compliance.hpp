// C^T A^-1 C from the supernodes of a Cholesky factor.
#pragma once

#include <cholmod.h>

#include "linear/spd_solver.hpp"

namespace brainshift {

// With A = P^T L L^T P and Y = L^-1 P C this is Y^T Y. Entries of a column of C reach the supernodes on
// their way to the root of the elimination tree and no others (Gilbert, Peierls 1988), and what a supernode
// gives to Y is not needed any more once it has been counted.
Eigen::MatrixXd supernodal_compliance(const cholmod_factor& factor, const SparseColumns& C);

}  // namespace brainshift
