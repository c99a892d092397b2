// SPDX-License-Identifier: Apache-2.0
// The grid -1..1: 27 points, 27^3 ordered triangles.
#include <cchip/stimulus/judge.hpp>

#include "commands.hpp"
#include "grid_pairs.hpp"
#include "rtl_stream.hpp"

namespace cchip::campaign {
namespace {

Table<Judgement> model_pairs(const ShapeInfo& shape, const GridOptions& options, std::uint64_t count,
                             const std::vector<int>& firsts) {
  const GridPairs pairs(shape, count, firsts);
  return sum_of_parts<Table<Judgement>>(part_count(count), options.threads, [&](std::uint64_t part) {
    Table<Judgement> counted(1);
    pairs.visit(part, options.seed_of(part), [&](const GridPair& pair) {
      const Judgement one = judge(shape, pair, defs::coord_w_default);
      if (one.failed()) counted.examples.add(part, to_text(pair));
      counted.rows[0] += one;
    });
    return counted;
  });
}

Table<RtlJudgement> rtl_pairs(const ShapeInfo& shape, const GridOptions& options, const std::vector<int>& firsts) {
  const GridPairs pairs(shape, options.rtl, firsts);
  return sum_of_parts<Table<RtlJudgement>>(2 * part_count(options.rtl), options.threads, [&](std::uint64_t job) {
    const std::uint64_t part = job / 2;
    std::vector<PairRequest> requests;
    std::vector<bool> exact;
    pairs.visit(part, options.seed_of(part), [&](const GridPair& pair) {
      requests.push_back({pair, 0, static_cast<PairMode>(job % 2)});
      exact.push_back(exact_intersects(pair));
    });
    Table<RtlJudgement> counted(2);
    counted.rows[job % 2] = judge_rtl(shape, requests, exact, options.seed_of(job), job, counted.examples);
    return counted;
  });
}

}  // namespace

int run_grid(const GridOptions& options) {
  const StopWatch watch;
  const std::vector<int> firsts = first_triangles();
  fmt::print("seed={} first triangles={} ordered second triangles={}\n", options.seed, firsts.size(), triangles);
  std::vector<std::string> names;
  Table<Judgement> table;
  Table<RtlJudgement> rtl_table;
  for (const ShapeInfo& shape : options.shapes()) {
    const bool all = shape.b == Kind::tri && options.pairs == 0;
    const std::uint64_t count = all ? firsts.size() * triangles : options.pairs;
    const Table<Judgement> counted = model_pairs(shape, options, count, firsts);
    names.emplace_back(shape.name);
    table.rows.push_back(counted.sum());
    counted.examples.print();
    if (options.rtl == 0) continue;
    const Table<RtlJudgement> rtl = rtl_pairs(shape, options, firsts);
    rtl_table.rows.insert(rtl_table.rows.end(), rtl.rows.begin(), rtl.rows.end());
    rtl.examples.print();
  }
  const Judgement sum = print(names, table);
  if (options.rtl != 0) {
    fmt::print("\n{:<28} {:>11} {:>11} {:>14} {:>9} {:>9} {:>6}\n", "RTL", "pairs", "hits", "not as model", "wrong",
               "beats", "max");
    for (std::size_t i = 0; i < rtl_table.rows.size(); ++i) {
      const RtlJudgement& r = rtl_table.rows[i];
      fmt::print("{:<28} {:>11} {:>11} {:>14} {:>9} {:>9.3f} {:>6}\n", names[i / 2] + " " + programmes[i % 2], r.pairs,
                 r.hits, r.not_as_model, r.wrong, r.beats.mean(), r.beats.greatest);
    }
  }
  const RtlJudgement rtl = rtl_table.sum();
  fmt::print(
      "pairs={} wrong_exhaustive={} wrong_directed={} false_no={} too_many_beats={} rtl_results={} rtl_not_as_model={} "
      "rtl_wrong={} seconds={:.1f} seed={}\n",
      sum.pairs, sum.wrong[0], sum.wrong[1], sum.false_no, sum.too_many_beats + rtl.too_many_beats, rtl.pairs,
      rtl.not_as_model, rtl.wrong, watch.seconds(), options.seed);
  Goals goals;
  options.check(goals, sum.pairs, sum.hits);
  return sum.failed() || rtl.failed() || goals.missed() ? wrong_result : 0;
}

}  // namespace cchip::campaign
