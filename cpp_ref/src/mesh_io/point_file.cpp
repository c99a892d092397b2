// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/mesh_io/point_file.hpp>
#include <cctype>
#include <filesystem>
#include <stdexcept>

#include "file_content.hpp"
#include "polygon_soup.hpp"
#include "text.hpp"
#include "unpack.hpp"

namespace cchip {
namespace {

using mesh_io::FormatError;
using mesh_io::PolygonSoup;

PolygonSoup read_xyz(std::string_view file) {
  PolygonSoup soup;
  mesh_io::Lines lines(file, {true, false});
  while (lines.next())
    soup.add_point(Vec3d(lines.to_number(0), lines.to_number(1), lines.to_number(2)), lines.number());
  return soup;
}

PolygonSoup read_points(std::string_view file, const std::string& name) {
  std::string end = std::filesystem::path(name).extension().string();
  std::transform(end.begin(), end.end(), end.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* const other : {".las", ".laz", ".e57", ".obj", ".off", ".stl"}) {
    if (end == other) {
      throw FormatError(
          "points of this format are not read; write them as PLY, PCD or XYZ, for example with "
          "CloudCompare");
    }
  }
  if (end == ".ply" || file.substr(0, 4) == "ply\n" || file.substr(0, 4) == "ply\r") return mesh_io::read_ply(file);
  // A PCD begins with a comment, or with its version.
  if (end == ".pcd" || file.substr(0, 8) == "VERSION " || file.substr(0, 7) == "# .PCD ")
    return mesh_io::read_pcd(file);
  return read_xyz(file);
}

std::vector<Vec3d> usable_points(PolygonSoup soup, const LoadPointsOptions& options) {
  if (options.points_left_out != nullptr) *options.points_left_out = soup.unusable.size();
  if (options.numbers != nullptr) {
    options.numbers->clear();
    for (std::size_t i = 0; i < soup.points.size(); ++i) {
      if (soup.points[i].allFinite()) options.numbers->push_back(static_cast<std::uint32_t>(i));
    }
  }
  if (!soup.unusable.empty()) {
    if (!options.leave_out_nan) {
      const auto& [point, why] = *soup.unusable.begin();
      throw FormatError("point " + std::to_string(point) + " " + why.what, why.line);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < soup.points.size(); ++i) {
      if (soup.points[i].allFinite()) soup.points[kept++] = soup.points[i];
    }
    soup.points.resize(kept);
  }
  if (soup.points.empty()) throw FormatError("the file holds no points");
  return std::move(soup.points);
}

}  // namespace

std::vector<Vec3d> load_points(const std::string& path, const LoadPointsOptions& options) {
  return parse_points(mesh_io::read_file(path, "point"), path, options);
}

std::vector<Vec3d> parse_points(std::string_view file, const std::string& name, const LoadPointsOptions& options) {
  using namespace std::string_view_literals;
  try {
    std::string content;
    std::string inside = name;
    if (file.substr(0, 2) == "\x1f\x8b"sv) {
      if (!mesh_io::can_unpack_gzip()) throw FormatError("is packed with gzip; unpack it first");
      content = mesh_io::unpack_gzip(file, options.most_unpacked_bytes);
      file = content;
      inside = mesh_io::name_inside(name);
    }
    return usable_points(read_points(mesh_io::without_mark(file), inside), options);
  } catch (const FormatError& error) {
    const std::string line = error.line == 0 ? " " : std::to_string(error.line) + ": ";
    const bool tells_remedy = std::string_view(error.what()).find("; ") != std::string_view::npos;
    throw std::runtime_error(name + ":" + line + error.what() +
                             (tells_remedy ? "" : "; repair the file or write it again"));
  }
}

}  // namespace cchip
