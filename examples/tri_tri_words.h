// SPDX-License-Identifier: Apache-2.0
/* From two triangles in doubles to the ports of cchip_primtest_tri_tri with COORD_W = 16. */
#ifndef CCHIP_EXAMPLES_TRI_TRI_WORDS_H
#define CCHIP_EXAMPLES_TRI_TRI_WORDS_H

#include <stdint.h>

struct cchip_words {
  int exponent;     /* a step of the grid is 2^exponent of the caller's length unit */
  uint64_t a[3];    /* s_pair_a[143:0], lowest bits first: vertex 0 x, y, z, vertex 1 x, ... of 16 bits each */
  uint64_t b[3];    /* s_pair_b, likewise; the bits of the fourth vertices are 0 */
  unsigned eta;     /* s_pair_err: 0 nothing was rounded, 1 every coordinate to the nearest step */
};

/* a, b: three vertices of x, y, z each. Returns 0, or -1 if a coordinate is not finite or all of them are in one point. */
int cchip_tri_tri_words(const double a[9], const double b[9], struct cchip_words *words);

#endif
