// SPDX-License-Identifier: Apache-2.0
/// \file
/// What solids() knows of an object beside its tree.
#ifndef CCHIP_INTERNAL_JUDGE_SHELLS_HPP
#define CCHIP_INTERNAL_JUDGE_SHELLS_HPP

#include <cchip/collide.hpp>
#include <cstdint>
#include <optional>
#include <vector>

namespace cchip {

/// A shell is what faces form that hang together by edges of two faces each.
struct Shells {
  /// No face has anything in common with another but a vertex or an edge of both, and each has an area, so the surface
  /// is never in one place twice.
  bool simple = false;
  /// Of a surface that is not simple: the first two faces that cross or share an area.
  std::optional<Contact> overlap;
  std::vector<std::uint32_t> of_face;     ///< number of its shell
  std::vector<std::uint32_t> first_face;  ///< of each shell
  /// All coordinates that faces use are multiples of 2^exponent.
  int exponent = 0;
};

/// Made by the first call, which takes as long as self_contacts(); copies of the object share it.
/// \throws as self_contacts()
const Shells& shells_of(const Object& object);

}  // namespace cchip

#endif
