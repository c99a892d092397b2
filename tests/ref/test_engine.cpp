// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cchip/internal/driver/pair_engine.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/reference/eigen_sat.hpp>
#include <cchip/internal/wire/axis.hpp>
#include <map>
#include <set>
#include <string>

#include "random_pairs.hpp"

using namespace cchip_test;
using cchip::AxisClass;
using cchip::to_symbol;
using cchip::to_words;

namespace {

std::unique_ptr<cchip::PairEngine> make_eigen_engine(int coord_w) {
  return cchip::make_function_engine(
      "eigen", coord_w, [coord_w](const GridPair& pair) { return cchip::eigen_intersects(pair, coord_w); });
}

}  // namespace

TEST_CASE("engine: eigen and exact answer batches in order", "[ref][engine]") {
  PairSource source(-100, 100);
  std::vector<GridPair> pairs;
  for (int i = 0; i < 500; ++i) {
    pairs.push_back(source.pair(PairClass::general));
    pairs.back().eta = i % 3;
  }
  for (const auto& engine : {make_eigen_engine(8), cchip::make_exact_engine(8)}) {
    INFO(engine->name());
    CHECK(engine->coord_w() == 8);
    CHECK(engine->run({}, cchip::PairMode::directed).empty());
    const std::vector<cchip::EngineAnswer> answers = engine->run(pairs, cchip::PairMode::exhaustive);
    REQUIRE(answers.size() == pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      INFO(describe(pairs[i]));
      REQUIRE(answers[i].grid == cchip::exact_intersects(pairs[i]));
      REQUIRE(answers[i].definite == (pairs[i].eta == 0));
      REQUIRE_FALSE(answers[i].clocks.has_value());
    }
    CHECK(engine->statistics().clocks == 0);
  }
  CHECK(make_eigen_engine(8)->name() == std::string("eigen"));
  CHECK(cchip::make_exact_engine(8)->name() == std::string("exact"));
}

TEST_CASE("engine: refuses widths outside 4..20", "[ref][engine]") {
  CHECK_THROWS_AS(make_eigen_engine(3), std::invalid_argument);
  CHECK_THROWS_AS(cchip::make_exact_engine(21), std::invalid_argument);
}

TEST_CASE("engine: witness axes in words", "[ref][engine]") {
  CHECK(to_words({AxisClass::none, 0, 0}) == "none");
  CHECK(to_words({AxisClass::normal_a, 0, 0}) == "normal of A");
  CHECK(to_words({AxisClass::normal_b, 0, 0}) == "normal of B");
  CHECK(to_words({AxisClass::normal_b, 3, 0}) == "normal of face 2 of B");  // the face without vertex 2
  CHECK(to_words({AxisClass::cross, 0, 2}) == "edge 0 of A x edge 2 of B");
  CHECK(to_words({AxisClass::cross, 4, 5}) == "diagonal V0V2 of A x diagonal V1V3 of B");
  CHECK(to_words({AxisClass::in_plane_a, 1, 1}) == "edge 1 of A x direction y");
  CHECK(to_words({AxisClass::in_plane_b, 2, 0}) == "edge 2 of B x direction x");
  CHECK(to_words({AxisClass::box, 0, 2}) == "box z");
  CHECK(to_words({AxisClass::illegal, 0, 0}) == "illegal request");
}

TEST_CASE("engine: witness axes in a few letters", "[ref][engine]") {
  CHECK(to_symbol({AxisClass::normal_a, 0, 0}) == "normal A");
  CHECK(to_symbol({AxisClass::normal_b, 3, 0}) == "face B2");
  CHECK(to_symbol({AxisClass::cross, 4, 2}) == "e4 x f2");
  CHECK(to_symbol({AxisClass::in_plane_a, 1, 1}) == "e1 x uy");
  CHECK(to_symbol({AxisClass::in_plane_b, 2, 0}) == "f2 x ux");
  CHECK(to_symbol({AxisClass::box, 0, 2}) == "box z");
  // Two codes share a symbol exactly if they share their words.
  std::map<std::string, std::string> words;
  std::set<std::string> different;
  for (std::uint16_t code = 0; code < 1 << cchip::defs::axis_code_w; ++code) {
    const cchip::AxisCode axis = cchip::axis_code_from_bits(code);
    CAPTURE(code);
    CHECK(words.emplace(to_symbol(axis), to_words(axis)).first->second == to_words(axis));
    different.insert(to_words(axis));
  }
  CHECK(words.size() == different.size());
}
