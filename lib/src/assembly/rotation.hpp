// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rotations of quaternions.
#ifndef CCHIP_ASSEMBLY_ROTATION_HPP
#define CCHIP_ASSEMBLY_ROTATION_HPP

#include <Eigen/Core>
#include <array>
#include <optional>

namespace cchip::assembly {

/// In the homogeneous form, so that quarter turns and thirds are exact although the quaternion is rounded.
/// \param q x, y, z, w, of any length
/// \returns nothing if the length is 0, infinite or close to either
inline std::optional<Eigen::Matrix3d> rotation_of(const std::array<double, 4>& q) {
  const auto [x, y, z, w] = q;
  const double xx = x * x;
  const double yy = y * y;
  const double zz = z * z;
  const double ww = w * w;
  const double square = (xx + yy) + (zz + ww);
  if (!(square > 0x1p-500 && square < 0x1p500)) return std::nullopt;
  Eigen::Matrix3d r;
  r << (ww - zz) + (xx - yy), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
      2 * (x * y + w * z), (ww - zz) + (yy - xx), 2 * (y * z - w * x),   //
      2 * (x * z - w * y), 2 * (y * z + w * x), (ww - xx) + (zz - yy);
  return Eigen::Matrix3d(r / square);
}

}  // namespace cchip::assembly

#endif
