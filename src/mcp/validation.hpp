// What solve_mcp() refuses.
#pragma once

#include "brainshift/mcp.hpp"

namespace brainshift::mcp {

// Throws Error: size_mismatch, not_finite, invalid_argument.
void validate(const Eigen::MatrixXd& M, const Eigen::VectorXd& q, const Eigen::VectorXd& lower,
              const Eigen::VectorXd& upper, const McpOptions& options);

}  // namespace brainshift::mcp
