// SPDX-License-Identifier: Apache-2.0
// main() of the tests, compiled once.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#include "seed_printer.hpp"
