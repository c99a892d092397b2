// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <iostream>

#include "cli.hpp"

int main(int argc, char** argv) {
  std::ios::sync_with_stdio(false);
  const cchip::app::Streams streams{std::cin, std::cout, std::cerr, isatty(STDERR_FILENO) == 1};
  return cchip::app::run_cli({argv + 1, argv + argc}, streams);
}
