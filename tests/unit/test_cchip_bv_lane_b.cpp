// SPDX-License-Identifier: Apache-2.0
#include <deque>
#include <iostream>
#include <models/cchip_bv_lane_b.hpp>

#include "bv_tools.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_bv_lane_b: planes are the functional model's, a child on every clock",
                        "[unit][cchip_bv_lane_b]", cchip_bv_lane_b_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    struct Item {
      bvh::InnerLine node;
      std::size_t child;
      model::NodeGrid grid;
    };
    auto& top = simulation.top();
    std::deque<Item> items;  // newest first
    stimulus::Bins bins;
    for (int clock = 0; clock < 30000; ++clock) {
      Item item{random_node(random), random() % 4, {}};
      const int scale = edge(random, 0, 7);
      item.grid.y = scale == 7 ? number(random, 6, 30) : scale - 1;
      item.grid.b_is_point = scale == 7;
      item.grid.use_b_cuts = item.grid.y <= 1;
      item.grid.slack = edge(random, 0, model::slack_max);
      items.push_front(item);
      see_child(bins, item.node.child[item.child]);
      bins.see("scale", scale, 0, 7);
      bins.see("slack", item.grid.slack, 0, model::slack_max);
      bins.see("cut exponent", item.node.cut_exponent, 2, 3);
      bins.end();

      set_child(top.child, item.node, item.child);
      top.scale = static_cast<CData>(scale);
      top.coarse = item.node.cut_exponent == 3 ? 1 : 0;
      if (items.size() > 1) top.slack = static_cast<CData>(items[1].grid.slack);
      simulation.settle();
      if (items.size() > 5) {
        const Item& at = items[5];
        expect_planes(top.planes, planes_of_b(at.node, at.child, at.grid));
        items.pop_back();
      }
      simulation.rise();
    }
    std::cout << "cchip_bv_lane_b: " << bins.summary() << '\n';
    REQUIRE(bins.missing(impossible_child).empty());
  });
}
