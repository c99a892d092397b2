// SPDX-License-Identifier: Apache-2.0
/// \file
/// Options of the programs that refuse values without a meaning (CLI11).
#ifndef CCHIP_PROGRAM_COMMAND_LINE_HPP
#define CCHIP_PROGRAM_COMMAND_LINE_HPP

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cchip/program/usage_error.hpp>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <system_error>

namespace cchip {

/// Values that an option takes.
struct WholeRange {
  std::uint64_t least = 0;
  std::uint64_t greatest = std::numeric_limits<std::uint64_t>::max();
};

/// The whole number that is the value of an option.
/// \throws UsageError option, value, what is expected
inline std::uint64_t parse_whole(const std::string& option, const std::string& text, WholeRange range) {
  std::uint64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && stop == text.data() + text.size();
  if (whole && value >= range.least && value <= range.greatest) return value;
  const bool bounded = range.greatest != std::numeric_limits<std::uint64_t>::max();
  throw UsageError(bounded ? fmt::format("{}: got '{}'; write a whole number from {} to {}", option, text, range.least,
                                         range.greatest)
                           : fmt::format("{}: got '{}'; write a whole number, {} or more", option, text, range.least));
}

/// An option that takes a whole number.
template <class Value>
CLI::Option* add_whole(CLI::App& command, const std::string& name, Value& value, const std::string& description,
                       WholeRange range = {}) {
  const auto set = [name, &value, range](const std::string& text) {
    value = static_cast<Value>(parse_whole(name, text, range));
  };
  return command.add_option_function<std::string>(name, set, description)->type_name("N");
}

/// An option or an argument that takes a text, which must not be empty.
inline CLI::Option* add_text(CLI::App& command, const std::string& name, std::string& value,
                             const std::string& description) {
  const auto set = [name, &value](const std::string& text) {
    if (text.empty()) throw UsageError(name + ": the value is empty; write one, or leave the option out");
    value = text;
  };
  return command.add_option_function<std::string>(name, set, description);
}

}  // namespace cchip

#endif
