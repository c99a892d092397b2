// SPDX-License-Identifier: Apache-2.0
// Point Cloud Data of the Point Cloud Library: text, binary (little endian) and compressed.
#include <array>
#include <cmath>
#include <cstring>

#include "lzf.hpp"
#include "polygon_soup.hpp"
#include "text.hpp"

namespace cchip::mesh_io {
namespace {

struct Field {
  std::string name;
  std::size_t bytes = 4;
  char type = 'F';  ///< F: floating, I: signed integer, U: unsigned integer
  std::size_t count = 1;
};

enum class Data { text, binary, compressed };

struct Header {
  std::vector<Field> fields;
  std::size_t points = 0;
  bool has_points = false;
  std::size_t width = 0;
  std::size_t height = 1;
  bool has_width = false;
  Data data = Data::text;
  std::size_t lines = 0;
};

Data to_data(std::string_view word, std::size_t line) {
  if (word == "ascii") return Data::text;
  if (word == "binary") return Data::binary;
  if (word == "binary_compressed") return Data::compressed;
  throw FormatError("DATA is neither ascii, binary nor binary_compressed", line);
}

void require_fields(const Header& header, const std::vector<std::string_view>& words) {
  if (header.fields.empty() || words.size() != header.fields.size() + 1) {
    throw FormatError(std::string(words[0]) + " needs one word for each of FIELDS, which come first", header.lines);
  }
}

/// Takes the header off the front of the file, DATA included.
Header take_header(std::string_view& file) {
  Header header;
  while (!file.empty()) {
    Lines line(take_line(file), {true, false});
    ++header.lines;
    if (!line.next()) continue;
    const auto& words = line.words();
    if (words[0] == "FIELDS" || words[0] == "COLUMNS") {
      header.fields.clear();
      for (std::size_t i = 1; i < words.size(); ++i) {
        header.fields.emplace_back();
        header.fields.back().name = std::string(words[i]);
      }
    } else if (words[0] == "SIZE") {
      require_fields(header, words);
      for (std::size_t i = 1; i < words.size(); ++i) {
        const std::size_t bytes = to_count(words[i], header.lines);
        if (bytes != 1 && bytes != 2 && bytes != 4 && bytes != 8) {
          throw FormatError("the size of a field is neither 1, 2, 4 nor 8", header.lines);
        }
        header.fields[i - 1].bytes = bytes;
      }
    } else if (words[0] == "TYPE") {
      require_fields(header, words);
      for (std::size_t i = 1; i < words.size(); ++i) {
        if (words[i] != "F" && words[i] != "I" && words[i] != "U") {
          throw FormatError("the type of a field is neither F, I nor U", header.lines);
        }
        header.fields[i - 1].type = words[i][0];
      }
    } else if (words[0] == "COUNT") {
      require_fields(header, words);
      for (std::size_t i = 1; i < words.size(); ++i) header.fields[i - 1].count = to_count(words[i], header.lines);
    } else if ((words[0] == "WIDTH" || words[0] == "HEIGHT" || words[0] == "POINTS") && words.size() == 2) {
      const std::size_t count = to_count(words[1], header.lines);
      if (words[0] == "POINTS") {
        header.points = count;
        header.has_points = true;
      } else if (words[0] == "WIDTH") {
        header.width = count;
        header.has_width = true;
      } else {
        header.height = count;
      }
    } else if (words[0] == "DATA" && words.size() == 2) {
      header.data = to_data(words[1], header.lines);
      if (!header.has_points && !header.has_width) throw FormatError("the header has no POINTS", header.lines);
      const double area = static_cast<double>(header.width) * static_cast<double>(header.height);
      if (!header.has_points) header.points = area < 0x1p53 ? header.width * header.height : std::size_t{1} << 53U;
      if (header.has_points && header.has_width && area != static_cast<double>(header.points)) {
        throw FormatError("POINTS is not WIDTH times HEIGHT", header.lines);
      }
      return header;
    } else if (words[0] != "VERSION" && words[0] != "VIEWPOINT") {
      throw FormatError("the line is not complete or no line of a PCD header", header.lines);
    }
  }
  throw FormatError("the file ends within the header", header.lines);
}

double to_value(std::string_view bytes, char type) {
  std::uint64_t bits = 0;
  for (std::size_t i = bytes.size(); i > 0; --i) bits = bits << 8U | static_cast<unsigned char>(bytes[i - 1]);
  if (type == 'F') {
    if (bytes.size() == 8) {
      double value = 0;
      std::memcpy(&value, &bits, sizeof value);
      return value;
    }
    const auto half = static_cast<std::uint32_t>(bits);
    float value = 0;
    std::memcpy(&value, &half, sizeof value);
    return static_cast<double>(value);
  }
  if (type == 'U') return static_cast<double>(bits);
  const auto unused = static_cast<unsigned>(64 - 8 * bytes.size());
  return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
}

/// Where x, y and z are: their words in a line, their bytes in a record.
struct Layout {
  std::array<const Field*, 3> field = {};
  std::array<std::size_t, 3> word = {};
  std::array<std::size_t, 3> byte = {};
  std::size_t words = 0;  ///< of a line
  std::size_t bytes = 0;  ///< of a record
};

Layout layout_of(const Header& header) {
  Layout layout;
  for (const Field& f : header.fields) {
    if (f.count > std::size_t{1} << 20U) throw FormatError("the COUNT of a field is above 2^20", header.lines);
    const auto axis = std::string_view("xyz").find(f.name);
    if (f.name.size() == 1 && axis < 3) {
      if (layout.field[axis] != nullptr || f.count != 1) {
        throw FormatError("the fields need one " + f.name, header.lines);
      }
      layout.field[axis] = &f;
      layout.word[axis] = layout.words;
      layout.byte[axis] = layout.bytes;
    }
    layout.words += f.count;
    layout.bytes += f.bytes * f.count;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    const Field* const f = layout.field[k];
    if (f == nullptr) throw FormatError("the fields need one " + axis, header.lines);
    if (f->type == 'F' && f->bytes < 4) throw FormatError(axis + " has no size of a float", header.lines);
  }
  return layout;
}

/// \param by_field all values of a field are together; otherwise all values of a point
PolygonSoup read_records(std::string_view bytes, const Header& header, const Layout& layout, bool by_field) {
  PolygonSoup soup;
  for (std::size_t i = 0; i < header.points; ++i) {
    Vec3d point;
    for (std::size_t k = 0; k < 3; ++k) {
      const Field& f = *layout.field[k];
      const std::size_t at =
          by_field ? layout.byte[k] * header.points + i * f.bytes : i * layout.bytes + layout.byte[k];
      point[static_cast<Eigen::Index>(k)] = to_value(bytes.substr(at, f.bytes), f.type);
    }
    soup.add_point(point, 0);
  }
  return soup;
}

constexpr const char* too_short = "the file ends before the last point that the header announces";
constexpr const char* too_long = "the file continues after the last point that the header announces";

PolygonSoup read_binary(std::string_view file, const Header& header, const Layout& layout) {
  if (file.size() / layout.bytes < header.points) throw FormatError(too_short);
  if (!without_padding(file.substr(header.points * layout.bytes)).empty()) throw FormatError(too_long);
  return read_records(file, header, layout, false);
}

/// Two counts of bytes, packed and unpacked, and LZF.
PolygonSoup read_compressed(std::string_view file, const Header& header, const Layout& layout) {
  if (file.size() < 8) throw FormatError(too_short);
  const auto packed = static_cast<std::size_t>(to_value(file.substr(0, 4), 'U'));
  const auto unpacked = static_cast<std::size_t>(to_value(file.substr(4, 4), 'U'));
  file.remove_prefix(8);
  if (file.size() < packed) throw FormatError(too_short);
  if (unpacked % layout.bytes != 0 || unpacked / layout.bytes != header.points) {
    throw FormatError("the compressed data has " + std::to_string(unpacked) + " bytes, which are not " +
                      std::to_string(header.points) + " points of " + std::to_string(layout.bytes) + " bytes");
  }
  if (!without_padding(file.substr(packed)).empty()) throw FormatError(too_long);
  return read_records(unpack_lzf(file.substr(0, packed), unpacked), header, layout, true);
}

PolygonSoup read_text(std::string_view file, const Header& header, const Layout& layout) {
  PolygonSoup soup;
  Lines lines(file, {true, false});
  for (std::size_t i = 0; i < header.points; ++i) {
    if (!lines.next()) throw FormatError(too_short, header.lines + lines.number());
    if (lines.words().size() != layout.words) {
      throw FormatError("the line has " + std::to_string(lines.words().size()) + " words for " +
                            std::to_string(layout.words) + " values of the fields",
                        header.lines + lines.number());
    }
    Vec3d point;
    for (std::size_t k = 0; k < 3; ++k) {
      point[static_cast<Eigen::Index>(k)] = to_number(lines.words()[layout.word[k]], header.lines + lines.number());
    }
    soup.add_point(point, header.lines + lines.number());
  }
  if (lines.next()) throw FormatError(too_long, header.lines + lines.number());
  return soup;
}

}  // namespace

PolygonSoup read_pcd(std::string_view file) {
  const Header header = take_header(file);
  const Layout layout = layout_of(header);
  if (header.data == Data::text) return read_text(file, header, layout);
  return header.data == Data::binary ? read_binary(file, header, layout) : read_compressed(file, header, layout);
}

}  // namespace cchip::mesh_io
