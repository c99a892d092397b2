// SPDX-License-Identifier: Apache-2.0
#include <cchip/levels/pin_driver.hpp>

namespace cchip::levels {
namespace {

VertexBits to_bits(const GridPrimitive& p) {
  static_assert(coord_w == 16);
  VertexBits bits;
  for (int i = 0; i < defs::vertices; ++i) {
    for (int d = 0; d < 3; ++d) {
      const int at = 3 * i + d;
      const auto coordinate = static_cast<std::uint16_t>(p.v.at(static_cast<std::size_t>(i))[d]);
      const std::uint32_t word = bits.get_word(at / 2);
      bits.set_word(at / 2, word | std::uint32_t{coordinate} << (at % 2 * 16));
    }
  }
  return bits;
}

}  // namespace

PinDriver::PinDriver(const sc_core::sc_module_name& name) : sc_module(name) {
  SC_HAS_PROCESS(PinDriver);
  SC_METHOD(clock);
  sensitive << clk.pos();
  dont_initialize();
}

void PinDriver::clock() {
  if (m_result_ready.read() && m_result_valid.read()) results.nb_write(result());
  if (s_pair_valid.read() && s_pair_ready.read()) offers_ = false;
  RtlRequest request;
  if (coupled_ && !offers_ && requests.nb_read(request)) {
    put(request);
    offers_ = true;
  }
  s_pair_valid.write(coupled_ && offers_);
  m_result_ready.write(coupled_ && results.num_free() > 0);
}

void PinDriver::put(const RtlRequest& request) {
  s_pair_tag.write(request.tag);
  s_pair_mode.write(static_cast<std::uint32_t>(request.mode));
  s_pair_a.write(to_bits(request.pair.a));
  s_pair_b.write(to_bits(request.pair.b));
  s_pair_err.write(static_cast<std::uint32_t>(request.pair.eta));
}

RtlResult PinDriver::result() const {
  const std::uint32_t axis = m_result_axis.read();
  RtlResult r;
  r.tag = static_cast<std::uint16_t>(m_result_tag.read());
  r.hit = m_result_hit.read();
  r.grid = m_result_grid.read();
  r.definite = m_result_definite.read();
  r.axis = {static_cast<AxisClass>(axis >> 6 & 7U), static_cast<std::uint8_t>(axis >> 3 & 7U),
            static_cast<std::uint8_t>(axis & 7U)};
  r.beats = static_cast<int>(m_result_beats.read());
  return r;
}

}  // namespace cchip::levels
