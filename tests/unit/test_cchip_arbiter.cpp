// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_arbiter.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// The first request behind the source served last.
template <int N>
struct ArbiterModel {
  int last = N - 1;
  unsigned grant(unsigned request) const {
    for (int i = 1; i <= N; ++i) {
      const unsigned bit = 1U << ((last + i) % N);
      if ((request & bit) != 0) return bit;
    }
    return 0;
  }
  void clock(unsigned request, bool take) {
    const unsigned served = grant(request);
    for (int i = 0; take && i < N; ++i) {
      if ((served >> i & 1U) != 0) last = i;
    }
  }
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_arbiter: grant is the model's on every clock, no port waits for more than the others",
                        "[unit][cchip_arbiter]", cchip_arbiter_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    constexpr int n = TestType::N;
    auto& top = simulation.top();
    for (const int percent : {100, 60, 10, 0}) {  // 0: now and then one of four neighbours, so that sources are alone
      ArbiterModel<n> model;
      std::array<int, n> others{};
      top.request = 0;
      top.take = 0;
      simulation.reset();
      unsigned request = 0;
      for (int clock = 0; clock < (percent == 0 ? 20000 : 2000); ++clock) {
        if (chance(random, 3)) request = 0;  // requests may be taken back
        for (int i = 0; i < n; ++i) request |= chance(random, percent) ? 1U << i : 0;
        if (percent == 0 && chance(random, 50))
          request |= 1U << (static_cast<unsigned>(clock) / 200 + random() % 4) % n;
        const bool take = chance(random, 70);
        const bool reset = chance(random, 1);
        sim::set_bits(top.request, 0, n, request);
        top.take = take;
        top.rst = reset;
        simulation.settle();
        const unsigned grant = top.grant;
        REQUIRE(grant == model.grant(request));
        for (std::size_t i = 0; i < n; ++i) {
          others[i] += take && grant != 0 ? 1 : 0;
          if ((request >> i & 1U) == 0 || (grant >> i & 1U) != 0 || reset) others[i] = 0;
          REQUIRE(others[i] < TestType::N);
        }
        model.clock(request, take);
        if (take) request &= ~grant;
        if (reset) model = {};
        simulation.rise();
      }
    }
  });
}
