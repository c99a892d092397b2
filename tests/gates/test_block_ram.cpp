// SPDX-License-Identifier: Apache-2.0
#include <Vcchip_block_ram_ecp5_1.h>
#include <Vcchip_block_ram_ecp5_4.h>
#include <Vcchip_block_ram_portable_1.h>
#include <Vcchip_block_ram_portable_4.h>
#include <Vcchip_dual_ram_ecp5_10.h>
#include <Vcchip_dual_ram_ecp5_11.h>
#include <Vcchip_dual_ram_portable_10.h>
#include <Vcchip_dual_ram_portable_11.h>

#include "../unit/bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// The same accesses on both; words that are read on the clock on which they are written are not compared.
template <class Portable, class Block>
void compare(int words, int width, int addr_w) {
  sim::SimulationOptions options;
  Random random(options.seed);
  sim::Simulation<Portable> portable(options);
  sim::Simulation<Block> block(options);
  std::vector<bool> written(std::size_t{1} << addr_w);
  std::array<bool, 2> known{};
  int compared = 0;
  for (int clock = 0; clock < 20000; ++clock) {
    const int write_addr = static_cast<int>(random() % (written.size() / static_cast<std::size_t>(words)));
    const int read_addr = chance(random, 20) ? write_addr * words : static_cast<int>(random() % written.size());
    const bool write = chance(random, 60);
    sim::set_random(portable->write_data, words * width, random);
    block->write_data = portable->write_data;
    const auto drive = [&](auto& top) {
      top.write = write ? 1 : 0;
      sim::set_bits(top.write_addr, 0, words == 4 ? addr_w - 2 : addr_w, static_cast<std::uint64_t>(write_addr));
      sim::set_bits(top.read_addr, 0, addr_w, static_cast<std::uint64_t>(read_addr));
    };
    drive(portable.top());
    drive(block.top());
    portable.settle();
    block.settle();
    if (known[1]) {
      for (int bit = 0; bit < width; bit += 32) {
        const int bits = std::min(32, width - bit);
        if (sim::get_bits(portable->read_data, bit, bits) != sim::get_bits(block->read_data, bit, bits))
          FAIL("clock " << clock << ": bits " << bit << " to " << bit + bits - 1 << " of the word differ");
      }
      ++compared;
    }
    const bool collides = write && read_addr / words == write_addr;
    known = {written[static_cast<std::size_t>(read_addr)] && !collides, known[0]};
    for (int i = 0; write && i < words; ++i) written[static_cast<std::size_t>(write_addr * words + i)] = true;
    portable.rise();
    block.rise();
  }
  REQUIRE(compared > 10000);
}

/// The same with a second port that reads, and a first one that reads when it does not write.
template <class Portable, class Block>
void compare_dual(int width, int addr_w) {
  sim::SimulationOptions options;
  Random random(options.seed);
  sim::Simulation<Portable> portable(options);
  sim::Simulation<Block> block(options);
  const auto words = std::uint64_t{1} << addr_w;
  std::vector<bool> written(words);
  std::array<std::array<bool, 2>, 2> known{};
  int compared = 0;
  for (int clock = 0; clock < 20000; ++clock) {
    const bool write = chance(random, 60);
    const std::uint64_t a = random() % words;
    const std::uint64_t b = chance(random, 20) ? a : random() % words;
    const std::uint64_t data = random();
    const auto drive = [&](auto& top) {
      top.write = write ? 1 : 0;
      sim::set_bits(top.addr_a, 0, addr_w, a);
      sim::set_bits(top.addr_b, 0, addr_w, b);
      sim::set_bits(top.write_data, 0, width, data);
    };
    drive(portable.top());
    drive(block.top());
    portable.settle();
    block.settle();
    if (known[0][1]) REQUIRE(portable->read_data_a == block->read_data_a);
    if (known[1][1]) REQUIRE(portable->read_data_b == block->read_data_b);
    compared += (known[0][1] ? 1 : 0) + (known[1][1] ? 1 : 0);
    known[0] = {!write && written[a], known[0][0]};
    known[1] = {written[b] && !(write && a == b), known[1][0]};
    if (write) written[a] = true;
    portable.rise();
    block.rise();
  }
  REQUIRE(compared > 10000);
}

}  // namespace

TEST_CASE("DP16KD: a memory made of the block's model does what the portable one does", "[unit][gates]") {
  compare<Vcchip_block_ram_portable_1, Vcchip_block_ram_ecp5_1>(1, 22, 10);
  compare<Vcchip_block_ram_portable_4, Vcchip_block_ram_ecp5_4>(4, 96, 11);
  compare_dual<Vcchip_dual_ram_portable_10, Vcchip_dual_ram_ecp5_10>(40, 10);
  compare_dual<Vcchip_dual_ram_portable_11, Vcchip_dual_ram_ecp5_11>(40, 11);
}
