// SPDX-License-Identifier: Apache-2.0
// Which of the four combinations of inside and outside of A and of B occur in space?
//
// The surfaces of A and B together cut space into cells, on each of which "inside A" and "inside B" are constant. The
// answer is which of (in, in), (in, out), (out, in) occur. Let R be all the space of one of these, without the pieces
// of surface on both sides of which it lies. If R is not empty, it is bounded, so a piece of a face belongs to its
// boundary: on one side of the piece is R, on the other is not. So it is enough to look at both sides of a point of
// every piece of every face, and only pieces on which something changes matter:
// - Of faces of A that touch no face of B and hang together by vertices, all points are on the same side of B. Where A
//   changes, one side is in A and one is not, so all such points say the same: one is enough.
// - A face that touches some is cut by them. Where B's surface does not lie in it and A changes, faces of A that cut it
//   make no difference, for the same reason. Otherwise it is cut by A's as well.
//
// A point of a piece and its sides: the piece is bounded by a part of a cut, unless the face is not cut at all. The
// point is the middle of the part, moved by e along w, into the piece, and by e^2 along the cut, for an e above 0 that
// is as small as needed: only signs matter, and of a linear function at such a point the sign is the first one of its
// values at the middle, along w and along the cut that is not 0. A line through it along an axis passes no edge of any
// triangle and meets the planes of no other faces on this one. So the triangles that it passes above and below count
// the crossings of two rays, which start on the two sides of the point.
//
// All numbers are integers: vertices in units of 2^exponent, points with a denominator.
#include <algorithm>
#include <array>
#include <cchip/cpu/solids.hpp>
#include <cchip/internal/collide/face_pairs.hpp>
#include <cchip/internal/exact/posed_pairs.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>

#include "exact/scaled_points.hpp"

namespace cchip {
namespace {

using exact::BigInt;
using Vector = exact::Vec<BigInt>;

constexpr double infinity = std::numeric_limits<double>::infinity();

int sign(const BigInt& x) { return x.sign(); }
BigInt dot(const Vector& p, const Vector& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
Vector times(const Vector& p, const BigInt& x) { return {p[0] * x, p[1] * x, p[2] * x}; }
Vector sum(const Vector& p, const Vector& q) { return {p[0] + q[0], p[1] + q[1], p[2] + q[2]}; }

/// The point x / w. \pre w > 0
struct Point {
  Vector x;
  BigInt w;
  friend bool operator==(const Point& p, const Point& q) { return times(p.x, q.w) == times(q.x, p.w); }
};

/// Lower and upper bound of a number.
struct Range {
  double low;
  double high;
};

/// Bounds of x / w * 2^exponent.
Range range_of(const BigInt& x, const BigInt& w, int exponent) {
  if (x.is_zero()) return {0, 0};
  const BigInt size = abs(x);
  const int shift = 64 + static_cast<int>(msb(w)) - static_cast<int>(msb(size));  // the quotient has 64 or 65 bits
  const BigInt quotient = shift >= 0 ? BigInt((size << shift) / w) : BigInt(size / (w << -shift));
  const double value = std::ldexp(quotient.convert_to<double>(), exponent - shift);
  const double low = value * (1 - 0x1p-50) - 0x1p-1070;
  const double high = value * (1 + 0x1p-50) + 0x1p-1070;
  return x.sign() > 0 ? Range{low, high} : Range{-high, -low};
}

/// The product of two doubles that are not 0, as mantissa * 2^exponent with an odd mantissa: small numbers for models
/// in whole units.
struct Product {
  Product(exact::Scaled x, exact::Scaled y) : exponent(x.exponent + y.exponent) {
    for (exact::Scaled* factor : {&x, &y}) {
      for (; factor->mantissa % 2 == 0; ++exponent) factor->mantissa /= 2;
    }
    mantissa = BigInt(x.mantissa) * y.mantissa;
  }
  BigInt mantissa;
  int exponent;
};

/// exact::common_exponent() and exact::scaled_points() for these.
int common_exponent(const Primitive& p, const Pose& pose, int so_far) {
  exact::for_each_product(p, pose, [&so_far](std::size_t, std::size_t, const exact::Scaled& x, const exact::Scaled& y) {
    so_far = std::min(so_far, Product(x, y).exponent);
  });
  return so_far;
}
std::array<Vector, 4> scaled_points(const Primitive& p, const Pose& pose, int exponent) {
  std::array<Vector, 4> points;
  exact::for_each_product(p, pose, [&](std::size_t i, std::size_t k, const exact::Scaled& x, const exact::Scaled& y) {
    const Product product(x, y);
    points[i][k] += product.mantissa << (product.exponent - exponent);
  });
  return points;
}

/// More than these are looked for only if they do not tell everything.
constexpr std::size_t some_contacts = 256;

using Triangle = std::uint32_t;

/// A placed object as triangles.
class Side {
 public:
  Side(const Object& object, const Pose& pose) : object_(object), pose_(pose) {
    const Mesh& mesh = object.mesh();
    first_.reserve(mesh.faces.size() + 1);
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
      first_.push_back(static_cast<Triangle>(triangles_.size()));
      const auto& v = mesh.faces[f].vertex;
      triangles_.push_back({{v[0], v[1], v[2]}, f});
      if (mesh.faces[f].kind == Kind::quad) triangles_.push_back({{v[0], v[2], v[3]}, f});
    }
    first_.push_back(static_cast<Triangle>(triangles_.size()));
    make_boxes();
  }

  const Object& object() const { return object_; }
  const Pose& pose() const { return pose_; }
  std::uint32_t face_count() const { return static_cast<std::uint32_t>(first_.size() - 1); }
  Triangle first(std::uint32_t face) const { return first_[face]; }
  Triangle count() const { return static_cast<Triangle>(triangles_.size()); }
  std::uint32_t face(Triangle t) const { return triangles_[t].face; }
  std::uint32_t vertex(Triangle t, std::size_t i) const { return triangles_[t].vertex[i]; }
  /// In object coordinates.
  Primitive primitive(Triangle t) const {
    Primitive p;
    for (std::size_t i = 0; i < 3; ++i) p.v[i] = object_.mesh().vertices[vertex(t, i)];
    return p;
  }

  /// Greatest exponent such that all coordinates in the world are multiples of 2^exponent; `so_far` if that is less.
  int common_exponent(int so_far) const {
    for (std::uint32_t f = 0; f < face_count(); ++f) {
      so_far = cchip::common_exponent(object_.mesh().primitive(f), pose_, so_far);
    }
    return so_far;
  }
  void set_exponent(int exponent) { exponent_ = exponent; }

  const std::array<Vector, 3>& corners(Triangle t) { return placed(t).corner; }
  /// Zero if the triangle is collapsed.
  const Vector& normal(Triangle t) { return placed(t).normal; }

  /// Could a line along axis k through these ranges of the others pass the triangle?
  bool may_pass(Triangle t, std::size_t u, const Range& at_u, std::size_t v, const Range& at_v) const {
    const Box& box = boxes_[t];
    return box.low[u] <= at_u.high && at_u.low <= box.high[u] && box.low[v] <= at_v.high && at_v.low <= box.high[v];
  }
  bool is_clear_of(const Side& other) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (all_.high[i] < other.all_.low[i] || other.all_.high[i] < all_.low[i]) return true;
    }
    return false;
  }

 private:
  struct Corners {
    std::array<std::uint32_t, 3> vertex;
    std::uint32_t face;
  };
  struct Box {
    std::array<double, 3> low = {infinity, infinity, infinity};
    std::array<double, 3> high = {-infinity, -infinity, -infinity};
    void add(const Box& x) {
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], x.low[i]);
        high[i] = std::max(high[i], x.high[i]);
      }
    }
  };
  struct Placed {
    std::array<Vector, 3> corner;
    Vector normal;
  };

  Box box_of(const Vec3d& p) const {
    Box box;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      double value = pose_(row, 3);
      double size = std::abs(value);
      for (Eigen::Index i = 0; i < 3; ++i) {
        value += pose_(row, i) * p[i];
        size += std::abs(pose_(row, i) * p[i]);
      }
      // Six roundings, each of at most 2^-53 size, and what underflows.
      const double slack = size * 0x1p-49 + 0x1p-1060;
      const bool finite = size < 0x1p1000;
      box.low[k] = finite ? value - slack : -infinity;
      box.high[k] = finite ? value + slack : infinity;
    }
    return box;
  }

  void make_boxes() {
    std::vector<Box> points;
    points.reserve(object_.mesh().vertices.size());
    for (const Vec3d& p : object_.mesh().vertices) points.push_back(box_of(p));
    boxes_.resize(triangles_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      for (const std::uint32_t v : triangles_[t].vertex) boxes_[t].add(points[v]);
      all_.add(boxes_[t]);
    }
  }

  const Placed& placed(Triangle t) {
    const auto [at, is_new] = placed_.try_emplace(t);
    Placed& result = at->second;
    if (!is_new) return result;
    const std::array<Vector, 4> points = scaled_points(primitive(t), pose_, exponent_);
    for (std::size_t i = 0; i < 3; ++i) result.corner[i] = points[i];
    using exact::operator-;
    result.normal = exact::cross(points[1] - points[0], points[2] - points[0]);
    return result;
  }

  const Object& object_;
  const Pose& pose_;
  std::vector<Corners> triangles_;
  std::vector<Triangle> first_;  ///< of each face, and the end
  std::vector<Box> boxes_;
  Box all_;
  int exponent_ = 0;
  std::unordered_map<Triangle, Placed> placed_;
};

/// A point on a face, moved by e along w and by e^2 along t.
struct Sample {
  Point at;
  Vector w;
  Vector t;
  std::size_t axis;  ///< of the rays
};

/// How many triangles of a surface a line passes: before the point, at it and behind it.
struct Passed {
  unsigned below = 0;
  unsigned here = 0;
  unsigned above = 0;
  /// The surface lies here, and its inside on one side alone.
  bool changes() const { return (below + above) % 2 != 0; }
};

/// A segment in the plane of a face.
struct Cut {
  Point from;
  Point to;
  Vector along;  ///< from `from` to `to`, any length
};

class SolidSearch {
 public:
  SolidSearch(Device* device, const CollisionQuery& query)
      : device_(device), query_(query), sides_{Side(*query.a, *query.pose_a), Side(*query.b, *query.pose_b)} {
    exponent_ = sides_[1].common_exponent(sides_[0].common_exponent(std::numeric_limits<int>::max()));
    for (Side& side : sides_) side.set_exponent(exponent_);
  }

  SolidRelation run() {
    CollisionRequest request = {CollisionRequest::Contacts::all, some_contacts};
    request.relation = true;
    CollisionResult found = collide(request);
    if (!found.hit && sides_[0].is_clear_of(sides_[1])) return SolidRelation::disjoint;
    std::array<std::vector<bool>, 2> touched = {std::vector<bool>(sides_[0].face_count()),
                                                std::vector<bool>(sides_[1].face_count())};
    bool touching = false;
    if (found.hit) {
      // Where faces cross, usually the pieces of one of them show everything.
      for (const Contact& contact : found.contacts) {
        if (contact.relation != Relation::crossing) continue;
        if (look_at_first(contact)) return answer(true);
        break;
      }
      if (found.contacts.size() == some_contacts) found = collide({CollisionRequest::Contacts::all});
      std::array<std::map<std::uint32_t, std::vector<Triangle>>, 2> others;
      for (const Contact& contact : found.contacts) {
        touching = touching || triangles_touch(contact);
        for (const std::uint32_t a : query_.a->parts(contact.face_a)) {
          for (const std::uint32_t b : query_.b->parts(contact.face_b)) {
            touched[0][a] = touched[1][b] = true;
            add_triangles(sides_[1], b, others[0][a]);
            add_triangles(sides_[0], a, others[1][b]);
          }
        }
      }
      for (const std::size_t own : {0U, 1U}) {
        for (const auto& [face, cutters] : others[own]) {
          for (Triangle t = sides_[own].first(face); t < sides_[own].first(face + 1); ++t) {
            look_at(own, t, cutters);
            if (is_decided()) return answer(touching);
          }
        }
      }
    }
    for (const std::size_t own : {0U, 1U}) {
      look_at_untouched(own, touched[own]);
      if (is_decided()) break;
    }
    return answer(touching);
  }

 private:
  CollisionResult collide(const CollisionRequest& request) const {
    if (device_ == nullptr) return cchip::collide(*query_.a, *query_.pose_a, *query_.b, *query_.pose_b, request);
    return cchip::collide(*device_, *query_.a, *query_.pose_a, *query_.b, *query_.pose_b, request);
  }

  bool is_decided() const { return in_both_ && in_a_ && in_b_; }

  SolidRelation answer(bool touching) const {
    if (!in_both_) return touching ? SolidRelation::touching : SolidRelation::disjoint;
    if (in_a_) return in_b_ ? SolidRelation::overlapping : SolidRelation::b_in_a;
    return in_b_ ? SolidRelation::a_in_b : SolidRelation::equal;
  }

  static void add_triangles(const Side& side, std::uint32_t face, std::vector<Triangle>& to) {
    for (Triangle t = side.first(face); t < side.first(face + 1); ++t) to.push_back(t);
  }

  /// Do the triangles of two faces in contact touch? Those of quads that are not flat need not.
  bool triangles_touch(const Contact& contact) const {
    const PosedPairs pairs(*query_.pose_a, *query_.pose_b);
    std::array<std::vector<Triangle>, 2> of;
    for (const std::uint32_t f : query_.a->parts(contact.face_a)) add_triangles(sides_[0], f, of[0]);
    for (const std::uint32_t f : query_.b->parts(contact.face_b)) add_triangles(sides_[1], f, of[1]);
    for (const Triangle a : of[0]) {
      for (const Triangle b : of[1]) {
        if (pairs.decide(sides_[0].primitive(a), sides_[1].primitive(b)).hit) return true;
      }
    }
    return false;
  }

  /// Triangles of faces of an object that touch a face of one of them.
  std::vector<Triangle> find_cutters(std::size_t own, std::uint32_t face, std::size_t other) const {
    Mesh one;
    const Mesh& mesh = sides_[own].object().mesh();
    one.faces.push_back(mesh.faces[face]);
    for (std::uint32_t i = 0; i < 4; ++i) {
      const bool used = i < static_cast<std::uint32_t>(mesh.faces[face].kind);
      one.vertices.push_back(mesh.vertices[mesh.faces[face].vertex[used ? i : 0]]);
      one.faces.front().vertex[i] = i;
    }
    // Within one object poses make no difference.
    const Pose here = Pose::Identity();
    CollisionRequest request;
    request.contacts = CollisionRequest::Contacts::all;
    const CollisionResult found =
        cchip::collide(Object(one), own == other ? here : sides_[own].pose(), sides_[other].object(),
                       own == other ? here : sides_[other].pose(), request);
    std::vector<Triangle> triangles;
    for (const Contact& contact : found.contacts) {
      for (const std::uint32_t f : sides_[other].object().parts(contact.face_b)) {
        add_triangles(sides_[other], f, triangles);
      }
    }
    return triangles;
  }

  bool look_at_first(const Contact& contact) {
    for (const std::uint32_t face : query_.a->parts(contact.face_a)) {
      const std::vector<Triangle> cutters = find_cutters(0, face, 1);
      for (Triangle t = sides_[0].first(face); t < sides_[0].first(face + 1); ++t) {
        look_at(0, t, cutters);
        if (is_decided()) return true;
      }
    }
    return false;
  }

  /// One point of each set of faces that hang together.
  void look_at_untouched(std::size_t own, const std::vector<bool>& touched) {
    Side& side = sides_[own];
    const std::vector<std::uint32_t>& place = side.object().same_place();
    std::vector<std::uint32_t> root(place.size());
    std::iota(root.begin(), root.end(), 0U);
    const auto find = [&root](std::uint32_t v) {
      while (root[v] != v) v = root[v] = root[root[v]];
      return v;
    };
    for (Triangle t = 0; t < side.count(); ++t) {
      if (touched[side.face(t)]) continue;
      for (const std::size_t i : {1U, 2U}) root[find(place[side.vertex(t, i)])] = find(place[side.vertex(t, 0)]);
    }
    std::vector<bool> done(place.size());
    for (Triangle t = 0; t < side.count() && !is_decided(); ++t) {
      if (touched[side.face(t)]) continue;
      const std::uint32_t set = find(place[side.vertex(t, 0)]);
      if (!done[set]) done[set] = look_at(own, t, {});
    }
  }

  /// Looks at the pieces of a triangle. \returns whether its own surface changes at one of them
  bool look_at(std::size_t own, Triangle t, const std::vector<Triangle>& cutters) {
    if (exact::is_zero(sides_[own].normal(t))) return false;
    changes_ = false;
    all_plain_ = true;
    std::vector<Cut> cuts;
    for (const Triangle cutter : cutters) add_cuts(own, t, 1 - own, cutter, cuts);
    look_at_pieces(own, t, cuts);
    if (all_plain_ || is_decided()) return changes_;
    const std::size_t before = cuts.size();
    for (const Triangle cutter : find_cutters(own, sides_[own].face(t), own)) {
      if (cutter != t) add_cuts(own, t, own, cutter, cuts);
    }
    if (cuts.size() != before) look_at_pieces(own, t, cuts);
    return changes_;
  }

  /// Adds where a triangle meets another in segments.
  void add_cuts(std::size_t own, Triangle t, std::size_t other, Triangle cutter, std::vector<Cut>& cuts) {
    using exact::operator-;
    const Vector& n = sides_[own].normal(t);
    const std::array<Vector, 3>& own_corner = sides_[own].corners(t);
    const std::array<Vector, 3>& corner = sides_[other].corners(cutter);
    const Vector& normal = sides_[other].normal(cutter);
    if (exact::is_zero(normal)) return;
    std::array<BigInt, 3> height;
    for (std::size_t i = 0; i < 3; ++i) height[i] = dot(n, corner[i] - own_corner[0]);
    if (height[0].is_zero() && height[1].is_zero() && height[2].is_zero()) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t k = (i + 1) % 3;
        add_cut(own, t, {{corner[i], 1}, {corner[k], 1}, corner[k] - corner[i]}, cuts);
      }
      return;
    }
    std::vector<Point> ends;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t k = (i + 1) % 3;
      if (height[i].is_zero()) ends.push_back({corner[i], 1});
      if (sign(height[i]) * sign(height[k]) >= 0) continue;
      const BigInt at_i = abs(height[k]);
      const BigInt at_k = abs(height[i]);
      ends.push_back({sum(times(corner[i], at_i), times(corner[k], at_k)), at_i + at_k});
    }
    if (ends.size() == 2) add_cut(own, t, {ends[0], ends[1], exact::cross(n, normal)}, cuts);
  }

  /// Adds a segment unless it passes the interior of the triangle nowhere, or is there already.
  void add_cut(std::size_t own, Triangle t, Cut cut, std::vector<Cut>& cuts) {
    using exact::operator-;
    const Vector& n = sides_[own].normal(t);
    const std::array<Vector, 3>& corner = sides_[own].corners(t);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector inwards = exact::cross(n, corner[(i + 1) % 3] - corner[i]);
      const BigInt limit = dot(inwards, corner[i]);
      if (dot(inwards, cut.from.x) <= limit * cut.from.w && dot(inwards, cut.to.x) <= limit * cut.to.w) return;
    }
    for (const Cut& x : cuts) {
      if ((x.from == cut.from && x.to == cut.to) || (x.from == cut.to && x.to == cut.from)) return;
    }
    cuts.push_back(std::move(cut));
  }

  void look_at_pieces(std::size_t own, Triangle t, const std::vector<Cut>& cuts) {
    using exact::operator-;
    const Vector& n = sides_[own].normal(t);
    const std::array<Vector, 3>& corner = sides_[own].corners(t);
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (abs(n[k]) > abs(n[axis])) axis = k;
    }
    // The edges divide cuts that go on beyond them.
    std::vector<Cut> dividers = cuts;
    bool in_pieces = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector& to = corner[(i + 1) % 3];
      dividers.push_back({{corner[i], 1}, {to, 1}, to - corner[i]});
    }
    for (const Cut& cut : cuts) {
      const Vector w = exact::cross(n, cut.along);
      const Vector minus_w = times(w, -1);
      for (const Point& middle : middles(cut, dividers, w)) {
        if (look(own, t, {middle, w, cut.along, axis})) in_pieces = true;
        if (look(own, t, {middle, minus_w, cut.along, axis})) in_pieces = true;
        if (is_decided()) return;
      }
    }
    if (in_pieces) return;
    // No cut passes the interior: it is one piece.
    const Vector edge = corner[1] - corner[0];
    look(own, t, {{sum(sum(corner[0], corner[1]), corner[2]), 3}, exact::cross(n, edge), edge, axis});
  }

  /// A fraction of the way along a segment. \pre whole > 0
  struct Fraction {
    BigInt part;
    BigInt whole;
    friend bool operator<(const Fraction& x, const Fraction& y) { return x.part * y.whole < y.part * x.whole; }
    friend bool operator==(const Fraction& x, const Fraction& y) { return x.part * y.whole == y.part * x.whole; }
  };

  /// Middles of the parts into which others, or itself, divide a segment. \param w at right angles to it, in the plane
  static std::vector<Point> middles(const Cut& cut, const std::vector<Cut>& dividers, const Vector& w) {
    const std::size_t axis = exact::nonzero_component(cut.along);
    // Coordinate `axis` of all points, as a fraction of that of the end from that of the beginning.
    const BigInt begin = cut.from.x[axis] * cut.to.w;
    const BigInt length = cut.to.x[axis] * cut.from.w - begin;
    const BigInt unit = cut.from.w * cut.to.w;
    std::vector<Fraction> at = {{0, 1}, {1, 1}};
    for (const Cut& other : dividers) {
      const BigInt limit = dot(w, cut.from.x);
      const BigInt from = dot(w, other.from.x) * cut.from.w - limit * other.from.w;
      const BigInt to = dot(w, other.to.x) * cut.from.w - limit * other.to.w;
      if (sign(from) * sign(to) > 0 || (from.is_zero() && to.is_zero())) continue;
      const BigInt size_from = abs(from);
      const BigInt size_to = abs(to);
      const BigInt x = other.from.x[axis] * size_to + other.to.x[axis] * size_from;
      const BigInt x_w = other.from.w * size_to + other.to.w * size_from;
      Fraction fraction = {x * unit - begin * x_w, length * x_w};
      if (fraction.whole.sign() < 0) {
        fraction.part = -fraction.part;
        fraction.whole = -fraction.whole;
      }
      if (fraction.part.sign() > 0 && fraction.part < fraction.whole) at.push_back(std::move(fraction));
    }
    std::sort(at.begin(), at.end());
    at.erase(std::unique(at.begin(), at.end()), at.end());
    std::vector<Point> result;
    for (std::size_t i = 1; i < at.size(); ++i) {
      const BigInt part = at[i - 1].part * at[i].whole + at[i].part * at[i - 1].whole;
      const BigInt whole = 2 * at[i - 1].whole * at[i].whole;
      const BigInt rest = (whole - part) * cut.to.w;
      const BigInt far = part * cut.from.w;
      result.push_back({sum(times(cut.from.x, rest), times(cut.to.x, far)), whole * unit});
    }
    return result;
  }

  /// Looks at both sides of a point, if it is in the triangle. \returns whether it is
  bool look(std::size_t own, Triangle t, const Sample& sample) {
    if (!passes(sides_[own], t, sample)) return false;
    const Passed a = pass(sides_[0], sample);
    const Passed b = pass(sides_[1], sample);
    if ((a.below + a.here + a.above) % 2 != 0 || (b.below + b.here + b.above) % 2 != 0) {
      throw std::logic_error("solids: a line passes a closed surface an odd number of times; please report this");
    }
    add(a.below % 2 != 0, b.below % 2 != 0);
    add(a.above % 2 != 0, b.above % 2 != 0);
    const bool own_changes = (own == 0 ? a : b).changes();
    changes_ = changes_ || own_changes;
    all_plain_ = all_plain_ && own_changes && (own == 0 ? b : a).here == 0;
    return true;
  }

  void add(bool in_a, bool in_b) {
    in_both_ = in_both_ || (in_a && in_b);
    in_a_ = in_a_ || (in_a && !in_b);
    in_b_ = in_b_ || (in_b && !in_a);
  }

  /// Does a line through the sample along its axis pass the triangle?
  static bool passes(Side& side, Triangle t, const Sample& sample) {
    const std::size_t u = (sample.axis + 1) % 3;
    const std::size_t v = (sample.axis + 2) % 3;
    const std::array<Vector, 3>& corner = side.corners(t);
    int seen = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector& from = corner[i];
      const Vector& to = corner[(i + 1) % 3];
      const BigInt along_u = to[u] - from[u];
      const BigInt along_v = to[v] - from[v];
      int s =
          sign(along_u * (sample.at.x[v] - from[v] * sample.at.w) - along_v * (sample.at.x[u] - from[u] * sample.at.w));
      if (s == 0) s = sign(along_u * sample.w[v] - along_v * sample.w[u]);
      if (s == 0) s = sign(along_u * sample.t[v] - along_v * sample.t[u]);
      if (s == 0 || s == -seen) return false;
      seen = s;
    }
    return true;
  }

  Passed pass(Side& side, const Sample& sample) const {
    using exact::operator-;
    const std::size_t u = (sample.axis + 1) % 3;
    const std::size_t v = (sample.axis + 2) % 3;
    const Range at_u = range_of(sample.at.x[u], sample.at.w, exponent_);
    const Range at_v = range_of(sample.at.x[v], sample.at.w, exponent_);
    Passed passed;
    for (Triangle t = 0; t < side.count(); ++t) {
      if (!side.may_pass(t, u, at_u, v, at_v) || !passes(side, t, sample)) continue;
      const Vector& n = side.normal(t);
      int s = sign(dot(n, sample.at.x) - dot(n, side.corners(t)[0]) * sample.at.w);
      if (s == 0) s = sign(dot(n, sample.w));
      if (s == 0) s = sign(dot(n, sample.t));
      s *= sign(n[sample.axis]);
      ++(s == 0 ? passed.here : s > 0 ? passed.below : passed.above);
    }
    return passed;
  }

  Device* device_;
  CollisionQuery query_;
  std::array<Side, 2> sides_;
  int exponent_ = 0;
  bool in_both_ = false;  ///< some space is in both
  bool in_a_ = false;     ///< some space is in A alone
  bool in_b_ = false;
  bool changes_ = false;    ///< of the present face: at a point one side alone was inside its object
  bool all_plain_ = false;  ///< that at all points, and the other surface did not lie there
};

std::string text_of(const Vec3d& p) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(17);
  text << '(' << p.x() << ", " << p.y() << ", " << p.z() << ')';
  return text.str();
}

void check_solid(const Object& object, const Pose& pose, const char* name) {
  if (const std::optional<OpenEdge> edge = object.open_edge()) {
    throw std::invalid_argument(std::string("solids: the surface of ") + name + " is open at the edge from " +
                                text_of(edge->from) + " to " + text_of(edge->to) + " of face " +
                                std::to_string(edge->face) +
                                ": an odd number of faces use it; close the mesh, or ask collide() about the surface");
  }
  // The normal of the triangle of the columns' ends, seen from the origin, in integers.
  Primitive columns;
  for (Eigen::Index i = 0; i < 3; ++i) columns.v[static_cast<std::size_t>(i)] = pose.linear().col(i);
  const Pose here = Pose::Identity();
  const std::array<Vector, 4> points = scaled_points(columns, here, common_exponent(columns, here, 0));
  if (!dot(points[0], exact::cross(points[1], points[2])).is_zero()) return;
  throw std::invalid_argument(std::string("solids: the pose of ") + name +
                              " flattens space (its determinant is 0), so that the object has no volume");
}

SolidRelation relate(Device* device, const CollisionQuery& query) {
  check_query(query, {});
  check_solid(*query.a, *query.pose_a, "A");
  check_solid(*query.b, *query.pose_b, "B");
  return SolidSearch(device, query).run();
}

}  // namespace

const char* name_of(SolidRelation relation) {
  switch (relation) {
    case SolidRelation::disjoint:
      return "disjoint";
    case SolidRelation::touching:
      return "touching";
    case SolidRelation::overlapping:
      return "overlapping";
    case SolidRelation::a_in_b:
      return "a_in_b";
    case SolidRelation::b_in_a:
      return "b_in_a";
    case SolidRelation::equal:
      return "equal";
  }
  return "";
}

SolidRelation solids(Device& device, const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b) {
  return relate(&device, {&a, &pose_a, &b, &pose_b});
}

SolidRelation solids(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b) {
  return relate(nullptr, {&a, &pose_a, &b, &pose_b});
}

std::vector<SolidPair> solids(Device& device, const Scene& scene) {
  std::vector<SolidPair> result;
  for (const auto& [a, b] : scene.candidates()) {
    const SolidRelation relation = solids(device, scene.object(a), scene.pose(a), scene.object(b), scene.pose(b));
    if (relation != SolidRelation::disjoint) result.push_back({a, b, relation});
  }
  return result;
}

}  // namespace cchip
