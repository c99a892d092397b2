// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_sat_select.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_sat_select: edges and points of every axis code", "[unit][cchip_sat_select]",
                        cchip_sat_select_configs) {
  using Model = typename TestType::Model;
  constexpr int w = TestType::COORD_W;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Random random(options.seed);
    sim::Simulation<Model> simulation(options);
    Model& top = simulation.top();
    model::Delay<std::optional<model::Selection>> delay(static_cast<std::size_t>(defs::select_latency()));
    GridPrimitive a, b;
    unsigned next_code = 0;
    int compared = 0;
    Bench bench(
        [&](const sim::ClockInfo&) {
          a = random_triangle(random, w);
          b = random_triangle(random, w);
          set_triangle(top.s_a, a, w);
          set_triangle(top.s_b, b, w);
          top.s_code = static_cast<SData>(next_code++ & 0x1ff);
        },
        [&](const sim::ClockInfo&) {
          if (const auto expected = delay.q()) {
            const bool edges = get_word3(top.m_e_from, w) == to_word3(expected->e_from) &&
                               get_word3(top.m_e_to, w) == to_word3(expected->e_to) &&
                               get_word3(top.m_f_from, w) == to_word3(expected->f_from) &&
                               get_word3(top.m_f_to, w) == to_word3(expected->f_to);
            sim::require(edges, "wrong edge for the code of the clock before " + std::to_string(top.s_code));
            for (int i = 0; i < 3; ++i) {
              sim::require(get_word3(top.m_points, w, i) == to_word3(expected->points[static_cast<std::size_t>(i)]),
                           "wrong point for the code of the clock before " + std::to_string(top.s_code));
            }
            ++compared;
          }
          const AxisCode code = model::axis_code_from_bits(top.s_code);
          // triangles have edges 0..2; others are not asked for
          const bool exists = code.cls != AxisClass::cross || (code.k < 3 && code.l < 3);
          delay.clock(exists ? std::optional(model::sat_select(code, a, b)) : std::nullopt);
        });
    simulation.add(bench);
    simulation.steps(5 * 512);
    REQUIRE(compared > 4 * 448);
  });
}

TEST_CASE("cchip_sat_select: the points leave out only what the reference stands for", "[unit][cchip_sat_select]") {
  // Every vertex is a start or end of an edge of its axis or a projected point.
  sim::Simulation<Vcchip_sat_select> simulation;
  Vcchip_sat_select& top = simulation.top();
  constexpr int w = 16;
  GridPrimitive a, b;
  for (int i = 0; i < 3; ++i) {
    a.v[static_cast<std::size_t>(i)] = Vec3i::Constant(i);
    b.v[static_cast<std::size_t>(i)] = Vec3i::Constant(3 + i);
  }
  set_triangle(top.s_a, a, w);
  set_triangle(top.s_b, b, w);
  for (int beat = 0; beat < defs::exhaustive_beats_tri_tri; ++beat) {
    top.s_code = model::to_bits(model::exhaustive_axis(beat));
    simulation.step();
    unsigned seen = 0;
    const auto see = [&](const model::Word3& v) { seen |= 1U << v[0]; };
    see(get_word3(top.m_e_from, w));
    see(get_word3(top.m_e_to, w));
    see(get_word3(top.m_f_from, w));
    see(get_word3(top.m_f_to, w));
    for (int i = 0; i < 3; ++i) see(get_word3(top.m_points, w, i));
    INFO("beat " << beat);
    CHECK(seen == 0x3f);
  }
}
