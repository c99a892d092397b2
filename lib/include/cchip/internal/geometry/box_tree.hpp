// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which of many boxes overlap one?
#ifndef CCHIP_INTERNAL_GEOMETRY_BOX_TREE_HPP
#define CCHIP_INTERNAL_GEOMETRY_BOX_TREE_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace cchip {

/// A closed box in D dimensions; empty until something is added.
template <std::size_t D>
struct AxisBox {
  std::array<double, D> low = filled(std::numeric_limits<double>::infinity());
  std::array<double, D> high = filled(-std::numeric_limits<double>::infinity());
  void add(const AxisBox& x) {
    for (std::size_t k = 0; k < D; ++k) {
      low[k] = std::min(low[k], x.low[k]);
      high[k] = std::max(high[k], x.high[k]);
    }
  }
  bool overlaps(const AxisBox& x) const {
    for (std::size_t k = 0; k < D; ++k) {
      if (!(low[k] <= x.high[k] && x.low[k] <= high[k])) return false;
    }
    return true;
  }

 private:
  static std::array<double, D> filled(double value) {
    std::array<double, D> result;
    result.fill(value);
    return result;
  }
};

/// Boxes in a binary tree: halves by where they begin on the longest axis. No entry is NaN.
template <std::size_t D>
class BoxTree {
 public:
  explicit BoxTree(std::vector<AxisBox<D>> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (order_.empty()) return;
    nodes_.reserve(2 * order_.size() / most + 1);
    build(0, order_.size());
  }

  const AxisBox<D>& box(std::size_t number) const { return boxes_[number]; }

  /// Calls visit(number) for each box that overlaps the given one.
  template <class Visit>
  void for_each_overlap(const AxisBox<D>& with, const Visit& visit) const {
    if (!nodes_.empty()) descend(0, with, visit);
  }
  /// Calls visit(number here, number there) for each pair of boxes that overlap.
  template <class Visit>
  void for_each_overlap(const BoxTree& other, const Visit& visit) const {
    if (!nodes_.empty() && !other.nodes_.empty()) descend(0, other, 0, visit);
  }

 private:
  static constexpr std::size_t most = 4;  ///< boxes of a leaf

  struct Node {
    AxisBox<D> box;
    std::size_t begin;
    std::size_t end;
    std::size_t second = 0;  ///< the first child follows its parent; 0: a leaf
    bool is_leaf() const { return second == 0; }
    std::size_t size() const { return end - begin; }
  };

  std::size_t build(std::size_t begin, std::size_t end) {
    const std::size_t at = nodes_.size();
    nodes_.push_back({{}, begin, end});
    AxisBox<D> all;
    for (std::size_t i = begin; i < end; ++i) all.add(boxes_[order_[i]]);
    nodes_[at].box = all;
    if (end - begin <= most) return at;
    std::size_t axis = 0;
    for (std::size_t k = 1; k < D; ++k) {
      if (all.high[k] - all.low[k] > all.high[axis] - all.low[axis]) axis = k;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    const auto first = order_.begin();
    std::nth_element(first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(middle),
                     first + static_cast<std::ptrdiff_t>(end), [this, axis](std::uint32_t i, std::uint32_t k) {
                       return boxes_[i].low[axis] < boxes_[k].low[axis];
                     });
    build(begin, middle);
    const std::size_t second = build(middle, end);
    nodes_[at].second = second;
    return at;
  }

  template <class Visit>
  void descend(std::size_t at, const AxisBox<D>& with, const Visit& visit) const {
    const Node& node = nodes_[at];
    if (!node.box.overlaps(with)) return;
    if (!node.is_leaf()) {
      descend(at + 1, with, visit);
      descend(node.second, with, visit);
      return;
    }
    for (std::size_t i = node.begin; i < node.end; ++i) {
      if (boxes_[order_[i]].overlaps(with)) visit(order_[i]);
    }
  }

  template <class Visit>
  void descend(std::size_t at, const BoxTree& other, std::size_t at_other, const Visit& visit) const {
    const Node& p = nodes_[at];
    const Node& q = other.nodes_[at_other];
    if (!p.box.overlaps(q.box)) return;
    if (p.is_leaf() && q.is_leaf()) {
      for (std::size_t i = p.begin; i < p.end; ++i) {
        const std::uint32_t number = order_[i];
        for (std::size_t k = q.begin; k < q.end; ++k) {
          const std::uint32_t number_there = other.order_[k];
          if (boxes_[number].overlaps(other.boxes_[number_there])) visit(number, number_there);
        }
      }
    } else if (q.is_leaf() || (!p.is_leaf() && p.size() >= q.size())) {
      descend(at + 1, other, at_other, visit);
      descend(p.second, other, at_other, visit);
    } else {
      descend(at, other, at_other + 1, visit);
      descend(at, other, q.second, visit);
    }
  }

  std::vector<AxisBox<D>> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace cchip

#endif
