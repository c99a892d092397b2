// SPDX-License-Identifier: Apache-2.0
/// \file
/// What check.hpp computes with: the vertices of two meshes in their poses and the numbers of certificates, as
/// integers.
#ifndef CCHIP_INTERNAL_CERTIFICATE_EXACT_POINTS_HPP
#define CCHIP_INTERNAL_CERTIFICATE_EXACT_POINTS_HPP

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cchip/certificate.hpp>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace cchip::certificate_check {

using Int = boost::multiprecision::cpp_int;
using Point = std::array<Int, 3>;

inline void require(bool holds, const char* otherwise) {
  if (!holds) throw std::invalid_argument(otherwise);
}

/// A double as m 2^e with an odd m, or as 0 2^0.
struct Binary {
  std::int64_t m = 0;
  int e = 0;
};
inline Binary binary(double x) {
  require(std::isfinite(x), "a number of a mesh or a pose is not finite");
  Binary result;
  if (x == 0) return result;
  result.m = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &result.e), 53));
  for (result.e -= 53; result.m % 2 == 0; ++result.e) result.m /= 2;
  return result;
}

/// Doubles as integers times the same power of two.
class Scale {
 public:
  void add(double x) {
    const Binary b = binary(x);
    if (b.m != 0 && (!any_ || b.e < least_)) {
      least_ = b.e;
      any_ = true;
    }
  }
  /// The exponent: 2^exponent() divides all that were added.
  int exponent() const { return least_; }
  Int whole(double x) const {
    const Binary b = binary(x);
    if (b.m == 0) return 0;
    return Int(b.m) << (b.e - least_);
  }

 private:
  int least_ = 0;
  bool any_ = false;
};

/// The point times a power of two.
inline Point whole_point(const Vec3d& p) {
  Scale scale;
  for (int i = 0; i < 3; ++i) scale.add(p[i]);
  return {scale.whole(p[0]), scale.whole(p[1]), scale.whole(p[2])};
}

struct Placed {
  std::array<std::vector<Point>, 2> points;
  Int length = 0;
};
/// The vertices of the faces of both meshes in their poses and a length, all multiplied by the same power of two;
/// exact.
inline Placed place(const std::array<const Mesh*, 2>& mesh, const std::array<const Pose*, 2>& pose, double length = 0) {
  std::array<std::vector<bool>, 2> used;
  Scale coordinate, entry, shift;
  for (const std::size_t side : {0U, 1U}) {
    used[side].resize(mesh[side]->vertices.size());
    for (const Mesh::Face& face : mesh[side]->faces) {
      require(face.kind == Kind::tri || face.kind == Kind::quad, "a face is neither triangle nor quad");
      for (std::size_t k = 0; k < static_cast<std::size_t>(face.kind); ++k) {
        require(face.vertex[k] < used[side].size(), "a face has a vertex that does not exist");
        used[side][face.vertex[k]] = true;
      }
    }
    for (std::size_t v = 0; v < used[side].size(); ++v) {
      for (int i = 0; used[side][v] && i < 3; ++i) coordinate.add(mesh[side]->vertices[v][i]);
    }
    for (int row = 0; row < 3; ++row) {
      for (int i = 0; i < 3; ++i) entry.add((*pose[side])(row, i));
      shift.add((*pose[side])(row, 3));
    }
  }
  shift.add(length);
  // Products are multiples of 2^of_products, translations of 2^shift.exponent(); all are made such of the lesser one.
  const int of_products = coordinate.exponent() + entry.exponent();
  const unsigned to_products = static_cast<unsigned>(std::max(0, of_products - shift.exponent()));
  const unsigned to_shift = static_cast<unsigned>(std::max(0, shift.exponent() - of_products));
  Placed result;
  result.length = shift.whole(length) << to_shift;
  std::array<std::vector<Point>, 2>& points = result.points;
  for (const std::size_t side : {0U, 1U}) {
    std::array<std::array<Int, 4>, 3> map;
    for (std::size_t row = 0; row < 3; ++row) {
      const auto at = [&](int column) { return (*pose[side])(static_cast<int>(row), column); };
      for (int i = 0; i < 3; ++i) map[row][static_cast<std::size_t>(i)] = entry.whole(at(i)) << to_products;
      map[row][3] = shift.whole(at(3)) << to_shift;
    }
    points[side].resize(used[side].size());
    for (std::size_t v = 0; v < used[side].size(); ++v) {
      if (!used[side][v]) continue;
      std::array<Int, 3> x;
      for (int i = 0; i < 3; ++i) x[static_cast<std::size_t>(i)] = coordinate.whole(mesh[side]->vertices[v][i]);
      for (std::size_t row = 0; row < 3; ++row) {
        Int& sum = points[side][v][row];
        sum = map[row][3];
        for (std::size_t i = 0; i < 3; ++i) sum += map[row][i] * x[i];
      }
    }
  }
  return result;
}

/// Reads integers of a certificate.
inline std::vector<Int> integers(const std::vector<Digits>& texts, std::size_t count) {
  require(texts.size() == count, "wrong number of weights or components");
  std::vector<Int> result;
  for (const Digits& text : texts) {
    require(is_integer(text), "not an integer of at most 20000 digits");
    result.emplace_back(text);
  }
  return result;
}

inline Int dot(const std::vector<Int>& d, const Point& p) { return d[0] * p[0] + d[1] * p[1] + d[2] * p[2]; }

}  // namespace cchip::certificate_check

#endif
