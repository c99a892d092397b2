// SPDX-License-Identifier: Apache-2.0
#include <deque>
#include <iostream>
#include <models/cchip_bv_compare.hpp>

#include "bv_tools.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// Planes anywhere in their width, or such that intervals overlap by about `most` half steps.
model::Planes random_planes(Random& random, int most) {
  model::Planes planes{};
  for (std::size_t d = 0; d < bvh::directions.size(); ++d) {
    const int limit = most == 0 ? (1 << (plane_width(d) - 1)) - 1 : most;
    planes.upper[d] = edge(random, most == 0 ? -limit - 1 : -1, limit);
    planes.lower[d] = edge(random, most == 0 ? -limit - 1 : -limit, most == 0 ? limit : 1);
  }
  return planes;
}

/// The comparison of two children, as the functional model makes it: a node of one child each.
struct Expected {
  bool separated = false;
  int key = 15;
};
Expected compare(const model::Planes& a, const model::Planes& b) {
  Expected expected;
  for (std::size_t d = 0; d < bvh::directions.size(); ++d) {
    for (const std::int64_t over : {a.upper[d] - b.lower[d], b.upper[d] - a.lower[d]}) {
      expected.separated = expected.separated || over < 0;
      expected.key = static_cast<int>(std::min<std::int64_t>(expected.key, over / (d < bvh::first_face ? 8 : 16)));
    }
  }
  return expected;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_bv_compare: separation after 2 clocks, least overlap after 6",
                        "[unit][cchip_bv_compare]", cchip_bv_compare_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    std::deque<Expected> expected;  // newest first
    std::array<int, 16> keys{};
    int separations = 0;
    stimulus::Bins bins;
    for (int clock = 0; clock < 60000; ++clock) {
      const int most = chance(random, 10) ? 0 : 1 << number(random, 0, 9);
      const model::Planes a = random_planes(random, most);
      const model::Planes b = random_planes(random, most);
      for (std::size_t d = 0; d < bvh::directions.size(); ++d) {
        const std::int64_t end = std::int64_t{1} << (plane_width(d) - 1);
        const std::string direction = std::to_string(d);
        bins.see("upper of A " + direction, a.upper[d], -end, end - 1);
        bins.see("lower of A " + direction, a.lower[d], -end, end - 1);
        bins.see("upper of B " + direction, b.upper[d], -end, end - 1);
        bins.see("lower of B " + direction, b.lower[d], -end, end - 1);
      }
      bins.end();
      set_planes(top.a, a);
      set_planes(top.b, b);
      expected.push_front(compare(a, b));
      simulation.settle();
      if (expected.size() > 2) {
        REQUIRE((top.separated != 0) == expected[2].separated);
        separations += expected[2].separated ? 1 : 0;
      }
      if (expected.size() > 6) {
        if (!expected[6].separated) {
          REQUIRE(top.key == expected[6].key);
          ++keys[top.key];
        }
        expected.pop_back();
      }
      simulation.rise();
    }
    std::cout << "cchip_bv_compare: " << bins.summary() << '\n';
    REQUIRE(bins.missing().empty());
    REQUIRE(separations > 1000);
    for (const std::size_t key : {0, 1, 2, 4, 8}) REQUIRE(keys[key] > 0);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_bv_compare: each bit of an overlap counts, and of each direction",
                        "[unit][cchip_bv_compare]", cchip_bv_compare_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random&) {
    auto& top = simulation.top();
    // all intervals are as long as they can be, but for one end, which leaves an overlap of one bit, or one less
    model::Planes longest{};
    for (std::size_t d = 0; d < bvh::directions.size(); ++d) {
      longest.upper[d] = (1 << (plane_width(d) - 1)) - 1;
      longest.lower[d] = -(1 << (plane_width(d) - 1));
    }
    int told = 0;
    for (std::size_t d = 0; d < bvh::directions.size(); ++d) {
      for (int bit = 0; bit < plane_width(d); ++bit) {
        for (const int over : {1 << bit, (1 << bit) - 1, -(1 << bit)}) {
          for (const bool of_a : {true, false}) {
            model::Planes a = longest;
            model::Planes b = longest;
            model::Planes& upper = of_a ? a : b;
            model::Planes& lower = of_a ? b : a;
            upper.upper[d] = over < 0 ? longest.lower[d] : longest.lower[d] + over;
            lower.lower[d] = over < 0 ? longest.lower[d] - over : longest.lower[d];
            if (lower.lower[d] > longest.upper[d]) continue;
            set_planes(top.a, a);
            set_planes(top.b, b);
            for (int clock = 0; clock < 8; ++clock) {
              simulation.settle();
              simulation.rise();
            }
            simulation.settle();
            const Expected expected = compare(a, b);
            REQUIRE(expected.separated == (over < 0));
            REQUIRE((top.separated != 0) == expected.separated);
            if (!expected.separated) REQUIRE(top.key == expected.key);
            ++told;
          }
        }
      }
    }
    REQUIRE(told >= 2 * 3 * (3 * 11 + 10 * 12));
  });
}
