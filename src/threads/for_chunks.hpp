// Work cut into chunks that a few threads share. Which thread takes a chunk is left open, so each
// chunk must write to places of its own; what is computed then does not depend on the number of
// threads. All threads have ended when the call returns.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

#include "brainshift/types.hpp"

namespace brainshift {

// Calls work(chunk) for chunk = 0 .. chunks - 1 on `threads` threads, the calling one among them.
// What a call throws is thrown here; of several, that of the lowest chunk.
inline void for_chunks(int threads, Index chunks, const std::function<void(Index)>& work) {
  if (threads <= 1 || chunks <= 1) {
    for (Index c = 0; c < chunks; ++c) work(c);
    return;
  }
  std::atomic<Index> next{0};
  std::vector<std::exception_ptr> thrown;
  thrown.resize(std::size_t(chunks));
  const auto take = [&] {
    for (Index c = next++; c < chunks; c = next++) {
      try {
        work(c);
      } catch (...) {
        thrown[std::size_t(c)] = std::current_exception();
      }
    }
  };
  std::vector<std::thread> helpers;
  helpers.reserve(std::size_t(threads));
  try {
    for (int t = 1; t < std::min<int>(threads, chunks); ++t) helpers.emplace_back(take);
  } catch (...) {
    // No more threads to be had, or no memory for them: those that run, and this one, do the work.
  }
  take();
  for (std::thread& helper : helpers) helper.join();
  for (const std::exception_ptr& e : thrown) {
    if (e) std::rethrow_exception(e);
  }
}

// Half-open range of `count` items that chunk c of `chunks` holds.
struct ChunkRange {
  Index from, to;
};
inline ChunkRange chunk_range(Index count, Index chunks, Index c) {
  const auto cut = [&](Index k) { return Index(std::int64_t(count) * k / chunks); };
  return {cut(c), cut(c + 1)};
}

}  // namespace brainshift
