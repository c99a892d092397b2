// SPDX-License-Identifier: Apache-2.0
#ifndef CCHIP_TESTS_LIB_LAYOUT_HPP
#define CCHIP_TESTS_LIB_LAYOUT_HPP

#include <array>
#include <cstddef>

namespace cchip_test {

using Layout = std::array<std::size_t, 22>;
extern const Layout layout_plain;
extern const Layout layout_wide;  // for AVX-512

}  // namespace cchip_test

#endif
