// SPDX-License-Identifier: Apache-2.0
/// \file
/// Values as text.
#ifndef CCHIP_ASSEMBLY_TEXTS_HPP
#define CCHIP_ASSEMBLY_TEXTS_HPP

#include <cchip/internal/geometry/decimal.hpp>
#include <locale>
#include <sstream>
#include <string>

namespace cchip::assembly {

/// A basic string of TOML with its quotes.
inline std::string toml_text(const std::string& text) {
  constexpr const char* digits = "0123456789abcdef";
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      quoted += "\\u00";
      quoted += digits[byte / 16];
      quoted += digits[byte % 16];
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

/// The shortest text that is read as the same double.
inline std::string number_text(double x) {
  constexpr int most_digits = 17;
  for (int digits = 1; digits < most_digits; ++digits) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(digits);
    text << x + 0.0;  // -0 is 0
    if (read_decimal(text.str()) == x) return text.str();
  }
  return decimal_text(x);
}

/// Nine digits, for people.
inline std::string rounded_text(double x) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(9);
  text << x + 0.0;
  return text.str();
}

}  // namespace cchip::assembly

#endif
