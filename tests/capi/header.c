/* The header alone, first in the file: compiled as C99, C17 and (as header.cpp) C++17. */
#include "brainshift/c/brainshift.h"

int brainshift_header_compiles(void);
int brainshift_header_compiles(void) { return (int)sizeof(brs_solve_report); }
