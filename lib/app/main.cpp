// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <string_view>

#include "cli.hpp"
#include "hardware.hpp"

namespace {

/// NO_COLOR, of any text, asks every program for none.
bool may_colour() {
  const char* const no_colour = std::getenv("NO_COLOR");
  const char* const terminal = std::getenv("TERM");
  return (no_colour == nullptr || *no_colour == '\0') && (terminal == nullptr || std::string_view(terminal) != "dumb");
}

}  // namespace

int main(int argc, char** argv) {
  std::ios::sync_with_stdio(false);
  const bool person = isatty(STDOUT_FILENO) == 1;
  const cchip::app::Streams streams{
      std::cin, std::cout, std::cerr, isatty(STDERR_FILENO) == 1, person, person && may_colour()};
  return cchip::app::run_cli({argv + 1, argv + argc}, streams, cchip::app::hardware());
}
