// SPDX-License-Identifier: Apache-2.0
/// \file
/// The whole command line as one function.
#ifndef CCHIP_APP_CLI_HPP
#define CCHIP_APP_CLI_HPP

#include <istream>
#include <ostream>
#include <string>
#include <vector>

namespace cchip::app {

struct Streams {
  std::istream& in;
  std::ostream& out;
  std::ostream& err;
  /// True if `err` is a terminal: draw a progress bar.
  bool progress = false;
  /// True if a person reads `out` on a terminal: show times.
  bool person = false;
  /// The answer in colour.
  bool colour = false;
};

struct Hardware;

/// Runs `cchip` with the arguments after the program name; returns the exit code. Does not throw.
/// \param hardware what the simulated hardware adds; null: nothing
int run_cli(std::vector<std::string> arguments, const Streams& streams, const Hardware* hardware);

}  // namespace cchip::app

#endif
