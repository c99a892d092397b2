// SPDX-License-Identifier: Apache-2.0
// What the driver of a chip makes of registers that no chip has.
#include <catch2/catch.hpp>
#include <cchip/driver/chip_driver.hpp>
#include <cchip/internal/wire/chip_registers.hpp>

using namespace cchip;
namespace regs = cchip::chip_registers;

namespace {

/// Registers of a chip with swaps and this number of slots; the others are 0.
class Registers final : public Machine {
 public:
  explicit Registers(std::uint32_t slots) : slots_(slots) {}
  std::uint32_t read_register(std::uint32_t offset) override {
    if (offset == regs::id::offset) return regs::id::value_reset;
    if (offset == regs::version::offset) return 2U << regs::version::major_number_shift;
    if (offset != regs::capabilities::offset) return 0;
    return regs::capabilities::swaps_mask | 7U << regs::capabilities::kinds_shift |
           slots_ << regs::capabilities::slots_shift;
  }
  void write_register(std::uint32_t, std::uint32_t) override {}
  void write_memory(std::uint64_t, const Bytes&) override {}
  Bytes read_memory(std::uint64_t, std::size_t count) override { return Bytes(count); }
  bool has_refit() const override { return true; }
  RefitEnd refit(std::uint32_t, std::uint32_t, std::uint32_t) override { return end; }
  bool interrupt() override { return false; }
  void proceed() override {}

  RefitEnd end;

 private:
  std::uint32_t slots_;
};

}  // namespace

TEST_CASE("chip driver: more slots than a chip can have are refused", "[ref][chip_driver]") {
  for (std::uint32_t slots = 1; slots <= regs::slot_status::count; ++slots) {
    const auto port = open_chip(std::make_unique<Registers>(slots));
    CHECK(port->capabilities().swap_slots == slots);
    for (std::uint32_t i = 0; i < 2 * slots; ++i) port->load(ModuleId::tri_tri);
  }
  for (std::uint32_t slots = regs::slot_status::count + 1; slots <= 7; ++slots) {
    CHECK_THROWS_WITH(open_chip(std::make_unique<Registers>(slots)),
                      "chip driver: the register capabilities says " + std::to_string(slots) +
                          " slots, a chip has at most 4; check the bus and the chip's release");
  }
}

TEST_CASE("chip driver: a refit whose writes may still arrive is no refit that gave up", "[ref][chip_driver]") {
  auto machine = std::make_unique<Registers>(1);
  RefitEnd& end = machine->end;
  const auto port = open_chip(std::move(machine));
  CHECK(port->refit(100, 3, 1));
  end.code = RefitCode::timeout;
  CHECK_FALSE(port->refit(100, 3, 1));  // the host makes the nodes and stores them at once
  end.outstanding = true;
  CHECK_THROWS_AS(port->refit(100, 3, 1), std::runtime_error);
}
