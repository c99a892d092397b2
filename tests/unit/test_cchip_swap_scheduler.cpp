// SPDX-License-Identifier: Apache-2.0
// The scheduler with slots, queues, table and controller played by the test.
#include <cchip/rtl/swap_port.hpp>
#include <cchip/wire/definitions.hpp>
#include <cchip/wire/swap.hpp>
#include <models/cchip_swap_scheduler.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// Inputs as plain numbers; collects the outputs.
template <class Config>
class SchedulerBench {
 public:
  static constexpr std::size_t slots = Config::SLOTS;
  static constexpr std::size_t entries = 4 * slots;

  explicit SchedulerBench(const sim::SimulationOptions& options)
      : simulation(long_run(options)),
        bench_([this](const auto&) { drive(); }, [this](const auto& now) { sample(now); }) {
    for (std::size_t e = 0; e < entries; ++e) address[e] = static_cast<std::uint32_t>(64 * (e + 1));
    simulation.add(bench_);
    reset();
  }
  void reset() {
    requests.clear();
    told.clear();
    cleared = 0;
    simulation.reset();
  }
  void steps(std::uint64_t clocks) { simulation.steps(clocks); }
  void report(const SwapReport& r) {
    report_ = r;
    simulation.step();
    simulation.step();
  }
  /// For use inside on_clock.
  void report_now(const SwapReport& r) { report_ = r; }
  void command(int slot, int module_id, bool force) {
    command_ = SwapRequest{slot, module_id, 0, 0, force};
    simulation.step();
  }

  bool enable = false;
  bool ready = true;
  std::uint32_t batch = 1, age = 1000;
  unsigned valid = (1U << entries) - 1;
  unsigned resting = 0;
  std::array<std::uint32_t, entries> address{};
  std::array<int, 4> waiting{};       // by kind
  std::array<int, slots> modules{};   // 0: none
  unsigned taken = 0;                 // this clock, by slot
  std::vector<SwapRequest> requests;  // accepted
  std::vector<SwapReport> told;
  unsigned cleared = 0;  // entries invalidated so far
  unsigned no_provider = 0;
  std::function<void()> on_clock = [] {};
  sim::Simulation<typename Config::Model> simulation;

 private:
  static sim::SimulationOptions long_run(sim::SimulationOptions options) {
    options.timeout_clocks = 0;
    return options;
  }
  void drive() {
    on_clock();
    auto& top = simulation.top();
    top.enable = enable;
    top.min_batch = batch;
    top.max_age = age;
    sim::set_bits(top.table_valid, 0, static_cast<int>(entries), valid);
    sim::set_bits(top.table_resting, 0, static_cast<int>(entries), resting);
    for (std::size_t e = 0; e < entries; ++e) {
      sim::set_bits(top.table_address, static_cast<int>(32 * e), 32, address[e]);
      sim::set_bits(top.table_size, static_cast<int>(32 * e), 32, address[e] + 7);
    }
    for (int k = 1; k < 4; ++k) {
      sim::set_bits(top.waiting, Config::COUNT_W * (k - 1), Config::COUNT_W,
                    static_cast<std::uint64_t>(waiting[static_cast<std::size_t>(k)]));
    }
    for (std::size_t s = 0; s < slots; ++s) {
      sim::set_bits(top.slot_module, static_cast<int>(2 * s), 2, static_cast<std::uint64_t>(modules[s]));
    }
    top.slot_taken = static_cast<CData>(taken);
    top.m_swap_ready = ready;
    top.command_valid = command_ ? 1 : 0;
    const SwapRequest c = command_.value_or(SwapRequest{});
    top.command_slot = static_cast<CData>(c.slot);
    top.command_module = static_cast<CData>(c.module_id);
    top.command_force = c.force;
    command_.reset();
    top.s_report_valid = report_ ? 1 : 0;
    sim::put_swap_report(top.s_report_data, report_.value_or(SwapReport{}));
    report_.reset();
  }
  void sample(const sim::ClockInfo& now) {
    auto& top = simulation.top();
    if (now.in_reset) return;
    if (top.m_swap_valid != 0 && ready) requests.push_back(sim::get_swap_request(top.m_swap_data));
    if (top.m_report_valid != 0) told.push_back(sim::get_swap_report(top.m_report_data));
    cleared |= static_cast<unsigned>(sim::get_bits(top.table_invalidate, 0, static_cast<int>(entries)));
    no_provider = top.no_provider;
  }

  Bench bench_;
  std::optional<SwapRequest> command_;
  std::optional<SwapReport> report_;
};

#define CCHIP_CASE(name) \
  TEMPLATE_LIST_TEST_CASE("cchip_swap_scheduler: " name, "[unit][cchip_swap_scheduler]", cchip_swap_scheduler_configs)

}  // namespace

CCHIP_CASE("the choice in a still picture is that of the rules") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Random random(options.seed);
    SchedulerBench<TestType> bench(options);
    constexpr std::size_t slots = TestType::SLOTS;
    int chosen = 0, none = 0, old = 0, busy_slot = 0;
    for (int picture = 0; picture < 800; ++picture) {
      bench.enable = false;
      bench.waiting.fill(0);
      bench.taken = 0;
      bench.batch = static_cast<std::uint32_t>(random() % 20);
      bench.age = static_cast<std::uint32_t>(random() % 250);
      bench.valid = static_cast<unsigned>(random() & ((1U << (4 * slots)) - 1)) |
                    (chance(random, 50) ? ~0x11U & ((1U << (4 * slots)) - 1) : 0);
      for (int& m : bench.modules) m = static_cast<int>(random() % 4);
      bench.reset();
      // kinds begin to wait one after the other; slots take some pairs
      std::array<int, 3> order = {1, 2, 3};
      std::shuffle(order.begin(), order.end(), random);
      std::array<std::uint64_t, 4> since{};
      std::array<int, slots> pairs_taken{};
      for (const int kind : order) {
        if (chance(random, 75)) bench.waiting[static_cast<std::size_t>(kind)] = 1 + static_cast<int>(random() % 40);
        since[static_cast<std::size_t>(kind)] = bench.simulation.clock();
        for (int i = 0; i < 40; ++i) {
          bench.taken = chance(random, 20) ? static_cast<unsigned>(random() & ((1U << slots) - 1)) : 0;
          for (std::size_t s = 0; s < slots; ++s) pairs_taken[s] += static_cast<int>(bench.taken >> s & 1U);
          bench.steps(1);
        }
        bench.taken = 0;
      }
      bench.steps(4);  // until it has seen all of this
      const std::uint64_t now = bench.simulation.clock();
      // the decision by the rules
      std::optional<std::tuple<bool, std::uint64_t>> best;  // of the kinds: too old, then age or pairs
      std::size_t best_slot = 0;
      int best_kind = 0;
      bool unclear = false;
      bool best_idle = false;
      for (int kind = 1; kind < 4; ++kind) {
        const auto k = static_cast<std::size_t>(kind);
        const bool provided = std::count(bench.modules.begin(), bench.modules.end(), kind) != 0;
        if (bench.waiting[k] == 0 || provided) continue;
        const std::uint64_t its_age = now - since[k];
        unclear = unclear || (bench.age + 4 > its_age && bench.age < its_age + 40);
        const bool too_old = its_age >= bench.age;
        const std::tuple merit(too_old, too_old ? its_age : static_cast<std::uint64_t>(bench.waiting[k]));
        std::optional<std::tuple<bool, bool>> best_of_slots;  // idle, not exchanged last
        const bool enough = bench.waiting[k] >= static_cast<int>(bench.batch);
        for (std::size_t s = 0; s < slots; ++s) {
          const int has = bench.modules[s];
          const bool idle = has == 0 || bench.waiting[static_cast<std::size_t>(has)] == 0;
          const bool settled = has != 0 && pairs_taken[s] > 0 && pairs_taken[s] >= static_cast<int>(bench.batch);
          const bool legal =
              (bench.valid >> (4 * s + k) & 1U) != 0 && ((idle && (enough || too_old)) || (settled && too_old));
          const std::tuple merit_of_slot(idle, s != 1);
          const bool first = !best_of_slots && (!best || merit > *best);
          const bool better_slot = best_of_slots && merit_of_slot > *best_of_slots;
          if (!legal || !(first || better_slot)) continue;
          best = merit;
          best_of_slots = merit_of_slot;
          best_slot = s;
          best_kind = kind;
          best_idle = idle;
        }
      }
      bench.enable = true;
      bench.steps(2 * (3 * slots + 3) + 2);  // two scans
      if (unclear) continue;                 // an age passes the limit meanwhile
      INFO("picture " << picture);
      REQUIRE(bench.requests.size() == (best ? 1U : 0U));
      none += best ? 0 : 1;
      if (!best) continue;
      ++chosen;
      old += std::get<0>(*best) ? 1 : 0;
      busy_slot += best_idle ? 0 : 1;
      const SwapRequest& got = bench.requests.front();
      REQUIRE(got.module_id == best_kind);
      REQUIRE(got.slot == static_cast<int>(best_slot));
      REQUIRE(got.address == bench.address[4 * best_slot + static_cast<std::size_t>(best_kind)]);
      REQUIRE(got.size == got.address + 7);
      REQUIRE(!got.force);
    }
    REQUIRE(chosen > 100);
    REQUIRE(none > 50);
    REQUIRE(old > 20);
    REQUIRE(busy_slot > 5);
  });
}

CCHIP_CASE("one swap at a time; a rejected bitstream is forgotten, an interrupted one is not") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    for (unsigned code = 0; code < 16; ++code) {
      SchedulerBench<TestType> bench(options);
      bench.modules.fill(1);
      bench.waiting = {0, 0, 5, 0};
      bench.enable = true;
      bench.steps(60);
      REQUIRE(bench.requests.size() == 1);
      REQUIRE(bench.requests[0].module_id == 2);
      const int slot = bench.requests[0].slot;
      bench.enable = false;
      bench.report({slot, 2, static_cast<SwapCode>(code), 3});
      bench.steps(2);
      REQUIRE(bench.told.size() == 1);
      REQUIRE(bench.told[0].code == static_cast<SwapCode>(code));
      REQUIRE(bench.told[0].slot == slot);
      REQUIRE(bench.told[0].module_id == 2);
      REQUIRE(bench.told[0].lost == 3);
      const auto c = static_cast<SwapCode>(code);
      const bool spoilt = c == SwapCode::request || c == SwapCode::magic || c == SwapCode::slot ||
                          c == SwapCode::module || c == SwapCode::length || c == SwapCode::crc ||
                          c == SwapCode::wrong_module;  // the others say nothing about the bitstream
      REQUIRE((defs::swap_spoilt(static_cast<int>(code)) != 0) == spoilt);
      REQUIRE(bench.cleared == (spoilt ? 1U << (4 * slot + 2) : 0));
    }
  });
}

CCHIP_CASE("an entry that rests is not chosen, but a command takes it, and its kind keeps its provider") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    SchedulerBench<TestType> bench(options);
    bench.modules.fill(1);
    bench.waiting = {0, 0, 5, 0};
    bench.enable = true;
    for (std::size_t s = 0; s < TestType::SLOTS; ++s) bench.resting |= 12U << (4 * s);  // kinds 2 and 3
    bench.steps(2000);
    REQUIRE(bench.requests.empty());
    REQUIRE(bench.no_provider == 0);
    bench.command(0, 2, false);
    bench.steps(3);
    REQUIRE(bench.requests.size() == 1);
    bench.report({0, 2, SwapCode::memory, 0});
    bench.steps(200);
    REQUIRE(bench.requests.size() == 1);
    bench.resting = 0;
    bench.steps(60);
    REQUIRE(bench.requests.size() == 2);
    REQUIRE(bench.requests[1].module_id == 2);
  });
}

CCHIP_CASE("commands: passed on, busy, no such bitstream") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    constexpr int slots = TestType::SLOTS;
    SchedulerBench<TestType> bench(options);
    bench.modules.fill(1);
    bench.command(slots - 1, 3, true);
    bench.steps(3);
    REQUIRE(bench.requests.size() == 1);
    REQUIRE(bench.requests[0].slot == slots - 1);
    REQUIRE(bench.requests[0].module_id == 3);
    REQUIRE(bench.requests[0].address == bench.address[4 * (slots - 1) + 3]);
    REQUIRE(bench.requests[0].force);
    bench.command(0, 2, false);
    bench.steps(3);
    REQUIRE(bench.requests.size() == 1);
    REQUIRE(bench.told.size() == 1);
    REQUIRE(bench.told[0].code == SwapCode::busy);
    REQUIRE(bench.told[0].module_id == 2);
    // refused on the clock of a report: both are reported
    bench.report_now({slots - 1, 3, SwapCode::ok, 0});
    bench.command(0, 2, false);
    bench.steps(3);
    REQUIRE(bench.told.size() == 3);
    REQUIRE(bench.told[1].code == SwapCode::ok);
    REQUIRE(bench.told[2].code == SwapCode::busy);
    bench.command(slots, 1, false);  // no such slot
    bench.steps(3);
    bench.command(0, 4, false);  // no such module
    bench.steps(3);
    bench.valid &= ~2U;
    bench.command(0, 1, false);  // no bitstream
    bench.steps(3);
    REQUIRE(bench.told.size() == 6);
    for (std::size_t i = 3; i < 6; ++i) REQUIRE(bench.told[i].code == SwapCode::request);
    REQUIRE(bench.requests.size() == 1);
    REQUIRE(bench.cleared == 0);
    bench.command(0, 0, false);  // blank, by software only
    bench.steps(3);
    REQUIRE(bench.requests.size() == 2);
    REQUIRE(bench.requests[1].module_id == 0);
  });
}

CCHIP_CASE("a kind has no provider after 16 clocks without slot, bitstream and swap, and at once one again") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    SchedulerBench<TestType> bench(options);
    bench.modules.fill(1);
    bench.ready = false;
    bench.steps(40);
    REQUIRE(bench.no_provider == 0);
    for (std::size_t s = 0; s < TestType::SLOTS; ++s) bench.valid &= ~(1U << (4 * s + 3));
    bench.steps(15);
    REQUIRE(bench.no_provider == 0);
    bench.steps(3);
    REQUIRE(bench.no_provider == 4);
    bench.valid |= 8;
    bench.steps(2);
    REQUIRE(bench.no_provider == 0);
    bench.command(0, 3, false);  // a swap provides it, though its bitstream is removed meanwhile
    bench.valid &= ~8U;
    bench.steps(40);
    REQUIRE(bench.no_provider == 0);
    bench.ready = true;
    bench.steps(2);
    bench.report({0, 3, SwapCode::crc, 0});
    bench.modules[0] = 0;
    bench.steps(20);
    REQUIRE((bench.no_provider & 4U) != 0);
    bench.modules[0] = 3;
    bench.steps(2);
    REQUIRE((bench.no_provider & 4U) == 0);
  });
}

CCHIP_CASE("no kind starves under full load, and every turn serves pairs") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Random random(options.seed);
    constexpr std::size_t slots = TestType::SLOTS;
    for (const std::uint32_t age : {0U, 300U, 3000U}) {
      for (const int swap_clocks : {20, 700}) {
        SchedulerBench<TestType> bench(options);
        bench.enable = true;
        bench.batch = 8;
        bench.age = age;
        bench.modules.fill(1);
        std::array<int, slots> left{};  // clocks of the swap
        std::size_t swapping = slots;
        int coming = 0;
        std::array<std::uint64_t, 4> served_at{}, longest{};
        std::array<int, 4> served{};
        int swaps = 0, since_swap = 0;
        bench.waiting = {0, 30, 30, 30};
        bench.on_clock = [&] {
          const std::uint64_t now = bench.simulation.clock();
          bench.taken = 0;
          for (std::size_t s = 0; s < slots; ++s) {
            const auto has = static_cast<std::size_t>(bench.modules[s]);
            if (has == 0 || !chance(random, 30)) continue;  // all queues stay full
            bench.taken |= 1U << s;
            ++served[has];
            ++since_swap;
            longest[has] = std::max(longest[has], now - served_at[has]);
            served_at[has] = now;
          }
          if (!bench.requests.empty()) {
            const SwapRequest r = bench.requests.front();
            bench.requests.clear();
            swapping = static_cast<std::size_t>(r.slot);
            coming = r.module_id;
            bench.modules[swapping] = 0;
            left[swapping] = swap_clocks;
          } else if (swapping < slots && --left[swapping] == 0) {
            bench.modules[swapping] = coming;
            bench.report_now({static_cast<int>(swapping), coming, SwapCode::ok, 0});
            swapping = slots;
            ++swaps;
            REQUIRE((slots == 2 || swaps == 1 || since_swap > 0));  // no turn without a pair
            since_swap = 0;
          }
        };
        bench.steps(60000);
        // the kind becomes too old, the present swap ends, a slot settles, one older kind goes first
        const std::uint64_t turn = static_cast<std::uint64_t>(swap_clocks) + 40 + std::max<std::uint64_t>(age, 1024);
        const std::uint64_t bound = age + 3 * turn;
        for (std::size_t kind = 1; kind < 4; ++kind) {
          CAPTURE(age, swap_clocks, kind, served[kind], swaps);
          REQUIRE(longest[kind] <= bound);
          REQUIRE(60000 - served_at[kind] <= bound);
          REQUIRE(served[kind] >= static_cast<int>(60000 / bound) * 8);
        }
        REQUIRE(swaps > 10);
      }
    }
  });
}
