// SPDX-License-Identifier: Apache-2.0
/// \file
/// For files whose error bounds are proven for IEEE 754 operations as they are written: anything else does not compile.
#ifndef CCHIP_EXACT_IEEE_HPP
#define CCHIP_EXACT_IEEE_HPP

#include <cfloat>
#include <limits>

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0)
#error "exact arithmetic needs IEEE 754 as it is written: compile this file without -ffast-math and -Ofast"
#endif
static_assert(FLT_EVAL_METHOD == 0, "operations must round to their own type: compile for SSE2, not for the x87");
static_assert(std::numeric_limits<double>::is_iec559 && std::numeric_limits<float>::is_iec559);

#endif
