// SPDX-License-Identifier: Apache-2.0
// main() of the tests, compiled once.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
#include <cstdlib>
#include <iostream>

namespace {

/// Prints the seed of every run; tests take it from the same variable.
struct SeedPrinter : Catch::TestEventListenerBase {
  using TestEventListenerBase::TestEventListenerBase;
  void testRunStarting(const Catch::TestRunInfo&) override {
    const char* seed = std::getenv("CCHIP_SEED");
    std::cout << "CCHIP_SEED=" << (seed == nullptr || *seed == '\0' ? "1" : seed) << std::endl;
  }
};

}  // namespace

CATCH_REGISTER_LISTENER(SeedPrinter)
