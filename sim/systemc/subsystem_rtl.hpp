// SPDX-License-Identifier: Apache-2.0
/// \file
/// The Verilated cchip_primtest_subsystem of level 4, clock by clock. Neither Verilator nor SystemC is visible: the
/// headers of the two do not go together in one translation unit unless Verilator makes SystemC models.
#ifndef CCHIP_LEVELS_SUBSYSTEM_RTL_HPP
#define CCHIP_LEVELS_SUBSYSTEM_RTL_HPP

#include <cchip/internal/driver/primtest_engine.hpp>
#include <cstdint>
#include <memory>
#include <optional>

namespace cchip::levels {

/// A burst of the AXI4 read master.
struct AxiBurst {
  std::uint32_t address = 0;
  std::uint32_t beats = 0;  ///< of 4 bytes
};

/// An answered AXI4-Lite access.
struct RegisterAnswer {
  std::uint32_t data = 0;  ///< of a read
  bool ok = false;
};

class SubsystemRtl {
 public:
  /// After reset. \param seed of what the RTL leaves undefined at power-up
  explicit SubsystemRtl(std::uint64_t seed);
  ~SubsystemRtl();
  SubsystemRtl(const SubsystemRtl&) = delete;
  SubsystemRtl& operator=(const SubsystemRtl&) = delete;

  /// One clock. \throws std::exception an assertion of the RTL fails
  void clock();

  /// s_pair: true if the pair offered last was accepted.
  bool wants_pair() const;
  /// \param test module that tests the pair
  void offer(const PairRequest& request, ModuleId test);
  /// m_result_ready of the next clock.
  void set_result_ready(bool ready);
  /// Oldest answer not yet taken.
  std::optional<PairResult> result();

  /// AXI4-Lite, one access at a time.
  void write_register(std::uint32_t address, std::uint32_t data);
  void read_register(std::uint32_t address);
  /// The answer, returned once, when it has arrived.
  std::optional<RegisterAnswer> register_answer();

  /// Oldest burst not yet taken.
  std::optional<AxiBurst> burst();
  /// Next beat of the bursts in their order; any time after the burst was taken.
  void give_beat(std::uint32_t data, bool ok, bool last);

  bool irq() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace cchip::levels

#endif
