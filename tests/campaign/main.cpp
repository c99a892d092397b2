// SPDX-License-Identifier: Apache-2.0
// Compares the bit-exact model of the EXHAUSTIVE programme with the exact oracle on random pairs.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cchip/exact_oracle.hpp>
#include <cchip/model/sat.hpp>
#include <chrono>
#include <cstdio>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "pair_source.hpp"

namespace cchip::campaign {
namespace {

struct Options {
  std::uint64_t pairs = 1000000;
  std::uint64_t seed = 1;
  int coord_w = defs::coord_w_default;
  unsigned threads = 2;
};

/// What was seen of one class.
struct Counts {
  std::uint64_t pairs = 0;
  std::uint64_t hits = 0;        ///< by the oracle
  std::uint64_t special = 0;     ///< coplanar or degenerate, by the model
  std::uint64_t open = 0;        ///< special, not separated by the model, yet disjoint: a later programme's task
  std::uint64_t mismatches = 0;  ///< model wrong where it must be right, false no included
  std::uint64_t false_no = 0;    ///< model separated, oracle hit

  Counts& operator+=(const Counts& x) {
    pairs += x.pairs;
    hits += x.hits;
    special += x.special;
    open += x.open;
    mismatches += x.mismatches;
    false_no += x.false_no;
    return *this;
  }
};
using Table = std::array<Counts, pair_classes.size()>;

/// A model that separates must be right; so must every answer of a pair that is not special; and special must
/// be what geometry calls coplanar or degenerate.
Counts judge(const GridPair& pair, int coord_w) {
  const model::Outcome model = model::exhaustive(pair, coord_w);
  const bool hit = exact_intersects(pair);
  const bool special = is_degenerate(pair.a) || is_degenerate(pair.b) || is_coplanar(pair);
  const bool wrong = model.grid != hit && (!special || !model.grid);
  Counts c;
  c.pairs = 1;
  c.hits = hit;
  c.special = model.special;
  c.open = special && model.grid && !hit;
  c.mismatches = wrong || model.special != special;
  c.false_no = !model.grid && hit;
  return c;
}

std::string to_text(const GridPair& pair) {
  std::string text;
  for (const GridPrimitive* p : {&pair.a, &pair.b}) {
    text += p == &pair.a ? "A" : "  B";
    for (std::size_t i = 0; i < 3; ++i) {
      text += fmt::format(" ({}, {}, {})", p->v[i].x(), p->v[i].y(), p->v[i].z());
    }
  }
  return text;
}

/// Progress in one line of a terminal; silent elsewhere.
class Progress {
 public:
  explicit Progress(std::uint64_t total) : total_(total), on_(isatty(STDERR_FILENO) == 1) {}
  ~Progress() {
    if (on_) std::fputs("\r\033[K", stderr);
  }
  void show(std::uint64_t done) const {
    if (on_) fmt::print(stderr, "\r{} of {} pairs, {} %", done, total_, 100 * done / total_);
  }

 private:
  std::uint64_t total_;
  bool on_;
};

/// The pairs are cut into chunks, each with its own source, so that the outcome depends neither on the number
/// of threads nor on who takes which chunk.
class Campaign {
 public:
  explicit Campaign(const Options& options) : options_(options), progress_(options.pairs) {}

  void run() {
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < options_.threads; ++i) threads.emplace_back([this] { work(); });
    for (std::thread& t : threads) t.join();
  }

  const Table& table() const { return table_; }
  /// The first mismatches, by chunk.
  const std::map<std::uint64_t, std::string>& examples() const { return examples_; }

 private:
  static constexpr std::uint64_t chunk_pairs = 1 << 16;
  static constexpr std::size_t examples_max = 10;

  void work() {
    while (true) {
      const std::uint64_t chunk = next_chunk_++;
      const std::uint64_t first = chunk * chunk_pairs;
      if (first >= options_.pairs) return;
      std::string example;
      const Table counted = run_chunk(chunk, std::min(chunk_pairs, options_.pairs - first), example);
      const std::lock_guard<std::mutex> lock(mutex_);
      for (std::size_t c = 0; c < counted.size(); ++c) {
        table_[c] += counted[c];
        done_ += counted[c].pairs;
      }
      if (!example.empty()) examples_[chunk] = example;
      if (examples_.size() > examples_max) examples_.erase(std::prev(examples_.end()));
      progress_.show(done_);
    }
  }

  Table run_chunk(std::uint64_t chunk, std::uint64_t pairs, std::string& example) const {
    PairSource source(options_.coord_w, options_.seed * 0x9e3779b97f4a7c15U + chunk);
    Table table;
    for (std::uint64_t i = 0; i < pairs; ++i) {
      const std::size_t c = source.draw_class();
      const GridPair pair = source.draw(pair_classes[c].value);
      const Counts one = judge(pair, options_.coord_w);
      if (one.mismatches != 0 && example.empty()) example = fmt::format("{}: {}", pair_classes[c].name, to_text(pair));
      table[c] += one;
    }
    return table;
  }

  Options options_;
  Progress progress_;
  std::atomic<std::uint64_t> next_chunk_{0};
  std::mutex mutex_;
  Table table_;
  std::uint64_t done_ = 0;
  std::map<std::uint64_t, std::string> examples_;
};

Counts print(const Table& table) {
  constexpr const char* row = "{:<20} {:>11} {:>11} {:>11} {:>11} {:>11} {:>9}\n";
  fmt::print(row, "class", "pairs", "hits", "special", "open", "mismatches", "false_no");
  Counts sum;
  for (std::size_t c = 0; c < table.size(); ++c) {
    const Counts& t = table[c];
    fmt::print(row, pair_classes[c].name, t.pairs, t.hits, t.special, t.open, t.mismatches, t.false_no);
    sum += t;
  }
  fmt::print(row, "all", sum.pairs, sum.hits, sum.special, sum.open, sum.mismatches, sum.false_no);
  return sum;
}

int run(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  fmt::print("seed={} coord_w={}\n", options.seed, options.coord_w);
  Campaign campaign(options);
  campaign.run();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const Counts sum = print(campaign.table());
  for (const auto& [chunk, text] : campaign.examples()) fmt::print("mismatch in chunk {}: {}\n", chunk, text);
  fmt::print("pairs={} special={} mismatches={} false_no={} seconds={:.1f} seed={}\n", sum.pairs, sum.special,
             sum.mismatches, sum.false_no, seconds.count(), options.seed);
  return sum.mismatches == 0 ? 0 : 3;
}

}  // namespace
}  // namespace cchip::campaign

int main(int argc, char** argv) {
  cchip::campaign::Options options;
  CLI::App app{
      "Compares the bit-exact model of the triangle-triangle module with the exact oracle on random pairs.\n"
      "special: coplanar or degenerate; open: special, disjoint, and separated by none of the eleven axes.\n"
      "Exit codes: 0 no mismatch, 3 mismatches, others: wrong arguments."};
  app.add_option("--pairs", options.pairs, "number of pairs")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--seed", options.seed, "repeats a run")->envname("CCHIP_SEED")->capture_default_str();
  app.add_option("--coord-w", options.coord_w, "bits of a coordinate")
      ->check(CLI::Range(cchip::defs::coord_w_min, cchip::defs::coord_w_max))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "threads; the outcome does not depend on it")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return cchip::campaign::run(options);
}
