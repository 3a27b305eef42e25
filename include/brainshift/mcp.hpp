// The mixed complementarity problem, usable alone.
//
// Find lower <= z <= upper with w = M z + q and, row by row,
//   w_i >= 0 where z_i = lower_i,  w_i <= 0 where z_i = upper_i,  w_i = 0 in between.
// lower = -inf, upper = +inf: a free (bilateral) row; lower = 0, upper = +inf: a one-sided row;
// finite bounds: a box (friction with a given bound). Forces and gaps of contact are z and w.
#pragma once

#include <string>

#include "brainshift/types.hpp"

namespace brainshift {

enum class McpMethod {
  automatic,    // semismooth Newton, then pivoting where it does not converge
  newton,       // semismooth Newton on the min function, with line search
  pivoting,     // Lemke's complementary pivoting with covering vector of ones
  gauss_seidel  // projected Gauss-Seidel: the baseline, not the method
};

struct McpOptions {
  McpMethod method = McpMethod::automatic;
  double noise = 0.0;        // q is known to this, in the unit of w: rows between their bounds that
                             // leave no more than that open are solved
  double tolerance = 1e-10;  // of McpReport::residual; 100 (1 + n) eps is the least that counts
  int max_iterations = 100;  // Newton: linear solves
  int max_pivots = 0;        // 0: 50 + 10 n, a box counting twice
  int max_sweeps = 10000;    // Gauss-Seidel
};

enum class McpStatus { solved, infeasible, not_converged };

struct McpReport {
  McpStatus status = McpStatus::not_converged;
  // max_i |z_i - clamp(z_i - w_i, lower_i, upper_i)| / T_i, rows and columns scaled to entries of
  // order one; T_i = |q_i| + sum_j |M_ij z_j|, at least 1e-3 of the largest of them and at most
  // 1e4 times the largest w at z = 0; of w, what is beyond the noise. No unit, and small
  // forces count as much as large ones.
  // Computed from the z returned, whatever the method says.
  double residual = 0.0;
  int iterations = 0;  // Newton iterations, pivots or sweeps; automatic: their sum
  Index rank = 0;      // of the rows that ended strictly between their bounds
  // false: z is, or may be, one of many (dependent rows); w is unique all the same where M is
  // symmetric and semidefinite. Newton then returns z of least norm of sqrt(M_ii) z_i over the
  // rows between their bounds.
  bool unique = true;
  Indices conflict;  // infeasible: rows proved (Farkas) to contradict; z is void
  std::string message;
};

struct McpSolution {
  Eigen::VectorXd z, w;
  McpReport report;
};

// M: n x n, dense. Throws Error: not_finite, size_mismatch, invalid_argument (lower > upper).
McpSolution solve_mcp(const Eigen::MatrixXd& M, const Eigen::VectorXd& q,
                      const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                      const McpOptions& options = {});

}  // namespace brainshift
