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

#include "simd_distance.hpp"
#include "tree_side.hpp"

namespace cchip {

/// How far nodes reach along a vector m of their object's frame, from the object's centre: a sum of three words times a
/// factor each, since m is a sum of three directions of the words.
class LineReach {
 public:
  LineReach() = default;
  LineReach(const Vec3d& m, double unit);
  /// The greatest of m . (x - centre), at most, up to the rounding of this line.
  double along(const bvh::SupportLine& line) const { return sum(along_, line); }
  /// The same for -m.
  double against(const bvh::SupportLine& line) const { return sum(against_, line); }
  /// As a lane of a side: `along`, or against.
  void store(bool along, double scale, std::size_t lane, simd::FrameSide& side) const;

 private:
  using Words = std::array<std::uint8_t, 3>;
  double sum(const Words& words, const bvh::SupportLine& line) const {
    return factor_[0] * line.word[words[0]] + factor_[1] * line.word[words[1]] + factor_[2] * line.word[words[2]];
  }
  std::array<double, 3> factor_ = {};
  Words along_ = {};
  Words against_ = {};
};

/// The sets of two nodes are at least as far apart as the root of the sum of the squares of their gaps along three axes
/// that are orthogonal, nearly. With the line between the nearest points as one axis that is close to the distance, for
/// nodes that face each other and for those aside. Bounds hold in spite of rounding: docs/cpp/exactness.md.
class FrameGap {
 public:
  static constexpr std::size_t axes = 3;
  /// How far a set reaches along the axes and against them, from the centre of its object.
  struct Reach {
    std::array<double, axes> along = {};
    std::array<double, axes> against = {};
  };
  /// Gaps along another axis of the world.
  struct Line;

  /// The axes are those of the world until set_axis() chooses others.
  FrameGap(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b);

  /// False: the numbers are so great or so small that nothing is known, and gaps are 0.
  bool is_moderate() const { return is_moderate_; }
  /// One axis is along `axis`, of any length; a zero vector is refused, and the axes stay.
  void set_axis(const Vec3d& axis);

  Reach reach_a(const bvh::SupportLine& line) const { return reach(a_, line); }
  Reach reach_b(const bvh::SupportLine& line) const { return reach(b_, line); }
  Reach reach_a(const Primitive& p) const { return reach(a_, p); }
  Reach reach_b(const Primitive& p) const { return reach(b_, p); }
  static Reach enclose(const Reach& x, const Reach& y);

  /// The same axes in single precision.
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

  /// The axes times these numbers.
  Vec3d in_world(const Vec3d& along_axes) const { return axes_ * along_axes; }

  /// At most the distance in the world of the sets; at least 0.
  double operator()(const Reach& a, const Reach& b) const {
    if (!is_moderate_) return 0;
    double sum = 0;
    for (std::size_t i = 0; i < axes; ++i) {
      const double before = offset_[i] - (a.along[i] + b.against[i]);
      const double behind = -offset_[i] - (a.against[i] + b.along[i]);
      const double gap = (before > behind ? before : behind) - slack_[i];
      sum += gap > 0 ? gap * gap : 0;
    }
    return std::sqrt(sum) * scale_;
  }

  /// In the world, rounded and relative to one point: the middle of what the lines contain.
  Vec3d middle_a(const bvh::SupportLine* lines, std::size_t count) const { return middle(a_, lines, count); }
  Vec3d middle_b(const bvh::SupportLine* lines, std::size_t count) const { return between_ + middle(b_, lines, count); }

  /// \param axis leads from A to B, of any length
  Line line(const Vec3d& axis) const;
  static double reach_a(const Line& line, const bvh::SupportLine& node);
  static double reach_b(const Line& line, const bvh::SupportLine& node);
  /// At most the distance of sets with these reaches along the line; at least 0.
  static double gap(const Line& line, double reach_a, double reach_b);

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
    std::array<double, axes> m_centre = {};
    std::array<LineReach, axes> reach;
  };

  static Reach reach(const Side& side, const bvh::SupportLine& line);
  static FrameSlab slab(const Side& side, const bvh::SupportLine& line,
                        const std::array<float, simd::reach_lanes>& reach, int sign);
  static Reach reach(const Side& side, const Primitive& p);
  static Vec3d middle(const Side& side, const bvh::SupportLine* lines, std::size_t count);
  double slack(const Vec3d& axis) const;

  Side a_;
  Side b_;
  Vec3d between_;         ///< translation of B relative to A
  Vec3d centre_between_;  ///< centre of B relative to that of A
  double size_;
  bool is_moderate_;
  std::array<double, axes> offset_ = {};
  std::array<double, axes> slack_ = {};
  double scale_ = 0;  ///< from the root of the sum of squares to the bound
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();
  Vec3d offset_in_frame_ = Vec3d::Zero();
};

struct FrameGap::Line {
  LineReach a;
  LineReach b;
  double offset = 0;      ///< of the centres, less what rounding may cost
  double per_length = 0;  ///< 1 / length of the axis, at most; 0: nothing is known
};

inline double FrameGap::reach_a(const Line& line, const bvh::SupportLine& node) { return line.a.along(node); }
inline double FrameGap::reach_b(const Line& line, const bvh::SupportLine& node) { return line.b.against(node); }
inline double FrameGap::gap(const Line& line, double reach_a, double reach_b) {
  const double gap = (line.offset - reach_a - reach_b) * line.per_length;
  return gap > 0 ? gap : 0;
}

}  // namespace cchip

#endif
