/* The scene of the small examples, as arrays: a block of soft tissue, 60 mm wide, that stands on the
 * floor of a box full of cerebrospinal fluid, 10 mm of it above the block. For C and C++.
 *
 *        +-----------+  wall, 70 mm high
 *        | ~~~~~~~~~ |  fluid
 *        | ~+-----+~ |
 *        | ~|block|~ |
 *        +--+=====+--+  held base
 */
#ifndef BRAINSHIFT_EXAMPLES_BLOCK_H
#define BRAINSHIFT_EXAMPLES_BLOCK_H

#include <stdint.h>

enum { CELLS = 6, SIDE = CELLS + 1, NODES = SIDE * SIDE * SIDE, TETS = 6 * CELLS * CELLS * CELLS };
enum { BASE_NODES = SIDE * SIDE }; /* nodes 0 .. BASE_NODES - 1 */

static const double block_wall[24] = {-20, -20, 0,  80, -20, 0,  -20, 80, 0,  80, 80, 0,
                                      -20, -20, 70, 80, -20, 70, -20, 80, 70, 80, 80, 70};
static const int32_t block_wall_triangles[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6,
                                                 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3,
                                                 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

/* nodes: NODES x 3, mm. tets: TETS x 4, either way round: six per cell, one for each order in which
 * x, y, z are climbed from corner to corner. */
static void make_block(double* nodes, int32_t* tets) {
  static const int climb[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  static const int32_t stride[3] = {1, SIDE, SIDE * SIDE};
  int i, a, c, t, step;
  for (i = 0; i < NODES; ++i)
    for (a = 0; a < 3; ++a) nodes[3 * i + a] = 60.0 / CELLS * (i / stride[a] % SIDE);
  for (c = 0; c < CELLS * CELLS * CELLS; ++c)
    for (t = 0; t < 6; ++t) {
      *tets++ = c % CELLS + SIDE * (c / CELLS % CELLS) + SIDE * SIDE * (c / CELLS / CELLS);
      for (step = 0; step < 3; ++step, ++tets) *tets = tets[-1] + stride[climb[t][step]];
    }
}

#endif
