// SPDX-License-Identifier: Apache-2.0
#include "tri_tri_words.h"

#include <math.h>
#include <string.h>

enum { COORD_W = 16 };

int cchip_tri_tri_words(const double a[9], const double b[9], struct cchip_words *words) {
  double middle[3], span = 0;
  for (int axis = 0; axis < 3; ++axis) {
    double least = INFINITY, greatest = -INFINITY;
    for (int vertex = 0; vertex < 3; ++vertex) {
      const double x = a[3 * vertex + axis], y = b[3 * vertex + axis];
      if (!isfinite(x) || !isfinite(y)) return -1;
      least = fmin(least, fmin(x, y));
      greatest = fmax(greatest, fmax(x, y));
    }
    middle[axis] = least / 2 + greatest / 2;
    span = fmax(span, greatest - least);
  }
  if (!(span > 0) || !isfinite(span)) return -1;
  /* The finest grid on which the pair's box, rounded, fits into 16 bits around its middle. */
  words->exponent = ilogb(span) + 1 - COORD_W;
  while (ldexp(span, -words->exponent) > (1 << COORD_W) - 4) ++words->exponent;
  words->eta = 0;
  memset(words->a, 0, sizeof words->a);
  memset(words->b, 0, sizeof words->b);
  for (int i = 0; i < 9; ++i) {
    const double origin = nearbyint(ldexp(middle[i % 3], -words->exponent)); /* whole steps */
    for (int which = 0; which < 2; ++which) {
      const double steps = ldexp(which == 0 ? a[i] : b[i], -words->exponent);
      const double rounded = nearbyint(steps);
      if (rounded != steps) words->eta = 1;
      const uint64_t bits = (uint16_t)(int16_t)(rounded - origin);
      (which == 0 ? words->a : words->b)[i / 4] |= bits << (16 * (i % 4));
    }
  }
  return 0;
}
