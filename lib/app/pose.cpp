// SPDX-License-Identifier: Apache-2.0
#include "pose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cchip/internal/geometry/quarter_turns.hpp>
#include <cchip/internal/geometry/rotation.hpp>
#include <cchip/pose.hpp>
#include <cchip/program/usage_error.hpp>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace cchip::app {
namespace {

/// Columns of rotations, in the order of PoseColumns::Rotation.
const std::array<std::vector<const char*>, 5> rotation_columns = {
    {{},
     {"r00", "r01", "r02", "r10", "r11", "r12", "r20", "r21", "r22"},
     {"rx", "ry", "rz"},
     {"roll", "pitch", "yaw"},
     {"qx", "qy", "qz", "qw"}}};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::vector<double> parse_numbers(const std::string& option, std::string_view text) {
  if (text.find(',') == std::string_view::npos && trimmed(text).find_first_of(" \t;") != std::string_view::npos) {
    throw UsageError(
        fmt::format("{}: '{}' has no commas; write commas between the numbers, like 0.5,0,0", option, text));
  }
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

Vec3d parse_direction(const std::string& text) {
  const std::vector<double> n = parse_numbers("--along", text);
  if (n.size() != 3) throw UsageError(fmt::format("--along: got {} numbers; write x,y,z", n.size()));
  const Vec3d direction(n[0], n[1], n[2]);
  if (direction == Vec3d::Zero()) throw UsageError("--along: the direction is 0; write another vector, like 0,0,1");
  return direction;
}

Pose parse_affine_matrix(const std::string& text) {
  const std::vector<double> n = parse_numbers("--pose-matrix", text);
  if (n.size() != 12 && n.size() != 16) {
    throw UsageError(fmt::format(
        "--pose-matrix: got {} numbers; write the twelve of the 3x4 matrix row by row, or the sixteen of a 4x4 matrix",
        n.size()));
  }
  if (n.size() == 16 && (n[12] != 0 || n[13] != 0 || n[14] != 0 || n[15] != 1)) {
    throw UsageError(fmt::format(
        "--pose-matrix: the last row of the 4x4 matrix is {},{},{},{}, but must be 0,0,0,1; write the numbers row by "
        "row (transpose a matrix that is written column by column)",
        n[12], n[13], n[14], n[15]));
  }
  Pose pose = Pose::Identity();
  auto next = n.begin();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) pose(row, column) = *next++;
  }
  return pose;
}

Eigen::Isometry3d parse_pose_matrix(const std::string& text) {
  const Pose pose = parse_affine_matrix(text);
  const Eigen::Matrix3d r = pose.linear();
  const double error = (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(error <= 1e-9) || r.determinant() <= 0) {
    throw UsageError(
        "--pose-matrix: the left 3x3 part is not a rotation; write an orthonormal matrix with determinant 1 (to 1e-9)");
  }
  return Eigen::Isometry3d(pose.matrix());
}

Pose parse_pose_options(const std::string& pose, const std::string& pose_matrix) {
  if (!pose_matrix.empty()) return parse_affine_matrix(pose_matrix);
  if (!pose.empty()) return Pose(parse_pose(pose));
  return Pose::Identity();
}

PoseColumns::PoseColumns(const CsvRow& header, std::string file, const std::string& expect)
    : file_(std::move(file)), fields_(header.fields.size()) {
  for (std::size_t kind = 1; kind < rotation_columns.size(); ++kind) {
    const std::vector<const char*>& names = rotation_columns[kind];
    if (std::none_of(names.begin(), names.end(), [&](const char* name) { return find(header, name).has_value(); }))
      continue;
    if (rotation_ == Rotation::matrix) break;  // beside it other columns are passed through
    if (rotation_ != Rotation::none) {
      throw row_error(file_, header.line,
                      fmt::format("columns {} and {} are there; keep those of one rotation, and rename the others",
                                  names_[0], names[0]));
    }
    rotation_ = static_cast<Rotation>(kind);
    names_ = names;
  }
  for (const char* const name : {"tx", "ty", "tz"}) names_.push_back(name);
  for (const char* const name : names_) {
    const auto column = find(header, name);
    if (!column) {
      throw missing_column(file_, header, name,
                           "the first row must name the columns tx,ty,tz and, for a rotation, r00,r01,r02 to r22 or "
                           "rx,ry,rz or roll,pitch,yaw or qx,qy,qz,qw");
    }
    entry_.push_back(*column);
  }
  if (!expect.empty()) {
    expect_ = find(header, expect);
    if (!expect_) {
      throw row_error(file_, header.line,
                      fmt::format("column {} of --expect is missing; name a column of the file", expect));
    }
  }
  for (std::size_t i = 0; i < fields_; ++i) {
    if (std::find(entry_.begin(), entry_.end(), i) != entry_.end()) continue;
    passed_.push_back(i);
    passed_names_.push_back(header.fields[i]);
  }
}

std::optional<std::size_t> PoseColumns::find(const CsvRow& header, const std::string& name) const {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    if (trimmed(header.fields[i]) != name) continue;
    if (found) {
      throw row_error(file_, header.line, fmt::format("column {} is there twice; rename or remove one of them", name));
    }
    found = i;
  }
  return found;
}

PoseColumns::Row PoseColumns::parse(const CsvRow& row) const {
  if (row.fields.size() != fields_) {
    throw row_error(file_, row.line,
                    fmt::format("the row has {} fields, but the header names {} columns; write one field per column",
                                row.fields.size(), fields_));
  }
  Row result;
  std::array<double, 12> n = {};
  for (std::size_t i = 0; i < entry_.size(); ++i) {
    try {
      n[i] = parse_coordinate(row.fields[entry_[i]]);
    } catch (const std::invalid_argument& error) {
      throw row_error(file_, row.line, fmt::format("column {}: {}", names_[i], error.what()));
    }
  }
  switch (rotation_) {
    case Rotation::none:
      break;
    case Rotation::matrix:
      result.pose.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(n.data());
      break;
    case Rotation::degrees:
      result.pose.linear() = make_pose(Vec3d::Zero(), {n[0], n[1], n[2]}).linear();
      break;
    case Rotation::radians:
      result.pose.linear() =
          snapped(make_pose(Vec3d::Zero(), {to_degrees(n[0]), to_degrees(n[1]), to_degrees(n[2])}).linear());
      break;
    case Rotation::quaternion: {
      const std::optional<Eigen::Matrix3d> rotation = rotation_of({n[0], n[1], n[2], n[3]});
      if (!rotation) {
        throw row_error(file_, row.line, "columns qx to qw: the quaternion is 0; write one that is not, of any length");
      }
      result.pose.linear() = snapped(*rotation);
    } break;
  }
  result.pose.translation() = Eigen::Map<const Vec3d>(n.data() + entry_.size() - 3);
  for (const std::size_t i : passed_) result.passed.push_back(row.fields[i]);
  if (expect_) {
    const std::string_view text = trimmed(row.fields[*expect_]);
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
      throw row_error(file_, row.line,
                      "the expected answer is not a whole number; write 0 or 1, or a count of contacts");
    }
    result.expected = value;
  }
  return result;
}

}  // namespace cchip::app
