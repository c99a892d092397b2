// SPDX-License-Identifier: Apache-2.0
// The chip through its registers: their values, events and interrupt, counters, invalidation, soft reset.
#include <Vcchip_chip_swaps1.h>

#include <cchip/internal/wire/chip_registers.hpp>
#include <map>
#include <models/cchip_chip.hpp>

#include "bench.hpp"
#include "chip_objects.hpp"
#include "port_bench.hpp"
#include "reported.hpp"

using namespace cchip;
using namespace cchip::test;
using cchip::testing::compare_answer;
using cchip::testing::Objects;
using cchip::testing::queries_of;
using cchip::testing::wild;
namespace regs = cchip::chip_registers;

namespace {

using Model = chip_small::Model;
using SmallChip = sim::ChipMachine<Model, chip_small::DATA_W>;
using Bench = cchip::testing::PortBench<Model, chip_small::DATA_W>;

constexpr std::uint64_t most_clocks = 3000000;

/// Offset, value after reset, bits that can be written.
struct Register {
  std::uint32_t offset, reset, writable;
};
// As docs/hardware/chip-registers.md lists them, without those that a write makes work.
const std::vector<Register> plain = {
    {0x024, 0, 0x1FF},      {0x030, 0xFFFFFFFF, 0xFFFFFFFF}, {0x034, 0, 0xFFFFFFFF}, {0x038, 16, 0xFF},
    {0x03C, 3, 0x7},        {0x040, 0, 0xFFFFFFC0},          {0x044, 0, 0xFFFFFFFF}, {0x048, 0, 0xF},
    {0x04C, 0, 0xFFFF},     {0x060, 0, 0xFFFFFFF0},          {0x064, 0, 0xFFFFFFFF}, {0x068, 0, 0x1F},
    {0x06C, 0, 0xFFFFFFFF}, {0x080, 1, 0xFFFFFFFF},          {0x084, 0, 0xFFFFFFFF}, {0x088, 1, 0xFFFFFFFF},
    {0x08C, 0, 0xFFFFFFFF}, {0x090, 1, 0xFFFFFFFF},          {0x094, 0, 0xFFFFFFFF}, {0x098, 1, 0xFFFFFFFF},
    {0x09C, 0, 0xFFFFFFFF}, {0x0A0, 0, 0xFFFFFFFF},          {0x0A4, 0, 0xFFFFFFFF},
};

ChipDriverOptions small_rings() {
  ChipDriverOptions options;
  options.memory_base = std::uint64_t{1} << 36U;  // addresses of more than 32 bits
  options.memory_bytes = 1 << 24;
  options.query_log2 = 3;
  options.record_log2 = 5;
  options.patience = 40000;
  options.reset_patience = 10000;
  return options;
}

struct Setup {
  explicit Setup(const sim::SimulationOptions& options, const sim::AxiLinesOptions& memory = wild())
      : random(options.seed), objects(Kind::quad), bench(endless(options), memory, small_rings(), 1) {
    objects.place(bench);
  }
  static sim::SimulationOptions endless(sim::SimulationOptions options) {
    options.timeout_clocks = 0;
    return options;
  }

  /// Queries that get right answers.
  void check(std::size_t count) {
    const std::size_t from = bench.queries().size();
    for (const Query& query : queries_of(objects, random, count)) bench.submit(query);
    REQUIRE(bench.run(most_clocks));
    REQUIRE(bench.wrong() == std::vector<std::string>());
    for (std::size_t i = from; i < bench.queries().size(); ++i) {
      const Query& query = bench.queries()[i];
      CAPTURE(i);
      REQUIRE(compare_answer(query, bench.answers()[i], objects.expected(query), 16).empty());
    }
  }
  /// The host sees a record as soon as memory has it; the chip knows a little later.
  void settle() {
    while ((status() & regs::status::idle_mask) == 0) bench.machine().proceed();
  }
  std::uint32_t read(std::uint32_t offset) { return bench.machine().read_register(offset); }
  void write(std::uint32_t offset, std::uint32_t value) { bench.machine().write_register(offset, value); }
  std::uint32_t status() { return read(regs::status::offset); }

  Random random;
  Objects objects;
  Bench bench;
};

template <class Body>
void for_two_power_ups_of_setup(Body&& body, const sim::AxiLinesOptions& memory = wild()) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    Setup setup(options, memory);
    body(setup);
  });
}

}  // namespace

TEST_CASE("cchip_chip: registers after reset, what can be written, what is refused", "[unit][cchip_chip]") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    SmallChip machine(options);
    Random random(options.seed);
    CHECK(machine.read_register(0x000) == 0x43484343);  // CCHC
    CHECK(machine.read_register(0x004) == 0x200);
    CHECK(machine.read_register(0x008) == (1U << 28 | 1U << 24 | 0U << 16 | 7U << 8 | 16U));
    CHECK(machine.read_register(0x00C) == (16U << 24 | 4U << 8 | 4U));
    CHECK(machine.read_register(0x010) == 0);
    CHECK(machine.read_register(0x050) == 0);
    CHECK(machine.read_register(0x070) == 0);
    std::map<std::uint32_t, std::uint32_t> now;
    for (const Register& r : plain) {
      CAPTURE(r.offset);
      CHECK(machine.read_register(r.offset) == r.reset);
      now[r.offset] = r.reset;
    }
    for (int i = 0; i < 200; ++i) {
      const Register& r = plain[random() % plain.size()];
      const auto value = static_cast<std::uint32_t>(random());
      machine.write_register(r.offset, value);
      now[r.offset] = value & r.writable;
      const Register& other = plain[random() % plain.size()];
      CAPTURE(r.offset, other.offset);
      REQUIRE(machine.read_register(other.offset) == now[other.offset]);
    }
    for (const Register& r : plain) REQUIRE(machine.read_register(r.offset) == now[r.offset]);
    for (const std::uint32_t offset :
         {0x000U, 0x004U, 0x008U, 0x00CU, 0x014U, 0x050U, 0x070U, 0x100U, 0x140U, 0x154U}) {
      CAPTURE(offset);
      REQUIRE_THROWS_WITH(machine.write_register(offset, 1), Catch::Contains("refuses a write"));
    }
    for (const std::uint32_t offset :
         {0x01CU, 0x028U, 0x054U, 0x058U, 0x074U, 0x0ACU, 0x0FCU, 0x158U, 0x200U, 0xFFCU}) {
      CAPTURE(offset);
      REQUIRE_THROWS_WITH(machine.read_register(offset), Catch::Contains("refuses a read"));
      REQUIRE_THROWS_WITH(machine.write_register(offset, 1), Catch::Contains("refuses a write"));
    }
    machine.reset();
    for (const Register& r : plain) REQUIRE(machine.read_register(r.offset) == r.reset);
  });
}

TEST_CASE("cchip_chip: an invalidation that ended is one that was asked for", "[unit][cchip_chip]") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    SmallChip machine(options);
    const auto wait = [&machine] {  // the cache clears itself after a reset
      while ((machine.read_register(regs::status::offset) & regs::status::invalidating_mask) != 0) machine.proceed();
      for (int i = 0; i < 50; ++i) machine.proceed();
    };
    const auto invalidated = [&machine] {
      return (machine.read_register(regs::interrupt_status::offset) & regs::interrupt_status::invalidated_mask) != 0;
    };
    const auto clear = [&machine] { machine.write_register(regs::interrupt_status::offset, 0x1F); };
    for (int round = 0; round < 3; ++round) {
      wait();
      CHECK_FALSE(invalidated());
      machine.write_register(regs::invalidate::offset, regs::invalidate::go_mask);
      wait();
      CHECK(invalidated());
      clear();
      if (round == 0) machine.write_register(regs::control::offset, regs::control::soft_reset_mask);
      if (round == 1) machine.reset();
    }
  });
}

TEST_CASE("cchip_chip: counters are what was submitted and answered", "[unit][cchip_chip]") {
  for_two_power_ups_of_setup([](Setup& s) {
    s.write(regs::control::offset, regs::control::clear_mask | regs::control::enable_mask);
    const std::uint64_t beats = s.bench.machine().memory().read_beats();
    s.check(40);
    s.settle();
    std::uint64_t records = 0, steps = 0;
    for (const auto& answer : s.bench.answers()) {
      records += answer.pairs.size() + 1;
      steps += answer.done->steps;
    }
    CHECK(s.read(regs::counter_queries::offset) == 40);
    CHECK(s.read(regs::counter_errors::offset) == 0);
    CHECK(s.read(regs::counter_records::offset) == records);
    CHECK(s.read(regs::counter_records::offset) == s.read(regs::record_producer::offset));
    CHECK(s.read(regs::query_consumer::offset) == 40);
    CHECK(s.bench.counter(regs::counter_node_pairs::offset) >= steps);  // those of leaf pairs that came too late, too
    CHECK(s.bench.counter(regs::counter_primitive_pairs::offset) > records - 40);
    CHECK(s.read(regs::counter_leaf_pairs::offset) > 0);
    CHECK(s.read(regs::counter_record_waits::offset) > 0);  // the ring has 32 records
    const std::uint64_t reads = (s.bench.machine().memory().read_beats() - beats) / (64 / (chip_small::DATA_W / 8));
    CHECK(s.read(regs::counter_reads::offset) == reads);
    // the cache answers what it holds and reads the rest; besides it only the 40 queries are read
    const std::uint64_t misses =
        s.bench.counter(regs::counter_misses_a::offset) + s.bench.counter(regs::counter_misses_b::offset);
    CHECK(misses == reads - 40);
    CHECK(s.bench.counter(regs::counter_hits_a::offset) > 0);
    CHECK(s.bench.counter(regs::counter_hits_b::offset) > 0);
    const std::uint64_t busy = s.bench.counter(regs::counter_box_busy::offset);
    const std::uint64_t clocks = s.bench.counter(regs::counter_clocks::offset);
    CHECK(busy > steps);
    CHECK(busy < clocks);
    const std::uint64_t before = s.bench.clocks();
    s.bench.machine().simulation().steps(1000);
    const std::uint64_t later = s.bench.counter(regs::counter_clocks::offset);
    CHECK(later - clocks >= 1000);
    CHECK(later - clocks <= s.bench.clocks() - before + 30);
    s.write(regs::control::offset, regs::control::clear_mask);
    CHECK(s.bench.counter(regs::counter_clocks::offset) < 100);
    CHECK(s.read(regs::counter_queries::offset) == 0);
    CHECK(s.bench.counter(regs::counter_node_pairs::offset) == 0);
  });
}

TEST_CASE("cchip_chip: drain, idle", "[unit][cchip_chip]") {
  for_two_power_ups_of_setup([](Setup& s) {
    for (int run = 0; run < 20; ++run) {
      for (const Query& query : queries_of(s.objects, s.random, 12)) s.bench.submit(query);
      const std::uint64_t until = s.random() % 3000;
      for (std::uint64_t i = 0; i < until; ++i) REQUIRE(s.bench.step());
      s.write(regs::control::offset, 0);
      // the host takes records, so all queries that were read end
      for (int i = 0; (s.status() & regs::status::idle_mask) == 0; ++i) {
        REQUIRE(i < 100000);
        REQUIRE(s.bench.step());
      }
      const std::uint32_t producer = s.read(regs::record_producer::offset);
      for (int i = 0; i < 300; ++i) REQUIRE(s.bench.step());
      CHECK(s.read(regs::record_producer::offset) == producer);
      CHECK(s.read(regs::query_consumer::offset) + s.bench.unanswered() == s.bench.queries().size());
      CHECK((s.status() & regs::status::idle_mask) != 0);
      s.write(regs::control::offset, regs::control::enable_mask);
      REQUIRE(s.bench.run(most_clocks));
    }
    s.check(10);
  });
}

TEST_CASE("cchip_chip: events, interrupt", "[unit][cchip_chip]") {
  for_two_power_ups_of_setup([](Setup& s) {
    constexpr std::uint32_t all = 0x1F;
    const auto clear = [&s] { s.write(regs::interrupt_status::offset, all); };
    const auto events = [&s] { return s.read(regs::interrupt_status::offset); };
    const auto line = [&s] { return s.bench.machine().interrupt(); };
    // the driver's reset and its invalidations
    CHECK((events() & regs::interrupt_status::reset_done_mask) != 0);
    CHECK((events() & regs::interrupt_status::invalidated_mask) != 0);
    clear();
    CHECK(events() == 0);
    CHECK_FALSE(line());
    s.check(1);
    s.settle();
    CHECK(events() == regs::interrupt_status::record_mask);
    CHECK_FALSE(line());
    s.write(regs::interrupt_enable::offset, regs::interrupt_enable::record_mask);
    CHECK(line());
    clear();
    CHECK_FALSE(line());
    s.write(regs::interrupt_enable::offset, all & ~regs::interrupt_enable::record_mask);
    s.check(1);
    s.settle();
    CHECK_FALSE(line());
    clear();

    s.write(regs::invalidate::offset, regs::invalidate::go_mask);
    while ((s.status() & regs::status::invalidating_mask) != 0) s.bench.machine().proceed();
    CHECK(events() == regs::interrupt_status::invalidated_mask);
    CHECK(line());
    clear();

    // a query that cannot be read: its ring stops, what came before is answered, a soft reset helps
    const std::uint64_t bad = small_rings().memory_base / 64 + (s.read(regs::query_consumer::offset) & 7U);
    s.bench.machine().memory().read_fault = [bad](std::uint64_t number) {
      return number == bad ? sim::AxiFault::slave_error : sim::AxiFault::none;
    };
    s.bench.submit(s.objects.query(s.random));
    CHECK_FALSE(s.bench.run(most_clocks));
    CHECK(events() == regs::interrupt_status::query_failed_mask);
    CHECK((s.status() & regs::status::query_failed_mask) != 0);
    CHECK(line());
    clear();
    s.bench.machine().memory().read_fault = [](std::uint64_t) { return sim::AxiFault::none; };
    REQUIRE(s.bench.recover());
    CHECK((s.status() & regs::status::query_failed_mask) == 0);
    CHECK((events() & regs::interrupt_status::reset_done_mask) != 0);
    s.check(5);
    s.settle();
    clear();

    // a record that cannot be written
    s.bench.machine().memory().write_fault = [](std::uint64_t) { return sim::AxiFault::slave_error; };
    s.bench.submit(s.objects.query(s.random));
    CHECK_FALSE(s.bench.run(most_clocks));
    CHECK(events() == regs::interrupt_status::record_failed_mask);
    CHECK((s.status() & regs::status::record_failed_mask) != 0);
    s.bench.machine().memory().write_fault = [](std::uint64_t) { return sim::AxiFault::none; };
    REQUIRE(s.bench.recover());
    s.check(5);
  });
}

TEST_CASE("cchip_chip: a soft reset at any clock leaves nothing of before", "[unit][cchip_chip]") {
  for_two_power_ups_of_setup([](Setup& s) {
    for (int run = 0; run < 40; ++run) {
      for (const Query& query : queries_of(s.objects, s.random, 12)) s.bench.submit(query);
      const std::uint64_t clocks = s.random() % (run % 2 == 0 ? 3000 : 60);
      for (std::uint64_t i = 0; i < clocks; ++i) REQUIRE(s.bench.step());
      REQUIRE(s.bench.recover());
      REQUIRE((s.status() & regs::status::resetting_mask) == 0);
      if (run % 4 == 0) REQUIRE(s.bench.recover());
      s.check(3);
    }
  });
}

TEST_CASE("cchip_chip: a soft reset waits for memory, however long that takes", "[unit][cchip_chip]") {
  for_two_power_ups_of_setup([](Setup& s) {
    auto& memory = s.bench.machine().memory();
    for (const bool reads : {true, false}) {
      CAPTURE(reads);
      int lost = 0;
      const auto once = [&lost](std::uint64_t) { return lost++ == 0 ? sim::AxiFault::silence : sim::AxiFault::none; };
      (reads ? memory.read_fault : memory.write_fault) = once;
      s.bench.submit(s.objects.query(s.random));
      while (lost == 0) REQUIRE(s.bench.step());
      (reads ? memory.read_fault : memory.write_fault) = [](std::uint64_t) { return sim::AxiFault::none; };
      s.write(regs::control::offset, regs::control::soft_reset_mask | regs::control::enable_mask);
      s.bench.machine().simulation().steps(20000);
      const std::uint32_t owed = reads ? regs::status::read_outstanding_mask : regs::status::write_outstanding_mask;
      CHECK((s.status() & regs::status::resetting_mask) != 0);
      CHECK((s.status() & owed) != 0);
      // these stay 0 meanwhile in spite of writes
      s.write(regs::control::offset, regs::control::enable_mask);
      s.write(regs::query_producer::offset, 5);
      s.write(regs::record_consumer::offset, 5);
      CHECK(s.read(regs::control::offset) == 0);
      CHECK(s.read(regs::query_producer::offset) == 0);
      CHECK(s.read(regs::record_consumer::offset) == 0);
      CHECK_FALSE(s.bench.recover());  // it does not end, and the driver says so
      // the remedy: chip and bus
      s.bench.machine().reset();
      REQUIRE(s.bench.recover());
      s.check(5);
    }
  });
}

TEST_CASE("cchip_chip: lines that changed in memory are read anew after an invalidation", "[unit][cchip_chip]") {
  for_two_power_ups_of_setup([](Setup& s) {
    s.check(5);
    // other objects in the same lines
    const Objects others(Kind::tri);
    s.bench.port().store(static_cast<std::uint32_t>(s.objects.line_a), others.b.lines);
    s.bench.port().store(static_cast<std::uint32_t>(s.objects.line_a + others.b.lines.size()), others.a.lines);
    const std::uint64_t line_b = s.objects.line_a;
    const std::uint64_t line_a = s.objects.line_a + others.b.lines.size();
    s.objects.a = others.a;
    s.objects.b = others.b;
    s.objects.line_a = line_a;
    s.objects.line_b = line_b;
    s.check(10);
  });
}

TEST_CASE("chip driver: what it refuses", "[unit][chip_driver]") {
  const auto open = [](const ChipDriverOptions& options) {
    return open_chip(std::make_unique<SmallChip>(sim::SimulationOptions{}), options);
  };
  ChipDriverOptions options = small_rings();
  options.memory_base = 32;
  CHECK_THROWS_WITH(open(options), "chip driver: memory_base is no multiple of 64");
  options = small_rings();
  options.memory_bytes = 1000;
  CHECK_THROWS_WITH(open(options), Catch::Contains("memory of 1000 bytes is too small: the rings take 1024"));
  options = small_rings();
  options.memory_bytes = std::uint64_t{1} << 38U;
  CHECK_THROWS_WITH(open(options), Catch::Contains("does not end below 2^38"));
  options = small_rings();
  options.query_log2 = 16;
  CHECK_THROWS_WITH(open(options), Catch::Contains("query_log2 is 16, 0..15 are legal"));
  options = small_rings();
  options.record_log2 = 29;
  CHECK_THROWS_WITH(open(options), Catch::Contains("record_log2 is 29, 0..28 are legal"));
  CHECK_THROWS_WITH(open_chip(nullptr), Catch::Contains("no machine"));
  const auto port = open(small_rings());
  CHECK(port->capabilities().quads);
  CHECK(port->capabilities().lock_ranges == 1);
  CHECK(port->capabilities().queries_in_flight == 8);
  CHECK_THROWS_WITH(port->lock(1, 1, 2), Catch::Contains("no lock range 1"));
}

namespace {

/// The rules that are broken when memory sets these pins on one clock, with nothing in flight.
template <class Chip>
std::set<std::string> reported_of(const std::function<void(Chip&)>& fault) {
  sim::ChipMachine<Chip, 128> machine(sim::without_timeout(sim::seed_from_environment()));
  cchip::test::Bench wrong(
      [&](const sim::ClockInfo& now) {
        if (now.clock == 20) fault(machine.simulation().top());
      },
      [](const sim::ClockInfo&) {});
  machine.simulation().add(wrong);
  return reported([&] { machine.simulation().steps(30); });
}

}  // namespace

TEST_CASE("cchip_chip: a fault of memory on either bus is reported by the rules beside it", "[unit][cchip_chip]") {
  using Names = std::set<std::string>;
  using Swaps = Vcchip_chip_swaps1;
  CHECK(reported_of<Model>([](Model&) {}) == Names{});
  CHECK(reported_of<Model>([](Model& top) { top.m_axi_rvalid = 1; }) == Names{"u_axi_rules.m_r_owed"});
  CHECK(reported_of<Model>([](Model& top) { top.m_axi_bvalid = 1; }) == Names{"u_axi_rules.m_b_owed"});
  CHECK(reported_of<Swaps>([](Swaps&) {}) == Names{});
  CHECK(reported_of<Swaps>([](Swaps& top) { top.m_axi_rvalid = 1; }) == Names{"u_axi_rules.m_r_owed"});
  CHECK(reported_of<Swaps>([](Swaps& top) { top.m_axi_cfg_rvalid = 1; }) == Names{"u_axi_cfg_rules.m_r_owed"});
}
