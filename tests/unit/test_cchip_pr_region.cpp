// SPDX-License-Identifier: Apache-2.0
// The partition with each of its personas: pairs of every class and of every kind that it serves, as the model answers.
#include <models/cchip_pr_region.hpp>

#include "vertex_port.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

template <class Config>
void check_persona() {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    constexpr auto id = static_cast<ModuleId>(Config::RM_ID);
    for (const double rate : {1.0, 0.4}) {
      sim::Simulation<typename Config::Model> simulation(options);
      auto& top = simulation.top();
      SlotRequests requests(Config::COORD_W, options.seed);
      VertexPort<typename Config::Model> port(top, Config::COORD_W, Config::CONTEXTS, options.seed,
                                              sim::Pattern::random(rate, options.seed));
      sim::TagScoreboard<PairResult> scoreboard{"region"};
      port.on_sent = [&](const PairRequest& r) {
        scoreboard.expect(r.tag, requests.answer(r, id), simulation.clock());
      };
      port.on_result = [&](const PairResult& r, bool known) {
        sim::require(known, "a result without a request");
        scoreboard.got(r.tag, r, simulation.clock());
      };
      port.set_numbers(256);  // any number, whatever the credit
      simulation.add(port);
      simulation.reset();
      simulation.steps(4);
      REQUIRE(int{top.rm_id} == Config::RM_ID);
      REQUIRE(top.idle == 1);
      const std::vector<ModuleId> kinds = kinds_served(id);
      for (std::size_t i = 0; i < 300; ++i) port.push(requests.draw(kinds[i % kinds.size()]));
      simulation.steps(10);
      std::uint64_t clocks = 0;
      while (port.waiting() != 0 || scoreboard.open() != 0) {
        REQUIRE(++clocks < 200000);
        simulation.step();
        if (port.inside() != 0) REQUIRE(top.idle == 0);
      }
      scoreboard.finish();
      simulation.steps(4);
      REQUIRE(top.idle == 1);
      // a pair alone, also while it waits for its next vertex
      for (int i = 0; i < 20; ++i) {
        port.push(requests.draw(id));
        while (port.waiting() != 0 || port.inside() != 0) {
          const bool begun = port.begun();
          simulation.step();
          if (begun) REQUIRE(top.idle == 0);
        }
        simulation.steps(6);
        REQUIRE(top.idle == 1);
      }
    }
  });
}

}  // namespace

TEST_CASE("cchip_pr_region: RM_ID 1 is the triangle-triangle test", "[unit][cchip_pr_region]") {
  check_persona<region_tri_tri>();
}

TEST_CASE("cchip_pr_region: RM_ID 2 is the triangle-quad test", "[unit][cchip_pr_region]") {
  check_persona<region_tri_quad>();
}

TEST_CASE("cchip_pr_region: RM_ID 3 is the quad-quad test", "[unit][cchip_pr_region]") {
  check_persona<region_quad_quad>();
}

TEST_CASE("cchip_pr_region: RM_ID 4 is the test of a point and a triangle", "[unit][cchip_pr_region]") {
  check_persona<region_point_tri>();
}

TEST_CASE("cchip_pr_region: RM_ID 0 is blank: it never answers", "[unit][cchip_pr_region]") {
  for_two_power_ups<region_blank::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    simulation.reset();
    for (int clock = 0; clock < 500; ++clock) {
      top.s_vertex_valid = random() & 1;
      sim::set_random(top.s_vertex_data, defs::vertex_w(region_blank::COORD_W), random);
      top.rst = chance(random, 2) ? 1 : 0;
      simulation.settle();
      REQUIRE(top.m_result_valid == 0);
      REQUIRE(sim::get_bits(top.m_result_data, 0, defs::slot_result_w) == 0);
      REQUIRE(top.rm_id == 0);
      REQUIRE(top.idle == 1);
      simulation.rise();
    }
  });
}
