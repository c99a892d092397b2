// SPDX-License-Identifier: Apache-2.0
/// \file
/// The Verilated cchip_chip as a machine and as a device.
#ifndef CCHIP_MACHINES_SIMULATED_CHIP_HPP
#define CCHIP_MACHINES_SIMULATED_CHIP_HPP

#include <cchip/collide.hpp>
#include <cchip/driver/machine.hpp>
#include <cchip/sim/axi_lines.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace cchip {

struct SimulatedChipOptions {
  /// Seed of what the RTL leaves undefined at power-up.
  std::uint64_t seed = 1;
  /// FST file, none if empty, of the first trace_clocks clocks, and the layout for GTKWave beside it.
  std::string trace_path;
  std::uint64_t trace_clocks = 30000;
  sim::AxiLinesOptions memory;
  /// 0: a static chip. 1, 2: the number of slots whose modules are exchanged at run time; each begins with the triangle
  /// test.
  unsigned slots = 0;
  /// Payload of each bitstream of such a chip, bytes.
  std::size_t payload_bytes = 2048;
  /// Chips on one memory, 1 to most_simulated_chips; more than one share its bus: one beat of 128 bit a clock each way
  /// for all of them. The waveform is that of the first.
  unsigned chips = 1;
};
inline constexpr unsigned most_simulated_chips = 8;

/// cchip_chip with default parameters (quad test in its slot, buses of 128 bit) after reset, and its memory. Errors of
/// the RTL or of a bus are std::runtime_error.
std::unique_ptr<Machine> make_simulated_chip(const SimulatedChipOptions& options = {});

/// A machine for each of the chips, for open_chips(): registers of their own, one memory, one clock.
/// \throws std::invalid_argument no such number of chips or slots
std::vector<std::unique_ptr<Machine>> make_simulated_chips(const SimulatedChipOptions& options);

/// Driver and host over make_simulated_chip(), or over make_simulated_chips() if there are several. The memory holds
/// images of 256 MiB in all, once for all chips.
/// \throws std::invalid_argument as make_simulated_chips()
std::unique_ptr<Device> open_simulated_chip(const SimulatedChipOptions& options = {});

/// Makes open_device("sim") known; a second call does nothing.
void add_simulated_chip();

}  // namespace cchip

#endif
