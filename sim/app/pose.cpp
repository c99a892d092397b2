// SPDX-License-Identifier: Apache-2.0
#include "pose.hpp"

#include <fmt/format.h>

#include <cchip/geometry/pose.hpp>
#include <cchip/stimulus/pair_columns.hpp>
#include <cchip/stimulus/usage_error.hpp>
#include <string_view>
#include <vector>

namespace cchip::app {
namespace {

std::vector<double> parse_numbers(const std::string& option, std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    const auto comma = text.find(',');
    try {
      numbers.push_back(parse_coordinate(text.substr(0, comma)));
    } catch (const std::invalid_argument& error) {
      throw UsageError(fmt::format("{}: number {}: {}", option, numbers.size() + 1, error.what()));
    }
    if (comma == std::string_view::npos) return numbers;
    text.remove_prefix(comma + 1);
  }
}

}  // namespace

Eigen::Isometry3d parse_pose(const std::string& text) {
  const std::vector<double> n = parse_numbers("--pose", text);
  if (n.size() == 3) return make_pose({n[0], n[1], n[2]}, {0, 0, 0});
  if (n.size() == 6) return make_pose({n[0], n[1], n[2]}, {n[3], n[4], n[5]});
  throw UsageError(fmt::format("--pose: got {} numbers; write tx,ty,tz or tx,ty,tz,rx,ry,rz", n.size()));
}

Eigen::Isometry3d parse_pose_matrix(const std::string& text) {
  const std::vector<double> n = parse_numbers("--pose-matrix", text);
  if (n.size() != 12) {
    throw UsageError(
        fmt::format("--pose-matrix: got {} numbers; write the twelve of the 3x4 matrix row by row", n.size()));
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  auto next = n.begin();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) pose(row, column) = *next++;
  }
  const Eigen::Matrix3d r = pose.linear();
  const double error = (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(error <= 1e-9) || r.determinant() <= 0) {
    throw UsageError(
        "--pose-matrix: the left 3x3 part is not a rotation; write an orthonormal matrix with determinant 1 (to 1e-9)");
  }
  return pose;
}

}  // namespace cchip::app
