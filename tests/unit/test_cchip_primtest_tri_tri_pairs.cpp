// SPDX-License-Identifier: Apache-2.0
// A million pairs through the default configuration, and relations between the answers of related pairs.
#include <cchip/eigen_reference.hpp>
#include <cchip/rtl_engine.hpp>
#include <iostream>

#include "../campaign/pair_source.hpp"
#include "pair_tools.hpp"

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
  std::uint64_t special = 0;
  std::uint64_t open = 0;  ///< special, disjoint and not separated by the eleven axes
};

/// The RTL's answer against the functional model (every field), the witness against the vertices, and both
/// references against it where it must be right.
void judge(const GridPair& pair, const EngineAnswer& answer, Counts& counts) {
  const HardwareAnswer& got = answer.hardware.value();
  const model::Outcome model = model::exhaustive(pair, w);
  const bool definite = pair.eta == 0 && !(model.special && model.grid);
  const bool same = got.grid == model.grid && got.axis == model.witness && got.beats == model.beats &&
                    got.definite == definite && got.hit == (model.grid || !definite);
  if (!same) FAIL("RTL differs from the model: " << describe(pair));
  if (!got.grid && !axis_separates(got.axis, pair)) FAIL("the witness does not separate: " << describe(pair));
  const bool exact = exact_intersects(pair);
  if (eigen_intersects(pair, w) != exact) FAIL("Eigen reference differs from the exact oracle: " << describe(pair));
  const bool special = is_special(pair);
  if (special != model.special) FAIL("special is not coplanar or degenerate: " << describe(pair));
  if (got.grid != exact && (!special || !got.grid)) FAIL("wrong answer: " << describe(pair));
  ++counts.pairs;
  counts.hits += exact ? 1 : 0;
  counts.special += special ? 1 : 0;
  counts.open += special && got.grid && !exact ? 1 : 0;
}

}  // namespace

TEST_CASE("cchip_primtest_tri_tri: a million pairs, RTL and model and both references agree",
          "[unit][cchip_primtest_tri_tri]") {
  const std::uint64_t seed = sim::seed_from_environment();
  const auto engine = rtl(seed);
  campaign::PairSource source(w, seed);
  Random random(seed);
  std::array<Counts, campaign::pair_classes.size()> table;
  constexpr std::size_t batch = 50000;
  for (int part = 0; part < 20; ++part) {
    std::vector<GridPair> pairs;
    std::vector<std::size_t> classes;
    for (std::size_t i = 0; i < batch; ++i) {
      classes.push_back(source.draw_class());
      pairs.push_back(source.draw(campaign::pair_classes[classes.back()].value));
      pairs.back().eta = chance(random, 80) ? 0 : static_cast<int>(random() % 16);
    }
    const auto answers = engine->run(pairs, PairMode::exhaustive);
    REQUIRE(answers.size() == batch);
    for (std::size_t i = 0; i < batch; ++i) judge(pairs[i], answers[i], table[classes[i]]);
  }
  Counts sum;
  for (std::size_t c = 0; c < table.size(); ++c) {
    const Counts& t = table[c];
    std::cout << campaign::pair_classes[c].name << ": pairs=" << t.pairs << " hits=" << t.hits
              << " special=" << t.special << " open=" << t.open << '\n';
    REQUIRE(t.pairs > 10000);
    sum.pairs += t.pairs;
    sum.hits += t.hits;
    sum.special += t.special;
    sum.open += t.open;
  }
  std::cout << "pairs=" << sum.pairs << " hits=" << sum.hits << " special=" << sum.special << " open=" << sum.open
            << " mismatches=0 clocks=" << engine->statistics().clocks << '\n';
  REQUIRE(sum.pairs == 20 * batch);
  REQUIRE(sum.hits > sum.pairs / 10);
  REQUIRE(sum.hits < 9 * sum.pairs / 10);
  REQUIRE(engine->statistics().beats == 11 * sum.pairs);
}

namespace {

/// The same pair written in another way; `change` maps points.
template <class Change>
GridPair mapped(const GridPair& pair, Change change) {
  GridPair result = pair;
  for (GridPrimitive* p : {&result.a, &result.b}) {
    for (std::size_t i = 0; i < 3; ++i) p->v[i] = change(p->v[i]);
  }
  return result;
}

/// Nine ways; coordinates of the pair must lie within a quarter of the grid.
std::vector<std::pair<const char*, GridPair>> variants(const GridPair& pair, Random& random) {
  std::vector<std::pair<const char*, GridPair>> list;
  list.emplace_back("swapped", GridPair{pair.b, pair.a, 0});
  for (const int first : {1, 2}) {
    GridPair turned = pair;
    std::rotate(turned.a.v.begin(), turned.a.v.begin() + first, turned.a.v.begin() + 3);
    list.emplace_back("vertices of A rotated", turned);
  }
  GridPair reversed = pair;
  std::swap(reversed.a.v[1], reversed.a.v[2]);
  std::swap(reversed.b.v[0], reversed.b.v[1]);
  list.emplace_back("vertices exchanged", reversed);
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

}  // namespace

TEST_CASE("cchip_primtest_tri_tri: the answer does not depend on how the pair is written",
          "[unit][cchip_primtest_tri_tri]") {
  const std::uint64_t seed = sim::seed_from_environment();
  const auto engine = rtl(seed);
  campaign::PairSource source(w - 2, seed);  // a quarter of the grid
  Random random(seed);
  std::vector<GridPair> pairs;
  std::vector<GridPair> changed;
  std::vector<std::pair<const char*, std::size_t>> relation;  // and the index of the pair
  while (pairs.size() < 20000) {
    const GridPair pair = source.draw(campaign::pair_classes[source.draw_class()].value);
    if (is_special(pair)) continue;
    for (const auto& [name, variant] : variants(pair, random)) {
      relation.emplace_back(name, pairs.size());
      changed.push_back(variant);
    }
    pairs.push_back(pair);
  }
  const auto answers = engine->run(pairs, PairMode::exhaustive);
  const auto changed_answers = engine->run(changed, PairMode::exhaustive);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < changed.size(); ++i) {
    const auto [name, original] = relation[i];
    const bool grid = answers[original].grid;
    if (changed_answers[i].grid != grid || !changed_answers[i].definite) {
      FAIL(name << " changes the answer " << grid << " of " << describe(pairs[original]));
    }
    hits += grid ? 1 : 0;
  }
  REQUIRE(changed.size() == 9 * pairs.size());
  REQUIRE(hits > changed.size() / 10);
  REQUIRE(hits < 9 * changed.size() / 10);
}
