// The BLAS is whichever the host has loaded, so its kind is asked for while the program runs: each of
// these is null unless a library of that kind is there.
#include "linear/blas_threads.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

extern "C" {
// OpenBLAS. 0: built without threads.
int openblas_get_parallel(void) __attribute__((weak));
int openblas_get_num_threads(void) __attribute__((weak));
// Intel's MKL.
int MKL_Get_Max_Threads(void) __attribute__((weak));
// BLIS. Below 1 where ways to divide each loop are set, or nothing is.
std::int64_t bli_info_get_enable_threading(void) __attribute__((weak));
std::int64_t bli_thread_get_num_threads(void) __attribute__((weak));
}

namespace brainshift {
namespace {

constexpr int does_not_tell = 0;

// Each: nothing where that library is not there.
std::optional<int> of_openblas() {
  if (!openblas_get_parallel) return {};
  if (openblas_get_parallel() == 0) return 1;
  return openblas_get_num_threads ? std::max(1, openblas_get_num_threads()) : does_not_tell;
}

std::optional<int> of_mkl() {
  if (!MKL_Get_Max_Threads) return {};
  return std::max(1, MKL_Get_Max_Threads());
}

std::optional<int> of_blis() {
  if (!bli_info_get_enable_threading || !bli_thread_get_num_threads) return {};
  if (bli_info_get_enable_threading() == 0) return 1;
  const std::int64_t count = bli_thread_get_num_threads();
  return count >= 1 ? int(count) : does_not_tell;
}

}  // namespace

// A process may hold several; which of them is called is not asked, the worst is said.
int blas_threads() {
  int most = does_not_tell;
  bool all_tell = true;
  for (const std::optional<int>& threads : {of_openblas(), of_mkl(), of_blis()}) {
    if (!threads) continue;
    most = std::max(most, *threads);
    all_tell = all_tell && *threads != does_not_tell;
  }
  return most > 1 || all_tell ? most : does_not_tell;
}

}  // namespace brainshift
