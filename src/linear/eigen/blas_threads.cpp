#include "linear/blas_threads.hpp"

namespace brainshift {

// Eigen's kernels, which the library is built with, run on the calling thread.
int blas_threads() { return 1; }

}  // namespace brainshift
