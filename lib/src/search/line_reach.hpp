// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far nodes of a SupportTree reach along a vector.
#ifndef CCHIP_SEARCH_LINE_REACH_HPP
#define CCHIP_SEARCH_LINE_REACH_HPP

#include <array>
#include <cchip/internal/tree/support_tree.hpp>
#include <cchip/primitive.hpp>
#include <cmath>
#include <cstdint>
#include <utility>

namespace cchip {

namespace simd {
struct FrameSide;
}

/// How far nodes reach along a vector m of their object's frame, from the object's centre: a sum of three words times a
/// factor each, since m is a sum of three directions of the words.
class LineReach {
 public:
  LineReach() = default;
  LineReach(const Vec3d& m, double unit) {
    const std::array<double, 3> size = {std::abs(m[0]), std::abs(m[1]), std::abs(m[2])};
    std::array<unsigned, 3> order = {0, 1, 2};
    if (size[order[0]] < size[order[1]]) std::swap(order[0], order[1]);
    if (size[order[1]] < size[order[2]]) std::swap(order[1], order[2]);
    if (size[order[0]] < size[order[1]]) std::swap(order[0], order[1]);
    const auto [i, j, k] = order;
    const std::array<unsigned, 3> negative = {m[0] < 0 ? 1U : 0U, m[1] < 0 ? 1U : 0U, m[2] < 0 ? 1U : 0U};
    const auto axis = static_cast<std::uint8_t>(2 * i + negative[i]);
    const auto face = static_cast<std::uint8_t>(negative[(k + 1) % 3] + 2 * negative[(k + 2) % 3]);
    const auto corner = static_cast<std::uint8_t>(negative[0] + 2 * negative[1] + 4 * negative[2]);
    const auto first_face = static_cast<std::uint8_t>(bvh::first_face_word + 4 * k);
    constexpr auto first_corner = static_cast<std::uint8_t>(bvh::first_corner_word);
    // (a - b) axis + (b - c) face diagonal + c cube diagonal, with a >= b >= c the magnitudes.
    factor_ = {unit * (size[i] - size[j]), unit * 1.4142135623730951 * (size[j] - size[k]),
               unit * 1.7320508075688772 * size[k]};
    along_ = {axis, static_cast<std::uint8_t>(first_face + face), static_cast<std::uint8_t>(first_corner + corner)};
    against_ = {static_cast<std::uint8_t>(axis ^ 1U), static_cast<std::uint8_t>(first_face + (face ^ 3U)),
                static_cast<std::uint8_t>(first_corner + (corner ^ 7U))};
  }
  /// The greatest of m . (x - centre), at most, up to the rounding of this line.
  double along(const bvh::SupportLine& line) const { return sum(along_, line); }
  /// The same for -m.
  double against(const bvh::SupportLine& line) const { return sum(against_, line); }
  /// As a lane of a side: `along`, or against.
  void store(bool along, double scale, std::size_t lane, simd::FrameSide& side) const;

 private:
  using Words = std::array<std::uint8_t, 3>;
  double sum(const Words& words, const bvh::SupportLine& line) const {
    return factor_[0] * line.word[words[0]] + factor_[1] * line.word[words[1]] + factor_[2] * line.word[words[2]];
  }
  std::array<double, 3> factor_ = {};
  Words along_ = {};
  Words against_ = {};
};

}  // namespace cchip

#endif
