// SPDX-License-Identifier: Apache-2.0
#include "box_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cchip {
namespace {

constexpr std::uint32_t most_in_leaf = 4;  // at least 2
/// A cover of a box that moves is larger by this part of its longest side, on each side: more room makes more pairs of
/// covers, less makes more covers.
constexpr double room = 0.0625;
/// All covers are made anew if more than 1 / whole_share of them must be.
constexpr std::size_t whole_share = 4;

using Numbers = std::pair<std::uint32_t, std::uint32_t>;

/// A tree of some of the boxes, by halves of the greatest spread of their middles.
class BoxTree {
 public:
  struct Item {
    WorldBox box;
    std::uint32_t number;
  };

  BoxTree(const std::vector<WorldBox>& boxes, const std::vector<std::uint32_t>& numbers) {
    if (numbers.empty()) return;
    places_.reserve(numbers.size());
    for (const std::uint32_t number : numbers) {
      const WorldBox& box = boxes[number];
      Place& place = places_.emplace_back(Place{{}, number});
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double middle = box.least[axis] / 2 + box.greatest[axis] / 2;
        constexpr double most = std::numeric_limits<float>::max();
        // 0 for a box without bounds
        place.middle[axis] = std::isnan(middle) ? 0 : static_cast<float>(std::max(-most, std::min(most, middle)));
      }
    }
    others_.resize(numbers.size());
    items_.reserve(numbers.size());
    nodes_.reserve(numbers.size());
    build(boxes, 0, static_cast<std::uint32_t>(numbers.size()));
  }

  /// Finds the pairs of the tree's boxes that overlap: descends the tree against itself.
  void find_pairs() {
    if (!nodes_.empty()) inside(0);
  }
  /// Finds the pairs of a box that is not in the tree.
  void find_pairs(const Item& item) {
    for (std::uint32_t at = 0; at < nodes_.size();) {
      const Node& node = nodes_[at];
      const bool meets = overlap(item.box, node.box);
      if (meets && node.second_child == 0) meet(item, node.first, node.end);
      at = meets ? at + 1 : node.next;
    }
  }
  /// What was found, the lower number first.
  const std::vector<Numbers>& pairs() const { return pairs_; }

 private:
  /// What the boxes are sorted by, small because it is moved about. Rounding changes the tree, not the answer.
  struct Place {
    std::array<float, 3> middle;
    std::uint32_t number;
  };
  /// Items first..end - 1. The first child follows its parent.
  struct Node {
    WorldBox box;
    std::uint32_t first;
    std::uint32_t end;
    std::uint32_t second_child;  ///< 0 for a leaf
    std::uint32_t next;          ///< the node after all that are below this one
  };

  static void add(WorldBox& box, const WorldBox& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.least[axis] = std::min(box.least[axis], other.least[axis]);
      box.greatest[axis] = std::max(box.greatest[axis], other.greatest[axis]);
    }
  }

  /// Reorders the places by what is below `middle` and what is not, and returns where the second part begins. Halves
  /// them by number instead where one part would be small, which bounds the depth of the tree.
  std::uint32_t divide(std::uint32_t first, std::uint32_t end, std::size_t axis, float middle) {
    std::uint32_t half = first;
    std::uint32_t others = 0;
    for (std::uint32_t i = first; i < end; ++i) {  // without branches, which would be mispredicted
      const Place place = places_[i];
      const bool below = place.middle[axis] < middle;
      places_[half] = place;
      others_[others] = place;
      half += below ? 1 : 0;
      others += below ? 0 : 1;
    }
    std::copy_n(others_.begin(), others, places_.begin() + half);
    if (std::min(half - first, others) >= 1 + (end - first) / 8) return half;
    half = first + (end - first) / 2;
    std::nth_element(places_.begin() + first, places_.begin() + half, places_.begin() + end,
                     [axis](const Place& p, const Place& q) { return p.middle[axis] < q.middle[axis]; });
    return half;
  }

  /// Leaves come in the order of their items, which are complete below a node when its box is made.
  std::uint32_t build(const std::vector<WorldBox>& boxes, std::uint32_t first, std::uint32_t end) {
    const auto at = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({{}, first, end, 0, at + 1});
    if (end - first <= most_in_leaf) {
      for (std::uint32_t i = first; i < end; ++i) {
        items_.push_back({boxes[places_[i].number], places_[i].number});
        if (i == first) nodes_[at].box = items_[i].box;
        add(nodes_[at].box, items_[i].box);
      }
      return at;
    }
    std::array<float, 3> least = places_[first].middle;
    std::array<float, 3> greatest = least;
    for (std::uint32_t i = first + 1; i < end; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        least[axis] = std::min(least[axis], places_[i].middle[axis]);
        greatest[axis] = std::max(greatest[axis], places_[i].middle[axis]);
      }
    }
    std::size_t widest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
      const auto spread = [&](std::size_t k) { return greatest[k] / 2 - least[k] / 2; };
      if (spread(axis) > spread(widest)) widest = axis;
    }
    const std::uint32_t half = divide(first, end, widest, least[widest] / 2 + greatest[widest] / 2);
    build(boxes, first, half);
    const std::uint32_t second = build(boxes, half, end);
    nodes_[at].second_child = second;
    nodes_[at].box = nodes_[at + 1].box;
    nodes_[at].next = nodes_[second].next;
    add(nodes_[at].box, nodes_[second].box);
    return at;
  }

  /// Pairs of items of one node.
  void inside(std::uint32_t at) {
    const Node& node = nodes_[at];
    if (node.second_child == 0) {
      for (std::uint32_t i = node.first; i < node.end; ++i) meet(items_[i], i + 1, node.end);
      return;
    }
    inside(at + 1);
    inside(node.second_child);
    between(at + 1, node.second_child);
  }

  /// Pairs of an item of one node and an item of another one.
  void between(std::uint32_t p_at, std::uint32_t q_at) {
    const Node& p = nodes_[p_at];
    const Node& q = nodes_[q_at];
    if (!overlap(p.box, q.box)) return;
    if (p.second_child == 0 && q.second_child == 0) {
      for (std::uint32_t i = p.first; i < p.end; ++i) meet(items_[i], q.first, q.end);
    } else if (q.second_child == 0 || (p.second_child != 0 && p.end - p.first > q.end - q.first)) {
      between(p_at + 1, q_at);
      between(p.second_child, q_at);
    } else {
      between(p_at, q_at + 1);
      between(p_at, q.second_child);
    }
  }

  void meet(const Item& item, std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t i = first; i < end; ++i) {
      if (overlap(item.box, items_[i].box)) pairs_.push_back(std::minmax(item.number, items_[i].number));
    }
  }

  std::vector<Place> places_;
  std::vector<Place> others_;  ///< of divide()
  std::vector<Item> items_;
  std::vector<Node> nodes_;
  std::vector<Numbers> pairs_;
};

/// Sorts pairs of numbers below `count`. They are dealt out by their lower number, and only the few of one number are
/// sorted: O(count + pairs), about.
std::vector<Numbers> sorted(const std::vector<Numbers>& pairs, std::size_t count) {
  std::vector<std::size_t> next(count);  // where the next pair of a number goes
  for (const Numbers& pair : pairs) ++next[pair.first];
  std::size_t sum = 0;
  for (std::size_t& place : next) sum += std::exchange(place, sum);
  std::vector<Numbers> result(pairs.size());
  for (const Numbers& pair : pairs) result[next[pair.first]++] = pair;
  auto first = result.begin();
  for (const std::size_t place : next) {  // where they end now
    const auto end = result.begin() + static_cast<std::ptrdiff_t>(place);
    std::sort(first, end);
    first = end;
  }
  return result;
}

bool holds(const WorldBox& outer, const WorldBox& inner) {
  bool out = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out |= inner.least[axis] < outer.least[axis];
    out |= inner.greatest[axis] > outer.greatest[axis];
  }
  return !out;
}

/// The cover of a box that moves: it leaves room on all sides for the next steps.
WorldBox roomy(WorldBox box) {
  double side = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double length = box.greatest[axis] - box.least[axis];
    if (std::isfinite(length)) side = std::max(side, length);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.least[axis] -= room * side;
    box.greatest[axis] += room * side;
  }
  return box;
}

}  // namespace

WorldBox grown(WorldBox box, double by) {
  if (by == 0) return box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.least[axis] = std::nextafter(box.least[axis] - by, -std::numeric_limits<double>::infinity());
    box.greatest[axis] = std::nextafter(box.greatest[axis] + by, std::numeric_limits<double>::infinity());
  }
  return box;
}

BoxPairs::BoxPairs(const BoxPairs& other) {
  const std::lock_guard<std::mutex> lock(other.mutex_);
  state_ = other.state_;
}

void BoxPairs::add(const WorldBox& box) {
  state_.boxes.push_back(box);
  try {
    state_.changes.push_back(Change::added);
  } catch (...) {
    state_.boxes.pop_back();
    throw;
  }
  state_.changed = true;
}

void BoxPairs::move(std::size_t number, const WorldBox& box) {
  state_.boxes[number] = box;
  if (state_.changes[number] == Change::none) state_.changes[number] = Change::moved;
  state_.changed = true;
}

void BoxPairs::remove(std::size_t number) {
  state_.changes[number] = Change::absent;
  state_.changed = true;
}

void BoxPairs::renumber() {
  std::size_t count = 0;
  for (std::size_t i = 0; i < numbers(); ++i) {
    if (!contains(i)) continue;
    state_.boxes[count] = state_.boxes[i];
    state_.changes[count++] = Change::added;
  }
  state_.boxes.resize(count);
  state_.changes.resize(count);
  state_.pairs.clear();
  state_.changed = true;
}

std::vector<Numbers> BoxPairs::pairs(double by) {
  const std::lock_guard<std::mutex> lock(mutex_);
  update(by);
  std::vector<Numbers> result;
  result.reserve(state_.pairs.size());
  for (const Pair& pair : state_.pairs) {
    if (pair.overlap) result.emplace_back(pair.a, pair.b);
  }
  return result;
}

void BoxPairs::update(double by) {
  State& s = state_;
  bool whole = !(by == s.by);
  if (!whole && !s.changed) return;
  s.by = std::numeric_limits<double>::quiet_NaN();  // all anew next time if something throws
  const std::size_t count = numbers();
  s.grown.resize(count);
  s.covers.resize(count);
  enum : std::uint8_t { keep, test, drop };  // what to do with the old pairs of a box
  std::vector<std::uint8_t> actions(count, keep);
  std::vector<std::uint32_t> present;
  std::vector<std::uint32_t> fresh;  // those that get a new cover
  present.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (s.changes[i] == Change::absent) {
      actions[i] = drop;
      continue;
    }
    present.push_back(i);
    if (s.changes[i] == Change::none && !whole) continue;
    actions[i] = test;
    s.grown[i] = grown(s.boxes[i], by);
    if (s.changes[i] == Change::moved && holds(s.covers[i], s.grown[i])) continue;
    actions[i] = drop;
    fresh.push_back(i);
  }
  if (whole || fresh.size() > present.size() / whole_share) {  // one descent of a tree of all takes less
    whole = true;
    fresh = present;
    s.pairs.clear();
  }

  for (const std::uint32_t i : fresh) s.covers[i] = s.changes[i] == Change::moved ? roomy(s.grown[i]) : s.grown[i];
  BoxTree tree(s.covers, fresh);
  tree.find_pairs();
  if (!whole && !fresh.empty()) {
    for (const std::uint32_t i : present) {
      if (actions[i] != drop) tree.find_pairs({s.covers[i], i});
    }
  }
  const std::vector<Numbers> found = sorted(tree.pairs(), count);

  const auto overlapping = [&s](std::uint32_t a, std::uint32_t b) { return overlap(s.grown[a], s.grown[b]); };
  std::size_t kept = 0;
  for (Pair pair : s.pairs) {
    const std::uint8_t action = std::max(actions[pair.a], actions[pair.b]);
    if (action == drop) continue;
    if (action == test) pair.overlap = overlapping(pair.a, pair.b);
    s.pairs[kept++] = pair;
  }
  s.pairs.resize(kept + found.size());
  std::size_t place = s.pairs.size();
  for (auto next = found.rbegin(); next != found.rend();) {  // merges from the back
    const bool old_is_later = kept > 0 && *next < Numbers(s.pairs[kept - 1].a, s.pairs[kept - 1].b);
    s.pairs[--place] =
        old_is_later ? s.pairs[--kept] : Pair{next->first, next->second, overlapping(next->first, next->second)};
    if (!old_is_later) ++next;
  }
  for (const std::uint32_t i : present) s.changes[i] = Change::none;
  s.changed = false;
  s.by = by;
}

}  // namespace cchip
