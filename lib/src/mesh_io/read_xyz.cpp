// SPDX-License-Identifier: Apache-2.0
// Points as text: XYZ, ASC, CSV with commas or semicolons, PTS and PTX.
#include <algorithm>
#include <array>
#include <cchip/internal/geometry/decimal.hpp>
#include <cctype>
#include <limits>
#include <optional>

#include "polygon_soup.hpp"
#include "text.hpp"

namespace cchip::mesh_io {
namespace {

enum class Separator { blanks, comma, semicolon };

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view around = " \t\f\v\"";
  const auto begin = std::min(text.find_first_not_of(around), text.size());
  return text.substr(begin, text.find_last_not_of(around) + 1 - begin);
}

/// Semicolons or commas between values; a comma within each word is a decimal comma, which is no separator.
Separator separator_of(std::string_view line) {
  if (line.find(';') != std::string_view::npos) return Separator::semicolon;
  if (line.find(',') == std::string_view::npos) return Separator::blanks;
  Lines words(line, {});
  words.next();
  const bool decimal_commas =
      words.words().size() >= 3 && words.words()[0].back() != ',' && has_decimal_comma(words.words()[0]);
  return decimal_commas ? Separator::blanks : Separator::comma;
}

void cut(std::string_view line, Separator separator, std::vector<std::string_view>& words) {
  words.clear();
  if (separator == Separator::blanks) {
    Lines lines(line, {});
    if (lines.next()) words = lines.words();
    return;
  }
  const char mark = separator == Separator::comma ? ',' : ';';
  for (bool more = true; more;) {
    const auto end = line.find(mark);
    more = end != std::string_view::npos;
    words.push_back(trimmed(line.substr(0, end)));
    if (more) line.remove_prefix(end + 1);
  }
}

/// The axis that the title of a column names: "x", "X", "x[m]", "x (m)", "Points:0"; 3 for others.
std::size_t axis_of(std::string_view title) {
  std::string name(trimmed(title));
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  name = trimmed(std::string_view(name).substr(0, name.find_first_of("[(")));
  for (std::size_t k = 0; k < 3; ++k) {
    if (name == std::string(1, "xyz"[k]) || name == "points:" + std::to_string(k)) return k;
  }
  return 3;
}

using Columns = std::array<std::size_t, 3>;

/// The columns x, y and z of a title line; nothing unless it names each once.
std::optional<Columns> columns_of(const std::vector<std::string_view>& titles) {
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  Columns columns = {none, none, none};
  for (std::size_t i = 0; i < titles.size(); ++i) {
    const std::size_t axis = axis_of(titles[i]);
    if (axis == 3) continue;
    if (columns[axis] != none) return {};
    columns[axis] = i;
  }
  if (std::find(columns.begin(), columns.end(), none) != columns.end()) return {};
  return columns;
}

bool is_number(std::string_view word) { return read_decimal(word).has_value() || has_decimal_comma(word); }

/// Lines with values; titles and comments are taken out of the way.
class Table {
 public:
  explicit Table(std::string_view file) : rest_(without_padding(file)) {}

  /// Goes to the next line with a value; false at the end.
  bool next() {
    while (!rest_.empty()) {
      std::string_view line = take_line(rest_);
      ++number_;
      std::string_view text = trimmed(line);
      const bool comment = text.substr(0, 1) == "#" || text.substr(0, 2) == "//";
      if (comment && !begun_) take_title(text.substr(std::min(text.find_first_not_of("#/"), text.size())));
      if (comment) continue;
      line = line.substr(0, line.find('#'));
      text = trimmed(line);
      if (text.empty()) continue;
      if (!begun_) begin(line);
      cut(line, separator_, words_);
      if (begun_) return true;
      if (!is_title()) {
        begun_ = true;
        // A title in a comment holds only if it has a word for each value.
        if (in_comment_ && words_.size() != titles_) columns_ = {0, 1, 2};
        return true;
      }
    }
    return false;
  }

  const std::vector<std::string_view>& words() const { return words_; }
  std::size_t number() const { return number_; }

  double value(std::size_t column) const {
    if (column >= words_.size() || words_[column].empty()) {
      throw FormatError("word " + std::to_string(column + 1) + " of the line is missing", number_);
    }
    try {
      return to_number(words_[column], number_);
    } catch (const FormatError& error) {
      if (std::string_view(error.what()).find("; ") != std::string_view::npos) throw;
      throw FormatError(std::string(error.what()) + "; each line holds x, y and z: begin others with #", number_);
    }
  }
  Vec3d point() const { return {value(columns_[0]), value(columns_[1]), value(columns_[2])}; }

 private:
  void begin(std::string_view line) { separator_ = separator_of(line); }

  void take_title(std::string_view text) {
    cut(text, separator_of(text), words_);
    const auto columns = columns_of(words_);
    if (!columns) return;
    columns_ = *columns;
    titles_ = words_.size();
    in_comment_ = true;
  }

  /// A first line without any number. \throws FormatError it does not say which columns are x, y and z
  bool is_title() {
    if (titled_ || std::any_of(words_.begin(), words_.end(), is_number)) return false;
    const auto columns = columns_of(words_);
    if (!columns) {
      throw FormatError("the title line names no columns x, y and z; name them so, or begin the line with #", number_);
    }
    columns_ = *columns;
    in_comment_ = false;
    titled_ = true;
    return true;
  }

  std::string_view rest_;
  std::vector<std::string_view> words_;
  std::size_t number_ = 0;
  Separator separator_ = Separator::blanks;
  Columns columns_ = {0, 1, 2};
  std::size_t titles_ = 0;
  bool in_comment_ = false;
  bool titled_ = false;
  bool begun_ = false;  ///< a line with values was met
};

void require_line(Table& table, std::size_t have, std::size_t count) {
  if (table.next()) return;
  throw FormatError(
      "the file ends after " + std::to_string(have) + " of the " + std::to_string(count) + " points that it announces",
      table.number());
}

/// A block of a PTS file; its count and its first line are read.
void read_pts_block(Table& table, std::size_t count, PolygonSoup& soup) {
  soup.add_point(table.point(), table.number());
  for (std::size_t i = 1; i < count; ++i) {
    require_line(table, i, count);
    soup.add_point(table.point(), table.number());
  }
}

/// Numbers of a line of a PTX header.
template <std::size_t count>
std::array<double, count> header_line(Table& table) {
  if (!table.next() || table.words().size() != count) {
    throw FormatError("the header of the PTX needs a line with " + std::to_string(count) + " numbers here",
                      table.number());
  }
  std::array<double, count> values = {};
  for (std::size_t i = 0; i < count; ++i) values[i] = table.value(i);
  return values;
}

/// A scan of a PTX file, its counts read: where the scanner was, a matrix whose rows multiply from the left, points.
/// A point 0 0 0 is a ray that came back from nowhere.
void read_ptx_scan(Table& table, std::size_t columns, std::size_t rows, PolygonSoup& soup) {
  for (int i = 0; i < 4; ++i) header_line<3>(table);
  std::array<std::array<double, 4>, 4> matrix = {};
  for (auto& row : matrix) row = header_line<4>(table);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t c = 0; c < columns; ++c) {
    for (std::size_t r = 0; r < rows; ++r) {
      require_line(table, c * rows + r, columns * rows);
      const Vec3d p(table.value(0), table.value(1), table.value(2));
      Vec3d placed;
      for (std::size_t k = 0; k < 3; ++k) {
        placed[static_cast<Eigen::Index>(k)] =
            p.isZero(0) ? nan : p[0] * matrix[0][k] + p[1] * matrix[1][k] + p[2] * matrix[2][k] + matrix[3][k];
      }
      soup.add_point(placed, table.number());
    }
  }
}

/// PTS and PTX, the first count read.
PolygonSoup read_counted(Table& table) {
  PolygonSoup soup;
  do {
    if (table.words().size() != 1) {
      throw FormatError("the file continues after the last point that it announces", table.number());
    }
    const std::size_t count = to_count(table.words()[0], table.number());
    if (count == 0) continue;
    require_line(table, 0, count);
    if (table.words().size() == 1) {
      read_ptx_scan(table, count, to_count(table.words()[0], table.number()), soup);
    } else {
      read_pts_block(table, count, soup);
    }
  } while (table.next());
  return soup;
}

}  // namespace

PolygonSoup read_xyz(std::string_view file) {
  PolygonSoup soup;
  Table table(file);
  if (!table.next()) return soup;
  if (table.words().size() == 1) return read_counted(table);
  do {
    soup.add_point(table.point(), table.number());
  } while (table.next());
  return soup;
}

}  // namespace cchip::mesh_io
