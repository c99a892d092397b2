// SPDX-License-Identifier: Apache-2.0
/// \file
/// Level 3: the RTL of a primitive test as a closed SystemC component with pins.
#ifndef CCHIP_LEVELS_RTL_SHELL_HPP
#define CCHIP_LEVELS_RTL_SHELL_HPP

#include <cchip/internal/wire/definitions.hpp>
#include <cstdint>
#include <memory>
#include <systemc>

namespace cchip::levels {

class PrimtestRtl;

/// Flat vector of four vertices.
using VertexBits = sc_dt::sc_bv<defs::vertices * 3 * defs::coord_w_default>;

/// Pins of cchip_primtest_tri_tri and the others (docs/modules/cchip_primtest.md) but clk and rst, with the types that
/// `verilator --sc` gives them. In: towards the test; Out: from it.
template <template <class> class In, template <class> class Out>
struct PrimtestPins {
  In<bool> s_pair_valid{"s_pair_valid"};
  Out<bool> s_pair_ready{"s_pair_ready"};
  In<std::uint32_t> s_pair_tag{"s_pair_tag"};
  In<std::uint32_t> s_pair_mode{"s_pair_mode"};
  In<VertexBits> s_pair_a{"s_pair_a"};
  In<VertexBits> s_pair_b{"s_pair_b"};
  In<std::uint32_t> s_pair_err{"s_pair_err"};
  Out<bool> m_result_valid{"m_result_valid"};
  In<bool> m_result_ready{"m_result_ready"};
  Out<std::uint32_t> m_result_tag{"m_result_tag"};
  Out<bool> m_result_hit{"m_result_hit"};
  Out<bool> m_result_grid{"m_result_grid"};
  Out<bool> m_result_definite{"m_result_definite"};
  Out<std::uint32_t> m_result_axis{"m_result_axis"};
  Out<std::uint32_t> m_result_beats{"m_result_beats"};
  Out<std::uint32_t> rm_id{"rm_id"};
  Out<bool> idle{"idle"};
};

/// A primitive test. It works at the rising edge of clk, since every output is a flip-flop. A Verilated model for
/// SystemC cannot be made during simulation, so the model inside is one for C++. The component does not reset itself
/// and knows nothing of reconfiguration.
class RtlShell : public sc_core::sc_module, public PrimtestPins<sc_core::sc_in, sc_core::sc_out> {
 public:
  sc_core::sc_in<bool> clk{"clk"};
  sc_core::sc_in<bool> rst{"rst"};

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
