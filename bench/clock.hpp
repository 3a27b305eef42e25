// Seconds since its construction: CPU seconds of all threads, which bear a busy machine, and wall time.
#pragma once

#include <chrono>
#include <ctime>

namespace bench {

class Clock {
 public:
  double cpu() const { return double(std::clock() - m_cpu) / CLOCKS_PER_SEC; }
  double wall() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - m_wall).count();
  }

 private:
  std::clock_t m_cpu = std::clock();
  std::chrono::steady_clock::time_point m_wall = std::chrono::steady_clock::now();
};

}  // namespace bench
