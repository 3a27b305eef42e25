// Nested dissection: a permutation, always the same, and no trace of it in the process.
#include "linear/ordering.hpp"

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include <gtest/gtest.h>

namespace brainshift {
namespace {

// A grid of n x n blocks, each linked to its four neighbours.
std::vector<Indices> grid(Index n) {
  std::vector<Indices> near(static_cast<std::size_t>(n * n));
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      Indices& list = near[std::size_t(i + n * j)];
      if (j > 0) list.push_back(i + n * (j - 1));
      if (i > 0) list.push_back(i - 1 + n * j);
      if (i + 1 < n) list.push_back(i + 1 + n * j);
      if (j + 1 < n) list.push_back(i + n * (j + 1));
    }
  }
  return near;
}

void on_signal(int) {}

TEST(Ordering, IsAPermutation) {
  for (Index n : {1, 2, 3, 40}) {
    Indices position = nested_dissection(grid(n));
    std::sort(position.begin(), position.end());
    for (std::size_t i = 0; i < position.size(); ++i) EXPECT_EQ(position[i], Index(i));
    EXPECT_EQ(position.size(), std::size_t(n * n));
  }
  EXPECT_TRUE(nested_dissection({}).empty());
}

TEST(Ordering, OfBlocksWithoutNeighboursIsAPermutation) {
  Indices position = nested_dissection(std::vector<Indices>(10));
  std::sort(position.begin(), position.end());
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(position[i], Index(i));
}

TEST(Ordering, IsTheSameEveryTimeWhateverTheHostsSeed) {
  std::srand(1);
  const Indices first = nested_dissection(grid(40));
  std::srand(99);
  EXPECT_EQ(first, nested_dissection(grid(40)));
}

TEST(Ordering, LeavesTheHostsRandomNumbersAsTheyWere) {
  std::srand(42);
  (void)std::rand();
  const int expected[3] = {std::rand(), std::rand(), std::rand()};
  std::srand(42);
  (void)std::rand();
  (void)nested_dissection(grid(40));
  for (int number : expected) EXPECT_EQ(std::rand(), number);
}

TEST(Ordering, LeavesTheHostsSignalHandlersAsTheyWere) {
  struct sigaction mine {
  }, before_abort, before_term, now;
  mine.sa_handler = on_signal;
  sigaction(SIGABRT, &mine, &before_abort);
  sigaction(SIGTERM, &mine, &before_term);
  (void)nested_dissection(grid(40));
  sigaction(SIGABRT, &before_abort, &now);
  EXPECT_EQ(now.sa_handler, on_signal);
  sigaction(SIGTERM, &before_term, &now);
  EXPECT_EQ(now.sa_handler, on_signal);
}

TEST(Ordering, SavesFillOnAGrid) {
  // Fill of a factor by simulated elimination: nested dissection beats the given order.
  const auto fill = [](const std::vector<Indices>& near, const Indices& position) {
    const std::size_t n = near.size();
    std::vector<std::vector<bool>> linked(n, std::vector<bool>(n, false));
    for (std::size_t i = 0; i < n; ++i) {
      for (Index k : near[i])
        linked[std::size_t(position[i])][std::size_t(position[std::size_t(k)])] = true;
    }
    std::size_t count = 0;
    for (std::size_t p = 0; p < n; ++p) {
      std::vector<std::size_t> later;
      for (std::size_t q = p + 1; q < n; ++q) {
        if (linked[p][q]) later.push_back(q);
      }
      count += later.size();
      for (std::size_t a : later) {
        for (std::size_t b : later) linked[a][b] = true;
      }
    }
    return count;
  };
  const auto near = grid(20);
  Indices natural(near.size());
  for (std::size_t i = 0; i < natural.size(); ++i) natural[i] = Index(i);
  EXPECT_LT(double(fill(near, nested_dissection(near))), 0.7 * double(fill(near, natural)));
}

}  // namespace
}  // namespace brainshift
