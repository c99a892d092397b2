// SPDX-License-Identifier: Apache-2.0
/// \file
/// Instruction sets for which the files of this folder are compiled. To be included before foreach_target.h.
#ifndef CCHIP_SEARCH_SIMD_TARGETS_HPP
#define CCHIP_SEARCH_SIMD_TARGETS_HPP

// The emulation of 128-bit vectors serves computers without any of the instruction sets, and as a check of these. GCC
// before 12.3 miscompiles it where it vectorises, so these files are compiled without that.
#define HWY_BROKEN_EMU128 0
#ifdef CCHIP_SIMD_TARGETS  // a build that needs few of them (tests/ref)
#define HWY_DISABLED_TARGETS (~(CCHIP_SIMD_TARGETS))
#else
// Vectors of a size that only the machine knows cannot be kept in arrays.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_WASM | HWY_WASM_EMU256)
#endif

#include <cstddef>
#include <string>

namespace cchip {

/// The place of an instruction set in a table of HWY_EXPORT. A choice of our own: that of hwy::GetChosenTarget() is of
/// the whole process, where other users of Highway have chosen, too.
/// \param target one of simd_targets()
/// \param entries of the table, 1 if a single target is compiled in
/// \throws std::invalid_argument there is no such target
std::size_t target_index(const std::string& target, std::size_t entries);

}  // namespace cchip

#endif
