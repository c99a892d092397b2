// SPDX-License-Identifier: Apache-2.0
// Prints the seed of every run; tests read it from the same variable. Include it once, beside main().
#ifndef CCHIP_TESTS_SEED_PRINTER_HPP
#define CCHIP_TESTS_SEED_PRINTER_HPP

#include <catch2/catch.hpp>
#include <cchip/program/seed.hpp>
#include <iostream>

struct SeedPrinter : Catch::TestEventListenerBase {
  using TestEventListenerBase::TestEventListenerBase;
  void testRunStarting(const Catch::TestRunInfo&) override {
    std::cout << "CCHIP_SEED=" << cchip::sim::seed_from_environment() << std::endl;
  }
};

CATCH_REGISTER_LISTENER(SeedPrinter)

#endif
