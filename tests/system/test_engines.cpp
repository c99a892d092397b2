// SPDX-License-Identifier: Apache-2.0
// The dispatcher over the three modules, with the model and the RTL behind it.
#include <catch2/catch.hpp>
#include <cchip/internal/grid/canonical.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/stimulus/witness.hpp>
#include <map>
#include <random>

#include "engines.hpp"

using namespace cchip;
using namespace cchip::app;

namespace {

class Source {
 public:
  explicit Source(std::uint64_t stream) : random_(sim::seed_from_environment() * 1000003 + stream) {}
  int integer(int least, int greatest) { return std::uniform_int_distribution<int>(least, greatest)(random_); }

  /// Any kinds; from small grids, so that coplanar, degenerate, self-crossing and dented ones abound.
  GridPair pair() {
    const int limit = integer(1, 4) == 1 ? 1000 : integer(1, 4);
    GridPair result{primitive(limit), primitive(limit), integer(0, 15)};
    if (integer(0, 2) == 0) {
      const int d = integer(0, 2);
      for (Vec3i& v : result.a.v) v[d] = 0;
      if (integer(0, 1) == 0) {
        for (Vec3i& v : result.b.v) v[d] = 0;
      }
    }
    if (integer(0, 1) == 0) {  // beside each other
      const int d = integer(0, 2);
      for (Vec3i& v : result.b.v) v[d] += limit;
    }
    return result;
  }

 private:
  GridPrimitive primitive(int limit) {
    GridPrimitive p;
    p.kind = integer(0, 1) == 0 ? Kind::tri : Kind::quad;
    for (Vec3i& v : p.v) v = {integer(-limit, limit), integer(-limit, limit), integer(-limit, limit)};
    return p;
  }
  std::mt19937_64 random_;
};

std::unique_ptr<PairEngine> engine_of(EngineKind kind) {
  EngineOptions options;
  options.kind = kind;
  return make_engine(options);
}

}  // namespace

TEST_CASE("engines: any kinds and modes mixed: exact, every no with a witness in the caller's terms",
          "[system][engines]") {
  const EngineKind kind = GENERATE(EngineKind::model, EngineKind::rtl);
  Source source(1);
  std::vector<GridPair> pairs;
  std::vector<PairMode> modes;
  for (int i = 0; i < 20000; ++i) {
    pairs.push_back(source.pair());
    modes.push_back(source.integer(0, 1) == 0 ? PairMode::exhaustive : PairMode::directed);
  }
  const auto answers = engine_of(kind)->run(pairs, modes);
  REQUIRE(answers.size() == pairs.size());
  std::size_t not_canonical = 0;
  std::size_t hits = 0;
  std::map<AxisClass, std::size_t> witnesses;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    CAPTURE(i, static_cast<int>(modes[i]));
    REQUIRE(answers[i].grid == exact_intersects(pairs[i]));
    if (pairs[i].eta == 0) REQUIRE(answers[i].definite);
    CAPTURE(to_words(answers[i].axis));
    if (answers[i].grid) REQUIRE(answers[i].axis.cls == AxisClass::none);
    if (!answers[i].grid) REQUIRE(stimulus::witness_separates(answers[i].axis, pairs[i]));
    ++witnesses[answers[i].axis.cls];
    hits += answers[i].grid;
    not_canonical += !is_canonical(pairs[i].a) || !is_canonical(pairs[i].b);
  }
  CHECK(hits > 1000);
  CHECK(not_canonical > 1000);
  for (const AxisClass cls : {AxisClass::normal_a, AxisClass::normal_b, AxisClass::cross, AxisClass::in_plane_a,
                              AxisClass::in_plane_b, AxisClass::box}) {
    CHECK(witnesses[cls] > 10);
  }
}

TEST_CASE("engines: RTL and its model agree in every field, batch after batch", "[system][engines]") {
  Source source(2);
  const auto rtl = engine_of(EngineKind::rtl);
  const auto model = engine_of(EngineKind::model);
  for (const int size : {1, 0, 500, 3000}) {
    std::vector<GridPair> pairs;
    std::vector<PairMode> modes;
    for (int i = 0; i < size; ++i) {
      pairs.push_back(source.pair());
      modes.push_back(source.integer(0, 1) == 0 ? PairMode::exhaustive : PairMode::directed);
    }
    const auto from_rtl = rtl->run(pairs, modes);
    const auto from_model = model->run(pairs, modes);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      CAPTURE(i);
      const PairResult& x = from_rtl[i];
      const PairResult& y = from_model[i];
      REQUIRE(x == y);
      REQUIRE(from_rtl[i].clocks->accepted == from_model[i].clocks->accepted);
      REQUIRE(from_rtl[i].clocks->answered == from_model[i].clocks->answered);
    }
    CHECK(rtl->statistics().clocks == model->statistics().clocks);
    CHECK(rtl->statistics().beats == model->statistics().beats);
    CHECK(rtl->statistics().waiting_clocks == model->statistics().waiting_clocks);
  }
}

TEST_CASE("engines: statistics are sums over the modules", "[system][engines]") {
  Source source(3);
  std::vector<GridPair> pairs;
  pairs.reserve(3000);
  for (int i = 0; i < 3000; ++i) pairs.push_back(source.pair());
  const auto engine = engine_of(EngineKind::model);
  const auto answers = engine->run(pairs, PairMode::directed);
  std::uint64_t beats = 0;
  for (const EngineAnswer& answer : answers) beats += static_cast<std::uint64_t>(answer.beats);
  CHECK(engine->statistics().beats == beats);
  CHECK(engine->statistics().waiting_clocks >= beats);
  CHECK(engine->statistics().clocks > beats);
}
