// SPDX-License-Identifier: Apache-2.0
#include "frame_gap.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exact/ieee.hpp"

namespace cchip {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double unit_roundoff = 0x1p-53;

/// Bound on the length of what a unit vector becomes.
double stretch_of(const Eigen::Matrix3d& linear) {
  const double greatest = linear.cwiseAbs().maxCoeff();
  if (!(greatest > 0 && greatest < infinity)) return greatest;
  const Eigen::Matrix3d m = linear / greatest;
  return greatest * std::sqrt((m.transpose() * m).cwiseAbs().rowwise().sum().maxCoeff()) * (1 + 0x1p-40);
}

}  // namespace

template <>
void BasicLineReach<double>::store(bool along, double scale, std::size_t lane, simd::FrameSide& side) const {
  const Words& words = along ? along_ : against_;
  // Both bytes of a word within the 16 bytes where it lies.
  const auto bytes = [](std::size_t word) { return static_cast<std::uint16_t>(0x0100U + 0x0202U * (word % 8)); };
  constexpr std::uint16_t none = 0x8080;
  const bool is_high = words[1] >= bvh::first_face_word + 8;
  side.axis[lane] = bytes(words[0]);
  side.face_low[lane] = is_high ? none : bytes(words[1]);
  side.face_high[lane] = is_high ? bytes(words[1]) : none;
  side.corner[lane] = bytes(words[2]);
  side.axis_factor[lane] = static_cast<float>(factor_[0] * scale);
  side.face_factor[lane] = static_cast<float>(factor_[1] * scale);
  side.corner_factor[lane] = static_cast<float>(factor_[2] * scale);
}

FrameGap::Side::Side(const Object& object, const Pose& pose)
    : linear(pose.linear()),
      centre(object.tree().centre()),
      world_centre(linear * centre),
      stretch(stretch_of(linear)),
      unit(object.tree().unit()),
      size(linear.cwiseAbs().rowwise().sum().maxCoeff() *
           (centre.cwiseAbs().maxCoeff() + 2 * bvh::support_most * unit)) {}

FrameGap::FrameGap(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b)
    : a_(a, pose_a),
      b_(b, pose_b),
      between_(pose_b.translation() - pose_a.translation()),
      centre_between_(between_ + (b_.world_centre - a_.world_centre)),
      size_(a_.size + b_.size + between_.cwiseAbs().maxCoeff()),
      is_moderate_(size_ > 0x1p-200 && size_ < 0x1p200) {
  set_axis(Vec3d::UnitX());
}

// Every magnitude that is added up for a gap along n is at most |n|_1 size_. With u = 2^-53, L^T n costs 3u, the
// factors of a reach, their products with the words and the sums 8u, the product of a vertex or of the centre with L^T
// n 6u, the difference of the centres and its product with n 9u, the last sums 4u: less than 32u in all.
double FrameGap::slack(const Vec3d& axis) const { return 128 * unit_roundoff * (axis.cwiseAbs().sum() * size_); }

void FrameGap::set_axis(const Vec3d& axis) {
  const double greatest = axis.cwiseAbs().maxCoeff();
  if (!is_moderate_ || !(greatest > 0 && greatest < infinity)) return;
  std::array<Vec3d, axes> n;
  n[0] = (axis / greatest).normalized();
  Eigen::Index least = 0;
  n[0].cwiseAbs().minCoeff(&least);
  n[1] = n[0].cross(Vec3d::Unit(least)).normalized();
  n[2] = n[0].cross(n[1]);
  for (std::size_t i = 0; i < axes; ++i) {
    for (Side* side : {&a_, &b_}) {
      side->m[i] = side->linear.transpose() * n[i];
      side->reach[i] = LineReach(side->m[i], side->unit);
    }
    offset_[i] = n[i].dot(centre_between_);
    slack_[i] = slack(n[i]);
  }
  // The sum of the squares of v's products with the axes is at most v's square times the greatest eigenvalue of the
  // products of the axes with each other, which is at most the greatest sum of magnitudes in a row of these.
  Eigen::Matrix3d all;
  all << n[0], n[1], n[2];
  axes_ = all;
  const double eigenvalue = (all.transpose() * all).cwiseAbs().rowwise().sum().maxCoeff();
  scale_ = (1 - 0x1p-49) / std::sqrt(eigenvalue);
}

double FrameGap::in_single(simd::DistanceFrame& frame) {
  frame = {};
  // The three factors of a reach, in the order of magnitude of the components of a vector m, are together at most
  // 1.13 |m|.
  const double size = 1.13 * bvh::support_most * (a_.stretch * a_.unit + b_.stretch * b_.unit) + centre_between_.norm();
  if (!is_moderate_ || !(size > 0x1p-200 && size < 0x1p200)) {  // all gaps are 0, all upper bounds infinite
    frame.slack = std::numeric_limits<float>::infinity();
    a_.dual_slack = b_.dual_slack = infinity;
    return 1;
  }
  const double scale = 0.499 / size;
  float most_slack = 0;
  for (std::size_t i = 0; i < axes; ++i) {
    a_.reach[i].store(true, scale, 2 * i, frame.a);
    a_.reach[i].store(false, scale, 2 * i + 1, frame.a);
    b_.reach[i].store(false, scale, 2 * i, frame.b);
    b_.reach[i].store(true, scale, 2 * i + 1, frame.b);
    const auto slack = static_cast<float>(2.02 * slack_[i] * scale) + simd::single_slack;
    most_slack = std::max(most_slack, slack);
    frame.centre_b[i] = static_cast<float>(offset_[i] * scale);
    frame.offset[2 * i] = frame.centre_b[i] - slack;
    frame.offset[2 * i + 1] = -frame.centre_b[i] - slack;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      frame.a.vertex[3 * i + k] = static_cast<float>(a_.m[i][row] * a_.unit * scale);
      frame.b.vertex[3 * i + k] = static_cast<float>(b_.m[i][row] * b_.unit * scale);
    }
  }
  for (Side* side : {&a_, &b_}) {
    Eigen::Matrix3d to_frame;
    for (std::size_t i = 0; i < axes; ++i) {
      to_frame.row(static_cast<Eigen::Index>(i)) = side->m[i].transpose() * (side->unit * scale);
    }
    side->dual = to_frame.inverse().transpose();
    // Heights are off by what is left of dual^T to_frame - 1, and by the rounding of the sums for that and for them.
    const double left = (to_frame.transpose() * side->dual - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    const double slack = bvh::support_most * (9 * left + 256 * unit_roundoff * to_frame.norm() * side->dual.norm());
    side->dual_slack = slack < 100 ? slack + 0x1p-20 : infinity;
  }
  offset_in_frame_ = Vec3d(offset_[0], offset_[1], offset_[2]) * scale;
  frame.offset[6] = frame.offset[7] = -1;
  frame.shrink = static_cast<float>(scale_ * scale_ * (1 - 0x1p-19));
  frame.slack = most_slack;
  return 1 / scale;
}

FrameGap::FrameSlab FrameGap::slab(const Side& side, const bvh::SupportLine& line,
                                   const std::array<float, simd::reach_lanes>& reach, int sign) {
  FrameSlab slab;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    slab.middle[i] = sign * 0.5 * (static_cast<double>(reach[2 * k]) - reach[2 * k + 1]);
    slab.half[i] = 0.5 * (static_cast<double>(reach[2 * k]) + reach[2 * k + 1]) + simd::single_slack;
  }
  bvh::Slab of_line;
  if (!(side.dual_slack < infinity) || !bvh::slab_of(line, of_line)) return slab;
  slab.normal = side.dual * of_line.normal;
  slab.along = of_line.along + side.dual_slack;
  slab.against = of_line.against + side.dual_slack;
  return slab;
}

double FrameGap::slab_gap(const FrameSlab& a, const FrameSlab& b) const {
  // With the normal p of one and q of the other, p = c q + r: heights along p are sums of heights in the other's slab
  // and along r, which is short, in its box.
  const auto gap = [this](const FrameSlab& own, const FrameSlab& other, int sign) {
    const double square = own.normal.squaredNorm();
    if (square == 0) return -1.0;
    const double other_square = other.normal.squaredNorm();
    const double c = other_square > 0 ? own.normal.dot(other.normal) / other_square : 0;
    const Vec3d r = own.normal - c * other.normal;
    const double middle = r.dot(other.middle);
    const double half = r.cwiseAbs().dot(other.half);
    const double most = middle + half + (c > 0 ? c * other.along : -c * other.against);
    const double least = middle - half - (c > 0 ? c * other.against : -c * other.along);
    const double between = sign * own.normal.dot(offset_in_frame_);  // from the own centre to the other's
    const double beyond = std::max(between + least - own.along, -between - most - own.against);
    return (beyond - own.normal.cwiseAbs().sum() * 0x1p-40) / std::sqrt(square) * (1 - 0x1p-20);
  };
  return std::max(gap(a, b, 1), gap(b, a, -1));
}

double FrameGap::rough_gap(const Vec3d& axis, const bvh::SupportLine& line_a, const bvh::SupportLine& line_b) const {
  const Vec3d n = axis.normalized();
  return n.dot(centre_between_) - LineReach(a_.linear.transpose() * n, a_.unit).along(line_a) -
         LineReach(b_.linear.transpose() * n, b_.unit).against(line_b);
}

Vec3d FrameGap::middle(const Side& side, const bvh::SupportLine* lines, std::size_t count) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const auto& word = lines[i].word;
    sum += Vec3d(word[0] - word[1], word[2] - word[3], word[4] - word[5]);
  }
  return side.world_centre + side.linear * (sum * (0.5 * side.unit / static_cast<double>(count)));
}

}  // namespace cchip
