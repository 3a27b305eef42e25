// Semismooth Newton on the min function, with the proximal point method behind it.
#pragma once

#include "mcp/problem.hpp"

namespace brainshift::mcp {

// Full active-set steps; then steps with a line search; then the proximal iteration.
// `max_iterations` counts linear solves over all three.
Attempt solve_by_newton(const Problem& problem, double tolerance, int max_iterations);

// One run of semismooth Newton from z. damped: line search on |natural map|^2.
Attempt run_newton(const Problem& problem, const VectorXd& z, bool damped, double tolerance,
                   int max_iterations);

// Proximal point iteration: M + eps I, q - eps z_k instead of M, q. Each of its problems is
// strongly monotone where M is monotone, so redundant or contradictory rows do no harm: the
// iterates go to (nearly) the solution of least norm, or drift along a direction that proves that
// there is none.
Attempt solve_by_proximal_point(const Problem& problem, double tolerance, int max_iterations);

}  // namespace brainshift::mcp
