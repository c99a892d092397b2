// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pairs of nodes that wait, the nearest ones first.
#ifndef CCHIP_SEARCH_GAP_QUEUE_HPP
#define CCHIP_SEARCH_GAP_QUEUE_HPP

#include <algorithm>
#include <array>
#include <cchip/internal/tree/support_tree.hpp>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace cchip {

/// A queue in constant time: squares of gaps whose exponent and first three binary digits are the same share a stack.
class GapQueue {
 public:
  struct Pair {
    float square;  ///< at most the square of the distance; at least 0
    bvh::NodeRef a;
    bvh::NodeRef b;
  };

  GapQueue() {
    top_.fill(none);
    entries_.reserve(256);
  }

  void push(const Pair& pair) {
    const std::uint32_t stack = stack_of(pair.square);
    std::uint32_t at = free_;
    if (at == none) {
      at = static_cast<std::uint32_t>(entries_.size());
      entries_.emplace_back();
    } else {
      free_ = entries_[at].below;
    }
    entries_[at] = {pair, top_[stack]};
    top_[stack] = at;
    filled_[stack / 64] |= std::uint64_t{1} << stack % 64;
  }

  /// \param most pairs beyond this square need not come
  /// \returns false if no other pair is left
  bool pop(float most, Pair& pair) {
    const std::uint32_t stack = first_stack();
    if (stack > stack_of(most)) return false;
    const std::uint32_t at = top_[stack];
    Entry& entry = entries_[at];
    pair = entry.pair;
    top_[stack] = entry.below;
    if (entry.below == none) filled_[stack / 64] &= ~(std::uint64_t{1} << stack % 64);
    entry.below = free_;
    free_ = at;
    return true;
  }

  /// At most the square of each pair that is left; infinite if there is none.
  float least() const {
    const std::uint32_t stack = first_stack();
    if (stack == stacks) return std::numeric_limits<float>::infinity();
    if (stack == 0) return 0;
    const std::uint32_t bits = (stack + lowest) << digits_left;
    float square = 0;
    std::memcpy(&square, &bits, sizeof square);
    return square;
  }

 private:
  struct Entry {
    Pair pair;
    std::uint32_t below = 0;  ///< in its stack, or among those that are free
  };
  static constexpr std::uint32_t none = 0xFFFFFFFF;
  static constexpr unsigned digits_left = 20;  ///< of a float's 23 behind the point, which do not count
  static constexpr std::uint32_t stacks = 384;
  static constexpr std::uint32_t lowest = (127 - 45) << 3U;  ///< squares from 2^-45 to 2^3; those below have no order

  static std::uint32_t stack_of(float square) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &square, sizeof bits);
    return std::min(std::max(bits >> digits_left, lowest) - lowest, stacks - 1);
  }
  std::uint32_t first_stack() const {
    for (std::uint32_t i = 0; i < filled_.size(); ++i) {
      if (filled_[i] != 0) return 64 * i + static_cast<std::uint32_t>(__builtin_ctzll(filled_[i]));
    }
    return stacks;
  }

  std::array<std::uint32_t, stacks> top_;
  std::array<std::uint64_t, stacks / 64> filled_ = {};
  std::vector<Entry> entries_;
  std::uint32_t free_ = none;
};

}  // namespace cchip

#endif
