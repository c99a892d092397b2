// SPDX-License-Identifier: Apache-2.0
#include <cchip/program/output_file.hpp>
#include <cchip/stimulus/judge.hpp>
#include <cchip/stimulus/pair_source.hpp>
#include <optional>
#include <random>

#include "commands.hpp"
#include "rtl_stream.hpp"

namespace cchip::campaign {
namespace {

/// Of the clocks on which a pair waits at the input, the least share on which the pipeline must accept an axis.
constexpr double least_axes_per_clock = 0.99;

/// Programmes of a stream: one for all pairs, or pair by pair with a reserved mode now and then.
constexpr std::array<const char*, 3> mixes = {"exhaustive", "directed", "mixed"};

PairMode draw_mode(std::size_t mix, std::mt19937_64& random) {
  if (mix < 2) return static_cast<PairMode>(mix);
  return static_cast<PairMode>(random() % 50 == 0 ? 2 + random() % 2 : random() % 2);
}

/// One class of one shape in one mix of programmes; half of the pairs with any eta.
Table<RtlJudgement> stream_class(const ShapeInfo& shape, PairClass c, std::size_t mix, const ClassesOptions& options,
                                 std::uint64_t part) {
  PairSource source(defs::coord_w_default, options.seed_of(part), shape.a, shape.b);
  std::mt19937_64 random(options.seed_of(part) + 1);
  std::vector<PairRequest> requests;
  std::vector<bool> exact;
  for (std::uint64_t i = 0; i < options.pairs; ++i) {
    GridPair pair = source.draw(c);
    pair.eta = random() % 2 == 0 ? 0 : static_cast<int>(random() % 16);
    requests.push_back({pair, 0, draw_mode(mix, random)});
    exact.push_back(exact_intersects(pair));
  }
  Table<RtlJudgement> table(1);
  table.rows[0] = judge_rtl(shape, requests, exact, options.seed_of(part), part, table.examples);
  return table;
}

double axes_per_clock(const RtlJudgement& r) {
  return static_cast<double>(r.counts.beats) / static_cast<double>(r.counts.offered_clocks);
}

void print_row(const std::string& name, const char* mix, const RtlJudgement& r) {
  fmt::print("{:<20} {:<11} {:>9} {:>8} {:>9} {:>6} {:>5} {:>7.3f} {:>4} {:>10.4f} {:>9.4f}{}\n", name, mix, r.pairs,
             r.hits, r.not_as_model, r.wrong, r.beats.least, r.beats.mean(), r.beats.greatest,
             static_cast<double>(r.pairs) / static_cast<double>(r.counts.clocks), axes_per_clock(r),
             r.too_many_beats != 0 ? fmt::format("  {} pairs took too many beats", r.too_many_beats) : "");
}

/// The mean beats for other programs: one line per class and programme behind one of names.
class BeatsFile {
 public:
  /// name: empty for no file.
  explicit BeatsFile(const std::string& name) {
    if (name.empty()) return;
    out_.emplace(name);
    out_->stream() << "shape,class,programme,pairs,beats_least,beats_mean,beats_greatest,axes_per_clock\n";
  }
  void add(const ShapeInfo& shape, const std::string& name, const char* mix, const RtlJudgement& r) {
    if (!out_) return;
    out_->stream() << fmt::format("{},\"{}\",{},{},{},{:.4f},{},{:.4f}\n", shape.name, name, mix, r.pairs,
                                  r.beats.least, r.beats.mean(), r.beats.greatest, axes_per_clock(r));
  }
  /// Throws if the file could not be written.
  void commit() {
    if (out_) out_->commit();
  }

 private:
  std::optional<sim::OutputFile> out_;
};

}  // namespace

int run_classes(const ClassesOptions& options) {
  const StopWatch watch;
  fmt::print("seed={} coord_w={}\n", options.seed, defs::coord_w_default);
  BeatsFile beats(options.csv);
  RtlJudgement all;
  double least = 1;
  std::uint64_t first_part = 0;
  for (const ShapeInfo& shape : options.shapes()) {
    const auto classes = classes_of(shape.a, shape.b);
    const std::uint64_t jobs = classes.size() * mixes.size();
    const auto table = sum_of_parts<Table<RtlJudgement>>(jobs, options.threads, [&](std::uint64_t job) {
      Table<RtlJudgement> counted(jobs);
      const Table<RtlJudgement> one =
          stream_class(shape, classes[job / mixes.size()].value, job % mixes.size(), options, first_part + job);
      counted.rows[job] = one.rows[0];
      counted.examples = one.examples;
      return counted;
    });
    first_part += jobs;
    fmt::print("\n{}\n{:<20} {:<11} {:>9} {:>8} {:>9} {:>6} {:>5} {:>7} {:>4} {:>10} {:>9}\n", shape.name, "class",
               "programme", "pairs", "hits", "not model", "wrong", "min", "beats", "max", "pairs/clk", "axes/clk");
    for (std::uint64_t job = 0; job < jobs; ++job) {
      const RtlJudgement& r = table.rows[job];
      print_row(classes[job / mixes.size()].name, mixes[job % mixes.size()], r);
      beats.add(shape, classes[job / mixes.size()].name, mixes[job % mixes.size()], r);
      least = std::min(least, axes_per_clock(r));
    }
    table.examples.print();
    all += table.sum();
  }
  beats.commit();
  Goals goals;
  options.check(goals, all.pairs, all.hits);
  goals.at_least("number of axes per waiting clock", least, least_axes_per_clock);
  fmt::print(
      "pairs={} not_as_model={} wrong={} too_many_beats={} least_axes_per_waiting_clock={:.4f} clocks={} "
      "seconds={:.1f} "
      "seed={}\n",
      all.pairs, all.not_as_model, all.wrong, all.too_many_beats, least, all.counts.clocks, watch.seconds(),
      options.seed);
  return all.failed() || goals.missed() ? wrong_result : 0;
}

}  // namespace cchip::campaign
