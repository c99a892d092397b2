// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the readers of the formats hand over: points and polygons as the file lists them.
#ifndef CCHIP_MESH_IO_POLYGON_SOUP_HPP
#define CCHIP_MESH_IO_POLYGON_SOUP_HPP

#include <cchip/primitive.hpp>
#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace cchip::mesh_io {

/// A file that cannot be read: what is wrong, and the line if the format has lines.
class FormatError : public std::runtime_error {
 public:
  explicit FormatError(const std::string& what, std::size_t line_number = 0)
      : std::runtime_error(what), line(line_number) {}
  std::size_t line;         ///< counted from 1; 0: none
  std::string_view remedy;  ///< what to do, if the message does not say it and no other format shows
};

/// Rounds points to single precision; the number of the first one with a finite coordinate beyond its range, or else
/// the count of points.
std::size_t round_to_single(std::vector<Vec3d>& points);

struct PolygonSoup {
  /// How the file counts vertices: from 0, or from 1 with negative numbers that count back from the last one so far.
  enum class Counting { from_0, from_1_or_back } counting = Counting::from_0;
  std::vector<Vec3d> points;
  std::vector<std::uint32_t> corners;  ///< numbers of points, of all polygons one after the other
  struct Polygon {
    std::size_t end;   ///< behind its last corner in `corners`
    std::size_t line;  ///< of the file; 0: binary file
  };
  std::vector<Polygon> polygons;
  /// Points that no face may use: what is wrong with them, and where.
  struct Unusable {
    std::string what;
    std::size_t line;
  };
  std::map<std::size_t, Unusable> unusable;
  /// What is wrong with the corners of polygons, by their number; only the first of many.
  std::map<std::size_t, std::string> bad_polygons;
  std::vector<std::string> notes;  ///< what was left out

  /// A point that is not finite is unusable.
  void add_point(const Vec3d& point, std::size_t line);
  /// Rounds the points to single precision. \throws FormatError a finite coordinate is beyond its range
  void round_to_single();
  /// If the index leads to a number below 0 or beyond 32 bits, the polygon is bad. \param index as the file counts
  /// \throws FormatError it is no whole number
  void add_corner(double index, std::size_t line);
  /// Index of the first vertex, as the file counts.
  std::uint64_t first_index() const { return counting == Counting::from_0 ? 0 : 1; }
  /// Makes one polygon of the corners since the last polygon. With fewer than three it is a point or a line, which is
  /// no face but keeps its number.
  void end_polygon(std::size_t line);
};

// The readers take the whole file. Regardless of the counts the file announces, they keep only what they have read, so
// time and memory are at most proportional to its size. \throws FormatError the text is not of the format, or ends too
// early

/// \param lenient statements that are not of OBJ are left out with a note; otherwise they are an error
PolygonSoup read_obj(std::string_view file, bool lenient = false);
PolygonSoup read_off(std::string_view file);
PolygonSoup read_pcd(std::string_view file);
PolygonSoup read_ply(std::string_view file);
PolygonSoup read_stl(std::string_view file);
PolygonSoup read_xyz(std::string_view file);

/// True for OFF with any of its prefixes, and if the first count follows without a blank.
bool is_off_keyword(std::string_view word);

/// True if the header of a binary STL would announce the size of this file.
bool is_binary_stl(std::string_view file);

}  // namespace cchip::mesh_io

#endif
