// SPDX-License-Identifier: Apache-2.0
#include <Vtq_w16_s10_rel___024root.h>

#include <models/cchip_primtest_tri_quad.hpp>

#include "primtest_bench.hpp"

CCHIP_WATCH(tq_w16_s10_rel);

using namespace cchip;
using namespace cchip::test;

CCHIP_PRIMTEST_CASES(tri_quad)

TEST_CASE("cchip_primtest_tri_quad: an axis on 99 % of the clocks while pairs wait",
          "[unit][cchip_primtest_tri_quad]") {
  check_throughput(primtest_config<tq_w16_s10_rel>(ModuleId::tri_quad));
}
