// SPDX-License-Identifier: Apache-2.0
/// \file
/// Broad phase: which of many boxes overlap, while they come, move and go?
#ifndef CCHIP_JUDGE_BOX_PAIRS_HPP
#define CCHIP_JUDGE_BOX_PAIRS_HPP

#include <cchip/scene.hpp>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace cchip {

/// Whether they share a point.
inline bool overlap(const WorldBox& p, const WorldBox& q) {
  bool apart = false;  // without branches, which would be mispredicted
  for (std::size_t axis = 0; axis < 3; ++axis) {
    apart |= p.least[axis] > q.greatest[axis];
    apart |= q.least[axis] > p.greatest[axis];
  }
  return !apart;
}

/// The box and all that is at most `by` away from it, `by` rounded up to what the coordinates can tell.
WorldBox grown(WorldBox box, double by);

/// Boxes, numbered in the order in which they came, and the pairs of them that overlap.
///
/// Each box has a cover, which is a box that contains it, and the pairs of covers that overlap are kept from one query
/// to the next. A box that stays within its cover costs a look at its pairs. Those that left it, and those that are
/// new, get new covers; a tree of these few covers finds their pairs with each other and with all others. That takes
/// O(c log c + n log c + pairs) for n boxes of which c got a cover, if they are small beside the space between them.
///
/// pairs() may be called by several threads at a time, and a copy made; a change must not happen meanwhile.
class BoxPairs {
 public:
  BoxPairs() = default;
  BoxPairs(const BoxPairs& other);
  BoxPairs& operator=(const BoxPairs&) = delete;

  /// Its number is that of all that were added before. \throws std::bad_alloc nothing has changed
  void add(const WorldBox& box);
  void move(std::size_t number, const WorldBox& box);
  void remove(std::size_t number);
  /// Closes the gaps that remove() left: the boxes that are there get the numbers from 0, in the same order.
  void renumber();

  bool contains(std::size_t number) const { return state_.changes[number] != Change::absent; }
  const WorldBox& box(std::size_t number) const { return state_.boxes[number]; }
  /// How many numbers are given, those of removed boxes included.
  std::size_t numbers() const { return state_.boxes.size(); }

  /// Every pair of boxes that overlap if each is grown by `by`, ascending, the lower number first.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs(double by);

 private:
  /// What happened to a box since the last query.
  enum class Change : std::uint8_t { none, moved, added, absent };
  /// Two boxes whose covers overlap, a < b.
  struct Pair {
    std::uint32_t a;
    std::uint32_t b;
    bool overlap;  ///< the boxes do, too
  };
  struct State {
    std::vector<WorldBox> boxes;
    std::vector<WorldBox> grown;  ///< by `by`; this and the next are of the last query
    std::vector<WorldBox> covers;
    std::vector<Change> changes;
    std::vector<Pair> pairs;  ///< ascending
    bool changed = false;     ///< any of the boxes
    double by = 0;
  };

  void update(double by);

  State state_;
  mutable std::mutex mutex_;  ///< of queries, which bring the pairs up to date
};

}  // namespace cchip

#endif
