#include "mcp/scaling.hpp"

#include <cmath>

namespace brainshift::mcp {
namespace {

double power_of_two_near(double value) {
  if (!(value > 0.0) || !std::isfinite(value)) return 1.0;
  return std::exp2(std::round(std::log2(value)));
}

// Entries below this part of the largest diagonal one are rounding: rows of them are left as they
// are, or they would outweigh all others. Units 10^15 apart between rows stay within it.
constexpr double nothing = 1e-30;

}  // namespace

Scaling scaling_of(const MatrixXd& M) {
  const Index n = static_cast<Index>(M.rows());
  if (n == 0) return {};
  // A common unit goes into a power of two first: in other units (2^k) the rest is the same bit
  // for bit.
  const double largest_diagonal = M.diagonal().maxCoeff();
  const double unit =
      power_of_two_near(largest_diagonal > 0.0 ? largest_diagonal : M.cwiseAbs().maxCoeff());
  Scaling scaling{VectorXd::Constant(n, 1.0 / unit), VectorXd::Ones(n)};
  for (Index i = 0; i < n; ++i) {
    if (!(M(i, i) > nothing * unit)) continue;
    const double factor = 1.0 / std::sqrt(M(i, i) / unit);
    scaling.row[i] *= factor;
    scaling.column[i] = factor;
  }
  // A largest entry within a factor of four of 1 is good enough: symmetric semidefinite problems,
  // whose diagonal is 1 by now, leave at once.
  constexpr int max_sweeps = 12;
  constexpr double good_enough = 4.0;
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    const MatrixXd scaled_abs =
        (scaling.row.asDiagonal() * M * scaling.column.asDiagonal()).cwiseAbs();
    bool changed = false;
    const auto adjust = [&](double largest, double& factor) {
      if (largest <= nothing || (largest < good_enough && largest > 1.0 / good_enough)) return;
      factor *= power_of_two_near(1.0 / std::sqrt(largest));
      changed = true;
    };
    for (Index i = 0; i < n; ++i) {
      adjust(scaled_abs.row(i).maxCoeff(), scaling.row[i]);
      adjust(scaled_abs.col(i).maxCoeff(), scaling.column[i]);
    }
    if (!changed) break;
  }
  return scaling;
}

Problem scaled(const Problem& original, const Scaling& scaling) {
  Problem problem;
  problem.M = scaling.row.asDiagonal() * original.M * scaling.column.asDiagonal();
  problem.q = original.q.cwiseProduct(scaling.row);
  problem.noise = original.noise.cwiseProduct(scaling.row);
  problem.lower = original.lower.cwiseQuotient(scaling.column);
  problem.upper = original.upper.cwiseQuotient(scaling.column);
  return problem;
}

}  // namespace brainshift::mcp
