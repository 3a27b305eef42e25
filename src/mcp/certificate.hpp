// What can be said about a solution: its rank and whether it is the only one.
#pragma once

#include "mcp/problem.hpp"

namespace brainshift::mcp {

struct Uniqueness {
  Index inner;  // rows strictly between their bounds
  Index rank;   // of those rows and columns of M
  bool unique;
};

// Looks at the rows that may move: those between their bounds, and those at a bound with w = 0.
// Regular there: no other solution nearby, and none at all where M is monotone or a P-matrix.
Uniqueness uniqueness_of(const Problem& problem, const VectorXd& z);

}  // namespace brainshift::mcp
