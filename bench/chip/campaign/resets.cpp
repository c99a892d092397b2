// SPDX-License-Identifier: Apache-2.0
// Soft resets of chips without and with swaps.
#include <Vcchip_chip.h>
#include <Vcchip_chip_swaps1.h>
#include <Vcchip_chip_swaps2.h>
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "campaign.hpp"
#include "chip_objects.hpp"
#include "port_bench.hpp"

namespace cchip::testing {
namespace {

namespace regs = chip_registers;

/// A chip with swaps: the module that answered a pair decides how certain it is, and a pair that a swap left without a
/// module comes back open. So there may be more open pairs, never fewer contacts or more definite ones.
std::string compare_ids(const Query& query, const ChipAnswer& answer, const model::BroadPhaseResult& expected) {
  if (!answer.done) return "no answer";
  using Key = std::pair<std::uint32_t, std::uint32_t>;
  std::set<Key> wanted, got;
  for (const PairRecord& x : expected.pairs) wanted.emplace(x.id_a, x.id_b);
  bool more = false;
  for (const PairRecord& x : answer.pairs) {
    got.emplace(x.id_a, x.id_b);
    const bool is_new = wanted.count({x.id_a, x.id_b}) == 0;
    more = more || is_new;
    // the first contact may be any, so a definite one that the model does not name is no error there
    if (is_new && x.definite && query.mode == QueryMode::all) return "a definite contact that is none";
  }
  const auto some = [](QueryAnswer x) { return x != QueryAnswer::no; };
  if (some(expected.done.answer) && !some(answer.done->answer)) return "answer";
  if (!some(expected.done.answer) && some(answer.done->answer) && !more) return "answer";
  if (answer.done->answer == QueryAnswer::yes && !some(expected.done.answer)) return "yes";
  if (query.mode == QueryMode::first) return "";
  if (answer.done->code != expected.done.code) return "code";
  if (answer.done->steps != expected.done.steps) return "steps";
  return std::includes(got.begin(), got.end(), wanted.begin(), wanted.end()) ? "" : "a contact is missing";
}

template <class Bench>
int run_resets_of(const ResetSettings& settings) {
  const std::size_t resets = settings.resets;
  const std::uint64_t seed = settings.seed;
  const std::uint32_t slots = settings.slots;
  const bool swaps = slots > 0;
  Random random(seed);
  fmt::print("seed={}\n", seed);
  ChipDriverOptions driver = small_rings();
  if (swaps) driver.memory_base = std::uint64_t{1} << 20U;  // of bitstreams, too
  Bench bench(sim::without_timeout(seed), {}, driver, 1);
  std::size_t in_swaps = 0;
  Objects objects(Kind::quad);
  objects.place(bench);
  std::size_t wrong = 0, hangs = 0, checked = 0;
  constexpr std::uint32_t transfer = 5;     // phase of a swap
  constexpr std::uint64_t port_clocks = 2;  // of a word of the configuration port, a byte
  constexpr std::uint64_t longest_swap = 20000;
  for (std::size_t i = 0; i < resets; ++i) {
    bench.machine().memory().options = any_memory(random);
    for (const Query& query : queries_of(objects, random, 12)) bench.submit(query);
    const std::uint64_t clocks = i % 2 == 0 ? random() % 3000 : random() % 100;
    const std::uint32_t slot = slots > 1 ? static_cast<std::uint32_t>(random() % slots) : 0;
    const auto field = [&](std::uint32_t mask, int shift) {
      return (bench.machine().read_register(regs::slot_status::offset(slot)) & mask) >> shift;
    };
    const auto phase = [&] { return field(regs::slot_status::phase_mask, regs::slot_status::phase_shift); };
    if (swaps) {
      const std::uint32_t now = field(regs::slot_status::module_id_mask, regs::slot_status::module_id_shift);
      const std::uint32_t other = 1 + (now + static_cast<std::uint32_t>(random() % 2)) % 3;
      bench.machine().write_register(regs::swap_command::offset, regs::swap_command::go_mask |
                                                                     slot << regs::swap_command::slot_shift |
                                                                     other << regs::swap_command::module_id_shift);
    }
    std::uint64_t wait = clocks;
    if (swaps && i % 4 >= 2) {
      // Nearly all of a swap is its transfer: a quarter of the resets looks for one of the phases before it, another
      // begins about where it ends, and continues while the new module is reset and taken into operation.
      const std::uint32_t wanted = i % 4 == 2 ? 1 + static_cast<std::uint32_t>(random() % 4) : transfer;
      for (std::uint64_t k = 0; k < longest_swap && phase() < wanted; ++k) bench.step();
      wait = i % 4 == 2 ? clocks % 16 : driver.payload_bytes * port_clocks - 48 + clocks % 64;
    }
    for (std::uint64_t k = 0; k < wait; ++k) bench.step();
    if (swaps && phase() != 0) ++in_swaps;
    if (!bench.recover()) {
      ++hangs;
      bench.machine().reset();
      bench.recover();
      continue;
    }
    const std::size_t from = bench.queries().size();
    for (const Query& query : queries_of(objects, random, 3)) bench.submit(query);
    if (!bench.run(round_clocks)) ++hangs;
    for (std::size_t k = from; k < bench.queries().size(); ++k) {
      const Query& query = bench.queries()[k];
      const model::BroadPhaseResult expected = objects.expected(query);
      const ChipAnswer& answer = bench.answers()[k];
      const std::string text =
          swaps ? compare_ids(query, answer, expected) : compare_answer(query, answer, expected, 16);
      if (!text.empty()) {
        ++wrong;
        fmt::print("reset {}, query {}: {}, mode {}, code {} {}, answer {} {}, records {} {}, steps {} {}\n", i,
                   k - from, text, query.mode == QueryMode::first ? "first" : "all",
                   answer.done ? static_cast<int>(answer.done->code) : -1, static_cast<int>(expected.done.code),
                   answer.done ? static_cast<int>(answer.done->answer) : -1, static_cast<int>(expected.done.answer),
                   answer.pairs.size(), expected.pairs.size(), answer.done ? answer.done->steps : 0,
                   expected.done.steps);
      }
      ++checked;
    }
  }
  wrong += bench.wrong().size();
  fmt::print("resets={} wrong={} hangs={} checked={}", resets, wrong, hangs, checked);
  if (swaps) fmt::print(" in_swaps={}", in_swaps);
  fmt::print("\n");
  return resets != 0 && wrong == 0 && hangs == 0 ? 0 : 3;
}

}  // namespace

int run_resets(const ResetSettings& settings) {
  if (settings.slots == 1) return run_resets_of<PortBench<Vcchip_chip_swaps1, 128>>(settings);
  if (settings.slots == 2) return run_resets_of<PortBench<Vcchip_chip_swaps2, 128>>(settings);
  return run_resets_of<PortBench<Vcchip_chip, 128>>(settings);
}

}  // namespace cchip::testing
