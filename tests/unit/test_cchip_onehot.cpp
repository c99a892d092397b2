// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_onehot_index.hpp>
#include <models/cchip_onehot_mux.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_onehot_mux: the selected word, and 0 without one", "[unit][cchip_onehot_mux]",
                        cchip_onehot_mux_configs) {
  constexpr int n = TestType::N;
  constexpr int width = TestType::WIDTH;
  Random random(sim::seed_from_environment());
  const auto top = std::make_unique<typename TestType::Model>();
  for (int round = 0; round < 200; ++round) {
    std::array<std::uint64_t, n> words{};
    for (int i = 0; i < n; ++i) {
      words[static_cast<std::size_t>(i)] = static_cast<std::uint64_t>(random()) & ((std::uint64_t{1} << width) - 1);
      sim::set_bits(top->s_data, i * width, width, words[static_cast<std::size_t>(i)]);
    }
    for (int i = 0; i <= n; ++i) {  // n: none
      sim::set_bits(top->select, 0, n, i < n ? std::uint64_t{1} << i : 0);
      top->eval();
      REQUIRE(sim::get_bits(top->m_data, 0, width) == (i < n ? words[static_cast<std::size_t>(i)] : 0));
    }
  }
}

TEMPLATE_LIST_TEST_CASE("cchip_onehot_index: the number of the bit, and 0 without one", "[unit][cchip_onehot_index]",
                        cchip_onehot_index_configs) {
  const auto top = std::make_unique<typename TestType::Model>();
  for (int i = 0; i < TestType::N; ++i) {
    sim::set_bits(top->select, 0, TestType::N, std::uint64_t{1} << i);
    top->eval();
    REQUIRE(top->index == i);
  }
  sim::set_bits(top->select, 0, TestType::N, 0);
  top->eval();
  REQUIRE(top->index == 0);
}
