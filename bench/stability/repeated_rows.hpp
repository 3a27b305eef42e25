// Complementarity problems whose rows are there k times: of the forces only their sum is one.
#pragma once

#include <random>

#include "brainshift/mcp.hpp"
#include "mcp/case.hpp"

namespace brainshift::stability {

using test::Case;
using test::MatrixXd;
using test::VectorXd;

constexpr int distinct_rows = 20;
constexpr int copies[] = {1, 2, 4, 8};

enum class Rows { free, one_sided, boxes };
constexpr Rows kinds[] = {Rows::free, Rows::one_sided, Rows::boxes};

inline const char* to_string(Rows rows) {
  return rows == Rows::free ? "free" : rows == Rows::one_sided ? "one-sided" : "boxes";
}

// A compliance of condition some hundred, each row `count` times; boxes a `count`-th as wide, so that
// the sum is that of the single problem.
inline Case repeated(Rows kind, int count) {
  std::mt19937 generator(12);
  const auto uniform = [&] { return 2.0 * double(generator()) / double(generator.max()) - 1.0; };
  const MatrixXd B = MatrixXd::NullaryExpr(distinct_rows, distinct_rows, uniform);
  const VectorXd q = VectorXd::NullaryExpr(distinct_rows, uniform);
  const MatrixXd W = B * B.transpose() / distinct_rows;
  const MatrixXd M = W + 0.1 * MatrixXd::Identity(distinct_rows, distinct_rows);
  Case c = test::one_sided(M.replicate(count, count), q.replicate(count, 1));
  if (kind != Rows::one_sided) c.lower.setConstant(kind == Rows::free ? -test::inf : -1.0 / count);
  if (kind == Rows::boxes) c.upper.setConstant(1.0 / count);
  return c;
}

inline VectorXd sum_of_copies(const VectorXd& z) {
  return Eigen::Map<const MatrixXd>(z.data(), distinct_rows, z.size() / distinct_rows)
      .rowwise()
      .sum();
}

// Sum of the forces against the single problem, by the library's pivoting, which is exact.
inline double off_single(Rows kind, const VectorXd& z) {
  McpOptions options;
  options.method = McpMethod::pivoting;
  const Case c = repeated(kind, 1);
  const VectorXd single = solve_mcp(c.M, c.q, c.lower, c.upper, options).z;
  return (sum_of_copies(z) - single).norm() / single.norm();
}

constexpr const char* repeated_header =
    "solver,rows,copies,n,rank,iterations,residual,off_single,largest_force,status\n";

}  // namespace brainshift::stability
