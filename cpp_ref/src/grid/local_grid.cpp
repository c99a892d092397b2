// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/grid/local_grid.hpp>
#include <cchip/internal/wire/definitions.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace cchip {
namespace {

/// Positions on the grid before the translation stay below this, so that sums of two fit into int64.
constexpr double position_limit = 4611686018427387904.0;  // 2^62

struct Range {
  double least;
  double greatest;
};

std::vector<Vec3d> all_vertices(const Primitive& a, const Primitive& b) {
  std::vector<Vec3d> points(a.v.begin(), a.v.begin() + static_cast<std::ptrdiff_t>(a.vertex_count()));
  points.insert(points.end(), b.v.begin(), b.v.begin() + static_cast<std::ptrdiff_t>(b.vertex_count()));
  return points;
}

Range range(const std::vector<Vec3d>& points, int axis) {
  const auto less = [axis](const Vec3d& p, const Vec3d& q) { return p[axis] < q[axis]; };
  const auto found = std::minmax_element(points.begin(), points.end(), less);
  return {(*found.first)[axis], (*found.second)[axis]};
}

void require_finite(const Primitive& p, char name) {
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    if (!p.v[i].allFinite()) {
      throw GridError(std::string("vertex ") + name + std::to_string(i) +
                      " is not finite: replace NaN and infinities by numbers");
    }
  }
}

/// Exponent of the lowest set bit of a finite number that is not zero.
int lowest_bit(double value) {
  int exponent = 0;
  constexpr int digits = std::numeric_limits<double>::digits;
  auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), digits));
  for (exponent -= digits; mantissa % 2 == 0; mantissa /= 2) ++exponent;
  return exponent;
}

/// Greatest exponent for which every coordinate is a whole multiple of the step; 0 if all are zero.
int common_lowest_bit(const std::vector<Vec3d>& points) {
  std::optional<int> lowest;
  for (const Vec3d& p : points) {
    for (const double c : p) {
      if (c != 0) lowest = std::min(lowest.value_or(std::numeric_limits<int>::max()), lowest_bit(c));
    }
  }
  return lowest.value_or(0);
}

/// Position rounded to nearest; an infinity if too far for a double. ldexp rounds only what becomes 0 here.
double to_steps(double coordinate, int exponent) { return std::nearbyint(std::ldexp(coordinate, -exponent)); }

/// True if the rounded box fits. The difference is exact where it matters: near the limit.
bool box_fits(const std::vector<Vec3d>& points, int exponent, int coord_w) {
  const double limit = std::ldexp(1.0, coord_w) - 1;
  for (int axis = 0; axis < 3; ++axis) {
    const Range r = range(points, axis);
    const bool fits = to_steps(r.greatest, exponent) - to_steps(r.least, exponent) <= limit;
    if (!fits) return false;  // also when positions overflow to infinities
  }
  return true;
}

bool positions_fit(const std::vector<Vec3d>& points, int exponent) {
  return std::all_of(points.begin(), points.end(), [exponent](const Vec3d& p) {
    return std::ldexp(p.cwiseAbs().maxCoeff(), -exponent) < position_limit;
  });
}

/// A step on which all coordinates are whole and the box fits: 1 if possible, else the greatest.
std::optional<int> exact_exponent(const std::vector<Vec3d>& points, int coord_w) {
  const int greatest = common_lowest_bit(points);
  for (const int exponent : {std::min(greatest, 0), greatest}) {
    if (positions_fit(points, exponent) && box_fits(points, exponent, coord_w)) return exponent;
  }
  return std::nullopt;
}

/// Smallest step on which the rounded box fits; nothing if the box has no extent.
std::optional<int> rounded_exponent(const std::vector<Vec3d>& points, int coord_w) {
  double extent = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Range r = range(points, axis);
    extent = std::max(extent, r.greatest - r.least);
  }
  if (extent == 0) return std::nullopt;
  // 2^k <= extent <= 2^(k+1), whichever way the difference was rounded: the box has over 2^W steps of
  // the first exponent tried and at most 2^(W-1) + 1 of the last.
  const int k = std::min(std::ilogb(extent), std::numeric_limits<double>::max_exponent);
  int exponent = k - coord_w - 1;
  while (exponent < k - coord_w + 2 && !box_fits(points, exponent, coord_w)) ++exponent;
  return exponent;
}

/// Translation that puts the middle of the range on 0, or none if the range is legal as it is.
std::int64_t origin_of(const Range& r, int exponent, bool keep_if_legal, int coord_w) {
  const auto least = static_cast<std::int64_t>(to_steps(r.least, exponent));
  const auto greatest = static_cast<std::int64_t>(to_steps(r.greatest, exponent));
  const std::int64_t half = std::int64_t{1} << (coord_w - 1);
  if (keep_if_legal && least >= -half && greatest < half) return 0;
  return least + (greatest - least + 1) / 2;
}

GridPrimitive place(const Primitive& p, const LocalGrid& grid) {
  GridPrimitive result;
  result.kind = p.kind;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto position = static_cast<std::int64_t>(to_steps(p.v[i][axis], grid.exponent));
      result.v[i][axis] = static_cast<std::int32_t>(position - grid.origin[static_cast<std::size_t>(axis)]);
    }
  }
  return result;
}

}  // namespace

QuantisedPair quantise(const Primitive& a, const Primitive& b, int coord_w) {
  if (coord_w < defs::coord_w_min || coord_w > defs::coord_w_max) {
    throw std::invalid_argument("quantise: coord_w " + std::to_string(coord_w) + " is not in 4..20");
  }
  require_finite(a, 'a');
  require_finite(b, 'b');
  const std::vector<Vec3d> points = all_vertices(a, b);
  const std::optional<int> exact = exact_exponent(points, coord_w);
  QuantisedPair result;
  const std::optional<int> exponent = exact ? exact : rounded_exponent(points, coord_w);
  if (!exponent || !positions_fit(points, *exponent)) {
    throw GridError(
        "the pair is too small for its distance from the origin (over 2^62 grid steps): "
        "move both primitives nearer to the origin or scale them");
  }
  result.grid.exponent = *exponent;
  for (int axis = 0; axis < 3; ++axis) {
    result.grid.origin[static_cast<std::size_t>(axis)] =
        origin_of(range(points, axis), result.grid.exponent, exact.has_value(), coord_w);
  }
  result.pair = {place(a, result.grid), place(b, result.grid), exact ? 0 : 1};
  return result;
}

}  // namespace cchip
