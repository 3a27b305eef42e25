#include "mcp/newton.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "mcp/minimum_norm.hpp"

namespace brainshift::mcp {
namespace {

// Undamped steps without a gain, once dependent rows were met: they wander there, whereas on
// P-matrices they are finite, however long they go without a gain (n steps on Murty's).
constexpr int patience = 8;

double merit(const Problem& problem, const VectorXd& z) {
  return natural_map(problem, z, problem.w(z)).squaredNorm();
}

// The longest of 1, 1/2, 1/4, ... that lowers the merit; 0 where none does.
double step_length(const Problem& problem, const VectorXd& z, const VectorXd& step) {
  constexpr int most_halvings = 10;
  constexpr double sufficient = 1e-4;
  const double start = merit(problem, z);
  for (int halvings = 0; halvings <= most_halvings; ++halvings) {
    const double length = std::ldexp(1.0, -halvings);
    if (merit(problem, z + length * step) <= (1.0 - sufficient * length) * start) return length;
  }
  return 0.0;
}

bool keep_better(const Problem& problem, const VectorXd& z, Attempt& best) {
  const double error = natural_error(problem, z).value;
  if (best.z.size() != 0 && !(error < best.error)) return false;
  best.z = z;
  best.error = error;
  return true;
}

}  // namespace

Attempt run_newton(const Problem& problem, const VectorXd& start, bool damped, double tolerance,
                   int max_iterations) {
  Attempt best;
  VectorXd z = start;
  keep_better(problem, z, best);
  // An undamped step depends on the sides alone: sides seen before mean a cycle.
  std::set<std::vector<Side>> seen;
  int last_gain = 0;
  bool regular = true;
  while (best.error > tolerance && best.iterations < max_iterations) {
    if (!damped && !regular && best.iterations - last_gain >= patience) break;
    const std::vector<Side> sides = sides_of(problem, z, problem.w(z));
    if (!damped && !seen.insert(sides).second) break;
    const SideSolution solution = solve_on_sides(problem, sides);
    const VectorXd& target = solution.z;
    regular = regular && solution.regular;
    ++best.iterations;
    if (!target.allFinite()) break;
    if (damped) {
      const double length = step_length(problem, z, target - z);
      if (length == 0.0) break;
      z += length * (target - z);
    } else {
      z = target;
    }
    if (keep_better(problem, z, best)) last_gain = best.iterations;
  }
  return best;
}

Attempt solve_by_newton(const Problem& problem, double tolerance, int max_iterations) {
  const VectorXd start = problem.clamp(VectorXd::Zero(problem.size()));
  Attempt best = run_newton(problem, start, false, tolerance, max_iterations);
  const auto try_next = [&](Attempt next) {
    next.iterations += best.iterations;
    if (next.error < best.error) {
      best.z = next.z;
      best.error = next.error;
    }
    best.iterations = next.iterations;
    best.conflict = next.conflict;
  };
  const auto unsettled = [&] { return !(best.error <= tolerance) && best.conflict.empty(); };
  if (unsettled()) {
    try_next(solve_by_proximal_point(problem, tolerance, max_iterations - best.iterations));
  }
  if (unsettled()) {
    try_next(run_newton(problem, best.z, true, tolerance, max_iterations - best.iterations));
  }
  return best;
}

}  // namespace brainshift::mcp
