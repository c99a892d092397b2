// SPDX-License-Identifier: Apache-2.0
/// \file
/// Bounds on the distance of nodes of two objects: gaps along the three axes of a frame that is free to choose.
#ifndef CCHIP_SEARCH_FRAME_GAP_HPP
#define CCHIP_SEARCH_FRAME_GAP_HPP

#include <array>
#include <cchip/internal/tree/support_tree.hpp>
#include <cchip/object.hpp>
#include <cchip/pose.hpp>
#include <cchip/primitive.hpp>
#include <cmath>
#include <cstdint>

#include "line_reach.hpp"
#include "simd_distance.hpp"
#include "tree_side.hpp"

namespace cchip {

/// The sets of two nodes are at least as far apart as the root of the sum of the squares of their gaps along three axes
/// that are orthogonal, nearly. With the line between the nearest points as one axis that is close to the distance, for
/// nodes that face each other and for those aside. Bounds hold in spite of rounding: docs/cpp/exactness.md.
class FrameGap {
 public:
  static constexpr std::size_t axes = 3;
  /// The axes are those of the world until set_axis() chooses others.
  FrameGap(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b);

  /// One axis is along `axis`, of any length; a zero vector is refused, and the axes stay.
  void set_axis(const Vec3d& axis);

  /// The axes in single precision.
  /// \returns the length in the world of a unit of the frame
  double in_single(simd::DistanceFrame& frame);
  /// A slab in the coordinates of the last call of in_single(): for all points x below the node, from the centre of its
  /// object, -against <= normal . x <= along.
  struct FrameSlab {
    Vec3d normal = Vec3d::Zero();
    double along = 0;
    double against = 0;
    Vec3d middle = Vec3d::Zero();  ///< of the node's box in the frame
    Vec3d half = Vec3d::Zero();
  };
  /// \param reach of the node, as DistanceKernels::nodes has it; lanes of B are along the opposite directions
  FrameSlab slab_a(const bvh::SupportLine& line, const std::array<float, simd::reach_lanes>& reach) const {
    return slab(a_, line, reach, 1);
  }
  FrameSlab slab_b(const bvh::SupportLine& line, const std::array<float, simd::reach_lanes>& reach) const {
    return slab(b_, line, reach, -1);
  }
  /// At most the distance of the nodes in units of the frame, by both slabs; may be negative.
  double slab_gap(const FrameSlab& a, const FrameSlab& b) const;

  /// What the rounding of words may take from a gap.
  double resolution() const { return 4 * (a_.stretch * a_.unit + b_.stretch * b_.unit); }
  /// About how far apart two nodes are along an axis of the world that leads from A to B; may be negative.
  double rough_gap(const Vec3d& axis, const bvh::SupportLine& line_a, const bvh::SupportLine& line_b) const;
  /// Across a face, in the world, of any length and on either side.
  Vec3d normal_a(const Primitive& face) const { return normal(a_, face); }
  Vec3d normal_b(const Primitive& face) const { return normal(b_, face); }

  /// The axes times these numbers.
  Vec3d in_world(const Vec3d& along_axes) const { return axes_ * along_axes; }

  /// In the world, rounded and relative to one point: the middle of what the lines contain.
  Vec3d middle_a(const bvh::SupportLine* lines, std::size_t count) const { return middle(a_, lines, count); }
  Vec3d middle_b(const bvh::SupportLine* lines, std::size_t count) const { return between_ + middle(b_, lines, count); }

 private:
  struct Side {
    Side(const Object& object, const Pose& pose);
    Eigen::Matrix3d linear;
    Vec3d centre;        ///< in the object's frame
    Vec3d world_centre;  ///< under the linear map, rounded
    double stretch;      ///< bound on the length of what a unit vector becomes
    double unit;
    double size;  ///< bound on the sum of the magnitudes that are added up for a coordinate of a point under the map
    Eigen::Matrix3d dual;   ///< from normals to those in the frame of in_single()
    double dual_slack = 0;  ///< on heights, for the rounding of that; infinite: there is none
    std::array<Vec3d, axes> m;
    std::array<LineReach, axes> reach;
  };

  static FrameSlab slab(const Side& side, const bvh::SupportLine& line,
                        const std::array<float, simd::reach_lanes>& reach, int sign);
  static Vec3d normal(const Side& side, const Primitive& face) {
    return (side.linear * (face.v[1] - face.v[0])).cross(side.linear * (face.v[2] - face.v[0]));
  }
  static Vec3d middle(const Side& side, const bvh::SupportLine* lines, std::size_t count);
  double slack(const Vec3d& axis) const;

  Side a_;
  Side b_;
  Vec3d between_;         ///< translation of B relative to A
  Vec3d centre_between_;  ///< centre of B relative to that of A
  double size_;
  bool is_moderate_;  ///< false: the numbers are so great or so small that nothing is known, and gaps are 0
  std::array<double, axes> offset_ = {};
  std::array<double, axes> slack_ = {};
  double scale_ = 0;  ///< from the root of the sum of squares to the bound
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();
  Vec3d offset_in_frame_ = Vec3d::Zero();
};

}  // namespace cchip

#endif
