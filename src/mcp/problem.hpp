// The scaled problem that every method of this folder works on, and its measure of error.
#pragma once

#include <vector>

#include "brainshift/mcp.hpp"

namespace brainshift::mcp {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Problem {
  MatrixXd M;
  VectorXd q, lower, upper;
  VectorXd noise;   // of q, row by row

  Index size() const { return static_cast<Index>(q.size()); }
  VectorXd w(const VectorXd& z) const { return M * z + q; }
  VectorXd clamp(const VectorXd& z) const { return z.cwiseMax(lower).cwiseMin(upper); }
};

enum class Side : char { lower, inner, upper };

// Where the min function says row i belongs: z_i - w_i below, inside or above its bounds.
// A tie goes to the bound: a contact that just touches stays out of the linear system.
inline Side side_of(const Problem& problem, Index i, double z, double w) {
  const double trial = z - w;
  if (trial <= problem.lower[i]) return Side::lower;
  if (trial >= problem.upper[i]) return Side::upper;
  return Side::inner;
}

std::vector<Side> sides_of(const Problem& problem, const VectorXd& z, const VectorXd& w);

// z - clamp(z - w, lower, upper), without the cancellation of that form; zero at a solution.
VectorXd natural_map(const Problem& problem, const VectorXd& z, const VectorXd& w);

struct RowError {
  double value;  // infinite where z is not finite
  Index row;     // the worst one, -1 for an empty problem
};

// max_i |natural map|_i / T_i with T_i = |q_i| + sum_j |M_ij z_j|: each row against the terms it is
// the sum of, so that small forces count as much as large ones.
// T_i is floored at 1e-3 of the largest: a row whose terms should all be zero holds nothing but
// the rounding of the others. It is capped at 1e4 of the largest w at z = clamp(0): the iterates
// of an unsolvable problem grow without bound, and would look ever better against their own size.
RowError natural_error(const Problem& problem, const VectorXd& z);

// What a method hands back; the caller certifies it.
struct Attempt {
  VectorXd z;
  double error = 0.0;
  int iterations = 0;
  std::vector<Index> conflict;  // not empty: these rows were proved to contradict each other
};

}  // namespace brainshift::mcp
