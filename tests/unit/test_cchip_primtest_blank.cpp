// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_primtest_blank.hpp>

#include "primtest_bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEST_CASE("cchip_primtest_blank: constant outputs, never ready, never valid, idle", "[unit][cchip_primtest_blank]") {
  require_never_answers<cchip_primtest_blank>();
}
