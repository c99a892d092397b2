// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "layout.hpp"

TEST_CASE("layout: no type of the interface depends on the instruction set", "[lib][collide]") {
  CHECK(cchip_test::layout_plain[1] == alignof(double));
  CHECK(cchip_test::layout_plain == cchip_test::layout_wide);
}
