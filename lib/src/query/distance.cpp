// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cchip/distance.hpp>
#include <cchip/internal/exact/posed_distances.hpp>
#include <cchip/internal/geometry/decimal.hpp>
#include <cchip/internal/judge/face_pairs.hpp>
#include <cchip/internal/judge/near_parts.hpp>
#include <cmath>
#include <limits>
#include <list>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "exact/nearest_planes.hpp"
#include "in_blocks.hpp"
#include "search/behind_plane.hpp"
#include "search/frame_gap.hpp"
#include "search/gap_queue.hpp"
#include "search/query_scale.hpp"
#include "search/simd_distance.hpp"
#include "search/tree_side.hpp"

namespace cchip {
namespace {

using bvh::NodeRef;

using FacePair = std::array<std::uint32_t, 2>;  ///< of A and of B, numbers in the meshes

constexpr double infinity = std::numeric_limits<double>::infinity();
/// A search that takes more steps asks slabs, too: a short one is over before they pay.
constexpr std::uint64_t slab_steps = 256;
constexpr double nearly = 1 - 0x1p-7;

void check(const DistanceRequest& request) {
  if (!(request.rel_error >= 0 && request.rel_error < 1)) {
    throw std::invalid_argument("rel_error is " + decimal_text(request.rel_error) +
                                ": ask for one that is at least 0 and less than 1");
  }
  if (!(request.stop_above >= 0)) {
    throw std::invalid_argument("stop_above is " + decimal_text(request.stop_above) + ": it must be at least 0");
  }
}

/// Planes through nearest points, and which faces lie behind them, as far as that was asked lately.
class KnownPlanes {
 public:
  explicit KnownPlanes(exact::NearestPlanes planes) : planes_(std::move(planes)) {}
  const DistanceBounds& bounds() const { return planes_.bounds(); }
  /// Then they are no nearer than the planes' faces.
  bool contain(const Mesh& mesh_a, std::uint32_t face_a, const Mesh& mesh_b, std::uint32_t face_b) {
    return is_behind(a_, planes_.a(), mesh_a, face_a) && is_behind(b_, planes_.b(), mesh_b, face_b);
  }

 private:
  struct Asked {
    std::uint32_t face = 0xFFFFFFFF;
    bool is_behind = false;
  };
  using Side = std::array<Asked, 256>;
  static bool is_behind(Side& side, const exact::HalfSpace& space, const Mesh& mesh, std::uint32_t face) {
    Asked& asked = side[face % side.size()];
    if (asked.face != face) asked = {face, space.contains(mesh.primitive(face))};
    return asked.is_behind;
  }

  exact::NearestPlanes planes_;
  Side a_;
  Side b_;
};

/// Branch and bound over pairs of nodes, the nearest ones first. Bounds of nodes and of faces are in single precision,
/// squares in the unit of the frame; faces that may be the nearest ones are kept, doubles and then integers decide
/// between them at the end. Those in the unit that QueryScale has chosen.
class DistanceSearch {
 public:
  DistanceSearch(const CollisionQuery& query, const QueryScale& scale, const DistanceRequest& request)
      : scale_(scale),
        request_(request),
        stop_above_(scale.rounded_up(request.stop_above)),
        kernels_(simd::distance_kernels()),
        a_{query.a->mesh(), query.a->tree()},
        b_{query.b->mesh(), query.b->tree()},
        gap_(*query.a, *query.pose_a, *query.b, *query.pose_b),
        distances_(*query.pose_a, *query.pose_b) {}

  /// \pre the objects share no point
  void run(DistanceResult& result) {
    stats_ = result.stats;
    search();
    answer(result);
    result.stats = stats_;
  }

 private:
  struct Faces {
    double lower;  ///< at most the distance
    std::uint32_t a;
    std::uint32_t b;
    std::uint64_t group;  ///< 0 until there are many
  };

  /// The same for parallel faces, mostly.
  static std::uint64_t group_of(const Primitive& p) {
    const Vec3d normal = (p.v[1] - p.v[0]).cross(p.v[2] - p.v[0]);
    const double size = normal.cwiseAbs().maxCoeff();
    if (!(size > 0 && size < infinity)) return 0;
    std::uint64_t group = 0;
    for (const double x : normal) group = group << 16U | static_cast<std::uint16_t>(std::lround(x / size * 0x1p14));
    return group;
  }

  /// What is farther apart than this does not matter any more.
  void set_limit() {
    const double limit = std::min(stop_above_, upper_ * (1 - (1 - 0x1p-20) * request_.rel_error));
    limit_ = static_cast<float>(std::min(limit / unit_ * (1 + 0x1p-20), 1e15));
    most_ = limit_ * limit_ * (1 + 0x1p-20F);
  }
  bool is_pruned(float square) {
    if (square <= most_) return false;
    left_out_ = std::min(left_out_, square);
    return true;
  }
  void set_axis(const Vec3d& axis) {
    gap_.set_axis(axis);
    unit_ = gap_.in_single(frame_);
    set_limit();
  }

  void search() {
    set_axis(gap_.middle_b(b_.tree.lines() + b_.tree.root().first(), b_.tree.root().count()) -
             gap_.middle_a(a_.tree.lines() + a_.tree.root().first(), a_.tree.root().count()));
    queue_.push({0, a_.tree.root(), b_.tree.root()});
    GapQueue::Pair pair;
    while (queue_.pop(most_, pair)) {
      if (is_pruned(pair.square)) continue;
      const bool is_behind = is_behind_planes(pair);
      if (all_behind_) {
        found_.clear();
        return;
      }
      if (is_behind) continue;
      do {
        if (pair.a.is_leaf() && pair.b.is_leaf()) {
          test_leaves(pair.a, pair.b);
          break;
        }
      } while (open(pair));
    }
    left_out_ = std::min(left_out_, queue_.least());
  }

  /// True only if nothing below the item is nearer than the nearest faces so far. Of many pairs at the same distance,
  /// as between parallel faces, bounds in single precision leave each open; the planes through the nearest points do
  /// not. They cost as much as some steps: they wait for as many, but not if the whole objects seem to lie behind them.
  bool is_behind_planes(const GapQueue::Pair& pair) {
    if (!nearest_ || !(is_between_planes_ || pair.square >= nearly * nearly * most_)) return false;
    ++as_near_;
    // Those of earlier faces, which were not nearer, still prune.
    const auto is_behind = [&] {
      if (!planes_help() || !behind_a_->contains(pair.a) || !behind_b_->contains(pair.b)) return false;
      ++behind_;
      return true;
    };
    if (is_behind()) return true;
    const std::uint64_t wait = !is_between_planes_ ? 128 : behind_a_ ? 4 : 1;
    if (planes_of_ == nearest_ || as_near_ < wait) return false;
    make_planes();
    behind_a_.emplace(a_, planes_->a());
    behind_b_.emplace(b_, planes_->b());
    all_behind_ = is_between_planes_ && behind_a_->contains_all() && behind_b_->contains_all();
    return all_behind_ || is_behind();
  }

  /// There are planes, and it pays to ask them: much of what was as near lay behind them.
  bool planes_help() const { return behind_a_ && (is_between_planes_ || as_near_ < 512 || 8 * behind_ > as_near_); }

  /// At most the distance of the objects, by the frame.
  double whole_gap() {
    kernels_.nodes(frame_, a_.tree.lines() + a_.tree.whole().first(), 1, b_.tree.lines() + b_.tree.whole().first(), 1,
                   0, 0, gaps_);
    return std::sqrt(gaps_.square[0]) * unit_;
  }

  /// Those through the nearest points of the nearest faces, which share no point.
  void make_planes() {
    if (planes_of_ == nearest_) return;
    ++stats_.open;
    planes_of_ = nearest_;
    behind_a_.reset();
    behind_b_.reset();
    planes_.emplace(distances_, a_.mesh.primitive((*nearest_)[0]), b_.mesh.primitive((*nearest_)[1]));
  }

  /// Puts the pairs of the nodes below that may be nearer than what is known into the queue, but for the nearest one
  /// where it is hardly farther apart than the pair, or none is known.
  /// \param pair becomes that one
  /// \returns whether there is one
  bool open(GapQueue::Pair& pair) {
    const std::uint32_t count_a = pair.a.count();
    const std::uint32_t count_b = pair.b.count();
    ++stats_.steps;
    stats_.box_tests += std::uint64_t{count_a} * count_b;
    const bvh::SupportLine* const lines_a = a_.tree.lines() + pair.a.first();
    const bvh::SupportLine* const lines_b = b_.tree.lines() + pair.b.first();
    unsigned near = kernels_.nodes(frame_, lines_a, count_a, lines_b, count_b, pair.square, most_, gaps_);
    left_out_ = std::min(left_out_, gaps_.left_out);
    if (near == 0) return false;
    if (stats_.steps > slab_steps) near = near_by_slabs(near, lines_a, lines_b);
    const unsigned nearest =
        nearest_of(near, nearest_ ? 1.5625F * pair.square : std::numeric_limits<float>::infinity());
    const GapQueue::Pair above = pair;
    for (unsigned left = near; left != 0; left &= left - 1) {
      const unsigned number = lowest_bit(left);
      const std::uint32_t i = number / 4;
      const std::uint32_t k = number % 4;
      const GapQueue::Pair below = {gaps_.square[number], a_.below(above.a.first() + i, lines_b[k].ref().is_leaf()),
                                    b_.below(above.b.first() + k, lines_a[i].ref().is_leaf())};
      if (number == nearest) {
        pair = below;
      } else {
        queue_.push(below);
      }
    }
    return nearest != 16;
  }

  /// The one of `near` with the least gap, which is at most `most`, or 16; of those with about the same gap, as between
  /// flat parts, the one whose middles are nearest.
  unsigned nearest_of(unsigned near, float most) const {
    unsigned nearest = 16;
    float least = most;
    for (unsigned left = near; left != 0; left &= left - 1) {
      const unsigned number = lowest_bit(left);
      if (!(gaps_.square[number] <= least)) continue;
      nearest = number;
      least = gaps_.square[number];
    }
    if (nearest == 16) return nearest;
    float least_between = std::numeric_limits<float>::infinity();
    for (unsigned left = near; left != 0; left &= left - 1) {
      const unsigned number = lowest_bit(left);
      if (!(gaps_.square[number] <= least * 1.01F)) continue;
      float between = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& a = gaps_.a[number / 4];
        const auto& b = gaps_.b[number % 4];  // its lanes are along the opposite directions
        const float x = 2 * frame_.centre_b[k] - (a[2 * k] - a[2 * k + 1]) - (b[2 * k] - b[2 * k + 1]);
        between += x * x;
      }
      if (!(between < least_between)) continue;
      nearest = number;
      least_between = between;
    }
    return nearest;
  }

  /// In a long search, by the slabs of both.
  unsigned near_by_slabs(unsigned near, const bvh::SupportLine* lines_a, const bvh::SupportLine* lines_b) {
    std::array<FrameGap::FrameSlab, 4>& slabs_a = slabs_[0];
    std::array<FrameGap::FrameSlab, 4>& slabs_b = slabs_[1];
    unsigned made_a = 0;
    unsigned made_b = 0;
    for (unsigned left = near; left != 0; left &= left - 1) {
      const unsigned number = lowest_bit(left);
      const std::uint32_t i = number / 4;
      const std::uint32_t k = number % 4;
      if ((made_a >> i & 1U) == 0) slabs_a[i] = gap_.slab_a(lines_a[i], gaps_.a[i]);
      if ((made_b >> k & 1U) == 0) slabs_b[k] = gap_.slab_b(lines_b[k], gaps_.b[k]);
      made_a |= 1U << i;
      made_b |= 1U << k;
      const double gap = gap_.slab_gap(slabs_a[i], slabs_b[k]);
      if (!(gap > 0)) continue;
      gaps_.square[number] = std::max(gaps_.square[number], static_cast<float>(gap * gap * (1 - 0x1p-22)));
      if (is_pruned(gaps_.square[number])) near &= ~(1U << number);
    }
    return near;
  }
  static unsigned lowest_bit(unsigned bits) { return static_cast<unsigned>(__builtin_ctz(bits)); }

  void test_leaves(NodeRef leaf_a, NodeRef leaf_b) {
    const std::uint32_t pairs = leaf_a.count() * leaf_b.count();
    stats_.pairs += pairs;
    if (!kernels_.leaves(frame_, a_.tree.vertices(leaf_a.first()), leaf_a, b_.tree.vertices(leaf_b.first()), leaf_b,
                         limit_, faces_)) {
      // All are beyond what is known; a bound for an answer that need not be exact.
      for (std::uint32_t i = 0; i < pairs; ++i) leave_out(faces_.lower[number(i, leaf_b)]);
      return;
    }
    for (std::uint32_t i = 0; i < pairs; ++i) {
      const float lower = faces_.lower[number(i, leaf_b)];
      if (leave_out(lower)) continue;
      const std::uint32_t face_a = a_.tree.faces()[leaf_a.first() + i / leaf_b.count()];
      const std::uint32_t face_b = b_.tree.faces()[leaf_b.first() + i % leaf_b.count()];
      const bool is_nearer = faces_.upper[number(i, leaf_b)] * unit_ < upper_ || !nearest_;
      if (is_nearer) {
        refine({lower * unit_, face_a, face_b, 0});
        continue;
      }
      // Between parallel faces only the planes see which are nearer.
      if (planes_help() && is_behind(face_a, face_b)) continue;
      // In doubles, along the line that single precision has found.
      const std::size_t at = number(i, leaf_b);
      const Vec3d between(faces_.between[0][at], faces_.between[1][at], faces_.between[2][at]);
      const double gap =
          distances_.gap_along(gap_.in_world(between), a_.mesh.primitive(face_a), b_.mesh.primitive(face_b));
      const Faces faces = {std::max(gap, lower * unit_), face_a, face_b, 0};
      if (faces.lower < upper_ * (1 - 0x1p-20)) {
        refine(faces);
      } else if (faces.lower < upper_) {
        found_.push_back(faces);
      }
    }
  }
  bool leave_out(float gap) { return is_pruned(gap * gap * (1 - 0x1p-22F)); }
  /// No nearer than the faces of the planes.
  bool is_behind(std::uint32_t face_a, std::uint32_t face_b) const {
    return planes_->a().contains(a_.mesh.primitive(face_a)) && planes_->b().contains(b_.mesh.primitive(face_b));
  }
  static std::size_t number(std::uint32_t pair, NodeRef leaf_b) {
    return 2 * std::size_t{pair / leaf_b.count()} + pair % leaf_b.count();
  }

  /// Bounds in doubles of faces that may be the nearest ones.
  void refine(Faces faces) {
    const DistanceBounds bounds = distances_.bounds(a_.mesh.primitive(faces.a), b_.mesh.primitive(faces.b));
    faces.lower = std::max(faces.lower, bounds.lower);
    found_.push_back(faces);
    if (nearest_ && !(bounds.upper < upper_)) return;
    upper_ = bounds.upper;
    best_ = bounds;
    nearest_ = {faces.a, faces.b};
    as_near_ = behind_ = 0;
    set_axis(axis_of(faces));
    const double whole = whole_gap();
    is_between_planes_ = whole >= nearly * upper_ && whole + gap_.resolution() >= upper_;
  }

  /// Along the line between the nearest points, or across one of the faces if the whole objects lie on both sides of a
  /// gap there, as flat parts do: there these faces may not be the nearest ones, but all bounds are close.
  Vec3d axis_of(const Faces& faces) const {
    const Vec3d line = best_.point_b - best_.point_a;
    const auto gap = [this](const Vec3d& axis) {
      return gap_.rough_gap(axis, a_.tree.lines()[a_.tree.whole().first()], b_.tree.lines()[b_.tree.whole().first()]);
    };
    double most = gap(line);
    if (most >= nearly * upper_) return line;
    most = std::max(most, upper_ / 2);
    Vec3d axis = line;
    for (Vec3d normal : {gap_.normal_a(a_.mesh.primitive(faces.a)), gap_.normal_b(b_.mesh.primitive(faces.b))}) {
      if (normal.dot(line) < 0) normal = -normal;
      const double across = gap(normal);
      if (!(across > most)) continue;
      most = across;
      axis = normal;
    }
    return axis;
  }

  void answer(DistanceResult& result) {
    if (!nearest_) return answer_above(result);
    // What is left out of an exact search is no nearer than the nearest faces.
    if (request_.rel_error > 0) pruned_ = std::sqrt(static_cast<double>(left_out_)) * unit_ * (1 - 0x1p-20);
    double lower = std::min(pruned_, best_.lower);
    settle(lower);
    result.lower = scale_.lower(lower);
    if (result.lower > request_.stop_above) return answer_above(result);
    result.upper = scale_.upper(best_.upper);
    result.point_a = scale_.point(best_.point_a);
    result.point_b = scale_.point(best_.point_b);
    result.face_a = a_.mesh.number_in_file((*nearest_)[0]);
    result.face_b = b_.mesh.number_in_file((*nearest_)[1]);
  }

  /// Decides between the faces that were found.
  void settle(double& lower) {
    double least = infinity;  // of those that may be nearer
    const auto is_left = [&](const Faces& faces) {
      if (!(faces.lower < upper_) || nearest_ == FacePair{faces.a, faces.b}) return false;
      least = std::min(least, faces.lower);
      return true;
    };
    found_.erase(std::remove_if(found_.begin(), found_.end(), [&](const Faces& x) { return !is_left(x); }),
                 found_.end());
    lower = std::min({pruned_, best_.lower, least});
    if (best_.upper < infinity && best_.upper - lower <= request_.rel_error * best_.upper) return;
    // Few may end early. Many are at the same distance: those whose faces of A are parallel are behind the same planes.
    constexpr std::size_t few = 64;
    if (found_.size() > few) {
      for (Faces& faces : found_) faces.group = group_of(a_.mesh.primitive(faces.a));
    }
    std::sort(found_.begin(), found_.end(), [](const Faces& x, const Faces& y) {
      return std::tie(x.group, x.lower, x.a, x.b) < std::tie(y.group, y.lower, y.a, y.b);
    });
    make_planes();
    best_ = planes_->bounds();
    std::list<KnownPlanes> known;
    known.emplace_back(*planes_);
    for (const Faces& faces : found_) {
      if (!(faces.lower < best_.lower)) continue;
      const bool is_behind = std::any_of(known.begin(), known.end(), [&](KnownPlanes& planes) {
        return planes.contain(a_.mesh, faces.a, b_.mesh, faces.b);
      });
      if (is_behind) continue;
      const Primitive a = a_.mesh.primitive(faces.a);
      const Primitive b = b_.mesh.primitive(faces.b);
      if (distances_.bounds(a, b).lower >= best_.lower) continue;
      constexpr std::size_t most_known = 4;
      if (known.size() == most_known) known.pop_back();
      known.emplace_front(exact::NearestPlanes(distances_, a, b));
      ++stats_.open;
      const DistanceBounds& bounds = known.front().bounds();
      if (!(bounds.lower < best_.lower || (bounds.lower == best_.lower && bounds.upper < best_.upper))) continue;
      nearest_ = {faces.a, faces.b};
      best_ = bounds;
    }
    lower = std::min(pruned_, best_.lower);
  }

  void answer_above(DistanceResult& result) const {
    result.lower = std::min(request_.stop_above, std::numeric_limits<double>::max());
    result.upper = infinity;
  }

  const QueryScale& scale_;
  const DistanceRequest& request_;
  const double stop_above_;  ///< DistanceRequest::stop_above in the unit of the search, at least
  const simd::DistanceKernels& kernels_;
  const TreeSide a_;
  const TreeSide b_;
  FrameGap gap_;
  simd::DistanceFrame frame_;
  double unit_ = 1;  ///< of the frame
  simd::NodeGaps gaps_;
  std::array<std::array<FrameGap::FrameSlab, 4>, 2> slabs_;
  simd::FaceGaps faces_;
  const PosedDistances distances_;
  CollisionStats stats_;
  GapQueue queue_;
  float limit_ = 0;                                          ///< in the unit of the frame
  float most_ = 0;                                           ///< its square
  float left_out_ = std::numeric_limits<float>::infinity();  ///< the least square of what was left out
  std::vector<Faces> found_;
  double upper_ = infinity;   ///< the least of a pair of faces so far
  double pruned_ = infinity;  ///< of an answer that need not be exact: at most the distance of what was left out
  std::optional<FacePair> nearest_;
  DistanceBounds best_;             ///< of these
  std::uint64_t as_near_ = 0;       ///< items since then that are about as near
  std::uint64_t behind_ = 0;        ///< of these lie behind planes
  bool is_between_planes_ = false;  ///< by the frame the whole objects are as far apart, as closely as it tells
  std::optional<exact::NearestPlanes> planes_;
  bool all_behind_ = false;  ///< nothing is nearer than the faces that planes_ is of
  std::optional<FacePair> planes_of_;
  std::optional<BehindPlane> behind_a_;
  std::optional<BehindPlane> behind_b_;
};

/// Of objects that share a point: 0, and such a point.
void answer_contact(const CollisionQuery& query, const QueryScale& scale, const Contact& contact,
                    DistanceResult& result) {
  const PosedDistances distances(*query.pose_a, *query.pose_b);
  result.face_a = contact.face_a;
  result.face_b = contact.face_b;
  const PosedPairs pairs(*query.pose_a, *query.pose_b);
  any_near_parts(query, contact, [&](std::uint32_t part_a, std::uint32_t part_b) {
    const Primitive a = query.a->mesh().primitive(part_a);
    const Primitive b = query.b->mesh().primitive(part_b);
    if (!pairs.decide(a, b).hit) return false;
    const DistanceBounds bounds = distances.tight_bounds(a, b);
    result.point_a = scale.point(bounds.point_a);
    result.point_b = scale.point(bounds.point_b);
    return true;
  });
}

}  // namespace

DistanceResult distance(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                        const DistanceRequest& request) {
  check(request);
  DistanceResult result;
  const CollisionResult touching = collide(a, pose_a, b, pose_b);
  result.stats = touching.stats;
  const QueryScale scale({&a, &pose_a, &b, &pose_b});
  const Pose scaled_a = scale(pose_a);
  const Pose scaled_b = scale(pose_b);
  const CollisionQuery query = {&a, &scaled_a, &b, &scaled_b};
  if (touching.hit) {
    answer_contact(query, scale, touching.contacts.front(), result);
  } else {
    DistanceSearch(query, scale, request).run(result);
  }
  return result;
}

std::vector<DistanceResult> distances(const Object& object, const Pose& pose, const std::vector<Vec3d>& points,
                                      const DistanceRequest& request, unsigned threads) {
  Mesh mesh;  // one point, which poses bring to the others
  mesh.vertices.emplace_back(Vec3d::Zero());
  mesh.faces.push_back({Kind::tri, {0, 0, 0}});
  const Object origin(std::move(mesh));
  std::vector<Pose> places(points.size(), Pose::Identity());
  for (std::size_t i = 0; i < points.size(); ++i) {
    places[i].translation() = points[i];
    check_pose(places[i], ("point " + std::to_string(i)).c_str());
  }
  std::vector<DistanceResult> results(points.size());
  constexpr std::size_t block = 256;  // points that one thread takes at a time
  in_blocks(points.size(), block, threads,
            [&] { return [&](std::size_t i) { results[i] = distance(object, pose, origin, places[i], request); }; });
  return results;
}

}  // namespace cchip
