// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cchip/internal/grid/coplanar.hpp>
#include <cchip/internal/wire/pair.hpp>
#include <cchip/primitive.hpp>

#include "random_pairs.hpp"

using namespace cchip_test;
using cchip::is_coplanar;
using cchip::is_degenerate;

namespace {

const GridPrimitive flat = make_triangle<GridPrimitive>({0, 0, 5}, {9, 0, 5}, {0, 9, 5});

}  // namespace

TEST_CASE("geometry: degenerate primitives", "[ref][geometry]") {
  CHECK_FALSE(is_degenerate(flat));
  CHECK(is_degenerate(make_triangle<GridPrimitive>({1, 2, 3}, {1, 2, 3}, {1, 2, 3})));
  CHECK(is_degenerate(make_triangle<GridPrimitive>({1, 2, 3}, {1, 2, 3}, {4, 5, 6})));
  CHECK(is_degenerate(make_triangle<GridPrimitive>({1, 2, 3}, {3, 4, 5}, {-9, -8, -7})));
  CHECK_FALSE(is_degenerate(make_triangle<GridPrimitive>({1, 2, 3}, {3, 4, 5}, {-9, -8, -6})));
  GridPrimitive quad = make_triangle<GridPrimitive>({0, 0, 0}, {1, 1, 1}, {3, 3, 3});
  quad.kind = Kind::quad;
  quad.v[3] = {7, 7, 7};
  CHECK(is_degenerate(quad));
  quad.v[3] = {7, 7, 8};
  CHECK_FALSE(is_degenerate(quad));
}

TEST_CASE("geometry: coplanar pairs", "[ref][geometry]") {
  CHECK(is_coplanar({flat, make_triangle<GridPrimitive>({-3, 4, 5}, {80, 1, 5}, {2, 2, 5}), 0}));
  CHECK_FALSE(is_coplanar({flat, make_triangle<GridPrimitive>({-3, 4, 5}, {80, 1, 5}, {2, 2, 6}), 0}));
  CHECK_FALSE(is_coplanar({flat, make_triangle<GridPrimitive>({0, 0, 6}, {9, 0, 6}, {0, 9, 6}), 0}));
  const GridPrimitive along_x = make_triangle<GridPrimitive>({0, 0, 0}, {1, 0, 0}, {3, 0, 0});
  CHECK(is_coplanar({flat, make_triangle<GridPrimitive>({1, 1, 5}, {2, 3, 5}, {1, 1, 5}), 0}));
  CHECK_FALSE(is_coplanar({flat, along_x, 0}));
  CHECK(is_coplanar({along_x, make_triangle<GridPrimitive>({0, 1, 2}, {5, 1, 2}, {9, 1, 2}), 0}));    // parallel lines
  CHECK(is_coplanar({along_x, make_triangle<GridPrimitive>({0, 1, 2}, {0, -1, -2}, {0, 2, 4}), 0}));  // crossing lines
  CHECK_FALSE(
      is_coplanar({along_x, make_triangle<GridPrimitive>({0, 1, 2}, {0, -1, -1}, {0, 3, 5}), 0}));  // skew lines
  CHECK(is_coplanar({along_x, make_triangle<GridPrimitive>({7, 8, 9}, {7, 8, 9}, {7, 8, 9}), 0}));
  CHECK(is_coplanar({make_triangle<GridPrimitive>({1, 1, 1}, {1, 1, 1}, {1, 1, 1}),
                     make_triangle<GridPrimitive>({7, 8, 9}, {7, 8, 9}, {7, 8, 9}), 0}));
}

TEST_CASE("geometry: one step off a plane at the ends of the widest range", "[ref][geometry]") {
  constexpr int lo = -(1 << 19);
  constexpr int hi = (1 << 19) - 1;
  const GridPrimitive a = make_triangle<GridPrimitive>({lo, lo, lo}, {hi, lo, hi}, {lo, hi, hi});  // z = x + y - lo
  CHECK(is_coplanar({a, make_triangle<GridPrimitive>({lo, lo, lo}, {0, lo, 0}, {lo, 0, 0}), 0}));
  CHECK_FALSE(is_coplanar({a, make_triangle<GridPrimitive>({lo, lo, lo}, {0, lo, 0}, {lo, 0, 1}), 0}));
  CHECK_FALSE(is_coplanar({a, make_triangle<GridPrimitive>({hi, hi, lo}, {hi, hi, lo}, {hi, hi, lo}), 0}));
  CHECK_FALSE(is_degenerate(make_triangle<GridPrimitive>({lo, lo, lo}, {hi, hi, hi}, {hi, hi, hi - 1})));
  CHECK(is_degenerate(make_triangle<GridPrimitive>({lo, lo, lo}, {hi, hi, hi}, {0, 0, 0})));
}

TEST_CASE("geometry: random pairs are of the class they were made for", "[ref][geometry]") {
  PairSource source(-1000, 1000);
  int general_coplanar = 0;
  for (int i = 0; i < 2000; ++i) {
    const GridPair coplanar = source.pair(PairClass::coplanar);
    if (!is_coplanar(coplanar)) FAIL(describe(coplanar));
    const GridPair degenerate = source.pair(PairClass::degenerate);
    if (!is_degenerate(degenerate.a) && !is_degenerate(degenerate.b)) FAIL(describe(degenerate));
    general_coplanar += is_coplanar(source.pair(PairClass::general));
  }
  CHECK(general_coplanar < 20);
}
