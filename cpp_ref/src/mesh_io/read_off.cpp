// SPDX-License-Identifier: Apache-2.0
// Geomview OFF as text: a vertex or a face on each line.
#include "polygon_soup.hpp"
#include "text.hpp"

namespace cchip::mesh_io {
namespace {

bool take(std::string_view& text, std::string_view prefix) {
  const bool there = text.substr(0, prefix.size()) == prefix;
  if (there) text.remove_prefix(prefix.size());
  return there;
}

/// Reads "OFF" with its prefixes. The values that they announce follow the coordinates and are ignored.
void check_keyword(std::string_view word, std::size_t line) {
  for (const char* const prefix : {"ST", "C", "N"}) take(word, prefix);
  if (take(word, "4") || take(word, "n")) throw FormatError("coordinates other than x, y, z are not read", line);
  if (word != "OFF") throw FormatError("the file does not begin with OFF", line);
}

}  // namespace

PolygonSoup read_off(std::string_view file) {
  PolygonSoup soup;
  Lines lines(file, {true, false});
  lines.require_next("its first word");
  check_keyword(lines.words()[0], lines.number());
  std::size_t first = 1;
  if (lines.words().size() == 1) {
    lines.require_next("the counts");
    first = 0;
  }
  if (lines.words()[first] == "BINARY") throw FormatError("binary OFF is not read", lines.number());
  if (lines.words().size() < first + 2)
    throw FormatError("the counts of vertices and faces are missing", lines.number());
  const std::size_t points = to_count(lines.words()[first], lines.number());
  const std::size_t polygons = to_count(lines.words()[first + 1], lines.number());
  while (soup.points.size() < points) {
    lines.require_next("vertex " + std::to_string(soup.points.size()) + " of " + std::to_string(points));
    soup.add_point({lines.to_number(0), lines.to_number(1), lines.to_number(2)}, lines.number());
  }
  while (soup.polygons.size() < polygons) {
    lines.require_next("face " + std::to_string(soup.polygons.size()) + " of " + std::to_string(polygons));
    const std::size_t corners = to_count(lines.words()[0], lines.number());
    for (std::size_t i = 1; i <= corners; ++i) soup.add_corner(lines.to_number(i), lines.number());
    soup.end_polygon(lines.number());
  }
  if (lines.next()) throw FormatError("the file continues after the last face that it announces", lines.number());
  return soup;
}

}  // namespace cchip::mesh_io
