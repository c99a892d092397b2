// SPDX-License-Identifier: Apache-2.0
// Seeds of the tests.
#include <catch2/catch.hpp>
#include <cchip/program/seed.hpp>
#include <cstdlib>
#include <limits>
#include <string>

using cchip::sim::power_up_seed;
using cchip::sim::seed_from_environment;

namespace {

/// CCHIP_SEED has this value while the object lives.
class Environment {
 public:
  explicit Environment(const std::string& value) {
    const char* old = std::getenv("CCHIP_SEED");
    if (old != nullptr) old_ = old;
    setenv("CCHIP_SEED", value.c_str(), 1);
  }
  ~Environment() {
    if (old_.empty()) {
      unsetenv("CCHIP_SEED");
    } else {
      setenv("CCHIP_SEED", old_.c_str(), 1);
    }
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  std::string old_;
};

}  // namespace

TEST_CASE("seed: seeds that follow each other give two power-ups", "[ref][seed]") {
  for (const std::string value : {"0", "1", "2", "3", "1000", "0x3ffffffe", "0x7fffffff", "18446744073709551615"}) {
    CAPTURE(value);
    const Environment environment(value);
    const std::uint64_t seed = seed_from_environment();
    const int first = power_up_seed(seed);
    const int second = power_up_seed(seed + 1);
    CHECK(first != second);
    for (const int power_up : {first, second}) {
      CHECK(power_up > 0);  // 0 means "choose one" to Verilator
    }
  }
}

TEST_CASE("seed: a number that is negative or no number is refused", "[ref][seed]") {
  for (const std::string value : {"-3", "abc", "7x", " -1", "1e3"}) {
    CAPTURE(value);
    const Environment environment(value);
    CHECK_THROWS_AS(seed_from_environment(), std::invalid_argument);
  }
}
