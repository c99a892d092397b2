// SPDX-License-Identifier: Apache-2.0
// B is moved by s d. A set in A and one in B can only meet while n p = n q + s (n d) for some p and q, for any vector
// n. So each n bounds s, in doubles rounded outward: the 13 directions of volumes for nodes of the trees, the normals
// of the difference of two faces for these. Integers say exactly when two faces meet, where that decides.
#include <algorithm>
#include <array>
#include <cchip/along.hpp>
#include <cchip/internal/tree/support_tree.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <stdexcept>
#include <vector>

#include "exact/meeting.hpp"
#include "search/dop_pairs.hpp"
#include "search/tree_side.hpp"

namespace cchip {
namespace {

using bvh::Dop26;
using bvh::NodeRef;
using exact::Fraction;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What is left of s >= 0.
struct Span {
  double low = 0;
  double high = infinity;

  bool is_empty() const { return low > high; }
  /// Leaves out s for which s h < x. Neither a NaN nor an infinity leaves out anything that it should not.
  void require(double h, double x) {
    constexpr double more = 1 + 0x1p-50;  // for the rounding of x and of the quotient
    constexpr double less = 1 - 0x1p-50;
    constexpr double lost = 0x1p-1070;  // more than what underflows
    if (!(x > 0)) {
      if (h < 0) high = std::min(high, x / h * more + lost);
    } else if (h > 0) {
      low = std::max(low, x / h * less - lost);
    } else if (h <= 0) {
      high = -1;
    }
  }
};

/// n d for a vector n and the direction d, at least and at most.
struct Rate {
  Rate(const Vec3d& n, const Vec3d& d) {
    const double rate = n.dot(d);
    const double slack = 0x1p-50 * n.cwiseAbs().dot(d.cwiseAbs()) + 0x1p-1000 * n.cwiseAbs().sum();
    low = rate - slack;
    high = rate + slack;
  }
  Rate() = default;
  double low = 0;
  double high = 0;
};

/// When sets meet whose products with n are in these ranges.
void narrow(Span& span, const Rate& rate, double low_a, double high_a, double low_b, double high_b) {
  span.require(rate.high, low_a - high_b);
  span.require(-rate.low, low_b - high_a);
}

double extent(const Object& object) {
  return object.tree().centre().cwiseAbs().maxCoeff() + 2 * bvh::support_most * object.tree().unit();
}
double row_sum(const Pose& pose) { return pose.linear().cwiseAbs().rowwise().sum().maxCoeff(); }

/// When volumes may meet.
class VolumeSpans {
 public:
  VolumeSpans(const CollisionQuery& query, const Vec3d& direction)
      : volumes_(*query.a, *query.pose_a, *query.b, *query.pose_b) {
    for (std::size_t k = 0; k < rates_.size(); ++k) {
      rates_[k] = Rate(volumes_.world().col(static_cast<Eigen::Index>(k)), direction);
    }
  }
  Dop26 volume_a(const Dop26& dop) const { return volumes_.volume_a(dop); }
  Dop26 volume_b(const Dop26& dop) const { return volumes_.volume_b(dop); }
  void narrow(Span& span, const Dop26& a, const Dop26& b) const {
    for (std::size_t k = 0; k < rates_.size(); ++k) {
      cchip::narrow(span, rates_[k], a.least[k], a.greatest[k], b.least[k], b.greatest[k]);
    }
  }

 private:
  DopPairs volumes_;
  std::array<Rate, bvh::directions.size()> rates_;
};

/// When faces may meet, nearly as exactly as doubles can tell.
class FaceSpans {
 public:
  FaceSpans(const CollisionQuery& query, const Vec3d& direction)
      : pose_a_(*query.pose_a), pose_b_(*query.pose_b), direction_(direction) {
    const Vec3d between = pose_a_.translation() - pose_b_.translation();
    const double size =
        row_sum(pose_a_) * extent(*query.a) + row_sum(pose_b_) * extent(*query.b) + between.cwiseAbs().maxCoeff();
    pose_a_.translation() = between;
    pose_b_.translation().setZero();
    is_moderate_ = size > 0x1p-950 && size < 0x1p1000;
    if (is_moderate_) exponent_ = std::ilogb(size) + 1;
  }

  void narrow(Span& span, const Primitive& a, const Primitive& b) const {
    if (!is_moderate_) return;
    const Points points_a(a, pose_a_, exponent_);
    const Points points_b(b, pose_b_, exponent_);
    Span scaled;
    // Normals of the facets of the difference of the two sets; of faces in one plane, or that are less than flat, it is
    // flat itself, and its edges tell.
    for (const Points* points : {&points_a, &points_b}) {
      const Vec3d normal = points->edge[1].cross(points->edge[0]);
      for (std::size_t i = 0; i < points->edges; ++i) {
        for (std::size_t k = 0; k < i; ++k) along(points->edge[i].cross(points->edge[k]), points_a, points_b, scaled);
        along(points->edge[i].cross(normal), points_a, points_b, scaled);
        along(points->edge[i].cross(direction_), points_a, points_b, scaled);
        if (scaled.is_empty()) break;
      }
    }
    for (std::size_t i = 0; i < points_a.edges && !scaled.is_empty(); ++i) {
      for (std::size_t k = 0; k < points_b.edges; ++k) {
        along(points_a.edge[i].cross(points_b.edge[k]), points_a, points_b, scaled);
      }
    }
    if (scaled.is_empty()) {
      span.high = -1;
      return;
    }
    span.low = std::max(span.low, std::ldexp(scaled.low, exponent_) - 0x1p-1070);
    span.high = std::min(span.high, std::ldexp(scaled.high, exponent_) + 0x1p-1070);
  }

 private:
  /// Vertices relative to B's translation, in units of 2^exponent, so that no coordinate is above 1.
  struct Points {
    Points(const Primitive& p, const Pose& pose, int exponent) : count(p.vertex_count()) {
      for (std::size_t i = 0; i < count; ++i) {
        for (Eigen::Index k = 0; k < 3; ++k) {
          point[i][k] = std::ldexp(
              pose(k, 0) * p.v[i][0] + pose(k, 1) * p.v[i][1] + pose(k, 2) * p.v[i][2] + pose(k, 3), -exponent);
        }
        for (std::size_t k = 0; k < i; ++k) edge[edges++] = point[i] - point[k];
      }
    }
    std::size_t count;
    std::size_t edges = 0;
    std::array<Vec3d, 4> point;
    std::array<Vec3d, 6> edge;
  };

  /// With u = 2^-53: the rounding of a coordinate is below 8u, that of its products and their sum 4u |n|_1, that of
  /// the difference 2u |n|_1. A slack of 2^-47 |n|_1 = 64u |n|_1 covers that of both sides.
  void along(const Vec3d& n, const Points& a, const Points& b, Span& span) const {
    const double size = n.cwiseAbs().sum();
    if (!(size > 0x1p-400)) return;
    const auto range = [&n](const Points& points) {
      std::pair<double, double> r = {infinity, -infinity};
      for (std::size_t i = 0; i < points.count; ++i) {
        const double x = n.dot(points.point[i]);
        r = {std::min(r.first, x), std::max(r.second, x)};
      }
      return r;
    };
    const auto [low_a, high_a] = range(a);
    const auto [low_b, high_b] = range(b);
    const double slack = 0x1p-47 * size;
    cchip::narrow(span, Rate(n, direction_), low_a - slack, high_a + slack, low_b, high_b);
  }

  Pose pose_a_;  ///< relative to B's translation
  Pose pose_b_;
  Vec3d direction_;
  int exponent_ = 0;
  bool is_moderate_ = false;
};

/// Pairs of nodes and of faces with bounds on when they meet. The direction is scaled by a power of two such that its
/// greatest component is at least 1 and less than 2.
class Search {
 public:
  Search(const CollisionQuery& query, const Vec3d& direction)
      : query_(query),
        a_{query.a->mesh(), query.a->tree()},
        b_{query.b->mesh(), query.b->tree()},
        direction_(direction),
        exponent_(std::ilogb(direction.cwiseAbs().maxCoeff())),
        volumes_(query, scaled(direction)),
        faces_(query, scaled(direction)) {}

  struct Item {
    Span span;
    NodeRef a;
    NodeRef b;
    bool is_faces = false;  ///< a.first() and b.first() are faces of the meshes
  };
  struct Met {
    exact::Meeting when;  ///< for the scaled direction
    std::uint32_t face_a;
    std::uint32_t face_b;
  };

  Item all() const { return {{}, a_.tree.root(), b_.tree.root()}; }

  /// Calls take(item) for all pairs below a pair of nodes that may meet for some s >= 0.
  template <class Take>
  void expand(const Item& item, const Take& take) {
    if (item.a.is_leaf() && item.b.is_leaf()) return expand_leaves(item, take);
    ++stats_.steps;
    stats_.box_tests += std::uint64_t{item.a.count()} * item.b.count();
    std::array<Dop26, 4> volumes_b;
    for (std::uint32_t k = 0; k < item.b.count(); ++k) {
      volumes_b[k] = volumes_.volume_b(b_.volume(b_.tree.lines()[item.b.first() + k]));
    }
    for (std::uint32_t i = item.a.first(); i < item.a.first() + item.a.count(); ++i) {
      const Dop26 volume_a = volumes_.volume_a(a_.volume(a_.tree.lines()[i]));
      for (std::uint32_t k = 0; k < item.b.count(); ++k) {
        Item below;
        below.span = item.span;
        volumes_.narrow(below.span, volume_a, volumes_b[k]);
        if (below.span.is_empty()) continue;
        const std::uint32_t line_b = item.b.first() + k;
        below.a = a_.below(i, b_.tree.lines()[line_b].ref().is_leaf());
        below.b = b_.below(line_b, a_.tree.lines()[i].ref().is_leaf());
        take(below);
      }
    }
  }

  /// Of a pair of faces.
  std::optional<Met> meeting(const Item& item) {
    ++stats_.open;
    const std::uint32_t face_a = item.a.first();
    const std::uint32_t face_b = item.b.first();
    const auto when = exact::meeting(a_.mesh.primitive(face_a), *query_.pose_a, b_.mesh.primitive(face_b),
                                     *query_.pose_b, direction_);
    if (!when) return std::nullopt;
    return Met{{shifted(when->first, exponent_), shifted(when->last, exponent_)},
               a_.mesh.number_in_file(face_a),
               b_.mesh.number_in_file(face_b)};
  }

  /// \param factor of the scaled direction
  void answer(const Fraction& factor, AlongResult& result) const {
    const Fraction own = shifted(factor, -exponent_);
    result.factor = own.nearest;
    result.lower = own.low;
    result.upper = own.high;
    result.stats += stats_;
  }

 private:
  Vec3d scaled(const Vec3d& direction) const {
    return direction.unaryExpr([this](double x) { return std::ldexp(x, -exponent_); });
  }
  static Fraction shifted(const Fraction& x, int by) {
    return x.over == 0 ? Fraction() : Fraction(x.over, x.under, x.exponent + by);
  }

  template <class Take>
  void expand_leaves(const Item& item, const Take& take) {
    for (std::uint32_t i = item.a.first(); i < item.a.first() + item.a.count(); ++i) {
      for (std::uint32_t k = item.b.first(); k < item.b.first() + item.b.count(); ++k) {
        const std::uint32_t face_a = a_.tree.faces()[i];
        const std::uint32_t face_b = b_.tree.faces()[k];
        ++stats_.pairs;
        Item below = {item.span, NodeRef::leaf(face_a, 1, false), NodeRef::leaf(face_b, 1, false), true};
        faces_.narrow(below.span, a_.mesh.primitive(face_a), b_.mesh.primitive(face_b));
        if (!below.span.is_empty()) take(below);
      }
    }
  }

  const CollisionQuery& query_;
  const TreeSide a_;
  const TreeSide b_;
  const Vec3d direction_;
  const int exponent_;
  const VolumeSpans volumes_;
  const FaceSpans faces_;
  CollisionStats stats_;
};

/// Smallest key first.
template <class T, class Later>
using Queue = std::priority_queue<T, std::vector<T>, Later>;

struct BeginsLater {
  bool operator()(const Search::Item& x, const Search::Item& y) const { return x.span.low > y.span.low; }
  bool operator()(const Search::Met& x, const Search::Met& y) const { return compare(x.when.first, y.when.first) > 0; }
};
struct EndsEarlier {
  bool operator()(const Search::Item& x, const Search::Item& y) const { return x.span.high < y.span.high; }
};

/// The objects touch from 0 to `front`. Pairs that may meet at the front are looked at, those that may meet for longest
/// first; others wait until the front reaches them.
class ClearSearch {
 public:
  explicit ClearSearch(Search& search) : search_(search) {}

  /// \param result has two faces that touch at 0
  void run(AlongResult& result) {
    insert(search_.all());
    while (!at_front_.empty() && at_front_.top().span.high > front_.low) {
      const Search::Item item = at_front_.top();
      at_front_.pop();
      if (!item.is_faces) {
        search_.expand(item, [this](const Search::Item& below) { insert(below); });
        continue;
      }
      std::optional<Search::Met> met = search_.meeting(item);
      if (!met || compare(met->when.last, front_) <= 0) continue;
      later_faces_.push(std::move(*met));
      move_front(result);
    }
    search_.answer(front_, result);
  }

 private:
  void insert(const Search::Item& item) {
    if (item.span.high <= front_.low) return;
    if (item.span.low <= front_.high) {
      at_front_.push(item);
    } else {
      later_.push(item);
    }
  }

  void move_front(AlongResult& result) {
    while (!later_faces_.empty() && compare(later_faces_.top().when.first, front_) <= 0) {
      const Search::Met& met = later_faces_.top();
      if (compare(met.when.last, front_) > 0) {
        front_ = met.when.last;
        result.face_a = met.face_a;
        result.face_b = met.face_b;
      }
      later_faces_.pop();
    }
    while (!later_.empty() && later_.top().span.low <= front_.high) {
      insert(later_.top());
      later_.pop();
    }
  }

  Search& search_;
  Fraction front_;
  Queue<Search::Item, EndsEarlier> at_front_;
  Queue<Search::Item, BeginsLater> later_;       ///< beyond the front
  Queue<Search::Met, BeginsLater> later_faces_;  ///< faces that meet only beyond the front, exactly
};

/// \pre the objects are apart
void search_contact(Search& search, AlongResult& result) {
  Queue<Search::Item, BeginsLater> queue;
  std::optional<Search::Met> best;
  const auto is_too_late = [&best](const Search::Item& item) { return best && item.span.low >= best->when.first.high; };
  queue.push(search.all());
  while (!queue.empty() && !is_too_late(queue.top())) {
    const Search::Item item = queue.top();
    queue.pop();
    if (!item.is_faces) {
      search.expand(item, [&](const Search::Item& below) {
        if (!is_too_late(below)) queue.push(below);
      });
      continue;
    }
    std::optional<Search::Met> met = search.meeting(item);
    if (!met || met->when.first.over < 0) continue;  // then they are apart for all s >= 0, as they are for 0
    if (!best || compare(met->when.first, best->when.first) < 0) best = std::move(met);
  }
  result.touches = best.has_value();
  search.answer(best ? best->when.first : Fraction(), result);
  if (best) {
    result.face_a = best->face_a;
    result.face_b = best->face_b;
  } else {
    result.factor = result.lower = result.upper = infinity;
  }
}

void check(const Vec3d& direction) {
  if (!direction.allFinite() || direction.isZero(0)) {
    throw std::invalid_argument("the direction is zero or not finite: give a vector along which object B may move");
  }
}

/// Do they touch as they are? Then the factor is 0, with two faces.
AlongResult at_once(const CollisionQuery& query) {
  const CollisionResult now = collide(*query.a, *query.pose_a, *query.b, *query.pose_b);
  AlongResult result;
  result.touches = now.hit;
  result.stats = now.stats;
  if (now.hit) {
    result.face_a = now.contacts.front().face_a;
    result.face_b = now.contacts.front().face_b;
  }
  return result;
}

}  // namespace

AlongResult clear_along(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                        const Vec3d& direction) {
  check(direction);
  const CollisionQuery query = {&a, &pose_a, &b, &pose_b};
  AlongResult result = at_once(query);
  if (!result.touches) return result;
  Search search(query, direction);
  ClearSearch(search).run(result);
  return result;
}

AlongResult first_contact(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                          const Vec3d& direction) {
  check(direction);
  const CollisionQuery query = {&a, &pose_a, &b, &pose_b};
  AlongResult result = at_once(query);
  if (result.touches) return result;
  Search search(query, direction);
  search_contact(search, result);
  return result;
}

}  // namespace cchip
