// Threads of the dense kernels that the linear solver stands on.
#pragma once

namespace brainshift {

// As many as they may use now, the calling one among them. 0: they do not tell.
int blas_threads();

}  // namespace brainshift
