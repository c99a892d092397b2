// SPDX-License-Identifier: Apache-2.0
// The cloud's tree against the object's, in the world. For any vector n, two sets are farther apart than r if their
// ranges along n are farther apart than |n| r; so every vector may leave out pairs of nodes, whatever map the poses
// are. Those of nodes are the normals of both frames' boxes. Bounds on the rounding: docs/cpp/exactness.md, "Points".
#include <algorithm>
#include <cchip/internal/exact/posed_distances.hpp>
#include <cchip/internal/geometry/decimal.hpp>
#include <cchip/internal/judge/face_pairs.hpp>
#include <cchip/internal/tree/support_tree.hpp>
#include <cchip/point_cloud.hpp>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "exact/float_mode.hpp"
#include "exact/ieee.hpp"
#include "exact/posed_filter.hpp"
#include "search/point_tree.hpp"

namespace cchip {
namespace {

using bvh::NodeRef;
using bvh::SupportLine;

constexpr double unit = std::numeric_limits<double>::epsilon() / 2;  // greatest relative error of one operation
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t lanes = PointTree::lanes;
constexpr std::size_t block = PointTree::block;

double row_sum(const Pose& pose) { return pose.linear().cwiseAbs().rowwise().sum().maxCoeff(); }

/// Normals of the sides of boxes under a map, with a greatest component of 1; any vectors if it is singular.
std::array<Vec3d, 3> normals_of(const Pose& pose) {
  std::array<Vec3d, 3> normals;
  for (Eigen::Index k = 0; k < 3; ++k) {
    Vec3d n = pose.linear().col((k + 1) % 3).cross(pose.linear().col((k + 2) % 3));
    const double size = n.cwiseAbs().maxCoeff();
    if (size > 0x1p-900 && size < 0x1p1000) {
      n /= size;
    } else {
      n = Vec3d::Unit(k);
    }
    normals[static_cast<std::size_t>(k)] = n;
  }
  return normals;
}

/// Ranges of boxes of both frames along vectors of the world.
class Axes {
 public:
  static constexpr std::size_t count = 6;

  Axes(const PointTree& cloud, const Pose& pose_cloud, const bvh::SupportTree& object, const Pose& pose_object)
      : object_(object) {
    const std::array<Vec3d, 3> of_cloud = normals_of(pose_cloud);
    const std::array<Vec3d, 3> of_object = normals_of(pose_object);
    const Vec3d between = pose_cloud.translation() - pose_object.translation();
    const Vec3d extent = Vec3d::Constant(object.extent());
    const Eigen::Matrix3d size_cloud = pose_cloud.linear().cwiseAbs();
    const Eigen::Matrix3d size_object = pose_object.linear().cwiseAbs();
    const Vec3d size_between = pose_cloud.translation().cwiseAbs() + pose_object.translation().cwiseAbs();
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3d& n = k < 3 ? of_cloud[k] : of_object[k - 3];
      const Vec3d size = n.cwiseAbs();
      const Vec3d u = pose_cloud.linear().transpose() * n;
      const Vec3d v = pose_object.linear().transpose() * n;
      for (std::size_t i = 0; i < 3; ++i) {
        cloud_[k][i] = u[static_cast<Eigen::Index>(i)];
        of_object_[k][i] = v[static_cast<Eigen::Index>(i)];
      }
      between_[k] = n.dot(between);
      length_[k] = std::sqrt(n.squaredNorm()) * (1 + 0x1p-48);
      // Below 40 units of the sum of the magnitudes of all terms; what underflows is below the other two.
      const double terms =
          size.dot(size_cloud * cloud.greatest) + size.dot(size_object * extent) + size.dot(size_between);
      slack_[k] =
          terms < 0x1p1000 ? 0x1p-45 * terms + 0x1p-1065 * (cloud.greatest.sum() + extent.sum()) + 0x1p-1060 : infinity;
    }
  }

  /// A node of the object along all axes, relative to the cloud's frame.
  struct Ranges {
    std::array<double, count> centre;
    std::array<double, count> half;  ///< with all slack
  };
  Ranges ranges(const SupportLine& line) const {
    std::array<double, 3> centre;
    std::array<double, 3> half;
    box(line, centre, half);
    Ranges r;
    for (std::size_t k = 0; k < count; ++k) {
      const std::array<double, 3>& v = of_object_[k];
      r.centre[k] = v[0] * centre[0] + v[1] * centre[1] + v[2] * centre[2] - between_[k];
      r.half[k] = std::abs(v[0]) * half[0] + std::abs(v[1]) * half[1] + std::abs(v[2]) * half[2] + slack_[k];
    }
    return r;
  }
  /// Half of the longest side, for a choice.
  double size(const SupportLine& line) const {
    std::array<double, 3> centre;
    std::array<double, 3> half;
    box(line, centre, half);
    return std::max({half[0], half[1], half[2]});
  }

  /// The greatest gap between the spheres of each child and the node of the object; at most 0 if none is proved.
  PointTree::Lanes gaps(const PointTree::Node& node, const Ranges& object) const {
    PointTree::Lanes most;
    most.fill(-infinity);
    for (std::size_t k = 0; k < count; ++k) {
      const double x = cloud_[k][0];
      const double y = cloud_[k][1];
      const double z = cloud_[k][2];
      const double size_x = std::abs(x);
      const double size_y = std::abs(y);
      const double size_z = std::abs(z);
      for (std::size_t i = 0; i < lanes; ++i) {
        const double centre = x * node.centre[0][i] + y * node.centre[1][i] + z * node.centre[2][i] - object.centre[k];
        const double half = size_x * node.half[0][i] + size_y * node.half[1][i] + size_z * node.half[2][i] +
                            length_[k] * node.radius[i];
        const double gap = std::abs(centre) - (half + object.half[k]);
        most[i] = gap > most[i] ? gap : most[i];  // not for NaN
      }
    }
    return most;
  }
  double gap(const PointTree::Node& node, std::size_t i, const Ranges& object) const {
    double most = -infinity;
    for (std::size_t k = 0; k < count; ++k) {
      const std::array<double, 3>& u = cloud_[k];
      const double centre =
          u[0] * node.centre[0][i] + u[1] * node.centre[1][i] + u[2] * node.centre[2][i] - object.centre[k];
      const double half = std::abs(u[0]) * node.half[0][i] + std::abs(u[1]) * node.half[1][i] +
                          std::abs(u[2]) * node.half[2][i] + length_[k] * node.radius[i];
      const double gap = std::abs(centre) - (half + object.half[k]);
      most = gap > most ? gap : most;
    }
    return most;
  }

  /// The points of a block along all axes, and the reach of their spheres.
  struct Block {
    std::array<std::array<double, block>, count> at;
    std::array<std::array<double, block>, count> reach;
  };
  void project(const PointTree& cloud, std::size_t first, Block& to) const {
    for (std::size_t k = 0; k < count; ++k) {
      const double x = cloud_[k][0];
      const double y = cloud_[k][1];
      const double z = cloud_[k][2];
      for (std::size_t i = 0; i < block; ++i) {
        to.at[k][i] = x * cloud.at[0][first + i] + y * cloud.at[1][first + i] + z * cloud.at[2][first + i];
        to.reach[k][i] = length_[k] * cloud.radius[first + i];
      }
    }
  }
  /// The points of `mask` whose spheres may meet the node of the object.
  std::uint32_t left(const Block& points, const Ranges& object, std::uint32_t mask) const {
    std::array<double, block> most;
    most.fill(-infinity);
    for (std::size_t k = 0; k < count; ++k) {
      const double centre = object.centre[k];
      const double half = object.half[k];
      for (std::size_t i = 0; i < block; ++i) {
        const double gap = std::abs(points.at[k][i] - centre) - (points.reach[k][i] + half);
        most[i] = gap > most[i] ? gap : most[i];  // not for NaN
      }
    }
    std::uint32_t left = 0;
    for (std::size_t i = 0; i < block; ++i) left |= static_cast<std::uint32_t>(!(most[i] > 0)) << i;
    return left & mask;
  }

 private:
  void box(const SupportLine& line, std::array<double, 3>& centre, std::array<double, 3>& half) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const double up = line.word[2 * k];
      const double down = line.word[2 * k + 1];
      centre[k] = object_.centre()[static_cast<Eigen::Index>(k)] + object_.unit() * (0.5 * (up - down));
      half[k] = object_.unit() * (0.5 * (up + down));
    }
  }

  const bvh::SupportTree& object_;
  std::array<std::array<double, 3>, count> cloud_;
  std::array<std::array<double, 3>, count> of_object_;
  std::array<double, count> between_;
  std::array<double, count> length_;
  std::array<double, count> slack_;
};

/// A point on the hull of the vertices that is near p, in doubles; nearest up to rounding if p is not in the hull.
struct NearPoint {
  Vec3d p;
  Vec3d at = Vec3d::Zero();
  double square = infinity;

  void offer(const Vec3d& q) {
    const double here = (p - q).squaredNorm();
    if (!(here < square)) return;
    square = here;
    at = q;
  }
  void offer_edge(const Vec3d& from, const Vec3d& to) {
    const Vec3d edge = to - from;
    const double t = edge.dot(p - from) / edge.squaredNorm();
    offer(from + (t > 0 ? std::min(t, 1.0) : 0) * edge);  // of NaN 0
  }
  void offer_face(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d u = b - a;
    const Vec3d v = c - a;
    const Vec3d w = p - a;
    const Vec3d normal = u.cross(v);
    const double size = normal.squaredNorm();
    const double s = w.cross(v).dot(normal) / size;
    const double t = u.cross(w).dot(normal) / size;
    if (s >= 0 && t >= 0 && s + t <= 1) offer(a + s * u + t * v);
  }
};

/// A face in the world, relative to its first vertex there, rounded.
struct WorldFace {
  std::array<Vec3d, 4> v = {Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero()};
  std::size_t count = 0;
  Vec3d base;
  double greatest = 0;

  /// Vectors along which most spheres are clear of it: those of the frame, the normal and, in its plane, across the
  /// sides.
  struct Axis {
    Vec3d n;
    double least;
    double greatest;
    double length;  ///< at least that of n
    double size;    ///< sum of magnitudes
  };
  static constexpr std::size_t axes_most = 8;
  std::array<Axis, axes_most> axis;
  std::size_t axes = 0;

  WorldFace(const Primitive& p, const Pose& pose) : count(p.vertex_count()) {
    for (std::size_t i = 0; i < count; ++i) v[i] = pose.linear() * p.v[i];
    base = v[0];
    for (std::size_t i = 0; i < count; ++i) {
      v[i] -= base;
      greatest = std::max(greatest, v[i].cwiseAbs().maxCoeff());
    }
  }
  void make_axes() {
    for (Eigen::Index k = 0; k < 3; ++k) add_axis(Vec3d::Unit(k));
    const Vec3d normal = count == 3 ? (v[1] - v[0]).cross(v[2] - v[0]) : (v[2] - v[0]).cross(v[3] - v[1]);
    add_axis(normal);
    for (std::size_t i = 0; i < count; ++i) add_axis((v[(i + 1) % count] - v[i]).cross(normal));
  }

 private:
  void add_axis(const Vec3d& n) {
    const double length = std::sqrt(n.squaredNorm()) * (1 + 0x1p-48);
    if (!(length > 0x1p-300)) return;
    Axis& a = axis[axes++];
    a.n = n;
    a.length = length;
    a.size = n.cwiseAbs().sum();
    a.least = a.greatest = n.dot(v[0]);
    for (std::size_t i = 1; i < count; ++i) {
      const double x = n.dot(v[i]);
      a.least = std::min(a.least, x);
      a.greatest = std::max(a.greatest, x);
    }
  }
};

class CloudSearch {
 public:
  CloudSearch(const PointTree& cloud, const Pose& pose_cloud, const Object& object, const Pose& pose_object,
              const CloudRequest& request, CloudResult& result)
      : cloud_(cloud),
        pose_cloud_(pose_cloud),
        mesh_(object.mesh()),
        tree_(object.tree()),
        pose_object_(pose_object),
        first_(request.contacts == CollisionRequest::Contacts::first),
        most_(first_ ? 1 : request.max_contacts),
        check_at_(most_),
        result_(result),
        axes_(cloud, pose_cloud, object.tree(), pose_object),
        offset_(exact::Offset(pose_cloud, pose_object).value) {
    const double magnitude = row_sum(pose_cloud) * cloud.greatest.maxCoeff() + row_sum(pose_object) * tree_.extent() +
                             offset_.cwiseAbs().maxCoeff();
    error_ = 16 * unit * magnitude + 0x1p-1070;
    is_moderate_ = magnitude < 0x1p200 && cloud.greatest_radius < 0x1p200;
    scale_cloud_ = row_sum(pose_cloud);
    scale_object_ = row_sum(pose_object);
  }

  void run() {
    if (cloud_.nodes.empty()) return;
    search();
    if (first_) return;
    settle();
  }

 private:
  /// A child of a node of the cloud and a line of the object.
  struct Item {
    std::uint32_t node;
    std::uint32_t lane;
    std::uint32_t line;
    std::uint32_t mask;  ///< of a block: its points that are not clear of what is above the line
  };
  static constexpr std::uint32_t all_points = (std::uint32_t{1} << block) - 1;
  // A step takes one item and leaves at most 8 of the cloud's, or 4 of the object's, in its place.
  static constexpr std::size_t stack_most =
      (lanes - 1) * PointTree::depth_most + 3 * static_cast<std::size_t>(bvh::tree_depth_max) + lanes;

  void search() {
    std::array<Item, stack_most> stack;
    std::size_t top = 0;
    const auto whole = static_cast<std::uint32_t>(tree_.size());
    ++result_.stats.box_tests;
    if (!(axes_.gap(cloud_.nodes[0], 0, axes_.ranges(tree_.lines()[whole])) > 0))
      stack[top++] = {0, 0, whole, all_points};
    while (top > 0 && !done_) {
      const Item item = stack[--top];
      const PointTree::Node& node = cloud_.nodes[item.node];
      const PointTree::Child child = node.child[item.lane];
      const SupportLine& line = tree_.lines()[item.line];
      const NodeRef ref = line.ref();
      if (child.is_leaf() && ref.is_leaf()) {
        test_leaves(child.number(), ref, item.mask);
        continue;
      }
      ++result_.stats.steps;
      std::array<Item, lanes> next;
      std::array<double, lanes> gap;
      std::size_t count = 0;
      // Sorted by their gaps, the least last: it comes first then.
      const auto add = [&](const Item& x, double here) {
        std::size_t i = count++;
        for (; i > 0 && gap[i - 1] < here; --i) {
          gap[i] = gap[i - 1];
          next[i] = next[i - 1];
        }
        gap[i] = here;
        next[i] = x;
      };
      if (child.is_leaf() || (!ref.is_leaf() && is_object_larger(node, item.lane, line))) {
        result_.stats.box_tests += ref.count();
        for (std::uint32_t i = ref.first(); i < ref.first() + ref.count(); ++i) {
          const Axes::Ranges ranges = axes_.ranges(tree_.lines()[i]);
          const double here = axes_.gap(node, item.lane, ranges);
          if (here > 0) continue;
          const std::uint32_t mask =
              child.is_leaf() ? axes_.left(placed(child.number()), ranges, item.mask) : all_points;
          if (mask != 0) add({item.node, item.lane, i, mask}, here);
        }
      } else {
        const PointTree::Node& below = cloud_.nodes[child.number()];
        result_.stats.box_tests += below.count;
        const PointTree::Lanes gaps = axes_.gaps(below, axes_.ranges(line));
        for (std::uint32_t i = 0; i < below.count; ++i) {
          if (!(gaps[i] > 0)) add({child.number(), i, item.line, all_points}, gaps[i]);
        }
      }
      for (std::size_t i = 0; i < count; ++i) stack[top++] = next[i];
    }
  }

  bool is_object_larger(const PointTree::Node& node, std::size_t lane, const SupportLine& line) const {
    const double half = std::max({node.half[0][lane], node.half[1][lane], node.half[2][lane]});
    return scale_object_ * axes_.size(line) > scale_cloud_ * half;
  }

  void test_leaves(std::uint32_t leaf, NodeRef faces, std::uint32_t mask) {
    placed(leaf);
    const std::size_t count = std::min(block, cloud_.points - leaf * block);
    if (count < block) mask &= (std::uint32_t{1} << count) - 1;
    for (std::uint32_t i = faces.first(); i < faces.first() + faces.count() && !done_; ++i) {
      const std::uint32_t face = tree_.faces()[i];
      for (std::uint32_t left = mask; left != 0; left &= left - 1) ++result_.stats.pairs;
      test_face(leaf, mask, face, mesh_.primitive(face));
    }
  }

  /// The points of a block along the axes, and in the world, less the object's translation, rounded.
  const Axes::Block& placed(std::uint32_t leaf) {
    if (leaf != placed_) place(leaf);
    return along_;
  }
  void place(std::uint32_t leaf) {
    placed_ = leaf;
    const std::size_t first = std::size_t{leaf} * block;
    axes_.project(cloud_, first, along_);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      const double x = pose_cloud_(row, 0);
      const double y = pose_cloud_(row, 1);
      const double z = pose_cloud_(row, 2);
      const double offset = offset_[row];
      for (std::size_t i = 0; i < block; ++i) {
        world_[k][i] =
            (x * cloud_.at[0][first + i] + y * cloud_.at[1][first + i] + z * cloud_.at[2][first + i]) + offset;
      }
    }
  }

  void test_face(std::uint32_t leaf, std::uint32_t mask, std::uint32_t face, const Primitive& primitive) {
    WorldFace world(primitive, pose_object_);
    std::array<std::array<double, block>, 3> p;
    double greatest = world.greatest;
    for (std::size_t k = 0; k < 3; ++k) {
      const double base = world.base[static_cast<Eigen::Index>(k)];
      for (std::size_t i = 0; i < block; ++i) {
        p[k][i] = world_[k][i] - base;
        const double size = std::abs(p[k][i]);
        greatest = size > greatest ? size : greatest;
      }
    }
    // No product overflows, and what underflows is far below the error.
    const bool is_moderate = is_moderate_ && (greatest == 0 || greatest > 0x1p-400);
    const double* const radius = cloud_.radius.data() + std::size_t{leaf} * block;
    std::array<double, block> gap;
    gap.fill(0);
    if (is_moderate) {
      world.make_axes();
      for (std::size_t a = 0; a < world.axes; ++a) {
        const WorldFace::Axis& axis = world.axis[a];
        const double x = axis.n.x();
        const double y = axis.n.y();
        const double z = axis.n.z();
        const double slack = axis.size * (2.5 * error_ + 16 * unit * greatest);
        for (std::size_t i = 0; i < block; ++i) {
          const double t = x * p[0][i] + y * p[1][i] + z * p[2][i];
          const double above = t - axis.greatest;
          const double below = axis.least - t;
          const double here = (above > below ? above : below) - slack - axis.length * radius[i];
          gap[i] = here > gap[i] ? here : gap[i];
        }
      }
    }
    for (std::size_t i = 0; i < block && !done_; ++i) {
      if (gap[i] > 0 || (mask >> i & 1U) == 0) continue;
      if (meets(world, {p[0][i], p[1][i], p[2][i]}, radius[i], is_moderate, primitive, leaf * block + i)) {
        add_contact(cloud_.number[leaf * block + i], face);
      }
    }
  }

  /// As PosedDistances::bounds(), for a point: a near point of the hull bounds the distance from above, the axis from
  /// there bounds it from below.
  bool meets(const WorldFace& face, const Vec3d& p, double radius, bool is_moderate, const Primitive& primitive,
             std::size_t place) {
    if (is_moderate) {
      NearPoint near;
      near.p = p;
      for (std::size_t i = 1; i < face.count; ++i) {
        for (std::size_t k = 0; k < i; ++k) near.offer_edge(face.v[k], face.v[i]);
      }
      near.offer_face(face.v[0], face.v[1], face.v[2]);
      if (face.count == 4) {
        near.offer_face(face.v[0], face.v[1], face.v[3]);
        near.offer_face(face.v[0], face.v[2], face.v[3]);
        near.offer_face(face.v[1], face.v[2], face.v[3]);
      }
      const double greatest = std::max(face.greatest, p.cwiseAbs().maxCoeff());
      const Vec3d axis = p - near.at;
      const double length = std::sqrt(axis.squaredNorm());
      if (length * (1 + 8 * unit) + 4 * (error_ + 24 * unit * greatest) <= radius) return true;
      if (length > 0x1p-300) {
        double to = -infinity;
        for (std::size_t i = 0; i < face.count; ++i) to = std::max(to, axis.dot(face.v[i]));
        const double slack = axis.cwiseAbs().sum() * (2.5 * error_ + 16 * unit * greatest);
        const double gap = (axis.dot(p) - to) - slack;
        if (gap > 0 && gap / length * (1 - 16 * unit) > radius) return false;
      }
    }
    ++result_.stats.open;
    if (!distances_) distances_.emplace(pose_cloud_, pose_object_);
    const Vec3d centre(cloud_.at[0][place], cloud_.at[1][place], cloud_.at[2][place]);
    Primitive point;
    point.v = {centre, centre, centre, centre};
    return distances_->within(point, primitive, radius).hit;
  }

  void add_contact(std::uint32_t point, std::uint32_t face) {
    result_.hit = true;
    result_.contacts.push_back({point, mesh_.number_in_file(face)});
    if (first_) {
      done_ = true;
    } else if (result_.contacts.size() > check_at_) {
      settle();
      // Parts of one face of the file may repeat a contact; sorting each time would take too long.
      check_at_ = std::max(most_, 2 * result_.contacts.size());
    }
  }

  /// Sorts the contacts, and leaves out what is there twice or too many.
  void settle() {
    std::vector<CloudContact>& contacts = result_.contacts;
    std::sort(contacts.begin(), contacts.end());
    contacts.erase(std::unique(contacts.begin(), contacts.end()), contacts.end());
    if (contacts.size() <= most_) return;
    contacts.resize(most_);
    done_ = true;
  }

  const PointTree& cloud_;
  const Pose& pose_cloud_;
  const Mesh& mesh_;
  const bvh::SupportTree& tree_;
  const Pose& pose_object_;
  const bool first_;
  const std::size_t most_;
  std::size_t check_at_;  ///< more contacts than this are looked through
  CloudResult& result_;
  const Axes axes_;
  const Vec3d offset_;  ///< translation of the cloud relative to the object's, rounded
  double error_ = 0;    ///< bound on the error of each coordinate in the world
  bool is_moderate_ = false;
  double scale_cloud_ = 0;
  double scale_object_ = 0;
  bool done_ = false;
  std::uint32_t placed_ = std::numeric_limits<std::uint32_t>::max();  ///< block that is in world_
  std::array<std::array<double, block>, 3> world_;
  Axes::Block along_;
  std::optional<PosedDistances> distances_;  ///< made when it is needed first
};

void check_points(const std::vector<Vec3d>& points) {
  check_float_mode();
  if (points.size() >= std::size_t{1} << 31U) {
    throw std::invalid_argument("point cloud: " + std::to_string(points.size()) +
                                " points are too many: give fewer than 2^31");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= 0x1p1000) continue;
    throw std::invalid_argument("point cloud: point " + std::to_string(i) +
                                " has a coordinate that is not finite or beyond 2^1000; leave the point out");
  }
}

void check_radius(double radius, const std::string& of) {
  if (radius >= 0 && radius <= 0x1p1000) return;
  throw std::invalid_argument("point cloud: the radius" + of + " is " + decimal_text(radius) +
                              "; it must be at least 0 and at most 2^1000");
}

}  // namespace

PointCloud::PointCloud(const std::vector<Vec3d>& points, double radius) {
  check_points(points);
  check_radius(radius, "");
  tree_ = std::make_shared<const PointTree>(points, &radius, 0);
}

PointCloud::PointCloud(const std::vector<Vec3d>& points, const std::vector<double>& radii) {
  check_points(points);
  if (radii.size() != points.size()) {
    throw std::invalid_argument("point cloud: " + std::to_string(radii.size()) + " radii for " +
                                std::to_string(points.size()) + " points; give one for each, or one for all");
  }
  for (std::size_t i = 0; i < radii.size(); ++i) check_radius(radii[i], " of point " + std::to_string(i));
  tree_ = std::make_shared<const PointTree>(points, radii.data(), 1);
}

const PointTree& PointCloud::tree() const {
  if (tree_) return *tree_;
  throw std::invalid_argument(
      "point cloud: it was moved from and has no points; use the PointCloud that it was moved to");
}

std::size_t PointCloud::size() const { return tree().points; }

std::vector<Vec3d> PointCloud::points() const {
  const PointTree& t = tree();
  std::vector<Vec3d> points(t.points);
  for (std::size_t i = 0; i < t.points; ++i) points[t.number[i]] = {t.at[0][i], t.at[1][i], t.at[2][i]};
  return points;
}

std::vector<double> PointCloud::radii() const {
  const PointTree& t = tree();
  std::vector<double> radii(t.points);
  for (std::size_t i = 0; i < t.points; ++i) radii[t.number[i]] = t.radius[i];
  return radii;
}

void collide(const PointCloud& cloud, const Pose& pose_cloud, const Object& object, const Pose& pose_object,
             const CloudRequest& request, CloudResult& result) {
  check_float_mode();
  check_pose(pose_cloud, "the cloud");
  check_pose(pose_object, "the object");
  if (request.max_contacts == 0) throw std::invalid_argument("max_contacts is 0: ask for at least one contact");
  result.hit = false;
  result.contacts.clear();
  result.stats = {};
  CloudSearch(cloud.tree(), pose_cloud, object, pose_object, request, result).run();
}

CloudResult collide(const PointCloud& cloud, const Pose& pose_cloud, const Object& object, const Pose& pose_object,
                    const CloudRequest& request) {
  CloudResult result;
  collide(cloud, pose_cloud, object, pose_object, request, result);
  return result;
}

void collide(const PointCloud& cloud, const Pose& pose_cloud, const std::vector<PlacedObject>& objects,
             const CloudRequest& request, std::vector<CloudResult>& results) {
  results.resize(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].object == nullptr) {
      throw std::invalid_argument("object " + std::to_string(i) + " is a null pointer; point it to an Object");
    }
    collide(cloud, pose_cloud, *objects[i].object, objects[i].pose, request, results[i]);
  }
}

std::size_t first_met(const PointCloud& cloud, const Pose& pose_cloud, const std::vector<PlacedObject>& objects) {
  CloudResult result;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].object == nullptr) {
      throw std::invalid_argument("object " + std::to_string(i) + " is a null pointer; point it to an Object");
    }
    collide(cloud, pose_cloud, *objects[i].object, objects[i].pose, {}, result);
    if (result.hit) return i;
  }
  return objects.size();
}

}  // namespace cchip
