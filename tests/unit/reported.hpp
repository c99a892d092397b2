// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which assertions of the RTL a run has reported, by their names.
#ifndef CCHIP_TESTS_UNIT_REPORTED_HPP
#define CCHIP_TESTS_UNIT_REPORTED_HPP

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cchip/sim/errors.hpp>
#include <cstdio>
#include <set>
#include <stdexcept>
#include <string>

namespace cchip::test {

/// Standard output goes to a file for as long as this lives: the runtime of the simulator prints there.
class Output {
 public:
  Output() : before_(dup(1)), file_(std::tmpfile()) {
    std::fflush(stdout);
    if (before_ < 0 || file_ == nullptr || dup2(fileno(file_), 1) < 0)
      throw std::runtime_error("no file for the output");
  }
  ~Output() {
    std::fflush(stdout);
    dup2(before_, 1);
    close(before_);
    std::fclose(file_);
  }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  std::string text() {
    std::fflush(stdout);
    std::fseek(file_, 0, SEEK_END);
    std::string read(static_cast<std::size_t>(std::ftell(file_)), ' ');
    std::rewind(file_);
    if (std::fread(read.data(), 1, read.size(), file_) != read.size()) throw std::runtime_error("output is lost");
    return read;
  }

 private:
  int before_;
  std::FILE* file_;
};

/// "Instance.assertion" of every assertion that fails in `body`, which the first one ends.
template <class Body>
std::set<std::string> reported(Body&& body) {
  std::string text;
  bool ended = false;
  {
    Output output;
    try {
      body();
    } catch (const sim::AssertionFailure&) {
      ended = true;
    }
    text = output.text();
  }
  std::set<std::string> names;
  const std::string mark = "Assertion failed in ";
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
    const std::size_t from = at + mark.size();
    const std::string path = text.substr(from, text.find_first_of(":\n", from) - from);
    const std::size_t name = path.rfind('.') + 1;
    // without the generate block between the module and the assertion
    const std::size_t block = path.rfind(".gen_");
    const std::string outside = path.substr(0, block == std::string::npos ? name - 1 : block);
    names.insert(outside.substr(outside.rfind('.') + 1) + "." + path.substr(name));
  }
  REQUIRE(ended == !names.empty());
  return names;
}

}  // namespace cchip::test

#endif
