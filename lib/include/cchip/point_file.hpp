// SPDX-License-Identifier: Apache-2.0
/// \file
/// Files of points without faces, as scanners and depth cameras write them.
#ifndef CCHIP_POINT_FILE_HPP
#define CCHIP_POINT_FILE_HPP

#include <cchip/primitive.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cchip {

struct LoadPointsOptions {
  /// Points with a coordinate that is not finite are left out: sensors write NaN where they saw nothing. The points
  /// behind them move up, see `numbers`. If false, such a point is an error.
  bool leave_out_nan = true;
  /// If not null, set to the number of points that were left out.
  std::size_t* points_left_out = nullptr;
  /// If not null, set to the number in the file, from 0, of each point that is returned.
  std::vector<std::uint32_t>* numbers = nullptr;
  /// As LoadOptions::single_precision.
  bool single_precision = false;
  /// Bytes that the content of a packed file may have.
  std::uint64_t most_unpacked_bytes = std::uint64_t{1} << 32;
};

/// Reads points in the file's order and unit: the vertices of a Stanford PLY (text, binary of both byte orders; faces
/// may be there or not) or of an OBJ or OFF without faces, PCD (`DATA ascii`, `binary` and `binary_compressed`), and
/// text: XYZ, ASC, CSV, PTS, PTX (docs/cpp/points.md). The extension of the name decides the format, or else the
/// beginning of the file; what is no other format is read as text. A file packed with gzip is unpacked first, if the
/// library was built with zlib.
/// \throws std::runtime_error one line: file, line number if it has one, what is wrong, what to do
std::vector<Vec3d> load_points(const std::string& path, const LoadPointsOptions& options = {});

/// The same for the content of a file. `name` stands for its path.
std::vector<Vec3d> parse_points(std::string_view file, const std::string& name, const LoadPointsOptions& options = {});

}  // namespace cchip

#endif
