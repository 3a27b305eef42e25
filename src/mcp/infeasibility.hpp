// Proof that rows contradict each other.
#pragma once

#include "mcp/problem.hpp"

namespace brainshift::mcp {

// Farkas: a row that has no upper bound demands w_i >= 0, one without a lower bound w_i <= 0, a
// free one w_i = 0, a box nothing. If weights u with the same signs give u^T (M z + q) < 0 for
// every z between the bounds, nothing satisfies these demands. Returns the rows with a share in u,
// or nothing where `direction` proves nothing.
std::vector<Index> contradiction(const Problem& problem, const VectorXd& direction);

}  // namespace brainshift::mcp
