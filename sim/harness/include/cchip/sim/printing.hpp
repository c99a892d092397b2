// SPDX-License-Identifier: Apache-2.0
/// \file
/// Values in error messages.
#ifndef CCHIP_SIM_PRINTING_HPP
#define CCHIP_SIM_PRINTING_HPP

#include <sstream>
#include <string>
#include <type_traits>
#include <utility>

namespace cchip::sim {

namespace detail {
template <class T, class = void>
struct Streams : std::false_type {};
template <class T>
struct Streams<T, std::void_t<decltype(std::declval<std::ostream&>() << std::declval<const T&>())>> : std::true_type {};
}  // namespace detail

/// The value by its operator<< (numbers of one byte as numbers), "?" if it has none.
template <class T>
std::string to_text(const T& value) {
  std::ostringstream text;
  if constexpr (std::is_integral_v<T>) {
    text << +value;
  } else if constexpr (detail::Streams<T>::value) {
    text << value;
  } else {
    text << '?';
  }
  return text.str();
}

}  // namespace cchip::sim

#endif
