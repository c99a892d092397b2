// SPDX-License-Identifier: Apache-2.0
/// \file
/// Does the sphere of a point meet a triangle? Two exact answers in integers that share nothing but the input: the
/// square of the distance as a fraction, and seven axes on which the projections are compared literally.
#ifndef CCHIP_TESTS_REF_POINT_TRIANGLE_ORACLE_HPP
#define CCHIP_TESTS_REF_POINT_TRIANGLE_ORACLE_HPP

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace cchip_test {

/// Enough for every product of coordinates of 16 bits below: the greatest has 226 bits.
using Int256 = boost::multiprecision::int256_t;

template <class Int>
using IntVector = std::array<Int, 3>;
using IntTriangle = std::array<std::array<std::int64_t, 3>, 3>;

template <class Int>
Int dot(const IntVector<Int>& a, const IntVector<Int>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Int>
IntVector<Int> minus(const IntVector<Int>& a, const IntVector<Int>& b) {
  return {Int(a[0] - b[0]), Int(a[1] - b[1]), Int(a[2] - b[2])};
}
template <class Int>
IntVector<Int> cross(const IntVector<Int>& a, const IntVector<Int>& b) {
  return {Int(a[1] * b[2] - a[2] * b[1]), Int(a[2] * b[0] - a[0] * b[2]), Int(a[0] * b[1] - a[1] * b[0])};
}
template <class Int>
IntVector<Int> convert(const std::array<std::int64_t, 3>& v) {
  return {Int(v[0]), Int(v[1]), Int(v[2])};
}

/// over / under, under > 0.
template <class Int>
struct Fraction {
  Int over = 0;
  Int under = 1;
  friend bool operator<(const Fraction& x, const Fraction& y) { return x.over * y.under < y.over * x.under; }
};

/// Where the nearest point of the triangle lies.
enum class Region : std::uint8_t { vertex, side, face };

template <class Int>
struct Nearest {
  Fraction<Int> square;  ///< of the distance from the origin
  Region region = Region::vertex;
};

/// The nearest of: the vertices, the foot of the perpendicular on each side if it lies inside the side, and the foot on
/// the plane if its barycentric coordinates (normal equations, Cramer's rule) are those of an inner point.
/// \param t vertices relative to the point
template <class Int>
Nearest<Int> nearest(const IntTriangle& t) {
  const IntVector<Int> v[3] = {convert<Int>(t[0]), convert<Int>(t[1]), convert<Int>(t[2])};
  Nearest<Int> best{{dot(v[0], v[0]), 1}, Region::vertex};
  const auto offer = [&](const Fraction<Int>& square, Region region) {
    if (square < best.square) best = {square, region};
  };
  for (std::size_t i = 1; i < 3; ++i) offer({dot(v[i], v[i]), 1}, Region::vertex);
  for (std::size_t i = 0; i < 3; ++i) {
    const IntVector<Int> e = minus(v[(i + 1) % 3], v[i]);
    const Int length = dot(e, e);
    const Int along = -dot(v[i], e);  // the foot is v + along / length e
    if (along <= 0 || along >= length) continue;
    offer({Int(dot(v[i], v[i]) * length - along * along), length}, Region::side);
  }
  const IntVector<Int> e = minus(v[1], v[0]);
  const IntVector<Int> f = minus(v[2], v[0]);
  const Int ee = dot(e, e);
  const Int ef = dot(e, f);
  const Int ff = dot(f, f);
  const Int er = -dot(e, v[0]);
  const Int fr = -dot(f, v[0]);
  const Int under = ee * ff - ef * ef;
  const Int s = er * ff - fr * ef;  // the foot is v[0] + (s e + t f) / under
  const Int u = fr * ee - er * ef;
  if (under != 0 && s > 0 && u > 0 && s + u < under) {
    const Int height = dot(cross(e, f), v[0]);
    offer({Int(height * height), under}, Region::face);
  }
  return best;
}

/// -1: the distance is less than the radius, 0: the same, 1: greater.
template <class Int>
int compare(const Fraction<Int>& square, std::int64_t radius) {
  const Int difference = square.over - Int(radius) * Int(radius) * square.under;
  return difference < 0 ? -1 : difference > 0 ? 1 : 0;
}

/// Axis 0 is the normal of the face, 1 to 3 are the perpendiculars from the point on the lines of the sides 0 to 2, 4
/// to 6 the directions to the vertices.
inline constexpr std::size_t point_axes = 7;

/// Direction of an axis; zero if there is none, as the normal of a triangle without area.
template <class Int>
IntVector<Int> axis_of(const IntTriangle& t, std::size_t axis) {
  const IntVector<Int> v[3] = {convert<Int>(t[0]), convert<Int>(t[1]), convert<Int>(t[2])};
  if (axis >= 4) return v[axis - 4];
  if (axis == 0) return cross(minus(v[1], v[0]), minus(v[2], v[0]));
  const IntVector<Int>& from = v[axis - 1];
  const IntVector<Int> e = minus(v[axis % 3], from);
  const Int length = dot(e, e);
  const Int along = dot(from, e);
  return {Int(length * from[0] - along * e[0]), Int(length * from[1] - along * e[1]),
          Int(length * from[2] - along * e[2])};
}

/// Whether the projections of sphere and triangle on the axis are disjoint: all vertices beyond r |u| on one side.
template <class Int>
bool separates(const IntTriangle& t, std::int64_t radius, std::size_t axis) {
  const IntVector<Int> u = axis_of<Int>(t, axis);
  Int least = dot(u, convert<Int>(t[0]));
  Int most = least;
  for (std::size_t i = 1; i < 3; ++i) {
    const Int p = dot(u, convert<Int>(t[i]));
    if (p < least) least = p;
    if (p > most) most = p;
  }
  const Int gap = least > 0 ? least : most < 0 ? Int(-most) : Int(0);
  return gap > 0 && gap * gap > Int(radius) * Int(radius) * dot(u, u);
}

/// The first axis that separates.
template <class Int>
std::optional<std::size_t> first_axis(const IntTriangle& t, std::int64_t radius) {
  for (std::size_t axis = 0; axis < point_axes; ++axis) {
    if (separates<Int>(t, radius, axis)) return axis;
  }
  return std::nullopt;
}

}  // namespace cchip_test

#endif
