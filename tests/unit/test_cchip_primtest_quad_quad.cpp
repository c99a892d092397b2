// SPDX-License-Identifier: Apache-2.0
#include <Vqq_w16_s10_rel___024root.h>

#include <models/cchip_primtest_quad_quad.hpp>

#include "primtest_bench.hpp"

CCHIP_WATCH(qq_w16_s10_rel);

using namespace cchip;
using namespace cchip::test;

CCHIP_PRIMTEST_CASES(quad_quad)

TEST_CASE("cchip_primtest_quad_quad: an axis on 99 % of the clocks while pairs wait",
          "[unit][cchip_primtest_quad_quad]") {
  check_throughput(primtest_config<qq_w16_s10_rel>(ModuleId::quad_quad));
}
