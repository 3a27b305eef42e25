#include "mesh/quadratic_tet.hpp"

#include <cmath>

namespace brainshift {
namespace {

std::array<TetQuadraturePoint, 4> four_points() {
  const double b = (5.0 - std::sqrt(5.0)) / 20.0, a = 1.0 - 3.0 * b;
  std::array<TetQuadraturePoint, 4> rule;
  for (int k = 0; k < 4; ++k) {
    rule[std::size_t(k)] = {Eigen::Vector4d::Constant(b), 0.25};
    rule[std::size_t(k)].L[k] = a;
  }
  return rule;
}

// Two orbits of four points (b, b, b, 1 - 3 b), one of six (c, c, 1/2 - c, 1/2 - c).
std::array<TetQuadraturePoint, 14> fourteen_points() {
  const double b[2] = {0.31088591926330060980, 0.092735250310891226402};
  const double weight[2] = {0.11268792571801585080, 0.073493043116361949544};
  const double c = 0.045503704125649649492, rest = 0.042546020777081466438;
  std::array<TetQuadraturePoint, 14> rule;
  std::size_t n = 0;
  for (int orbit = 0; orbit < 2; ++orbit) {
    for (int k = 0; k < 4; ++k, ++n) {
      rule[n] = {Eigen::Vector4d::Constant(b[orbit]), weight[orbit]};
      rule[n].L[k] = 1.0 - 3.0 * b[orbit];
    }
  }
  for (const auto& edge : tet_edges) {
    rule[n] = {Eigen::Vector4d::Constant(0.5 - c), rest};
    rule[n].L[edge[0]] = rule[n].L[edge[1]] = c;
    ++n;
  }
  return rule;
}

}  // namespace

const std::array<TetQuadraturePoint, 4>& tet_rule_2() {
  static const std::array<TetQuadraturePoint, 4> rule = four_points();
  return rule;
}

const std::array<TetQuadraturePoint, 14>& tet_rule_5() {
  static const std::array<TetQuadraturePoint, 14> rule = fourteen_points();
  return rule;
}

}  // namespace brainshift
