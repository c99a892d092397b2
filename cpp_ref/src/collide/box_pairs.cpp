// SPDX-License-Identifier: Apache-2.0
#include "box_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cchip {
namespace {

constexpr std::uint32_t most_in_leaf = 4;  // at least 2

class BoxTree {
 public:
  explicit BoxTree(const std::vector<WorldBox>& boxes) {
    if (boxes.empty()) return;
    places_.reserve(boxes.size());
    for (const WorldBox& box : boxes) {
      Place& place = places_.emplace_back(Place{{}, static_cast<std::uint32_t>(places_.size())});
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double middle = box.least[axis] / 2 + box.greatest[axis] / 2;
        constexpr double most = std::numeric_limits<float>::max();
        // 0 for a box without bounds
        place.middle[axis] = std::isnan(middle) ? 0 : static_cast<float>(std::max(-most, std::min(most, middle)));
      }
    }
    others_.resize(boxes.size());
    items_.reserve(boxes.size());
    nodes_.reserve(boxes.size());
    build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
  }

  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs() {
    if (!nodes_.empty()) inside(0);
    return std::move(pairs_);
  }

 private:
  /// What the boxes are sorted by, small because it is moved about. Rounding changes the tree, not the answer.
  struct Place {
    std::array<float, 3> middle;
    std::uint32_t number;
  };
  struct Item {
    WorldBox box;
    std::uint32_t number;
  };
  /// Items first..end - 1. The first child follows its parent.
  struct Node {
    WorldBox box;
    std::uint32_t first;
    std::uint32_t end;
    std::uint32_t second_child;  ///< 0 for a leaf
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
    nodes_.push_back({{}, first, end, 0});
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
      if (overlap(item.box, items_[i].box)) pairs_.emplace_back(item.number, items_[i].number);
    }
  }

  std::vector<Place> places_;
  std::vector<Place> others_;  ///< of divide()
  std::vector<Item> items_;
  std::vector<Node> nodes_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
};

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> box_pairs(const std::vector<WorldBox>& boxes) {
  return BoxTree(boxes).pairs();
}

}  // namespace cchip
