// SPDX-License-Identifier: Apache-2.0
/// \file
/// Integers of 128 bits.
#ifndef CCHIP_SIM_INT128_HPP
#define CCHIP_SIM_INT128_HPP

namespace cchip::sim {

// __extension__ (no warning about a type outside ISO C++) needs typedef.
__extension__ typedef __int128 Int128;            // NOLINT(modernize-use-using)
__extension__ typedef unsigned __int128 UInt128;  // NOLINT(modernize-use-using)

}  // namespace cchip::sim

#endif
