// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a fuzz target demands of an outcome; anything else ends the program.
#ifndef CCHIP_TESTS_FUZZ_REQUIRE_HPP
#define CCHIP_TESTS_FUZZ_REQUIRE_HPP

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

/// What libFuzzer and replay.cpp call with each input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "not so: %s\n", what);
  std::abort();
}

/// Errors are one line, and not a long one.
inline void require_one_line(const std::exception& error) {
  const std::string text = error.what();
  require(!text.empty() && text.size() < 1000 && text.find('\n') == std::string::npos, "an error is one line");
}

#endif
