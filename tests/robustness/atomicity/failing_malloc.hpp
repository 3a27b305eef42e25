// An allocator that fails on demand: operator new, and all that Eigen, SuiteSparse, METIS, zlib and the
// C library take from malloc. Only for a program of its own: it replaces malloc for the whole process.
// Under a sanitizer, which has its own malloc, nothing fails and tests skip.
#pragma once

namespace brainshift::test {

enum class Failing {
  once,    // allocation k alone
  onwards  // k and all that follow
};

// Counts allocations of the process from now on and lets number k (0, 1, ...) fail.
void let_allocation_fail(long k, Failing how);
// No more failures; true: an allocation has failed since.
bool stop_failing();
// Allocations that have not been freed.
long outstanding_allocations();
// METIS returns an error where it gets no memory, but not all of what it had.
bool failed_in_metis();
bool can_fail();  // false under a sanitizer

}  // namespace brainshift::test
