// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_transform.hpp>

#include "transform_tools.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_transform: the model's pairs of primitives on every clock", "[unit][cchip_transform]",
                        cchip_transform_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    constexpr int w = TestType::COORD_W;
    constexpr int id_w = TestType::ID_W;
    auto& top = simulation.top();
    std::array<std::size_t, 4> kinds = {};
    std::size_t exchanged = 0;
    std::size_t full = 0;
    std::array<std::size_t, 16> etas = {};
    // How often a pair is ready to go on, and how often its credit comes back, of 100 clocks.
    for (const auto& [percent, back] : {std::pair(100, 100), std::pair(100, 8), std::pair(10, 50)}) {
      model::Transform model(w, TestType::PASSES, TestType::CREDIT);
      JobSource source(3);
      std::uint32_t id = 0;
      int held = 0;  // pairs of which all vertices came and whose credit did not go back
      top.s_valid = 0;
      top.s_credit = 0;
      simulation.reset();
      model.reset();
      for (int clock = 0; clock < 25000; ++clock) {
        const bool reset = clock % 6000 == 5999;
        const model::LeafJob* job = source.next(random, percent);
        const bool credit = held > 0 && chance(random, back);
        top.rst = reset ? 1 : 0;
        top.s_valid = job != nullptr ? 1 : 0;
        set_job(top, job != nullptr ? *job : random_job(random, 50));
        sim::set_bits(top.s_id, 0, id_w, id);
        top.s_credit = credit ? 1 : 0;
        simulation.settle();
        REQUIRE((top.s_ready != 0) == model.s_ready());
        if (model.s_ready()) REQUIRE((top.corrupt != 0) == model.corrupt());
        const std::optional<model::GridVertex> expected = model.m();
        REQUIRE((top.m_valid != 0) == expected.has_value());
        held -= credit ? 1 : 0;
        if (expected) {
          const model::GridVertex got{top.m_first != 0, top.m_last != 0, get_point(top.m_a, w), get_point(top.m_b, w),
                                      static_cast<int>(top.m_err)};
          const model::PairIdentity& identity = model.identity();
          CAPTURE(clock, got.a, expected->a, got.b, expected->b, got.eta, expected->eta);
          REQUIRE(got == *expected);
          REQUIRE(top.m_kind == identity.kind);
          REQUIRE(top.m_face_a == identity.face_a);
          REQUIRE(top.m_face_b == identity.face_b);
          REQUIRE(sim::get_bits(top.m_id, 0, id_w) == identity.id);
          REQUIRE(unsigned{top.m_pair} == identity.pair);
          ++etas[static_cast<std::size_t>(got.eta)];
          if (got.last) {
            ++held;
            ++kinds[static_cast<std::size_t>(identity.kind)];
            exchanged += identity.exchange ? 1 : 0;
          }
        }
        full += model.used() > TestType::CREDIT - 4 ? 1 : 0;
        REQUIRE(model.used() <= TestType::CREDIT);
        const bool taken = model.s_ready();
        if (reset) {
          model.reset();
          source.taken();
          held = 0;
        } else {
          model.clock(job, id, credit);
          if (taken) source.taken();
        }
        if (taken || reset) id = static_cast<std::uint32_t>(random() & ((std::uint64_t{1} << id_w) - 1));
        simulation.rise();
      }
    }
    for (std::size_t kind = 1; kind < kinds.size(); ++kind) REQUIRE(kinds[kind] > 100);
    REQUIRE(exchanged > 40);
    REQUIRE(full > 1000);
    if (w >= 16) REQUIRE(etas[0] > 5);  // little fits fewer bits exactly
    for (const std::size_t eta : {2, 15}) REQUIRE(etas[eta] > 5);
  });
}
