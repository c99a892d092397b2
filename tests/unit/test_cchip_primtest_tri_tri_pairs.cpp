// SPDX-License-Identifier: Apache-2.0
// Random pairs of all shapes through the default configurations, and relations between the answers of related pairs.
#include <cchip/internal/grid/canonical.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/model/programme.hpp>
#include <cchip/internal/reference/eigen_sat.hpp>
#include <cchip/machines/rtl_engine.hpp>
#include <cchip/stimulus/judge.hpp>
#include <cchip/stimulus/pair_source.hpp>
#include <cchip/stimulus/witness.hpp>
#include <iostream>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

constexpr int w = defs::coord_w_default;

std::unique_ptr<PairEngine> rtl(std::uint64_t seed) {
  RtlEngineOptions options;
  options.seed = seed;
  return make_rtl_engine(options);
}

struct Counts {
  std::uint64_t pairs = 0;
  std::uint64_t hits = 0;
  std::uint64_t special = 0;  ///< coplanar, degenerate or warped
  std::uint64_t beats = 0;
};

/// The RTL's answer against the functional model (every field), both references, the witness by hand, beats.
void judge(const GridPair& pair, PairMode mode, const PairResult& got, Counts& counts) {
  const model::Options options{{pair.a.vertex_count(), pair.b.vertex_count()}, true};
  if (!(got == model::run_programme(options, pair, mode, w).result(got.tag)))
    FAIL("RTL differs from the model: " << to_text(pair));
  if (!got.grid && !witness_separates(got.axis, pair)) FAIL("the witness does not separate: " << to_text(pair));
  const bool exact = exact_intersects(pair);
  if (eigen_intersects(pair, w) != exact) FAIL("Eigen reference differs from the exact oracle: " << to_text(pair));
  if (got.grid != exact) FAIL("wrong answer: " << to_text(pair));
  if (pair.eta == 0 && !got.definite) FAIL("exact input left open: " << to_text(pair));
  const bool general = is_general_position(pair);
  if (general && mode == PairMode::directed && got.beats > most_general_position_beats(pair, got.grid))
    FAIL(got.beats << " beats: " << to_text(pair));
  ++counts.pairs;
  counts.hits += exact ? 1 : 0;
  counts.special += general ? 0 : 1;
  counts.beats += static_cast<std::uint64_t>(got.beats);
}

struct Run {
  Kind a;
  Kind b;
  std::size_t pairs;
  /// The mode of pair number i.
  std::function<PairMode(std::size_t i)> mode;
};

void require_right_answers(const Run& run) {
  const std::uint64_t seed = sim::seed_from_environment();
  const auto engine = rtl(seed);
  stimulus::PairSource source(w, seed + static_cast<std::uint64_t>(run.mode(0)), run.a, run.b);
  Random random(seed);
  const auto classes = stimulus::classes_of(run.a, run.b);
  std::vector<Counts> table(classes.size());
  constexpr std::size_t batch = 50000;
  for (std::size_t done = 0; done < run.pairs; done += batch) {
    std::vector<GridPair> pairs;
    std::vector<std::size_t> drawn;
    std::vector<PairMode> modes;
    for (std::size_t i = 0; i < batch; ++i) {
      drawn.push_back(source.draw_class());
      pairs.push_back(source.draw(classes[drawn.back()].value));
      pairs.back().eta = chance(random, 80) ? 0 : static_cast<int>(random() % 16);
      modes.push_back(run.mode(i));
    }
    const auto answers = engine->run(pairs, modes);
    REQUIRE(answers.size() == batch);
    for (std::size_t i = 0; i < batch; ++i) judge(pairs[i], modes[i], answers[i], table[drawn[i]]);
  }
  Counts sum;
  for (std::size_t c = 0; c < table.size(); ++c) {
    const Counts& t = table[c];
    std::cout << classes[c].name << ": pairs=" << t.pairs << " hits=" << t.hits << " special=" << t.special
              << " beats=" << t.beats << '\n';
    REQUIRE(t.pairs > run.pairs / 100);
    sum.pairs += t.pairs;
    sum.hits += t.hits;
    sum.special += t.special;
    sum.beats += t.beats;
  }
  std::cout << "pairs=" << sum.pairs << " hits=" << sum.hits << " special=" << sum.special << " beats=" << sum.beats
            << " mismatches=0 clocks=" << engine->statistics().clocks << '\n';
  REQUIRE(sum.pairs == run.pairs);
  REQUIRE(sum.hits > sum.pairs / 10);
  REQUIRE(sum.hits < 9 * sum.pairs / 10);
  REQUIRE(sum.special > sum.pairs / 20);
  REQUIRE(engine->statistics().beats == sum.beats);
}

PairMode in_turn(std::size_t i) { return i % 2 == 0 ? PairMode::exhaustive : PairMode::directed; }

}  // namespace

TEST_CASE("cchip_primtest_tri_tri: half a million EXHAUSTIVE pairs, RTL, model and both references agree",
          "[unit][cchip_primtest_tri_tri]") {
  require_right_answers({Kind::tri, Kind::tri, 500000, [](std::size_t) { return PairMode::exhaustive; }});
}

TEST_CASE("cchip_primtest_tri_tri: half a million DIRECTED pairs, RTL, model and both references agree",
          "[unit][cchip_primtest_tri_tri]") {
  require_right_answers({Kind::tri, Kind::tri, 500000, [](std::size_t) { return PairMode::directed; }});
}

TEST_CASE("cchip_primtest_tri_quad: 100,000 pairs, RTL, model and both references agree",
          "[unit][cchip_primtest_tri_quad]") {
  require_right_answers({Kind::tri, Kind::quad, 100000, in_turn});
}

TEST_CASE("cchip_primtest_quad_quad: 100,000 pairs, RTL, model and both references agree",
          "[unit][cchip_primtest_quad_quad]") {
  require_right_answers({Kind::quad, Kind::quad, 100000, in_turn});
}

TEST_CASE("A quad module with V3 = V2 answers as the triangle module",
          "[unit][cchip_primtest_tri_quad][cchip_primtest_quad_quad]") {
  const std::uint64_t seed = sim::seed_from_environment();
  const auto engine = rtl(seed);
  stimulus::PairSource source(w, seed);
  const auto as_quad = [](GridPrimitive p) {
    p.kind = Kind::quad;
    p.v[3] = p.v[2];
    return p;
  };
  std::vector<GridPair> tri_tri, tri_quad, quad_quad;
  std::vector<PairMode> modes;
  for (std::size_t i = 0; i < 100000; ++i) {
    const GridPair pair = source.draw(stimulus::pair_classes[source.draw_class()].value);
    tri_tri.push_back(pair);
    tri_quad.push_back({pair.a, as_quad(pair.b), 0});
    quad_quad.push_back({as_quad(pair.a), as_quad(pair.b), 0});
    REQUIRE(is_canonical(quad_quad.back().a));  // else the host would change it on the way
    REQUIRE(is_canonical(quad_quad.back().b));
    modes.push_back(in_turn(i));
  }
  const auto expected = engine->run(tri_tri, modes);
  std::size_t hits = 0;
  for (const auto* pairs : {&tri_quad, &quad_quad}) {
    const auto answers = engine->run(*pairs, modes);
    for (std::size_t i = 0; i < pairs->size(); ++i) {
      if (answers[i].grid != expected[i].grid || !answers[i].definite) FAIL("another answer: " << to_text(tri_tri[i]));
      hits += answers[i].grid ? 1 : 0;
    }
  }
  REQUIRE(hits > 20000);
  REQUIRE(hits < 180000);
}

namespace {

/// The same pair written differently; `change` maps points.
template <class Change>
GridPair mapped(const GridPair& pair, Change change) {
  GridPair result = pair;
  for (GridPrimitive* p : {&result.a, &result.b}) {
    for (std::size_t i = 0; i < p->vertex_count(); ++i) p->v[i] = change(p->v[i]);
  }
  return result;
}

GridPrimitive turned(GridPrimitive p, std::ptrdiff_t by) {
  std::rotate(p.v.begin(), p.v.begin() + by, p.v.begin() + static_cast<std::ptrdiff_t>(p.vertex_count()));
  return p;
}
GridPrimitive reversed(GridPrimitive p) {
  std::reverse(p.v.begin(), p.v.begin() + static_cast<std::ptrdiff_t>(p.vertex_count()));
  return p;
}

/// Coordinates of the pair must lie within a quarter of the grid.
std::vector<std::pair<const char*, GridPair>> variants(const GridPair& pair, Random& random) {
  std::vector<std::pair<const char*, GridPair>> list;
  list.emplace_back("swapped", GridPair{pair.b, pair.a, 0});
  list.emplace_back("vertices of A rotated", GridPair{turned(pair.a, 1), pair.b, 0});
  list.emplace_back("vertices of B rotated", GridPair{pair.a, turned(pair.b, 2), 0});
  list.emplace_back("vertices reversed", GridPair{reversed(pair.a), reversed(pair.b), 0});
  list.emplace_back("axes rotated", mapped(pair, [](const Vec3i& v) { return Vec3i(v.y(), v.z(), v.x()); }));
  list.emplace_back("axes exchanged", mapped(pair, [](const Vec3i& v) { return Vec3i(v.y(), v.x(), v.z()); }));
  const auto d = static_cast<Eigen::Index>(random() % 3);
  list.emplace_back("mirrored", mapped(pair, [d](Vec3i v) {
                      v[d] = -v[d];
                      return v;
                    }));
  constexpr int quarter = 1 << (w - 3);
  std::uniform_int_distribution<int> shift(-2 * quarter, 2 * quarter);
  const Vec3i by(shift(random), shift(random), shift(random));
  list.emplace_back("translated", mapped(pair, [by](const Vec3i& v) { return Vec3i(v + by); }));
  list.emplace_back("scaled by two", mapped(pair, [](const Vec3i& v) { return Vec3i(2 * v); }));
  return list;
}

void require_same_answers(Kind a, Kind b, std::size_t count) {
  const std::uint64_t seed = sim::seed_from_environment();
  const auto engine = rtl(seed);
  stimulus::PairSource source(w - 2, seed, a, b);  // a quarter of the grid
  Random random(seed);
  const auto classes = stimulus::classes_of(a, b);
  std::vector<GridPair> pairs, changed;
  std::vector<PairMode> modes, changed_modes;
  std::vector<std::pair<const char*, std::size_t>> relation;  // and the index of the pair
  while (pairs.size() < count) {
    const GridPair pair = source.draw(classes[source.draw_class()].value);
    for (const auto& [name, variant] : variants(pair, random)) {
      relation.emplace_back(name, pairs.size());
      changed.push_back(variant);
      changed_modes.push_back(in_turn(random()));
    }
    pairs.push_back(pair);
    modes.push_back(in_turn(random()));
  }
  const auto answers = engine->run(pairs, modes);
  const auto changed_answers = engine->run(changed, changed_modes);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < changed.size(); ++i) {
    const auto [name, original] = relation[i];
    const bool grid = answers[original].grid;
    if (changed_answers[i].grid != grid || !changed_answers[i].definite) {
      FAIL(name << " changes the answer " << grid << " of " << to_text(pairs[original]));
    }
    hits += grid ? 1 : 0;
  }
  REQUIRE(hits > changed.size() / 10);
  REQUIRE(hits < 9 * changed.size() / 10);
}

}  // namespace

TEST_CASE("cchip_primtest_tri_tri: the answer does not depend on how the pair is written",
          "[unit][cchip_primtest_tri_tri]") {
  require_same_answers(Kind::tri, Kind::tri, 10000);
}

TEST_CASE("cchip_primtest_tri_quad: the answer does not depend on how the pair is written",
          "[unit][cchip_primtest_tri_quad]") {
  require_same_answers(Kind::tri, Kind::quad, 5000);
}

TEST_CASE("cchip_primtest_quad_quad: the answer does not depend on how the pair is written",
          "[unit][cchip_primtest_quad_quad]") {
  require_same_answers(Kind::quad, Kind::quad, 5000);
}
