// SPDX-License-Identifier: Apache-2.0
/// \file
/// Points with a radius and triangles for tests, most of them near the decision: touching exactly at a vertex, on a
/// side, on the face, one step beside that, degenerate, at the ends of the grid.
#ifndef CCHIP_TESTS_REF_POINT_TRIANGLE_SOURCE_HPP
#define CCHIP_TESTS_REF_POINT_TRIANGLE_SOURCE_HPP

#include <algorithm>
#include <cchip/stimulus/boundary.hpp>
#include <cmath>
#include <random>

#include "point_triangle_oracle.hpp"

namespace cchip_test {

struct PointTriangle {
  std::array<std::int64_t, 3> point = {};
  std::int64_t radius = 0;
  IntTriangle triangle = {};
  /// Vertices as seen from the point.
  IntTriangle relative() const {
    IntTriangle t = triangle;
    for (auto& v : t) v = minus<std::int64_t>(v, point);
    return t;
  }
};

class PointTriangleSource {
 public:
  /// \param coord_w width of a signed coordinate, bit
  PointTriangleSource(int coord_w, std::uint64_t seed)
      : least_(-(std::int64_t{1} << (coord_w - 1))), most_(-least_ - 1), random_(seed) {}

  PointTriangle draw() {
    const auto choice = random_() % 100;
    PointTriangle pair = choice < 10 ? anywhere() : choice < 50 ? near_the_radius() : touching();
    if (chance(25)) step(pair);
    return pair;
  }

 private:
  using Vector = std::array<std::int64_t, 3>;

  bool chance(int percent) { return static_cast<int>(random_() % 100) < percent; }
  std::int64_t integer(std::int64_t least, std::int64_t most) { return cchip::stimulus::draw(random_, least, most); }
  std::int64_t most_radius() const { return most_ - least_; }
  Vector anyone() { return {integer(least_, most_), integer(least_, most_), integer(least_, most_)}; }
  bool fits(std::int64_t c) const { return c >= least_ && c <= most_; }
  bool fits(const Vector& v) const { return fits(v[0]) && fits(v[1]) && fits(v[2]); }
  bool fits(const PointTriangle& p) const {
    return fits(p.point) && fits(p.triangle[0]) && fits(p.triangle[1]) && fits(p.triangle[2]) && p.radius >= 0 &&
           p.radius <= most_radius();
  }

  PointTriangle anywhere() {
    PointTriangle p;
    p.point = anyone();
    for (Vector& v : p.triangle) v = anyone();
    degenerate(p.triangle);
    p.radius = integer(0, most_radius());
    return p;
  }

  void degenerate(IntTriangle& t) {
    if (!chance(25)) return;
    const std::size_t i = random_() % 3;
    const Vector& from = t[(i + 1) % 3];
    const Vector& to = t[(i + 2) % 3];
    t[i] = from;                            // a segment
    if (chance(30)) t[(i + 2) % 3] = from;  // a point
    Vector middle;
    for (std::size_t d = 0; d < 3; ++d) middle[d] = (from[d] + to[d]) / 2;
    bool even = true;
    for (std::size_t d = 0; d < 3; ++d) even = even && (from[d] + to[d]) % 2 == 0;
    if (even && chance(50)) t[i] = middle;  // three points on a line
  }

  /// Any triangle, the radius next to the distance.
  PointTriangle near_the_radius() {
    PointTriangle p = anywhere();
    if (chance(50)) {  // a point near the middle, so that the face is the nearest more often
      for (std::size_t d = 0; d < 3; ++d) {
        const std::int64_t middle = (p.triangle[0][d] + p.triangle[1][d] + p.triangle[2][d]) / 3;
        p.point[d] = std::min(most_, std::max(least_, middle + integer(least_, most_) / 4));
      }
    }
    const auto square = nearest<double>(p.relative()).square;
    const double distance = std::sqrt(square.over / square.under);
    p.radius = std::min(most_radius(), std::max<std::int64_t>(0, std::llround(distance) + integer(-1, 1)));
    return p;
  }

  /// Whole vectors of whole length, in any order and with any signs.
  Vector whole_direction(std::int64_t& length) {
    static constexpr std::array<std::array<std::int64_t, 4>, 9> table = {{{0, 0, 1, 1},
                                                                          {0, 0, 1, 1},
                                                                          {0, 3, 4, 5},
                                                                          {1, 2, 2, 3},
                                                                          {2, 3, 6, 7},
                                                                          {1, 4, 8, 9},
                                                                          {4, 4, 7, 9},
                                                                          {2, 6, 9, 11},
                                                                          {3, 4, 12, 13}}};
    const auto& row = table[random_() % table.size()];
    length = row[3];
    const std::size_t first = random_() % 3;
    const bool mirror = chance(50);
    Vector u;
    for (std::size_t d = 0; d < 3; ++d) {
      const std::size_t at = mirror ? (first + 3 - d) % 3 : (first + d) % 3;
      u[at] = chance(50) ? row[d] : -row[d];
    }
    return u;
  }

  /// The distance is the radius exactly, by construction.
  PointTriangle touching() {
    for (;;) {
      std::int64_t length = 1;
      const Vector u = whole_direction(length);
      const std::int64_t times = chance(5) ? 0 : integer(0, most_radius() / length);
      const Vector any = {integer(-9, 9), integer(-9, 9), integer(-9, 9)};
      const Vector e = cross<std::int64_t>(u, any);  // both are perpendicular to u
      const Vector f = cross<std::int64_t>(u, e);
      PointTriangle p;
      p.radius = times * length;
      p.point = anyone();
      const auto at = [&](std::int64_t out, std::int64_t along, std::int64_t across) {
        Vector v;
        for (std::size_t d = 0; d < 3; ++d) v[d] = p.point[d] + out * u[d] + along * e[d] + across * f[d];
        return v;
      };
      const std::int64_t reach = 1 + most_ / 40;
      const auto some = [&] { return integer(0, std::max<std::int64_t>(1, reach / (length * length + 1))); };
      const std::int64_t beyond = times + integer(0, 3);
      switch (random_() % 3) {
        case 0:  // a vertex
          p.triangle = {at(times, 0, 0), at(beyond, some(), -some()), at(beyond + some(), -some(), some())};
          break;
        case 1:  // a side
          p.triangle = {at(times, -some(), 0), at(times, some(), 0), at(beyond, some() - some(), some() - some())};
          break;
        default:  // the face
          p.triangle = {at(times, -1 - some(), -1 - some()), at(times, 1 + some(), -1 - some()),
                        at(times, some() - some(), 1 + some())};
      }
      std::rotate(p.triangle.begin(), p.triangle.begin() + static_cast<int>(random_() % 3), p.triangle.end());
      if (chance(50)) std::swap(p.triangle[0], p.triangle[1]);
      if (fits(p)) return p;
    }
  }

  /// One step off.
  void step(PointTriangle& p) {
    PointTriangle moved = p;
    const std::int64_t by = chance(50) ? 1 : -1;
    const std::size_t d = random_() % 3;
    switch (random_() % 3) {
      case 0:
        moved.radius += by;
        break;
      case 1:
        moved.point[d] += by;
        break;
      default:
        moved.triangle[random_() % 3][d] += by;
    }
    if (fits(moved)) p = moved;
  }

  std::int64_t least_;
  std::int64_t most_;
  std::mt19937_64 random_;
};

}  // namespace cchip_test

#endif
