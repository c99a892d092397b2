// SPDX-License-Identifier: Apache-2.0
/// \file
/// How two parts of an assembly lie to each other, and whether its rules accept that.
#ifndef CCHIP_ASSEMBLY_PAIR_JUDGE_HPP
#define CCHIP_ASSEMBLY_PAIR_JUDGE_HPP

#include <cchip/assembly.hpp>
#include <cstddef>

#include "rule_book.hpp"

namespace cchip::assembly {

/// \pre a < b
/// \throws as solids()
AssemblyPair judge_pair(const Assembly& assembly, const RuleBook& rules, std::size_t a, std::size_t b,
                        std::size_t most_normals);
/// The same with the parts elsewhere.
AssemblyPair judge_pair(const Assembly& assembly, const RuleBook& rules, std::size_t a, std::size_t b,
                        const AssemblyPart& part_a, const AssemblyPart& part_b, std::size_t most_normals);

}  // namespace cchip::assembly

#endif
