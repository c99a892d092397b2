// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cchip/internal/wire/registers.hpp>
#include <cchip/sim/axi_lite.hpp>
#include <map>
#include <models/cchip_subsystem_regs.hpp>
#include <set>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

using Model = cchip_subsystem_regs::Model;
using Master = sim::AxiLiteMaster<Model>;

/// Inputs from hardware, all random; events and clears 0.
void scramble(Model& top, Random& random) {
  sim::set_random(top.hwif_in_capabilities_coord_w, 8, random);
  sim::set_random(top.hwif_in_capabilities_cfg_w, 8, random);
  sim::set_random(top.hwif_in_capabilities_slots, 8, random);
  sim::set_random(top.hwif_in_capabilities_kinds, 3, random);
  sim::set_random(top.hwif_in_queue_depth_pairs, 32, random);
  sim::set_random(top.hwif_in_report_module_id, 8, random);
  sim::set_random(top.hwif_in_report_slot, 8, random);
  sim::set_random(top.hwif_in_report_code, 4, random);
  sim::set_random(top.hwif_in_report_lost_pairs, 16, random);
  sim::set_random(top.hwif_in_slot_status_outstanding, 64, random);
  sim::set_random(top.hwif_in_slot_status_decoupled, 4, random);
  sim::set_random(top.hwif_in_slot_status_phase, 16, random);
  sim::set_random(top.hwif_in_slot_status_module_id, 32, random);
  sim::set_random(top.hwif_in_lost_value, 32, random);
  top.hwif_in_interrupt_status_done_hwset = 0;
  top.hwif_in_interrupt_status_error_hwset = 0;
  top.hwif_in_interrupt_status_lost_hwset = 0;
  top.hwif_in_interrupt_status_no_provider_hwset = 0;
  top.hwif_in_interrupt_status_illegal_kind_hwset = 0;
}

/// External registers: one memory of words; reads are answered after any delay, also none.
class External : public sim::Agent {
 public:
  External(Model& model, Random& random) : model_(model), random_(random) {
    for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(random_());
    model_.hwif_in_external_ack = 0;
    model_.hwif_in_external_rdata = 0;
  }
  void drive(const sim::ClockInfo& now) override {
    const bool request = model_.hwif_out_swaps_read != 0 || model_.hwif_out_rejected_read != 0 ||
                         model_.hwif_out_stalls_read != 0 || model_.hwif_out_phase_clocks_read != 0 ||
                         model_.hwif_out_pairs_read != 0 || model_.hwif_out_bitstream_read != 0;
    if (now.in_reset) {
      wait_ = -1;
    } else if (request) {
      sim::require(wait_ < 0, "a read before the answer of the one before");
      wait_ = chance(random_, 50) ? 0 : static_cast<int>(random_() % 20);
    }
    const bool ack = wait_ == 0;
    model_.hwif_in_external_ack = ack ? 1 : 0;
    model_.hwif_in_external_rdata = ack ? words[model_.hwif_out_external_raddr] : 0;
    if (wait_ >= 0) --wait_;
  }
  void sample(const sim::ClockInfo& now) override {
    if (now.in_reset || model_.hwif_out_bitstream_write == 0) return;
    std::uint32_t& word = words[model_.hwif_out_external_waddr];
    for (unsigned lane = 0; lane < 4; ++lane) {
      const std::uint32_t mask = (model_.hwif_out_external_wstrb >> lane & 1U) != 0 ? 0xFFU << 8 * lane : 0;
      word = (word & ~mask) | (model_.hwif_out_external_wdata & mask);
    }
  }
  std::array<std::uint32_t, 1024> words{};  ///< by word address

 private:
  Model& model_;
  Random& random_;
  int wait_ = -1;  ///< clocks until the answer, < 0: no read
};

template <class Body>
void run(const sim::SimulationOptions& options, Random& random, const sim::AxiLitePatterns& patterns, Body& body) {
  sim::Simulation<Model> simulation(options);
  Master master(simulation.top(), patterns);
  External external(simulation.top(), random);
  simulation.add(master);
  simulation.add(external);
  scramble(simulation.top(), random);
  simulation.reset();
  body(simulation, master, random, external);
}

template <class Body>
void with_registers(Body body) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    Random random(options.seed);
    run(options, random, {}, body);
  });
}

/// The same 20 times, with any delays on each channel of the bus.
template <class Body>
void with_any_delays(Body body) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    Random random(options.seed);
    const auto pattern = [&] { return sim::standard_patterns(random())[random() % 7]; };
    for (int round = 0; round < 20; ++round) {
      run(options, random, {pattern(), pattern(), pattern(), pattern(), pattern()}, body);
    }
  });
}

/// Registers that software writes and reads back: offset, bits that exist, value after reset.
std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> plain_registers() {
  namespace r = registers;
  std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> found = {
      {r::control::offset, {1, 0}},
      {r::command::offset, {0x1FFFF, 0}},
      {r::interrupt_enable::offset, {0x1F, 0}},
      {r::shutdown_limit::offset, {~0U, 0}},
      {r::memory_limit::offset, {~0U, 0}},
      {r::minimum_batch::offset, {~0U, r::minimum_batch::pairs_reset}},
      {r::maximum_age::offset, {~0U, r::maximum_age::clocks_reset}}};
  return found;
}

}  // namespace

TEST_CASE("cchip_subsystem_regs: what software writes it reads back, byte by byte, with any delays",
          "[unit][cchip_subsystem_regs]") {
  with_any_delays([](auto& simulation, Master& master, Random& random, External& external) {
    auto expected = plain_registers();
    for (std::uint32_t i = 0; i < registers::bitstream_address::count; ++i) {
      for (const std::uint32_t offset : {registers::bitstream_address::offset(i), registers::bitstream_size::offset(i),
                                         registers::bitstream_valid::offset(i)}) {
        expected[offset] = {~0U, external.words[offset / 4]};
      }
    }
    for (const auto& [offset, bits] : expected) {
      const sim::AxiLiteWord word = master.read(simulation, offset);
      REQUIRE(word.ok);
      REQUIRE(word.data == bits.second);
    }
    for (int i = 0; i < 100; ++i) {
      auto entry = expected.begin();
      std::advance(entry, static_cast<std::ptrdiff_t>(random() % expected.size()));
      const auto data = static_cast<std::uint32_t>(random());
      const auto lanes = static_cast<unsigned>(random() % 16);
      REQUIRE(master.write(simulation, entry->first, data, lanes));
      for (unsigned lane = 0; lane < 4; ++lane) {
        const std::uint32_t mask = (lanes >> lane & 1U) != 0 ? 0xFFU << 8 * lane & entry->second.first : 0;
        entry->second.second = (entry->second.second & ~mask) | (data & mask);
      }
      entry = expected.begin();
      std::advance(entry, static_cast<std::ptrdiff_t>(random() % expected.size()));
      REQUIRE(master.read(simulation, entry->first).data == entry->second.second);
    }
    for (const auto& [offset, bits] : expected) REQUIRE(master.read(simulation, offset).data == bits.second);
    const Model& top = simulation.top();
    namespace r = registers;
    REQUIRE(top.hwif_out_maximum_age_clocks == expected[r::maximum_age::offset].second);
    REQUIRE(top.hwif_out_command_module_id ==
            (expected[r::command::offset].second >> r::command::module_id_shift & 255));
  });
}

TEST_CASE("cchip_subsystem_regs: what hardware writes is read, and nothing is where nothing is",
          "[unit][cchip_subsystem_regs]") {
  with_registers([](auto& simulation, Master& master, Random& random, External& external) {
    namespace r = registers;
    Model& top = simulation.top();
    const auto read = [&](std::uint32_t offset) {
      const sim::AxiLiteWord word = master.read(simulation, offset);
      REQUIRE(word.ok);
      return word.data;
    };
    for (int round = 0; round < 30; ++round) {
      scramble(top, random);
      REQUIRE(read(r::id::offset) == 0x50484343);
      REQUIRE(read(r::version::offset) == 0x200);
      REQUIRE(read(r::capabilities::offset) ==
              (top.hwif_in_capabilities_slots | std::uint32_t{top.hwif_in_capabilities_cfg_w} << 8 |
               std::uint32_t{top.hwif_in_capabilities_coord_w} << 16 |
               std::uint32_t{top.hwif_in_capabilities_kinds} << 24));
      REQUIRE(read(r::queue_depth::offset) == top.hwif_in_queue_depth_pairs);
      REQUIRE(read(r::report::offset) == (top.hwif_in_report_code | std::uint32_t{top.hwif_in_report_slot} << 8 |
                                          std::uint32_t{top.hwif_in_report_module_id} << 16));
      REQUIRE(read(r::report_lost::offset) == top.hwif_in_report_lost_pairs);
      for (std::uint32_t i = 0; i < r::slot_status::count; ++i) {
        const std::uint32_t word = read(r::slot_status::offset(i));
        REQUIRE((word & r::slot_status::module_id_mask) == (top.hwif_in_slot_status_module_id >> 8 * i & 255U));
        REQUIRE((word & r::slot_status::phase_mask) >> r::slot_status::phase_shift ==
                (top.hwif_in_slot_status_phase >> 4 * i & 15U));
        REQUIRE((word >> r::slot_status::decoupled_shift & 1U) == (top.hwif_in_slot_status_decoupled >> i & 1U));
        REQUIRE((word & 0xE000U) == 0);  // no field
        REQUIRE(word >> r::slot_status::outstanding_shift == (top.hwif_in_slot_status_outstanding >> 16 * i & 0xFFFFU));
      }
      REQUIRE(read(r::lost::offset) == top.hwif_in_lost_value);
      const auto require_external = [&](std::uint32_t offset) {
        CAPTURE(offset);
        REQUIRE(read(offset) == external.words[offset / 4]);
      };
      for (const std::uint32_t offset : {r::swaps::offset, r::rejected::offset, r::stalls::offset}) {
        require_external(offset);
      }
      for (std::uint32_t i = 0; i < r::phase_clocks::count; ++i) require_external(r::phase_clocks::offset(i));
      for (std::uint32_t i = 0; i < 2 * r::pairs::count; ++i) require_external(r::pairs::offset(0) + 4 * i);
    }
  });
}

TEST_CASE("cchip_subsystem_regs: every address that is no register, or read-only, refuses and changes nothing",
          "[unit][cchip_subsystem_regs]") {
  with_registers([](auto& simulation, Master& master, Random& random, External& external) {
    namespace r = registers;
    std::set<std::uint32_t> written = {r::interrupt_status::offset};
    for (const auto& [offset, bits] : plain_registers()) written.insert(offset);
    for (std::uint32_t i = 0; i < r::bitstream_address::count; ++i) {
      written.insert({r::bitstream_address::offset(i), r::bitstream_size::offset(i), r::bitstream_valid::offset(i)});
    }
    std::set<std::uint32_t> read = {
        r::id::offset,          r::version::offset, r::capabilities::offset, r::queue_depth::offset, r::report::offset,
        r::report_lost::offset, r::lost::offset,    r::swaps::offset,        r::rejected::offset,    r::stalls::offset};
    for (std::uint32_t i = 0; i < r::slot_status::count; ++i) read.insert(r::slot_status::offset(i));
    for (std::uint32_t i = 0; i < r::phase_clocks::count; ++i) read.insert(r::phase_clocks::offset(i));
    for (std::uint32_t i = 0; i < 2 * r::pairs::count; ++i) read.insert(r::pairs::offset(0) + 4 * i);
    read.insert(written.begin(), written.end());
    std::map<std::uint32_t, std::uint32_t> values;
    for (const auto& [offset, bits] : plain_registers()) {
      values[offset] = static_cast<std::uint32_t>(random()) & bits.first;
      REQUIRE(master.write(simulation, offset, values[offset]));
    }
    const auto words = external.words;
    for (std::uint32_t offset = 0; offset < 4096; offset += 4) {
      CAPTURE(offset);
      const sim::AxiLiteWord word = master.read(simulation, offset);
      REQUIRE(word.ok == (read.count(offset) != 0));
      if (!word.ok) REQUIRE(word.data == 0);
      if (written.count(offset) == 0) REQUIRE(!master.write(simulation, offset, ~0U));
    }
    for (const auto& [offset, value] : values) {
      CAPTURE(offset);
      REQUIRE(master.read(simulation, offset).data == value);
    }
    REQUIRE(external.words == words);
  });
}

TEST_CASE("cchip_subsystem_regs: a refusal stays on the bus until it is taken, and the next access is judged anew",
          "[unit][cchip_subsystem_regs]") {
  with_any_delays([](auto& simulation, Master& master, Random& random, External&) {
    namespace r = registers;
    for (int i = 0; i < 20; ++i) {
      const bool good = chance(random, 50);
      const std::uint32_t none = chance(random, 50) ? r::report::offset : 0xFFC;  // read-only, or nothing there
      REQUIRE(master.write(simulation, good ? r::minimum_batch::offset : none, 7) == good);
      REQUIRE(master.read(simulation, good ? r::minimum_batch::offset : 0xFFC).ok == good);
    }
  });
}

TEST_CASE("cchip_subsystem_regs: pulses last a clock, with their operands", "[unit][cchip_subsystem_regs]") {
  with_registers([](auto& simulation, Master& master, Random& random, External&) {
    namespace r = registers;
    Model& top = simulation.top();
    for (int round = 0; round < 50; ++round) {
      const bool go = random() % 2 != 0;
      const std::uint32_t word = static_cast<std::uint32_t>(random()) & 0x1FFFFU;
      master.push_write(r::command::offset, word | (go ? r::command::go_mask : 0));
      int pulses = 0;
      for (int clock = 0; clock < 12; ++clock) {
        simulation.step();
        if (top.hwif_out_command_go == 0) continue;
        ++pulses;
        REQUIRE(top.hwif_out_command_slot == (word & 255));
        REQUIRE(top.hwif_out_command_module_id == (word >> 8 & 255));
        REQUIRE(top.hwif_out_command_force == word >> 16);
      }
      REQUIRE(master.next_write());
      REQUIRE(pulses == (go ? 1 : 0));
      const auto control = static_cast<std::uint32_t>(random() % 8);
      master.push_write(r::control::offset, control);
      int aborts = 0;
      int clears = 0;
      for (int clock = 0; clock < 12; ++clock) {
        simulation.step();
        aborts += top.hwif_out_control_abort;
        clears += top.hwif_out_control_clear;
      }
      REQUIRE(master.next_write());
      REQUIRE(aborts == static_cast<int>(control >> r::control::abort_shift & 1));
      REQUIRE(clears == static_cast<int>(control >> r::control::clear_shift & 1));
      REQUIRE(top.hwif_out_control_scheduler_enable == (control & 1));
    }
  });
}

TEST_CASE("cchip_subsystem_regs: events stay until they are cleared and are never lost",
          "[unit][cchip_subsystem_regs]") {
  with_registers([](auto& simulation, Master& master, Random& random, External&) {
    namespace r = registers;
    Model& top = simulation.top();
    const std::array<CData*, 5> events = {
        &top.hwif_in_interrupt_status_done_hwset, &top.hwif_in_interrupt_status_error_hwset,
        &top.hwif_in_interrupt_status_lost_hwset, &top.hwif_in_interrupt_status_no_provider_hwset,
        &top.hwif_in_interrupt_status_illegal_kind_hwset};
    std::uint32_t status = 0;
    for (int round = 0; round < 200; ++round) {
      const std::size_t i = random() % 5;
      *events[i] = 1;
      simulation.step();
      *events[i] = 0;
      status |= 1U << i;
      REQUIRE(master.read(simulation, r::interrupt_status::offset).data == status);
      const auto clear = static_cast<std::uint32_t>(random());
      // an event on the clock of the write is not lost: events on every clock of the write
      const bool again = chance(random, 30);
      *events[i] = again ? 1 : 0;
      REQUIRE(master.write(simulation, r::interrupt_status::offset, clear));
      *events[i] = 0;
      status = (status & ~clear) | (again ? 1U << i : 0U);
      REQUIRE(master.read(simulation, r::interrupt_status::offset).data == status);
      REQUIRE(top.hwif_out_interrupt_status_done == (status & 1));
    }
  });
}
