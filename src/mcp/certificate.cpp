#include "mcp/certificate.hpp"

#include <cmath>

#include "mcp/minimum_norm.hpp"

namespace brainshift::mcp {
namespace {

constexpr double touching = 1e-9;  // of the largest term of the problem: rounding, not a gap

struct Movable {
  std::vector<Index> rows;        // inner ones first
  std::vector<double> direction;  // 0: both ways, +1: up only, -1: down only
  Index inner = 0;
};

Movable movable_rows(const Problem& problem, const VectorXd& z) {
  const VectorXd w = problem.w(z);
  const double scale = (problem.M.cwiseAbs() * z.cwiseAbs() + problem.q.cwiseAbs()).maxCoeff();
  const double near_z = touching * std::max(z.cwiseAbs().maxCoeff(), scale);
  const double near_w = touching * scale;
  Movable movable;
  std::vector<Index> at_bound;
  for (Index i = 0; i < problem.size(); ++i) {
    const bool low = z[i] - problem.lower[i] <= near_z, high = problem.upper[i] - z[i] <= near_z;
    if (!low && !high) {
      movable.rows.push_back(i);
      movable.direction.push_back(0.0);
    } else if (low != high && std::abs(w[i]) <= near_w) {
      at_bound.push_back(i);
    }
  }
  movable.inner = static_cast<Index>(movable.rows.size());
  for (const Index i : at_bound) {
    movable.rows.push_back(i);
    movable.direction.push_back(z[i] - problem.lower[i] <= near_z ? 1.0 : -1.0);
  }
  return movable;
}

// May z + t x, t > 0, stay between the bounds?
bool admissible(const VectorXd& x, const std::vector<double>& direction) {
  constexpr double zero = 1e-7;  // of a vector of length 1; a null vector is known to ~1e-10
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (x[i] * direction[i] < -zero) return false;
  }
  return true;
}

// The null vector of a matrix with exactly one: what the pseudo-inverse removes from any vector.
VectorXd null_vector(const MatrixXd& A, const MinimumNormSolver& solver) {
  VectorXd longest = VectorXd::Zero(A.rows());
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    const VectorXd unit = VectorXd::Unit(A.rows(), i);
    const VectorXd rest = unit - solver.solve(A * unit);
    if (rest.norm() > longest.norm()) longest = rest;
    if (longest.squaredNorm() * static_cast<double>(A.rows()) > 0.5) break;
  }
  return longest.normalized();
}

}  // namespace

Uniqueness uniqueness_of(const Problem& problem, const VectorXd& z) {
  if (problem.size() == 0) return {0, 0, true};
  const Movable movable = movable_rows(problem, z);
  const std::vector<Index> inner(movable.rows.begin(), movable.rows.begin() + movable.inner);
  const Index rank = MinimumNormSolver(sub_matrix(problem.M, inner, inner)).rank();
  const Index size = static_cast<Index>(movable.rows.size());
  if (size == movable.inner) return {movable.inner, rank, rank == size};

  const MatrixXd A = sub_matrix(problem.M, movable.rows, movable.rows);
  const MinimumNormSolver solver(A);
  bool unique = solver.rank() == size;
  if (solver.rank() == size - 1) {
    const VectorXd x = null_vector(A, solver);
    unique = !admissible(x, movable.direction) && !admissible(-x, movable.direction);
  }
  return {movable.inner, rank, unique};
}

}  // namespace brainshift::mcp
