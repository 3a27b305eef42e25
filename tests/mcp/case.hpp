// A complementarity problem, without what only tests need.
#pragma once

#include <limits>

#include <Eigen/Core>

namespace brainshift::test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double inf = std::numeric_limits<double>::infinity();

struct Case {
  MatrixXd M;
  VectorXd q, lower, upper;
};

inline Case one_sided(const MatrixXd& M, const VectorXd& q) {
  const Eigen::Index n = q.size();
  return {M, q, VectorXd::Zero(n), VectorXd::Constant(n, inf)};
}

}  // namespace brainshift::test
