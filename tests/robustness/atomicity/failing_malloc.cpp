#include "robustness/atomicity/failing_malloc.hpp"

#include <dlfcn.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
namespace brainshift::test {
void let_allocation_fail(long, Failing) {}
bool stop_failing() { return false; }
long outstanding_allocations() { return 0; }
bool failed_in_metis() { return false; }
bool can_fail() { return false; }
}  // namespace brainshift::test
#else

namespace {
std::atomic<long> countdown{-1};  // allocations until the one that fails; negative: none fails
std::atomic<bool> onwards{false}, failed{false}, in_metis{false};
std::atomic<long> outstanding{0};

// GCC's OpenMP, in which CHOLMOD is built, ends the process when it gets no memory for a team (2 kB).
// No caller can help that, so its allocations are not made to fail.
bool is_of(const char* library, const void* caller) {
  Dl_info info;
  return dladdr(caller, &info) != 0 && info.dli_fname && std::strstr(info.dli_fname, library);
}

bool fails_now(const void* caller) {
  if (countdown.load(std::memory_order_relaxed) < 0) return false;
  if (countdown.load(std::memory_order_relaxed) == 0 && is_of("libgomp", caller)) return false;
  const long left = countdown.fetch_sub(1);
  if (left > 0) return false;
  if (onwards) countdown = 0;
  if (is_of("libmetis", caller)) in_metis = true;
  failed = true;
  errno = ENOMEM;
  return true;
}

void* counted(void* memory) {
  if (memory) ++outstanding;
  return memory;
}
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
void free(void*);

void* malloc(std::size_t size) {
  return fails_now(__builtin_return_address(0)) ? nullptr : counted(__libc_malloc(size));
}
void* calloc(std::size_t count, std::size_t size) {
  return fails_now(__builtin_return_address(0)) ? nullptr : counted(__libc_calloc(count, size));
}
void* realloc(void* memory, std::size_t size) {
  if (memory && size == 0) {  // glibc frees, which cannot fail; Eigen takes null for that
    free(memory);
    return nullptr;
  }
  if (fails_now(__builtin_return_address(0))) return nullptr;
  void* const result = __libc_realloc(memory, size);
  if (!memory && result) ++outstanding;
  return result;
}
void* memalign(std::size_t alignment, std::size_t size) {
  return fails_now(__builtin_return_address(0)) ? nullptr
                                                : counted(__libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  *memory = memalign(alignment, size);  // the caller is taken to be none of OpenMP's
  return *memory ? 0 : ENOMEM;
}
void free(void* memory) {
  if (memory) --outstanding;
  __libc_free(memory);
}
}

namespace brainshift::test {

void let_allocation_fail(long k, Failing how) {
  onwards = how == Failing::onwards;
  failed = in_metis = false;
  countdown = k;
}

bool stop_failing() {
  countdown = -1;
  return failed;
}

long outstanding_allocations() { return outstanding; }
bool failed_in_metis() { return in_metis; }
bool can_fail() { return true; }

}  // namespace brainshift::test

#endif
