#include "brainshift/mcp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "brainshift/error.hpp"
#include "mcp/certificate.hpp"
#include "mcp/gauss_seidel.hpp"
#include "mcp/newton.hpp"
#include "mcp/pivoting.hpp"
#include "mcp/problem.hpp"
#include "mcp/scaling.hpp"
#include "mcp/validation.hpp"

namespace brainshift {
namespace {

using mcp::Attempt;
using mcp::Problem;

// Never below what rounding allows: asking for 0 must not turn a solution into a failure.
double attainable(double tolerance, Index size) {
  return std::max(tolerance, 100.0 * std::numeric_limits<double>::epsilon() * (1.0 + size));
}

Attempt automatic(const Problem& problem, const McpOptions& options, double tolerance) {
  Attempt newton = mcp::solve_by_newton(problem, tolerance, options.max_iterations);
  if (newton.error <= tolerance || !newton.conflict.empty()) return newton;
  Attempt pivoting = mcp::solve_by_pivoting(problem, options.max_pivots);
  pivoting.iterations += newton.iterations;
  if (newton.error < pivoting.error) {
    pivoting.z = newton.z;
    pivoting.error = newton.error;
  }
  return pivoting;
}

Attempt run(const Problem& problem, const McpOptions& options, double tolerance) {
  switch (options.method) {
    case McpMethod::newton: return mcp::solve_by_newton(problem, tolerance, options.max_iterations);
    case McpMethod::pivoting: return mcp::solve_by_pivoting(problem, options.max_pivots);
    case McpMethod::gauss_seidel:
      return mcp::solve_by_gauss_seidel(problem, tolerance, options.max_sweeps);
    case McpMethod::automatic: break;
  }
  return automatic(problem, options, tolerance);
}

// Back to the units of the caller; a z on a scaled bound is on the bound exactly.
Eigen::VectorXd unscaled(const Eigen::VectorXd& z, const mcp::Scaling& scaling,
                         const Problem& original) {
  return original.clamp(z.cwiseProduct(scaling.column));
}

std::string names_of(const std::vector<Index>& rows) {
  constexpr std::size_t shown = 8;
  std::string names = rows.size() == 1 ? "row " : "rows ";
  for (std::size_t i = 0; i < std::min(rows.size(), shown); ++i) {
    names += (i ? ", " : "") + std::to_string(rows[i]);
  }
  return rows.size() > shown ? names + ", ..." : names;
}

// Nothing a method said is believed: status and residual come from z alone.
McpReport certified(const Problem& problem, const Eigen::VectorXd& z, const Attempt& attempt,
                    double tolerance) {
  McpReport report;
  report.iterations = attempt.iterations;
  const mcp::RowError error = mcp::natural_error(problem, z);
  report.residual = error.value;
  if (error.value <= tolerance) {
    const mcp::Uniqueness uniqueness = mcp::uniqueness_of(problem, z);
    report.status = McpStatus::solved;
    report.rank = uniqueness.rank;
    report.unique = uniqueness.unique;
    report.message = "solved";
    if (!report.unique) {
      report.message += "; z is not unique: rank " + std::to_string(uniqueness.rank) + " of " +
                        std::to_string(uniqueness.inner) + " rows between their bounds";
    }
  } else if (!attempt.conflict.empty()) {
    report.status = McpStatus::infeasible;
    report.conflict = attempt.conflict;
    report.message =
        "infeasible: " + names_of(attempt.conflict) +
        (attempt.conflict.size() == 1 ? " cannot be satisfied" : " contradict each other");
  } else {
    report.message = "not converged: the residual is largest in row " + std::to_string(error.row);
  }
  return report;
}

}  // namespace

McpSolution solve_mcp(const Eigen::MatrixXd& M, const Eigen::VectorXd& q,
                      const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                      const McpOptions& options) {
  mcp::validate(M, q, lower, upper, options);
  const Problem original{M, q, lower, upper, Eigen::VectorXd::Constant(q.size(), options.noise)};
  const mcp::Scaling scaling = mcp::scaling_of(M);
  const Problem problem = mcp::scaled(original, scaling);
  const double tolerance = attainable(options.tolerance, original.size());

  Attempt attempt = run(problem, options, tolerance);
  if (!attempt.z.allFinite()) attempt.z = problem.clamp(Eigen::VectorXd::Zero(problem.size()));

  McpSolution solution;
  solution.z = unscaled(attempt.z, scaling, original);
  solution.w = original.w(solution.z);
  solution.report =
      certified(problem, solution.z.cwiseQuotient(scaling.column), attempt, tolerance);
  const bool finite = solution.z.allFinite() && solution.w.allFinite();
  if (!finite && solution.report.status == McpStatus::solved) {
    solution.report.status = McpStatus::not_converged;
    solution.report.message = "not converged: the solution is outside the range of double";
  }
  return solution;
}

}  // namespace brainshift
