// Bytes that the process has from malloc: operator new, and what Eigen, SuiteSparse, METIS and the BLAS take.
// Only for a program of its own, with heap.cpp: it replaces malloc for the whole process. Under a sanitizer,
// which has its own malloc, nothing is counted.
#pragma once

#include <cstdint>

namespace brainshift::test {

bool heap_is_counted();
std::int64_t heap_in_use();
// The most there has been since forget_peak().
std::int64_t heap_peak();
void forget_peak();

}  // namespace brainshift::test
