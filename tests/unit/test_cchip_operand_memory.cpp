// SPDX-License-Identifier: Apache-2.0
// Pairs come in whole and are found again at their place, vertex by vertex.
#include <map>
#include <models/cchip_operand_memory.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_operand_memory: what was written at a place is read there, at one vertex per clock",
                        "[unit][cchip_operand_memory]", cchip_operand_memory_configs) {
  constexpr int w = TestType::COORD_W;
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    using Vertices = std::array<model::Word3, 4>;
    struct Pair {
      int kind = 0;
      Vertices a{}, b{};
    };
    const auto draw = [&] {
      Pair p;
      p.kind = static_cast<int>(random() % (defs::kinds_max + 1));
      for (Vertices* v : {&p.a, &p.b}) {
        for (auto& x : *v) x = random_word3(random, w);
      }
      return p;
    };
    const auto put = [&](const Pair& p) {
      top.s_pair_kind = static_cast<CData>(p.kind);
      for (int i = 0; i < 4; ++i) {
        for (int d = 0; d < 3; ++d) {
          const auto at = static_cast<std::size_t>(i);
          sim::set_signed(top.s_pair_a, w * (3 * i + d), w, p.a[at][static_cast<std::size_t>(d)]);
          sim::set_signed(top.s_pair_b, w * (3 * i + d), w, p.b[at][static_cast<std::size_t>(d)]);
        }
      }
    };
    const auto word = [&](const auto& port) { return get_word3(port, w); };
    std::map<int, Pair> stored;
    top.s_pair_valid = 0;
    simulation.reset();
    int dropped = 0;
    int held = 0;
    top.m_vertex = 0;
    for (int round = 0; round < 600; ++round) {
      const Pair p = draw();
      const int place = static_cast<int>(random() % (1U << TestType::PLACE_W));
      stored.erase(place);
      put(p);
      sim::set_bits(top.place, 0, TestType::PLACE_W, static_cast<std::uint64_t>(place));
      top.s_pair_valid = 1;
      // no room: nothing happens, for as long as it lasts
      for (int wait = chance(random, 30) ? static_cast<int>(random() % 5) : 0; wait > 0; --wait) {
        top.room = 0;
        simulation.settle();
        REQUIRE(top.s_pair_ready == 0);
        simulation.rise();
      }
      if (chance(random, 10)) {  // a reset, and a sender that starts again
        top.room = 1;
        simulation.steps(random() % 3);
        top.rst = 1;
        simulation.step();
        top.rst = 0;
        ++dropped;
      }
      top.room = 1;
      // the pair that was there is still being read: it must not be written over
      if (chance(random, 30)) {
        sim::set_bits(top.m_place, 0, TestType::PLACE_W, static_cast<std::uint64_t>(place));
        for (int vertex = 1 + static_cast<int>(random() % 3); vertex < 4; ++vertex) {
          top.m_vertex = static_cast<CData>(vertex);
          simulation.settle();
          REQUIRE(top.s_pair_ready == 0);
          simulation.rise();
        }
        top.m_vertex = 0;
        ++held;
      }
      for (int i = 0; i < 2; ++i) {
        simulation.settle();
        REQUIRE((top.s_pair_ready != 0) == (i == 1));
        simulation.rise();
      }
      stored[place] = p;
      top.s_pair_valid = 0;
      top.room = 1;
      if (chance(random, 50)) simulation.steps(random() % 4);
      // any pair, vertex after vertex
      auto it = stored.begin();
      std::advance(it, static_cast<std::ptrdiff_t>(random() % stored.size()));
      sim::set_bits(top.m_place, 0, TestType::PLACE_W, static_cast<std::uint64_t>(it->first));
      const int vertices = it->second.kind == 2 || it->second.kind == 3 ? 4 : 3;
      for (int i = 0; i <= vertices + 1; ++i) {
        top.m_vertex = static_cast<CData>(i & 3);
        simulation.settle();
        if (i > 1) {
          const int v = i - 2;
          const int v_of_a = it->second.kind == 2 && v == 3 ? 2 : v;
          REQUIRE(word(top.m_a) == it->second.a[static_cast<std::size_t>(v_of_a)]);
          REQUIRE(word(top.m_b) == it->second.b[static_cast<std::size_t>(v)]);
        }
        simulation.rise();
      }
      top.m_vertex = 0;
    }
    REQUIRE(dropped > 20);
    REQUIRE(held > 100);
  });
}
