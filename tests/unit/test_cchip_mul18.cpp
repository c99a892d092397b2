// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_mul18.hpp>

#include "multiplier_bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEST_CASE("cchip_mul18: exact products after two clocks", "[unit][cchip_mul18]") {
  compare_multiplier<Vcchip_mul18>(18, 18, defs::mul18_latency, 100000);
}
