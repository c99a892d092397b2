// SPDX-License-Identifier: Apache-2.0
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
#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cchip/exact/oracle.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace cchip {
namespace {

/// The grid's integer. 32-bit coordinates need 3 x 33 + 3 bits.
using Int128 = boost::multiprecision::int128_t;
/// Any size, for doubles.
using BigInt = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>, boost::multiprecision::et_off>;

template <class Int>
using Vec = std::array<Int, 3>;

template <class Int>
Vec<Int> operator-(const Vec<Int>& p, const Vec<Int>& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}

template <class Int>
Vec<Int> cross(const Vec<Int>& p, const Vec<Int>& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

template <class Int>
int sign_of_dot(const Vec<Int>& p, const Vec<Int>& q) {
  return Int(p[0] * q[0] + p[1] * q[1] + p[2] * q[2]).sign();
}

/// Index of a component that is not zero; 3 if there is none.
template <class Int>
std::size_t nonzero_component(const Vec<Int>& p) {
  return static_cast<std::size_t>(std::find_if(p.begin(), p.end(), [](const Int& c) { return c.sign() != 0; }) -
                                  p.begin());
}

template <class Int>
bool is_zero(const Vec<Int>& p) {
  return nonzero_component(p) == 3;
}

/// True if the signs are neither all positive nor all negative.
bool both_sides(const std::array<int, 3>& s) {
  return std::min({s[0], s[1], s[2]}) <= 0 && std::max({s[0], s[1], s[2]}) >= 0;
}

/// True if 0 <= part / whole <= 1, whole not zero.
template <class Int>
bool is_fraction(const Int& part, const Int& whole) {
  return whole.sign() > 0 ? part.sign() >= 0 && part <= whole : part.sign() <= 0 && part >= whole;
}

/// Closed segments pq and rs in space; each may be a point.
template <class Int>
bool segments_meet(const Vec<Int>& p, const Vec<Int>& q, const Vec<Int>& r, const Vec<Int>& s) {
  const Vec<Int> u = q - p;
  const Vec<Int> w = s - r;
  const Vec<Int> between = r - p;
  const Vec<Int> normal = cross(u, w);
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
template <class Int>
struct Triangle {
  Triangle(const Vec<Int>& v0, const Vec<Int>& v1, const Vec<Int>& v2)
      : v{v0, v1, v2}, normal(cross(v1 - v0, v2 - v0)) {}

  /// Sides of the plane on which the points lie; zeros if this is collapsed.
  int side(const Vec<Int>& p) const { return sign_of_dot(normal, p - v[0]); }
  std::array<int, 3> sides(const Triangle& t) const { return {side(t.v[0]), side(t.v[1]), side(t.v[2])}; }

  std::array<Vec<Int>, 3> v;
  Vec<Int> normal;
};

/// p in the plane of a triangle that is not collapsed. (V(k+1) - V(k)) x (p - V(k)) is parallel to the
/// normal, so one component tells its sign.
template <class Int>
bool coplanar_point_in_triangle(const Vec<Int>& p, const Triangle<Int>& t) {
  const std::size_t d = nonzero_component(t.normal);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec<Int>& from = t.v[k];
    if (cross(t.v[(k + 1) % 3] - from, p - from)[d].sign() * t.normal[d].sign() < 0) return false;
  }
  return true;
}

/// Segment pq in the plane of the triangle, or any segment and a collapsed triangle.
template <class Int>
bool coplanar_segment_meets(const Vec<Int>& p, const Vec<Int>& q, const Triangle<Int>& t) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (segments_meet(p, q, t.v[k], t.v[(k + 1) % 3])) return true;
  }
  return !is_zero(t.normal) && coplanar_point_in_triangle(p, t);
}

/// Segment pq whose end points lie on the given sides of the triangle's plane.
template <class Int>
bool segment_meets(const Vec<Int>& p, int side_p, const Vec<Int>& q, int side_q, const Triangle<Int>& t) {
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) return coplanar_segment_meets(p, q, t);
  // The line crosses the plane in one point, which the segment holds: the triangle holds it unless the
  // line passes two of its edges on different sides.
  const Vec<Int> u = q - p;
  const std::array<Vec<Int>, 3> from_p = {t.v[0] - p, t.v[1] - p, t.v[2] - p};
  int least = 0;
  int greatest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const int s = sign_of_dot(u, cross(from_p[k], from_p[(k + 1) % 3]));
    least = std::min(least, s);
    greatest = std::max(greatest, s);
  }
  return least == 0 || greatest == 0;
}

template <class Int>
bool triangles_meet(const Triangle<Int>& a, const Triangle<Int>& b) {
  const std::array<int, 3> sides_b = a.sides(b);
  if (!both_sides(sides_b)) return false;
  const std::array<int, 3> sides_a = b.sides(a);
  if (!both_sides(sides_a)) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t n = (k + 1) % 3;
    if (segment_meets(a.v[k], sides_a[k], a.v[n], sides_a[n], b)) return true;
    if (segment_meets(b.v[k], sides_b[k], b.v[n], sides_b[n], a)) return true;
  }
  return false;
}

/// Hull of three or four points as its triangles; triangle i of four leaves vertex i out.
template <class Int>
struct Hull {
  explicit Hull(const std::vector<Vec<Int>>& points) : v(points) {
    if (v.size() == 3) {
      faces = {Triangle<Int>(v[0], v[1], v[2])};
    } else {
      for (std::size_t i = 0; i < 4; ++i) faces.emplace_back(v[(i + 1) % 4], v[(i + 2) % 4], v[(i + 3) % 4]);
    }
  }

  /// True if this is a tetrahedron with a volume and p is in it.
  bool solid_holds(const Vec<Int>& p) const {
    if (v.size() == 3) return false;
    for (std::size_t i = 0; i < 4; ++i) {
      const int inner = faces[i].side(v[i]);
      if (inner == 0 || inner * faces[i].side(p) < 0) return false;
    }
    return true;
  }

  std::vector<Vec<Int>> v;
  std::vector<Triangle<Int>> faces;
};

template <class Int>
bool hulls_meet(const Hull<Int>& a, const Hull<Int>& b) {
  for (const Triangle<Int>& face_a : a.faces) {
    for (const Triangle<Int>& face_b : b.faces) {
      if (triangles_meet(face_a, face_b)) return true;
    }
  }
  return a.solid_holds(b.v[0]) || b.solid_holds(a.v[0]);
}

Vec<Int128> to_int128(const Vec3i& p) { return {p.x(), p.y(), p.z()}; }

Triangle<Int128> grid_triangle(const GridPrimitive& p) {
  return {to_int128(p.v[0]), to_int128(p.v[1]), to_int128(p.v[2])};
}

Hull<Int128> grid_hull(const GridPrimitive& p) {
  std::vector<Vec<Int128>> points;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) points.push_back(to_int128(p.v[i]));
  return Hull<Int128>(points);
}

/// value = mantissa * 2^exponent, exactly.
struct Scaled {
  explicit Scaled(double value) {
    if (!std::isfinite(value)) {
      throw std::invalid_argument("exact oracle: a coordinate is not finite: replace NaN and infinities by numbers");
    }
    constexpr int digits = std::numeric_limits<double>::digits;
    mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), digits));
    exponent -= digits;
  }
  std::int64_t mantissa = 0;
  int exponent = 0;
};

/// Smallest exponent of the coordinates that are not zero; `so_far` if there is none.
int common_exponent(const Primitive& p, int so_far) {
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    for (const double c : p.v[i]) {
      const Scaled s(c);
      if (s.mantissa != 0) so_far = std::min(so_far, s.exponent);
    }
  }
  return so_far;
}

BigInt to_bigint(double value, int exponent) {
  const Scaled s(value);
  return s.mantissa == 0 ? BigInt(0) : BigInt(s.mantissa) << (s.exponent - exponent);
}

Hull<BigInt> scaled_hull(const Primitive& p, int exponent) {
  std::vector<Vec<BigInt>> points;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    points.push_back(
        {to_bigint(p.v[i].x(), exponent), to_bigint(p.v[i].y(), exponent), to_bigint(p.v[i].z(), exponent)});
  }
  return Hull<BigInt>(points);
}

}  // namespace

bool exact_intersects(const GridPair& pair) {
  if (pair.a.kind == Kind::tri && pair.b.kind == Kind::tri) {
    return triangles_meet(grid_triangle(pair.a), grid_triangle(pair.b));
  }
  return hulls_meet(grid_hull(pair.a), grid_hull(pair.b));
}

bool exact_intersects(const Primitive& a, const Primitive& b) {
  const int exponent = common_exponent(b, common_exponent(a, std::numeric_limits<double>::max_exponent));
  return hulls_meet(scaled_hull(a, exponent), scaled_hull(b, exponent));
}

}  // namespace cchip
