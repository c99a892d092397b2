// SPDX-License-Identifier: Apache-2.0
/// \file
/// The box test: which children of a node of A may meet which children of a node of B.
///
/// All quantities are in half steps of the pair's own grid, a power of two that is A's step unless B's is much coarser.
/// All roundings are floors. One slack per node pair, added to the corners of B's boxes, covers all of them
/// (docs/hardware/image.md, "Box test").
#ifndef CCHIP_INTERNAL_MODEL_BOX_TEST_HPP
#define CCHIP_INTERNAL_MODEL_BOX_TEST_HPP

#include <array>
#include <cchip/internal/image/image_line.hpp>
#include <cchip/internal/model/pose_setup.hpp>
#include <cstdint>

namespace cchip::model {

/// A node pair placed on its grid.
struct NodeGrid {
  /// log2 (grid step / step) for A and for B, and whether a box counts as a point because it is so much smaller than a
  /// step that the slack covers it.
  int x = 0;  ///< 0, 2, 4, or more and a_is_point
  int y = 0;  ///< -1..5, or more and b_is_point
  bool a_is_point = false;
  bool b_is_point = false;
  /// Cuts of nodes that are much finer than the grid are left out.
  bool use_a_cuts = true;
  bool use_b_cuts = true;
  /// M o_A + t - o_B, half steps with 6 fraction bits.
  std::array<std::int64_t, 3> offset = {};
  std::int64_t slack = 0;  ///< quarters of a half step, 0..255
  bool far = false;        ///< the offset alone separates every child
  bool near = false;       ///< the slack does not fit: nothing is separated
};

inline constexpr int offset_w = 17;  ///< bits of NodeGrid::offset; what does not fit is far
inline constexpr int slack_max = 255;

/// Planes of a child on the directions of B: half steps with 1 fraction bit.
struct Planes {
  std::array<std::int64_t, bvh::directions.size()> upper;
  std::array<std::int64_t, bvh::directions.size()> lower;
};
Planes planes_of_a(const bvh::InnerLine& node, std::size_t child, const PoseSetup& pose, const NodeGrid& grid);
Planes planes_of_b(const bvh::InnerLine& node, std::size_t child, const NodeGrid& grid);

NodeGrid grid_of(const bvh::InnerLine& a, const bvh::InnerLine& b, const PoseSetup& pose);

/// Child pair (i, j), i of A, has number 4 i + j.
struct BoxVerdict {
  std::uint16_t overlap = 0;              ///< bit of each child pair that is not separated
  std::array<std::uint8_t, 16> key = {};  ///< least overlap over the directions, 0..15, of these
};

BoxVerdict test_boxes(const bvh::InnerLine& a, const bvh::InnerLine& b, const PoseSetup& pose, const NodeGrid& grid);

/// Key from which on a child pair overlaps well: it is likely to hold a contact.
inline constexpr std::uint8_t strong_key = 8;

/// What becomes of the child pairs of a node pair; bit 4 i + j is child pair (i, j).
struct ChildPairs {
  std::uint16_t counted = 0;  ///< compared
  std::uint16_t waiting = 0;  ///< overlap, and at least one of the two is an inner node
  std::uint16_t leaves = 0;   ///< overlap, and both are leaves
  std::uint16_t strong = 0;   ///< of `waiting`: with at least strong_key
  unsigned best = 0;          ///< of `waiting`: number of the greatest key, the first of equals
};

/// \param children_a, children_b bit of each child that counts; bits beyond the children of the node are ignored
ChildPairs sort_children(const bvh::InnerLine& a, unsigned children_a, const bvh::InnerLine& b, unsigned children_b,
                         const BoxVerdict& verdict);

}  // namespace cchip::model

#endif
