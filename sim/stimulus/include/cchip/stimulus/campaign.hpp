// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the campaigns share: shapes, threads whose number does not change the outcome, examples of failures.
#ifndef CCHIP_STIMULUS_CAMPAIGN_HPP
#define CCHIP_STIMULUS_CAMPAIGN_HPP

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cchip/internal/model/programme.hpp>
#include <cchip/internal/wire/pair.hpp>
#include <cchip/primitive.hpp>
#include <cchip/program/progress.hpp>
#include <cchip/program/seed.hpp>
#include <chrono>
#include <cstdint>
#include <exception>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace cchip::stimulus {

/// A primitive test and the kinds of its primitives.
struct ShapeInfo {
  const char* name;
  ModuleId id;
  Kind a = kinds_of(id)[0];
  Kind b = kinds_of(id)[1];
  model::Options options() const { return {{vertices_of(id)[0], vertices_of(id)[1]}, true}; }
};
constexpr std::array<ShapeInfo, 3> all_shapes = {
    {{"tri-tri", ModuleId::tri_tri}, {"tri-quad", ModuleId::tri_quad}, {"quad-quad", ModuleId::quad_quad}}};

/// Both programmes; the index is the mode.
constexpr std::array<const char*, 2> programmes = {"exhaustive", "directed"};

/// What a run must reach besides right results: a run that covers next to nothing fails.
class Goals {
 public:
  void at_least(const std::string& what, double got, double goal) {
    if (!(got >= goal)) miss(what, got, "at least", goal);
  }
  void at_most(const std::string& what, double got, double goal) {
    if (!(got <= goal)) miss(what, got, "at most", goal);
  }
  bool missed() const { return missed_; }

 private:
  void miss(const std::string& what, double got, const char* relation, double goal) {
    missed_ = true;
    fmt::print("goal missed: {} is {}, must be {} {}\n", what, got, relation, goal);
  }
  bool missed_ = false;
};

/// The options of every campaign.
struct CommonOptions {
  std::uint64_t seed = sim::seed_from_environment();
  unsigned threads = 2;
  std::uint64_t least_pairs = 1000;  ///< goals: in all
  std::uint64_t least_hits = 100;

  void check(Goals& goals, std::uint64_t pairs, std::uint64_t hits) const {
    goals.at_least("number of pairs", static_cast<double>(pairs), static_cast<double>(least_pairs));
    goals.at_least("number of hits", static_cast<double>(hits), static_cast<double>(least_hits));
  }
  std::string shape = "all";  ///< name of a shape, or all

  std::vector<ShapeInfo> shapes() const {
    std::vector<ShapeInfo> chosen;
    for (const ShapeInfo& s : all_shapes) {
      if (shape == "all" || shape == s.name) chosen.push_back(s);
    }
    return chosen;
  }
  /// Seed of a part of a run; each part gets another one.
  std::uint64_t seed_of(std::uint64_t part) const { return seed * 0x9e3779b97f4a7c15U + part; }
};

/// A wrong result or a missed goal ends a campaign with this exit code.
constexpr int wrong_result = 3;

/// The failures of the first parts of a run.
class Examples {
 public:
  void add(std::uint64_t part, std::string text) {
    texts_.emplace(part, std::move(text));
    trim();
  }
  Examples& operator+=(const Examples& x) {
    texts_.insert(x.texts_.begin(), x.texts_.end());
    trim();
    return *this;
  }
  void print() const {
    for (const auto& [part, text] : texts_) fmt::print("wrong in part {}: {}\n", part, text);
  }

 private:
  void trim() {
    while (texts_.size() > 10) texts_.erase(std::prev(texts_.end()));
  }
  std::map<std::uint64_t, std::string> texts_;
};

/// Smallest, largest and mean of what is counted.
struct Spread {
  std::uint64_t count = 0;
  std::uint64_t sum = 0;
  int least = 0;
  int greatest = 0;
  void add(int value) { *this += Spread{1, static_cast<std::uint64_t>(value), value, value}; }
  Spread& operator+=(const Spread& x) {
    if (x.count == 0) return *this;
    least = count == 0 ? x.least : std::min(least, x.least);
    greatest = count == 0 ? x.greatest : std::max(greatest, x.greatest);
    count += x.count;
    sum += x.sum;
    return *this;
  }
  double mean() const { return count == 0 ? 0 : static_cast<double>(sum) / static_cast<double>(count); }
};

/// Rows of a table, added row by row.
template <class Row>
struct Table {
  std::vector<Row> rows;
  Examples examples;
  explicit Table(std::size_t size = 0) : rows(size) {}
  Table& operator+=(const Table& x) {
    if (rows.size() < x.rows.size()) rows.resize(x.rows.size());
    for (std::size_t i = 0; i < x.rows.size(); ++i) rows[i] += x.rows[i];
    examples += x.examples;
    return *this;
  }
  Row sum() const {
    Row result;
    for (const Row& row : rows) result += row;
    return result;
  }
};

/// Sum of work(0) .. work(parts - 1). Every part draws its own random numbers, so the sum depends neither on the number
/// of threads nor on which thread does which part. The first exception of a part ends the run.
template <class Result, class Work>
Result sum_of_parts(std::uint64_t parts, unsigned threads, const Work& work) {
  Result result;
  std::mutex mutex;
  std::exception_ptr failure;
  std::atomic<std::uint64_t> next{0};
  Progress progress("parts");
  std::uint64_t done = 0;
  const auto worker = [&] {
    for (std::uint64_t part = next++; part < parts; part = next++) {
      try {
        const Result one = work(part);
        const std::lock_guard<std::mutex> lock(mutex);
        result += one;
        progress.update_of(++done, parts);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!failure) failure = std::current_exception();
        next = parts;
      }
    }
  };
  std::vector<std::thread> pool;
  for (unsigned i = 0; i < threads; ++i) pool.emplace_back(worker);
  for (std::thread& t : pool) t.join();
  if (failure) std::rethrow_exception(failure);
  return result;
}

/// Pairs per part of a long run.
constexpr std::uint64_t part_pairs = 1 << 16;
inline std::uint64_t part_count(std::uint64_t pairs) { return (pairs + part_pairs - 1) / part_pairs; }
inline std::uint64_t pairs_of_part(std::uint64_t pairs, std::uint64_t part) {
  return std::min(part_pairs, pairs - part * part_pairs);
}

class StopWatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

inline double percent(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace cchip::stimulus

#endif
