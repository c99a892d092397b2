// SPDX-License-Identifier: Apache-2.0
// Eigen reference = exact oracle = exact linear programming, on pairs of every class.
#include <catch2/catch.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/reference/eigen_sat.hpp>
#include <cchip/internal/wire/definitions.hpp>

#include "linear_programme.hpp"
#include "random_pairs.hpp"

using namespace cchip_test;

namespace {

/// Compares Eigen and exact and counts; the first disagreement is shown.
class Comparison {
 public:
  void add(const GridPair& pair, int coord_w) {
    const bool hit = cchip::exact_intersects(pair);
    ++pairs_;
    hits_ += hit;
    if (cchip::eigen_intersects(pair, coord_w) == hit) return;
    if (mismatches_++ == 0) UNSCOPED_INFO("exact says " << hit << ", Eigen differs: " << describe(pair));
  }
  void check(int pairs) const {
    INFO("pairs " << pairs_ << ", hits " << hits_);
    CHECK(mismatches_ == 0);
    CHECK(pairs_ == pairs);
    CHECK(hits_ > pairs_ / 100);  // both answers must occur
    CHECK(hits_ < pairs_ - pairs_ / 100);
  }

 private:
  int pairs_ = 0;
  int hits_ = 0;
  int mismatches_ = 0;
};

void compare(PairClass c, int range, int pairs) {
  PairSource source(-range, range, static_cast<std::uint64_t>(range) * 16 + static_cast<std::uint64_t>(c));
  Comparison comparison;
  for (int i = 0; i < pairs; ++i) comparison.add(source.pair(c), 16);
  INFO(name(c) << ", coordinates within " << range);
  comparison.check(pairs);
}

}  // namespace

TEST_CASE("agreement: general triangle pairs", "[ref][agreement]") {
  for (const int range : {1, 2, 7, 100, 32767}) compare(PairClass::general, range, 100000);
}

TEST_CASE("agreement: coplanar triangle pairs", "[ref][agreement]") {
  for (const int range : {4, 16, 1000, 32767}) compare(PairClass::coplanar, range, 50000);
}

TEST_CASE("agreement: degenerate triangle pairs", "[ref][agreement]") {
  for (const int range : {2, 4, 8}) compare(PairClass::degenerate, range, 50000);
}

TEST_CASE("agreement: touching and just missing triangle pairs", "[ref][agreement]") {
  for (const int range : {8, 100, 32767}) compare(PairClass::touching, range, 50000);
}

TEST_CASE("agreement: triangle pairs with shared vertices", "[ref][agreement]") {
  for (const int range : {2, 100, 32767}) {
    PairSource source(-range, range, static_cast<std::uint64_t>(range));
    for (int i = 0; i < 20000; ++i) {
      GridPair pair = source.pair(PairClass::general);
      pair.b.v[static_cast<std::size_t>(source.integer(0, 2))] =
          pair.a.v[static_cast<std::size_t>(source.integer(0, 2))];
      const bool all_hit = cchip::exact_intersects(pair) && cchip::eigen_intersects(pair, 16);
      if (!all_hit) FAIL("shares a vertex, yet does not intersect: " << describe(pair));
    }
    SUCCEED();
  }
}

TEST_CASE("agreement: every triangle pair of the 0..1 grid", "[ref][agreement]") {
  Comparison comparison;
  constexpr int points = 8;
  const auto point = [](int code) { return Vec3i(code & 1, code >> 1 & 1, code >> 2 & 1); };
  constexpr int pairs = points * points * points * points * points * points;
  for (int code = 0; code < pairs; ++code) {
    GridPair pair;
    for (int i = 0; i < 3; ++i) {
      pair.a.v[static_cast<std::size_t>(i)] = point(code >> (3 * i) & 7);
      pair.b.v[static_cast<std::size_t>(i)] = point(code >> (3 * i + 9) & 7);
    }
    comparison.add(pair, 4);
  }
  comparison.check(pairs);
}

TEST_CASE("agreement: chosen triangles with every triangle of the -1..1 grid", "[ref][agreement]") {
  PairSource source(-1, 1, 77);
  Comparison comparison;
  constexpr int chosen = 16;
  constexpr int triangles = 27 * 27 * 27;
  const auto point = [](int code) { return Vec3i(code % 3 - 1, code / 3 % 3 - 1, code / 9 % 3 - 1); };
  for (int i = 0; i < chosen; ++i) {
    GridPair pair{source.primitive(Kind::tri), {}, 0};
    for (int code = 0; code < triangles; ++code) {
      pair.b.v = {point(code % 27), point(code / 27 % 27), point(code / 729), Vec3i::Zero()};
      comparison.add(pair, 4);
    }
  }
  comparison.check(chosen * triangles);
}

TEST_CASE("agreement: every coordinate width, corners of the range", "[ref][agreement]") {
  for (int w = cchip::defs::coord_w_min; w <= cchip::defs::coord_w_max; ++w) {
    INFO("coord_w " << w);
    const int lo = -(1 << (w - 1));
    const int hi = -lo - 1;
    PairSource source(lo, hi, static_cast<std::uint64_t>(w));
    Comparison comparison;
    constexpr int pairs = 6000;
    for (int i = 0; i < pairs; ++i) {
      GridPair pair = source.pair(PairClass::general);
      for (GridPrimitive* p : {&pair.a, &pair.b}) {
        for (Vec3i& v : p->v) {
          for (int& c : v) {  // most coordinates at, or one step from, an end of the range
            if (i % 3 != 0 && source.integer(0, 3) != 0)
              c = source.coin() ? lo + source.integer(0, 1) : hi - source.integer(0, 1);
          }
        }
      }
      comparison.add(pair, w);
    }
    comparison.check(pairs);
  }
}

TEST_CASE("agreement: pairs with quads", "[ref][agreement]") {
  const Kind kinds[] = {Kind::tri, Kind::quad};
  for (const Kind kind_a : kinds) {
    for (const PairClass c : {PairClass::general, PairClass::coplanar, PairClass::degenerate, PairClass::touching}) {
      for (const int range : {4, 100, 32767}) {
        if (c == PairClass::degenerate && range > 4) continue;  // hits are too rare there
        INFO(name(c) << ", vertices of A " << static_cast<int>(kind_a) << ", range " << range);
        PairSource source(-range, range, static_cast<std::uint64_t>(range) + 5);
        Comparison comparison;
        constexpr int pairs = 4000;
        for (int i = 0; i < pairs; ++i) comparison.add(source.pair(c, kind_a, Kind::quad), 16);
        comparison.check(pairs);
      }
    }
  }
}

TEST_CASE("agreement: a tetrahedron around a triangle and around a tetrahedron", "[ref][agreement]") {
  GridPair pair;
  pair.a.kind = Kind::quad;
  pair.a.v = {Vec3i(0, 0, 0), Vec3i(100, 0, 0), Vec3i(0, 100, 0), Vec3i(0, 0, 100)};
  pair.b.v = {Vec3i(10, 10, 10), Vec3i(20, 10, 10), Vec3i(10, 20, 12), Vec3i(10, 10, 20)};
  for (const Kind kind : {Kind::tri, Kind::quad}) {
    pair.b.kind = kind;
    for (const GridPair& p : {pair, GridPair{pair.b, pair.a, 0}}) {
      CHECK(cchip::exact_intersects(p));
      CHECK(cchip::eigen_intersects(p, 8));
    }
  }
}

TEST_CASE("agreement: exact linear programming", "[ref][agreement]") {
  for (const Kind kind_a : {Kind::tri, Kind::quad}) {
    for (const PairClass c : pair_classes) {
      for (const int range : {1, 3, 40, 32767}) {
        PairSource source(-range, range, 1000 + static_cast<std::uint64_t>(range));
        for (int i = 0; i < 150; ++i) {
          const GridPair pair = source.pair(c, kind_a, i % 2 == 0 ? Kind::tri : Kind::quad);
          const bool hit = linear_programme_intersects(pair.a, pair.b);
          if (cchip::exact_intersects(pair) != hit) FAIL("linear programming says " << hit << ": " << describe(pair));
        }
        SUCCEED();
      }
    }
  }
}

TEST_CASE("Eigen reference: refuses a width it is not exact for", "[ref][agreement]") {
  CHECK_THROWS_AS(cchip::eigen_intersects(GridPair{}, 3), std::invalid_argument);
  CHECK_THROWS_AS(cchip::eigen_intersects(GridPair{}, 21), std::invalid_argument);
}
