// SPDX-License-Identifier: Apache-2.0
/// \file
/// Exit codes of the command line and the error that means "the input or the command is wrong".
#ifndef CCHIP_PROGRAM_USAGE_ERROR_HPP
#define CCHIP_PROGRAM_USAGE_ERROR_HPP

#include <cstdint>
#include <stdexcept>
#include <string>

namespace cchip {

/// Exit codes of `cchip`, documented in docs/cpp/cli.md.
enum ExitCode : int {
  exit_ok = 0,
  exit_internal = 1,
  exit_refused = 1,    ///< `check`: a certificate does not hold
  exit_violation = 1,  ///< `clash`: the assembly is not as its rules want it
  exit_usage = 2,
  exit_mismatch = 3,
  exit_left_out = 4,  ///< answered without the faces that could not be used (--lenient)
  exit_contact = 5    ///< a query found a contact (--exit-code)
};

/// Wrong input or wrong command line. what() is one line "<where>: <what>; <remedy>".
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The same, placed in a row of a file: "<file>:<row>: <message>".
inline UsageError row_error(const std::string& file, std::uint64_t row, const std::string& message) {
  UsageError error(file + ":" + std::to_string(row) + ": " + message);
  return error;
}

}  // namespace cchip

#endif
