// Projected Gauss-Seidel: the baseline of the charts.
#pragma once

#include "mcp/problem.hpp"

namespace brainshift::mcp {

// Converges for symmetric definite M (slowly on floppy devices), cycles on some P-matrices.
// A row without a positive diagonal is set to the bound its w points to, or left alone.
Attempt solve_by_gauss_seidel(const Problem& problem, double tolerance, int max_sweeps);

}  // namespace brainshift::mcp
