// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lines, words and numbers of text files.
#ifndef CCHIP_MESH_IO_TEXT_HPP
#define CCHIP_MESH_IO_TEXT_HPP

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace cchip::mesh_io {

/// The file without a UTF-8 byte order mark.
std::string_view without_mark(std::string_view file);

/// The text without what editors and downloads leave behind its end: blanks, line ends, NUL and Ctrl-Z.
std::string_view without_padding(std::string_view text);

/// A word of the file for a message: short, and without bytes that a terminal would obey.
std::string quoted(std::string_view word);

/// Takes a line off the front of a text that is not empty, and its end: LF, CR LF or CR. The last line needs none.
std::string_view take_line(std::string_view& text);

/// Lines of a text, cut into words. Blank lines are skipped. Padding behind the text is none of it.
class Lines {
 public:
  struct Rules {
    bool comments = false;      ///< '#' and what follows it is no part of the line
    bool continuation = false;  ///< '\' at the end of a line joins the next line to it, as another word
  };
  Lines(std::string_view text, Rules rules) : text_(without_padding(text)), rules_(rules) {}

  /// Goes to the next line with a word in it; false if there is none.
  bool next();
  /// The same for a line that must be there.
  /// \throws FormatError "the file ends before <what>"
  void require_next(const std::string& what);
  /// Words of the present line, at least one.
  const std::vector<std::string_view>& words() const { return words_; }
  /// Number of the present line, counted from 1.
  std::size_t number() const { return first_; }
  /// \throws FormatError word `i` is missing or no number
  double to_number(std::size_t i) const;

 private:
  std::string_view text_;
  Rules rules_;
  std::vector<std::string_view> words_;
  std::size_t first_ = 0;  ///< line where the present words begin
  std::size_t last_ = 0;   ///< line where they end
};

/// Words of a text whose line ends mean nothing.
class Words {
 public:
  explicit Words(std::string_view text, std::size_t lines_before = 0) : lines_(text, {}), before_(lines_before) {}
  /// The next word; empty at the end of the text.
  std::string_view next();
  /// Skips the rest of the present line.
  void skip_line() { next_ = lines_.words().size(); }
  /// Line of the last word.
  std::size_t line() const { return before_ + lines_.number(); }

 private:
  Lines lines_;
  std::size_t before_;
  std::size_t next_ = 0;
};

/// Nearest double of a decimal number; infinity for what is too large, "inf" and "nan" as they are.
/// \throws FormatError the word is not a number as a whole
double to_number(std::string_view word, std::size_t line);
/// A count from 0 to 2^53.
/// \throws FormatError it is not such a count
std::size_t to_count(std::string_view word, std::size_t line);

}  // namespace cchip::mesh_io

#endif
