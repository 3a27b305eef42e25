// One thread at a time where the BLAS cannot bear two.
#pragma once

#include <mutex>

// Of OpenBLAS, 0: its serial build. Null with any other BLAS.
extern "C" int openblas_get_parallel(void) __attribute__((weak));

namespace brainshift {

// The serial build of OpenBLAS shares its buffers among threads without a lock: two threads in its
// dtrsm, be it in two solvers, spoil each other's numbers. They take turns then.
// docs/decisions/threads.md
class BlasTurn {
 public:
  BlasTurn() {
    if (openblas_get_parallel && openblas_get_parallel() == 0) m_lock = std::unique_lock(mutex());
  }

 private:
  static std::mutex& mutex() {
    static std::mutex m;
    return m;
  }
  std::unique_lock<std::mutex> m_lock;
};

}  // namespace brainshift
