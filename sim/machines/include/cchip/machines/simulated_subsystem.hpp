// SPDX-License-Identifier: Apache-2.0
/// \file
/// The Verilated cchip_primtest_subsystem as a machine: two slots, real swaps.
#ifndef CCHIP_MACHINES_SIMULATED_SUBSYSTEM_HPP
#define CCHIP_MACHINES_SIMULATED_SUBSYSTEM_HPP

#include <cchip/driver/machine.hpp>
#include <cstdint>
#include <memory>
#include <string>

namespace cchip {

struct SimulatedSubsystemOptions {
  /// Seed of what the RTL leaves undefined at power-up.
  std::uint64_t seed = 1;
  /// FST file, none if empty, of the first trace_clocks clocks.
  std::string trace_path;
  std::uint64_t trace_clocks = 30000;
};

/// What only a simulation can observe.
struct SubsystemObservations {
  std::uint64_t clocks = 0;
  std::uint64_t transfer_clocks = 0;   ///< clocks of phase TRANSFER
  std::uint64_t hidden_clocks = 0;     ///< those of them with pairs inside the other slot
  std::uint64_t first_swap_start = 0;  ///< of the first swap that wrote a module; clocks since reset; both 0: none yet
  std::uint64_t first_swap_end = 0;
};

/// After reset slot 0 holds tri-tri and slot 1 quad-quad. Errors of the RTL or of a stream are std::runtime_error.
class SimulatedSubsystem : public PairMachine {
 public:
  /// Width of the configuration port, bit, and clocks per word of it.
  static constexpr int port_w = 8;
  static constexpr int clocks_per_word = 2;

  explicit SimulatedSubsystem(const SimulatedSubsystemOptions& options);
  ~SimulatedSubsystem() override;

  std::uint32_t read_register(std::uint32_t offset) override;
  void write_register(std::uint32_t offset, std::uint32_t value) override;
  /// Addresses have 32 bits.
  void write_memory(std::uint64_t address, const Bytes& bytes) override;
  /// 0 where nothing was written.
  Bytes read_memory(std::uint64_t address, std::size_t size) override;
  bool send(const KindRequest& request) override;
  std::optional<KindResult> receive() override;
  bool interrupt() override;
  void proceed() override;

  const SubsystemObservations& observations() const;
  /// Writes the layout of the waveform beside it, zoomed to the first swap.
  void write_layout() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace cchip

#endif
