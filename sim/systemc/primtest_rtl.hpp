// SPDX-License-Identifier: Apache-2.0
/// \file
/// A Verilated primitive test of level 3, clock by clock. Neither Verilator nor SystemC is visible, see
/// subsystem_rtl.hpp.
#ifndef CCHIP_LEVELS_PRIMTEST_RTL_HPP
#define CCHIP_LEVELS_PRIMTEST_RTL_HPP

#include <array>
#include <cchip/internal/wire/definitions.hpp>
#include <cstdint>
#include <memory>

namespace cchip::levels {

/// Words of a flat vector of vertices, lowest first.
using VertexWords = std::array<std::uint32_t, 6>;

struct PrimtestInputs {
  bool rst = false;
  bool s_pair_valid = false;
  std::uint32_t s_pair_tag = 0;
  std::uint32_t s_pair_mode = 0;
  VertexWords s_pair_a{};
  VertexWords s_pair_b{};
  std::uint32_t s_pair_err = 0;
  bool m_result_ready = false;
};

struct PrimtestOutputs {
  bool s_pair_ready = false;
  bool m_result_valid = false;
  std::uint32_t m_result_tag = 0;
  bool m_result_hit = false;
  bool m_result_grid = false;
  bool m_result_definite = false;
  std::uint32_t m_result_axis = 0;
  std::uint32_t m_result_beats = 0;
  std::uint32_t rm_id = 0;
  bool idle = false;
};

class PrimtestRtl {
 public:
  virtual ~PrimtestRtl() = default;
  /// A rising edge with these inputs. \return the outputs after it
  /// \throws std::exception an assertion of the RTL fails
  virtual PrimtestOutputs clock(const PrimtestInputs& in) = 0;
};

/// A module at power-up, with its own Verilated context: no reset; what RTL leaves undefined is drawn from `seed`.
/// \throws std::invalid_argument the blank module
std::unique_ptr<PrimtestRtl> power_up_primtest(ModuleId id, std::uint64_t seed);

}  // namespace cchip::levels

#endif
