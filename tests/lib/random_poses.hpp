// SPDX-License-Identifier: Apache-2.0
/// \file
/// Random poses, by class.
#ifndef CCHIP_TESTS_LIB_RANDOM_POSES_HPP
#define CCHIP_TESTS_LIB_RANDOM_POSES_HPP

#include <cchip/pose.hpp>
#include <cmath>
#include <random>

namespace cchip_test {

enum class PoseClass { rigid, quarter_turns, affine, mirror, shear, integers, small_scale, far_away, flat, point };
constexpr PoseClass pose_classes[] = {
    PoseClass::rigid,    PoseClass::quarter_turns, PoseClass::affine,   PoseClass::mirror, PoseClass::shear,
    PoseClass::integers, PoseClass::small_scale,   PoseClass::far_away, PoseClass::flat,   PoseClass::point};

inline bool is_invertible(PoseClass c) {
  return c != PoseClass::flat && c != PoseClass::point && c != PoseClass::integers;
}

/// Translations are up to `range` in each component.
inline cchip::Pose random_pose(PoseClass c, double range, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] {
    const double x = unit(random);
    const double y = unit(random);
    return Eigen::Vector3d(x, y, unit(random));
  };
  const Eigen::Vector3d angles = 180 * vector();
  cchip::Pose pose = cchip::Pose::Identity();
  pose.linear() = cchip::make_pose({0, 0, 0}, angles).linear();
  pose.translation() = range * vector();
  switch (c) {
    case PoseClass::rigid:
      break;
    case PoseClass::quarter_turns: {
      const Eigen::Vector3d turns = (2 * vector()).array().round();
      pose.linear() = cchip::make_pose({0, 0, 0}, 90 * turns).linear();
      break;
    }
    case PoseClass::affine:
      for (double& entry : pose.linear().reshaped()) entry = unit(random);
      break;
    case PoseClass::mirror:
      pose.linear().col(1) *= -1;
      break;
    case PoseClass::shear:
      pose.linear().col(1) += 3 * unit(random) * pose.linear().col(0);
      break;
    case PoseClass::integers:
      for (double& entry : pose.linear().reshaped()) entry = std::round(2 * unit(random));
      pose.translation() = pose.translation().array().round();
      break;
    case PoseClass::small_scale:
      pose.linear() *= 1e-3;
      break;
    case PoseClass::far_away:
      pose.translation() += Eigen::Vector3d(0x1p40, -0x1p40, 0x1p39);
      break;
    case PoseClass::flat: {
      const Eigen::Vector3d direction = vector();
      pose.linear() -= pose.linear() * direction * direction.transpose() / direction.squaredNorm();
      break;
    }
    case PoseClass::point:
      pose.linear().setZero();
      break;
  }
  return pose;
}

}  // namespace cchip_test

#endif
