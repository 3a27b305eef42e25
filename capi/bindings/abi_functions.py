"""Writes a definition of every function, so that debug information holds the ABI of the header alone."""


def abi_functions(api):
    bodies = '\n'.join(f.declaration.removesuffix(';') + ' { return 0; }' for f in api.functions)
    return f'''/* Every function of the header, empty: what abidiff compares with the recorded ABI. The
 * functions of the library are held to the same header by its compiler, to the same names by the test capi.exports.
 * Written by capi/bindings/generate from include/brainshift/c/brainshift.h; do not edit. */
#include "brainshift/c/brainshift.h"

{bodies}
'''
