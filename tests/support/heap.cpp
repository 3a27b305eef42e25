#include "support/heap.hpp"

#include <malloc.h>

#include <atomic>
#include <cerrno>
#include <cstddef>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
namespace brainshift::test {
bool heap_is_counted() { return false; }
std::int64_t heap_in_use() { return 0; }
std::int64_t heap_peak() { return 0; }
void forget_peak() {}
}  // namespace brainshift::test
#else

namespace {
std::atomic<std::int64_t> in_use{0}, peak{0};

void* taken(void* memory) {
  if (!memory) return nullptr;
  const std::int64_t now = in_use += std::int64_t(malloc_usable_size(memory));
  std::int64_t most = peak.load(std::memory_order_relaxed);
  while (now > most && !peak.compare_exchange_weak(most, now)) {}
  return memory;
}

void given_back(void* memory) {
  if (memory) in_use -= std::int64_t(malloc_usable_size(memory));
}
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) { return taken(__libc_malloc(size)); }
void* calloc(std::size_t count, std::size_t size) { return taken(__libc_calloc(count, size)); }
void* realloc(void* memory, std::size_t size) {
  const auto before = memory ? std::int64_t(malloc_usable_size(memory)) : 0;
  void* const result = __libc_realloc(memory, size);
  if (result || size == 0) in_use -= before;
  return taken(result);
}
void* memalign(std::size_t alignment, std::size_t size) { return taken(__libc_memalign(alignment, size)); }
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  *memory = memalign(alignment, size);
  return *memory ? 0 : ENOMEM;
}
void free(void* memory) {
  given_back(memory);
  __libc_free(memory);
}
}

namespace brainshift::test {

bool heap_is_counted() { return true; }
std::int64_t heap_in_use() { return in_use; }
std::int64_t heap_peak() { return peak; }
void forget_peak() { peak = in_use.load(); }

}  // namespace brainshift::test
#endif
