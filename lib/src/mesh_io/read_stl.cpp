// SPDX-License-Identifier: Apache-2.0
// STL as text (doubles as they are written) and binary (single precision).
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>

#include "polygon_soup.hpp"
#include "text.hpp"

namespace cchip::mesh_io {
namespace {

constexpr std::size_t header_bytes = 84;
constexpr std::size_t triangle_bytes = 50;

std::uint32_t little_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i > 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i - 1]);
  return value;
}

double to_float(std::string_view bytes) {
  const std::uint32_t bits = little_endian(bytes);
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return static_cast<double>(value);
}

std::uint64_t bytes_announced(std::string_view file) {
  return header_bytes + std::uint64_t{little_endian(file.substr(header_bytes - 4))} * triangle_bytes;
}

void add_triangle(PolygonSoup& soup, const std::array<Vec3d, 3>& vertices, std::size_t line) {
  for (const Vec3d& vertex : vertices) {
    soup.add_corner(static_cast<double>(soup.points.size()), line);
    soup.add_point(vertex, line);
  }
  soup.end_polygon(line);
}

void add_triangles(std::string_view bytes, PolygonSoup& soup) {
  for (; !bytes.empty(); bytes.remove_prefix(triangle_bytes)) {
    std::array<Vec3d, 3> vertices;
    for (std::size_t i = 0; i < 9; ++i) {
      vertices[i / 3][static_cast<Eigen::Index>(i % 3)] = to_float(bytes.substr(12 + 4 * i));
    }
    add_triangle(soup, vertices, 0);
  }
}

/// Triangles are made of numbers of some size; text or colours behind the triangles hardly ever are.
bool holds_triangles(std::string_view bytes) {
  if (bytes.size() % triangle_bytes != 0) return false;
  for (std::size_t i = 0; i < bytes.size() / triangle_bytes * 12; ++i) {
    const double x = std::abs(to_float(bytes.substr(i / 12 * triangle_bytes + i % 12 * 4)));
    if (x != 0 && !(x > 1e-30 && x < 1e30)) return false;
  }
  return true;
}

/// What follows the triangles that the header announces: more of them, if the writer stopped counting or never began,
/// or something else, such as colours. Nothing is left out without a note, but for padding.
void add_rest(std::string_view rest, PolygonSoup& soup) {
  if (without_padding(rest).empty()) return;
  const std::string announced = std::to_string(soup.polygons.size());
  if (holds_triangles(rest)) {
    add_triangles(rest, soup);
    soup.notes.push_back("the header announces " + announced + " triangles, the file holds " +
                         std::to_string(soup.polygons.size()) + ": all of them were read");
    return;
  }
  if (soup.polygons.empty()) {
    throw FormatError("the header announces 0 triangles, and the " + std::to_string(rest.size()) +
                      " bytes behind it are none; write the file again");
  }
  soup.notes.push_back(std::to_string(rest.size()) + " bytes behind the " + announced +
                       " triangles that the header announces were left out; they are no triangles");
}

PolygonSoup read_binary(std::string_view file) {
  if (file.size() < header_bytes) throw FormatError("the file ends within the header of a binary STL");
  if (bytes_announced(file) > file.size()) {
    throw FormatError("the header announces " + std::to_string(bytes_announced(file)) + " bytes, the file has " +
                      std::to_string(file.size()));
  }
  PolygonSoup soup;
  add_triangles(file.substr(header_bytes, bytes_announced(file) - header_bytes), soup);
  add_rest(file.substr(bytes_announced(file)), soup);
  return soup;
}

/// Keywords may be written in capitals.
bool is_keyword(std::string_view word, std::string_view keyword) {
  return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                    [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

void require(Words& words, std::string_view keyword) {
  if (!is_keyword(words.next(), keyword)) {
    throw FormatError("'" + std::string(keyword) + "' is missing", words.line());
  }
}

/// "endloop" or "end loop".
bool is_end(Words& words, std::string_view word, std::string_view what) {
  if (is_keyword(word, "end")) return is_keyword(words.next(), what);
  return is_keyword(word.substr(0, 3), "end") && is_keyword(word.substr(std::min<std::size_t>(3, word.size())), what);
}

void require_end(Words& words, std::string_view what) {
  if (!is_end(words, words.next(), what)) {
    throw FormatError("'end" + std::string(what) + "' is missing", words.line());
  }
}

double require_number(Words& words) {
  const std::string_view word = words.next();
  if (word.empty()) throw FormatError("the file ends where a number must follow", words.line());
  return to_number(word, words.line());
}

/// A facet, its first word read.
void read_facet(Words& words, PolygonSoup& soup) {
  require(words, "normal");
  for (int i = 0; i < 3; ++i) words.next();  // the normal is not used, and often is no number
  require(words, "outer");
  require(words, "loop");
  std::array<Vec3d, 3> vertices;
  for (Vec3d& vertex : vertices) {
    require(words, "vertex");
    for (Eigen::Index i = 0; i < 3; ++i) vertex[i] = require_number(words);
  }
  add_triangle(soup, vertices, words.line());
  require_end(words, "loop");
  require_end(words, "facet");
}

PolygonSoup read_text(std::string_view file) {
  PolygonSoup soup;
  Words words(file);
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (!is_keyword(word, "solid")) throw FormatError("'solid' is missing", words.line());
    words.skip_line();
    for (word = words.next(); is_keyword(word, "facet"); word = words.next()) read_facet(words, soup);
    if (!is_end(words, word, "solid")) throw FormatError("'facet' or 'endsolid' is missing", words.line());
    words.skip_line();
  }
  return soup;
}

}  // namespace

bool is_binary_stl(std::string_view file) {
  return file.size() >= header_bytes && bytes_announced(file) == file.size();
}

PolygonSoup read_stl(std::string_view file) {
  const auto first = std::min(file.find_first_not_of(" \t\r\n"), file.size());
  if (is_binary_stl(file) || !is_keyword(file.substr(first, 5), "solid")) return read_binary(file);
  // Many binary files begin with "solid", too. Text holds no NUL bytes, and the header of one with triangles would have
  // to announce more bytes than there are.
  const bool has_room = file.size() > header_bytes && bytes_announced(file) <= file.size() &&
                        (bytes_announced(file) > header_bytes || (file.size() - header_bytes) % triangle_bytes == 0);
  const bool has_nul = file.substr(0, header_bytes + triangle_bytes).find('\0') != std::string_view::npos;
  return has_room && has_nul ? read_binary(file) : read_text(file);
}

}  // namespace cchip::mesh_io
