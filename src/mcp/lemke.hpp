// Lemke's complementary pivoting for the standard problem  w = M x + q, 0 <= w, x, w^T x = 0.
#pragma once

#include "mcp/problem.hpp"

namespace brainshift::mcp {

struct LemkeResult {
  enum class End { solved, ray, pivot_limit };
  End end = End::pivot_limit;
  VectorXd x;          // solved: the solution
  VectorXd direction;  // ray: the x part of it; separates where M is monotone
  int pivots = 0;
};

// Covering vector of ones; lexicographic ratio test, so degenerate problems do not cycle.
// The number of pivots can be exponential (Murty 1978; Fathi 1979): hence the cap.
LemkeResult lemke(const MatrixXd& M, const VectorXd& q, int max_pivots);

}  // namespace brainshift::mcp
