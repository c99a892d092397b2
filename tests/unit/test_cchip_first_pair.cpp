// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_first_pair.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_first_pair: all sets of child pairs", "[unit][cchip_first_pair]",
                        cchip_first_pair_configs) {
  const auto top = std::make_unique<typename TestType::Model>();
  for (unsigned pairs = 0; pairs < 65536; ++pairs) {
    top->pairs = static_cast<std::uint16_t>(pairs);
    top->eval();
    unsigned first = 0;
    while (pairs != 0 && (pairs >> first & 1U) == 0) ++first;
    const unsigned rest = pairs & (pairs - 1);  // without the lowest bit
    if (pairs != 0) REQUIRE(top->first == first);
    REQUIRE(top->rest == rest);
    REQUIRE(top->several == (rest != 0 ? 1 : 0));
  }
}
