#include "mcp/pivoting.hpp"

#include "mcp/infeasibility.hpp"
#include "mcp/lemke.hpp"
#include "mcp/minimum_norm.hpp"
#include "mcp/reduction.hpp"

namespace brainshift::mcp {

Attempt solve_by_pivoting(const Problem& problem, int max_pivots) {
  const StandardProblem standard = standard_form(problem);
  const int cap = max_pivots > 0 ? max_pivots : 50 + 10 * static_cast<int>(standard.q.size());
  const LemkeResult result = lemke(standard.M, standard.q, cap);

  Attempt attempt;
  attempt.iterations = result.pivots;
  attempt.z = problem.clamp(standard.origin);
  if (result.end == LemkeResult::End::solved) {
    attempt.z = problem.clamp(standard.origin + standard.T * result.x);
  } else if (result.end == LemkeResult::End::ray) {
    attempt.conflict = contradiction(problem, standard.T * result.direction);
  }
  attempt.error = natural_error(problem, attempt.z).value;
  if (result.end == LemkeResult::End::solved) {
    const std::vector<Side> sides = sides_of(problem, attempt.z, problem.w(attempt.z));
    const VectorXd polished = problem.clamp(solve_on_sides(problem, sides).z);
    const double error = natural_error(problem, polished).value;
    if (error < attempt.error) {
      attempt.z = polished;
      attempt.error = error;
    }
  }
  return attempt;
}

}  // namespace brainshift::mcp
