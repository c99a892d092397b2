// SPDX-License-Identifier: Apache-2.0
/// \file
/// One seed for a test run.
#ifndef CCHIP_PROGRAM_SEED_HPP
#define CCHIP_PROGRAM_SEED_HPP

#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace cchip::sim {

/// Verilator's seed of what the RTL leaves undefined at power-up: odd, positive, and different for seeds that follow
/// each other.
constexpr int power_up_seed(std::uint64_t seed) { return static_cast<int>(seed % 0x3fffffff) * 2 + 1; }

/// The environment variable CCHIP_SEED, or `otherwise` if it is not set.
/// \throws std::invalid_argument CCHIP_SEED is not a whole number
inline std::uint64_t seed_from_environment(std::uint64_t otherwise = 1) {
  const char* text = std::getenv("CCHIP_SEED");
  if (text == nullptr || *text == '\0') return otherwise;
  std::size_t used = 0;
  std::uint64_t seed = 0;
  try {
    seed = std::stoull(text, &used, 0);
  } catch (const std::exception&) {
    used = 0;
  }
  const bool digits = std::isdigit(static_cast<unsigned char>(text[0])) != 0;  // stoull would take "-3"
  if (!digits || used == 0 || text[used] != '\0') {
    throw std::invalid_argument("CCHIP_SEED=" + std::string(text) + ": not a whole number; set it to one or unset it");
  }
  return seed;
}

}  // namespace cchip::sim

#endif
