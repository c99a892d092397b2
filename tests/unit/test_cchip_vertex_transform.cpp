// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_vertex_transform.hpp>

#include "transform_tools.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_vertex_transform: the model's vertices on every clock", "[unit][cchip_vertex_transform]",
                        cchip_vertex_transform_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    constexpr int passes = TestType::PASSES;
    auto& top = simulation.top();
    std::size_t vertices = 0;
    std::size_t corrupt = 0;
    std::size_t exact = 0;
    std::array<std::size_t, 8> lost = {};
    for (const int percent : {100, 10}) {
      model::VertexTransform model(passes);
      JobSource source(5);
      top.s_valid = 0;
      top.room = 0;
      simulation.reset();
      bool room = false;
      for (int clock = 0; clock < 40000; ++clock) {
        const bool reset = clock % 3000 == 2999;
        const model::LeafJob* job = source.next(random, percent);
        if (!model.launch() && chance(random, 20)) room = chance(random, percent == 100 ? 99 : 70);
        top.rst = reset ? 1 : 0;
        top.s_valid = job != nullptr ? 1 : 0;
        top.room = room ? 1 : 0;
        set_job(top, job != nullptr ? *job : random_job(random, 50));
        simulation.settle();
        REQUIRE((top.s_ready != 0) == model.s_ready());
        if (model.s_ready()) REQUIRE((top.corrupt != 0) == model.corrupt());
        REQUIRE((top.launch != 0) == model.launch().has_value());
        if (model.launch()) REQUIRE(top.launch_pair == (*model.launch())[0] * 2 + (*model.launch())[1]);
        REQUIRE((top.m_valid != 0) == model.m().has_value());
        if (model.m()) {
          model::MovedVertex got;
          got.first = top.m_first != 0;
          got.last = top.m_last != 0;
          got.a = get_word3(top.m_a, 45);
          got.b = get_word3(top.m_b, 25);
          got.origin_lost = (top.m_lost & 1) != 0;
          got.lost_a = (top.m_lost & 2) != 0;
          got.lost_b = (top.m_lost & 4) != 0;
          got.error_a = top.m_error_a;
          got.error_b = top.m_error_b;
          got.open = top.m_open != 0;
          const model::MovedVertex& expected = *model.m();
          CAPTURE(clock, got.a, expected.a, got.b, expected.b, got.error_a, expected.error_a, got.error_b,
                  expected.error_b);
          REQUIRE(got == expected);
          ++vertices;
          ++lost[top.m_lost];
          exact += got.error_a == 0 && got.error_b == 0 ? 1 : 0;
        }
        const bool taken = model.s_ready();
        corrupt += taken && model.corrupt() ? 1 : 0;
        if (reset) {
          model.reset();
          source.taken();
        } else {
          model.clock(job, room);
          if (taken) source.taken();
        }
        simulation.rise();
      }
    }
    for (const std::size_t count : lost) REQUIRE(count > 20);
    REQUIRE(vertices > 20000 / passes);
    REQUIRE(corrupt > 50);
    REQUIRE(exact > 100);
  });
}
