// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_mul_wide.hpp>

#include "multiplier_bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_mul_wide: exact products after the generated latency", "[unit][cchip_mul_wide]",
                        cchip_mul_wide_configs) {
  compare_multiplier<typename TestType::Model>(
      TestType::A_W, TestType::B_W, defs::mul_latency(TestType::A_W, TestType::B_W) + TestType::PRODUCT_REGS, 30000);
}
