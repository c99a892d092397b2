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
// - If B's surface is simple (shells.hpp) and all pieces of A have been looked at, one point of each shell of B is
//   enough. For let R be one of the combinations, and no piece of A bound it, but a piece P of a shell S of B. Follow S
//   from P over edges, past vertices, until A's surface is met first. Either A's inside changes along S there, or A's
//   surface runs on within S. On the side of S on which B's inside is as in R, a surface of A then leaves S, and a
//   piece of it bounds R; or A's surface within S does. So none is met, and all of S lies to A as P does.
// - If A is simple, too, a shell of A with a face that touches B needs no other point: the pieces of this face reach
//   its neighbours. Of a shell without one, one point is enough.
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
#include <cchip/internal/exact/posed_pairs.hpp>
#include <cchip/internal/geometry/decimal.hpp>
#include <cchip/internal/judge/face_pairs.hpp>
#include <cchip/internal/judge/near_parts.hpp>
#include <cchip/point_cloud.hpp>
#include <cchip/solids.hpp>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "in_blocks.hpp"
#include "search/query_scale.hpp"
#include "solid_side.hpp"

namespace cchip {
namespace {

using exact::BigInt;
using Vector = exact::Vec<BigInt>;
using Point = SolidPoint;
using Sample = SolidSample;
using Triangle = SolidSide::Triangle;

int sign(const BigInt& x) { return x.sign(); }
BigInt dot(const Vector& p, const Vector& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
Vector times(const Vector& p, const BigInt& x) { return {p[0] * x, p[1] * x, p[2] * x}; }
Vector sum(const Vector& p, const Vector& q) { return {p[0] + q[0], p[1] + q[1], p[2] + q[2]}; }

/// The same point with the least denominator.
Point reduced(Point p) {
  const BigInt factor = gcd(gcd(p.x[0], p.x[1]), gcd(p.x[2], p.w));
  for (BigInt& x : p.x) x /= factor;
  p.w /= factor;
  return p;
}

/// Any order. \pre both are reduced
bool comes_before(const Point& p, const Point& q) { return p.x != q.x ? p.x < q.x : p.w < q.w; }

/// More than these are looked for only if they do not tell everything.
constexpr std::size_t some_contacts = 256;

/// Where the inside of an object is at a point of a face.
struct Inside {
  bool below = false;
  bool above = false;
  bool here = false;  ///< the object's surface lies at the point itself
  bool changes() const { return below != above; }
};

/// A segment in the plane of a face.
struct Cut {
  Point from;
  Point to;
  Vector along;  ///< from `from` to `to`, any length
};

/// Where a triangle meets others in segments, each once.
class Cuts {
 public:
  Cuts(const std::array<Vector, 3>& corner, const Vector& normal) : corner_(corner), normal_(normal) {
    using exact::operator-;
    for (std::size_t i = 0; i < 3; ++i) inwards_[i] = exact::cross(normal, corner[(i + 1) % 3] - corner[i]);
  }

  /// The segments of another triangle that is not collapsed.
  void add(const std::array<Vector, 3>& corner, const Vector& normal) {
    using exact::operator-;
    std::array<BigInt, 3> height;
    for (std::size_t i = 0; i < 3; ++i) height[i] = dot(normal_, corner[i] - corner_[0]);
    if (height[0].is_zero() && height[1].is_zero() && height[2].is_zero()) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t k = (i + 1) % 3;
        add({{corner[i], 1}, {corner[k], 1}, corner[k] - corner[i]});
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
      ends.push_back(reduced({sum(times(corner[i], at_i), times(corner[k], at_k)), at_i + at_k}));
    }
    if (ends.size() == 2) add({ends[0], ends[1], exact::cross(normal_, normal)});
  }

  std::size_t size() const { return cuts_.size(); }
  const std::vector<Cut>& all() const { return cuts_; }

 private:
  using Ends = std::pair<Point, Point>;
  struct Before {
    bool operator()(const Ends& x, const Ends& y) const {
      if (comes_before(x.first, y.first)) return true;
      return !comes_before(y.first, x.first) && comes_before(x.second, y.second);
    }
  };

  /// Unless it passes the interior of the triangle nowhere, or is there already.
  void add(Cut cut) {
    for (std::size_t i = 0; i < 3; ++i) {
      const BigInt limit = dot(inwards_[i], corner_[i]);
      if (dot(inwards_[i], cut.from.x) <= limit * cut.from.w && dot(inwards_[i], cut.to.x) <= limit * cut.to.w) return;
    }
    const bool ascends = comes_before(cut.from, cut.to);
    Ends ends = ascends ? Ends(cut.from, cut.to) : Ends(cut.to, cut.from);
    if (known_.emplace(std::move(ends), true).second) cuts_.push_back(std::move(cut));
  }

  const std::array<Vector, 3>& corner_;
  const Vector& normal_;
  std::array<Vector, 3> inwards_;  ///< at right angles to the edges
  std::vector<Cut> cuts_;
  std::map<Ends, bool, Before> known_;
};

class SolidSearch {
 public:
  SolidSearch(Device* device, const CollisionQuery& query, const SolidRequest& request)
      : device_(device),
        query_(query),
        inside_(request.inside),
        scale_(query),
        poses_{scale_(*query.pose_a), scale_(*query.pose_b)},
        sides_{SolidSide(*query.a, poses_[0]), SolidSide(*query.b, poses_[1])} {}

  SolidResult run() {
    SolidResult result;
    if (sides_[0].is_clear_of(sides_[1])) return result;
    const int exponent = std::min(sides_[0].exponent(), sides_[1].exponent());
    for (SolidSide& side : sides_) side.set_exponent(exponent);
    result.relation = search();
    result.overlap_a = sides_[0].shells().overlap;
    result.overlap_b = sides_[1].shells().overlap;
    return result;
  }

 private:
  /// Triangles of the other object that may cut each face.
  using Cutters = std::map<std::uint32_t, std::vector<Triangle>>;

  SolidRelation search() {
    CollisionRequest request = {CollisionRequest::Contacts::all, some_contacts};
    request.relation = true;
    CollisionResult found = collide(request);
    std::array<Cutters, 2> cutters;
    bool touching = false;
    if (found.hit) {
      // Where faces cross, usually the pieces of one of them show everything.
      const auto crossing = std::find_if(found.contacts.begin(), found.contacts.end(),
                                         [](const Contact& c) { return c.relation == Relation::crossing; });
      if (crossing != found.contacts.end() && look_at_first(*crossing)) return answer(true);
      if (found.contacts.size() == some_contacts) found = collide({CollisionRequest::Contacts::all});
      for (const Contact& contact : found.contacts) {
        touching = touching || triangles_touch(contact);
        any_near_parts(query_, contact, [&](std::uint32_t a, std::uint32_t b) {
          sides_[1].for_each_triangle(b, [&](Triangle t) { cutters[0][a].push_back(t); });
          sides_[0].for_each_triangle(a, [&](Triangle t) { cutters[1][b].push_back(t); });
          return false;
        });
      }
    }
    look_at_all(cutters);
    return answer(touching);
  }

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

  /// Do the triangles of two faces in contact touch? Those of quads that are not flat need not.
  bool triangles_touch(const Contact& contact) const {
    const PosedPairs pairs(*query_.pose_a, *query_.pose_b);
    return any_near_parts(query_, contact, [&](std::uint32_t face_a, std::uint32_t face_b) {
      bool touch = false;
      sides_[0].for_each_triangle(face_a, [&](Triangle a) {
        sides_[1].for_each_triangle(face_b, [&](Triangle b) {
          touch = touch || pairs.decide(sides_[0].primitive(a), sides_[1].primitive(b)).hit;
        });
      });
      return touch;
    });
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
    const Object single(std::move(one));
    const bool within = own == other;
    const Pose& pose_own = within ? here : own == 0 ? *query_.pose_a : *query_.pose_b;
    const Pose& pose_other = within ? here : other == 0 ? *query_.pose_a : *query_.pose_b;
    const CollisionResult found = cchip::collide(single, pose_own, sides_[other].object(), pose_other, request);
    std::vector<Triangle> triangles;
    const CollisionQuery query = {&single, &pose_own, &sides_[other].object(), &pose_other};
    for (const Contact& contact : found.contacts) {
      any_near_parts(query, contact, [&](std::uint32_t, std::uint32_t f) {
        sides_[other].for_each_triangle(f, [&](Triangle t) { triangles.push_back(t); });
        return false;
      });
    }
    return triangles;
  }

  bool look_at_first(const Contact& contact) {
    constexpr std::size_t most = 4;  // parts of a polygon
    const std::vector<std::uint32_t> parts = query_.a->parts(contact.face_a);
    for (std::size_t i = 0; i < std::min(most, parts.size()) && !is_decided(); ++i) {
      look_at_face(0, parts[i], find_cutters(0, parts[i], 1));
    }
    return is_decided();
  }

  /// The faces that others cut, then what hangs together elsewhere.
  void look_at_all(const std::array<Cutters, 2>& cutters) {
    const std::array<bool, 2> simple = {sides_[0].shells().simple, sides_[1].shells().simple};
    const auto cost = [](const Cutters& of_side) {
      double sum = 0;
      for (const auto& [face, triangles] : of_side) {
        sum += static_cast<double>(triangles.size()) * static_cast<double>(triangles.size());
      }
      return sum;
    };
    const std::size_t first = simple[0] != simple[1]                 ? (simple[1] ? 0 : 1)
                              : cost(cutters[0]) <= cost(cutters[1]) ? 0
                                                                     : 1;
    const bool shells_tell = simple[1 - first];  // of the other side
    for (const std::size_t own : {first, 1 - first}) {
      if (own != first && shells_tell) {
        look_at_shells(own, {});
        return;
      }
      for (const auto& [face, triangles] : cutters[own]) {
        look_at_face(own, face, triangles);
        if (is_decided()) return;
      }
      if (simple[own] && shells_tell) {
        look_at_shells(own, cutters[own]);
      } else {
        look_at_untouched(own, cutters[own]);
      }
      if (is_decided()) return;
    }
  }

  /// One point of each shell none of whose faces is cut. \pre the surface is simple
  void look_at_shells(std::size_t own, const Cutters& cutters) {
    const Shells& shells = sides_[own].shells();
    std::vector<bool> done(shells.first_face.size());
    for (const auto& of_face : cutters) done[shells.of_face[of_face.first]] = true;
    for (std::size_t shell = 0; shell < done.size() && !is_decided(); ++shell) {
      if (!done[shell]) look_at(own, 2 * shells.first_face[shell], {});
    }
  }

  /// One point of each set of faces that are not cut and hang together.
  void look_at_untouched(std::size_t own, const Cutters& cutters) {
    SolidSide& side = sides_[own];
    const std::vector<std::uint32_t>& place = side.object().same_place();
    std::vector<std::uint32_t> root(place.size());
    std::iota(root.begin(), root.end(), 0U);
    const auto find = [&root](std::uint32_t v) {
      while (root[v] != v) v = root[v] = root[root[v]];
      return v;
    };
    const auto for_each_untouched = [&](const auto& visit) {
      for (std::uint32_t face = 0; face < side.face_count(); ++face) {
        if (cutters.count(face) == 0) side.for_each_triangle(face, visit);
      }
    };
    for_each_untouched([&](Triangle t) {
      const std::array<std::uint32_t, 3> v = side.vertices(t);
      for (const std::size_t i : {1U, 2U}) root[find(place[v[i]])] = find(place[v[0]]);
    });
    std::vector<bool> done(place.size());
    for_each_untouched([&](Triangle t) {
      if (is_decided()) return;
      const std::uint32_t set = find(place[side.vertices(t)[0]]);
      if (!done[set]) done[set] = look_at(own, t, {});
    });
  }

  void look_at_face(std::size_t own, std::uint32_t face, const std::vector<Triangle>& cutters) {
    sides_[own].for_each_triangle(face, [&](Triangle t) {
      if (!is_decided()) look_at(own, t, cutters);
    });
  }

  /// Looks at the pieces of a triangle. \returns whether its own surface changes at one of them
  bool look_at(std::size_t own, Triangle t, const std::vector<Triangle>& cutters) {
    SolidSide& side = sides_[own];
    if (exact::is_zero(side.normal(t))) return false;
    changes_ = false;
    all_plain_ = true;
    Cuts cuts(side.corners(t), side.normal(t));
    const auto add = [&cuts](SolidSide& of, Triangle cutter) {
      if (!exact::is_zero(of.normal(cutter))) cuts.add(of.corners(cutter), of.normal(cutter));
    };
    for (const Triangle cutter : cutters) add(sides_[1 - own], cutter);
    look_at_pieces(own, t, cuts.all());
    if (all_plain_ || side.shells().simple || is_decided()) return changes_;
    const std::size_t before = cuts.size();
    for (const Triangle cutter : find_cutters(own, SolidSide::face(t), own)) {
      if (cutter != t) add(side, cutter);
    }
    if (cuts.size() != before) look_at_pieces(own, t, cuts.all());
    return changes_;
  }

  void look_at_pieces(std::size_t own, Triangle t, const std::vector<Cut>& cuts) {
    using exact::operator-;
    SolidSide& side = sides_[own];
    const Vector& n = side.normal(t);
    const std::array<Vector, 3>& corner = side.corners(t);
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (abs(n[k]) > abs(n[axis])) axis = k;
    }
    bool in_pieces = false;
    if (!cuts.empty()) {
      // The edges divide cuts that go on beyond them.
      std::vector<Cut> dividers = cuts;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vector& to = corner[(i + 1) % 3];
        dividers.push_back({{corner[i], 1}, {to, 1}, to - corner[i]});
      }
      std::vector<AxisBox<3>> boxes;
      boxes.reserve(dividers.size());
      for (const Cut& cut : dividers) {
        boxes.push_back(side.box_of(cut.from));
        boxes.back().add(side.box_of(cut.to));
      }
      const BoxTree<3> tree(std::move(boxes));
      for (std::size_t i = 0; i < cuts.size(); ++i) {
        const Cut& cut = cuts[i];
        const Vector w = exact::cross(n, cut.along);
        const Vector minus_w = times(w, -1);
        for (const Point& middle : middles(cut, i, dividers, tree, w)) {
          if (look(own, t, {middle, w, cut.along, axis})) in_pieces = true;
          if (look(own, t, {middle, minus_w, cut.along, axis})) in_pieces = true;
          if (is_decided()) return;
        }
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

  /// Middles of the parts into which others, or itself, divide a segment.
  /// \param number of the cut among the dividers, which `tree` is of
  /// \param w at right angles to it, in the plane
  static std::vector<Point> middles(const Cut& cut, std::size_t number, const std::vector<Cut>& dividers,
                                    const BoxTree<3>& tree, const Vector& w) {
    const std::size_t axis = exact::nonzero_component(cut.along);
    // Coordinate `axis` of all points, as a fraction of that of the end from that of the beginning.
    const BigInt begin = cut.from.x[axis] * cut.to.w;
    const BigInt length = cut.to.x[axis] * cut.from.w - begin;
    const BigInt unit = cut.from.w * cut.to.w;
    const BigInt limit = dot(w, cut.from.x);
    std::vector<Fraction> at = {{0, 1}, {1, 1}};
    tree.for_each_overlap(tree.box(number), [&](std::uint32_t k) {
      const Cut& other = dividers[k];
      const BigInt from = dot(w, other.from.x) * cut.from.w - limit * other.from.w;
      const BigInt to = dot(w, other.to.x) * cut.from.w - limit * other.to.w;
      if (sign(from) * sign(to) > 0 || (from.is_zero() && to.is_zero())) return;
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
    });
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
    if (!sides_[own].is_passed(t, sample)) return false;
    const Inside other = inside(1 - own, sample);
    const Inside mine = own_inside(own, t, sample);
    const Inside& a = own == 0 ? mine : other;
    const Inside& b = own == 0 ? other : mine;
    add(a.below, b.below);
    add(a.above, b.above);
    changes_ = changes_ || mine.changes();
    all_plain_ = all_plain_ && mine.changes() && !other.here;
    return true;
  }

  void add(bool in_a, bool in_b) {
    in_both_ = in_both_ || (in_a && in_b);
    in_a_ = in_a_ || (in_a && !in_b);
    in_b_ = in_b_ || (in_b && !in_a);
  }

  /// Where the inside of an object is at a sample.
  Inside inside(std::size_t of, const Sample& sample) {
    const PassedTriangles p = sides_[of].passed(sample);
    const bool odd = inside_ == InsideRule::odd;
    if (odd ? (p.below.all + p.here.all + p.above.all) % 2 != 0 : p.below.net + p.here.net + p.above.net != 0) {
      throw std::logic_error("solids: a line leaves a closed surface less often than it enters; please report this");
    }
    const auto in = [odd](const PassedTriangles::Count& count) { return odd ? count.all % 2 != 0 : count.net != 0; };
    return {in(p.below), in(p.above), p.here.all != 0};
  }

  /// The same of the object that the triangle belongs to. All faces of a shell of a simple surface have the inside on
  /// the same side, if they are the same way round.
  Inside own_inside(std::size_t own, Triangle t, const Sample& sample) {
    SolidSide& side = sides_[own];
    if (!side.shells().simple || side.object().twisted_edge()) return inside(own, sample);
    std::vector<std::optional<Inside>>& known = of_shell_[own];
    known.resize(side.shells().first_face.size());
    std::optional<Inside>& shell = known[side.shells().of_face[SolidSide::face(t)]];
    const bool is_up = side.normal(t)[sample.axis].sign() > 0;
    const auto turned = [is_up](Inside x) {
      if (!is_up) std::swap(x.below, x.above);
      return x;
    };
    if (!shell) shell = turned(inside(own, sample));
    return turned(*shell);
  }

  Device* device_;
  CollisionQuery query_;
  InsideRule inside_;
  QueryScale scale_;
  std::array<Pose, 2> poses_;  ///< in the unit of the search
  std::array<SolidSide, 2> sides_;
  bool in_both_ = false;  ///< some space is in both
  bool in_a_ = false;     ///< some space is in A alone
  bool in_b_ = false;
  bool changes_ = false;    ///< of the present face: at a point one side alone was inside its object
  bool all_plain_ = false;  ///< that at all points, and the other surface did not lie there
  std::array<std::vector<std::optional<Inside>>, 2> of_shell_;  ///< behind (below) and in front of its faces
};

std::string text_of(const Vec3d& p) {
  return '(' + decimal_text(p.x()) + ", " + decimal_text(p.y()) + ", " + decimal_text(p.z()) + ')';
}

std::string text_of(const OpenEdge& edge) {
  return "at the edge from " + text_of(edge.from) + " to " + text_of(edge.to) + " of face " + std::to_string(edge.face);
}

bool is_flat(const Eigen::Matrix3d& linear) {
  // In doubles where they are certain: the terms of a determinant have two roundings each, and five of sums.
  const double scale = linear.cwiseAbs().maxCoeff();
  if (scale > 0) {
    const Eigen::Matrix3d unit = linear / scale;
    if (std::abs(unit.determinant()) > 0x1p-40) return false;
  }
  // The normal of the triangle of the columns' ends, seen from the origin, in integers.
  Primitive columns;
  for (Eigen::Index i = 0; i < 3; ++i) columns.v[static_cast<std::size_t>(i)] = linear.col(i);
  const Pose here = Pose::Identity();
  const std::array<Vector, 4> points = exact::scaled_points(columns, here, exact::common_exponent(columns, here, 0));
  return dot(points[0], exact::cross(points[1], points[2])).is_zero();
}

void check_solid(const Object& object, const Pose& pose, const SolidRequest& request, const char* name) {
  if (const std::optional<OpenEdge> edge = object.open_edge()) {
    throw std::invalid_argument(std::string("solids: the surface of ") + name + " is open " + text_of(*edge) +
                                ": an odd number of faces use it; close the mesh, or ask collide() about the surface");
  }
  if (request.inside == InsideRule::nonzero) {
    if (const std::optional<OpenEdge> edge = object.twisted_edge()) {
      throw std::invalid_argument(std::string("solids: the faces of ") + name + " are not the same way round " +
                                  text_of(*edge) +
                                  ", so nothing winds around a point a certain number of times; turn faces of the "
                                  "mesh round, or ask with the rule odd");
    }
  }
  if (!is_flat(pose.linear())) return;
  throw std::invalid_argument(std::string("solids: the pose of ") + name +
                              " flattens space (its determinant is 0), so that the object has no volume");
}

/// Sides of a solid on which points are that are not on its surface, and which points are.
class PointPlaces {
 public:
  /// \param exponent coordinates of points are multiples of 2^exponent
  PointPlaces(const Object& object, const Pose& pose, InsideRule inside, int exponent)
      : side_(object, pose), inside_(inside), exponent_(std::min(exponent, side_.exponent())) {
    side_.set_exponent(exponent_);
  }

  bool is_inside(const Vec3d& point) {
    // A line along z through a point moved by e along x and e^2 along y passes no edge. The point is not on the
    // surface, so nothing is crossed on the way.
    const PassedTriangles passed = side_.passed({{whole(point), 1}, {1, 0, 0}, {0, 1, 0}, 2});
    return inside_ == InsideRule::odd ? passed.below.all % 2 == 1 : passed.below.net != 0;
  }
  /// Is the point on one of the triangles of a face, whose hull it is in?
  bool is_on(std::uint32_t face, const Vec3d& point) {
    if (side_.object().mesh().faces[face].kind == Kind::tri) return true;
    bool found = false;
    side_.for_each_triangle(face, [&](Triangle t) { found = found || is_on_triangle(t, whole(point)); });
    return found;
  }

 private:
  Vector whole(const Vec3d& point) const {
    Vector result;
    for (std::size_t i = 0; i < 3; ++i) {
      const exact::Scaled x = exact::odd(exact::Scaled(point[static_cast<Eigen::Index>(i)]));
      result[i] = x.mantissa == 0 ? BigInt(0) : BigInt(x.mantissa) << (x.exponent - exponent_);
    }
    return result;
  }
  bool is_on_triangle(Triangle t, const Vector& p) {
    using exact::operator-;
    const auto& corner = side_.corners(t);
    const Vector& n = side_.normal(t);
    if (!dot(n, p - corner[0]).is_zero()) return false;
    const bool is_collapsed = n[0].is_zero() && n[1].is_zero() && n[2].is_zero();
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector edge = corner[(i + 1) % 3] - corner[i];
      const Vector to = p - corner[i];
      const Vector turn = exact::cross(edge, to);
      if (!is_collapsed && sign(dot(n, turn)) < 0) return false;
      // Of a collapsed one: on one of its edges.
      const bool is_along = turn[0].is_zero() && turn[1].is_zero() && turn[2].is_zero();
      if (is_collapsed && is_along && sign(dot(edge, to)) >= 0 && dot(edge, to) <= dot(edge, edge)) return true;
    }
    return !is_collapsed;
  }

  SolidSide side_;
  InsideRule inside_;
  int exponent_;
};

SolidResult relate(Device* device, const CollisionQuery& query, const SolidRequest& request) {
  check_query(query, {});
  check_solid(*query.a, *query.pose_a, request, "A");
  check_solid(*query.b, *query.pose_b, request, "B");
  return SolidSearch(device, query, request).run();
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

SolidResult solids(Device& device, const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                   const SolidRequest& request) {
  return relate(&device, {&a, &pose_a, &b, &pose_b}, request);
}

SolidResult solids(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                   const SolidRequest& request) {
  return relate(nullptr, {&a, &pose_a, &b, &pose_b}, request);
}

const char* name_of(PointPlace place) {
  switch (place) {
    case PointPlace::outside:
      return "outside";
    case PointPlace::on_surface:
      return "on_surface";
    case PointPlace::inside:
      return "inside";
  }
  return "";
}

std::vector<PointPlace> inside(const Object& object, const Pose& pose, const std::vector<Vec3d>& points,
                               const SolidRequest& request, unsigned threads) {
  check_pose(pose, "the object");
  check_solid(object, pose, request, "the object");
  CloudRequest on_faces;
  on_faces.contacts = CollisionRequest::Contacts::all;
  const CloudResult met = collide(PointCloud(points, 0), Pose::Identity(), object, pose, on_faces);
  int exponent = 0;
  for (const Vec3d& point : points) {
    for (const double x : point) {
      if (x != 0) exponent = std::min(exponent, exact::odd(exact::Scaled(x)).exponent);
    }
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> parts;  // of a face of the file
  const Mesh& mesh = object.mesh();
  if (!met.contacts.empty()) {
    for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) parts[mesh.number_in_file(i)].push_back(i);
  }
  std::vector<PointPlace> places(points.size(), PointPlace::outside);
  PointPlaces on(object, pose, request.inside, exponent);
  for (const CloudContact& contact : met.contacts) {
    const std::vector<std::uint32_t>& faces = parts[contact.face];
    const bool is_on = faces.size() > 1 || on.is_on(faces[0], points[contact.point]);
    if (is_on) places[contact.point] = PointPlace::on_surface;
  }
  constexpr std::size_t block = 1024;  // points that one thread takes at a time, close to each other in many files
  in_blocks(points.size(), block, threads, [&] {
    return [&, sides = PointPlaces(object, pose, request.inside, exponent)](std::size_t i) mutable {
      if (places[i] != PointPlace::on_surface && sides.is_inside(points[i])) places[i] = PointPlace::inside;
    };
  });
  return places;
}

std::vector<SolidPair> solids(Device& device, const Scene& scene, const SolidRequest& request) {
  std::vector<SolidPair> result;
  for (const auto& [a, b] : scene.candidates()) {
    const SolidResult pair = solids(device, scene.object(a), scene.pose(a), scene.object(b), scene.pose(b), request);
    if (pair.relation != SolidRelation::disjoint || pair.overlap_a || pair.overlap_b) result.push_back({pair, a, b});
  }
  return result;
}

}  // namespace cchip
