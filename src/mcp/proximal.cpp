// Rockafellar (1976), "Monotone operators and the proximal point algorithm"; where there is no
// solution the steps converge to a direction of separation (Banjac et al. 2019 for the QP case).
#include <algorithm>

#include "mcp/infeasibility.hpp"
#include "mcp/minimum_norm.hpp"
#include "mcp/newton.hpp"

namespace brainshift::mcp {
namespace {

Attempt solve_shifted(const Problem& shifted, const VectorXd& z, double tolerance, int budget) {
  Attempt attempt = run_newton(shifted, z, false, tolerance, budget);
  if (attempt.error <= tolerance) return attempt;
  const int used = attempt.iterations;
  attempt = run_newton(shifted, attempt.z, true, tolerance, budget - used);
  attempt.iterations += used;
  return attempt;
}

}  // namespace

Attempt solve_by_proximal_point(const Problem& problem, double tolerance, int max_iterations) {
  // Of entries of order one. The first, large one is for finding the sides; each later iteration
  // divides the error by eigenvalue / shift; the last stays clear of the rank tolerance, 1e-10.
  constexpr double first_shift = 1e-2, last_shift = 1e-8, largest_shift = 1.0;
  const VectorXd start = problem.clamp(VectorXd::Zero(problem.size()));
  Attempt best{start, natural_error(problem, start).value, 0, {}};
  const auto offer = [&](const VectorXd& z) {
    const double error = natural_error(problem, z).value;
    if (error < best.error) {
      best.z = z;
      best.error = error;
    }
  };

  VectorXd z = start;
  Problem shifted = problem;
  double shift = first_shift;
  while (best.error > tolerance && best.iterations < max_iterations) {
    shifted.M = problem.M;
    shifted.M.diagonal().array() += shift;
    shifted.q = problem.q - shift * z;
    const int budget = max_iterations - best.iterations;
    const Attempt inner = solve_shifted(shifted, z, 0.01 * tolerance, budget);
    best.iterations += std::max(inner.iterations, 1);
    if (!(inner.error <= 1e-6)) {  // a larger shift is easier to solve, and still makes headway
      if (shift >= largest_shift) break;
      shift *= 100.0;
      continue;
    }

    offer(inner.z);
    // the sides are right long before the last digits are: solve on them without the shift
    offer(problem.clamp(solve_on_sides(problem, sides_of(problem, inner.z, problem.w(inner.z))).z));
    if (best.error > tolerance) {
      best.conflict = contradiction(problem, inner.z - z);
      if (!best.conflict.empty()) {
        best.z = start;  // the iterates run away and mean nothing
        best.error = natural_error(problem, start).value;
        break;
      }
    }
    z = inner.z;
    shift = std::max(0.1 * shift, last_shift);
  }
  return best;
}

}  // namespace brainshift::mcp
