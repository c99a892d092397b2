// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/image/place.hpp>
#include <cchip/internal/tree/dop26.hpp>
#include <cmath>

#include "tree/rounding.hpp"

namespace cchip::bvh {
namespace {

using Vector = std::array<Interval, 3>;
using Matrix = std::array<Vector, 3>;

Interval dot(const Vector& x, const Vector& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }

Vector cross(const Vector& x, const Vector& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}

Vector column(const Pose& pose, Eigen::Index i) { return {pose(0, i), pose(1, i), pose(2, i)}; }

/// u -> linear u + offset
struct Map {
  Matrix linear;
  Vector offset;
  bool is_finite() const {
    bool finite = true;
    for (std::size_t i = 0; i < 3; ++i) {
      finite = finite && offset[i].is_finite();
      for (const Interval& x : linear[i]) finite = finite && x.is_finite();
    }
    return finite;
  }
};

/// From the frame of image A to that of image B: B's own map undone behind A's. With poses P x + p, centres c and
/// exponents e: 2^-eB (PB^-1 (PA (cA + 2^eA u) + pA - pB) - cB).
std::optional<Map> map_between(const HeaderLine& a, const Pose& pose_a, const HeaderLine& b, const Pose& pose_b) {
  // Rows of the inverse of PB are cross products of its columns over the determinant.
  const Vector x = column(pose_b, 0);
  const Vector y = column(pose_b, 1);
  const Vector z = column(pose_b, 2);
  const Matrix adjugate = {cross(y, z), cross(z, x), cross(x, y)};
  const Interval determinant = dot(x, adjugate[0]);
  if (!determinant.is_finite() || (determinant.least <= 0 && determinant.greatest >= 0)) return std::nullopt;
  Vector between;  // PA cA + pA - pB
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Vector row = {pose_a(i, 0), pose_a(i, 1), pose_a(i, 2)};
    between[static_cast<std::size_t>(i)] =
        dot(row, {a.centre.x(), a.centre.y(), a.centre.z()}) + (Interval(pose_a(i, 3)) - Interval(pose_b(i, 3)));
  }
  Map map;
  for (std::size_t i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      map.linear[i][static_cast<std::size_t>(j)] =
          scale(dot(adjugate[i], column(pose_a, j)) / determinant, a.exponent - b.exponent);
    }
    const Interval centre = b.centre[static_cast<Eigen::Index>(i)];
    map.offset[i] = scale(dot(adjugate[i], between) / determinant - centre, -b.exponent);
  }
  return map.is_finite() ? std::optional<Map>(map) : std::nullopt;
}

/// Nearest multiple of 2^-fraction.
double nearest(const Interval& x, int fraction) {
  return std::nearbyint(std::ldexp(x.least / 2 + x.greatest / 2, fraction));
}
/// Bound on the distance of value 2^-fraction from any member.
double distance(const Interval& x, double value, int fraction) {
  const double at = std::ldexp(value, -fraction);
  return std::max({0.0, sum_up(x.greatest, -at), sum_up(at, -x.least)});
}

/// True if the formats of the box test hold M (17 fraction bits there): with m = M^T d for each direction d,
/// |m_j| < 2 and the two smaller |m_j| together at most 2 and a little, and rows with sums of magnitudes < 2, so that
/// offsets fit. Every rotation passes.
bool fits_box_test(const std::array<std::array<std::int32_t, 3>, 3>& m30) {
  constexpr std::int64_t one = std::int64_t{1} << query_m_fraction;
  for (const auto& row : m30) {
    std::int64_t sum = 0;
    for (const std::int64_t x : row) {
      if (std::abs(x) > one) return false;
      sum += std::abs(x);
    }
    if (sum >= 2 * one - one / 1024) return false;
  }
  for (const auto& d : directions) {
    std::array<std::int64_t, 3> m = {};
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t i = 0; i < 3; ++i) m[j] += d[i] * std::int64_t{m30[i][j]};
      m[j] = std::abs(m[j]);
    }
    std::sort(m.begin(), m.end());
    if (m[2] >= 2 * one - one / 256 || m[0] + m[1] > 2 * one + one / 32) return false;
  }
  return true;
}

/// Query with a finer or equal unit in the role of A.
std::optional<Query> make_ordered(const HeaderLine& a, const Pose& pose_a, const HeaderLine& b, const Pose& pose_b) {
  const std::optional<Map> map = map_between(a, pose_a, b, pose_b);
  if (!map) return std::nullopt;
  double greatest = 0;
  for (const Vector& row : map->linear) {
    for (const Interval& x : row) greatest = std::max({greatest, std::abs(x.least), std::abs(x.greatest)});
  }
  // The greatest shift at which M 2^-shift with |M_ij| <= 1 represents the linear part, less if M does not fit
  // otherwise. If the greatest |M_ij| is below one half, M loses a bit: this much is allowed at the limit of shift, not
  // more.
  if (greatest < std::ldexp(0.5, -query_shift_max)) return std::nullopt;
  Query query;
  query.shift = std::min(query_shift_max, -std::ilogb(greatest));
  const auto fill = [&] {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const double value = nearest(map->linear[i][j], query_m_fraction + query.shift);
        if (std::abs(value) > 0x1p30) return false;
        query.m[i][j] = static_cast<std::int32_t>(value);
      }
    }
    return fits_box_test(query.m);
  };
  while (query.shift >= 0 && !fill()) --query.shift;
  if (query.shift < 0) return std::nullopt;
  double error = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    double row = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      row = sum_up(row, distance(map->linear[i][j], query.m[i][j], query_m_fraction + query.shift));
    }
    row /= 2;  // |u_j| <= 1/2
    double offset = nearest(map->offset[i], query_t_fraction);
    if (std::abs(offset) > 0x1p34) {
      // |M 2^-shift u| < 1, so A cannot reach B from this far away. Any |t_i| >= 4 says so to the chip.
      offset = std::copysign(0x1p34, offset);
    } else {
      row = sum_up(row, distance(map->offset[i], offset, query_t_fraction));
    }
    query.t[i] = static_cast<std::int64_t>(offset);
    error = std::max(error, row);
  }
  const double bound = std::ceil(std::ldexp(error, query_error_fraction));
  if (!(bound < std::ldexp(1.0, static_cast<int>(query_field::error.width)))) return std::nullopt;
  query.error = static_cast<std::uint32_t>(bound);
  return query;
}

}  // namespace

std::optional<Query> make_query(const HeaderLine& a, const Pose& pose_a, const HeaderLine& b, const Pose& pose_b) {
  std::optional<Query> query = make_ordered(a, pose_a, b, pose_b);
  if (query) return query;
  query = make_ordered(b, pose_b, a, pose_a);
  if (query) query->swapped = true;
  return query;
}

}  // namespace cchip::bvh
