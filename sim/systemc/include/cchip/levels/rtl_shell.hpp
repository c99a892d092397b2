// SPDX-License-Identifier: Apache-2.0
/// \file
/// Level 3: the RTL of a primitive test as a closed SystemC component with pins.
#ifndef CCHIP_LEVELS_RTL_SHELL_HPP
#define CCHIP_LEVELS_RTL_SHELL_HPP

#include <cchip/wire/definitions.hpp>
#include <cstdint>
#include <memory>
#include <systemc>

namespace cchip::levels {

class PrimtestRtl;

/// Flat vector of four vertices.
using VertexBits = sc_dt::sc_bv<defs::vertices * 3 * defs::coord_w_default>;

/// Pins of cchip_primtest_tri_tri and the others (docs/modules/cchip_primtest.md), with the types that `verilator --sc`
/// gives them. Works at the rising edge of clk, since every output is a flip-flop. A Verilated model for SystemC cannot
/// be made during simulation, so the model inside is one for C++. The component does not reset itself and knows nothing
/// of reconfiguration.
class RtlShell : public sc_core::sc_module {
 public:
  sc_core::sc_in<bool> clk{"clk"};
  sc_core::sc_in<bool> rst{"rst"};
  sc_core::sc_in<bool> s_pair_valid{"s_pair_valid"};
  sc_core::sc_out<bool> s_pair_ready{"s_pair_ready"};
  sc_core::sc_in<std::uint32_t> s_pair_tag{"s_pair_tag"};
  sc_core::sc_in<std::uint32_t> s_pair_mode{"s_pair_mode"};
  sc_core::sc_in<VertexBits> s_pair_a{"s_pair_a"};
  sc_core::sc_in<VertexBits> s_pair_b{"s_pair_b"};
  sc_core::sc_in<std::uint32_t> s_pair_err{"s_pair_err"};
  sc_core::sc_out<bool> m_result_valid{"m_result_valid"};
  sc_core::sc_in<bool> m_result_ready{"m_result_ready"};
  sc_core::sc_out<std::uint32_t> m_result_tag{"m_result_tag"};
  sc_core::sc_out<bool> m_result_hit{"m_result_hit"};
  sc_core::sc_out<bool> m_result_grid{"m_result_grid"};
  sc_core::sc_out<bool> m_result_definite{"m_result_definite"};
  sc_core::sc_out<std::uint32_t> m_result_axis{"m_result_axis"};
  sc_core::sc_out<std::uint32_t> m_result_beats{"m_result_beats"};
  sc_core::sc_out<std::uint32_t> rm_id{"rm_id"};
  sc_core::sc_out<bool> idle{"idle"};

  /// Without power: its outputs do not change until power_up().
  RtlShell(const sc_core::sc_module_name& name, ModuleId id);
  ~RtlShell() override;

  ModuleId module_id() const { return id_; }

  /// A freshly configured device: every register holds what `seed` makes of it.
  void power_up(std::uint64_t seed);

 private:
  void clock();

  ModuleId id_;
  std::unique_ptr<PrimtestRtl> rtl_;
};

}  // namespace cchip::levels

#endif
