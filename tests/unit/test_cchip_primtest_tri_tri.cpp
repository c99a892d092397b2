// SPDX-License-Identifier: Apache-2.0
#include <Vtt_w16_s10_rel___024root.h>
#include <Vtt_w16_s12_abs___024root.h>
#include <Vtt_w16_s8_abs___024root.h>

#include <cchip/stimulus/witness.hpp>
#include <models/cchip_primtest_tri_tri.hpp>

#include "primtest_bench.hpp"

CCHIP_WATCH(tt_w16_s8_abs);
CCHIP_WATCH(tt_w16_s10_rel);
CCHIP_WATCH(tt_w16_s12_abs);

using namespace cchip;
using namespace cchip::test;

CCHIP_PRIMTEST_CASES(tri_tri)

TEMPLATE_TEST_CASE("cchip_primtest_tri_tri: an axis on 99 % of the clocks while pairs wait",
                   "[unit][cchip_primtest_tri_tri]", tt_w16_s8_abs, tt_w16_s10_rel, tt_w16_s12_abs) {
  check_throughput(primtest_config<TestType>(ModuleId::tri_tri));
}

namespace {

/// Directed pairs whose answer is known by construction: `gap` < 0 deep, 0 touching, > 0 missed by that many steps.
struct KnownPair {
  GridPair pair;
  int gap;
};

GridPair with_axes(const GridPair& pair, int first, int sign) {
  GridPair result = pair;
  for (auto [from, to] : {std::pair(&pair.a, &result.a), std::pair(&pair.b, &result.b)}) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (int d = 0; d < 3; ++d) to->v[i][(d + first) % 3] = d == 2 ? sign * from->v[i][d] : from->v[i][d];
    }
  }
  return result;
}

/// A in the plane z = 0; B above it, its lowest point at height `gap` over the inside, a side or a corner of A.
std::vector<KnownPair> touching_pairs(int coord_w) {
  const int r = (1 << (coord_w - 1)) - 4;  // nearly the whole grid
  const auto tri = [](const Vec3i& p, const Vec3i& q, const Vec3i& s) {
    GridPrimitive t;
    t.v = {p, q, s, Vec3i::Zero()};
    return t;
  };
  std::vector<KnownPair> list;
  for (const int gap : {-2, -1, 0, 1, 2}) {
    const GridPrimitive floor = tri({-r, -r, 0}, {r, -r, 0}, {0, r, 0});
    const int top = r / 2 + gap;
    const std::vector<GridPair> shapes = {
        {floor, tri({0, 0, gap}, {r, r / 3, top}, {-r / 2, r, top}), 0},  // vertex over the face
        {floor, tri({0, -r, gap}, {1, -r, top}, {r, -r + 2, top}), 0},    // vertex over a side
        {floor, tri({0, r, gap}, {2, r - 1, top}, {-3, r, top}), 0},      // vertex over a corner
        {floor, tri({-r, 0, gap}, {r, 0, gap}, {0, 1, top}), 0},          // edge across the face
        {tri({-r, 0, 0}, {r, 0, 0}, {0, 1, -r}), tri({0, -r, gap}, {0, r, gap}, {1, 0, top}), 0},       // edge on edge
        {tri({-r, -1, 0}, {r, 1, 0}, {0, 0, -r}), tri({-1, -r, gap}, {1, r, gap}, {0, 0, top}), 0},     // oblique edges
        {tri({0, 0, 0}, {r, 1, -r}, {-r, 2, -r + 1}), tri({0, 0, gap}, {r, 1, top}, {-1, r, top}), 0},  // tip on tip
        {tri({0, 0, 0}, {0, 0, -r}, {r, 0, -r}), tri({0, -r, gap}, {0, r, gap}, {0, 0, top}), 0},  // corner under edge
    };
    for (const GridPair& shape : shapes) {
      for (int first = 0; first < 3; ++first) {
        for (const int sign : {1, -1}) {
          const GridPair pair = with_axes(shape, first, sign);
          list.push_back({pair, gap});
          list.push_back({{pair.b, pair.a, 0}, gap});
        }
      }
    }
  }
  return list;
}

/// A tilted: B's vertex on a grid point of A's plane, and one step to every side.
std::vector<GridPair> tilted_touching_pairs(int coord_w, Random& random) {
  const int r = (1 << (coord_w - 1)) / 8;
  std::uniform_int_distribution<int> c(-r, r);
  const auto point = [&] { return Vec3i(c(random), c(random), c(random)); };
  std::vector<GridPair> list;
  for (int i = 0; i < 40; ++i) {
    const Vec3i u = point();
    const Vec3i v = point();
    GridPair pair;
    pair.a.v = {Vec3i(-u - v), Vec3i(2 * u - v), Vec3i(2 * v - u), Vec3i::Zero()};  // the origin is inside
    const std::array<Vec3i, 4> targets = {Vec3i(0, 0, 0), u, Vec3i(-v), Vec3i(-u - v)};
    for (const Vec3i& target : targets) {
      const Vec3i second = point();
      const Vec3i third = point();
      for (int step = 0; step < 7; ++step) {
        Vec3i move = Vec3i::Zero();
        if (step > 0) move[(step - 1) / 2] = step % 2 == 0 ? 1 : -1;
        pair.b.v = {Vec3i(target + move), Vec3i(target + move + second), Vec3i(target + move + third), Vec3i::Zero()};
        list.push_back(pair);
      }
    }
  }
  return list;
}

void check_touching(const PrimtestConfig& config) {
  std::vector<GridPair> pairs;
  const auto known = touching_pairs(config.coord_w);
  for (const KnownPair& k : known) pairs.push_back(k.pair);
  for (const PairMode mode : {PairMode::exhaustive, PairMode::directed}) {
    const auto result = exact_answers(config, pairs, mode);
    for (std::size_t i = 0; i < known.size(); ++i) {
      INFO(to_text(known[i].pair) << ", gap " << known[i].gap);
      REQUIRE(result[i].definite);
      REQUIRE((result[i].grid || known[i].gap > 0));
      REQUIRE((!result[i].grid || known[i].gap <= 0));
    }
    Random random(sim::seed_from_environment());
    exact_answers(config, tilted_touching_pairs(config.coord_w, random), mode);
  }
}

}  // namespace

CCHIP_PRIMTEST_CASE(tri_tri, "touching and just missing by one step", check_touching)
