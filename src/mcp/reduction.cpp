#include "mcp/reduction.hpp"

#include <cmath>

#include "mcp/minimum_norm.hpp"

namespace brainshift::mcp {
namespace {

// Unknown k of the standard problem moves row `row` of the mixed one in direction `sign`.
struct Unknown {
  Index row;
  double sign;
};

struct Layout {
  std::vector<Unknown> unknowns;
  std::vector<Index> boxes;  // positions in `unknowns`
  std::vector<Index> free;
};

Layout layout_of(const Problem& problem, VectorXd& origin) {
  Layout layout;
  for (Index i = 0; i < problem.size(); ++i) {
    const bool below = std::isfinite(problem.lower[i]), above = std::isfinite(problem.upper[i]);
    if (!below && !above) {
      layout.free.push_back(i);
      continue;
    }
    origin[i] = below ? problem.lower[i] : problem.upper[i];
    if (below && problem.lower[i] == problem.upper[i]) continue;
    if (below && above) layout.boxes.push_back(static_cast<Index>(layout.unknowns.size()));
    layout.unknowns.push_back({i, below ? 1.0 : -1.0});
  }
  return layout;
}

// Columns of T for the unknowns, and what the free rows answer to them.
MatrixXd selection(Index n, const std::vector<Unknown>& unknowns) {
  MatrixXd S = MatrixXd::Zero(n, unknowns.size());
  for (std::size_t k = 0; k < unknowns.size(); ++k) S(unknowns[k].row, k) = unknowns[k].sign;
  return S;
}

void eliminate_free(const Problem& problem, const std::vector<Index>& free,
                    const MinimumNormSolver& solver, StandardProblem& standard) {
  const MatrixXd response = problem.M * standard.T;
  for (Eigen::Index k = 0; k < standard.T.cols(); ++k) {
    const VectorXd column = solver.solve(-sub_vector(response.col(k), free));
    for (std::size_t i = 0; i < free.size(); ++i) standard.T(free[i], k) = column[i];
  }
  const VectorXd rest = solver.solve(-sub_vector(problem.w(standard.origin), free));
  for (std::size_t i = 0; i < free.size(); ++i) standard.origin[free[i]] = rest[i];
}

// Appends the multipliers b >= 0 of upper - z >= 0: w = a - b, a >= 0.
void append_boxes(const Problem& problem, const Layout& layout, StandardProblem& standard) {
  const Eigen::Index n = standard.q.size(), m = static_cast<Eigen::Index>(layout.boxes.size());
  standard.M.conservativeResizeLike(MatrixXd::Zero(n + m, n + m));
  standard.q.conservativeResizeLike(VectorXd::Zero(n + m));
  standard.T.conservativeResizeLike(MatrixXd::Zero(problem.size(), n + m));
  for (Eigen::Index b = 0; b < m; ++b) {
    const Index k = layout.boxes[b], i = layout.unknowns[k].row;
    standard.M(k, n + b) = 1.0;
    standard.M(n + b, k) = -1.0;
    standard.q[n + b] = problem.upper[i] - problem.lower[i];
  }
}

}  // namespace

StandardProblem standard_form(const Problem& problem) {
  const Index n = problem.size();
  StandardProblem standard;
  standard.origin = VectorXd::Zero(n);
  Layout layout = layout_of(problem, standard.origin);
  const MinimumNormSolver solver(sub_matrix(problem.M, layout.free, layout.free));
  const bool regular = solver.rank() == static_cast<Index>(layout.free.size());
  if (!regular) {
    for (const Index i : layout.free) {
      layout.unknowns.push_back({i, 1.0});
      layout.unknowns.push_back({i, -1.0});
    }
  }
  const MatrixXd S = selection(n, layout.unknowns);
  standard.T = S;
  if (regular) eliminate_free(problem, layout.free, solver, standard);
  standard.M = S.transpose() * problem.M * standard.T;
  standard.q = S.transpose() * problem.w(standard.origin);
  append_boxes(problem, layout, standard);
  return standard;
}

}  // namespace brainshift::mcp
