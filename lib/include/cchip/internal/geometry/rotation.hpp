// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rotations of quaternions.
#ifndef CCHIP_INTERNAL_GEOMETRY_ROTATION_HPP
#define CCHIP_INTERNAL_GEOMETRY_ROTATION_HPP

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace cchip {

/// In the homogeneous form, divided by the square of the length at the end, so that quarter turns and thirds are exact
/// although the quaternion is rounded.
/// \param q x, y, z, w, of any length
/// \returns nothing if the length is 0 or not finite
inline std::optional<Eigen::Matrix3d> rotation_of(std::array<double, 4> q) {
  double greatest = 0;
  for (const double part : q) {
    if (!std::isfinite(part)) return std::nullopt;
    greatest = std::max(greatest, std::abs(part));
  }
  if (greatest == 0) return std::nullopt;
  int exponent = 0;
  std::frexp(greatest, &exponent);
  for (double& part : q) part = std::ldexp(part, -exponent);  // no square over- or underflows
  const auto [x, y, z, w] = q;
  const double xx = x * x;
  const double yy = y * y;
  const double zz = z * z;
  const double ww = w * w;
  Eigen::Matrix3d r;
  r << (ww - zz) + (xx - yy), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
      2 * (x * y + w * z), (ww - zz) + (yy - xx), 2 * (y * z - w * x),   //
      2 * (x * z - w * y), 2 * (y * z + w * x), (ww - xx) + (zz - yy);
  return Eigen::Matrix3d(r / ((xx + yy) + (zz + ww)));
}

}  // namespace cchip

#endif
