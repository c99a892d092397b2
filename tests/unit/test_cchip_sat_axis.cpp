// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_sat_axis.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_sat_axis: e x f after SUBSTAGES clocks", "[unit][cchip_sat_axis]",
                        cchip_sat_axis_configs) {
  using Model = typename TestType::Model;
  constexpr int w = TestType::COORD_W;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Random random(options.seed);
    sim::Simulation<Model> simulation(options);
    Model& top = simulation.top();
    model::Delay<std::optional<model::Selection>> delay(TestType::SUBSTAGES);
    model::Selection in;
    std::uint64_t compared = 0;
    Bench bench(
        [&](const sim::ClockInfo&) {
          in.e_from = random_point(random, w);
          in.e_to = random_point(random, w);
          in.f_from = random_point(random, w);
          in.f_to = random_point(random, w);
          set_word3(top.s_e_from, w, to_word3(in.e_from));
          set_word3(top.s_e_to, w, to_word3(in.e_to));
          set_word3(top.s_f_from, w, to_word3(in.f_from));
          set_word3(top.s_f_to, w, to_word3(in.f_to));
        },
        [&](const sim::ClockInfo&) {
          if (const auto s = delay.q()) {
            const model::Word3 axis = get_word3(top.m_axis, defs::axis_w(w));
            sim::require(axis == model::sat_axis(*s, w), "axis differs from the model");
            // exact for every input: orthogonal to both edges
            sim::require(wide_dot(axis, to_word3(s->e_to)) == wide_dot(axis, to_word3(s->e_from)) &&
                             wide_dot(axis, to_word3(s->f_to)) == wide_dot(axis, to_word3(s->f_from)),
                         "axis is not orthogonal to its edges");
            ++compared;
          }
          delay.clock(in);
        });
    simulation.add(bench);
    simulation.steps(20000);
    REQUIRE(compared == 20000 - TestType::SUBSTAGES);
  });
}
