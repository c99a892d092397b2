// SPDX-License-Identifier: Apache-2.0
// Faces of one object that touch or cross each other: its tree is descended against itself.
//
// Neighbours, which have one or two vertices in common, meet there in any case. What matters is whether they meet
// elsewhere, which is decided by asking whether smaller hulls meet:
// - One common vertex v: A is the hull of v and its other vertices A', B likewise. Let p be another common point, and
//   follow the ray from v through p as long as it is in both. It leaves A, say, in a point q, so q is in B. If v is not
//   in the hull of A', rays from v leave A through that hull, hence it meets B. Conversely a point of the hull of A' in
//   B is not v. If v is in the hull of A', A is the union of the hulls of v and A' without one vertex.
// - Two common vertices u and v: p is a common point that is not on the edge uv; follow the ray from the middle of uv
//   through p. It leaves A, say, through a hull of some vertices without u or without v. So without u, say, A meets B
//   beyond v, the first case. Conversely these hulls meet the edge in v alone, unless A is collapsed or the edge is a
//   diagonal: then A is divided first.
#include <algorithm>
#include <array>
#include <cchip/collide.hpp>
#include <cchip/internal/exact/posed_pairs.hpp>
#include <cchip/internal/judge/near_parts.hpp>
#include <cchip/internal/tree/support_tree.hpp>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "exact/float_mode.hpp"

namespace cchip {
namespace {

/// Up to four points, in no order.
class Points {
 public:
  Points() = default;
  Points(std::initializer_list<Vec3d> points) {  // NOLINT: a list is points
    for (const Vec3d& p : points) add(p);
  }
  void add(const Vec3d& p) { v_[size_++] = p; }
  Points with(const Vec3d& p) const {
    Points result = *this;
    result.add(p);
    return result;
  }
  Points without(std::size_t i) const {
    Points result;
    for (std::size_t k = 0; k < size_; ++k) {
      if (k != i) result.add(v_[k]);
    }
    return result;
  }
  /// Vectors from a point to these.
  Points from(const Vec3d& origin) const {
    Points result;
    for (std::size_t k = 0; k < size_; ++k) result.add(v_[k] - origin);
    return result;
  }
  std::size_t size() const { return size_; }
  const Vec3d& operator[](std::size_t i) const { return v_[i]; }
  /// \pre at least one point
  Primitive hull() const {
    Primitive p;
    p.kind = size_ == 4 ? Kind::quad : Kind::tri;
    for (std::size_t i = 0; i < 4; ++i) p.v[i] = v_[std::min(i, size_ - 1)];
    return p;
  }

 private:
  std::array<Vec3d, 4> v_;
  std::size_t size_ = 0;
};

/// A part of a face whose points on the common edge are the edge, or one of its ends.
struct Piece {
  bool has_u;
  bool has_v;
  Points others;
};

/// Exact answers about hulls of points.
class Hulls {
 public:
  bool meet(const Primitive& a, const Primitive& b) const { return pairs_.decide(a, b).hit; }
  bool meet(const Points& a, const Points& b) const { return meet(a.hull(), b.hull()); }
  bool cross(const Primitive& a, const Primitive& b) const { return pairs_.cross(a, b); }

  /// Do the hull of v and a, and that of v and b, have a point but v in common?
  bool meet_beyond(const Vec3d& v, const Points& a, const Points& b) const {
    if (a.size() == 0 || b.size() == 0) return false;
    if (meet(a, {v})) return any_without_one(a, [&](const Points& rest) { return meet_beyond(v, rest, b); });
    if (meet(b, {v})) return any_without_one(b, [&](const Points& rest) { return meet_beyond(v, a, rest); });
    return meet(a, b.with(v)) || meet(a.with(v), b);
  }

  /// Do the hulls of u, v and a, and of u, v and b, have a point in common that is not on the edge uv?
  bool meet_beyond(const Vec3d& u, const Vec3d& v, const Points& a, const Points& b) const {
    std::vector<Piece> pieces_a;
    std::vector<Piece> pieces_b;
    divide(u, v, a, pieces_a);
    divide(u, v, b, pieces_b);
    for (const Piece& p : pieces_a) {
      for (const Piece& q : pieces_b) {
        if (meet_beyond(u, v, p, q)) return true;
      }
    }
    return false;
  }

 private:
  template <class Call>
  static bool any_without_one(const Points& points, const Call& call) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (call(points.without(i))) return true;
    }
    return false;
  }

  /// Pieces whose union is the hull of u, v and the others, but for points on the edge uv.
  void divide(const Vec3d& u, const Vec3d& v, Points others, std::vector<Piece>& pieces) const {
    for (std::size_t i = others.size(); i-- > 0;) {
      if (meet({others[i]}, {u, v})) others = others.without(i);
    }
    if (others.size() == 0) return;
    const bool is_diagonal = others.size() == 2 && meet(others, {u, v});
    const bool v_is_inside = !is_diagonal && meet({v}, others.with(u));
    const bool u_is_inside = !is_diagonal && !v_is_inside && meet({u}, others.with(v));
    if (!is_diagonal && !v_is_inside && !u_is_inside) {
      pieces.push_back({true, true, others});
      return;
    }
    if (others.size() == 2) {
      divide(u, v, others.without(0), pieces);
      divide(u, v, others.without(1), pieces);
    }
    if (!is_diagonal) pieces.push_back({u_is_inside, v_is_inside, others});
  }

  bool meet_beyond(const Vec3d& u, const Vec3d& v, const Piece& p, const Piece& q) const {
    if (p.has_u && p.has_v && q.has_u && q.has_v) {
      return meet_beyond(v, p.others, q.others.with(u)) || meet_beyond(v, p.others.with(u), q.others) ||
             meet_beyond(u, p.others, q.others.with(v)) || meet_beyond(u, p.others.with(v), q.others);
    }
    const auto beside = [](const Piece& x, bool has_other, const Vec3d& other) {
      return has_other ? x.others.with(other) : x.others;
    };
    if (p.has_v && q.has_v) return meet_beyond(v, beside(p, p.has_u, u), beside(q, q.has_u, u));
    if (p.has_u && q.has_u) return meet_beyond(u, beside(p, p.has_v, v), beside(q, q.has_v, v));
    return meet(p.others.with(p.has_u ? u : v), q.others.with(q.has_u ? u : v));
  }

  PosedPairs pairs_ = PosedPairs(Pose::Identity(), Pose::Identity());
};

/// Greatest relative error of a sum of products of up to four differences, and of the sum of their magnitudes;
/// generous.
constexpr double rounding = 0x1p-48;
/// With coordinates of at most `greatest` nothing overflows, and what underflows of a product is lost in the rounding
/// of a sum above `least_sum`.
constexpr double greatest = 0x1p200;
constexpr double least_sum = 0x1p-600;

/// A number in doubles, and the sum of the magnitudes of what it was summed from.
struct Sum {
  double value;
  double size;
  bool is_positive() const { return value > rounding * size && size > least_sum; }
  bool is_negative() const { return value < -rounding * size && size > least_sum; }
};

Sum dot(const Vec3d& x, const Vec3d& y) { return {x.dot(y), x.cwiseAbs().dot(y.cwiseAbs())}; }

struct SumVector {
  Vec3d value;
  Vec3d size;
};

SumVector cross(const Vec3d& x, const Vec3d& y) {
  const Vec3d p = x.cwiseAbs();
  const Vec3d q = y.cwiseAbs();
  return {x.cross(y), {p.y() * q.z() + p.z() * q.y(), p.z() * q.x() + p.x() * q.z(), p.x() * q.y() + p.y() * q.x()}};
}

Sum dot(const SumVector& x, const Vec3d& y) { return {x.value.dot(y), x.size.dot(y.cwiseAbs())}; }
Sum dot(const SumVector& x, const SumVector& y) { return {x.value.dot(y.value), x.size.dot(y.size)}; }

bool are_moderate(const Points& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(points[i].cwiseAbs().maxCoeff() <= greatest)) return false;
  }
  return true;
}

/// True only if the vectors of x lie on one side of the plane through 0 and those of y on the other, none in it. The
/// axis needs no error bound: any is valid.
bool separates(const Vec3d& axis, const Points& x, const Points& y) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!dot(axis, x[i]).is_positive()) return false;
  }
  for (std::size_t k = 0; k < y.size(); ++k) {
    if (!dot(axis, y[k]).is_negative()) return false;
  }
  return true;
}

/// True only if hulls with one common vertex are certain to meet nowhere else; x, y: from there to their other
/// vertices, rounded.
bool are_apart_beyond_vertex(const Points& x, const Points& y) {
  Vec3d axis = Vec3d::Zero();
  for (std::size_t i = 0; i < x.size(); ++i) axis += x[i];
  for (std::size_t k = 0; k < y.size(); ++k) axis -= y[k];
  if (separates(axis, x, y)) return true;
  std::array<Vec3d, 3> unit_x;
  std::array<Vec3d, 3> unit_y;
  axis.setZero();
  for (std::size_t i = 0; i < x.size(); ++i) axis += unit_x[i] = x[i] / std::sqrt(x[i].squaredNorm());
  for (std::size_t k = 0; k < y.size(); ++k) axis -= unit_y[k] = y[k] / std::sqrt(y[k].squaredNorm());
  if (separates(axis, x, y)) return true;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t k = 0; k < y.size(); ++k) {
      if (separates(unit_x[i] - unit_y[k], x, y)) return true;
    }
  }
  const auto lies_beside = [](const Points& triangle, const Points& others) {
    if (triangle.size() != 2) return false;
    const SumVector normal = cross(triangle[0], triangle[1]);
    bool is_above = true;
    bool is_below = true;
    for (std::size_t i = 0; i < others.size(); ++i) {
      const Sum side = dot(normal, others[i]);
      is_above = is_above && side.is_positive();
      is_below = is_below && side.is_negative();
    }
    return is_above || is_below;
  };
  return lies_beside(x, y) || lies_beside(y, x);
}

/// True only if hulls with a common edge are certain to meet nowhere else; x, y: from one end of the edge to their
/// other vertices, rounded.
bool are_apart_beyond_edge(const Vec3d& edge, const Points& x, const Points& y) {
  if (x.size() == 1 && y.size() == 1) {
    const Sum volume = dot(cross(edge, x[0]), y[0]);
    if (volume.is_positive() || volume.is_negative()) return true;
  }
  // Seen along the edge, all angles between a vertex of one and a vertex of the other are obtuse.
  for (std::size_t i = 0; i < x.size(); ++i) {
    const SumVector normal = cross(edge, x[i]);
    for (std::size_t k = 0; k < y.size(); ++k) {
      if (!dot(normal, cross(edge, y[k])).is_negative()) return false;
    }
  }
  return true;
}

/// True only if an axis certainly separates the hulls of x and y; both from one origin, rounded.
bool separates_hulls(const Vec3d& axis, const Points& x, const Points& y) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto interval = [&axis, infinity](const Points& points, double& size) {
    std::pair<double, double> range = {infinity, -infinity};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Sum at = dot(axis, points[i]);
      range = {std::min(range.first, at.value), std::max(range.second, at.value)};
      size = std::max(size, at.size);
    }
    return range;
  };
  double size = 0;
  const auto at_x = interval(x, size);
  const auto at_y = interval(y, size);
  const double gap = std::max(at_y.first - at_x.second, at_x.first - at_y.second);
  return Sum{gap, 2 * size}.is_positive();
}

/// True only if hulls without a common vertex are certain to be apart; x, y: from one vertex of x to all of both,
/// rounded. Looks along the line between their centres and, for faces in one plane, along its normals to their edges:
/// PosedPairs decides all others well.
bool are_apart(const Points& x, const Points& y) {
  const auto centre = [](const Points& points) {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) sum += points[i];
    return Vec3d(sum / static_cast<double>(points.size()));
  };
  if (separates_hulls(centre(x) - centre(y), x, y)) return true;
  const auto across_edges = [](const Points& points, const Points& others) {
    const Vec3d normal = (points[1] - points[0]).cross(points[2] - points[0]);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3d edge = points[(i + 1) % points.size()] - points[i];
      if (separates_hulls(normal.cross(edge), points, others)) return true;
    }
    return false;
  };
  return (x.size() > 2 && across_edges(x, y)) || (y.size() > 2 && across_edges(y, x));
}

struct Box {
  Vec3d least;
  Vec3d greatest;
};

bool overlap(const Box& p, const Box& q) {
  return p.least.x() <= q.greatest.x() && q.least.x() <= p.greatest.x() && p.least.y() <= q.greatest.y() &&
         q.least.y() <= p.greatest.y() && p.least.z() <= q.greatest.z() && q.least.z() <= p.greatest.z();
}

void enclose(Box& box, const Box& other) {
  box.least = box.least.cwiseMin(other.least);
  box.greatest = box.greatest.cwiseMax(other.greatest);
}

/// Vectors from one vertex, each times some factor above 0, in a box; empty if there are none, without a bound if one
/// has no certain direction.
struct Directions {
  Box box = {Vec3d::Constant(std::numeric_limits<double>::infinity()),
             Vec3d::Constant(-std::numeric_limits<double>::infinity())};
  void add(const Vec3d& from, const Vec3d& to) {
    const Vec3d v = to - from;  // off by at most 2^-53 of itself
    const double size = v.cwiseAbs().maxCoeff();
    if (!(size > 0x1p-500 && size < 0x1p500)) {
      box = {Vec3d::Constant(-2), Vec3d::Constant(2)};
    } else {
      enclose(box, {v / size, v / size});
    }
  }
};

/// True only if a plane through the common vertex certainly separates the vectors of p from those of q.
bool separates(const Directions& p, const Directions& q) {
  const Vec3d axis = (p.box.least + p.box.greatest) - (q.box.least + q.box.greatest);
  double least_p = 0;
  double most_q = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    least_p += std::min(axis[k] * p.box.least[k], axis[k] * p.box.greatest[k]);
    most_q += std::max(axis[k] * q.box.least[k], axis[k] * q.box.greatest[k]);
  }
  // Components are at most 2 and exact up to 2^-51; three products and their sums.
  const double slack = 0x1p-46 * axis.cwiseAbs().sum();
  return least_p > slack && most_q < -slack;
}

/// Ends the search.
struct Enough {};

/// Vertices of a face, of those at one position always the same one; a triangle's first one twice.
using Corners = std::array<std::uint32_t, 4>;

class SelfSearch {
 public:
  SelfSearch(const Object& object, std::size_t most, Neighbours neighbours)
      : object_(object),
        mesh_(object.mesh()),
        tree_(object.tree()),
        most_(most),
        neighbours_(neighbours),
        numbers_(tree_.faces().size()),
        face_boxes_(tree_.faces().size()),
        boxes_(tree_.size()) {
    number_positions();
    for (std::size_t i = 0; i < face_boxes_.size(); ++i) face_boxes_[i] = box_of(mesh_.faces[tree_.faces()[i]]);
    // Lines come after the one that refers to them.
    for (std::size_t line = boxes_.size(); line-- > 0;) {
      const bvh::NodeRef node = tree_.lines()[line].ref();
      const std::vector<Box>& parts = node.is_leaf() ? face_boxes_ : boxes_;
      boxes_[line] = parts[node.first()];
      for (std::uint32_t i = 1; i < node.count(); ++i) enclose(boxes_[line], parts[node.first() + i]);
    }
    find_hubs();
  }

  std::vector<Contact> run() {
    try {
      inside(tree_.root());
    } catch (const Enough&) {  // NOLINT: it is no error
      relate_all_parts();
    }
    std::vector<Contact> contacts;
    contacts.reserve(found_.size());
    for (const auto& [faces, relation] : found_) contacts.push_back({faces.first, faces.second, relation});
    return contacts;
  }

 private:
  Box box_of(const Mesh::Face& face) const {
    const Vec3d& first = mesh_.vertices[face.vertex[0]];
    Box box = {first, first};
    for (std::size_t i = 1; i < static_cast<std::size_t>(face.kind); ++i) {
      const Vec3d& v = mesh_.vertices[face.vertex[i]];
      enclose(box, {v, v});
    }
    return box;
  }

  /// Gives the vertices of all faces numbers: one vertex for each position.
  void number_positions() {
    std::size_t size = 16;  // of a table with open addressing
    while (size < 2 * mesh_.vertices.size()) size *= 2;
    std::vector<std::uint32_t> table(size, none);
    std::vector<std::uint32_t> number(mesh_.vertices.size(), none);
    const auto number_of = [&](std::uint32_t vertex) {
      if (number[vertex] != none) return number[vertex];
      const Vec3d& v = mesh_.vertices[vertex];
      std::uint64_t hash = 0;
      for (Eigen::Index k = 0; k < 3; ++k) {
        const double x = v[k] + 0.0;  // not -0, which equals 0
        std::uint64_t bits = 0;
        std::memcpy(&bits, &x, sizeof bits);
        hash = (hash ^ bits) * 0x9E3779B97F4A7C15U;
        hash ^= hash >> 32U;
      }
      std::size_t at = hash & (size - 1);
      while (table[at] != none && !(mesh_.vertices[table[at]] == v)) at = (at + 1) & (size - 1);
      if (table[at] == none) table[at] = vertex;
      return number[vertex] = table[at];
    };
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      const Mesh::Face& face = mesh_.faces[tree_.faces()[i]];
      const std::size_t corners = static_cast<std::size_t>(face.kind);
      for (std::size_t k = 0; k < 4; ++k) numbers_[i][k] = number_of(face.vertex[k < corners ? k : 0]);
    }
  }

  /// Where very many faces meet in one vertex, the hub, their boxes all overlap. Lines below which all faces have it
  /// get the directions of their other vertices from there.
  void find_hubs() {
    std::vector<std::uint32_t> uses(mesh_.vertices.size());
    std::uint32_t most = 0;
    for (const Corners& corners : numbers_) {
      for (std::size_t a = 0; a < 4; ++a) {
        if (is_first(corners, a)) most = std::max(most, ++uses[corners[a]]);
      }
    }
    if (most < hub_uses) return;
    hubs_.resize(boxes_.size(), none);
    directions_.resize(boxes_.size());
    for (std::size_t line = boxes_.size(); line-- > 0;) {
      const bvh::NodeRef node = tree_.lines()[line].ref();
      std::uint32_t hub = none;
      if (node.is_leaf()) {
        for (const std::uint32_t corner : numbers_[node.first()]) {
          if (uses[corner] >= hub_uses && (hub == none || uses[corner] > uses[hub])) hub = corner;
        }
      } else {
        hub = hubs_[node.first()];
      }
      for (std::uint32_t i = node.first(); i < node.first() + node.count() && hub != none; ++i) {
        if (!(node.is_leaf() ? has(numbers_[i], hub) : hubs_[i] == hub)) hub = none;
      }
      hubs_[line] = hub;
      if (hub == none) continue;
      for (std::uint32_t i = node.first(); i < node.first() + node.count(); ++i) {
        if (!node.is_leaf()) {
          enclose(directions_[line].box, directions_[i].box);
          continue;
        }
        for (const std::uint32_t corner : numbers_[i]) {
          if (corner != hub) directions_[line].add(mesh_.vertices[hub], mesh_.vertices[corner]);
        }
      }
    }
  }

  /// True only if the faces below the two lines have a vertex in common and certainly nothing else.
  bool meet_in_hub_alone(std::uint32_t p, std::uint32_t q) const {
    return !hubs_.empty() && hubs_[p] != none && hubs_[p] == hubs_[q] && separates(directions_[p], directions_[q]);
  }

  /// Pairs of faces below one node.
  void inside(bvh::NodeRef node) {
    const std::uint32_t end = node.first() + node.count();
    for (std::uint32_t i = node.first(); i < end; ++i) {
      if (!node.is_leaf()) inside(tree_.lines()[i].ref());
      for (std::uint32_t k = i + 1; k < end; ++k) node.is_leaf() ? test(i, k) : between(i, k);
    }
  }

  /// Pairs of a face below one line and a face below another.
  void between(std::uint32_t p, std::uint32_t q) {
    if (!overlap(boxes_[p], boxes_[q]) || meet_in_hub_alone(p, q)) return;
    const bvh::NodeRef p_node = tree_.lines()[p].ref();
    const bvh::NodeRef q_node = tree_.lines()[q].ref();
    const bool open_p = !p_node.is_leaf();
    const bool open_q = !q_node.is_leaf();
    if (!open_p && !open_q) {
      for (std::uint32_t i = 0; i < p_node.count(); ++i) {
        for (std::uint32_t k = 0; k < q_node.count(); ++k) test(p_node.first() + i, q_node.first() + k);
      }
    } else if (open_p && (!open_q || size(p) >= size(q))) {
      for (std::uint32_t i = 0; i < p_node.count(); ++i) between(p_node.first() + i, q);
    } else {
      for (std::uint32_t k = 0; k < q_node.count(); ++k) between(p, q_node.first() + k);
    }
  }
  double size(std::uint32_t line) const { return (boxes_[line].greatest - boxes_[line].least).sum(); }

  /// Two faces by their places in the tree.
  void test(std::uint32_t p, std::uint32_t q) {
    if (!overlap(face_boxes_[p], face_boxes_[q])) return;
    const std::uint32_t i = tree_.faces()[p];
    const std::uint32_t k = tree_.faces()[q];
    const std::pair<std::uint32_t, std::uint32_t> faces =
        std::minmax({mesh_.number_in_file(i), mesh_.number_in_file(k)});  // by value
    if (faces.first == faces.second) return;                              // parts of one polygon
    const Relation relation = relate(i, k, numbers_[p], numbers_[q]);
    if (relation == Relation::apart) return;
    const auto known = found_.find(faces);
    if (known != found_.end()) {
      known->second = std::max(known->second, relation);
      return;
    }
    if (found_.size() == most_) throw Enough();
    found_.emplace(faces, relation);
  }

  /// Two faces by their numbers in the mesh, and their vertices.
  Relation relate(std::uint32_t i, std::uint32_t k, const Corners& f, const Corners& g) const {
    Points common;
    Points beside_f;
    Points beside_g;
    for (std::size_t a = 0; a < 4; ++a) {
      if (is_first(f, a)) (has(g, f[a]) ? common : beside_f).add(mesh_.vertices[f[a]]);
    }
    if (common.size() != 0 && neighbours_ == Neighbours::left_out) return Relation::apart;
    for (std::size_t a = 0; a < 4; ++a) {
      if (is_first(g, a) && !has(f, g[a])) beside_g.add(mesh_.vertices[g[a]]);
    }
    if (common.size() == 0) {
      const Points x = beside_f.from(beside_f[0]);
      const Points y = beside_g.from(beside_f[0]);
      if (are_moderate(x) && are_moderate(y) && are_apart(x, y)) return Relation::apart;
      if (!hulls_.meet(mesh_.primitive(i), mesh_.primitive(k))) return Relation::apart;
    } else if (!meet_beyond(common, beside_f, beside_g)) {
      return Relation::apart;
    }
    return hulls_.cross(mesh_.primitive(i), mesh_.primitive(k)) ? Relation::crossing : Relation::touching;
  }

  static bool has(const Corners& x, std::uint32_t number) {
    const auto is = [number](auto other) { return static_cast<unsigned>(other == number); };
    return (is(x[0]) | is(x[1]) | is(x[2]) | is(x[3])) != 0;  // without branches
  }
  static bool is_first(const Corners& x, std::size_t a) {
    return (a < 1 || x[0] != x[a]) && (a < 2 || x[1] != x[a]) && (a < 3 || x[2] != x[a]);
  }

  /// Do neighbours meet elsewhere than in their common vertex or on their common edge?
  bool meet_beyond(const Points& common, const Points& f, const Points& g) const {
    if (common.size() > 2) return true;
    if (f.size() == 0 || g.size() == 0) return false;  // collapsed
    const Points x = f.from(common[0]);
    const Points y = g.from(common[0]);
    const bool is_moderate = are_moderate(x) && are_moderate(y);
    if (common.size() == 1) {
      return !(is_moderate && are_apart_beyond_vertex(x, y)) && hulls_.meet_beyond(common[0], f, g);
    }
    const Vec3d edge = common[1] - common[0];
    return !(is_moderate && are_moderate({edge}) && are_apart_beyond_edge(edge, x, y)) &&
           hulls_.meet_beyond(common[0], common[1], f, g);
  }

  /// The search ended before it met all parts of polygons that were cut: those that only touch so far may cross.
  void relate_all_parts() {
    if (mesh_.file_face.empty()) return;
    std::vector<std::uint32_t> place(mesh_.faces.size());  // in the tree
    // Places of a leaf that it does not need repeat a face with equal numbers.
    for (std::uint32_t p = 0; p < numbers_.size(); ++p) place[tree_.faces()[p]] = p;
    for (auto& entry : found_) {  // no binding: a lambda cannot capture one
      const std::pair<std::uint32_t, std::uint32_t>& faces = entry.first;
      Relation& relation = entry.second;
      const Pose here = Pose::Identity();
      const CollisionQuery query = {&object_, &here, &object_, &here};
      any_near_parts(query, {faces.first, faces.second}, [&](std::uint32_t i, std::uint32_t k) {
        relation = std::max(relation, relate(i, k, numbers_[place[i]], numbers_[place[k]]));
        return relation == Relation::crossing;
      });
    }
  }

  static constexpr std::uint32_t none = ~std::uint32_t{0};
  static constexpr std::uint32_t hub_uses = 64;  ///< faces at a vertex from which it is a hub

  const Object& object_;
  const Mesh& mesh_;
  const bvh::SupportTree& tree_;
  std::size_t most_;
  Neighbours neighbours_;
  Hulls hulls_;
  std::vector<Corners> numbers_;        ///< in the order of the tree
  std::vector<Box> face_boxes_;         ///< in the order of the tree
  std::vector<Box> boxes_;              ///< of each line
  std::vector<std::uint32_t> hubs_;     ///< of each line; empty: there are none
  std::vector<Directions> directions_;  ///< of each line with a hub
  std::map<std::pair<std::uint32_t, std::uint32_t>, Relation> found_;
};

}  // namespace

std::vector<Contact> self_contacts(const Object& object, std::size_t max_contacts, Neighbours neighbours) {
  check_float_mode();
  if (max_contacts == 0) throw std::invalid_argument("self_contacts: max_contacts is 0: ask for at least one contact");
  return SelfSearch(object, max_contacts, neighbours).run();
}

}  // namespace cchip
