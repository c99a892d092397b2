// SPDX-License-Identifier: Apache-2.0
/// \file
/// Poses from the command line and from files.
#ifndef CCHIP_APP_POSE_HPP
#define CCHIP_APP_POSE_HPP

#include <array>
#include <cchip/pose.hpp>
#include <cchip/primitive.hpp>
#include <cchip/program/csv_reader.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cchip::app {

/// "tx,ty,tz" or "tx,ty,tz,rx,ry,rz": rotation by rx, ry, rz degrees about the fixed axes x, then y,
/// then z, followed by the translation. Exact for multiples of 90 degrees.
/// \throws UsageError
Eigen::Isometry3d parse_pose(const std::string& text);

/// Twelve numbers, the rows of the 3x4 matrix [R | t], or sixteen with a last row of 0, 0, 0, 1.
/// \throws UsageError other numbers
Pose parse_affine_matrix(const std::string& text);
/// The same for a rigid pose.
/// \throws UsageError other numbers, or R is not a rotation within 1e-9
Eigen::Isometry3d parse_pose_matrix(const std::string& text);

/// "x,y,z", a vector that is not 0, the value of --along.
/// \throws UsageError
Vec3d parse_direction(const std::string& text);

/// The pose that one of the options --pose and --pose-matrix gives; the identity if both are empty.
/// \throws UsageError as parse_pose() and parse_affine_matrix()
Pose parse_pose_options(const std::string& pose, const std::string& pose_matrix);

/// Columns tx, ty, tz of a CSV file and, for the rotation, one of: r00..r22, a matrix row by row, any; rx, ry, rz,
/// degrees as parse_pose() takes them; roll, pitch, yaw, the same in radians; qx, qy, qz, qw, a quaternion of any
/// length; none. Quarter turns are exact: what is within rounding of them becomes them, but for a matrix.
class PoseColumns {
 public:
  /// Reads the header record. \param expect column with the expected answers; empty: none
  /// \throws UsageError a column is missing or occurs twice, or two rotations without a matrix are there
  PoseColumns(const CsvRow& header, std::string file, const std::string& expect);

  struct Row {
    Pose pose = Pose::Identity();
    std::vector<std::string> passed;
    std::optional<std::uint64_t> expected;
  };
  /// \throws UsageError the record is not a pose, or the expected answer is not a whole number
  Row parse(const CsvRow& row) const;
  /// Names of the columns that are passed through, in the order of the file.
  const std::vector<std::string>& passed_names() const { return passed_names_; }

 private:
  std::optional<std::size_t> find(const CsvRow& header, const std::string& name) const;

  std::string file_;
  std::size_t fields_;
  enum class Rotation { none, matrix, degrees, radians, quaternion };
  Rotation rotation_ = Rotation::none;
  std::vector<const char*> names_;  ///< of the columns of a pose
  std::vector<std::size_t> entry_;  ///< where they are
  std::optional<std::size_t> expect_;
  std::vector<std::size_t> passed_;
  std::vector<std::string> passed_names_;
};

}  // namespace cchip::app

#endif
