// SPDX-License-Identifier: Apache-2.0
/// \file
/// Time of several ways to answer the same queries, measured in turns.
#ifndef CCHIP_BENCH_MEASURE_HPP
#define CCHIP_BENCH_MEASURE_HPP

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

namespace cchip::testing {

enum class Clock {
  cpu,  ///< all threads of the process: work that a variant moved to a helper thread counts
  wall
};

inline double seconds(Clock clock) {
  timespec now = {};
  clock_gettime(clock == Clock::cpu ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.at(values.size() / 2);
}

/// Collects factors for their geometric mean.
struct GeometricMean {
  double sum = 0;
  int count = 0;
  void add(double factor) {
    sum += std::log(factor);
    ++count;
  }
  double value() const { return count == 0 ? 0 : std::exp(sum / count); }
};

/// Fills the caches with something that no query needs.
inline void fill_caches() {
  static std::vector<unsigned char> unrelated(std::size_t{96} << 20U);
  for (std::size_t byte = 0; byte < unrelated.size(); byte += 64) ++unrelated[byte];
}

/// One way to answer.
struct Variant {
  std::string name;
  Clock clock = Clock::cpu;
  /// Answers the queries `first` to `first + count` of a pass.
  std::function<void(std::size_t first, std::size_t count)> answer;
  /// Seconds a query, one entry for each pass.
  std::vector<double> passes = {};
  double seconds_each() const { return median(passes); }
};

/// Lets every variant answer `queries` queries once. They are cut into chunks. After a variant the next one gets
/// another chunk, so that none finds in the caches what the one before it has just read, and in every round another
/// variant begins. \param between called between chunks, its time is not measured
/// \param before called before variant `number` answers the `count` queries from `first` on, its time is not measured
inline void measure_pass(
    std::vector<Variant>& variants, std::size_t queries, std::size_t chunks,
    const std::function<void(std::size_t)>& between,
    const std::function<void(std::size_t number, std::size_t first, std::size_t count)>& before = nullptr) {
  chunks = std::min(chunks, queries);
  const auto start_of = [&](std::size_t chunk) { return queries * chunk / chunks; };
  std::vector<double> total(variants.size());
  for (std::size_t round = 0; round < chunks; ++round) {
    for (std::size_t i = 0; i < variants.size(); ++i) {
      const std::size_t number = (i + round) % variants.size();
      const std::size_t chunk = (round + number) % chunks;
      const std::size_t first = start_of(chunk);
      const std::size_t count = start_of(chunk + 1) - first;
      Variant& variant = variants[number];
      if (before) before(number, first, count);
      const double start = seconds(variant.clock);
      variant.answer(first, count);
      total[number] += seconds(variant.clock) - start;
      between(count);
    }
  }
  for (std::size_t i = 0; i < variants.size(); ++i) {
    variants[i].passes.push_back(total[i] / static_cast<double>(queries));
  }
}

/// Bytes in use on the heap.
inline double heap_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

}  // namespace cchip::testing

#endif
