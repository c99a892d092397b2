// SPDX-License-Identifier: Apache-2.0
/// \file
/// A third, independent answer for the tests: exact linear programming.
#ifndef CCHIP_TESTS_REF_LINEAR_PROGRAMME_HPP
#define CCHIP_TESTS_REF_LINEAR_PROGRAMME_HPP

#include <cchip/internal/wire/pair.hpp>
#include <cchip/primitive.hpp>

namespace cchip_test {

/// Do the hulls of the vertices share a point? Exact for every finite input, some 0.1 ms per pair.
bool linear_programme_intersects(const cchip::GridPrimitive& a, const cchip::GridPrimitive& b);
bool linear_programme_intersects(const cchip::Primitive& a, const cchip::Primitive& b);

}  // namespace cchip_test

#endif
