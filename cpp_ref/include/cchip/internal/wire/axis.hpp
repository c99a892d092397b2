// SPDX-License-Identifier: Apache-2.0
/// \file
/// Axis codes, `m_result_axis`: which axis separates a pair.
#ifndef CCHIP_INTERNAL_WIRE_AXIS_HPP
#define CCHIP_INTERNAL_WIRE_AXIS_HPP

#include <cchip/internal/wire/definitions.hpp>
#include <cstdint>
#include <string>

namespace cchip {

/// Witness of a "no": {class, k, l} of the separating axis.
struct AxisCode {
  AxisClass cls = AxisClass::none;
  std::uint8_t k = 0;
  std::uint8_t l = 0;
  friend bool operator==(const AxisCode& x, const AxisCode& y) { return x.cls == y.cls && x.k == y.k && x.l == y.l; }
};

/// The code as the hardware carries it, defs::axis_code_w bits: class, k, l from the highest bit down.
std::uint16_t to_bits(const AxisCode& axis);
/// Inverse of to_bits(); higher bits are ignored.
AxisCode axis_code_from_bits(std::uint16_t bits);

/// The witness in words: "none", "normal of A", "normal of face 2 of B" (a warped quad's face without vertex 2),
/// "edge 0 of A x edge 2 of B", "diagonal V0V2 of A x edge 1 of B", "edge 1 of A x direction z" (an axis in A's
/// plane), "box x", ...
std::string to_words(const AxisCode& axis);
/// The same in a few letters, for waveforms: "none", "normal A", "face B2" (its normal), "e0 x f2" (e: edges of A, f:
/// of B; 4 = V0V2, 5 = V1V3), "e1 x uz" (u: unit vectors), "box x", ...
std::string to_symbol(const AxisCode& axis);

}  // namespace cchip

#endif
