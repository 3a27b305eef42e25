#include "mcp/gauss_seidel.hpp"

#include <algorithm>
#include <cmath>

namespace brainshift::mcp {
namespace {

// The value of z_i that solves row i with all others held.
double relaxed(const Problem& problem, Index i, double diagonal, double z, double w) {
  if (diagonal > 0.0) return std::clamp(z - w / diagonal, problem.lower[i], problem.upper[i]);
  const double bound = w > 0.0 ? problem.lower[i] : problem.upper[i];
  return w != 0.0 && std::isfinite(bound) ? bound : z;
}

}  // namespace

Attempt solve_by_gauss_seidel(const Problem& problem, double tolerance, int max_sweeps) {
  Attempt best;
  // sweeps go along rows
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> M = problem.M;
  constexpr int sweeps_per_check = 10;  // a check costs as much as two sweeps
  VectorXd z = problem.clamp(VectorXd::Zero(problem.size()));
  best.z = z;
  best.error = natural_error(problem, z).value;
  while (best.error > tolerance && best.iterations < max_sweeps) {
    for (Index i = 0; i < problem.size(); ++i) {
      z[i] = relaxed(problem, i, M(i, i), z[i], M.row(i).dot(z) + problem.q[i]);
    }
    ++best.iterations;
    const bool last = best.iterations == max_sweeps;
    if (best.iterations > sweeps_per_check && best.iterations % sweeps_per_check && !last) continue;
    const double error = natural_error(problem, z).value;
    if (!std::isfinite(error)) break;
    if (error < best.error) {
      best.error = error;
      best.z = z;
    }
  }
  return best;
}

}  // namespace brainshift::mcp
