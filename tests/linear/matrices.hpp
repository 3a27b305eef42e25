// Random sparse symmetric matrices for the tests of this folder.
#pragma once

#include <random>
#include <set>

#include <Eigen/Dense>

#include "linear/block_matrix.hpp"

namespace brainshift::test {

// A ring of blocks with a few chords.
inline std::vector<Indices> ring(Index n, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::set<Index>> near(static_cast<std::size_t>(n));
  const auto link = [&](Index a, Index b) {
    if (a == b) return;
    near[std::size_t(a)].insert(b);
    near[std::size_t(b)].insert(a);
  };
  for (Index i = 0; i < n; ++i) {
    link(i, (i + 1) % n);
    link(i, Index(random() % std::uint32_t(n)));
  }
  std::vector<Indices> lists;
  for (const auto& s : near) lists.emplace_back(s.begin(), s.end());
  return lists;
}

// Symmetric; positive definite by a dominant diagonal unless `shift` says otherwise.
struct RandomMatrix {
  BlockMatrix blocks;
  Eigen::MatrixXd dense;
  RandomMatrix(Index n, unsigned seed, double shift = 30.0) : blocks(ring(n, seed)) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    dense.setZero(3 * n, 3 * n);
    const std::vector<Indices> near = ring(n, seed);
    for (Index i = 0; i < n; ++i) {
      Mat3 d = Mat3::NullaryExpr([&] { return entry(random); });
      d = (d + d.transpose()).eval() + shift * Mat3::Identity();
      dense.block<3, 3>(3 * i, 3 * i) = d;
      blocks.add_at(i, i, d);
      for (Index j : near[std::size_t(i)]) {
        if (j > i) continue;
        const Mat3 b = Mat3::NullaryExpr([&] { return entry(random); });
        dense.block<3, 3>(3 * i, 3 * j) = b;
        dense.block<3, 3>(3 * j, 3 * i) = b.transpose();
        blocks.add_at(i, j, b);
      }
    }
  }
};

}  // namespace brainshift::test
