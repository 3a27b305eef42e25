// Eigen allocates and aligns by the vector flags of the compiler (-mavx, -march=native), and otherwise
// again under the address sanitizer. A program that does so otherwise than the library would free what
// it did not allocate, and crash. It does not link instead: the linker names the symbol below, and with
// it how the program aligns and whether it takes malloc() as aligned.
#pragma once

#include <Eigen/Core>

#define BRAINSHIFT_EIGEN_ABI_NAME(heap, fixed, plain)                                  \
  brainshift_is_built_with_other_vector_flags__this_program_aligns_by_##heap##_and_##fixed \
      ##_malloc_##plain
#define BRAINSHIFT_EIGEN_ABI_EXPANDED(heap, fixed, plain) BRAINSHIFT_EIGEN_ABI_NAME(heap, fixed, plain)
#define BRAINSHIFT_EIGEN_ABI                                                         \
  BRAINSHIFT_EIGEN_ABI_EXPANDED(EIGEN_MAX_ALIGN_BYTES, EIGEN_MAX_STATIC_ALIGN_BYTES, \
                                EIGEN_MALLOC_ALREADY_ALIGNED)

namespace brainshift {

extern const char BRAINSHIFT_EIGEN_ABI;   // src/eigen_abi.cpp
namespace {
[[gnu::used]] const char* const required_eigen_abi = &BRAINSHIFT_EIGEN_ABI;  // NOLINT(misc-definitions-in-headers): each file has its own
}

}  // namespace brainshift
