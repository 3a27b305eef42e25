// The header alone, first in the file.
#include "brainshift/c/brainshift.h"

int brainshift_header_compiles();
int brainshift_header_compiles() { return int(sizeof(brs_solve_report)); }
