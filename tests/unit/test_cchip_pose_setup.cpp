// SPDX-License-Identifier: Apache-2.0
#include <deque>
#include <models/cchip_pose_setup.hpp>

#include "bv_tools.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_pose_setup: poses are the functional model's, a direction on every clock",
                        "[unit][cchip_pose_setup]", cchip_pose_setup_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    for (const int percent : {100, 10}) {
      struct Expected {
        int clock;  // of its first direction
        model::PoseSetup pose;
      };
      std::deque<Expected> expected;
      std::optional<model::PoseSetup> shown;  // of the query at work, its last clock included
      std::size_t next = 0;                   // direction
      int queries = 0;
      // in reset, however long it lasts, no query is taken: on its first clock only one of before may leave
      top.rst = 1;
      top.s_valid = 1;
      for (int clock = 0; clock < 4; ++clock) {
        simulation.settle();
        if (clock > 0) REQUIRE(top.s_ready == 0);
        simulation.rise();
      }
      top.s_valid = 0;
      simulation.reset();
      for (int clock = 0; clock < 40000; ++clock) {
        const Query query = random_query(random);
        const bool valid = clock > 0 && chance(random, percent);
        top.s_valid = valid ? 1 : 0;
        for (std::size_t i = 0; i < 9; ++i)
          sim::set_bits(top.s_m, static_cast<int>(32 * i), 32, static_cast<std::uint32_t>(query.m[i / 3][i % 3]));
        for (std::size_t i = 0; i < 3; ++i)
          sim::set_bits(top.s_t, static_cast<int>(36 * i), 36, static_cast<std::uint64_t>(query.t[i]));
        top.s_shift = static_cast<CData>(query.shift);
        top.s_error = static_cast<SData>(query.error);
        simulation.settle();

        if (shown) {
          for (std::size_t i = 0; i < 9; ++i) {
            const auto m = static_cast<std::uint64_t>(shown->m[i / 3][i % 3]) & 0x7FFFF;
            REQUIRE(sim::get_bits(top.pose_m, static_cast<int>(19 * i), 19) == m);
          }
          for (std::size_t i = 0; i < 3; ++i) {
            const auto t = static_cast<std::uint64_t>(shown->t[i]) & 0x1FFFFFFF;
            REQUIRE(sim::get_bits(top.pose_t, static_cast<int>(29 * i), 29) == t);
          }
          REQUIRE(top.epsilon == shown->epsilon);
        }
        const bool due = !expected.empty() && expected.front().clock <= clock;
        REQUIRE((top.m_valid != 0) == due);
        if (due) {
          const auto& direction = expected.front().pose.direction[next];
          REQUIRE(top.m_direction == next);
          REQUIRE((top.m_select & 7) == direction.face - bvh::first_face);
          REQUIRE((top.m_select >> 3 & 1) == (direction.face_reversed ? 1 : 0));
          REQUIRE((top.m_select >> 4 & 3) == direction.corner - bvh::first_corner);
          REQUIRE((top.m_select >> 6) == (direction.corner_reversed ? 1 : 0));
          for (std::size_t j = 0; j < 3; ++j)
            REQUIRE(sim::get_bits(top.m_magnitude, static_cast<int>(10 * j), 10) ==
                    static_cast<std::uint64_t>(direction.magnitude[j]));
          REQUIRE((top.m_factor & 127) == direction.face_factor);
          REQUIRE((top.m_factor >> 7) == direction.corner_factor);
          if (++next == bvh::directions.size()) {
            next = 0;
            expected.pop_front();
          }
        }
        if (top.s_ready != 0) shown.reset();
        if (valid && top.s_ready != 0) {
          shown = model::set_up(query);
          expected.push_back({clock + 7, *shown});
          ++queries;
        }
        simulation.rise();
      }
      if (percent == 100) REQUIRE(queries == (40000 - 2) / 13 + 1);
      REQUIRE(queries > 1500);
    }
  });
}
