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

}  // namespace

LineReach::LineReach(const Vec3d& m, double unit) {
  const std::array<double, 3> size = {std::abs(m[0]), std::abs(m[1]), std::abs(m[2])};
  std::array<std::size_t, 3> order = {0, 1, 2};
  if (size[order[0]] < size[order[1]]) std::swap(order[0], order[1]);
  if (size[order[1]] < size[order[2]]) std::swap(order[1], order[2]);
  if (size[order[0]] < size[order[1]]) std::swap(order[0], order[1]);
  const auto& [i, j, k] = order;
  const std::array<unsigned, 3> negative = {m[0] < 0 ? 1U : 0U, m[1] < 0 ? 1U : 0U, m[2] < 0 ? 1U : 0U};
  const auto axis = static_cast<std::uint8_t>(2 * i + negative[i]);
  const auto face = static_cast<std::uint8_t>(negative[(k + 1) % 3] + 2 * negative[(k + 2) % 3]);
  const auto corner = static_cast<std::uint8_t>(negative[0] + 2 * negative[1] + 4 * negative[2]);
  const auto first_face = static_cast<std::uint8_t>(bvh::first_face_word + 4 * k);
  constexpr auto first_corner = static_cast<std::uint8_t>(bvh::first_corner_word);
  // (a - b) axis + (b - c) face diagonal + c cube diagonal, with a >= b >= c the magnitudes.
  factor_ = {unit * (size[i] - size[j]), unit * 1.4142135623730951 * (size[j] - size[k]),
             unit * 1.7320508075688772 * size[k]};
  along_ = {axis, static_cast<std::uint8_t>(first_face + face), static_cast<std::uint8_t>(first_corner + corner)};
  against_ = {static_cast<std::uint8_t>(axis ^ 1U), static_cast<std::uint8_t>(first_face + (face ^ 3U)),
              static_cast<std::uint8_t>(first_corner + (corner ^ 7U))};
}

FrameGap::Side::Side(const Object& object, const Pose& pose)
    : linear(pose.linear()),
      centre(object.tree().centre()),
      world_centre(linear * centre),
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

void FrameGap::set_axis(const Vec3d& axis, const Primitive* near_a) {
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
      side->m_centre[i] = side->m[i].dot(side->centre);
      side->reach[i] = LineReach(side->m[i], side->unit);
    }
    offset_[i] = n[i].dot(centre_between_);
    slack_[i] = slack(n[i]);
  }
  // The sum of the squares of v's products with the axes is at most v's square times the greatest eigenvalue of the
  // products of the axes with each other, which is at most the greatest sum of magnitudes in a row of these.
  Eigen::Matrix3d all;
  all << n[0], n[1], n[2];
  const double eigenvalue = (all.transpose() * all).cwiseAbs().rowwise().sum().maxCoeff();
  if (near_a != nullptr) near_a_ = reach_a(*near_a).along[0];
  scale_ = (1 - 0x1p-49) / std::sqrt(eigenvalue);
}

FrameGap::Reach FrameGap::reach(const Side& side, const bvh::SupportLine& line) {
  Reach reach;
  for (std::size_t i = 0; i < axes; ++i) {
    reach.along[i] = side.reach[i].along(line);
    reach.against[i] = side.reach[i].against(line);
  }
  return reach;
}

FrameGap::Reach FrameGap::reach(const Side& side, const Primitive& p) {
  Reach reach;
  for (std::size_t i = 0; i < axes; ++i) {
    double most = -infinity;
    double least = infinity;
    for (std::size_t k = 0; k < p.vertex_count(); ++k) {
      const double at = side.m[i].dot(p.v[k]);
      most = std::max(most, at);
      least = std::min(least, at);
    }
    reach.along[i] = most - side.m_centre[i];
    reach.against[i] = side.m_centre[i] - least;
  }
  return reach;
}

FrameGap::Reach FrameGap::enclose(const Reach& x, const Reach& y) {
  Reach reach;
  for (std::size_t i = 0; i < axes; ++i) {
    reach.along[i] = std::max(x.along[i], y.along[i]);
    reach.against[i] = std::max(x.against[i], y.against[i]);
  }
  return reach;
}

bool FrameGap::stays_below(const Side& side, const TreeSide& tree, bvh::NodeRef node, bool along, double limit) {
  for (std::uint32_t i = node.first(); i < node.first() + node.count(); ++i) {
    if (node.is_leaf()) {
      const Reach all = reach(side, tree.mesh.primitive(tree.tree.faces()[i]));
      if (!((along ? all.along[0] : all.against[0]) <= limit)) return false;
      continue;
    }
    const bvh::SupportLine& line = tree.tree.lines()[i];
    const double most = along ? side.reach[0].along(line) : side.reach[0].against(line);
    if (!(most <= limit) && !stays_below(side, tree, line.ref(), along, limit)) return false;
  }
  return true;
}

bool FrameGap::is_gap_nearly(double gap, const TreeSide& a, const TreeSide& b) const {
  // Where the nearest faces are, each object must end.
  const double rest = offset_[0] - gap;
  const double tolerance = 0x1p-30 * size_;
  return is_moderate_ && stays_below(a_, a, a.tree.root(), true, near_a_ + tolerance) &&
         stays_below(b_, b, b.tree.root(), false, rest - near_a_ + tolerance);
}

Vec3d FrameGap::middle(const Side& side, const bvh::SupportLine* lines, std::size_t count) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const auto& word = lines[i].word;
    sum += Vec3d(word[0] - word[1], word[2] - word[3], word[4] - word[5]);
  }
  return side.world_centre + side.linear * (sum * (0.5 * side.unit / static_cast<double>(count)));
}

FrameGap::Line FrameGap::line(const Vec3d& axis) const {
  Line line;
  const double greatest = axis.cwiseAbs().maxCoeff();
  if (!is_moderate_ || !(greatest > 0x1p-200 && greatest < 0x1p200)) return line;
  line.a = LineReach(a_.linear.transpose() * axis, a_.unit);
  line.b = LineReach(b_.linear.transpose() * axis, b_.unit);
  line.offset = axis.dot(centre_between_) - slack(axis);
  line.per_length = (1 - 0x1p-48) / axis.norm();
  return line;
}

}  // namespace cchip
