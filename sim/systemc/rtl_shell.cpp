// SPDX-License-Identifier: Apache-2.0
#include <cchip/levels/rtl_shell.hpp>

#include "primtest_rtl.hpp"

namespace cchip::levels {
namespace {

VertexWords words_of(const VertexBits& bits) {
  VertexWords words;
  static_assert(32 * words.size() == defs::vertices * 3 * defs::coord_w_default);
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = bits.get_word(static_cast<int>(i));
  return words;
}

}  // namespace

RtlShell::RtlShell(const sc_core::sc_module_name& name, ModuleId id) : sc_module(name), id_(id) {
  SC_HAS_PROCESS(RtlShell);
  SC_METHOD(clock);
  sensitive << clk.pos();
  dont_initialize();
}

RtlShell::~RtlShell() = default;

void RtlShell::power_up(std::uint64_t seed) { rtl_ = power_up_primtest(id_, seed); }

void RtlShell::clock() {
  if (!rtl_) return;
  const PrimtestOutputs out =
      rtl_->clock({rst.read(), s_pair_valid.read(), s_pair_tag.read(), s_pair_mode.read(), words_of(s_pair_a.read()),
                   words_of(s_pair_b.read()), s_pair_err.read(), m_result_ready.read()});
  s_pair_ready.write(out.s_pair_ready);
  m_result_valid.write(out.m_result_valid);
  m_result_tag.write(out.m_result_tag);
  m_result_hit.write(out.m_result_hit);
  m_result_grid.write(out.m_result_grid);
  m_result_definite.write(out.m_result_definite);
  m_result_axis.write(out.m_result_axis);
  m_result_beats.write(out.m_result_beats);
  rm_id.write(out.rm_id);
  idle.write(out.idle);
}

}  // namespace cchip::levels
