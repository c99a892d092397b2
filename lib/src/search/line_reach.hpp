// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far nodes of a SupportTree reach along a vector.
#ifndef CCHIP_SEARCH_LINE_REACH_HPP
#define CCHIP_SEARCH_LINE_REACH_HPP

#include <algorithm>
#include <array>
#include <cchip/internal/tree/support_tree.hpp>
#include <cchip/primitive.hpp>
#include <cmath>
#include <cstdint>

namespace cchip {

namespace simd {
struct FrameSide;
}

/// How far nodes reach along a vector m of their object's frame, from the object's centre: a sum of three words times a
/// factor each, since m is a sum of three directions of the words.
template <class Real>
class BasicLineReach {
 public:
  BasicLineReach() = default;
  BasicLineReach(const std::array<Real, 3>& m, Real unit) {
    const Real x = std::abs(m[0]);
    const Real y = std::abs(m[1]);
    const Real z = std::abs(m[2]);
    // (a - b) axis + (b - c) face diagonal + c cube diagonal, with a >= b >= c the magnitudes.
    const Real low = std::min(x, y);
    const Real high = std::max(x, y);
    const Real a = std::max(high, z);
    const Real b = std::max(low, std::min(high, z));
    const Real c = std::min(low, z);
    const unsigned greatest = a == x ? 0 : a == y ? 1 : 2;
    const unsigned of_others = greatest == 0 ? (z <= y ? 2 : 1) : greatest == 1 ? (z <= x ? 2 : 0) : (y <= x ? 1 : 0);
    factor_ = {unit * (a - b), unit * Real(1.4142135623730951) * (b - c), unit * Real(1.7320508075688772) * c};
    const unsigned corner = (m[0] < 0 ? 1U : 0U) | (m[1] < 0 ? 2U : 0U) | (m[2] < 0 ? 4U : 0U);
    // Signs of the axes after the missing one, in cyclic order.
    const unsigned face = (corner | corner << 3U) >> (of_others + 1) & 3U;
    const unsigned first_face = static_cast<unsigned>(bvh::first_face_word) + 4 * of_others;
    const unsigned first_corner = static_cast<unsigned>(bvh::first_corner_word);
    along_ = {2 * greatest + (corner >> greatest & 1U), first_face + face, first_corner + corner};
    against_ = {along_[0] ^ 1U, first_face + (face ^ 3U), first_corner + (corner ^ 7U)};
  }
  /// The greatest of m . (x - centre), at most, up to the rounding of this line.
  Real along(const bvh::SupportLine& line) const { return sum(along_, line); }
  /// The same for -m.
  Real against(const bvh::SupportLine& line) const { return sum(against_, line); }
  /// As a lane of a side: `along`, or against.
  void store(bool along, double scale, std::size_t lane, simd::FrameSide& side) const;

 private:
  using Words = std::array<unsigned, 3>;
  Real sum(const Words& words, const bvh::SupportLine& line) const {
    return factor_[0] * line.word[words[0]] + factor_[1] * line.word[words[1]] + factor_[2] * line.word[words[2]];
  }
  std::array<Real, 3> factor_ = {};
  Words along_ = {};
  Words against_ = {};
};

class LineReach : public BasicLineReach<double> {
 public:
  LineReach() = default;
  LineReach(const Vec3d& m, double unit) : BasicLineReach({m[0], m[1], m[2]}, unit) {}
};

}  // namespace cchip

#endif
