// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/cpu/distance.hpp>
#include <cchip/exact/posed_distances.hpp>
#include <queue>
#include <stdexcept>
#include <string>
#include <vector>

#include "axis_gap.hpp"
#include "dop_pairs.hpp"
#include "tree_side.hpp"

namespace cchip {
namespace {

using bvh::Dop26;
using bvh::NodeRef;

constexpr double infinity = std::numeric_limits<double>::infinity();

void check(const DistanceRequest& request) {
  if (!(request.rel_error >= 0 && request.rel_error < 1)) {
    throw std::invalid_argument("rel_error is " + std::to_string(request.rel_error) +
                                ": ask for one that is at least 0 and less than 1");
  }
  if (!(request.stop_above >= 0)) {
    throw std::invalid_argument("stop_above is " + std::to_string(request.stop_above) + ": it must be at least 0");
  }
}

/// Branch and bound over pairs of nodes, the one with the least gap first. Faces that may be the nearest ones are kept
/// with their bounds in doubles; integers decide between them at the end.
class DistanceSearch {
 public:
  DistanceSearch(const CollisionQuery& query, const DistanceRequest& request)
      : request_(request),
        a_{query.a->mesh(), query.a->tree()},
        b_{query.b->mesh(), query.b->tree()},
        volumes_(*query.a, *query.pose_a, *query.b, *query.pose_b),
        along_(*query.a, *query.pose_a, *query.b, *query.pose_b),
        distances_(*query.pose_a, *query.pose_b) {}

  /// \pre the objects share no point
  void run(DistanceResult& result) {
    counts_ = result.counts;
    search();
    answer(result);
    result.counts = counts_;
  }

 private:
  struct Item {
    double gap;
    NodeRef a;
    NodeRef b;
    friend bool operator<(const Item& x, const Item& y) { return x.gap > y.gap; }  // the least on top
  };
  struct Faces {
    DistanceBounds bounds;
    std::uint32_t a;
    std::uint32_t b;
  };

  /// Nothing this far apart matters any more.
  bool is_pruned(double gap) {
    if (gap > request_.stop_above) return true;
    // A little less than what is allowed, for the rounding of this line.
    if (gap < upper_ * (1 - (1 - 0x1p-20) * request_.rel_error)) return false;
    pruned_ = std::min(pruned_, gap);
    return true;
  }

  void search() {
    std::priority_queue<Item> queue;
    queue.push({0, a_.tree.root(), b_.tree.root()});
    while (!queue.empty()) {
      const Item item = queue.top();
      queue.pop();
      if (is_pruned(item.gap)) break;  // and so are all the others
      if (item.a.is_leaf() && item.b.is_leaf()) {
        test_leaves(item.a, item.b);
        continue;
      }
      ++counts_.steps;
      counts_.box_tests += std::uint64_t{item.a.count()} * item.b.count();
      std::array<Dop26, 4> own_b;
      std::array<Dop26, 4> volumes_b;
      std::array<Vec3d, 4> centres_b;
      for (std::uint32_t k = 0; k < item.b.count(); ++k) {
        own_b[k] = b_.volume(b_.tree.lines()[item.b.first() + k]);
        volumes_b[k] = volumes_.volume_b(own_b[k]);
        centres_b[k] = along_.centre_b(own_b[k]);
      }
      for (std::uint32_t i = item.a.first(); i < item.a.first() + item.a.count(); ++i) {
        const Dop26 own_a = a_.volume(a_.tree.lines()[i]);
        const Dop26 volume_a = volumes_.volume_a(own_a);
        const Vec3d centre_a = along_.centre_a(own_a);
        for (std::uint32_t k = 0; k < item.b.count(); ++k) {
          double gap = std::max(item.gap, volumes_.gap(volume_a, volumes_b[k]));
          gap = std::max(gap, along_(own_a, own_b[k], centres_b[k] - centre_a));
          gap = std::max(gap, along_(own_a, own_b[k], axis_));
          if (is_pruned(gap)) continue;
          const std::uint32_t line_b = item.b.first() + k;
          const bool leaf_a = a_.tree.lines()[i].ref().is_leaf();
          const bool leaf_b = b_.tree.lines()[line_b].ref().is_leaf();
          queue.push({gap, a_.below(i, leaf_b), b_.below(line_b, leaf_a)});
        }
      }
    }
  }

  void test_leaves(NodeRef leaf_a, NodeRef leaf_b) {
    for (std::uint32_t i = leaf_a.first(); i < leaf_a.first() + leaf_a.count(); ++i) {
      for (std::uint32_t k = leaf_b.first(); k < leaf_b.first() + leaf_b.count(); ++k) {
        const std::uint32_t face_a = a_.tree.faces()[i];
        const std::uint32_t face_b = b_.tree.faces()[k];
        ++counts_.pairs;
        const DistanceBounds bounds = distances_.bounds(a_.mesh.primitive(face_a), b_.mesh.primitive(face_b));
        if (is_pruned(bounds.lower)) continue;
        found_.push_back({bounds, face_a, face_b});
        if (!(bounds.upper < upper_)) continue;
        upper_ = bounds.upper;
        axis_ = bounds.point_b - bounds.point_a;
      }
    }
  }

  DistanceBounds tight_bounds(const Faces& faces) {
    ++counts_.open;
    return distances_.tight_bounds(a_.mesh.primitive(faces.a), b_.mesh.primitive(faces.b));
  }

  void answer(DistanceResult& result) {
    if (found_.empty()) return answer_above(result);
    std::sort(found_.begin(), found_.end(), [](const Faces& x, const Faces& y) {
      if (x.bounds.lower != y.bounds.lower) return x.bounds.lower < y.bounds.lower;
      return x.a != y.a ? x.a < y.a : x.b < y.b;
    });
    Faces best = *std::min_element(found_.begin(), found_.end(),
                                   [](const Faces& x, const Faces& y) { return x.bounds.upper < y.bounds.upper; });
    double lower = std::min(pruned_, found_.front().bounds.lower);
    if (!(best.bounds.upper - lower <= request_.rel_error * best.bounds.upper)) {
      best.bounds = tight_bounds(best);
      for (const Faces& faces : found_) {
        if (faces.bounds.lower >= best.bounds.lower) break;
        const Primitive a = a_.mesh.primitive(faces.a);
        const Primitive b = b_.mesh.primitive(faces.b);
        // Those between the same two doubles change nothing.
        const bool exact = best.bounds.lower == best.bounds.upper;
        const PosedDistances::Answer nearer =
            exact ? distances_.nearer(a, b, best.bounds.lower) : distances_.within(a, b, best.bounds.lower);
        counts_.open += nearer.open;
        if (nearer.hit) best = {tight_bounds(faces), faces.a, faces.b};
      }
      lower = std::min(pruned_, best.bounds.lower);
    }
    if (lower > request_.stop_above) return answer_above(result);
    result.lower = lower;
    result.upper = best.bounds.upper;
    result.point_a = best.bounds.point_a;
    result.point_b = best.bounds.point_b;
    result.face_a = a_.mesh.number_in_file(best.a);
    result.face_b = b_.mesh.number_in_file(best.b);
  }

  void answer_above(DistanceResult& result) const {
    result.lower = std::min(request_.stop_above, std::numeric_limits<double>::max());
    result.upper = infinity;
  }

  const DistanceRequest& request_;
  const TreeSide a_;
  const TreeSide b_;
  const DopPairs volumes_;
  const AxisGap along_;
  const PosedDistances distances_;
  CollisionCounts counts_;
  Vec3d axis_ = Vec3d::Zero();  ///< between the nearest points so far
  double upper_ = infinity;     ///< the least of a pair of faces so far
  double pruned_ = infinity;    ///< the least gap of what was left out since a pair of faces is as near
  std::vector<Faces> found_;
};

/// Of objects that share a point: 0, and such a point.
void answer_contact(const CollisionQuery& query, const Contact& contact, DistanceResult& result) {
  const PosedDistances distances(*query.pose_a, *query.pose_b);
  result.face_a = contact.face_a;
  result.face_b = contact.face_b;
  const std::vector<std::uint32_t> parts_b = query.b->parts(contact.face_b);
  for (const std::uint32_t part_a : query.a->parts(contact.face_a)) {
    for (const std::uint32_t part_b : parts_b) {
      const DistanceBounds bounds =
          distances.tight_bounds(query.a->mesh().primitive(part_a), query.b->mesh().primitive(part_b));
      if (bounds.upper != 0) continue;
      result.point_a = bounds.point_a;
      result.point_b = bounds.point_b;
      return;
    }
  }
}

}  // namespace

DistanceResult distance(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                        const DistanceRequest& request) {
  check(request);
  DistanceResult result;
  const CollisionQuery query = {&a, &pose_a, &b, &pose_b};
  const CollisionResult touching = collide(a, pose_a, b, pose_b);
  result.counts = touching.counts;
  if (touching.hit) {
    answer_contact(query, touching.contacts.front(), result);
  } else {
    DistanceSearch(query, request).run(result);
  }
  return result;
}

}  // namespace cchip
