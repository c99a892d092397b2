// SPDX-License-Identifier: Apache-2.0
// The sphere of a point and a triangle: the seven axes decide exactly what the distance decides.
#include <catch2/catch.hpp>
#include <cchip/program/seed.hpp>
#include <iostream>
#include <map>

#include "point_triangle_source.hpp"

using namespace cchip_test;

namespace {

struct Tally {
  std::uint64_t pairs = 0;
  std::uint64_t wrong = 0;
  std::uint64_t apart = 0;
  std::map<Region, std::uint64_t> touching;  // the distance is the radius
};

template <class Int>
void judge(Tally& tally, const IntTriangle& t, const Nearest<Int>& nearest, std::int64_t radius) {
  const int order = compare(nearest.square, radius);
  const bool separated = first_axis<Int>(t, radius).has_value();
  ++tally.pairs;
  tally.wrong += separated != (order > 0) ? 1 : 0;
  tally.apart += separated ? 1 : 0;
  if (order == 0) ++tally.touching[nearest.region];
}

void print(const char* what, const Tally& t) {
  std::cout << "point_triangle " << what << ": pairs=" << t.pairs << " wrong=" << t.wrong << " apart=" << t.apart;
  for (const auto& [region, count] : t.touching) {
    std::cout << " touching_"
              << (region == Region::vertex ? "vertex"
                  : region == Region::side ? "side"
                                           : "face")
              << '=' << count;
  }
  std::cout << std::endl;
}

}  // namespace

TEST_CASE("point and triangle: distance and seven axes agree on every triangle of a small grid", "[ref][point]") {
  // Relative to the point; every shape, degenerate ones included. The greatest distance is the root of 12.
  Tally tally;
  constexpr int reach = 2;
  constexpr int side = 2 * reach + 1;
  constexpr int points = side * side * side;
  const auto point = [](int n) {
    return std::array<std::int64_t, 3>{n % side - reach, n / side % side - reach, n / side / side - reach};
  };
  for (int i = 0; i < points; ++i) {
    for (int j = 0; j < points; ++j) {
      for (int k = 0; k < points; ++k) {
        const IntTriangle t = {point(i), point(j), point(k)};
        const auto near = nearest<std::int64_t>(t);
        for (std::int64_t radius = 0; radius <= 4; ++radius) judge<std::int64_t>(tally, t, near, radius);
      }
    }
  }
  print("small grid", tally);
  REQUIRE(tally.pairs == std::uint64_t{5} * points * points * points);
  REQUIRE(tally.wrong == 0);
  for (const Region region : {Region::vertex, Region::side, Region::face}) REQUIRE(tally.touching[region] > 100);
}

TEST_CASE("point and triangle: distance and seven axes agree on the whole grid", "[ref][point]") {
  Tally tally;
  PointTriangleSource source(16, cchip::sim::seed_from_environment());
  for (int i = 0; i < 1000000; ++i) {
    const auto pair = source.draw();
    const IntTriangle t = pair.relative();
    judge<Int256>(tally, t, nearest<Int256>(t), pair.radius);
  }
  print("whole grid", tally);
  REQUIRE(tally.wrong == 0);
  REQUIRE(tally.apart > tally.pairs / 5);
  REQUIRE(tally.apart < tally.pairs / 5 * 4);
  for (const Region region : {Region::vertex, Region::side, Region::face}) REQUIRE(tally.touching[region] > 1000);
}
