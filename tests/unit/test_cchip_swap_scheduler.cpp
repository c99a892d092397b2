// SPDX-License-Identifier: Apache-2.0
// The scheduler with slots, queues, table and controller played by the test.
#include <cchip/internal/wire/definitions.hpp>
#include <cchip/internal/wire/swap.hpp>
#include <cchip/machines/swap_port.hpp>
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
  static constexpr int kinds = Config::KINDS;
  static constexpr std::size_t stride = std::size_t{1} << defs::kind_bits(kinds);  ///< entries of a slot
  static constexpr std::size_t entries = stride * slots;

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
  unsigned valid = all();
  unsigned resting = 0;
  unsigned hopeless = 0;
  std::array<std::uint32_t, entries> address{};
  std::array<int, defs::kinds_max + 1> waiting{};  // by kind
  std::array<int, slots> modules{};                // 0: none
  unsigned full = 0;                               // bit kind - 1
  std::vector<SwapRequest> requests;               // accepted
  std::vector<SwapReport> told;
  unsigned cleared = 0;  // entries invalidated so far
  unsigned no_provider = 0;
  std::function<void()> on_clock = [] {};
  sim::Simulation<typename Config::Model> simulation;

  /// All bitstreams that there can be.
  static unsigned all() {
    unsigned bits = 0;
    for (std::size_t s = 0; s < slots; ++s) bits |= ((2U << kinds) - 1) << (stride * s);
    return bits;
  }
  /// Those of these modules, bit m for module m, of every slot.
  static unsigned of_modules(unsigned modules) {
    unsigned bits = 0;
    for (std::size_t s = 0; s < slots; ++s) bits |= modules << (stride * s);
    return bits;
  }
  static bool serves(int module_id, int kind) { return defs::rm_serves(module_id, kind) != 0; }

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
    sim::set_bits(top.table_hopeless, 0, static_cast<int>(entries), hopeless);
    // the table answers a look 2 clocks later
    if (looks_ > 0 && --looks_ == 0) {
      top.table_address = address.at(entry_);
      top.table_size = address.at(entry_) + 7;
    }
    for (int k = 1; k <= kinds; ++k) {
      sim::set_bits(top.waiting, Config::COUNT_W * (k - 1), Config::COUNT_W,
                    static_cast<std::uint64_t>(waiting[static_cast<std::size_t>(k)]));
    }
    for (std::size_t s = 0; s < slots; ++s) {
      sim::set_bits(top.slot_module, defs::kind_w * static_cast<int>(s), defs::kind_w,
                    static_cast<std::uint64_t>(modules[s]));
    }
    top.full = static_cast<CData>(full);
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
    if (top.table_look != 0) {
      entry_ = (static_cast<std::size_t>(top.table_entry >> 3U) * stride) + (top.table_entry & 7U);
      looks_ = 2;
    }
    if (top.m_swap_valid != 0 && ready) requests.push_back(sim::get_swap_request(top.m_swap_data));
    if (top.m_report_valid != 0) told.push_back(sim::get_swap_report(top.m_report_data));
    cleared |= static_cast<unsigned>(sim::get_bits(top.table_invalidate, 0, static_cast<int>(entries)));
    no_provider = top.no_provider;
  }

  Bench bench_;
  std::size_t entry_ = 0;  // being looked up
  int looks_ = 0;          // clocks until it is there
  std::optional<SwapRequest> command_;
  std::optional<SwapReport> report_;
};

#define CCHIP_CASE(name) \
  TEMPLATE_LIST_TEST_CASE("cchip_swap_scheduler: " name, "[unit][cchip_swap_scheduler]", cchip_swap_scheduler_configs)

/// body(bench) after each power-up.
template <class Config, class Body>
void with_bench(Body body) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    SchedulerBench<Config> bench(options);
    body(bench);
  });
}

}  // namespace

CCHIP_CASE("the choice in a still picture is that of the rules") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Random random(options.seed);
    SchedulerBench<TestType> bench(options);
    constexpr std::size_t slots = TestType::SLOTS;
    int chosen = 0, none = 0, old = 0, full = 0, larger = 0, kept = 0;
    for (int picture = 0; picture < 1500; ++picture) {
      bench.enable = false;
      bench.waiting.fill(0);
      bench.full = 0;
      // what is never reached, one bit of it at a time; or what is
      bench.batch = chance(random, 30) ? 1U << (6 + random() % 26) : static_cast<std::uint32_t>(random() % 20);
      bench.age = chance(random, 50) ? 1U << (11 + random() % 21) : static_cast<std::uint32_t>(random() % 250);
      bench.valid = static_cast<unsigned>(random()) & bench.all();
      bench.resting = chance(random, 50) ? 0 : static_cast<unsigned>(random() & random()) & bench.all();
      for (int& m : bench.modules) m = static_cast<int>(random() % (chance(random, 40) ? TestType::KINDS + 1U : 2U));
      bench.reset();
      std::optional<std::uint64_t> since;  // pairs of an unserved kind wait
      const auto is_served = [&](int kind) {
        return std::any_of(bench.modules.begin(), bench.modules.end(), [&](int m) { return bench.serves(m, kind); });
      };
      for (int kind = 1; kind <= TestType::KINDS; ++kind) {
        if (chance(random, 50)) continue;
        bench.waiting[static_cast<std::size_t>(kind)] = 1 + static_cast<int>(random() % 40);
        if (chance(random, 30)) bench.full |= 1U << (kind - 1);
        if (!is_served(kind) && !since) since = bench.simulation.clock();
        bench.steps(random() % 150);
      }
      bench.steps(6);  // until it has seen all of this
      const std::uint64_t its_age = since ? bench.simulation.clock() - *since : 0;
      if (since && bench.age + 6 > its_age && bench.age < its_age + 260) continue;  // it passes the limit meanwhile
      const bool too_old = since && its_age >= bench.age;
      // what the rules allow: for each kind that is due, one slot and module
      std::vector<std::pair<int, int>> legal;
      // would the exchange of slot s for module m take a kind of which pairs wait from its last slot?
      const auto is_needed = [&](std::size_t s, int m) {
        for (int kind = 1; kind <= TestType::KINDS; ++kind) {
          if (bench.waiting[static_cast<std::size_t>(kind)] == 0 || !bench.serves(bench.modules[s], kind)) continue;
          bool another = bench.serves(m, kind);
          for (std::size_t other = 0; other < slots; ++other) {
            another = another || (other != s && bench.serves(bench.modules[other], kind));
          }
          if (!another) return true;
        }
        return false;
      };
      for (int kind = 1; kind <= TestType::KINDS; ++kind) {
        const int waits = bench.waiting[static_cast<std::size_t>(kind)];
        const bool is_full = (bench.full >> (kind - 1) & 1U) != 0;
        if (is_served(kind) || waits == 0) continue;
        if (!too_old && !is_full && static_cast<unsigned>(waits) < bench.batch) continue;
        std::vector<std::tuple<int, int, int>> order;  // module, what the slot holds, slot
        for (std::size_t s = 0; s < slots; ++s) {
          for (int m = 1; m <= TestType::KINDS; ++m) {
            if (!bench.serves(m, kind)) continue;
            if (((bench.valid & ~bench.resting) >> (bench.stride * s + static_cast<std::size_t>(m)) & 1U) == 0)
              continue;
            const bool keeps = !too_old && is_needed(s, m);
            kept += keeps ? 1 : 0;
            if (!keeps) order.emplace_back(m, bench.modules[s], static_cast<int>(s));
          }
        }
        if (order.empty()) continue;
        const auto best = *std::min_element(order.begin(), order.end());
        legal.emplace_back(std::get<2>(best), std::get<0>(best));
        const bool enough = static_cast<unsigned>(waits) >= bench.batch;
        old += too_old && !is_full && !enough ? 1 : 0;
        full += is_full && !enough && !too_old ? 1 : 0;
        larger += std::get<0>(best) > kind ? 1 : 0;
      }
      bench.enable = true;
      constexpr std::size_t search = TestType::KINDS > 3 ? 15 : 9;
      bench.steps(TestType::KINDS * (4 + search * slots + 1) + 10);
      INFO("picture " << picture);
      REQUIRE(bench.requests.size() == (legal.empty() ? 0U : 1U));
      none += legal.empty() ? 1 : 0;
      if (legal.empty()) continue;
      ++chosen;
      const SwapRequest& got = bench.requests.front();
      REQUIRE(std::count(legal.begin(), legal.end(), std::pair(got.slot, got.module_id)) != 0);
      REQUIRE(
          got.address ==
          bench.address[bench.stride * static_cast<std::size_t>(got.slot) + static_cast<std::size_t>(got.module_id)]);
      REQUIRE(got.size == got.address + 7);
      REQUIRE(!got.force);
    }
    REQUIRE(chosen > 100);
    REQUIRE(none > 100);
    REQUIRE(old > 20);
    REQUIRE(full > 10);
    REQUIRE(larger > 20);
    REQUIRE((kept > 20) == (TestType::KINDS > 3));
  });
}

CCHIP_CASE("kinds are looked at in turn for 4 clocks each, and for no others") {
  with_bench<TestType>([](SchedulerBench<TestType>& bench) {
    bench.modules.fill(0);
    bench.enable = true;
    for (int kind = 1; kind <= TestType::KINDS; ++kind) {
      // pairs that come at any moment of a turn, twice: the wait differs by a turn less one clock
      int least = 1000, most = 0;
      for (int moment = 0; moment < 8 * TestType::KINDS; ++moment) {
        bench.waiting.fill(0);
        bench.reset();
        bench.steps(static_cast<std::uint64_t>(20 + moment));
        bench.waiting[static_cast<std::size_t>(kind)] = 5;
        int clocks = 0;
        for (; bench.requests.empty(); ++clocks) {
          REQUIRE(clocks < 200);
          bench.steps(1);
        }
        least = std::min(least, clocks);
        most = std::max(most, clocks);
      }
      CAPTURE(kind, least, most);
      REQUIRE(most - least == 4 * TestType::KINDS - 1);
    }
  });
}

CCHIP_CASE("after a report it rests until the slot shows the new module, which the next kind needs no more") {
  with_bench<TestType>([](SchedulerBench<TestType>& bench) {
    bench.modules.fill(1);
    bench.valid = bench.of_modules(8);  // that of quads, for kinds 2 and 3
    bench.waiting = {0, 0, 5, 5};
    bench.enable = true;
    bench.steps(100);
    REQUIRE(bench.requests.size() == 1);
    REQUIRE(bench.requests[0].module_id == 3);
    auto& changed = bench.modules[static_cast<std::size_t>(bench.requests[0].slot)];
    changed = 0;
    bench.steps(100);
    bench.report({bench.requests[0].slot, 3, SwapCode::ok, 0});
    bench.steps(12);
    changed = 3;
    bench.steps(300);
    REQUIRE(bench.requests.size() == 1);
  });
}

CCHIP_CASE("one swap at a time, a rejected bitstream is forgotten, an interrupted one is not") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    for (unsigned code = 0; code < 16; ++code) {
      SchedulerBench<TestType> bench(options);
      bench.modules.fill(1);
      bench.waiting = {0, 0, 5};
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
      REQUIRE(bench.cleared == (spoilt ? 1U << (bench.stride * static_cast<std::size_t>(slot) + 2) : 0));
    }
  });
}

CCHIP_CASE("an entry that rests is not chosen, but a command takes it, and its kind keeps its provider") {
  with_bench<TestType>([](SchedulerBench<TestType>& bench) {
    bench.modules.fill(1);
    bench.waiting = {0, 0, 5};
    bench.enable = true;
    bench.resting = bench.of_modules(12);  // kinds 2 and 3
    bench.steps(2000);
    REQUIRE(bench.requests.empty());
    REQUIRE(bench.no_provider == 0);
    bench.command(0, 2, false);
    bench.steps(3);
    REQUIRE(bench.requests.size() == 1);
    bench.report({0, 2, SwapCode::memory, 0});
    bench.steps(200);
    REQUIRE(bench.requests.size() == 1);
    bench.resting &= ~bench.of_modules(4);  // those of module 2 rest no more
    bench.steps(60);
    REQUIRE(bench.requests.size() == 2);
    REQUIRE(bench.requests[1].module_id == 2);
  });
}

CCHIP_CASE("a kind whose bitstreams are hopeless has no provider until one is tried again") {
  with_bench<TestType>([](SchedulerBench<TestType>& bench) {
    bench.modules.fill(1);
    bench.waiting = {0, 0, 5};
    bench.enable = true;
    bench.resting = bench.of_modules(12);  // kinds 2 and 3
    bench.steps(100);
    REQUIRE(bench.no_provider == 0);
    const unsigned one = 4U;  // module 2 of slot 0
    bench.hopeless = bench.resting & ~one;
    bench.steps(100);
    REQUIRE(bench.no_provider == 4);  // of kind 3; there is hope for kind 2
    bench.hopeless = bench.resting;
    bench.steps(14);
    REQUIRE(bench.no_provider == 4);
    bench.steps(10);
    REQUIRE(bench.no_provider == 6);
    // its rest is over: it is tried again, and its kinds wait
    bench.hopeless = bench.resting = 0;
    bench.steps(3);
    REQUIRE(bench.no_provider == 0);
    bench.steps(60);
    REQUIRE(bench.requests.size() == 1);
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
    REQUIRE(bench.requests[0].address == bench.address[bench.stride * (slots - 1) + 3]);
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
    bench.command(0, TestType::KINDS + 1, false);  // no such module
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

CCHIP_CASE("commands of any numbers are passed on or refused, and reports told, bit by bit") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    constexpr int slots = TestType::SLOTS;
    Random random(options.seed);
    SchedulerBench<TestType> bench(options);
    bench.modules.fill(1);
    bench.valid = static_cast<unsigned>(random()) & bench.all();
    const auto number = [&random](int most) {  // one that there is, that one with a bit too many, any
      const int small = static_cast<int>(random() % (static_cast<unsigned>(most) + 1));
      return chance(random, 70)   ? small
             : chance(random, 50) ? small | 1 << random() % 8
                                  : static_cast<int>(random() % 256);
    };
    int passed = 0, refused = 0;
    for (int i = 0; i < 600; ++i) {
      if (chance(random, 10)) bench.valid = static_cast<unsigned>(random()) & bench.all();  // so that each is met
      const int slot = number(slots - 1);
      const int module_id = number(TestType::KINDS);
      const bool force = chance(random, 50);
      const std::size_t entry = bench.stride * static_cast<std::size_t>(slot) + static_cast<std::size_t>(module_id);
      const bool is_known = slot < slots && module_id <= TestType::KINDS && (bench.valid >> entry & 1U) != 0;
      CAPTURE(i, slot, module_id);
      bench.requests.clear();
      bench.told.clear();
      bench.cleared = 0;
      bench.command(slot, module_id, force);
      bench.steps(5);
      REQUIRE(bench.requests.size() == (is_known ? 1U : 0U));
      REQUIRE(bench.told.size() == (is_known ? 0U : 1U));
      SwapReport expected = {slot, module_id, SwapCode::request, 0};
      if (is_known) {
        const SwapRequest& got = bench.requests[0];
        REQUIRE((got.slot == slot && got.module_id == module_id && got.force == force));
        REQUIRE((got.address == bench.address[entry] && got.size == got.address + 7));
        // refused meanwhile: told on its own clock, or one after that of the swap
        const int other_slot = static_cast<int>(random() % 256);
        const int other_module = static_cast<int>(random() % 256);
        const bool together = chance(random, 50);
        expected.code = static_cast<SwapCode>(random() % 14);
        expected.lost = static_cast<std::uint16_t>(random());
        if (together) bench.report_now(expected);
        bench.command(other_slot, other_module, false);
        bench.steps(3);
        if (!together) bench.report(expected);
        bench.steps(3);
        REQUIRE(bench.told.size() == 2);
        const SwapReport& busy = bench.told[together ? 1 : 0];
        REQUIRE((busy.slot == other_slot && busy.module_id == other_module && busy.code == SwapCode::busy &&
                 busy.lost == 0));
        if (!together) bench.told.erase(bench.told.begin());
        ++passed;
      } else {
        ++refused;
      }
      const SwapReport& told = bench.told[0];
      REQUIRE((told.slot == expected.slot && told.module_id == expected.module_id && told.code == expected.code &&
               told.lost == expected.lost));
      const bool spoilt = is_known && defs::swap_spoilt(static_cast<int>(expected.code)) != 0;
      REQUIRE(bench.cleared == (spoilt ? 1U << entry : 0U));
    }
    REQUIRE(passed > 50);
    REQUIRE(refused > 50);
  });
}

CCHIP_CASE("a kind has no provider after 16 clocks without slot, bitstream and swap, and at once one again") {
  with_bench<TestType>([](SchedulerBench<TestType>& bench) {
    bench.modules.fill(1);
    bench.ready = false;
    bench.steps(40);
    REQUIRE(bench.no_provider == 0);
    bench.valid &= ~bench.of_modules(8);
    bench.steps(15);
    REQUIRE(bench.no_provider == 0);
    bench.steps(3);
    REQUIRE(bench.no_provider == 4);
    bench.valid &= ~bench.of_modules(4);
    bench.steps(20);
    REQUIRE(bench.no_provider == 6);
    bench.valid |= 8;  // the largest module serves both
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
    REQUIRE(bench.no_provider == 6);  // of kind 1 there is a bitstream
    bench.modules[0] = 3;
    bench.steps(2);
    REQUIRE(bench.no_provider == 0);
  });
}

CCHIP_CASE("each kind has a provider exactly if a slot, a bitstream with hope or a swap in progress serves it") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Random random(options.seed);
    SchedulerBench<TestType> bench(options);
    constexpr std::size_t slots = TestType::SLOTS;
    std::array<std::array<int, 2>, defs::kinds_max + 1> seen{};
    for (int picture = 0; picture < 600; ++picture) {
      for (int& m : bench.modules) m = chance(random, 70) ? 0 : static_cast<int>(random() % (TestType::KINDS + 1U));
      bench.valid = static_cast<unsigned>(random() & random()) & bench.all();
      if (chance(random, 40)) bench.valid &= static_cast<unsigned>(random());
      bench.hopeless = chance(random, 50) ? 0 : static_cast<unsigned>(random()) & bench.all();
      int swapping = -1;
      if (chance(random, 30) && bench.valid != 0) {
        std::size_t entry = 0;
        do entry = random() % (slots * bench.stride);
        while ((bench.valid >> entry & 1U) == 0);
        swapping = static_cast<int>(entry % bench.stride);
        bench.ready = chance(random, 50);  // before the controller takes it, or while it works
        bench.command(static_cast<int>(entry / bench.stride), swapping, false);
      }
      bench.steps(30);
      for (int kind = 1; kind <= TestType::KINDS; ++kind) {
        bool provided = swapping >= 0 && bench.serves(swapping, kind);
        for (std::size_t s = 0; s < slots; ++s) {
          provided = provided || bench.serves(bench.modules[s], kind);
          for (int m = 1; m <= TestType::KINDS; ++m) {
            const unsigned hope = (bench.valid & ~bench.hopeless) >> (bench.stride * s + static_cast<std::size_t>(m));
            provided = provided || (bench.serves(m, kind) && (hope & 1U) != 0);
          }
        }
        CAPTURE(picture, kind, swapping);
        REQUIRE((bench.no_provider >> (kind - 1) & 1U) == (provided ? 0U : 1U));
        ++seen[static_cast<std::size_t>(kind)][provided ? 1 : 0];
      }
      if (swapping >= 0) {
        bench.ready = true;
        bench.steps(3);
        bench.report({bench.requests.back().slot, swapping, SwapCode::memory, 0});
      }
    }
    for (int kind = 1; kind <= TestType::KINDS; ++kind) {
      for (const int count : seen[static_cast<std::size_t>(kind)]) REQUIRE(count > 20);
    }
  });
}

CCHIP_CASE("a swap never takes a kind away: from blank slots to the largest module in three swaps at most") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Random random(options.seed);
    for (int round = 0; round < 20; ++round) {
      SchedulerBench<TestType> bench(options);
      bench.enable = true;
      bench.batch = 1;
      bench.modules.fill(0);
      int swaps = 0;
      for (int i = 0; i < 40; ++i) {
        bench.waiting[1 + random() % 3] = static_cast<int>(random() % 20);
        bench.steps(100);
        if (bench.requests.empty()) continue;
        const SwapRequest r = bench.requests.front();
        bench.requests.clear();
        const int before = *std::max_element(bench.modules.begin(), bench.modules.end());
        REQUIRE(r.module_id > before);
        REQUIRE(bench.modules[static_cast<std::size_t>(r.slot)] ==
                *std::min_element(bench.modules.begin(), bench.modules.end()));
        bench.modules[static_cast<std::size_t>(r.slot)] = 0;
        bench.steps(200);
        REQUIRE(bench.requests.empty());
        bench.modules[static_cast<std::size_t>(r.slot)] = r.module_id;
        bench.report({r.slot, r.module_id, SwapCode::ok, 0});
        ++swaps;
      }
      REQUIRE(swaps >= 1);
      REQUIRE(swaps <= 3);
    }
  });
}

CCHIP_CASE("points take the slot that alone serves waiting triangles after the age only, a free one at once") {
  if constexpr (TestType::KINDS > 3) {
    with_bench<TestType>([](SchedulerBench<TestType>& bench) {
      bench.modules.fill(0);
      bench.modules[0] = 1;
      bench.valid = 16;  // points, of slot 0 alone
      bench.batch = 1;
      bench.age = 400;
      bench.waiting = {0, 7, 0, 0, 3};
      bench.enable = true;
      bench.steps(380);
      REQUIRE(bench.requests.empty());
      bench.steps(120);
      REQUIRE(bench.requests.size() == 1);
      REQUIRE(bench.requests[0].module_id == 4);
      bench.modules[0] = 4;
      bench.report({0, 4, SwapCode::ok, 0});
      bench.valid = bench.all() & 31U;
      bench.steps(300);
      REQUIRE(bench.requests.size() == 1);  // points wait for it now
      bench.waiting[4] = 0;
      bench.steps(60);
      REQUIRE(bench.requests.size() == 2);
      REQUIRE(bench.requests[1].module_id == 1);
    });
  }
}
