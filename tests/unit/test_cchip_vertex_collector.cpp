// SPDX-License-Identifier: Apache-2.0
// Vertices in, requests out: complete pairs, cut-off ones, vertices that belong to none.
#include <models/cchip_vertex_collector.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_vertex_collector: the request of every complete pair, regardless of earlier ones",
                        "[unit][cchip_vertex_collector]", cchip_vertex_collector_configs) {
  constexpr int w = TestType::COORD_W;
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    const auto put = [&](defs::Field f, std::uint64_t value) {
      sim::set_bits(top.s_vertex_data, f.lsb, f.width, value);
    };
    struct Pair {
      std::array<model::Word3, 4> a{}, b{};
      std::uint64_t id = 0, err = 0, mode = 0;
    };
    Pair pair;
    int next = -1;  // place of the next vertex; -1: none begun
    bool complete = false;
    int pairs = 0, of_three = 0, cut_off = 0;
    top.s_vertex_valid = 0;
    simulation.reset();
    int sending = 0, length = 0;  // vertices of the pair that the sender is at
    for (int clock = 0; clock < 6000; ++clock) {
      if (sending == length) {
        sending = 0;
        length = chance(random, 10) ? 1 + static_cast<int>(random() % 4) : 3 + static_cast<int>(random() & 1);
      }
      const bool valid = chance(random, 80);
      const bool first = sending == 0 ? !chance(random, 3) : chance(random, 3);
      const bool last = sending + 1 == length && !chance(random, 5);
      const model::Word3 a = random_word3(random, w);
      const model::Word3 b = random_word3(random, w);
      const std::uint64_t id = random() & 255U, err = random() & 15U, mode = random() & 3U;
      top.s_vertex_valid = valid ? 1 : 0;
      put(defs::vertex_first, first ? 1 : 0);
      put(defs::vertex_last, last ? 1 : 0);
      put(defs::vertex_id, id);
      put(defs::vertex_err, err);
      put(defs::vertex_mode, mode);
      for (int d = 0; d < 3; ++d) {
        sim::set_signed(top.s_vertex_data, defs::vertex_a(w).lsb + w * d, w, a[static_cast<std::size_t>(d)]);
        sim::set_signed(top.s_vertex_data, defs::vertex_b(w).lsb + w * d, w, b[static_cast<std::size_t>(d)]);
      }
      top.rst = chance(random, 1) ? 1 : 0;
      simulation.settle();
      REQUIRE((top.m_pair_valid != 0) == complete);
      REQUIRE((top.busy != 0) == (complete || next >= 0));
      if (complete) {
        const auto get = [&](defs::Field f) { return sim::get_bits(top.m_pair_data, f.lsb, f.width); };
        REQUIRE(get(defs::request_tag) == pair.id);
        REQUIRE(get(defs::request_err(w)) == pair.err);
        REQUIRE(get(defs::request_mode(w)) == pair.mode);
        for (int i = 0; i < 4; ++i) {
          for (int d = 0; d < 3; ++d) {
            const auto v = static_cast<std::size_t>(i), c = static_cast<std::size_t>(d);
            REQUIRE(sim::get_signed(top.m_pair_data, defs::request_a(w).lsb + w * (3 * i + d), w) == pair.a[v][c]);
            REQUIRE(sim::get_signed(top.m_pair_data, defs::request_b(w).lsb + w * (3 * i + d), w) == pair.b[v][c]);
          }
        }
        ++pairs;
      }
      complete = false;
      if (valid) {
        ++sending;
        cut_off += first && next >= 0 ? 1 : 0;
        if (first) {
          next = 0;
          pair.id = id;
          pair.err = err;
          pair.mode = mode;
        }
        if (next >= 0) {
          for (std::size_t i = static_cast<std::size_t>(next); i < 4; ++i) {
            pair.a[i] = a;
            pair.b[i] = b;
          }
          of_three += last && next == 2 ? 1 : 0;
          complete = last;
          next = last ? -1 : std::min(next + 1, 4);
        }
      }
      if (top.rst != 0) {
        next = -1;
        complete = false;
      }
      simulation.rise();
    }
    REQUIRE(pairs > 500);
    REQUIRE(of_three > 200);
    REQUIRE(cut_off > 50);
  });
}
