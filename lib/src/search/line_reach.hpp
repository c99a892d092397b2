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

#include "exact/ieee.hpp"

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
    // (a - b) axis + (b - c) face diagonal + c cube diagonal, with a >= b >= c the magnitudes. Without branches, which
    // would be mispredicted.
    const Real low = std::min(x, y);
    const Real high = std::max(x, y);
    const Real a = std::max(high, z);
    const Real b = std::max(low, std::min(high, z));
    const Real c = std::min(low, z);
    factor_ = {unit * (a - b), unit * Real(1.4142135623730951) * (b - c), unit * Real(1.7320508075688772) * c};
    const auto bit = [](bool condition) { return static_cast<unsigned>(condition); };
    const unsigned corner = bit(m[0] < 0) | bit(m[1] < 0) << 1U | bit(m[2] < 0) << 2U;
    // Of components of equal size any may be the greatest or the least: if these are the same one, all are equal, and
    // only the corner has a factor.
    const unsigned greatest_z = bit(z > high);
    const unsigned greatest = greatest_z << 1U | (bit(y > x) & ~greatest_z);
    const unsigned least_z = bit(z < low);
    const unsigned least = least_z << 1U | (bit(y < x) & ~least_z);
    // Signs of the axes after the missing one, in cyclic order.
    const unsigned face = (corner | corner << 3U) >> (least + 1) & 3U;
    const unsigned first_face = static_cast<unsigned>(bvh::first_face_word) + 4 * least;
    const unsigned first_corner = static_cast<unsigned>(bvh::first_corner_word);
    along_ = {2 * greatest + (corner >> greatest & 1U), first_face + face, first_corner + corner};
    against_ = {along_[0] ^ 1U, first_face + (face ^ 3U), first_corner + (corner ^ 7U)};
  }
  /// The greatest of m . (x - centre), at most, up to the rounding of this line.
  Real along(const bvh::SupportLine& line) const { return sum(along_, line.word); }
  /// The same for -m.
  Real against(const bvh::SupportLine& line) const { return sum(against_, line.word); }
  /// The same as along() of the whole object. With the magnitudes of m adding up to s and the radius R of the object's
  /// ball, in doubles: off by at most 7.95 x 2^-53 R s, and by what underflows (docs/cpp/exactness.md, "Far apart").
  Real along_whole(const bvh::SupportTree& tree) const { return sum(along_, tree.whole_words()); }
  /// As a lane of a side: `along`, or against.
  void store(bool along, double scale, std::size_t lane, simd::FrameSide& side) const;

 private:
  using Words = std::array<unsigned, 3>;
  Real sum(const Words& words, const std::array<std::int16_t, bvh::support_words>& word) const {
    return factor_[0] * word[words[0]] + factor_[1] * word[words[1]] + factor_[2] * word[words[2]];
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

/// How far an object reaches along a vector of its frame, at most.
inline double reach_along(const bvh::SupportTree& tree, const std::array<double, 3>& m) {
  return BasicLineReach<double>(m, tree.unit()).along_whole(tree);
}

}  // namespace cchip

#endif
