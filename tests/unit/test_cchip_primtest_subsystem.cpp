// SPDX-License-Identifier: Apache-2.0
// The subsystem as a whole: every tag is answered once and correctly, even if swaps fail; each fault has its
// code and leaves the slot in the documented state. Answers come from the exact oracle and the model of the tests.
#include <catch2/catch.hpp>
#include <cchip/sim/wave_on_failure.hpp>

#include "subsystem_bench.hpp"

using namespace cchip;
using namespace cchip::subsystem;

namespace {

using Configs = std::tuple<OneSlot, TwoSlots, FourSlots, OneSlotPoints>;
#define CCHIP_CASE(name) \
  TEMPLATE_LIST_TEST_CASE("cchip_primtest_subsystem: " name, "[unit][cchip_primtest_subsystem]", Configs)

template <class Body>
void with_wave(Body&& body) {
  std::string name = Catch::getResultCapture().getCurrentTestName();
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  sim::with_wave_on_failure(name, body);
}

/// A system after reset with all bitstreams; the scheduler is off unless said otherwise.
template <class Config>
struct System : SubsystemBench<Config> {
  explicit System(const sim::SimulationOptions& options, bool scheduler = false) : SubsystemBench<Config>(options) {
    this->reset();
    this->set_up();
    if (!scheduler) this->write(regs::control::offset, 0);
    this->write(regs::shutdown_limit::offset, 4000);  // longer than the longest pair
    this->write(regs::memory_limit::offset, 100);
  }
  void push_some(int pairs) {
    for (int i = 0; i < pairs; ++i) this->push(1 + static_cast<int>(this->random()() % Config::KINDS));
  }
  /// A swap by software.
  SwapReport swap(int slot, int module_id, bool force = false) {
    this->command(slot, module_id, force);
    const SwapReport r = this->next_report();
    this->settle_bus();
    return r;
  }
  /// All slots get the test of triangles, by software, so that the scheduler has to work again.
  void only_triangles() {
    for (int slot = 0; slot < Config::SLOTS; ++slot) {
      if (this->module_in(slot) != 1) REQUIRE(swap(slot, 1).code == SwapCode::ok);
    }
  }
  /// Everything works: a pair of each kind is tested.
  void works() {
    this->memory.resume();
    this->memory.set_fault({});
    this->sink.set_pattern(sim::Pattern::always());
    this->set_up();
    const std::uint64_t refused = this->account.refused;
    for (int kind = 1; kind <= Config::KINDS; ++kind) {
      for (int i = 0; i < 3; ++i) this->push(kind);
    }
    this->finish();
    REQUIRE(this->account.refused == refused);
  }
  bool irq() { return this->top().irq != 0; }
  static constexpr std::uint32_t all_entries() {
    std::uint32_t all = 0;
    for (int slot = 0; slot < Config::SLOTS; ++slot) {
      all |= ((2U << Config::KINDS) - 1) << (defs::table_modules * slot);
    }
    return all;
  }
  /// Bit per entry: its bitstream is announced.
  std::uint32_t announced() {
    std::uint32_t valid = 0;
    for (std::uint32_t e = 0; e < defs::table_modules * Config::SLOTS; ++e)
      valid |= this->read(regs::bitstream_valid::offset(e)) << e;
    return valid;
  }
};

}  // namespace

CCHIP_CASE("mixed kinds by real swaps, counters and interrupt") {
  with_wave([](const sim::SimulationOptions& options) {
    System<TestType> s(options, true);
    REQUIRE(s.read(regs::id::offset) == regs::id::value_reset);
    REQUIRE(s.read(regs::capabilities::offset) ==
            static_cast<std::uint32_t>(TestType::KINDS << 24 | TestType::COORD_W << 16 | TestType::CFG_W << 8 |
                                       TestType::SLOTS));
    REQUIRE(s.read(regs::queue_depth::offset) == TestType::QUEUE_DEPTH);
    std::array<std::uint32_t, 5> sent{};
    for (int round = 0; round < 4; ++round) {
      s.only_triangles();
      for (int i = 0; i < 100; ++i) {
        const int kind = static_cast<int>(s.random()() % (TestType::KINDS + 1));
        ++sent[static_cast<std::size_t>(kind)];
        s.push(kind);
      }
      s.finish();
    }
    REQUIRE(s.account.pairs == 400);
    REQUIRE(s.account.refused == 0);
    REQUIRE(s.account.open == 0);
    std::uint32_t counted = 0;
    for (std::uint32_t m = 0; m < 5; ++m) {
      counted += s.read(regs::pairs::offset(m));
      REQUIRE(s.read(regs::pairs::offset(m) + 4) == 0);
    }
    REQUIRE(counted == 400);
    REQUIRE(s.read(regs::pairs::offset(0)) == sent[0]);
    REQUIRE(s.read(regs::pairs::offset(1)) <= sent[1]);
    REQUIRE(s.read(regs::pairs::offset(3)) >= sent[3]);
    REQUIRE(s.read(regs::pairs::offset(4)) == sent[4]);
    for (const SwapReport& r : s.reports) {
      CAPTURE(r.clock, r.slot, r.module_id, static_cast<int>(r.code), r.lost);
      REQUIRE(r.code == SwapCode::ok);
    }
    REQUIRE(s.count(SwapCode::ok) >= 7);  // four by the scheduler, three back
    REQUIRE(s.read(regs::swaps::offset) == s.reports.size());
    REQUIRE(s.read(regs::rejected::offset) == 0);
    REQUIRE(s.read(regs::lost::offset) == 0);
    REQUIRE(s.irq());
    REQUIRE(s.read(regs::interrupt_status::offset) ==
            (regs::interrupt_status::done_mask | regs::interrupt_status::illegal_kind_mask));
    s.write(regs::interrupt_status::offset, 0x1F);
    s.steps(2);
    REQUIRE(!s.irq());
    s.write(regs::control::offset, regs::control::clear_mask);
    REQUIRE(s.read(regs::pairs::offset(1)) == 0);
    REQUIRE(s.read(regs::swaps::offset) == 0);
  });
}

CCHIP_CASE("all patterns of senders and receivers") {
  with_wave([](const sim::SimulationOptions& options) {
    System<TestType> s(options, true);
    for (const sim::Pattern& source : sim::standard_patterns(options.seed)) {
      for (const sim::Pattern& back_pressure : sim::standard_patterns(options.seed + 100)) {
        INFO("s_pair " << source.name() << ", m_result " << back_pressure.name());
        s.driver.set_pattern(source);
        s.sink.set_pattern(back_pressure);
        s.only_triangles();
        s.push_some(20);
        s.finish();
      }
    }
    REQUIRE(s.count(SwapCode::ok) > 40);
    REQUIRE(s.account.refused == 0);
  });
}

CCHIP_CASE("spoilt bitstreams: code, slot at work or decoupled, valid bit gone, interrupt, then a good one") {
  const std::map<Spoilt, SwapCode> codes = {{Spoilt::magic, SwapCode::magic},
                                            {Spoilt::slot, SwapCode::slot},
                                            {Spoilt::module_id, SwapCode::module},
                                            {Spoilt::length, SwapCode::length},
                                            {Spoilt::crc, SwapCode::crc},
                                            {Spoilt::truncated, SwapCode::wrong_module},
                                            {Spoilt::too_long, SwapCode::wrong_module},
                                            {Spoilt::content, SwapCode::wrong_module},
                                            {Spoilt::other_module, SwapCode::wrong_module}};
  REQUIRE(codes.size() + 1 == static_cast<std::size_t>(Spoilt::last));
  with_wave([&](const sim::SimulationOptions& options) {
    System<TestType> s(options);
    for (const auto& [how, code] : codes) {
      for (int slot = 0; slot < TestType::SLOTS; ++slot) {
        INFO("spoilt " << static_cast<int>(how) << ", slot " << slot);
        s.write(regs::control::offset, 0);
        const int before = s.module_in(slot);
        const int module_id = before == 2 ? 3 : 2;
        s.push(before == 0 ? 1 : before);
        s.provide(slot, module_id, spoilt_bitstream(how, slot, module_id, 48, s.random(), TestType::KINDS));
        s.settle_bus();
        s.write(regs::interrupt_status::offset, 0x1F);
        const SwapReport r = s.swap(slot, module_id);
        REQUIRE(static_cast<int>(r.code) == static_cast<int>(code));
        REQUIRE(r.lost == 0);
        const bool at_work =
            code == SwapCode::magic || code == SwapCode::slot || code == SwapCode::module || code == SwapCode::length;
        s.steps(4);
        REQUIRE(s.decoupled(slot) == !at_work);
        REQUIRE(s.module_in(slot) == (at_work ? before : 0));
        REQUIRE(s.read(regs::bitstream_valid::offset(s.entry(slot, module_id))) == 0);
        REQUIRE((s.read(regs::interrupt_status::offset) & regs::interrupt_status::error_mask) != 0);
        REQUIRE(s.irq());
        const std::uint32_t report = s.read(regs::report::offset);
        REQUIRE((report & regs::report::code_mask) == static_cast<std::uint32_t>(code));
        REQUIRE((report & regs::report::slot_mask) >> regs::report::slot_shift == static_cast<std::uint32_t>(slot));
        REQUIRE((report & regs::report::module_id_mask) >> regs::report::module_id_shift ==
                static_cast<std::uint32_t>(module_id));
        REQUIRE(s.swap(slot, module_id).code == SwapCode::request);  // its bitstream is removed
        s.works();
      }
    }
  });
}

CCHIP_CASE("memory: an error, an address without memory, no answer") {
  with_wave([](const sim::SimulationOptions& options) {
    for (const int moment : {0, 1}) {  // in the header, in the payload
      for (const int what : {0, 1, 2}) {
        INFO("moment " << moment << ", fault " << what);
        System<TestType> s(options);
        const int before = s.module_in(0);
        s.provide(0, 2, s.good(0, 2, 400));
        s.push(1);
        if (what == 0) {
          s.memory.set_fault([moment, bursts = 0](std::vector<sim::AxiBeat>& burst) mutable {
            if (++bursts > 2 * moment) burst.back().response = sim::AxiResponse::slave_error;
          });
        } else if (what == 1) {
          s.memory.stop_after(moment == 0 ? 1 : 50);
        } else if (moment == 0) {
          s.settle_bus();
          s.write(regs::bitstream_address::offset(2), 0x100000);
        } else {
          continue;
        }
        const SwapReport r = s.swap(0, 2);
        REQUIRE(r.code == (what == 1 ? SwapCode::memory : SwapCode::bus));
        s.steps(4);
        if (moment == 0) REQUIRE(s.module_in(0) == before);
        if (moment == 1) REQUIRE(s.decoupled(0));
        s.works();  // late beats belong to no burst
      }
    }
  });
}

CCHIP_CASE("an abort while a slow memory brings the header: the bitstream stays, its pairs are tested") {
  with_wave([](const sim::SimulationOptions& options) {
    for (const std::uint64_t wait : {1, 20, 200}) {
      INFO("abort " << wait << " clocks after the beginning");
      System<TestType> s(options, true);
      s.only_triangles();
      sim::AxiMemoryOptions slow;
      slow.latency = 300;
      s.memory.set_options(slow);
      s.write(regs::memory_limit::offset, 1000);
      for (int i = 0; i < 6; ++i) s.push(2);
      s.simulation.run_until([&] { return s.phase() == SwapPhase::header; }, 5000, "the swap");
      s.steps(wait);
      s.write(regs::control::offset, regs::control::abort_mask | regs::control::scheduler_enable_mask);
      s.finish();
      REQUIRE(s.count(SwapCode::aborted) == 1);
      REQUIRE(s.account.pairs == 6);
      REQUIRE(s.account.refused == 0);
      REQUIRE(s.announced() == s.all_entries());
      s.works();
    }
  });
}

CCHIP_CASE("a read that comes too late costs time, not the bitstreams: header never read, entry kept") {
  with_wave([](const sim::SimulationOptions& options) {
    System<TestType> s(options, true);
    s.only_triangles();
    s.memory.stop_after(0);
    for (int i = 0; i < 6; ++i) s.push(2);
    for (int i = 0; i < 6; ++i) s.push(3);
    s.simulation.run_until([&] { return s.count(SwapCode::memory) == 1; }, 5000, "the end of the limit");
    s.steps(3000);
    REQUIRE(s.count(SwapCode::owed) >= 2);
    s.memory.resume();
    s.finish();
    REQUIRE(s.account.pairs == 12);
    REQUIRE(s.account.refused == 0);
    REQUIRE(s.announced() == s.all_entries());
    s.works();
  });
}

CCHIP_CASE("faults on the way leave the entry, the scheduler tries again, later and later, until one ends well") {
  with_wave([](const sim::SimulationOptions& options) {
    System<TestType> s(options, true);
    s.only_triangles();
    std::uint32_t entries = s.all_entries();
    for (int slot = 0; slot < TestType::SLOTS; ++slot) {  // one entry alone brings the kind
      for (const int module_id : {2, 3}) {
        if (slot == 0 && module_id == 2) continue;
        s.write(regs::bitstream_valid::offset(s.entry(slot, module_id)), 0);
        entries &= ~(1U << s.entry(slot, module_id));
      }
    }
    s.memory.set_fault([](std::vector<sim::AxiBeat>& burst) { burst.back().response = sim::AxiResponse::slave_error; });
    for (int i = 0; i < 6; ++i) s.push(2);
    const std::size_t before = s.reports.size();
    constexpr std::size_t attempts = defs::retry_doublings - 1;  // one more would take too long to simulate
    s.simulation.run_until([&] { return s.reports.size() == before + attempts; }, 200000, "seven attempts");
    for (std::size_t i = before; i < s.reports.size(); ++i) REQUIRE(s.reports[i].code == SwapCode::bus);
    for (std::size_t i = before + 1; i < s.reports.size(); ++i) {
      const std::uint64_t rest = s.reports[i].clock - s.reports[i - 1].clock;
      const std::uint64_t least = std::uint64_t{defs::retry_clocks}
                                  << std::min<std::size_t>(i - before - 1, defs::retry_doublings);
      CAPTURE(i, rest, least);
      REQUIRE(rest > least);
      REQUIRE(rest < least + 700);  // the rest, the age that starts again, a scan, the header
    }
    REQUIRE(s.announced() == entries);
    s.memory.set_fault({});
    s.finish();
    REQUIRE(s.account.refused == 0);
    s.works();
  });
}

CCHIP_CASE("after eight failures on the way its pairs are answered as open, until a swap ends well") {
  with_wave([](const sim::SimulationOptions& options) {
    System<TestType> s(options, true);
    s.only_triangles();
    for (int slot = 0; slot < TestType::SLOTS; ++slot) {  // one entry alone brings the kind
      for (const int module_id : {2, 3}) {
        if (slot != 0 || module_id != 2) s.write(regs::bitstream_valid::offset(s.entry(slot, module_id)), 0);
      }
    }
    s.memory.set_fault([](std::vector<sim::AxiBeat>& burst) { burst.back().response = sim::AxiResponse::slave_error; });
    for (int i = 0; i < 6; ++i) s.push(2);
    s.simulation.run_until([&] { return s.account.refused == 6; }, 300000, "six pairs answered as open");
    REQUIRE(s.count(SwapCode::bus) == defs::retry_doublings);
    REQUIRE(s.announced() != 0);  // the bitstream may be good
    // it is tried again: while its rest lasts new pairs are answered as open, then they wait for it
    s.memory.set_fault({});
    s.push(2);
    s.simulation.run_until([&] { return s.account.refused == 7; }, 1000, "a pair that does not wait");
    s.steps(std::uint64_t{defs::retry_clocks} << (defs::retry_doublings - 1));
    s.push(2);
    s.simulation.run_until([&] { return s.account.pairs == 8; }, 20000, "a pair that waits");
    REQUIRE(s.account.refused == 7);
    s.finish();
    s.works();
  });
}

CCHIP_CASE("an error of the device leaves the slot decoupled") {
  with_wave([](const sim::SimulationOptions& options) {
    System<TestType> s(options);
    s.command(0, 2, false);
    s.simulation.run_until([&] { return s.phase() == SwapPhase::transfer; }, 2000, "the transfer");
    s.steps(5);
    s.top().cfg_error = 1;
    s.step();
    s.top().cfg_error = 0;
    REQUIRE(s.next_report().code == SwapCode::device);
    s.steps(4);
    REQUIRE(s.decoupled(0));
    s.collect();
    s.works();
  });
}

CCHIP_CASE("busy, the same module again, no such slot or module") {
  with_wave([](const sim::SimulationOptions& options) {
    System<TestType> s(options);
    s.command(0, 2, false);
    s.simulation.run_until([&] { return s.phase() == SwapPhase::transfer; }, 2000, "the transfer");
    s.command(0, 3, false);
    const SwapReport busy = s.next_report();
    REQUIRE(busy.code == SwapCode::busy);
    REQUIRE(busy.module_id == 3);
    const SwapReport done = s.next_report();
    REQUIRE(done.code == SwapCode::ok);
    REQUIRE(done.module_id == 2);
    s.settle_bus();
    REQUIRE(s.swap(0, 2).code == SwapCode::same);
    REQUIRE(s.read(regs::bitstream_valid::offset(2)) == 1);
    REQUIRE(s.swap(TestType::SLOTS, 2).code == SwapCode::request);
    REQUIRE(s.swap(0, TestType::KINDS + 1).code == SwapCode::request);
    REQUIRE(s.read(regs::swaps::offset) == 1);
    s.works();
  });
}

CCHIP_CASE("abort in each phase: at work with the former module, decoupled, or too late") {
  with_wave([](const sim::SimulationOptions& options) {
    for (const SwapPhase phase : {SwapPhase::header, SwapPhase::shutdown, SwapPhase::decouple, SwapPhase::reset,
                                  SwapPhase::transfer, SwapPhase::check, SwapPhase::roc, SwapPhase::recouple}) {
      INFO("phase " << static_cast<int>(phase));
      System<TestType> s(options);
      s.push_some(4);
      s.steps(5);
      s.command(0, 2, false);
      // an abort takes some clocks through the bus: it is written so that it arrives in the phase asked for
      std::optional<SwapReport> report;
      for (int delay = 0; delay < 4000 && !report; ++delay) {
        const bool arrived = s.phase() == phase;
        if (arrived) {
          s.post_write(regs::control::offset, regs::control::abort_mask);
          report = s.next_report();
        } else {
          s.step();
        }
      }
      REQUIRE(report);
      REQUIRE((report->code == SwapCode::aborted || report->code == SwapCode::ok));
      if (phase <= SwapPhase::shutdown || phase == SwapPhase::transfer) REQUIRE(report->code == SwapCode::aborted);
      if (phase == SwapPhase::recouple) REQUIRE(report->code == SwapCode::ok);
      s.steps(10);
      s.collect();
      REQUIRE(s.module_in(0) == (report->code == SwapCode::ok ? 2 : s.decoupled(0) ? 0 : 1));
      if (report->code == SwapCode::aborted) {
        REQUIRE(s.read(regs::bitstream_valid::offset(2)) == 1);  // it has no defect
      }
      s.works();
    }
  });
}

CCHIP_CASE("a receiver that is gone does not stop a swap: the answers wait outside the slot") {
  with_wave([](const sim::SimulationOptions& options) {
    System<TestType> s(options);
    s.sink.set_pattern(sim::Pattern::never_for(~std::uint64_t{0}));
    for (int i = 0; i < 12; ++i) s.push(1);
    s.steps(2000);
    const SwapReport r = s.swap(0, 2);
    REQUIRE(r.code == SwapCode::ok);
    REQUIRE(r.lost == 0);
    s.works();
    REQUIRE(s.account.pairs == 12 + 3 * TestType::KINDS);
    REQUIRE(s.account.open == 0);
  });
}

CCHIP_CASE("pairs inside for longer than the limit: the slot continues, by force they are left open and reported") {
  with_wave([](const sim::SimulationOptions& options) {
    for (const bool force : {false, true}) {
      System<TestType> s(options);
      s.write(regs::shutdown_limit::offset, 5);
      std::uint64_t sent = 0;
      const auto send = [&] {
        KindRequest r = s.source.draw(1);
        r.request.mode = PairMode::exhaustive;
        s.push(r);
        ++sent;
      };
      for (int i = 0; i < 60; ++i) send();
      s.steps(100);
      const SwapReport r = s.swap(0, 2, force);
      REQUIRE(r.code == (force ? SwapCode::ok : SwapCode::shutdown));
      if (force) {
        REQUIRE(r.lost > 0);
        REQUIRE(s.read(regs::lost::offset) == r.lost);
        REQUIRE(s.read(regs::report_lost::offset) == r.lost);
        REQUIRE((s.read(regs::interrupt_status::offset) & regs::interrupt_status::lost_mask) != 0);
      } else {
        REQUIRE(r.lost == 0);
        REQUIRE(s.module_in(0) == 1);
        REQUIRE(s.read(regs::bitstream_valid::offset(2)) == 1);
      }
      s.write(regs::shutdown_limit::offset, 4000);
      s.works();
      REQUIRE(s.account.given_up == r.lost);
      REQUIRE(s.account.open == r.lost);
      REQUIRE(s.account.refused == 0);
      REQUIRE(s.account.pairs == sent + 3 * TestType::KINDS);
    }
  });
}

CCHIP_CASE("a test of quads answers for every kind") {
  with_wave([](const sim::SimulationOptions& options) {
    System<TestType> s(options);
    REQUIRE(s.swap(0, 3).code == SwapCode::ok);
    for (int slot = 1; slot < TestType::SLOTS; ++slot) REQUIRE(s.swap(slot, 0).code == SwapCode::ok);
    const std::size_t swaps = s.reports.size();
    s.write(regs::control::offset, regs::control::scheduler_enable_mask);
    for (int i = 0; i < 200; ++i) s.push(1 + i % 3);  // a test of points is another matter
    s.finish();
    REQUIRE(s.account.pairs == 200);
    REQUIRE(s.account.refused + s.account.open == 0);
    REQUIRE(s.reports.size() == swaps);  // no kind is without a slot
    REQUIRE(s.read(regs::pairs::offset(3)) == 200);
  });
}

CCHIP_CASE("blank slots asked to work: pairs wait for a bitstream, or are answered without a test and reported") {
  with_wave([](const sim::SimulationOptions& options) {
    System<TestType> s(options);
    for (int slot = 0; slot < TestType::SLOTS; ++slot) REQUIRE(s.swap(slot, 0).code == SwapCode::ok);
    REQUIRE(s.swap(0, 0).code == SwapCode::same);
    s.write(regs::interrupt_status::offset, 0x1F);
    s.push_some(10);
    s.steps(2000);
    REQUIRE(s.account.pairs == 0);  // the scheduler is off, bitstreams are loaded
    for (int slot = 0; slot < TestType::SLOTS; ++slot) {
      for (int m = 1; m <= TestType::KINDS; ++m) s.write(regs::bitstream_valid::offset(s.entry(slot, m)), 0);
    }
    s.finish();
    REQUIRE(s.account.pairs == 10);
    REQUIRE(s.account.refused > 0);
    REQUIRE(s.read(regs::pairs::offset(0)) == 10);
    REQUIRE((s.read(regs::interrupt_status::offset) & regs::interrupt_status::no_provider_mask) != 0);
    REQUIRE(s.irq());
    s.works();
  });
}

CCHIP_CASE("kinds that no bitstream serves are answered without a test, the others are tested") {
  with_wave([](const sim::SimulationOptions& options) {
    System<TestType> s(options, true);
    const auto announce = [&](std::uint32_t module_id, std::uint32_t valid) {
      for (int slot = 0; slot < TestType::SLOTS; ++slot)
        s.write(regs::bitstream_valid::offset(s.entry(slot, static_cast<int>(module_id))), valid);
    };
    announce(2, 0);
    announce(3, 0);
    s.push_some(100);
    s.finish();
    REQUIRE(s.account.refused > 20);
    REQUIRE(s.read(regs::pairs::offset(2)) == 0);
    REQUIRE(s.read(regs::pairs::offset(3)) == 0);
    REQUIRE(s.read(regs::pairs::offset(1)) > 10);
    REQUIRE((s.read(regs::interrupt_status::offset) & regs::interrupt_status::no_provider_mask) != 0);
    announce(3, 1);  // the test of quads serves kind 2 as well
    const std::uint64_t refused = s.account.refused;
    for (int i = 0; i < 20; ++i) s.push(2);
    s.finish();
    REQUIRE(s.account.refused == refused);
    REQUIRE(s.read(regs::pairs::offset(3)) == 20);
    s.works();
  });
}

CCHIP_CASE("a full queue is enough for a swap, however large the batch and the age that are asked for") {
  with_wave([](const sim::SimulationOptions& options) {
    System<TestType> s(options);
    s.only_triangles();
    s.write(regs::minimum_batch::offset, TestType::QUEUE_DEPTH + 1);
    s.write(regs::maximum_age::offset, 0x7FFFFFFF);
    s.write(regs::control::offset, regs::control::scheduler_enable_mask);
    const std::size_t swaps = s.count(SwapCode::ok);
    for (int i = 0; i < TestType::QUEUE_DEPTH - 1; ++i) s.push(2);
    s.steps(5000);
    REQUIRE(s.driver.waiting() == 0);
    REQUIRE(s.account.pairs == 0);  // one pair less than full: neither enough nor old
    REQUIRE(s.count(SwapCode::ok) == swaps);
    for (int i = 0; i < 10; ++i) s.push(2);
    s.finish(100000);
    REQUIRE(s.count(SwapCode::ok) == swaps + 1);
    REQUIRE(s.account.pairs == TestType::QUEUE_DEPTH + 9);
    REQUIRE(s.account.refused == 0);
  });
}

CCHIP_CASE("transfer takes eq. (4) and a fixed number of clocks") {
  with_wave([](const sim::SimulationOptions& options) {
    System<TestType> s(options);
    std::set<std::uint64_t> extra;
    for (const std::size_t bytes : {16U, 64U, 100U, 1024U, 3000U}) {
      const int module_id = s.module_in(0) == 2 ? 1 : 2;
      s.provide(0, module_id, s.good(0, module_id, bytes));
      s.settle_bus();
      REQUIRE(s.swap(0, module_id).code == SwapCode::ok);
      const std::uint64_t clocks =
          s.read(regs::phase_clocks::offset(static_cast<std::uint32_t>(SwapPhase::transfer) - 1));
      const std::uint64_t eq4 = transfer_clocks(bytes, TestType::CFG_W, TestType::CFG_DIVIDER);
      CAPTURE(bytes, clocks, eq4);
      REQUIRE(clocks >= eq4);
      extra.insert(clocks - eq4);
    }
    REQUIRE(extra.size() == 1);
    REQUIRE(*extra.begin() < 64);
    REQUIRE(s.read(regs::stalls::offset) == 0);
  });
}

CCHIP_CASE("reset at every clock of a swap") {
  with_wave([](const sim::SimulationOptions& options) {
    System<TestType> s(options);
    std::uint64_t length = 1;  // of a swap, clocks
    int cut_off = 0;           // resets that left the slot decoupled
    for (std::uint64_t moment = 0; moment <= length; ++moment) {
      INFO("clock " << moment << " of " << length);
      s.write(regs::control::offset, 0);
      const int module_id = s.module_in(0) == 3 ? 2 : 3;
      s.push_some(3);
      s.provide(0, module_id, s.good(0, module_id, 16));
      s.settle_bus();
      s.command(0, module_id, false);
      s.simulation.run_until([&] { return s.phase() != SwapPhase::idle; }, 100, "the swap");
      if (moment == 0) {
        const std::uint64_t start = s.simulation.clock();
        s.next_report();
        length = s.simulation.clock() - start + 40;  // pairs inside may take longer another time
      } else {
        s.steps(moment);
      }
      s.reset(moment % 3 == 0 ? 1 : 2);
      s.steps(20);
      cut_off += s.decoupled(0) ? 1 : 0;
      REQUIRE(s.phase() == SwapPhase::idle);
      s.works();
    }
    REQUIRE(length > 60);
    REQUIRE(cut_off > 10);
  });
}

CCHIP_CASE("a slot exchanges all its modules, each for each other, and every kind is tested") {
  with_wave([](const sim::SimulationOptions& options) {
    System<TestType> s(options);
    for (int from = 0; from <= TestType::KINDS; ++from) {
      for (int to = 0; to <= TestType::KINDS; ++to) {
        if (from == to) continue;
        if (s.module_in(0) != from) REQUIRE(s.swap(0, from).code == SwapCode::ok);
        REQUIRE(s.swap(0, to).code == SwapCode::ok);
        if (to == 0) continue;
        std::uint64_t pushed = s.account.pairs;
        for (int kind = 1; kind <= TestType::KINDS; ++kind) {
          for (int i = 0; i < 4 && defs::rm_serves(to, kind) != 0; ++i, ++pushed) s.push(kind);
        }
        s.finish();
        REQUIRE(s.account.pairs == pushed);
        REQUIRE(s.account.refused + s.account.open == 0);
      }
    }
    s.works();
  });
}

TEST_CASE("cchip_primtest_subsystem: triangles and points share a slot, by batches, and neither waits for ever",
          "[unit][cchip_primtest_subsystem]") {
  with_wave([](const sim::SimulationOptions& options) {
    System<OneSlotPoints> s(options, true);
    constexpr std::uint32_t age = 3000;
    s.write(regs::minimum_batch::offset, 1);
    s.write(regs::maximum_age::offset, age);
    s.only_triangles();
    // as many of both: a kind goes only when no more of it wait, so every swap is worth a queue of pairs
    const std::size_t before = s.reports.size();
    std::uint64_t pushed = 0;
    for (; pushed < 1000; ++pushed) s.push(pushed % 2 == 0 ? 1 : 4);
    s.finish();
    const std::size_t swaps = s.reports.size() - before;
    REQUIRE(swaps >= 4);
    REQUIRE(pushed / swaps >= 16);
    for (std::size_t i = before; i < s.reports.size(); ++i) REQUIRE(s.reports[i].code == SwapCode::ok);
    // triangles without end and one point: it gets the slot after its age, and they get it back
    if (s.module_in(0) != 1) REQUIRE(s.swap(0, 1).code == SwapCode::ok);
    s.write(regs::minimum_batch::offset, 1);
    s.push(4);
    ++pushed;
    const std::uint64_t start = s.simulation.total_clocks();
    const std::size_t then = s.reports.size();
    while (s.simulation.total_clocks() < start + 3 * age && s.reports.size() < then + 2) {
      for (; s.driver.waiting() < 4; ++pushed) s.push(1);
      s.step();
      if (s.simulation.total_clocks() < start + age) REQUIRE(s.module_in(0) == 1);
    }
    REQUIRE(s.reports.size() == then + 2);
    REQUIRE(s.reports[then].module_id == 4);
    REQUIRE(s.reports[then + 1].module_id == 1);
    REQUIRE(s.reports[then + 1].clock - s.reports[then].clock < 1500);  // the point was the only one
    s.finish();
    REQUIRE(s.account.refused + s.account.open == 0);
    REQUIRE(s.account.pairs == pushed);
    REQUIRE(s.read(regs::pairs::offset(1)) + s.read(regs::pairs::offset(4)) == pushed);
  });
}
