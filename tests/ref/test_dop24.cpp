// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cchip/bvh/dop24.hpp>
#include <cchip/exact/oracle.hpp>
#include <cstdlib>
#include <limits>
#include <random>

using namespace cchip;

namespace {

std::uint64_t seed() {
  const char* text = std::getenv("CCHIP_SEED");
  const std::uint64_t value = text != nullptr ? std::strtoull(text, nullptr, 10) : 1;
  UNSCOPED_INFO("CCHIP_SEED=" << value);
  return value;
}

Primitive random_primitive(std::mt19937_64& random, double range, const Vec3d& centre) {
  std::uniform_real_distribution<double> coordinate(-range, range);
  Primitive p;
  p.kind = random() % 2 == 0 ? Kind::tri : Kind::quad;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    p.v[i] = centre + Vec3d(coordinate(random), coordinate(random), coordinate(random));
  }
  return p;
}

}  // namespace

TEST_CASE("dop24: every vertex is inside, also where the sums round", "[ref]") {
  std::mt19937_64 random(seed());
  std::uniform_int_distribution<int> bits(1, 53);
  std::uniform_int_distribution<int> shift(0, 8);
  int rounded = 0;
  for (int n = 0; n < 20000; ++n) {
    Primitive p;
    std::array<std::array<std::int64_t, 3>, 3> exact{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t d = 0; d < 3; ++d) {
        const auto mantissa = static_cast<std::int64_t>(random() >> (64 - bits(random)));
        const std::int64_t c = (random() % 2 == 0 ? mantissa : -mantissa) * (std::int64_t{1} << shift(random));
        exact[i][d] = c;
        p.v[i][static_cast<Eigen::Index>(d)] = static_cast<double>(c);
      }
    }
    const Dop24 dop = make_dop24(p);
    for (std::size_t d = 0; d < dop24_directions.size(); ++d) {
      for (const auto& v : exact) {
        std::int64_t position = 0;
        for (std::size_t k = 0; k < 3; ++k) position += dop24_directions[d][k] * v[k];
        // long double holds 64 bits, so these comparisons are exact
        static_assert(std::numeric_limits<long double>::digits >= 64, "needs 64-bit mantissas");
        REQUIRE(static_cast<long double>(dop.least[d]) <= static_cast<long double>(position));
        REQUIRE(static_cast<long double>(dop.greatest[d]) >= static_cast<long double>(position));
        rounded += static_cast<std::int64_t>(static_cast<double>(position)) != position ? 1 : 0;
      }
    }
  }
  REQUIRE(rounded > 1000);
}

TEST_CASE("dop24: primitives that meet overlap, whatever their scale", "[ref]") {
  std::mt19937_64 random(seed());
  int hits = 0;
  int apart = 0;
  for (int n = 0; n < 20000; ++n) {
    const double range = std::ldexp(1.0, static_cast<int>(random() % 80) - 40);
    const Vec3d centre = Vec3d(1e3, -2e3, 3e3) * (random() % 2 == 0 ? 0.0 : 1.0);
    const Primitive p = random_primitive(random, range, centre);
    Primitive q = random_primitive(random, range, centre);
    if (random() % 2 == 0) q.v[1] = p.v[2];  // they touch
    const bool hit = exact_intersects(p, q);
    const bool found = overlap(make_dop24(p), make_dop24(q));
    if (hit) REQUIRE(found);
    hits += hit ? 1 : 0;
    apart += found ? 0 : 1;
  }
  REQUIRE(hits > 5000);
  REQUIRE(apart > 1000);
}

TEST_CASE("dop24: each of the 12 directions separates", "[ref]") {
  for (std::size_t d = 0; d < dop24_directions.size(); ++d) {
    const Vec3d n(dop24_directions[d][0], dop24_directions[d][1], dop24_directions[d][2]);
    const Vec3d u = n.unitOrthogonal();
    const Vec3d v = n.cross(u).normalized();
    // two large triangles in parallel planes, a little apart: only their normal tells them apart
    Primitive p;
    p.v = {10 * u, -5 * u + 8 * v, -5 * u - 8 * v, Vec3d::Zero()};
    Primitive q = p;
    for (Vec3d& x : q.v) x += 0.01 * n;
    INFO("direction " << n.transpose());
    REQUIRE_FALSE(overlap(make_dop24(p), make_dop24(q)));
    REQUIRE_FALSE(overlap(make_dop24(q), make_dop24(p)));
    REQUIRE(overlap(make_dop24(p), make_dop24(p)));
    Dop24 without = make_dop24(q);
    without.least[d] = make_dop24(p).least[d];
    REQUIRE(overlap(make_dop24(p), without));
  }
}

TEST_CASE("dop24: an overflow never separates", "[ref]") {
  const double huge = std::numeric_limits<double>::max();
  Primitive p;
  p.v = {Vec3d(huge, huge, huge), Vec3d(huge, huge, 0), Vec3d(0, 0, 0), Vec3d::Zero()};
  Primitive q;
  q.v = {Vec3d(0, 0, 0), Vec3d(huge, 0, huge), Vec3d(huge, huge, huge), Vec3d::Zero()};
  REQUIRE(overlap(make_dop24(p), make_dop24(q)));
}
