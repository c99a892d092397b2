// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <models/cchip_programme_plan.hpp>

#include "programme_tools.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_programme_plan: what the normals lead to is the model's plan",
                        "[unit][cchip_programme_plan]", cchip_programme_plan_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    constexpr auto points = static_cast<std::size_t>(defs::points(TestType::VERTS_A, TestType::VERTS_B));
    const model::Options o{{TestType::VERTS_A, TestType::VERTS_B}, TestType::WARPED_EXACT != 0};
    Random random(options.seed);
    sim::Simulation<typename TestType::Model> simulation(options);
    auto& top = simulation.top();
    const auto present = [&](const model::Verdict& v, Programme programme, std::uint64_t info, bool certain) {
      top.s_state = in_field(defs::state_programme, static_cast<std::uint64_t>(programme)) |
                    in_field(defs::state_info, info) | in_field(defs::state_certain, certain);
      top.s_negative = static_cast<CData>(bit_vector(v.compare.negative, points));
      top.s_zero = static_cast<CData>(bit_vector(v.compare.zero, points));
      top.s_clear = v.compare.clear ? 1 : 0;
      top.s_axis_negative = static_cast<CData>(bit_vector(v.axis_negative, 3));
      top.s_axis_zero = static_cast<CData>(bit_vector(v.axis_zero, 3));
      top.s_axis_largest = static_cast<CData>(v.axis_largest);
      simulation.settle();
      simulation.rise();
    };
    std::map<Programme, int> plans;
    for (int i = 0; i < 20000; ++i) {
      const unsigned zero_axes = random_zero_axes(random);
      const model::Verdict on_a = random_verdict(random, 0, zero_axes);
      const model::Verdict on_b = random_verdict(random, 0, zero_axes);
      model::Sides sides;
      model::record_normal_a(sides, o.shape, on_a);
      // An EXHAUSTIVE pair carries nothing along: its verdicts follow each other. Others come at any time.
      const bool exhaustive = chance(random, 50);
      present(on_a, exhaustive ? Programme::exhaustive : Programme::normals, random() % (1U << defs::info_w), true);
      REQUIRE((top.m_clear != 0) == sides.certain);
      const std::uint64_t info = top.m_info;
      if (!exhaustive) present(random_verdict(random, 0, 0), Programme::exhaustive, 0, chance(random, 50));
      present(on_b, exhaustive ? Programme::exhaustive : Programme::normals,
              exhaustive ? random() % (1U << defs::info_w) : info, exhaustive ? chance(random, 50) : sides.certain);
      model::record_normal_b(sides, o.shape, on_b);
      const model::State plan = model::plan(o, sides, 0);
      INFO("pair " << i << ", programme " << static_cast<int>(plan.programme) << (exhaustive ? ", exhaustive" : ""));
      REQUIRE((top.m_certain != 0) == sides.certain);
      REQUIRE(top.m_plan == plan_bits(o, plan));
      ++plans[plan.programme];
    }
    for (const Programme p : {Programme::crossing, Programme::coplanar, Programme::degenerate}) {
      REQUIRE(plans[p] > 100);
    }
    REQUIRE((plans[Programme::tetrahedron] > 100) == (TestType::VERTS_B == 4 && TestType::WARPED_EXACT != 0));
  });
}
