#include "mcp/problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brainshift::mcp {

std::vector<Side> sides_of(const Problem& problem, const VectorXd& z, const VectorXd& w) {
  std::vector<Side> sides(static_cast<std::size_t>(problem.size()));
  for (Index i = 0; i < problem.size(); ++i) sides[i] = side_of(problem, i, z[i], w[i]);
  return sides;
}

VectorXd natural_map(const Problem& problem, const VectorXd& z, const VectorXd& w) {
  VectorXd h(problem.size());
  for (Index i = 0; i < problem.size(); ++i) {
    switch (side_of(problem, i, z[i], w[i])) {
      case Side::lower: h[i] = z[i] - problem.lower[i]; break;
      case Side::upper: h[i] = z[i] - problem.upper[i]; break;
      case Side::inner: h[i] = w[i]; break;
    }
  }
  return h;
}

RowError natural_error(const Problem& problem, const VectorXd& z) {
  constexpr double floor_of_terms = 1e-3, cap_of_load = 1e4;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (problem.size() == 0) return {0.0, -1};
  const VectorXd w = problem.w(z);
  const VectorXd h = natural_map(problem, z, w);
  const VectorXd terms = problem.M.cwiseAbs() * z.cwiseAbs() + problem.q.cwiseAbs();
  const VectorXd load = problem.w(problem.clamp(VectorXd::Zero(problem.size())));
  const double most = cap_of_load * load.cwiseAbs().maxCoeff();
  const double least = floor_of_terms * std::min(terms.maxCoeff(), most);
  RowError worst{0.0, 0};
  for (Index i = 0; i < problem.size(); ++i) {
    const bool inner = side_of(problem, i, z[i], w[i]) == Side::inner;
    const double size = std::abs(h[i]) - (inner ? problem.noise[i] : 0.0);
    const double error = size > 0.0 ? size / std::clamp(terms[i], least, most) : 0.0;
    if (!std::isfinite(h[i]) || !std::isfinite(error) || !std::isfinite(z[i])) return {infinity, i};
    if (error > worst.value) worst = {error, i};
  }
  return worst;
}

}  // namespace brainshift::mcp
