// SPDX-License-Identifier: Apache-2.0
// Geomview OFF as text: a vertex or a face on each line, or numbers in lines of any length.
#include <algorithm>
#include <optional>
#include <utility>

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
  bool edges = false;                    ///< the count of edges, which means nothing, follows
  std::vector<std::string_view> behind;  ///< words behind them in their line: the count of edges, even the vertices
};

/// Reads to the end of the line on which the count of faces is.
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
  header.behind.assign(words.begin() + 2, words.end());
  Lines ahead = lines;  // the count of edges may also have a line of its own
  header.edges = header.behind.empty() ? ahead.next() && ahead.words().size() == 1 : is_digits(header.behind[0]);
  return header;
}

PolygonSoup read_by_lines(Lines lines, const Header& header) {
  PolygonSoup soup;
  if (header.behind.empty() && header.edges) lines.next();
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

/// How a file without a line for each vertex and each face can be arranged.
struct Arrangement {
  std::size_t numbers;  ///< of each vertex
  bool face_colours;    ///< each face begins a line, and behind it its colour ends the line
};

/// Numbers wherever lines end. \throws FormatError they do not end with the last face
PolygonSoup read_by_numbers(Lines lines, const Header& header, const Arrangement& as) {
  PolygonSoup soup;
  std::vector<std::string_view> words = header.behind;
  std::size_t at = 0;
  const auto next = [&] {
    if (at == words.size()) {
      lines.require_next("the last face");
      words = lines.words();
      at = 0;
    }
    return words[at++];
  };
  if (header.edges) to_count(next(), lines.number());
  while (soup.points.size() < header.points) {
    Vec3d point;
    for (std::size_t i = 0; i < as.numbers; ++i) {
      const double value = to_number(next(), lines.number());
      if (i < 3) point[static_cast<Eigen::Index>(i)] = value;
    }
    soup.add_point(point, lines.number());
  }
  while (soup.polygons.size() < header.polygons) {
    if (as.face_colours && at < words.size()) throw FormatError("the face begins no line", lines.number());
    const std::size_t corners = to_count(next(), lines.number());
    for (std::size_t i = 0; i < corners; ++i) soup.add_corner(to_number(next(), lines.number()), lines.number());
    soup.end_polygon(lines.number());
    if (as.face_colours) at = words.size();
  }
  if (at < words.size() || lines.next()) throw FormatError("the file continues", lines.number());
  return soup;
}

}  // namespace

bool is_off_keyword(std::string_view word) { return to_keyword(word).has_value(); }

namespace {

/// The one arrangement that uses up all numbers; nothing if there is none.
std::optional<PolygonSoup> read_by_some_numbers(const Lines& lines, const Header& header) {
  const std::size_t least = 3 + header.keyword.normal + header.keyword.texture;
  for (const std::size_t colour : {std::size_t{4}, std::size_t{3}}) {
    for (const bool face_colours : {false, true}) {
      try {
        return read_by_numbers(lines, header, {least + (header.keyword.colour ? colour : 0), face_colours});
      } catch (const FormatError&) {
        continue;
      }
    }
    if (!header.keyword.colour) break;
  }
  return {};
}

}  // namespace

PolygonSoup read_off(std::string_view file) {
  Lines lines(file, {true, false});
  const Header header = read_header(lines);
  const bool vertices_on_line_of_counts = header.behind.size() > 1;
  std::optional<PolygonSoup> soup;
  if (vertices_on_line_of_counts) soup = read_by_some_numbers(lines, header);
  if (soup) return std::move(*soup);
  try {
    return read_by_lines(lines, header);
  } catch (const FormatError&) {
    soup = read_by_some_numbers(lines, header);
    if (!soup) throw;
    return std::move(*soup);
  }
}

}  // namespace cchip::mesh_io
