// SPDX-License-Identifier: Apache-2.0
#include <cchip/stimulus/judge.hpp>
#include <cchip/stimulus/pair_source.hpp>

#include "certify_sample.hpp"
#include "commands.hpp"

namespace cchip::campaign {

int run_random(const RandomOptions& options) {
  const StopWatch watch;
  fmt::print("seed={} coord_w={}\n", options.seed, options.coord_w);
  Judgement all;
  std::uint64_t certified = 0;
  std::uint64_t refused = 0;
  for (const ShapeInfo& shape : options.shapes()) {
    const auto classes = classes_of(shape.a, shape.b);
    CertifySample sample(options.certify, options.pairs, part_count(options.pairs));
    const auto table =
        sum_of_parts<Table<Judgement>>(part_count(options.pairs), options.threads, [&](std::uint64_t part) {
          PairSource source(options.coord_w, options.seed_of(part), shape.a, shape.b);
          Table<Judgement> counted(classes.size());
          for (std::uint64_t i = 0; i < pairs_of_part(options.pairs, part); ++i) {
            const std::size_t c = source.draw_class();
            const GridPair pair = source.draw(classes[c].value);
            const Judgement one = judge(shape, pair, options.coord_w);
            const bool proven = i >= sample.of_part(part) || sample.add(pair);
            if (one.failed() || !proven)
              counted.examples.add(part, fmt::format("{}: {}", classes[c].name, to_text(pair)));
            counted.rows[c] += one;
          }
          return counted;
        });
    std::vector<std::string> names;
    names.reserve(classes.size());
    for (const PairClassInfo& c : classes) names.emplace_back(c.name);
    fmt::print("\n{}\n", shape.name);
    all += print(names, table);
    table.examples.print();
    certified += sample.certified();
    refused += sample.refused();
  }
  fmt::print("pairs={} wrong_exhaustive={} wrong_directed={} false_no={} too_many_beats={}{} seconds={:.1f} seed={}\n",
             all.pairs, all.wrong[0], all.wrong[1], all.false_no, all.too_many_beats,
             options.certify == 0 ? "" : fmt::format(" certified={} refused={}", certified, refused), watch.seconds(),
             options.seed);
  Goals goals;
  options.check(goals, all.pairs, all.hits);
  return all.failed() || refused != 0 || goals.missed() ? wrong_result : 0;
}

}  // namespace cchip::campaign
