// SPDX-License-Identifier: Apache-2.0
#include "box_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cchip {
namespace {

constexpr std::uint32_t most_in_leaf = 4;

class BoxTree {
 public:
  BoxTree(const std::vector<WorldBox>& boxes, const std::function<void(std::uint32_t, std::uint32_t)>& visit)
      : visit_(visit) {
    items_.reserve(boxes.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      Item& item = items_.emplace_back(Item{boxes[i], {}, i});
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double middle = boxes[i].least[axis] / 2 + boxes[i].greatest[axis] / 2;
        item.middle[axis] = std::isnan(middle) ? 0 : middle;  // of a box without bounds
      }
    }
    if (!items_.empty()) build(0, static_cast<std::uint32_t>(items_.size()));
  }

  void visit_all() const {
    if (!nodes_.empty()) inside(0);
  }

 private:
  struct Item {
    WorldBox box;
    std::array<double, 3> middle;
    std::uint32_t number;
  };
  /// Items first..end - 1. The first child follows its parent.
  struct Node {
    WorldBox box;
    std::uint32_t first;
    std::uint32_t end;
    std::uint32_t second_child;  ///< 0 for a leaf
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t end) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Node node = {{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}}, first, end, 0};
    WorldBox middles = node.box;
    for (std::uint32_t i = first; i < end; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Item& item = items_[i];
        node.box.least[axis] = std::min(node.box.least[axis], item.box.least[axis]);
        node.box.greatest[axis] = std::max(node.box.greatest[axis], item.box.greatest[axis]);
        middles.least[axis] = std::min(middles.least[axis], item.middle[axis]);
        middles.greatest[axis] = std::max(middles.greatest[axis], item.middle[axis]);
      }
    }
    const auto at = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(node);
    if (end - first <= most_in_leaf) return at;
    std::size_t widest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
      const auto spread = [&middles](std::size_t k) { return middles.greatest[k] - middles.least[k]; };
      if (spread(axis) > spread(widest)) widest = axis;
    }
    const std::uint32_t half = first + (end - first) / 2;
    std::nth_element(items_.begin() + first, items_.begin() + half, items_.begin() + end,
                     [widest](const Item& p, const Item& q) { return p.middle[widest] < q.middle[widest]; });
    build(first, half);
    const std::uint32_t second = build(half, end);
    nodes_[at].second_child = second;
    return at;
  }

  /// Pairs of items of one node.
  void inside(std::uint32_t at) const {
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
  void between(std::uint32_t p_at, std::uint32_t q_at) const {
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

  void meet(const Item& item, std::uint32_t first, std::uint32_t end) const {
    for (std::uint32_t i = first; i < end; ++i) {
      if (overlap(item.box, items_[i].box)) visit_(item.number, items_[i].number);
    }
  }

  const std::function<void(std::uint32_t, std::uint32_t)>& visit_;
  std::vector<Item> items_;
  std::vector<Node> nodes_;
};

}  // namespace

void visit_box_pairs(const std::vector<WorldBox>& boxes,
                     const std::function<void(std::uint32_t, std::uint32_t)>& visit) {
  BoxTree(boxes, visit).visit_all();
}

}  // namespace cchip
