// SPDX-License-Identifier: Apache-2.0
#include "polygon_soup.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace cchip::mesh_io {
namespace {

std::string to_text(double value) {
  std::array<char, 32> text{};
  return {text.begin(), std::to_chars(text.begin(), text.end(), value).ptr};
}

}  // namespace

void PolygonSoup::add_point(const Vec3d& point, std::size_t line) {
  if (!point.allFinite()) unusable[points.size()] = {"is not finite", line};
  points.push_back(point);
}

std::size_t round_to_single(std::vector<Vec3d>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (double& x : points[i]) {
      const bool finite = std::isfinite(x);
      if (finite && std::abs(x) > static_cast<double>(std::numeric_limits<float>::max())) return i;
      if (finite) x = static_cast<double>(static_cast<float>(x));
    }
  }
  return points.size();
}

void PolygonSoup::round_to_single() {
  const std::size_t bad = mesh_io::round_to_single(points);
  if (bad == points.size()) return;
  throw FormatError("vertex " + std::to_string(bad) +
                    " is beyond the range of single precision; leave out --single (single_precision)");
}

void PolygonSoup::add_corner(double index, std::size_t line) {
  const bool back = counting == Counting::from_1_or_back && index < 0;
  const double number = index + (back ? static_cast<double>(points.size()) : -static_cast<double>(first_index()));
  const bool whole = number == std::floor(number);
  if (whole && number >= 0 && number <= std::numeric_limits<std::uint32_t>::max()) {
    corners.push_back(static_cast<std::uint32_t>(number));
    return;
  }
  const std::string what = "face " + std::to_string(polygons.size()) + ": vertex index " + to_text(index);
  if (!whole) throw FormatError(what + " is not a whole number", line);
  corners.push_back(std::numeric_limits<std::uint32_t>::max());  // no mesh has so many vertices
  constexpr std::size_t most_bad = 1000;
  if (bad_polygons.size() == most_bad) return;
  bad_polygons.emplace(polygons.size(),
                       what + " is out of range (the mesh has " + std::to_string(points.size()) + " vertices so far)");
}

void PolygonSoup::end_polygon(std::size_t line) { polygons.push_back({corners.size(), line}); }

}  // namespace cchip::mesh_io
