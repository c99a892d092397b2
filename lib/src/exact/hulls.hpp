// SPDX-License-Identifier: Apache-2.0
/// \file
/// Do two hulls of three or four points share a point, and do they cross? Decided by signs of polynomials in the
/// coordinates, over any number type Num with +, -, *, sign() and comparison.
//
// Exact intersection of triangles by orientation signs, no separating axes.
//
// Two closed triangles A and B, each possibly collapsed to a segment or point, intersect if and only if
// an edge of one meets the other. Proof of "only if": let p be an extreme point of the compact convex
// set A n B. If A or B is collapsed, it is the union of its edges and p lies on one. Otherwise suppose
// that p lies in the relative interior of both. If their planes are equal, a disc around p belongs to
// both; if not, a segment around p on the planes' common line does. Either way p is not extreme. So p
// lies on the boundary, that is on an edge, of A or of B, and within the other.
//
// A quad is the hull of its four vertices. Its boundary (or all of it, if flat) is the union of the four
// triangles of three vertices each. Two hulls intersect if and only if two of these triangles do or one
// hull is solid and holds a vertex of the other (connected sets without a common boundary point).
#ifndef CCHIP_EXACT_HULLS_HPP
#define CCHIP_EXACT_HULLS_HPP

#include <algorithm>
#include <array>
#include <cchip/relation.hpp>
#include <cstddef>

namespace cchip::exact {

template <class Num>
using Vec = std::array<Num, 3>;

// Numbers that may not know their sign overload these; filter.hpp does.

/// Sign of x; where it is not known, 0, and `open` becomes true.
template <class Num>
int sign_if_known(const Num& x, bool& /*open*/) {
  return x.sign();
}
/// Makes the answer invalid: it depends on a sign that is not known.
template <class Num>
void give_up(const Num& /*any*/) {}
/// True if the answer is invalid already.
template <class Num>
bool is_pointless(const Num& /*any*/) {
  return false;
}

template <class Num>
Vec<Num> operator-(const Vec<Num>& p, const Vec<Num>& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}

template <class Num>
Vec<Num> cross(const Vec<Num>& p, const Vec<Num>& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

template <class Num>
int sign_of_dot(const Vec<Num>& p, const Vec<Num>& q) {
  return Num(p[0] * q[0] + p[1] * q[1] + p[2] * q[2]).sign();
}

/// Index of a component that is not zero; 3 if there is none.
template <class Num>
std::size_t nonzero_component(const Vec<Num>& p) {
  bool open = false;
  for (std::size_t k = 0; k < 3; ++k) {
    if (sign_if_known(p[k], open) != 0) return k;
  }
  if (open) give_up(p[0]);
  return 3;
}

template <class Num>
bool is_zero(const Vec<Num>& p) {
  return nonzero_component(p) == 3;
}

/// True if the signs are neither all positive nor all negative.
inline bool both_sides(const std::array<int, 3>& s) {
  return std::min({s[0], s[1], s[2]}) <= 0 && std::max({s[0], s[1], s[2]}) >= 0;
}

/// True if 0 <= part / whole <= 1, whole not zero.
template <class Num>
bool is_fraction(const Num& part, const Num& whole) {
  return whole.sign() > 0 ? part.sign() >= 0 && part <= whole : part.sign() <= 0 && part >= whole;
}

/// Closed segments pq and rs in space; each may be a point.
template <class Num>
bool segments_meet(const Vec<Num>& p, const Vec<Num>& q, const Vec<Num>& r, const Vec<Num>& s) {
  const Vec<Num> u = q - p;
  const Vec<Num> w = s - r;
  const Vec<Num> between = r - p;
  const Vec<Num> normal = cross(u, w);
  const std::size_t d = nonzero_component(normal);
  if (d < 3) {  // the lines are not parallel: p + t u = r + t' w, t normal = between x w, t' normal = between x u
    if (sign_of_dot(normal, between) != 0) return false;
    return is_fraction(cross(between, w)[d], normal[d]) && is_fraction(cross(between, u)[d], normal[d]);
  }
  if (!is_zero(cross(u, between)) || !is_zero(cross(w, between))) return false;
  // All on one line, along which the lexicographic order is monotonic; or two points.
  return std::max(std::min(p, q), std::min(r, s)) <= std::min(std::max(p, q), std::max(r, s));
}

/// Three vertices and (V1 - V0) x (V2 - V0), which is zero for a collapsed triangle.
template <class Num>
struct Triangle {
  Triangle() = default;
  Triangle(const Vec<Num>& v0, const Vec<Num>& v1, const Vec<Num>& v2)
      : v{v0, v1, v2}, normal(cross(v1 - v0, v2 - v0)) {}

  /// Sides of the plane on which the points lie; zeros if this is collapsed.
  int side(const Vec<Num>& p) const { return sign_of_dot(normal, p - v[0]); }
  std::array<int, 3> sides(const Triangle& t) const { return {side(t.v[0]), side(t.v[1]), side(t.v[2])}; }

  std::array<Vec<Num>, 3> v;
  Vec<Num> normal;
};

/// p in the plane of a triangle that is not collapsed. (V(k+1) - V(k)) x (p - V(k)) is parallel to the
/// normal, so one component tells its sign.
template <class Num>
bool coplanar_point_in_triangle(const Vec<Num>& p, const Triangle<Num>& t) {
  const std::size_t d = nonzero_component(t.normal);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec<Num>& from = t.v[k];
    if (cross(t.v[(k + 1) % 3] - from, p - from)[d].sign() * t.normal[d].sign() < 0) return false;
  }
  return true;
}

/// Segment pq in the plane of the triangle, or any segment and a collapsed triangle.
template <class Num>
bool coplanar_segment_meets(const Vec<Num>& p, const Vec<Num>& q, const Triangle<Num>& t) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (segments_meet(p, q, t.v[k], t.v[(k + 1) % 3])) return true;
  }
  return !is_zero(t.normal) && coplanar_point_in_triangle(p, t);
}

/// Segment pq whose end points lie on the given sides of the triangle's plane.
template <class Num>
bool segment_meets(const Vec<Num>& p, int side_p, const Vec<Num>& q, int side_q, const Triangle<Num>& t) {
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) return coplanar_segment_meets(p, q, t);
  // The line crosses the plane in one point, which the segment holds: the triangle holds it unless the
  // line passes two of its edges on different sides.
  const Vec<Num> u = q - p;
  const std::array<Vec<Num>, 3> from_p = {t.v[0] - p, t.v[1] - p, t.v[2] - p};
  int least = 0;
  int greatest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const int s = sign_of_dot(u, cross(from_p[k], from_p[(k + 1) % 3]));
    least = std::min(least, s);
    greatest = std::max(greatest, s);
  }
  return least == 0 || greatest == 0;
}

/// True if all of q lies beyond an edge of p, which is not collapsed, in their common plane. d: a component of p's
/// normal that is not zero, so leaving it out maps the plane one to one. One known vertex on the inner side is enough
/// to rule an edge out; `open` becomes true where that takes a sign that is not known.
template <class Num>
bool is_beyond_edge(const Triangle<Num>& p, std::size_t d, const Triangle<Num>& q, bool& open) {
  const std::size_t e = (d + 1) % 3;
  const std::size_t f = (d + 2) % 3;
  const int turn = p.normal[d].sign();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec<Num>& from = p.v[k];
    const Vec<Num>& to = p.v[(k + 1) % 3];
    const Num along_e = to[e] - from[e];
    const Num along_f = to[f] - from[f];
    bool beyond = true;
    bool unknown = false;
    for (std::size_t i = 0; i < 3 && beyond; ++i) {
      bool open_here = false;
      const int s = sign_if_known(Num(along_e * (q.v[i][f] - from[f]) - along_f * (q.v[i][e] - from[e])), open_here);
      unknown = unknown || open_here;
      beyond = open_here || s * turn < 0;
    }
    if (!beyond) continue;
    if (!unknown) return true;
    open = true;
  }
  return false;
}

/// Triangles in one plane, neither collapsed. Two convex polygons have no point in common if and only if one lies
/// beyond an edge of the other: their difference is a polygon, too, each of whose edges is parallel to an edge of one
/// of them.
template <class Num>
bool coplanar_triangles_meet(const Triangle<Num>& a, std::size_t d, const Triangle<Num>& b) {
  bool open = false;
  if (is_beyond_edge(a, d, b, open) || is_beyond_edge(b, d, a, open)) return false;
  if (open) give_up(a.normal[d]);
  return true;
}

inline bool are_zero(const std::array<int, 3>& s) { return s[0] == 0 && s[1] == 0 && s[2] == 0; }

template <class Num>
bool triangles_meet(const Triangle<Num>& a, const Triangle<Num>& b) {
  const std::array<int, 3> sides_b = a.sides(b);
  if (!both_sides(sides_b) || is_pointless(a.normal[0])) return false;
  const std::array<int, 3> sides_a = b.sides(a);
  if (!both_sides(sides_a) || is_pointless(b.normal[0])) return false;
  if (are_zero(sides_a) && are_zero(sides_b)) {
    const std::size_t d = nonzero_component(a.normal);
    if (d < 3 && !is_zero(b.normal)) return coplanar_triangles_meet(a, d, b);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t n = (k + 1) % 3;
    if (segment_meets(a.v[k], sides_a[k], a.v[n], sides_a[n], b)) return true;
    if (segment_meets(b.v[k], sides_b[k], b.v[n], sides_b[n], a)) return true;
  }
  return false;
}

/// Hull of three or four points as its triangles; triangle i of four leaves vertex i out.
template <class Num>
struct Hull {
  Hull(const std::array<Vec<Num>, 4>& points, std::size_t count)
      : v(points), solid(count == 4), faces(count == 4 ? 4 : 1) {
    if (!solid) {
      face[0] = Triangle<Num>(v[0], v[1], v[2]);
      return;
    }
    for (std::size_t i = 0; i < 4; ++i) face[i] = Triangle<Num>(v[(i + 1) % 4], v[(i + 2) % 4], v[(i + 3) % 4]);
  }

  std::size_t count() const { return solid ? 4 : 3; }

  /// True if this is a tetrahedron with a volume and p is in it.
  bool solid_holds(const Vec<Num>& p) const {
    if (!solid) return false;
    for (std::size_t i = 0; i < 4; ++i) {
      const int inner = face[i].side(v[i]);
      if (inner == 0 || inner * face[i].side(p) < 0) return false;
    }
    return true;
  }

  std::array<Vec<Num>, 4> v;  ///< v[3] of a triangle is unused
  bool solid;                 ///< four points, which may span a volume
  std::size_t faces;          ///< triangles in use
  std::array<Triangle<Num>, 4> face;
};

template <class Num>
bool hulls_meet(const Hull<Num>& a, const Hull<Num>& b) {
  for (std::size_t i = 0; i < a.faces; ++i) {
    for (std::size_t k = 0; k < b.faces; ++k) {
      if (triangles_meet(a.face[i], b.face[k])) return true;
    }
  }
  return a.solid_holds(b.v[0]) || b.solid_holds(a.v[0]);
}

// Two hulls cross if 0 lies in the interior of A - B, so that every small enough translation leaves them in contact.
// 0 lies outside the interior if and only if a linear function that is not zero is nowhere positive on A - B, or
// nowhere negative. If A - B has a volume, the normals of its facets suffice: a facet is the sum of a face of A and one
// of -B, so its normal is that of a face of one hull or is orthogonal to an edge of each. If it is flat, the normal of
// its plane is among these, too, and zero on all of A - B; if it is a segment or a point, all of them are zero vectors.
// Segments of two vertices that are no edges, and triangles of three that are no faces, only add functions.

/// True if the axis is not zero and some vertex of A lies farther along it than some vertex of B, and some less far.
template <class Num>
bool overlaps_both_ways(const Vec<Num>& axis, const Hull<Num>& a, const Hull<Num>& b) {
  bool before = false;
  bool behind = false;
  for (std::size_t i = 0; i < a.count(); ++i) {
    for (std::size_t k = 0; k < b.count(); ++k) {
      const int s = sign_of_dot(axis, a.v[i] - b.v[k]);
      before = before || s < 0;
      behind = behind || s > 0;
      if (before && behind) return true;
    }
  }
  return false;
}

/// True if 0 lies in the interior of A - B.
template <class Num>
bool hulls_cross(const Hull<Num>& a, const Hull<Num>& b) {
  bool some = false;  // an axis that is not zero
  const auto allows = [&](const Vec<Num>& axis) {
    if (!overlaps_both_ways(axis, a, b)) return is_zero(axis);
    some = true;
    return true;
  };
  const auto normals_allow = [&](const Hull<Num>& own, const Hull<Num>& other) {
    if (own.solid) {
      return std::all_of(own.face.begin(), own.face.end(), [&](const Triangle<Num>& t) { return allows(t.normal); });
    }
    bool before = false;  // all of a triangle lies in its plane, so only the other's vertices tell
    bool behind = false;
    for (std::size_t i = 0; i < other.count(); ++i) {
      const int s = own.face[0].side(other.v[i]);
      before = before || s < 0;
      behind = behind || s > 0;
    }
    if (!before || !behind) return is_zero(own.face[0].normal);
    some = true;
    return true;
  };
  if (!normals_allow(a, b) || !normals_allow(b, a)) return false;
  for (std::size_t i = 0; i < a.count(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec<Num> edge = a.v[i] - a.v[j];
      for (std::size_t k = 0; k < b.count(); ++k) {
        for (std::size_t l = 0; l < k; ++l) {
          if (!allows(cross(edge, b.v[k] - b.v[l]))) return false;
        }
      }
    }
  }
  return some;
}

template <class Num>
Relation relation_of(const Hull<Num>& a, const Hull<Num>& b) {
  if (!hulls_meet(a, b)) return Relation::apart;
  return hulls_cross(a, b) ? Relation::crossing : Relation::touching;
}

}  // namespace cchip::exact

#endif
