// SPDX-License-Identifier: Apache-2.0
// The simulated region from its own side of the boundary, without a decoupler.
#include <models/cchip_pr_virtual.hpp>
#include <set>

#include "slot_bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// Outputs of the region as one number.
template <class Model>
std::uint64_t outputs(const Model& top) {
  constexpr int w = defs::slot_result_w;
  return std::uint64_t{top.m_result_data} | std::uint64_t{top.rm_id} << w | std::uint64_t{top.idle} << (w + 8) |
         std::uint64_t{top.m_result_valid} << (w + 9);
}
constexpr int output_bits = defs::slot_result_w + 10;

template <class Config>
class Region {
  using Model = typename Config::Model;

 public:
  explicit Region(const sim::SimulationOptions& options)
      : random(options.seed), simulation(options), top(simulation.top()) {
    sim::set_random(top.s_vertex_data, defs::vertex_w(Config::COORD_W), random);
    top.s_vertex_valid = 0;
    top.cfg_valid = 0;
    simulation.reset();
  }
  /// One byte to the port; the outputs on the clock after it.
  std::uint64_t write(std::uint8_t byte) {
    top.cfg_valid = 1;
    top.cfg_data = byte;
    simulation.step();
    top.cfg_valid = 0;
    return outputs(top);
  }

  Random random;
  sim::Simulation<Model> simulation;
  Model& top;
};

/// What the region outputs during the second half of a transfer.
template <class Config>
std::vector<std::uint64_t> garbage(const sim::SimulationOptions& options) {
  Region<Config> region(options);
  std::vector<std::uint64_t> seen;
  for (const std::uint8_t byte : make_payload(Config::SLOT_ID, 2, 200, region.random))
    seen.push_back(region.write(byte));
  return {seen.begin() + 100, seen.end() - 1};
}

}  // namespace

TEST_CASE("cchip_pr_virtual: every output is random from the name of the slot to the last byte, no clock longer",
          "[unit][cchip_pr_virtual]") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    using Config = virtual_8;
    Region<Config> region(options);
    for (const int module : {3, 0, 4, 2, 1, 1}) {
      const auto before = region.top.rm_id;
      const Bytes bytes = make_payload(Config::SLOT_ID, module, 1000, region.random);
      std::vector<std::uint64_t> garbage;
      for (std::size_t i = 0; i < bytes.size(); ++i) {
        const std::uint64_t out = region.write(bytes[i]);
        if (i < 7) {
          REQUIRE(region.top.rm_id == before);
        } else if (i + 1 < bytes.size()) {
          garbage.push_back(out);
        }
      }
      REQUIRE(int{region.top.rm_id} == module);
      REQUIRE(std::set<std::uint64_t>(garbage.begin(), garbage.end()).size() > garbage.size() - 5);
      for (int bit = 0; bit < output_bits; ++bit) {  // half of the clocks each
        const auto ones = std::count_if(garbage.begin(), garbage.end(), [&](std::uint64_t g) { return g >> bit & 1; });
        INFO("bit " << bit << ", " << ones << " of " << garbage.size());
        REQUIRE(ones > static_cast<int>(garbage.size()) / 3);
        REQUIRE(ones < static_cast<int>(garbage.size()) * 2 / 3);
      }
    }
  });
}

TEST_CASE(
    "cchip_pr_virtual: the modules' state is scrambled even while rst is 1, only an rst that begins afterwards clears "
    "it",
    "[unit][cchip_pr_virtual]") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    using Config = virtual_8;
    for (const int module : {1, 2, 3, 4}) {
      for (const bool reset_after : {false, true}) {  // of its own
        Region<Config> region(options);
        region.top.rst = 1;
        for (const std::uint8_t byte : make_payload(Config::SLOT_ID, module, 100, region.random)) region.write(byte);
        region.simulation.steps(8);
        region.top.rst = 0;
        if (reset_after) {
          region.simulation.step();
          region.top.rst = 1;
          region.simulation.step();
          region.top.rst = 0;
        }
        int answers = 0;
        for (int clock = 0; clock < 2000; ++clock) {
          region.simulation.step();
          answers += region.top.m_result_valid;
        }
        INFO("module " << module << ", reset afterwards " << reset_after);
        REQUIRE((answers > 0) == !reset_after);
      }
    }
  });
}

TEST_CASE("cchip_pr_virtual: SEED chooses the garbage, regardless of the flip-flops at power-up",
          "[unit][cchip_pr_virtual]") {
  sim::SimulationOptions options;
  const auto first = garbage<virtual_8>(options);
  const auto other = garbage<virtual_seed>(options);
  ++options.seed;
  REQUIRE(garbage<virtual_8>(options) == first);
  REQUIRE(garbage<virtual_seed>(options) == other);
  std::size_t same = 0;
  for (std::size_t i = 0; i < first.size(); ++i) same += first[i] == other[i] ? 1 : 0;
  REQUIRE(same < 3);
}
