// SPDX-License-Identifier: Apache-2.0
// Convex polygons are clipped by half-spaces (I. Sutherland, G. Hodgman, "Reentrant polygon clipping", 1974), in
// integers: a point is a fraction whose numerators and denominator are integers of any size.
//
// A primitive is a point, a segment, a polygon or a tetrahedron. Each is the set where some linear functions are not
// negative, or zero. If one of two primitives is no tetrahedron, it is clipped by the functions of the other. If both
// are tetrahedra, a corner of their intersection lies on the boundary of one and in the other. It is a corner of the
// part of a boundary triangle that lies in the other, too, so clipping the four triangles of each finds it. Of what
// that finds, corners are the points at which three functions with independent normals are zero.
#include "common_part.hpp"

#include <algorithm>
#include <limits>

namespace cchip {
namespace {

using exact::BigInt;
using exact::cross;
using exact::FractionPoint;
using exact::is_zero;
using exact::nonzero_component;
using exact::Vec;

/// A point in units of the pair: over / under, under > 0.
struct Point {
  Vec<BigInt> over;
  BigInt under = 1;
};

/// normal x >= offset, or equal to it.
struct Constraint {
  Vec<BigInt> normal;
  BigInt offset;
  bool is_equation = false;

  /// Has the sign of normal x - offset.
  BigInt value(const Point& p) const {
    return normal[0] * p.over[0] + normal[1] * p.over[1] + normal[2] * p.over[2] - offset * p.under;
  }
};

using Polygon = std::vector<Point>;

BigInt dot(const Vec<BigInt>& p, const Vec<BigInt>& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
Vec<BigInt> negative(const Vec<BigInt>& p) { return {-p[0], -p[1], -p[2]}; }

int compare_component(const Point& p, const Point& q, std::size_t k) {
  return BigInt(p.over[k] * q.under - q.over[k] * p.under).sign();
}

int compare_points(const Point& p, const Point& q) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (const int s = compare_component(p, q, k); s != 0) return s;
  }
  return 0;
}

/// q - p times a positive factor.
Vec<BigInt> direction(const Point& p, const Point& q) {
  return {q.over[0] * p.under - p.over[0] * q.under, q.over[1] * p.under - p.over[1] * q.under,
          q.over[2] * p.under - p.over[2] * q.under};
}

/// Sorts and leaves out what is equal to another.
void sort_points(Polygon& points) {
  std::sort(points.begin(), points.end(), [](const Point& p, const Point& q) { return compare_points(p, q) < 0; });
  points.erase(std::unique(points.begin(), points.end(),
                           [](const Point& p, const Point& q) { return compare_points(p, q) == 0; }),
               points.end());
}

/// Sign of the turn p, q, r with coordinate d left out.
int turn(const Point& p, const Point& q, const Point& r, std::size_t d) {
  const std::size_t e = (d + 1) % 3;
  const std::size_t f = (d + 2) % 3;
  const Vec<BigInt> u = direction(p, q);
  const Vec<BigInt> v = direction(p, r);
  return BigInt(u[e] * v[f] - u[f] * v[e]).sign();
}

/// The corners of the hull of points in one plane, once around; A. Andrew's monotone chain (1979).
/// \param points sorted, not all on one line
/// \param d leaving this coordinate out maps the plane one to one
Polygon planar_hull(const Polygon& points, std::size_t d) {
  Polygon hull;
  const auto add = [&](const Point& p, std::size_t least) {
    while (hull.size() >= least && turn(hull[hull.size() - 2], hull.back(), p, d) <= 0) hull.pop_back();
    hull.push_back(p);
  };
  // The order by x, y, z is one in the plane: a linear function with an infinitesimal part, which is not constant on
  // any two of its points.
  for (const Point& p : points) add(p, 2);
  const std::size_t least = hull.size() + 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], least);
  hull.pop_back();  // the first once more
  return hull;
}

/// What some points span: dimension and, as far as there are such, a direction in it and a normal.
struct Span {
  int dimension = 0;
  Vec<BigInt> along;
  Vec<BigInt> normal;
};

Span span_of(const Polygon& points) {
  Span span;
  for (std::size_t i = 1; i < points.size() && span.dimension < 3; ++i) {
    const Vec<BigInt> u = direction(points[0], points[i]);
    if (span.dimension == 0) {
      if (!is_zero(u)) {
        span.along = u;
        span.dimension = 1;
      }
    } else if (span.dimension == 1) {
      const Vec<BigInt> normal = cross(span.along, u);
      if (!is_zero(normal)) {
        span.normal = normal;
        span.dimension = 2;
      }
    } else if (dot(span.normal, u) != 0) {
      span.dimension = 3;
    }
  }
  return span;
}

/// A primitive as constraints, and polygons (or a segment, or a point) that cover it, or its boundary if it is solid.
struct Convex {
  int dimension = 0;
  std::vector<Polygon> cover;
  std::vector<Constraint> constraints;

  explicit Convex(Polygon points) {
    sort_points(points);
    const Span span = span_of(points);
    dimension = span.dimension;
    switch (dimension) {
      case 0:
        for (std::size_t k = 0; k < 3; ++k) {
          Vec<BigInt> axis;
          axis[k] = 1;
          add(axis, points[0], true);
        }
        cover.push_back(points);
        break;
      case 1: {
        points = {points.front(), points.back()};
        const std::size_t d = nonzero_component(span.along);
        for (const std::size_t k : {(d + 1) % 3, (d + 2) % 3}) {
          Vec<BigInt> axis;
          axis[k] = 1;
          add(cross(span.along, axis), points[0], true);
        }
        const Vec<BigInt> along = direction(points[0], points[1]);
        add(along, points[0]);
        add(negative(along), points[1]);
        cover.push_back(points);
        break;
      }
      case 2: {
        add(span.normal, points[0], true);
        cover.push_back(planar_hull(points, nonzero_component(span.normal)));
        const Polygon& corner = cover.back();
        for (std::size_t i = 0; i < corner.size(); ++i) {
          const Point& p = corner[i];
          const Point& q = corner[(i + 1) % corner.size()];
          add_towards(cross(span.normal, direction(p, q)), p, corner[(i + 2) % corner.size()]);
        }
        break;
      }
      default:
        for (std::size_t i = 0; i < 4; ++i) {
          const Polygon face = {points[(i + 1) % 4], points[(i + 2) % 4], points[(i + 3) % 4]};
          add_towards(cross(direction(face[0], face[1]), direction(face[0], face[2])), face[0], points[i]);
          cover.push_back(face);
        }
    }
  }

 private:
  /// Zero at `at`, whose denominator is 1.
  void add(const Vec<BigInt>& normal, const Point& at, bool is_equation = false) {
    constraints.push_back({normal, dot(normal, at.over), is_equation});
  }
  /// Positive at `inside`.
  void add_towards(const Vec<BigInt>& normal, const Point& at, const Point& inside) {
    add(normal, at);
    if (constraints.back().value(inside).sign() > 0) return;
    constraints.pop_back();
    add(negative(normal), at);
  }
};

/// The point of the line p, q at which a function is zero that has values of different signs at p and q.
Point zero_between(const Point& p, const BigInt& at_p, const Point& q, const BigInt& at_q) {
  const BigInt weight_p = abs(at_q);
  const BigInt weight_q = abs(at_p);
  Point zero;
  for (std::size_t k = 0; k < 3; ++k) zero.over[k] = weight_p * p.over[k] + weight_q * q.over[k];
  zero.under = weight_p * p.under + weight_q * q.under;
  // Points that are cut from points that were cut get ever longer; a common divisor is most of it.
  constexpr std::size_t long_number = 1500;
  if (msb(zero.under) > long_number) {
    BigInt divisor = zero.under;
    for (const BigInt& x : zero.over) divisor = gcd(divisor, x);
    for (BigInt& x : zero.over) x /= divisor;
    zero.under /= divisor;
  }
  return zero;
}

/// The part of a polygon without superfluous corners, a segment or a point where the function is not negative, or, with
/// `sign` -1, not positive. The result has no superfluous corners either.
Polygon clip(const Polygon& polygon, const Constraint& constraint, int sign) {
  std::vector<BigInt> value;
  for (const Point& p : polygon) value.push_back(constraint.value(p) * sign);
  Polygon part;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (value[i].sign() >= 0) part.push_back(polygon[i]);
    const std::size_t k = (i + 1) % n;
    const bool is_edge = n > 2 || i + 1 < n;
    if (is_edge && value[i].sign() * value[k].sign() < 0) {
      part.push_back(zero_between(polygon[i], value[i], polygon[k], value[k]));
    }
  }
  return part;
}

Polygon clip(Polygon polygon, const std::vector<Constraint>& constraints) {
  // Equations first: they leave the least.
  for (const bool equations : {true, false}) {
    for (const Constraint& constraint : constraints) {
      if (polygon.empty()) return polygon;
      if (constraint.is_equation != equations) continue;
      polygon = clip(polygon, constraint, 1);
      if (equations) polygon = clip(polygon, constraint, -1);
    }
  }
  return polygon;
}

/// True if three of the constraints that are zero at p have independent normals.
bool is_corner(const Point& p, const Convex& a, const Convex& b) {
  Vec<BigInt> first;
  Vec<BigInt> normal;
  int rank = 0;
  for (const Convex* side : {&a, &b}) {
    for (const Constraint& constraint : side->constraints) {
      if (constraint.value(p) != 0) continue;
      if (rank == 0) {
        first = constraint.normal;
        rank = 1;
      } else if (rank == 1) {
        normal = cross(first, constraint.normal);
        if (!is_zero(normal)) rank = 2;
      } else if (dot(normal, constraint.normal) != 0) {
        return true;
      }
    }
  }
  return false;
}

/// The corners of the intersection of two solids, ascending.
Polygon solid_corners(const Convex& a, const Convex& b) {
  Polygon found;
  for (const auto& [own, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (const Polygon& face : own->cover) {
      for (Point& p : clip(face, other->constraints)) found.push_back(std::move(p));
    }
  }
  sort_points(found);
  found.erase(std::remove_if(found.begin(), found.end(), [&](const Point& p) { return !is_corner(p, a, b); }),
              found.end());
  return found;
}

/// From the least corner on, towards the lesser one of its neighbours.
void begin_at_least(Polygon& polygon) {
  const auto less = [](const Point& p, const Point& q) { return compare_points(p, q) < 0; };
  std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end(), less), polygon.end());
  if (polygon.size() > 2 && less(polygon.back(), polygon[1])) std::reverse(polygon.begin() + 1, polygon.end());
}

/// The vertices under the pose, in units of 2^exponent.
Polygon points_of(const Primitive& p, const Pose& pose, int exponent) {
  Polygon points(p.vertex_count());
  const std::array<Vec<BigInt>, 4> scaled = exact::scaled_points(p, pose, exponent);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].over = scaled[i];
  return points;
}

/// Takes a common power of two out of all coordinates. \returns its exponent
int shorten(Polygon& a, Polygon& b) {
  BigInt all = 0;
  for (const Polygon* side : {&a, &b}) {
    for (const Point& p : *side) {
      for (const BigInt& x : p.over) all |= abs(x);
    }
  }
  if (all == 0) return 0;
  const std::size_t zeros = lsb(all);
  for (Polygon* side : {&a, &b}) {
    for (Point& p : *side) {
      for (BigInt& x : p.over) x /= BigInt(1) << zeros;
    }
  }
  return static_cast<int>(zeros);
}

}  // namespace

double exact::nearest_double(const BigInt& over, const BigInt& under, int exponent) {
  if (over == 0) return 0;
  constexpr int digits = std::numeric_limits<double>::digits;
  constexpr int least = std::numeric_limits<double>::min_exponent - digits;  // of a subnormal number
  BigInt top = abs(over);
  BigInt bottom = under;
  // A quotient of 64 or 65 bits, whose last bit says whether anything is left.
  const int shift = 64 - (static_cast<int>(msb(top)) - static_cast<int>(msb(bottom)));
  (shift > 0 ? top : bottom) <<= std::abs(shift);
  BigInt quotient;
  BigInt rest;
  divide_qr(top, bottom, quotient, rest);
  if (rest != 0) quotient |= 1;
  const int length = static_cast<int>(msb(quotient)) + 1;
  const int unit = exponent - shift;  // the quotient is in units of 2^unit
  const int drop = std::max(length - digits, least - unit);
  if (drop > length) return 0;  // less than half of the least double
  const BigInt kept = quotient >> drop;
  const BigInt half = BigInt(1) << (drop - 1);
  const BigInt left = quotient - (kept << drop);
  auto size = static_cast<std::uint64_t>(kept);
  if (left > half || (left == half && size % 2 == 1)) ++size;
  const double result = std::ldexp(static_cast<double>(size), unit + drop);
  return over.sign() < 0 && result != 0 ? -result : result;
}

int exact::compare(const FractionPoint& p, const FractionPoint& q) {
  const int exponent = std::min(p.exponent, q.exponent);
  for (std::size_t k = 0; k < 3; ++k) {
    // Rounding does not change the order of numbers, at most it makes them equal.
    const auto i = static_cast<Eigen::Index>(k);
    if (p.rounded[i] != q.rounded[i]) return p.rounded[i] < q.rounded[i] ? -1 : 1;
    const BigInt left = (p.over[k] * q.under) << (p.exponent - exponent);
    const BigInt right = (q.over[k] * p.under) << (q.exponent - exponent);
    if (left != right) return left < right ? -1 : 1;
  }
  return 0;
}

std::optional<exact::CommonPart> exact::common_part(const Primitive& a, const Pose& pose_a, const Primitive& b,
                                                    const Pose& pose_b) {
  int exponent = common_exponent(b, pose_b, common_exponent(a, pose_a, std::numeric_limits<int>::max()));
  if (exponent == std::numeric_limits<int>::max()) exponent = 0;
  Polygon points_a = points_of(a, pose_a, exponent);
  Polygon points_b = points_of(b, pose_b, exponent);
  exponent += shorten(points_a, points_b);
  const Convex hull_a(points_a);
  const Convex hull_b(points_b);

  Polygon common;
  int dimension = 0;
  if (hull_a.dimension == 3 && hull_b.dimension == 3) {
    common = solid_corners(hull_a, hull_b);
    const Span span = span_of(common);
    dimension = span.dimension;
    if (dimension == 2) common = planar_hull(common, nonzero_component(span.normal));
  } else {
    const bool a_first = hull_a.dimension <= hull_b.dimension;
    common = clip((a_first ? hull_a : hull_b).cover[0], (a_first ? hull_b : hull_a).constraints);
    dimension = std::min<int>(2, static_cast<int>(common.size()) - 1);
  }
  if (common.empty()) return std::nullopt;
  if (dimension < 3) begin_at_least(common);

  CommonPart part;
  constexpr std::array<Intersection::Kind, 4> kinds = {Intersection::Kind::point, Intersection::Kind::segment,
                                                       Intersection::Kind::polygon, Intersection::Kind::polyhedron};
  part.kind = kinds.at(static_cast<std::size_t>(dimension));
  for (Point& p : common) {
    FractionPoint point;
    for (std::size_t k = 0; k < 3; ++k) {
      point.rounded[static_cast<Eigen::Index>(k)] = nearest_double(p.over[k], p.under, exponent);
    }
    point.over = std::move(p.over);
    point.under = std::move(p.under);
    point.exponent = exponent;
    part.points.push_back(std::move(point));
  }
  return part;
}

std::optional<Intersection> exact_intersection(const Primitive& a, const Pose& pose_a, const Primitive& b,
                                               const Pose& pose_b) {
  const std::optional<exact::CommonPart> part = exact::common_part(a, pose_a, b, pose_b);
  if (!part) return std::nullopt;
  Intersection result;
  result.kind = part->kind;
  for (const exact::FractionPoint& p : part->points) result.points.push_back(p.rounded);
  return result;
}

}  // namespace cchip
