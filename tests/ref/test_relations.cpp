// SPDX-License-Identifier: Apache-2.0
// What must not change an answer: order, symmetry, translation, scale.
#include <catch2/catch.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/reference/eigen_sat.hpp>

#include "random_pairs.hpp"

using namespace cchip_test;

namespace {

template <class Function>
GridPair map_vertices(GridPair pair, const Function& f) {
  for (GridPrimitive* p : {&pair.a, &pair.b}) {
    for (std::size_t i = 0; i < p->vertex_count(); ++i) p->v[i] = f(p->v[i]);
  }
  return pair;
}

void require_answer(bool hit, const GridPair& original, const GridPair& changed, const char* how) {
  if (cchip::exact_intersects(changed) != hit) FAIL("exact, " << how << ": " << describe(original));
  if (cchip::eigen_intersects(changed, 16) != hit) FAIL("Eigen, " << how << ": " << describe(original));
}

void check_relations(const GridPair& pair, PairSource& source) {
  const bool hit = cchip::exact_intersects(pair);
  const auto require = [&](const GridPair& changed, const char* how) { require_answer(hit, pair, changed, how); };
  require(GridPair{pair.b, pair.a, 0}, "swapped");

  GridPair turned = pair;
  std::rotate(turned.a.v.begin(), turned.a.v.begin() + 1,
              turned.a.v.begin() + static_cast<std::ptrdiff_t>(turned.a.vertex_count()));
  std::swap(turned.b.v[0], turned.b.v[2]);
  require(turned, "vertices permuted");

  require(map_vertices(pair, [](const Vec3i& v) { return Vec3i(v.y(), v.z(), v.x()); }), "axes turned");
  require(map_vertices(pair, [](const Vec3i& v) { return Vec3i(v.y(), v.x(), v.z()); }), "axes exchanged");
  const int d = source.integer(0, 2);
  const auto mirror = [d](Vec3i v) {
    v[d] = -v[d];
    return v;
  };
  require(map_vertices(pair, mirror), "mirrored");
  require(map_vertices(pair, [](const Vec3i& v) { return Vec3i(2 * v); }), "scaled by two");
  const Vec3i shift(source.integer(-16000, 16000), source.integer(-16000, 16000), source.integer(-16000, 16000));
  require(map_vertices(pair, [&](const Vec3i& v) { return Vec3i(v + shift); }), "translated");
}

}  // namespace

TEST_CASE("relations: symmetries of a pair do not change its answer", "[ref][relations]") {
  for (const PairClass c : pair_classes) {
    for (const int range : {2, 30, 16000}) {
      for (const Kind kind : {Kind::tri, Kind::quad}) {
        PairSource source(-range, range, 31 * static_cast<std::uint64_t>(range) + static_cast<std::uint64_t>(c));
        for (int i = 0; i < 1000; ++i) check_relations(source.pair(c, Kind::tri, kind), source);
        SUCCEED();
      }
    }
  }
}

TEST_CASE("relations: a quad with its last vertex doubled is a triangle", "[ref][relations]") {
  PairSource source(-20, 20, 5);
  for (int i = 0; i < 5000; ++i) {
    const GridPair pair = source.pair(PairClass::general);
    GridPair doubled = pair;
    doubled.b.kind = Kind::quad;
    doubled.b.v[3] = doubled.b.v[2];
    require_answer(cchip::exact_intersects(pair), pair, doubled, "as quad");
  }
  SUCCEED();
}

TEST_CASE("relations: pairs whose boxes are apart miss", "[ref][relations]") {
  PairSource source(-100, 100, 6);
  for (int i = 0; i < 2000; ++i) {
    GridPair pair = source.pair(PairClass::general);
    for (Vec3i& v : pair.b.v) v.x() += 201;
    require_answer(false, pair, pair, "boxes apart");
  }
  SUCCEED();
}
