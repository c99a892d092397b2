// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <models/cchip_bv_offset.hpp>

#include "bv_tools.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_bv_offset: grids are the functional model's, a node pair every third clock",
                        "[unit][cchip_bv_offset]", cchip_bv_offset_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    struct Item {
      int start;
      model::NodeGrid grid;
    };
    auto& top = simulation.top();
    std::vector<Item> items;    // oldest first
    std::array<int, 8> seen{};  // of each scale of B
    int far = 0;
    int near = 0;
    int rest = 0;
    stimulus::Bins bins;
    model::PoseSetup pose;  // of the node pair that was started last
    const auto show_row = [&](std::size_t i) {
      for (std::size_t j = 0; j < 3; ++j)
        sim::set_bits(top.row_m, static_cast<int>(19 * j), 19, static_cast<std::uint64_t>(pose.m[i][j]));
      top.row_t = static_cast<IData>(pose.t[i]) & 0x1FFFFFFF;
    };
    for (int clock = 0; clock < 60000; ++clock) {
      const bool start = rest == 0 && chance(random, 80);
      top.start = start ? 1 : 0;
      if (start) {
        rest = 2;
        pose = model::set_up(random_query(random));
        bvh::InnerLine a = random_node(random);
        bvh::InnerLine b = random_node(random);
        if (chance(random, 70)) b.step = std::clamp(a.step - pose.shift + number(random, -8, 8), 0, bvh::step_max);
        // any bound on the error, also with the finest grid, where the slack is about as large as it can be
        if (chance(random, 30)) pose.epsilon = number(random, 1, 127);
        if (chance(random, 15)) a.step = b.step = 0;
        if (chance(random, 50)) {  // near each other
          for (std::size_t i = 0; i < 3; ++i) b.origin[i] = std::clamp(pose.t[i] / 64, -131072, 131071);
        }
        items.push_back({clock, grid_of(a, b, pose)});
        for (std::size_t i = 0; i < 3; ++i) {
          const std::string axis = std::to_string(i);
          bins.see("origin of A " + axis, a.origin[i], -131072, 131071);
          bins.see("origin of B " + axis, b.origin[i], -131072, 131071);
          bins.see("t " + axis, pose.t[i], -(1 << 27), 1 << 27);
          for (std::size_t j = 0; j < 3; ++j)
            bins.see("M " + axis + std::to_string(j), pose.m[i][j], -(1 << 17), 1 << 17);
        }
        bins.see("step of A", a.step, 0, bvh::step_max);
        bins.see("step of B", b.step, 0, bvh::step_max);
        bins.see("shift", pose.shift, 0, query_shift_max);
        bins.end();
        for (std::size_t i = 0; i < 3; ++i) {
          sim::set_bits(top.a_origin, static_cast<int>(18 * i), 18, static_cast<std::uint64_t>(a.origin[i]));
          sim::set_bits(top.b_origin, static_cast<int>(18 * i), 18, static_cast<std::uint64_t>(b.origin[i]));
        }
        show_row(0);
        top.a_step = static_cast<CData>(a.step);
        top.b_step = static_cast<CData>(b.step);
        top.shift = static_cast<CData>(pose.shift);
        top.epsilon = static_cast<CData>(pose.epsilon);
      } else if (rest > 0) {
        show_row(static_cast<std::size_t>(3 - rest));
        top.shift = static_cast<CData>(random() % 16);  // counts with start only
        top.epsilon = static_cast<CData>(random() % 128);
        --rest;
      } else {  // the result is not read
        sim::set_random(top.a_origin, 54, random);
        sim::set_random(top.row_m, 57, random);
        sim::set_random(top.row_t, 29, random);
        top.a_step = static_cast<CData>(random() % 19);
      }
      simulation.settle();
      // each output from its clock on, until the next node pair's
      const auto at = [&](int latency) -> const model::NodeGrid* {
        const model::NodeGrid* found = nullptr;
        for (const Item& item : items) {
          if (item.start + latency <= clock) found = &item.grid;
        }
        return found;
      };
      if (const auto* grid = at(5)) {
        REQUIRE(top.a_scale == (grid->a_is_point ? 3 : grid->x / 2));
        REQUIRE(top.b_scale == (grid->b_is_point ? 7 : grid->y + 1));
        ++seen[top.b_scale];
      }
      if (const auto* grid = at(9)) REQUIRE(top.slack == grid->slack);
      if (const auto* grid = at(12)) {
        REQUIRE((top.is_far != 0) == grid->far);
        REQUIRE((top.is_near != 0) == grid->near);
        far += grid->far ? 1 : 0;
        near += grid->near ? 1 : 0;
        for (std::size_t i = 0; i < 3 && !grid->far; ++i)
          REQUIRE(sim::get_bits(top.offset, static_cast<int>(17 * i), 17) ==
                  (static_cast<std::uint64_t>(grid->offset[i]) & 0x1FFFF));
      }
      while (items.size() > 1 && items[1].start + 12 <= clock) items.erase(items.begin());
      simulation.rise();
    }
    std::cout << "cchip_bv_offset: " << bins.summary() << '\n';
    REQUIRE(bins.missing("M ..=\\w+ with M ..=\\w+").empty());
    for (const int count : seen) REQUIRE(count > 200);
    REQUIRE(far > 2000);
    REQUIRE(far < 50000);
    REQUIRE(near > 20);
  });
}
