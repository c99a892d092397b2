// SPDX-License-Identifier: Apache-2.0
#include "polygon_soup.hpp"

#include <cmath>
#include <limits>

namespace cchip::mesh_io {

void PolygonSoup::add_point(const Vec3d& point, std::size_t line) {
  if (!point.allFinite()) throw FormatError("vertex " + std::to_string(points.size()) + " is not finite", line);
  points.push_back(point);
}

void PolygonSoup::add_corner(double number, std::size_t line) {
  const bool fits = number >= 0 && number <= std::numeric_limits<std::uint32_t>::max() && number == std::floor(number);
  if (!fits) throw FormatError("face " + std::to_string(polygons.size()) + " names a vertex that cannot be", line);
  corners.push_back(static_cast<std::uint32_t>(number));
}

void PolygonSoup::end_polygon(std::size_t line) {
  const std::size_t begin = polygons.empty() ? 0 : polygons.back().end;
  if (corners.size() - begin < 3) {
    throw FormatError("face " + std::to_string(polygons.size()) + " has fewer than three corners", line);
  }
  polygons.push_back({corners.size(), line});
}

}  // namespace cchip::mesh_io
