#include "mcp/validation.hpp"

#include <cmath>
#include <limits>

#include "brainshift/error.hpp"

namespace brainshift::mcp {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

[[noreturn]] void refuse(ErrorCode code, const std::string& what) {
  throw Error(code, "solve_mcp: " + what);
}

std::string at(const char* name, Eigen::Index i) {
  return std::string(name) + "[" + std::to_string(i) + "]";
}

void check_size(const char* name, Eigen::Index size, Eigen::Index expected) {
  if (size == expected) return;
  refuse(ErrorCode::size_mismatch, std::string(name) + " has " + std::to_string(size) +
                                       " entries, M has " + std::to_string(expected) + " rows");
}

void check_bounds(Eigen::Index i, double lower, double upper) {
  if (std::isnan(lower)) refuse(ErrorCode::not_finite, at("lower", i) + " is not a number");
  if (std::isnan(upper)) refuse(ErrorCode::not_finite, at("upper", i) + " is not a number");
  if (lower > upper) {
    refuse(ErrorCode::invalid_argument, at("lower", i) + " is above " + at("upper", i));
  }
  if (lower == infinity) refuse(ErrorCode::invalid_argument, at("lower", i) + " is +infinity");
  if (upper == -infinity) refuse(ErrorCode::invalid_argument, at("upper", i) + " is -infinity");
}

}  // namespace

void validate(const Eigen::MatrixXd& M, const Eigen::VectorXd& q, const Eigen::VectorXd& lower,
              const Eigen::VectorXd& upper, const McpOptions& options) {
  if (M.rows() != M.cols()) {
    refuse(ErrorCode::size_mismatch,
           "M is " + std::to_string(M.rows()) + " x " + std::to_string(M.cols()) + ", not square");
  }
  check_size("q", q.size(), M.rows());
  check_size("lower", lower.size(), M.rows());
  check_size("upper", upper.size(), M.rows());
  for (Eigen::Index i = 0; i < M.rows(); ++i) {
    if (!std::isfinite(q[i])) refuse(ErrorCode::not_finite, at("q", i) + " is not finite");
    check_bounds(i, lower[i], upper[i]);
    for (Eigen::Index j = 0; j < M.cols(); ++j) {
      if (std::isfinite(M(i, j))) continue;
      refuse(ErrorCode::not_finite,
             "M(" + std::to_string(i) + ", " + std::to_string(j) + ") is not finite");
    }
  }
  if (!std::isfinite(options.noise) || options.noise < 0.0) {
    refuse(ErrorCode::invalid_argument, "noise is not a number of zero or more");
  }
  if (!std::isfinite(options.tolerance) || options.tolerance < 0.0) {
    refuse(ErrorCode::invalid_argument, "tolerance is not a number of zero or more");
  }
  if (options.max_iterations < 0 || options.max_pivots < 0 || options.max_sweeps < 0) {
    refuse(ErrorCode::invalid_argument,
           "max_iterations, max_pivots and max_sweeps must be zero or more");
  }
}

}  // namespace brainshift::mcp
