#include "mcp/infeasibility.hpp"

#include <cmath>
#include <limits>

namespace brainshift::mcp {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Same meaning as the rank tolerance: a solution that needs z beyond 1e10 |q| is none.
constexpr double zero_slope = 1e-10;
constexpr double clearly_negative = 1e-6;

// The part of the direction that respects the signs, largest entry 1; zero where there is none.
VectorXd weights_from(const Problem& problem, const VectorXd& direction) {
  VectorXd u = direction;
  for (Index i = 0; i < problem.size(); ++i) {
    if (problem.upper[i] < infinity) u[i] = std::min(u[i], 0.0);
    if (problem.lower[i] > -infinity) u[i] = std::max(u[i], 0.0);
  }
  const double largest = u.cwiseAbs().maxCoeff();
  if (!std::isfinite(largest) || largest == 0.0) return VectorXd::Zero(u.size());
  u /= largest;
  return (u.array().abs() < zero_slope).select(0.0, u);
}

// The largest slope * z between the bounds.
double upper_limit(double slope, double lower, double upper) {
  const double bound = slope > 0.0 ? upper : lower;
  if (std::isinf(bound)) return std::abs(slope) <= zero_slope ? 0.0 : infinity;
  return slope * bound;
}

}  // namespace

std::vector<Index> contradiction(const Problem& problem, const VectorXd& direction) {
  std::vector<Index> rows;
  if (problem.size() == 0 || !direction.allFinite()) return rows;
  const VectorXd u = weights_from(problem, direction);
  const VectorXd slope = problem.M.transpose() * u;
  double value = u.dot(problem.q), size = u.cwiseAbs().dot(problem.q.cwiseAbs());
  for (Index j = 0; j < problem.size(); ++j) {
    const double limit = upper_limit(slope[j], problem.lower[j], problem.upper[j]);
    value += limit;
    size += std::abs(limit);
  }
  if (!(value < -clearly_negative * size - u.cwiseAbs().dot(problem.noise))) return rows;
  for (Index i = 0; i < problem.size(); ++i) {
    if (std::abs(u[i]) > 1e-3) rows.push_back(i);
  }
  return rows;
}

}  // namespace brainshift::mcp
