// SPDX-License-Identifier: Apache-2.0
/// \file
/// A tree of boxes over the points of a cloud.
#ifndef CCHIP_SEARCH_POINT_TREE_HPP
#define CCHIP_SEARCH_POINT_TREE_HPP

#include <array>
#include <cchip/primitive.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cchip {

/// Points in blocks of 16, which are the leaves, and nodes of up to eight children over them. A node is the box of the
/// centres below it and the greatest of their radii; a radius is in units of the world, so no box of a frame can hold
/// it.
struct PointTree {
  static constexpr std::size_t lanes = 8;
  static constexpr std::size_t block = 16;
  /// A query that goes down by one level keeps at most `lanes` - 1 nodes for later.
  static constexpr std::size_t depth_most = 12;

  struct Child {
    static constexpr std::uint32_t leaf_bit = std::uint32_t{1} << 31U;
    std::uint32_t bits = 0;
    bool is_leaf() const { return (bits & leaf_bit) != 0; }
    std::uint32_t number() const { return bits & ~leaf_bit; }  ///< of a block or a node
  };
  using Lanes = std::array<double, lanes>;
  struct Node {
    std::array<Lanes, 3> centre = {};  ///< of the children's boxes, rounded
    std::array<Lanes, 3> half = {};    ///< from there to the farther side, rounded
    Lanes radius = {};
    std::array<Child, lanes> child = {};
    std::uint32_t count = 0;  ///< of children
  };

  PointTree(const std::vector<Vec3d>& points, const double* radii, std::size_t radii_step);

  std::size_t points = 0;
  std::vector<Node> nodes;  ///< the first one has one child: all points. Empty without points
  /// Of all points, block by block; the last block is filled up with copies of the last point.
  std::array<std::vector<double>, 3> at;
  std::vector<double> radius;
  std::vector<std::uint32_t> number;
  Vec3d greatest = Vec3d::Zero();  ///< magnitude of each coordinate
  double greatest_radius = 0;
};

}  // namespace cchip

#endif
