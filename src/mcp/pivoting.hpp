// The mixed problem by complementary pivoting.
#pragma once

#include "mcp/problem.hpp"

namespace brainshift::mcp {

// max_pivots = 0: 50 + 10 n. Sure where Newton is not (P-matrices, monotone problems), but its
// tableau drifts: the solution is recomputed on the sides it ends at.
Attempt solve_by_pivoting(const Problem& problem, int max_pivots);

}  // namespace brainshift::mcp
