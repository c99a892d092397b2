// SPDX-License-Identifier: Apache-2.0
#include <cchip/point_file.hpp>
#include <stdexcept>
#include <utility>

#include "file_content.hpp"
#include "other_formats.hpp"
#include "polygon_soup.hpp"
#include "text.hpp"
#include "unpack.hpp"

namespace cchip {
namespace {

using mesh_io::FormatError;
using mesh_io::PolygonSoup;

/// OBJ and OFF hold points only if they have no faces.
PolygonSoup vertices_of(PolygonSoup soup, const std::string& format) {
  if (soup.polygons.empty()) return soup;
  throw FormatError("is a mesh (" + format + " with faces); name the file of points first and the mesh behind it");
}

PolygonSoup read_points(std::string_view file, const std::string& name) {
  if (const std::string why = mesh_io::not_read_by_content(file, name); !why.empty()) throw FormatError(why);
  if (const std::string why = mesh_io::no_points_by_name(name); !why.empty()) throw FormatError(why);
  const std::string end = mesh_io::extension_of(name);
  if (end == ".obj") return vertices_of(mesh_io::read_obj(file), "OBJ");
  if (end == ".off") return vertices_of(mesh_io::read_off(file), "OFF");
  if (end == ".ply" || file.substr(0, 4) == "ply\n" || file.substr(0, 4) == "ply\r") return mesh_io::read_ply(file);
  // A PCD begins with a comment, or with its version.
  if (end == ".pcd" || file.substr(0, 8) == "VERSION " || file.substr(0, 7) == "# .PCD ")
    return mesh_io::read_pcd(file);
  return mesh_io::read_xyz(file);
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
  if (options.single_precision) soup.round_to_single();
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
