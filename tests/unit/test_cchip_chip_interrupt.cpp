// SPDX-License-Identifier: Apache-2.0
// A host whose interrupt controller sees edges of the line only: MSI, or a controller that is set to edges.
#include <cchip/internal/wire/chip_registers.hpp>
#include <cchip/machines/chip_machine.hpp>
#include <models/cchip_chip.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;
namespace regs = cchip::chip_registers;

namespace {

using Model = chip_small::Model;

/// Counts rising edges.
class Edges : public sim::Agent {
 public:
  explicit Edges(Model& model) : model_(model) {}
  void drive(const sim::ClockInfo&) override {}
  void sample(const sim::ClockInfo& now) override {
    if (model_.irq != 0 && !line_ && !now.in_reset) ++count;
    line_ = model_.irq != 0;
  }
  int count = 0;

 private:
  Model& model_;
  bool line_ = false;
};

/// A chip whose host hands over lines of zeros: each is answered by one record, "bad descriptor".
struct Host {
  explicit Host(const sim::SimulationOptions& options) : machine(options), edges(machine.simulation().top()) {
    machine.simulation().add(edges);
    machine.write_register(regs::query_size::offset, 3);
    machine.write_register(regs::record_base_low::offset, 0x1000);
    machine.write_register(regs::record_size::offset, 8);
    machine.write_memory(0, Bytes(0x3000, 0));
    machine.write_register(regs::control::offset, regs::control::enable_mask);
    wait(600);  // the cache clears itself
    clear(0x1FF);
    machine.write_register(regs::interrupt_enable::offset, regs::interrupt_enable::record_mask);
  }
  void wait(int clocks) {
    for (int i = 0; i < clocks; ++i) machine.proceed();
  }
  void submit() { machine.write_register(regs::query_producer::offset, ++submitted); }
  void clear(std::uint32_t events) { machine.write_register(regs::interrupt_status::offset, events); }
  bool event() {
    return (machine.read_register(regs::interrupt_status::offset) & regs::interrupt_status::record_mask) != 0;
  }
  std::uint32_t records() { return machine.read_register(regs::record_producer::offset); }

  sim::ChipMachine<Model, chip_small::DATA_W> machine;
  Edges edges;
  std::uint32_t submitted = 0;
};

}  // namespace

TEST_CASE("cchip_chip: an event on or after its clear makes a new edge of the interrupt", "[unit][cchip_chip]") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Host host(options);
    int stayed = 0;
    int cleared = 0;
    constexpr int longest = 400;  // clocks from the doorbell to the record, at most
    for (int delay = 0; delay < longest; ++delay) {
      CAPTURE(delay);
      host.submit();
      host.wait(longest);
      REQUIRE(host.records() == host.submitted);
      REQUIRE(host.event());
      REQUIRE(host.machine.interrupt());
      // one more record while the host is in its handler
      host.submit();
      host.wait(delay);
      host.edges.count = 0;
      host.clear(regs::interrupt_status::record_mask);
      host.wait(longest);
      REQUIRE(host.records() == host.submitted);
      const bool again = host.event();
      (again ? stayed : cleared) += 1;
      REQUIRE(host.edges.count == (again ? 1 : 0));
      REQUIRE(host.machine.interrupt() == again);
      host.clear(regs::interrupt_status::record_mask);
      host.machine.write_register(regs::record_consumer::offset, host.submitted);
    }
    REQUIRE(stayed >= 20);
    REQUIRE(cleared >= 20);
  });
}

TEST_CASE("cchip_chip: the interrupt drops for one clock after each write of its status", "[unit][cchip_chip]") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Host host(options);
    host.submit();
    host.wait(400);
    REQUIRE(host.machine.interrupt());
    for (const std::uint32_t others : {0x000U, 0x1FEU}) {  // clears nothing that is set
      host.edges.count = 0;
      host.clear(others);
      host.wait(20);
      REQUIRE(host.edges.count == 1);
      REQUIRE(host.machine.interrupt());
    }
    host.edges.count = 0;
    host.machine.write_register(regs::interrupt_enable::offset, 0x1FF);
    REQUIRE(host.event());
    host.wait(20);
    REQUIRE(host.edges.count == 0);
  });
}
