// SPDX-License-Identifier: Apache-2.0
// Point Cloud Data of the Point Cloud Library: text and binary (little endian).
#include <array>
#include <cmath>
#include <cstring>

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

struct Header {
  std::vector<Field> fields;
  std::size_t points = 0;
  bool has_points = false;
  std::size_t width = 0;
  std::size_t height = 1;
  bool has_width = false;
  bool binary = false;
  std::size_t lines = 0;
};

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
      if (words[1] == "binary_compressed") {
        throw FormatError(
            "compressed data is not read; write the file with `pcl_convert_pcd_ascii_binary in.pcd out.pcd 1`",
            header.lines);
      }
      if (words[1] != "ascii" && words[1] != "binary") {
        throw FormatError("DATA is neither ascii nor binary", header.lines);
      }
      header.binary = words[1] == "binary";
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

}  // namespace

PolygonSoup read_pcd(std::string_view file) {
  const Header header = take_header(file);
  // Where x, y and z are: their words in a line, their bytes in a record.
  std::array<const Field*, 3> field = {};
  std::array<std::size_t, 3> word = {};
  std::array<std::size_t, 3> byte = {};
  std::size_t words = 0;
  std::size_t bytes = 0;
  for (const Field& f : header.fields) {
    if (f.count > std::size_t{1} << 20U) throw FormatError("the COUNT of a field is above 2^20", header.lines);
    const auto axis = std::string_view("xyz").find(f.name);
    if (f.name.size() == 1 && axis < 3) {
      if (field[axis] != nullptr || f.count != 1) throw FormatError("the fields need one " + f.name, header.lines);
      field[axis] = &f;
      word[axis] = words;
      byte[axis] = bytes;
    }
    words += f.count;
    bytes += f.bytes * f.count;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    if (field[k] == nullptr) throw FormatError("the fields need one " + axis, header.lines);
    if (field[k]->type == 'F' && field[k]->bytes < 4) throw FormatError(axis + " has no size of a float", header.lines);
  }
  PolygonSoup soup;
  if (header.binary) {
    if (file.size() / bytes < header.points) {
      throw FormatError("the file ends before the last point that the header announces");
    }
    for (std::size_t i = 0; i < header.points; ++i) {
      Vec3d point;
      for (std::size_t k = 0; k < 3; ++k) {
        point[static_cast<Eigen::Index>(k)] =
            to_value(file.substr(i * bytes + byte[k], field[k]->bytes), field[k]->type);
      }
      soup.add_point(point, 0);
    }
    if (!without_padding(file.substr(header.points * bytes)).empty()) {
      throw FormatError("the file continues after the last point that the header announces");
    }
    return soup;
  }
  Lines lines(file, {true, false});
  for (std::size_t i = 0; i < header.points; ++i) {
    if (!lines.next()) {
      throw FormatError("the file ends before the last point that the header announces", header.lines + lines.number());
    }
    if (lines.words().size() != words) {
      throw FormatError("the line has " + std::to_string(lines.words().size()) + " words for " + std::to_string(words) +
                            " values of the fields",
                        header.lines + lines.number());
    }
    Vec3d point;
    for (std::size_t k = 0; k < 3; ++k) {
      point[static_cast<Eigen::Index>(k)] = to_number(lines.words()[word[k]], header.lines + lines.number());
    }
    soup.add_point(point, header.lines + lines.number());
  }
  if (lines.next()) {
    throw FormatError("the file continues after the last point that the header announces",
                      header.lines + lines.number());
  }
  return soup;
}

}  // namespace cchip::mesh_io
