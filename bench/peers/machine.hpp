// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a benchmark says about the computer that it ran on.
#ifndef CCHIP_BENCH_MACHINE_HPP
#define CCHIP_BENCH_MACHINE_HPP

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

namespace cchip::testing {

#ifdef __clang__
inline constexpr const char* compiler = __VERSION__;
#else
inline constexpr const char* compiler = "GCC " __VERSION__;
#endif

/// Name of the processor, number of cores and caches of the first one, as Linux reports them.
inline std::string machine_description() {
  std::string processor = "unknown";
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const std::size_t colon = line.find(": ");
    processor = colon == std::string::npos ? line : line.substr(colon + 2);
    break;
  }
  std::string caches;
  for (int i = 0; i < 4; ++i) {
    const std::string folder = fmt::format("/sys/devices/system/cpu/cpu0/cache/index{}/", i);
    std::ifstream level_file(folder + "level");
    std::ifstream type_file(folder + "type");
    std::ifstream size_file(folder + "size");
    std::string level;
    std::string type;
    std::string size;
    if (!(level_file >> level && type_file >> type && size_file >> size)) continue;
    if (type != "Instruction") caches += fmt::format("{}L{} {}", caches.empty() ? "" : ", ", level, size);
  }
  return fmt::format("{}, {} cores; {}", processor, std::thread::hardware_concurrency(), caches);
}

/// Processes that wanted to run in the last minute, mean; "unknown" if the system does not say.
inline std::string load_description() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? fmt::format("{:.1f}", load) : "unknown";
}

}  // namespace cchip::testing

#endif
