// SPDX-License-Identifier: Apache-2.0
#include <Vtq_w16_s10_rel___024root.h>

#include <models/cchip_primtest_tri_quad.hpp>

#include "primtest_bench.hpp"

CCHIP_WATCH(tq_w16_s10_rel);

using namespace cchip;
using namespace cchip::test;

#define CCHIP_CASE(name, check)                                                                \
  TEMPLATE_LIST_TEST_CASE("cchip_primtest_tri_quad: " name, "[unit][cchip_primtest_tri_quad]", \
                          cchip_primtest_tri_quad_configs) {                                   \
    check(primtest_config<TestType>(ModuleId::tri_quad));                                      \
  }

CCHIP_CASE("every output on every clock is the model's", check_every_clock)
CCHIP_CASE("long traffic", check_long_traffic)
CCHIP_CASE("extreme coordinates", check_extreme_coordinates)
CCHIP_CASE("each axis is the witness of the pair that it alone separates", check_only_witness)
CCHIP_CASE("latency of a lone pair", check_lone_pair_latency)
CCHIP_CASE("drains within its bound, keeps all results without ready", check_drain)
CCHIP_CASE("no output follows an input before the rising edge", check_registered_outputs)
CCHIP_CASE("no old tag after reset, whenever it comes", check_no_old_tags)

TEST_CASE("cchip_primtest_tri_quad: an axis on 99 % of the clocks while pairs wait",
          "[unit][cchip_primtest_tri_quad]") {
  check_throughput(primtest_config<tq_w16_s10_rel>(ModuleId::tri_quad));
}
