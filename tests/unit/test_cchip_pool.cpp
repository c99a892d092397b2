// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <models/cchip_pool.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_pool: each number has one borrower, the numbers are the model's on every clock",
                        "[unit][cchip_pool]", cchip_pool_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    constexpr std::size_t first = TestType::FIRST;
    constexpr std::size_t count = TestType::COUNT;
    auto& top = simulation.top();
    model::Pool model(count, first);
    std::vector<std::size_t> lent;
    top.m_ready = top.back_valid = 0;
    simulation.reset();
    model.reset();
    std::size_t all = 0;
    for (int clock = 0; clock < 20000; ++clock) {
      const int hurry = clock / 200 % 2 == 0 ? 90 : 20;
      top.m_ready = chance(random, hurry) ? 1 : 0;
      std::optional<std::size_t> back;
      if (!lent.empty() && chance(random, 100 - hurry)) {
        std::swap(lent[random() % lent.size()], lent.back());
        back = lent.back();
        lent.pop_back();
      }
      top.back_valid = back ? 1 : 0;
      top.back_number = static_cast<CData>(back.value_or(random() % 2));
      top.rst = chance(random, clock % 3000 > 2900 ? 2 : 0) ? 1 : 0;
      simulation.settle();
      REQUIRE((top.m_valid != 0) == model.m_valid());
      if (model.m_valid()) REQUIRE(std::size_t{top.m_number} == model.m_number());
      if (top.rst == 0 && top.m_valid != 0 && top.m_ready != 0) {
        REQUIRE((top.m_number >= first && top.m_number < first + count));
        REQUIRE(std::find(lent.begin(), lent.end(), std::size_t{top.m_number}) == lent.end());
        lent.push_back(top.m_number);
      }
      all += lent.size() == count ? 1 : 0;
      model.clock(top.m_ready != 0, back);
      if (top.rst != 0) {
        model.reset();
        lent.clear();
      }
      simulation.rise();
    }
    REQUIRE(all > 100);
  });
}
