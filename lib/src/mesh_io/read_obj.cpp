// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ, polygons only.
#include <algorithm>
#include <array>

#include "polygon_soup.hpp"
#include "text.hpp"

namespace cchip::mesh_io {
namespace {

/// Curves; their points are vertices that no face uses.
constexpr std::array<std::string_view, 14> of_curves = {"cstype", "deg",  "bmat", "step", "curv",  "curv2", "parm",
                                                        "trim",   "hole", "scrv", "sp",   "ctech", "stech", "con"};

/// Other statements that add no face: texture, normals, names, materials, display, points and lines.
constexpr std::array<std::string_view, 20> without_faces = {
    "vt",     "vn",     "vp",     "g",        "o",        "s",     "mg",  "l",          "p",         "usemtl",
    "mtllib", "usemap", "maplib", "c_interp", "d_interp", "bevel", "lod", "shadow_obj", "trace_obj", "end"};

void add_point(const Lines& lines, PolygonSoup& soup) {
  const std::size_t numbers = lines.words().size() - 1;
  // a fourth number alone is a weight, which only free-form surfaces have; with more behind it they are colours
  const bool weighted = numbers == 4 && lines.to_number(4) != 1;
  for (std::size_t i = 1; i <= numbers; ++i) lines.to_number(i);
  soup.add_point({lines.to_number(1), lines.to_number(2), lines.to_number(3)}, lines.number());
  if (weighted) soup.unusable[soup.points.size() - 1] = {"has a weight other than 1", lines.number()};
}

/// Surfaces of free form, also in words of older versions.
bool is_of_surfaces(std::string_view statement) {
  constexpr std::array<std::string_view, 6> words = {"surf", "bzp", "bsp", "cdp", "cdc", "res"};
  return std::find(words.begin(), words.end(), statement) != words.end();
}

[[noreturn]] void refuse_statement(const Lines& lines) {
  const std::string_view statement = lines.words()[0];
  const std::string word = quoted(statement);
  if (is_of_surfaces(statement)) {
    throw FormatError(word + " is a statement of free-form surfaces, which are not read; write the file as polygons",
                      lines.number());
  }
  FormatError error(word + " is no statement of OBJ", lines.number());
  error.remedy = "check the name of the file, or leave such lines out with --lenient (LoadOptions::lenient)";
  throw error;
}

/// The vertex index of "v", "v/vt", "v//vn" or "v/vt/vn".
double vertex_of(std::string_view corner, const Lines& lines) {
  const auto end = std::min(corner.find('/'), corner.size());
  const double number = to_number(corner.substr(0, end), lines.number());
  for (std::size_t begin = end; begin < corner.size();) {
    const auto next = std::min(corner.find('/', begin + 1), corner.size());
    if (next > begin + 1) to_number(corner.substr(begin + 1, next - begin - 1), lines.number());
    begin = next;
  }
  return number;
}

}  // namespace

PolygonSoup read_obj(std::string_view file, bool lenient) {
  PolygonSoup soup;
  soup.counting = PolygonSoup::Counting::from_1_or_back;
  Lines lines(file, {true, true});
  std::size_t curves = 0;
  std::size_t first_curve = 0;
  std::size_t unknown = 0;
  std::string first_unknown;
  while (lines.next()) {
    const std::string_view statement = lines.words()[0];
    if (statement == "v") {
      add_point(lines, soup);
    } else if (statement == "f" || statement == "fo") {
      for (std::size_t i = 1; i < lines.words().size(); ++i) {
        soup.add_corner(vertex_of(lines.words()[i], lines), lines.number());
      }
      if (lines.words().size() < 4) {
        throw FormatError("face " + std::to_string(soup.polygons.size()) + " has fewer than three corners",
                          lines.number());
      }
      soup.end_polygon(lines.number());
    } else if (std::find(of_curves.begin(), of_curves.end(), statement) != of_curves.end()) {
      const bool is_curve = statement == "curv" || statement == "curv2";
      if (is_curve && curves++ == 0) first_curve = lines.number();
    } else if (std::find(without_faces.begin(), without_faces.end(), statement) == without_faces.end()) {
      if (!lenient || is_of_surfaces(statement)) refuse_statement(lines);
      if (unknown++ == 0)
        first_unknown = "the first " + quoted(statement) + " in line " + std::to_string(lines.number());
    }
  }
  if (unknown > 0) {
    soup.notes.push_back(std::to_string(unknown) + " statements that are not of OBJ were left out, " + first_unknown);
  }
  if (curves > 0) {
    soup.notes.push_back(std::to_string(curves) + " curves were left out, the first in line " +
                         std::to_string(first_curve));
  }
  return soup;
}

}  // namespace cchip::mesh_io
