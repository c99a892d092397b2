// SPDX-License-Identifier: Apache-2.0
// The exact oracle on doubles of any magnitude.
#include <catch2/catch.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cmath>
#include <limits>

#include "linear_programme.hpp"
#include "random_pairs.hpp"

using namespace cchip_test;
using cchip::exact_intersects;
using cchip::Primitive;
using cchip::Vec3d;

TEST_CASE("exact doubles: grid pairs at every magnitude", "[ref][exact_doubles]") {
  for (const PairClass c : pair_classes) {
    PairSource source(-200, 200, static_cast<std::uint64_t>(c));
    for (int i = 0; i < 1000; ++i) {
      const GridPair pair = source.pair(c, Kind::tri, i % 4 == 0 ? Kind::quad : Kind::tri);
      const int exponent = source.integer(-1074, 1015);
      if (exact_intersects(scaled(pair.a, exponent), scaled(pair.b, exponent)) != exact_intersects(pair)) {
        FAIL("times 2^" << exponent << ": " << describe(pair));
      }
    }
    SUCCEED();
  }
}

TEST_CASE("exact doubles: coordinates of unlike magnitudes agree with linear programming", "[ref][exact_doubles]") {
  PairSource source(-1, 1, 3);
  const auto coordinate = [&source] { return std::ldexp(source.integer(-9999999, 9999999), source.integer(-60, 10)); };
  int hits = 0;
  for (int i = 0; i < 600; ++i) {
    Primitive a;
    Primitive b;
    for (Primitive* p : {&a, &b}) {
      for (Vec3d& v : p->v) v = Vec3d(coordinate(), coordinate(), coordinate());
    }
    if (i % 2 == 0) b.v[0] = (a.v[0] + a.v[1]) / 2;  // rounded, so next to the edge rather than on it
    const bool hit = exact_intersects(a, b);
    hits += hit;
    if (hit != linear_programme_intersects(a, b)) FAIL("pair " << i << ", seed " << seed());
  }
  CHECK(hits > 30);
  CHECK(hits < 570);
}

TEST_CASE("exact doubles: one unit in the last place decides", "[ref][exact_doubles]") {
  const Primitive floor = make_triangle<Primitive>({0, 0, 0.1}, {1, 0, 0.1}, {0, 1, 0.1});
  const double above = std::nextafter(0.1, 1.0);
  CHECK(exact_intersects(floor, make_triangle<Primitive>({0.25, 0.25, 0.1}, {0.25, 0.5, 1}, {0.5, 0.25, 1})));
  CHECK_FALSE(exact_intersects(floor, make_triangle<Primitive>({0.25, 0.25, above}, {0.25, 0.5, 1}, {0.5, 0.25, 1})));
  // 0.1 + 0.2 > 0.3 in exact arithmetic on the doubles, 0.3 < 1 - 0.7.
  const Primitive slope = make_triangle<Primitive>({0.3, 0, -1}, {0.3, 0, 1}, {0.3, 1, 0});
  CHECK(exact_intersects(slope, make_triangle<Primitive>({0.1, 0, 0}, {0.1 + 0.2, 0, 0}, {0.1, -1, 0})));
  CHECK_FALSE(
      exact_intersects(slope, make_triangle<Primitive>({0.1, 0, 0}, {std::nextafter(0.3, 0.0), 0, 0}, {0.1, -1, 0})));
}

TEST_CASE("exact doubles: smallest and largest numbers", "[ref][exact_doubles]") {
  const double tiny = std::numeric_limits<double>::denorm_min();
  const double huge = std::numeric_limits<double>::max();
  const Primitive big = make_triangle<Primitive>({-huge, -huge, 0}, {huge, -huge, 0}, {0, huge, 0});
  CHECK(exact_intersects(big, make_triangle<Primitive>({0, 0, 0}, {0, 1, huge}, {1, 0, huge})));
  CHECK_FALSE(exact_intersects(big, make_triangle<Primitive>({0, 0, tiny}, {0, 1, huge}, {1, 0, huge})));
  CHECK(exact_intersects(big, make_triangle<Primitive>({0, 0, tiny}, {0, tiny, -tiny}, {tiny, 0, -tiny})));
  CHECK_FALSE(exact_intersects(make_triangle<Primitive>({0, 0, 0}, {0, 0, 0}, {0, 0, 0}),
                               make_triangle<Primitive>({tiny, 0, 0}, {huge, 0, 0}, {1, 0, 0})));
}

TEST_CASE("exact doubles: zeros only, and minus zero", "[ref][exact_doubles]") {
  const Primitive origin = make_triangle<Primitive>(Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero());
  CHECK(exact_intersects(origin, make_triangle<Primitive>({-0.0, 0, -0.0}, {0, -0.0, 0}, {0, 0, 0})));
}

TEST_CASE("exact doubles: refuses what is not a number", "[ref][exact_doubles]") {
  const Primitive fine = make_triangle<Primitive>({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Primitive broken = make_triangle<Primitive>({0, 0, 0}, {1, bad, 0}, {0, 1, 0});
    CHECK_THROWS_AS(exact_intersects(fine, broken), std::invalid_argument);
    CHECK_THROWS_AS(exact_intersects(broken, fine), std::invalid_argument);
  }
}
