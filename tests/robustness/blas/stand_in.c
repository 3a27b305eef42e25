/* Answers as a BLAS of some kind does when it is asked how many threads it uses, and computes nothing. Loaded
 * before the others (LD_PRELOAD), so that every kind can be met on every machine. */
#include <stdint.h>

#if defined(STAND_IN_OPENBLAS)
int openblas_get_parallel(void) { return 1; }
int openblas_get_num_threads(void) { return 3; }
#elif defined(STAND_IN_SERIAL)
int openblas_get_parallel(void) { return 0; }
int openblas_get_num_threads(void) { return 8; } /* which the serial build does not use */
#elif defined(STAND_IN_MKL)
int MKL_Get_Max_Threads(void) { return 5; }
#elif defined(STAND_IN_BLIS)
int64_t bli_info_get_enable_threading(void) { return 1; }
int64_t bli_thread_get_num_threads(void) { return -1; } /* ways are set loop by loop */
#endif
