// SPDX-License-Identifier: Apache-2.0
// Apart, touching, crossing: the exact predicates against the definition, which knows no axes.
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/stimulus/pair_source.hpp>
#include <cchip/stimulus/pair_vector.hpp>

#include "certify_sample.hpp"
#include "commands.hpp"
#include "grid_pairs.hpp"
#include "ref/difference_oracle.hpp"

namespace cchip::campaign {
namespace {

struct Counted {
  std::uint64_t pairs = 0;
  std::array<std::uint64_t, 3> relations = {};
  std::uint64_t wrong = 0;
  Counted& operator+=(const Counted& x) {
    pairs += x.pairs;
    for (std::size_t i = 0; i < relations.size(); ++i) relations[i] += x.relations[i];
    wrong += x.wrong;
    return *this;
  }
};

Counted judge_relation(const GridPair& pair) {
  const Relation relation = exact_relation(pair);
  const bool crosses = !cchip_test::parting_direction(pair).has_value();
  const bool meets = exact_intersects(pair);
  Counted one;
  one.pairs = 1;
  ++one.relations[static_cast<std::size_t>(relation)];
  one.wrong =
      (relation == Relation::crossing) != crosses || (relation == Relation::apart) == meets || (crosses && !meets);
  return one;
}

}  // namespace

int run_relation(const RelationOptions& options) {
  const StopWatch watch;
  const std::vector<int> firsts = first_triangles();
  fmt::print("seed={} {}\n{:<12} {:>11} {:>11} {:>11} {:>11} {:>7}\n", options.seed,
             options.random ? fmt::format("random pairs of all classes, coord_w={}", options.coord_w) : "grid -1..1",
             "shape", "pairs", "apart", "touching", "crossing", "wrong");
  Counted sum;
  std::uint64_t certified = 0;
  std::uint64_t refused = 0;
  for (const ShapeInfo& shape : options.shapes()) {
    const bool all = !options.random && shape.b == Kind::tri && options.pairs == 0;
    const std::uint64_t count = all ? firsts.size() * triangles : options.pairs;
    const GridPairs grid(shape, count, firsts);
    const auto classes = classes_of(shape.a, shape.b);
    CertifySample sample(options.certify, count, part_count(count));
    const auto table = sum_of_parts<Table<Counted>>(part_count(count), options.threads, [&](std::uint64_t part) {
      Table<Counted> counted(1);
      std::uint64_t to_certify = sample.of_part(part);
      const auto take = [&](const GridPair& pair) {
        const Counted one = judge_relation(pair);
        const bool proven = to_certify == 0 || (--to_certify, sample.add(pair));
        if (one.wrong != 0 || !proven) counted.examples.add(part, to_text(pair));
        counted.rows[0] += one;
      };
      if (options.random) {
        PairSource source(options.coord_w, options.seed_of(part), shape.a, shape.b);
        for (std::uint64_t i = 0; i < pairs_of_part(count, part); ++i)
          take(source.draw(classes[source.draw_class()].value));
      } else {
        grid.visit(part, options.seed_of(part), take);
      }
      return counted;
    });
    const Counted row = table.sum();
    fmt::print("{:<12} {:>11} {:>11} {:>11} {:>11} {:>7}\n", shape.name, row.pairs, row.relations[0], row.relations[1],
               row.relations[2], row.wrong);
    table.examples.print();
    sum += row;
    certified += sample.certified();
    refused += sample.refused();
  }
  fmt::print("pairs={} apart={} touching={} crossing={} wrong={}{} seconds={:.1f} seed={}\n", sum.pairs,
             sum.relations[0], sum.relations[1], sum.relations[2], sum.wrong,
             options.certify == 0 ? "" : fmt::format(" certified={} refused={}", certified, refused), watch.seconds(),
             options.seed);
  Goals goals;
  options.check(goals, sum.pairs, sum.relations[1] + sum.relations[2]);
  return sum.wrong != 0 || refused != 0 || goals.missed() ? wrong_result : 0;
}

}  // namespace cchip::campaign
