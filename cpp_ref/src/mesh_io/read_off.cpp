// SPDX-License-Identifier: Apache-2.0
// Geomview OFF as text: a vertex or a face on each line, or numbers in lines of any length.
#include <algorithm>
#include <optional>

#include "polygon_soup.hpp"
#include "text.hpp"

namespace cchip::mesh_io {
namespace {

bool take(std::string_view& text, std::string_view prefix) {
  const bool there = text.substr(0, prefix.size()) == prefix;
  if (there) text.remove_prefix(prefix.size());
  return there;
}

bool is_digits(std::string_view text) { return text.find_first_not_of("0123456789") == std::string_view::npos; }

/// What the first word says.
struct Keyword {
  std::size_t normal = 0;   ///< numbers of a normal behind each vertex
  std::size_t texture = 0;  ///< and of a place in a texture
  bool colour = false;      ///< and a colour of three or four numbers
  bool other_space = false;
  std::string_view rest;  ///< the first count, if no blank is between
};

/// Nothing if the word is not OFF with some of its prefixes.
std::optional<Keyword> to_keyword(std::string_view word) {
  Keyword keyword;
  while (!word.empty() && word.substr(0, 3) != "OFF") {
    if (take(word, "ST")) {
      keyword.texture = 2;
    } else if (take(word, "C")) {
      keyword.colour = true;
    } else if (take(word, "N")) {
      keyword.normal = 3;
    } else if (take(word, "4") || take(word, "n")) {
      keyword.other_space = true;
    } else {
      return {};
    }
  }
  if (!take(word, "OFF") || !is_digits(word)) return {};
  keyword.rest = word;
  return keyword;
}

struct Header {
  Keyword keyword;
  std::size_t points = 0;
  std::size_t polygons = 0;
};

/// Reads to the end of the line on which the counts end.
Header read_header(Lines& lines) {
  lines.require_next("its first word");
  Header header;
  std::vector<std::string_view> words = lines.words();
  std::size_t line = lines.number();
  if (const auto keyword = to_keyword(words[0])) {
    header.keyword = *keyword;
    if (keyword->other_space) throw FormatError("coordinates other than x, y, z are not read", line);
    if (keyword->rest.empty()) {
      words.erase(words.begin());
    } else {
      words[0] = keyword->rest;
    }
    if (words.empty()) {
      lines.require_next("the counts");
      words = lines.words();
      line = lines.number();
    }
    if (words[0] == "BINARY") throw FormatError("binary OFF is not read", line);
  } else if (!is_digits(words[0])) {  // some files begin with the counts
    throw FormatError("the file does not begin with OFF", line);
  }
  if (words.size() == 1 && lines.next()) words.insert(words.end(), lines.words().begin(), lines.words().end());
  if (words.size() < 2) throw FormatError("the counts of vertices and faces are missing", line);
  header.points = to_count(words[0], line);
  header.polygons = to_count(words[1], line);
  Lines ahead = lines;
  // the count of edges, which means nothing, may be missing or follow in a line of its own
  if (words.size() == 2 && ahead.next() && ahead.words().size() == 1) lines = ahead;
  return header;
}

PolygonSoup read_by_lines(Lines lines, const Header& header) {
  PolygonSoup soup;
  while (soup.points.size() < header.points) {
    lines.require_next("vertex " + std::to_string(soup.points.size()) + " of " + std::to_string(header.points));
    soup.add_point({lines.to_number(0), lines.to_number(1), lines.to_number(2)}, lines.number());
  }
  while (soup.polygons.size() < header.polygons) {
    lines.require_next("face " + std::to_string(soup.polygons.size()) + " of " + std::to_string(header.polygons));
    const std::size_t corners = to_count(lines.words()[0], lines.number());
    for (std::size_t i = 1; i <= corners; ++i) soup.add_corner(lines.to_number(i), lines.number());
    soup.end_polygon(lines.number());
  }
  if (lines.next()) throw FormatError("the file continues after the last face that it announces", lines.number());
  return soup;
}

/// Each vertex has so many numbers, wherever lines end; behind a face its colour ends the line, or there are no
/// colours. \throws FormatError the numbers do not end with the last face
PolygonSoup read_by_numbers(Lines lines, const Header& header, std::size_t numbers, bool face_colours) {
  PolygonSoup soup;
  std::size_t at = 0;
  bool begun = false;
  const auto next = [&] {
    if (!begun || at == lines.words().size()) {
      lines.require_next("the last face");
      begun = true;
      at = 0;
    }
    return lines.words()[at++];
  };
  while (soup.points.size() < header.points) {
    Vec3d point;
    for (std::size_t i = 0; i < numbers; ++i) {
      const double value = to_number(next(), lines.number());
      if (i < 3) point[static_cast<Eigen::Index>(i)] = value;
    }
    soup.add_point(point, lines.number());
  }
  while (soup.polygons.size() < header.polygons) {
    const std::size_t corners = to_count(next(), lines.number());
    for (std::size_t i = 0; i < corners; ++i) soup.add_corner(to_number(next(), lines.number()), lines.number());
    soup.end_polygon(lines.number());
    if (face_colours) at = lines.words().size();
  }
  if (at < lines.words().size() || lines.next()) throw FormatError("the file continues", lines.number());
  return soup;
}

}  // namespace

bool is_off_keyword(std::string_view word) { return to_keyword(word).has_value(); }

PolygonSoup read_off(std::string_view file) {
  Lines lines(file, {true, false});
  const Header header = read_header(lines);
  try {
    return read_by_lines(lines, header);
  } catch (const FormatError&) {
    // Not a line for each. Only an arrangement that uses up all numbers is taken.
    const std::size_t least = 3 + header.keyword.normal + header.keyword.texture;
    for (const std::size_t colour : {std::size_t{4}, std::size_t{3}}) {
      for (const bool face_colours : {false, true}) {
        try {
          return read_by_numbers(lines, header, least + (header.keyword.colour ? colour : 0), face_colours);
        } catch (const FormatError&) {
          continue;
        }
      }
      if (!header.keyword.colour) break;
    }
    throw;
  }
}

}  // namespace cchip::mesh_io
