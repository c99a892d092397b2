// SPDX-License-Identifier: Apache-2.0
// The s for which a point p of A and a point q of B + s d coincide: p - q = s d. Seen along d, p and q coincide; how
// far they are apart along d is s. Least and greatest s are the optima of a linear programme in the weights of the
// vertices: all at least 0, those of A have the sum 1, those of B too, and two equations say that p and q coincide seen
// along d. An optimum is attained where at most four weights are not 0 and the equations determine them: a vertex on a
// vertex, a vertex on an edge, a vertex in a triangle, or an edge across an edge, as they are seen along d, where
// triangle and edges are of any vertices. So all of these are looked at, whatever is degenerate.
#include "meeting.hpp"

#include <cmath>
#include <utility>

#include "common_part.hpp"

namespace cchip::exact {
namespace {

/// A vertex seen along the direction: at (u, v), and how far along it.
struct Seen {
  BigInt u;
  BigInt v;
  BigInt along;
};

struct View {
  std::array<Seen, 4> point;
  std::size_t count = 0;
};

Seen operator-(const Seen& p, const Seen& q) { return {p.u - q.u, p.v - q.v, p.along - q.along}; }
/// Of (u, v).
BigInt cross(const Seen& p, const Seen& q) { return p.u * q.v - p.v * q.u; }

/// Least and greatest of fractions.
class Extremes {
 public:
  void add(BigInt over, BigInt under) {
    if (under < 0) {
      over = -over;
      under = -under;
    }
    if (!any_) {
      least_ = greatest_ = {over, under};
      any_ = true;
      return;
    }
    if (over * least_.second < least_.first * under) least_ = {over, under};
    if (over * greatest_.second > greatest_.first * under) greatest_ = {over, under};
  }
  bool any() const { return any_; }
  const std::pair<BigInt, BigInt>& least() const { return least_; }
  const std::pair<BigInt, BigInt>& greatest() const { return greatest_; }

 private:
  bool any_ = false;
  std::pair<BigInt, BigInt> least_;
  std::pair<BigInt, BigInt> greatest_;
};

/// 0 <= x <= whole, where the sign of `whole` may be any.
bool is_part(const BigInt& x, const BigInt& whole) { return whole > 0 ? x >= 0 && x <= whole : x <= 0 && x >= whole; }

/// Both as if the vertex were of A; `sign` is -1 if it is of B.
void vertex_on_edge(const Seen& p, const Seen& q0, const Seen& q1, int sign, Extremes& found) {
  const Seen edge = q1 - q0;
  const bool by_u = edge.u != 0;
  if (!by_u && edge.v == 0) return;
  const Seen from = p - q0;
  if (cross(edge, from) != 0) return;
  const BigInt& whole = by_u ? edge.u : edge.v;
  const BigInt& part = by_u ? from.u : from.v;
  if (is_part(part, whole)) found.add((from.along * whole - part * edge.along) * sign, whole);
}
void vertex_in_triangle(const Seen& p, const Seen& q0, const Seen& q1, const Seen& q2, int sign, Extremes& found) {
  const BigInt whole = cross(q1 - q0, q2 - q0);
  if (whole == 0) return;
  const Seen r0 = q0 - p;
  const Seen r1 = q1 - p;
  const Seen r2 = q2 - p;
  const BigInt w0 = cross(r1, r2);
  if (!is_part(w0, whole)) return;
  const BigInt w1 = cross(r2, r0);
  if (!is_part(w1, whole)) return;
  const BigInt w2 = whole - w0 - w1;
  if (!is_part(w2, whole)) return;
  found.add(-(w0 * r0.along + w1 * r1.along + w2 * r2.along) * sign, whole);
}

void edge_across_edge(const Seen& p0, const Seen& p1, const Seen& q0, const Seen& q1, Extremes& found) {
  const Seen p = p1 - p0;
  const Seen q = q1 - q0;
  const BigInt whole = cross(p, q);
  if (whole == 0) return;
  const Seen between = q0 - p0;
  const BigInt part_p = cross(between, q);
  if (!is_part(part_p, whole)) return;
  const BigInt part_q = cross(between, p);
  if (!is_part(part_q, whole)) return;
  found.add(part_p * p.along - part_q * q.along - between.along * whole, whole);
}

void vertices_on(const View& own, const View& other, int sign, Extremes& found) {
  for (std::size_t i = 0; i < own.count; ++i) {
    for (std::size_t j = 0; j < other.count; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        vertex_on_edge(own.point[i], other.point[j], other.point[k], sign, found);
        for (std::size_t l = 0; l < k; ++l) {
          vertex_in_triangle(own.point[i], other.point[j], other.point[k], other.point[l], sign, found);
        }
      }
    }
  }
}

/// Do the ranges of a coordinate overlap?
bool overlap(const View& a, const View& b, BigInt Seen::*coordinate) {
  const auto reaches = [coordinate](const View& from, const View& to) {  // is some of `to` not below all of `from`?
    const BigInt* least = &(from.point[0].*coordinate);
    for (std::size_t i = 1; i < from.count; ++i) {
      if (from.point[i].*coordinate < *least) least = &(from.point[i].*coordinate);
    }
    for (std::size_t k = 0; k < to.count; ++k) {
      if (to.point[k].*coordinate >= *least) return true;
    }
    return false;
  };
  return reaches(a, b) && reaches(b, a);
}

Extremes extremes(const View& a, const View& b) {
  Extremes found;
  if (!overlap(a, b, &Seen::u) || !overlap(a, b, &Seen::v)) return found;
  for (std::size_t i = 0; i < a.count; ++i) {
    for (std::size_t j = 0; j < b.count; ++j) {
      const Seen apart = a.point[i] - b.point[j];
      if (apart.u == 0 && apart.v == 0) found.add(apart.along, 1);
      for (std::size_t k = 0; k < i; ++k) {
        for (std::size_t l = 0; l < j; ++l) {
          edge_across_edge(a.point[i], a.point[k], b.point[j], b.point[l], found);
        }
      }
    }
  }
  vertices_on(a, b, 1, found);
  vertices_on(b, a, -1, found);
  return found;
}

/// Takes the greatest common power of two out of numbers. \returns its exponent
template <class Numbers>
int shorten(const Numbers& numbers) {
  BigInt all = 0;
  for (const BigInt* x : numbers) all |= abs(*x);
  if (all == 0) return 0;
  const std::size_t zeros = lsb(all);
  for (BigInt* x : numbers) *x /= BigInt(1) << zeros;
  return static_cast<int>(zeros);
}

/// A direction in units of 2^exponent.
struct Direction {
  explicit Direction(const Vec3d& d) : exponent(std::numeric_limits<int>::max()) {
    for (const double x : d) {
      if (x != 0) exponent = std::min(exponent, Scaled(x).exponent);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const Scaled x(d[static_cast<Eigen::Index>(i)]);
      if (x.mantissa != 0) vector[i] = BigInt(x.mantissa) << (x.exponent - exponent);
    }
    exponent += shorten(std::array<BigInt*, 3>{&vector[0], &vector[1], &vector[2]});
    for (std::size_t i = 1; i < 3; ++i) {
      if (abs(vector[i]) > abs(vector[greatest])) greatest = i;
    }
  }
  Vec<BigInt> vector;
  int exponent;
  std::size_t greatest = 0;  ///< component
};

View seen_along(const Direction& d, const std::array<Vec<BigInt>, 4>& points, std::size_t count) {
  const std::size_t k = d.greatest;
  const std::size_t e = (k + 1) % 3;
  const std::size_t f = (k + 2) % 3;
  View view;
  view.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec<BigInt>& p = points[i];
    view.point[i] = {p[e] * d.vector[k] - p[k] * d.vector[e], p[f] * d.vector[k] - p[k] * d.vector[f],
                     d.vector[k] < 0 ? -p[k] : p[k]};
  }
  return view;
}

}  // namespace

Fraction::Fraction(const BigInt& top, const BigInt& bottom, int power)
    : over(top), under(bottom), exponent(power), nearest(nearest_double(top, bottom, power)) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  low = high = nearest;
  int beside = 0;  // sign of the number less the nearest double
  if (!std::isfinite(nearest)) {
    beside = nearest > 0 ? -1 : 1;
  } else {
    const Scaled x(nearest);
    BigInt left = over;
    BigInt right = under * x.mantissa;
    if (x.mantissa != 0) {
      (exponent > x.exponent ? left : right) <<= std::abs(exponent - x.exponent);
    }
    beside = left.compare(right);
  }
  if (beside > 0) high = std::nextafter(nearest, infinity);
  if (beside < 0) low = std::nextafter(nearest, -infinity);
}

int compare(const Fraction& x, const Fraction& y) {
  if (x.high < y.low) return -1;
  if (y.high < x.low) return 1;
  const int exponent = std::min(x.exponent, y.exponent);
  const BigInt left = (x.over * y.under) << (x.exponent - exponent);
  const BigInt right = (y.over * x.under) << (y.exponent - exponent);
  return left.compare(right);
}

std::optional<Meeting> meeting(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b,
                               const Vec3d& direction) {
  const Direction d(direction);
  int exponent = common_exponent(b, pose_b, common_exponent(a, pose_a, std::numeric_limits<int>::max()));
  if (exponent == std::numeric_limits<int>::max()) exponent = 0;
  std::array<Vec<BigInt>, 4> points_a = scaled_points(a, pose_a, exponent);
  std::array<Vec<BigInt>, 4> points_b = scaled_points(b, pose_b, exponent);
  // Only differences matter. Those of points that are near each other are short numbers, wherever the points are.
  const Vec<BigInt> base = points_b[0];
  std::vector<BigInt*> numbers;
  for (const auto& [points, count] : {std::pair(&points_a, a.vertex_count()), std::pair(&points_b, b.vertex_count())}) {
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        (*points)[i][k] -= base[k];
        numbers.push_back(&(*points)[i][k]);
      }
    }
  }
  exponent += shorten(numbers);
  const Extremes found = extremes(seen_along(d, points_a, a.vertex_count()), seen_along(d, points_b, b.vertex_count()));
  if (!found.any()) return std::nullopt;
  const BigInt length = abs(d.vector[d.greatest]);
  const auto fraction = [&](const std::pair<BigInt, BigInt>& x) {
    return Fraction(x.first, x.second * length, exponent - d.exponent);
  };
  return Meeting{fraction(found.least()), fraction(found.greatest())};
}

}  // namespace cchip::exact
