// SPDX-License-Identifier: Apache-2.0
#include <deque>
#include <iostream>
#include <models/cchip_bv_lane_a.hpp>

#include "bv_tools.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_bv_lane_a: planes are the functional model's, a child on every clock",
                        "[unit][cchip_bv_lane_a]", cchip_bv_lane_a_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    struct Item {
      bvh::InnerLine node;
      std::size_t child;
      model::PoseSetup pose;
      model::NodeGrid grid;
    };
    auto& top = simulation.top();
    std::deque<Item> items;  // newest first
    int coarse = 0;
    stimulus::Bins bins;
    for (int clock = 0; clock < 30000; ++clock) {
      Item item{random_node(random), random() % 4, {}, {}};
      // a pose serves several children, as in the traversal
      item.pose = items.empty() || chance(random, 20) ? model::set_up(random_query(random)) : items.front().pose;
      const int scale = chance(random, 60) ? 0 : number(random, 1, 3);
      item.grid.x = scale == 3 ? number(random, 5, 30) : 2 * scale;
      item.grid.a_is_point = scale == 3;
      item.grid.use_a_cuts = scale == 0;
      coarse += scale != 0 ? 1 : 0;
      for (auto& offset : item.grid.offset) offset = edge(random, -65536, 65535);
      items.push_front(item);
      see_child(bins, item.node.child[item.child]);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::string row = std::to_string(i);
        bins.see("offset " + row, item.grid.offset[i], -65536, 65535);
        for (std::size_t j = 0; j < 3; ++j)
          bins.see("M " + row + std::to_string(j), item.pose.m[i][j], -(1 << 17), 1 << 17);
      }
      bins.see("scale", scale, 0, 3);
      bins.end();

      set_child(top.child, item.node, item.child);
      top.scale = static_cast<CData>(scale);
      if (items.size() > 1) {
        const Item& at = items[1];
        top.coarse = at.node.cut_exponent == 3 ? 1 : 0;
        for (std::size_t d = 0; d < 13; ++d) {
          const auto& direction = at.pose.direction[d];
          const int bit = static_cast<int>(7 * d);
          sim::set_bits(top.pose_select, bit, 3, direction.face - bvh::first_face);
          sim::set_bits(top.pose_select, bit + 3, 1, direction.face_reversed ? 1 : 0);
          sim::set_bits(top.pose_select, bit + 4, 2, direction.corner - bvh::first_corner);
          sim::set_bits(top.pose_select, bit + 6, 1, direction.corner_reversed ? 1 : 0);
        }
      }
      if (items.size() > 2) {
        const Item& at = items[2];
        for (std::size_t i = 0; i < 9; ++i)
          sim::set_bits(top.pose_m, static_cast<int>(19 * i), 19, static_cast<std::uint64_t>(at.pose.m[i / 3][i % 3]));
        for (std::size_t d = 0; d < 13; ++d) {
          const auto& direction = at.pose.direction[d];
          for (std::size_t j = 0; j < 3; ++j) {
            REQUIRE(direction.magnitude[j] < 1024);
            sim::set_bits(top.pose_magnitude, static_cast<int>(30 * d + 10 * j), 10,
                          static_cast<std::uint64_t>(direction.magnitude[j]));
          }
          sim::set_bits(top.pose_factor, static_cast<int>(14 * d), 7,
                        static_cast<std::uint64_t>(direction.face_factor));
          sim::set_bits(top.pose_factor, static_cast<int>(14 * d + 7), 7,
                        static_cast<std::uint64_t>(direction.corner_factor));
        }
      }
      if (items.size() > 4) {
        for (std::size_t i = 0; i < 3; ++i)
          sim::set_bits(top.offset, static_cast<int>(17 * i), 17, static_cast<std::uint64_t>(items[4].grid.offset[i]));
      }
      simulation.settle();
      if (items.size() > 9) {
        const Item& at = items[9];
        expect_planes(top.planes, planes_of_a(at.node, at.child, at.pose, at.grid));
        items.pop_back();
      }
      simulation.rise();
    }
    REQUIRE(coarse > 5000);
    std::cout << "cchip_bv_lane_a: " << bins.summary() << '\n';
    // the magnitudes of a row of M add up to less than 2, those of a column of M^T d too
    REQUIRE(bins.missing(std::string(impossible_child) + "|M ..=\\w+ with M ..=\\w+").empty());
  });
}
