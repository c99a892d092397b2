// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cchip/sim/axi_lite.hpp>
#include <cchip/wire/registers.hpp>
#include <map>
#include <models/cchip_subsystem_regs.hpp>

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
  sim::set_random(top.hwif_in_queue_depth_pairs, 32, random);
  sim::set_random(top.hwif_in_report_module_id, 8, random);
  sim::set_random(top.hwif_in_report_slot, 8, random);
  sim::set_random(top.hwif_in_report_code, 4, random);
  sim::set_random(top.hwif_in_report_lost_pairs, 16, random);
  sim::set_random(top.hwif_in_slot_status_outstanding, 32, random);
  sim::set_random(top.hwif_in_slot_status_decoupled, 2, random);
  sim::set_random(top.hwif_in_slot_status_phase, 8, random);
  sim::set_random(top.hwif_in_slot_status_module_id, 16, random);
  sim::set_random(top.hwif_in_swaps_value, 32, random);
  sim::set_random(top.hwif_in_rejected_value, 32, random);
  sim::set_random(top.hwif_in_stalls_value, 32, random);
  sim::set_random(top.hwif_in_lost_value, 32, random);
  sim::set_random(top.hwif_in_phase_clocks_value, 288, random);
  sim::set_random(top.hwif_in_pairs_value, 256, random);
  top.hwif_in_interrupt_status_done_hwset = 0;
  top.hwif_in_interrupt_status_error_hwset = 0;
  top.hwif_in_interrupt_status_lost_hwset = 0;
  top.hwif_in_interrupt_status_no_provider_hwset = 0;
  top.hwif_in_interrupt_status_illegal_kind_hwset = 0;
  top.hwif_in_bitstream_valid_value_hwclr = 0;
}

template <class Body>
void with_registers(Body&& body) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    Random random(options.seed);
    sim::Simulation<Model> simulation(options);
    Master master(simulation.top());
    simulation.add(master);
    scramble(simulation.top(), random);
    simulation.reset();
    body(simulation, master, random);
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
  for (std::uint32_t i = 0; i < r::bitstream_address::count; ++i) {
    found[r::bitstream_address::offset(i)] = {~0U, 0};
    found[r::bitstream_size::offset(i)] = {~0U, 0};
    found[r::bitstream_valid::offset(i)] = {1, 0};
  }
  return found;
}

}  // namespace

TEST_CASE("cchip_subsystem_regs: what software writes it reads back, byte by byte, with any delays",
          "[unit][cchip_subsystem_regs]") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Random random(options.seed);
    for (int round = 0; round < 20; ++round) {
      sim::Simulation<Model> simulation(options);
      const auto pattern = [&] { return sim::standard_patterns(random())[random() % 7]; };
      Master master(simulation.top(), {pattern(), pattern(), pattern(), pattern(), pattern()});
      simulation.add(master);
      scramble(simulation.top(), random);
      simulation.reset();
      auto expected = plain_registers();
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
      for (std::uint32_t i = 0; i < 8; ++i) {
        const int at = static_cast<int>(32 * i);
        REQUIRE(sim::get_bits(top.hwif_out_bitstream_address_value, at, 32) ==
                expected[r::bitstream_address::offset(i)].second);
        REQUIRE(sim::get_bits(top.hwif_out_bitstream_size_value, at, 32) ==
                expected[r::bitstream_size::offset(i)].second);
        REQUIRE((top.hwif_out_bitstream_valid_value >> i & 1U) == expected[r::bitstream_valid::offset(i)].second);
      }
    }
  });
}

TEST_CASE("cchip_subsystem_regs: what hardware writes is read, and nothing is where nothing is",
          "[unit][cchip_subsystem_regs]") {
  with_registers([](auto& simulation, Master& master, Random& random) {
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
      REQUIRE(read(r::version::offset) == 0x100);
      REQUIRE(read(r::capabilities::offset) ==
              (top.hwif_in_capabilities_slots | std::uint32_t{top.hwif_in_capabilities_cfg_w} << 8 |
               std::uint32_t{top.hwif_in_capabilities_coord_w} << 16));
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
        REQUIRE(word >> r::slot_status::outstanding_shift == (top.hwif_in_slot_status_outstanding >> 16 * i & 0xFFFFU));
      }
      REQUIRE(read(r::swaps::offset) == top.hwif_in_swaps_value);
      REQUIRE(read(r::rejected::offset) == top.hwif_in_rejected_value);
      REQUIRE(read(r::stalls::offset) == top.hwif_in_stalls_value);
      REQUIRE(read(r::lost::offset) == top.hwif_in_lost_value);
      for (std::uint32_t i = 0; i < r::phase_clocks::count; ++i) {
        REQUIRE(read(r::phase_clocks::offset(i)) ==
                sim::get_bits(top.hwif_in_phase_clocks_value, static_cast<int>(32 * i), 32));
      }
      // the high word must be the one of the moment at which the low word was read
      for (std::uint32_t i = 0; i < r::pairs::count; ++i) {
        const std::uint64_t value = sim::get_bits(top.hwif_in_pairs_value, static_cast<int>(64 * i), 64);
        REQUIRE(read(r::pairs::offset(i)) == (value & 0xFFFFFFFF));
        sim::set_bits(top.hwif_in_pairs_value, static_cast<int>(64 * i), 64, value + 0x123456789ABCDEF);
        REQUIRE(read(r::pairs::offset(i) + 4) == value >> 32);
      }
    }
    // read-only registers, and addresses without a register
    for (const std::uint32_t offset : {r::id::offset, r::report::offset, r::pairs::offset(0)}) {
      REQUIRE(!master.write(simulation, offset, 1));
      REQUIRE(master.read(simulation, offset).ok);
    }
    for (const std::uint32_t offset : {0x028U, 0x060U, 0x0C0U, 0x120U, 0x20CU, 0x280U, 0xFFCU}) {
      REQUIRE(!master.write(simulation, offset, 1));
      REQUIRE(!master.read(simulation, offset).ok);
    }
  });
}

TEST_CASE("cchip_subsystem_regs: pulses last a clock, with their operands", "[unit][cchip_subsystem_regs]") {
  with_registers([](auto& simulation, Master& master, Random& random) {
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
  with_registers([](auto& simulation, Master& master, Random& random) {
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
    for (std::uint32_t i = 0; i < 8; ++i) {
      REQUIRE(master.write(simulation, r::bitstream_valid::offset(i), 1));
      REQUIRE(master.read(simulation, r::bitstream_valid::offset(i)).data == 1);
      top.hwif_in_bitstream_valid_value_hwclr = static_cast<CData>(1U << i);
      simulation.step();
      top.hwif_in_bitstream_valid_value_hwclr = 0;
      REQUIRE(master.read(simulation, r::bitstream_valid::offset(i)).data == 0);
    }
  });
}
