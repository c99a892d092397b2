// SPDX-License-Identifier: Apache-2.0
// Stanford PLY: text, binary little endian, binary big endian.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>

#include "polygon_soup.hpp"
#include "text.hpp"

namespace cchip::mesh_io {
namespace {

struct Type {
  std::string_view name;
  std::string_view other_name;
  std::size_t bytes;
  enum class Is { signed_integer, unsigned_integer, floating } is;
};

constexpr std::array<Type, 10> types = {{{"char", "int8", 1, Type::Is::signed_integer},
                                         {"uchar", "uint8", 1, Type::Is::unsigned_integer},
                                         {"short", "int16", 2, Type::Is::signed_integer},
                                         {"ushort", "uint16", 2, Type::Is::unsigned_integer},
                                         {"int", "int32", 4, Type::Is::signed_integer},
                                         {"uint", "uint32", 4, Type::Is::unsigned_integer},
                                         {"int64", "longlong", 8, Type::Is::signed_integer},
                                         {"uint64", "ulonglong", 8, Type::Is::unsigned_integer},
                                         {"float", "float32", 4, Type::Is::floating},
                                         {"double", "float64", 8, Type::Is::floating}}};

struct Property {
  std::string name;
  std::optional<Type> count;  ///< of a list
  Type value;
};

struct Element {
  std::string name;
  std::size_t items = 0;
  std::vector<Property> properties;
};

enum class Encoding { text, little_endian, big_endian };

struct Header {
  Encoding encoding = Encoding::text;
  std::vector<Element> elements;
  std::size_t lines = 0;
};

// --- header

Type to_type(std::string_view name, std::size_t line) {
  for (const Type& type : types) {
    if (name == type.name || name == type.other_name) return type;
  }
  throw FormatError("the type of the property is unknown", line);
}

Encoding to_encoding(std::string_view name, std::size_t line) {
  if (name == "ascii") return Encoding::text;
  if (name == "binary_little_endian") return Encoding::little_endian;
  if (name == "binary_big_endian") return Encoding::big_endian;
  throw FormatError("the format is unknown", line);
}

Property to_property(const std::vector<std::string_view>& words, std::size_t line) {
  if (words.size() == 3) return {std::string(words[2]), {}, to_type(words[1], line)};
  if (words.size() == 5 && words[1] == "list") {
    return {std::string(words[4]), to_type(words[2], line), to_type(words[3], line)};
  }
  throw FormatError("the property is not complete", line);
}

/// Takes the header off the front of the file.
Header take_header(std::string_view& file) {
  Header header;
  bool has_format = false;
  const auto first_end = std::min(file.find_first_of("\r\n"), file.size());
  const bool ends_with_cr = file.substr(first_end, 1) == "\r" && file.substr(first_end, 2) != "\r\n";
  while (!file.empty()) {
    const std::string_view rest = file;
    const std::string_view text = take_line(file);
    // Where lines end with CR alone, an LF behind the last one is the first byte of binary values.
    if (ends_with_cr) file = rest.substr(std::min(text.size() + 1, rest.size()));
    Lines line(text, {});
    ++header.lines;
    const bool empty = !line.next();
    const auto& words = line.words();
    if (header.lines == 1) {
      if (empty || words[0] != "ply") throw FormatError("the file does not begin with 'ply'", 1);
    } else if (empty) {
      continue;
    } else if (words[0] == "format" && words.size() == 3) {
      header.encoding = to_encoding(words[1], header.lines);
      has_format = true;
    } else if (words[0] == "element" && words.size() == 3) {
      header.elements.push_back({std::string(words[1]), to_count(words[2], header.lines), {}});
    } else if (words[0] == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(to_property(words, header.lines));
    } else if (words[0] == "end_header" && has_format) {
      return header;
    } else if (words[0] == "format" || words[0] == "element" || words[0] == "property" || words[0] == "end_header") {
      throw FormatError("the line is not complete or stands in a wrong place", header.lines);
    }  // others are comments, with or without the keyword
  }
  throw FormatError("the file ends within the header", header.lines);
}

// --- values

/// Values behind the header. Every call takes at least one byte of the file.
class Values {
 public:
  virtual ~Values() = default;
  /// \throws FormatError the file ends before it, or it is no number
  virtual double next(const Type& type) = 0;
  /// Line of the last value; 0: the file is binary.
  virtual std::size_t line() const = 0;
  virtual bool at_end() = 0;
};

class TextValues : public Values {
 public:
  TextValues(std::string_view text, std::size_t lines_before) : words_(text, lines_before) {}
  /// The number as it is written, regardless of the precision of the announced type.
  double next(const Type&) override {
    const std::string_view word = words_.next();
    if (word.empty()) throw FormatError("the file ends before the last value that the header announces", line());
    return to_number(word, line());
  }
  std::size_t line() const override { return words_.line(); }
  bool at_end() override { return words_.next().empty(); }

 private:
  Words words_;
};

template <class Float, class Bits>
double to_float(Bits bits) {
  Float value = 0;
  static_assert(sizeof value == sizeof bits);
  std::memcpy(&value, &bits, sizeof value);
  return static_cast<double>(value);
}

class BinaryValues : public Values {
 public:
  BinaryValues(std::string_view bytes, bool big_endian) : bytes_(bytes), big_endian_(big_endian) {}
  double next(const Type& type) override {
    if (bytes_.size() < type.bytes) throw FormatError("the file ends before the last value that the header announces");
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < type.bytes; ++i) {
      bits = bits << 8 | static_cast<unsigned char>(bytes_[big_endian_ ? i : type.bytes - 1 - i]);
    }
    bytes_.remove_prefix(type.bytes);
    if (type.is == Type::Is::floating) {
      return type.bytes == 8 ? to_float<double>(bits) : to_float<float>(static_cast<std::uint32_t>(bits));
    }
    if (type.bytes == 8) {  // the nearest double
      return type.is == Type::Is::signed_integer ? static_cast<double>(static_cast<std::int64_t>(bits))
                                                 : static_cast<double>(bits);
    }
    const double range = std::ldexp(1.0, static_cast<int>(8 * type.bytes));
    const auto value = static_cast<double>(bits);  // exact, at most 32 bits
    return type.is == Type::Is::signed_integer && value >= range / 2 ? value - range : value;
  }
  std::size_t line() const override { return 0; }
  bool at_end() override { return bytes_.find_first_not_of(" \t\r\n") == std::string_view::npos; }

 private:
  std::string_view bytes_;
  bool big_endian_;
};

// --- elements

/// Calls take(property, value) for each value of an item; of a list without its count.
template <class Take>
void read_item(const Element& element, Values& values, const Take& take) {
  for (const Property& property : element.properties) {
    const double count = property.count ? values.next(*property.count) : 1;
    if (!(count >= 0) || count != std::floor(count)) throw FormatError("the count of a list is wrong", values.line());
    for (double i = 0; i < count; ++i) take(property, values.next(property.value));
  }
}

void read_vertex(const Element& element, Values& values, PolygonSoup& soup) {
  Vec3d point;
  read_item(element, values, [&](const Property& property, double value) {
    const auto axis = std::string_view("xyz").find(property.name);
    if (!property.count && property.name.size() == 1 && axis < 3) point[static_cast<Eigen::Index>(axis)] = value;
  });
  soup.add_point(point, values.line());
}

bool is_corners(const Property& property) {
  return property.count && (property.name == "vertex_indices" || property.name == "vertex_index");
}

void read_face(const Element& element, Values& values, PolygonSoup& soup) {
  read_item(element, values, [&](const Property& property, double value) {
    if (is_corners(property)) soup.add_corner(value, values.line());
  });
  soup.end_polygon(values.line());
}

/// Strips of triangles, with -1 between them. Triangles with two equal corners only lead from one strip to the next.
void read_strips(const Element& element, Values& values, PolygonSoup& soup) {
  std::array<double, 2> last{};
  std::size_t length = 0;  // of the present strip
  read_item(element, values, [&](const Property& property, double value) {
    if (!is_corners(property)) return;
    if (value == -1) {
      length = 0;
      return;
    }
    if (++length > 2 && last[0] != last[1] && last[1] != value && last[0] != value) {
      const bool turned = length % 2 == 0;
      for (const double corner : {last[turned ? 1 : 0], last[turned ? 0 : 1], value}) {
        soup.add_corner(corner, values.line());
      }
      soup.end_polygon(values.line());
    }
    last = {last[1], value};
  });
}

/// An element without items needs no properties: PCL writes `element face 0` without any behind a point cloud.
void require_properties(const Element& element) {
  if (element.items == 0) return;
  const auto count_if = [&](auto is) {
    return std::count_if(element.properties.begin(), element.properties.end(), is);
  };
  if (element.properties.empty()) {
    throw FormatError("element '" + element.name + "' has no properties");
  }
  for (const char* const name : {"x", "y", "z"}) {
    if (element.name != "vertex") break;
    if (count_if([&](const Property& p) { return !p.count && p.name == name; }) != 1) {
      throw FormatError(std::string("the vertices need one property ") + name);
    }
  }
  if (element.name == "face" && count_if(is_corners) != 1) {
    throw FormatError("the faces need one list vertex_indices");
  }
  if (element.name == "tristrips" && count_if(is_corners) != 1) {
    throw FormatError("the strips of triangles need one list vertex_indices");
  }
}

}  // namespace

PolygonSoup read_ply(std::string_view file) {
  const Header header = take_header(file);
  std::unique_ptr<Values> values;
  if (header.encoding == Encoding::text) {
    values = std::make_unique<TextValues>(file, header.lines);
  } else {
    values = std::make_unique<BinaryValues>(file, header.encoding == Encoding::big_endian);
  }
  PolygonSoup soup;
  for (const Element& element : header.elements) {
    require_properties(element);
    for (std::size_t i = 0; i < element.items; ++i) {
      if (element.name == "vertex") {
        read_vertex(element, *values, soup);
      } else if (element.name == "face") {
        read_face(element, *values, soup);
      } else if (element.name == "tristrips") {
        read_strips(element, *values, soup);
      } else {
        read_item(element, *values, [](const Property&, double) {});
      }
    }
  }
  if (!values->at_end()) {
    throw FormatError("the file continues after the last value that the header announces", values->line());
  }
  return soup;
}

}  // namespace cchip::mesh_io
