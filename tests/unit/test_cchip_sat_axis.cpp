// SPDX-License-Identifier: Apache-2.0
#include <cchip/stimulus/witness.hpp>
#include <models/cchip_sat_axis.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

WideVector difference(const Vec3i& to, const Vec3i& from) {
  return {to.x() - from.x(), to.y() - from.y(), to.z() - from.z()};
}
sim::Int128 norm1(const WideVector& v) {
  sim::Int128 sum = 0;
  for (const sim::Int128 x : v) sum += x < 0 ? -x : x;
  return sum;
}

/// A corner of the grid: longest edges, most negative coordinates.
Vec3i corner(Random& random, int coord_w) {
  Vec3i p;
  for (int d = 0; d < 3; ++d) p[d] = chance(random, 50) ? -(1 << (coord_w - 1)) : (1 << (coord_w - 1)) - 1;
  return p;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_sat_axis: e x f and its norms after SUBSTAGES clocks", "[unit][cchip_sat_axis]",
                        cchip_sat_axis_configs) {
  using Model = typename TestType::Model;
  constexpr int w = TestType::COORD_W;
  for_two_power_ups<Model>([](sim::Simulation<Model>& simulation, Random& random) {
    auto& top = simulation.top();
    model::Delay<std::optional<model::Selection>> delay(TestType::SUBSTAGES);
    model::Selection in;
    std::uint64_t compared = 0;
    Bench bench(
        [&](const sim::ClockInfo&) {
          const bool corners = chance(random, 30);
          for (Vec3i* p : {&in.e_from, &in.e_to, &in.f_from, &in.f_to}) {
            *p = corners ? corner(random, w) : random_point(random, w);
          }
          set_word3(top.s_e_from, w, to_word3(in.e_from));
          set_word3(top.s_e_to, w, to_word3(in.e_to));
          set_word3(top.s_f_from, w, to_word3(in.f_from));
          set_word3(top.s_f_to, w, to_word3(in.f_to));
        },
        [&](const sim::ClockInfo&) {
          if (const auto& s = delay.q()) {
            const model::Word3 axis = get_word3(top.m_axis, defs::axis_w(w));
            const auto edge_norm = static_cast<std::int64_t>(sim::get_bits(top.m_edge_norm, 0, defs::norm_w(w)));
            const model::Axis expected = model::sat_axis(*s, w);
            sim::require(axis == expected.axis, "axis differs from the model");
            expect("m_edge_norm", edge_norm, expected.edge_norm);
            // exact for every input
            const WideVector e = difference(s->e_to, s->e_from);
            const WideVector f = difference(s->f_to, s->f_from);
            sim::require(WideVector{axis[0], axis[1], axis[2]} == detail::cross(e, f), "axis is not e x f");
            sim::require(edge_norm == norm1(e) + norm1(f), "edge norm is not |e|_1 + |f|_1");
            ++compared;
          }
          delay.clock(in);
        });
    simulation.add(bench);
    simulation.steps(20000);
    REQUIRE(compared == 20000 - TestType::SUBSTAGES);
  });
}
