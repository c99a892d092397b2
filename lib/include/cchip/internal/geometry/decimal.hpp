// SPDX-License-Identifier: Apache-2.0
/// \file
/// Doubles from decimal text and to it.
#ifndef CCHIP_INTERNAL_GEOMETRY_DECIMAL_HPP
#define CCHIP_INTERNAL_GEOMETRY_DECIMAL_HPP

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <locale>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

#ifndef __cpp_lib_to_chars  // libc++ reads whole numbers only
#include <cerrno>
#include <cmath>
#include <cstdlib>
#ifdef __APPLE__
#include <xlocale.h>
#else
#include <locale.h>
#endif
#endif

namespace cchip {

namespace detail {

#ifdef __cpp_lib_to_chars
inline std::from_chars_result read_double(const char* first, const char* last, double& value) {
  return std::from_chars(first, last, value);
}
#else
/// The same by strtod in the locale "C", less what strtod reads beyond std::from_chars: spaces, a plus sign,
/// hexadecimals.
inline std::from_chars_result read_double(const char* first, const char* last, double& value) {
  static const locale_t c_locale = newlocale(LC_ALL_MASK, "C", nullptr);
  const std::string text(first, last);
  const std::size_t start = text.find_first_not_of('-');
  if (start > 1 || std::string_view("0123456789.iInN").find(text[start]) == std::string_view::npos ||
      text.find_first_of("xX") != std::string::npos) {
    return {first, std::errc::invalid_argument};
  }
  const int errno_before = errno;
  errno = 0;
  char* stop = nullptr;
  const double read = strtod_l(text.c_str(), &stop, c_locale);
  const bool out_of_range = errno == ERANGE && (std::isinf(read) || read == 0);  // not for a subnormal number
  errno = errno_before;
  if (stop == text.c_str()) return {first, std::errc::invalid_argument};
  if (!out_of_range) value = read;
  return {first + (stop - text.c_str()), out_of_range ? std::errc::result_out_of_range : std::errc()};
}
#endif

/// Of a decimal number that no double holds: is it too large, not too small?
inline bool is_too_large(std::string_view digits) {
  if (digits.front() == '-') digits.remove_prefix(1);
  const std::size_t letter = std::min(digits.find_first_of("eE"), digits.size());
  const std::string_view mantissa = digits.substr(0, letter);
  std::string_view power = digits.substr(std::min(letter + 1, digits.size()));
  const bool negative = !power.empty() && power.front() == '-';
  if (!power.empty() && (negative || power.front() == '+')) power.remove_prefix(1);
  constexpr std::int64_t far = std::int64_t{1} << 56;  // more than a text has digits
  std::int64_t exponent = 0;
  for (const char c : power) exponent = std::min(far, 10 * exponent + (c - '0'));
  if (negative) exponent = -exponent;
  const auto point = static_cast<std::int64_t>(std::min(mantissa.find('.'), mantissa.size()));
  const std::size_t first = mantissa.find_first_of("123456789");
  if (first == std::string_view::npos) return false;
  return point - static_cast<std::int64_t>(first) + exponent > 0;
}

}  // namespace detail

/// Nearest double of a decimal number, in any locale: `3`, `-0.25`, `+1e-9`; infinite if it is too large, 0 if it
/// is too small; "inf" and "nan" as they are. Nothing if the text is not a number as a whole.
inline std::optional<double> read_decimal(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = detail::read_double(text.data(), end, value);
  if (error == std::errc::invalid_argument || stop != end) return std::nullopt;
  if (error != std::errc::result_out_of_range) return value;
  // from_chars does not say whether the number is too large or too small, and strtod obeys the locale
  value = detail::is_too_large(text) ? std::numeric_limits<double>::infinity() : 0.0;
  return text[0] == '-' ? -value : value;
}

/// The number with 17 digits, in any locale: another double has another text.
inline std::string decimal_text(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(17);
  text << value;
  return text.str();
}

/// True if the text would be a number with a point in the place of its comma.
inline bool has_decimal_comma(std::string_view text) {
  std::string with_point(text);
  if (std::count(text.begin(), text.end(), ',') != 1) return false;
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return read_decimal(with_point).has_value();
}

}  // namespace cchip

#endif
