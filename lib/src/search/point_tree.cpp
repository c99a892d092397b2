// SPDX-License-Identifier: Apache-2.0
#include "point_tree.hpp"

#include <algorithm>

namespace cchip {
namespace {

struct Point {
  Vec3d at;
  double radius;
  std::uint32_t number;
};

/// Blocks begin..end - 1.
struct Range {
  std::size_t begin;
  std::size_t end;
  std::size_t size() const { return end - begin; }
};

class Builder {
 public:
  Builder(PointTree& tree, std::vector<Point>& points) : tree_(tree), points_(points) {}

  void run() {
    const Range all = {0, (points_.size() + PointTree::block - 1) / PointTree::block};
    tree_.nodes.emplace_back();
    tree_.nodes[0].count = 1;
    add_child(0, 0, all);
  }

 private:
  std::size_t first_point(std::size_t block) const { return std::min(block * PointTree::block, points_.size()); }

  void add_child(std::size_t node, std::size_t lane, Range range) {
    Vec3d least = points_[first_point(range.begin)].at;
    Vec3d greatest = least;
    double radius = 0;
    for (std::size_t i = first_point(range.begin); i < first_point(range.end); ++i) {
      least = least.cwiseMin(points_[i].at);
      greatest = greatest.cwiseMax(points_[i].at);
      radius = std::max(radius, points_[i].radius);
    }
    PointTree::Node& parent = tree_.nodes[node];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      const double centre = least[axis] / 2 + greatest[axis] / 2;
      parent.centre[k][lane] = centre;
      parent.half[k][lane] = std::max(greatest[axis] - centre, centre - least[axis]);
    }
    parent.radius[lane] = radius;
    if (range.size() == 1) {
      parent.child[lane].bits = static_cast<std::uint32_t>(range.begin) | PointTree::Child::leaf_bit;
      return;
    }
    const std::size_t child = tree_.nodes.size();
    parent.child[lane].bits = static_cast<std::uint32_t>(child);
    tree_.nodes.emplace_back();  // `parent` is invalid from here on
    std::array<Range, PointTree::lanes> parts;
    std::size_t count = 1;
    parts[0] = range;
    while (count < PointTree::lanes) {
      std::size_t largest = 0;
      for (std::size_t i = 1; i < count; ++i) {
        if (parts[i].size() > parts[largest].size()) largest = i;
      }
      if (parts[largest].size() == 1) break;
      const std::size_t middle = split(parts[largest]);
      parts[count++] = {middle, parts[largest].end};
      parts[largest].end = middle;
    }
    tree_.nodes[child].count = static_cast<std::uint32_t>(count);
    for (std::size_t i = 0; i < count; ++i) add_child(child, i, parts[i]);
  }

  /// Sorts the points to both sides of the middle along the longest side of their box. \returns the first block behind
  std::size_t split(Range range) {
    const std::size_t begin = first_point(range.begin);
    const std::size_t end = first_point(range.end);
    Vec3d least = points_[begin].at;
    Vec3d greatest = least;
    for (std::size_t i = begin; i < end; ++i) {
      least = least.cwiseMin(points_[i].at);
      greatest = greatest.cwiseMax(points_[i].at);
    }
    Eigen::Index axis = 0;
    (greatest - least).maxCoeff(&axis);
    const std::size_t middle = range.begin + (range.size() + 1) / 2;
    const auto place = [this](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(place(begin), place(first_point(middle)), place(end), [axis](const Point& p, const Point& q) {
      return p.at[axis] != q.at[axis] ? p.at[axis] < q.at[axis] : p.number < q.number;
    });
    return middle;
  }

  PointTree& tree_;
  std::vector<Point>& points_;
};

}  // namespace

PointTree::PointTree(const std::vector<Vec3d>& given, const double* radii, std::size_t radii_step)
    : points(given.size()) {
  if (given.empty()) return;
  std::vector<Point> order(given.size());
  for (std::size_t i = 0; i < given.size(); ++i) {
    order[i] = {given[i], radii[i * radii_step], static_cast<std::uint32_t>(i)};
    greatest = greatest.cwiseMax(given[i].cwiseAbs());
    greatest_radius = std::max(greatest_radius, order[i].radius);
  }
  Builder(*this, order).run();
  const std::size_t padded = (points + block - 1) / block * block;
  for (std::vector<double>& coordinates : at) coordinates.resize(padded);
  radius.resize(padded);
  number.resize(padded);
  for (std::size_t i = 0; i < padded; ++i) {
    const Point& p = order[std::min(i, points - 1)];
    for (std::size_t k = 0; k < 3; ++k) at[k][i] = p.at[static_cast<Eigen::Index>(k)];
    radius[i] = p.radius;
    number[i] = p.number;
  }
}

}  // namespace cchip
