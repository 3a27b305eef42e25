// Time spent in a part of a solve.
#pragma once

#include <chrono>

namespace brainshift {

// Adds the seconds between its construction and its end to a total.
class Stopwatch {
 public:
  explicit Stopwatch(double& total) : m_total(total), m_start(clock::now()) {}
  ~Stopwatch() { m_total += std::chrono::duration<double>(clock::now() - m_start).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  using clock = std::chrono::steady_clock;
  double& m_total;
  clock::time_point m_start;
};

}  // namespace brainshift
