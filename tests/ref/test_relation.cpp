// SPDX-License-Identifier: Apache-2.0
// Apart, touching, crossing (docs/cpp/touching.md): exact predicates against the definition and against small
// translations.
#include <catch2/catch.hpp>
#include <cchip/internal/exact/posed_pairs.hpp>
#include <cchip/internal/grid/canonical.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <map>

#include "difference_oracle.hpp"
#include "random_pairs.hpp"

using namespace cchip;
using namespace cchip_test;

namespace {

GridPair triangles(const std::array<Vec3i, 3>& a, const std::array<Vec3i, 3>& b) {
  GridPair pair;
  std::copy(a.begin(), a.end(), pair.a.v.begin());
  std::copy(b.begin(), b.end(), pair.b.v.begin());
  return pair;
}

GridPair moved(const GridPair& pair, int scale, const Vec3i& by) {
  GridPair result = pair;
  for (std::size_t i = 0; i < 4; ++i) {
    result.a.v[i] = scale * pair.a.v[i] + by;
    result.b.v[i] = scale * pair.b.v[i];
  }
  return result;
}

constexpr std::array<Kind, 2> kinds = {Kind::tri, Kind::quad};

}  // namespace

TEST_CASE("relation: the cases of the page", "[ref][relation]") {
  const std::array<Vec3i, 3> flat = {Vec3i(0, 0, 0), Vec3i(4, 0, 0), Vec3i(0, 4, 0)};
  const auto relation = [&](const std::array<Vec3i, 3>& b) { return exact_relation(triangles(flat, b)); };
  CHECK(relation({Vec3i(1, 1, -1), Vec3i(1, 1, 2), Vec3i(2, 1, 2)}) == Relation::crossing);    // pierced
  CHECK(relation({Vec3i(1, 1, 1), Vec3i(1, 1, 2), Vec3i(2, 1, 2)}) == Relation::apart);        // above
  CHECK(relation({Vec3i(1, 1, 0), Vec3i(1, 1, 2), Vec3i(2, 1, 2)}) == Relation::touching);     // a vertex on the face
  CHECK(relation({Vec3i(1, 1, 0), Vec3i(2, 1, 0), Vec3i(2, 1, 2)}) == Relation::touching);     // an edge on the face
  CHECK(relation({Vec3i(0, 0, 0), Vec3i(4, 0, 0), Vec3i(0, 4, 0)}) == Relation::touching);     // itself
  CHECK(relation({Vec3i(1, 1, 0), Vec3i(5, 1, 0), Vec3i(1, 5, 0)}) == Relation::touching);     // flush, overlapping
  CHECK(relation({Vec3i(0, 0, 0), Vec3i(4, 0, 0), Vec3i(0, 0, 4)}) == Relation::touching);     // a common edge
  CHECK(relation({Vec3i(2, -1, -1), Vec3i(2, -1, 1), Vec3i(2, 1, 0)}) == Relation::crossing);  // over the edge
  CHECK(relation({Vec3i(2, 0, -1), Vec3i(2, 0, 1), Vec3i(2, -3, 0)}) == Relation::touching);   // edge on edge
  CHECK(relation({Vec3i(1, 1, -1), Vec3i(1, 1, 1), Vec3i(1, 1, 1)}) == Relation::crossing);    // a segment through it
  CHECK(relation({Vec3i(1, 1, 0), Vec3i(1, 1, 0), Vec3i(1, 1, 0)}) == Relation::touching);     // a point on it
  CHECK(exact_relation(triangles({Vec3i(-1, 0, 0), Vec3i(1, 0, 0), Vec3i(1, 0, 0)},
                                 {Vec3i(0, -1, 0), Vec3i(0, 1, 0), Vec3i(0, 1, 0)})) == Relation::touching);
  // A point within a tetrahedron, which a warped quad is.
  GridPair warped;
  warped.a.kind = Kind::quad;
  warped.a.v = {Vec3i(0, 0, 0), Vec3i(8, 0, 8), Vec3i(8, 8, 0), Vec3i(0, 8, 8)};
  warped.b.v = {Vec3i(4, 4, 4), Vec3i(4, 4, 4), Vec3i(4, 4, 4), Vec3i(4, 4, 4)};
  CHECK(exact_relation(warped) == Relation::crossing);
  warped.b.v.fill(Vec3i(0, 0, 0));
  CHECK(exact_relation(warped) == Relation::touching);
}

TEST_CASE("relation: exact predicates follow the definition", "[ref][relation]") {
  for (const int range : {1, 2, 5, 1000, 500000}) {
    PairSource source(-range, range, static_cast<std::uint64_t>(range));
    for (const Kind kind_a : kinds) {
      for (const Kind kind_b : kinds) {
        for (const PairClass c : pair_classes) {
          std::map<Relation, int> found;
          for (int n = 0; n < 4000; ++n) {
            GridPair pair = source.pair(c, kind_a, kind_b);
            pair.a = canonical_quad(pair.a);
            pair.b = canonical_quad(pair.b);
            const Relation relation = exact_relation(pair);
            ++found[relation];
            const bool crosses = !parting_direction(pair).has_value();
            if ((relation == Relation::crossing) != crosses || (relation == Relation::apart) == exact_intersects(pair))
              FAIL(name(c) << ": " << describe(pair));
            if (exact_relation({pair.b, pair.a, 0}) != relation) FAIL("swapped: " << describe(pair));
          }
          INFO("range " << range << ", " << name(c));
          CHECK(found[Relation::touching] + found[Relation::apart] > 100);
          if (c == PairClass::coplanar) CHECK(found[Relation::crossing] < 4000);
          if (c == PairClass::general) CHECK(found[Relation::crossing] > 100);
        }
      }
    }
  }
}

TEST_CASE("relation: a small translation parts two that touch, and none parts two that cross", "[ref][relation]") {
  // On the grid -2..2 an axis of a pair has components of at most 32, so a crossing pair stays in contact under any
  // translation below 2^-8 of a step.
  constexpr int scale = 1 << 14;
  PairSource source(-2, 2, 7);
  std::map<Relation, int> found;
  for (int n = 0; n < 60000; ++n) {
    const Kind kind_a = kinds[static_cast<std::size_t>(source.integer(0, 1))];
    const Kind kind_b = kinds[static_cast<std::size_t>(source.integer(0, 1))];
    GridPair pair = source.pair(pair_classes[static_cast<std::size_t>(source.integer(0, 2))], kind_a, kind_b);
    pair.a = canonical_quad(pair.a);
    pair.b = canonical_quad(pair.b);
    const Relation relation = exact_relation(pair);
    ++found[relation];
    if (relation == Relation::touching) {
      const auto u = parting_direction(pair);
      if (!u) FAIL("no direction: " << describe(pair));
      Vec3i by(static_cast<int>(-(*u)[0]), static_cast<int>(-(*u)[1]), static_cast<int>(-(*u)[2]));
      bool parted = false;
      if (by != Vec3i::Zero()) {
        parted = !exact_intersects(moved(pair, scale, by));
      } else {  // points and collinear segments
        for (int d = 0; d < 3; ++d) parted = parted || !exact_intersects(moved(pair, scale, Vec3i::Unit(d)));
      }
      if (!parted) FAIL("not parted: " << describe(pair));
    } else if (relation == Relation::crossing) {
      for (int direction = 0; direction < 27; ++direction) {
        const Vec3i by(direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1);
        if (!exact_intersects(moved(pair, scale, by))) FAIL("parted: " << describe(pair));
      }
    }
  }
  CHECK(found[Relation::apart] > 1000);
  CHECK(found[Relation::touching] > 1000);
  CHECK(found[Relation::crossing] > 1000);
}

TEST_CASE("relation: doubles under poses answer as the grid does", "[ref][relation]") {
  PairSource source(-4, 4, 11);
  Pose turned = Pose::Identity();
  turned.linear() << 0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1;  // both objects alike: rounding of the entries is no error
  turned.translation() << 1e6 + 0.1, -0.3, 1e-3;
  std::map<Relation, int> found;
  for (int n = 0; n < 20000; ++n) {
    const GridPair pair = source.pair(pair_classes[static_cast<std::size_t>(source.integer(0, 4))]);
    const Relation relation = exact_relation(pair);
    ++found[relation];
    const Primitive a = scaled(pair.a, -3);
    const Primitive b = scaled(pair.b, -3);
    for (const Pose& pose : {Pose(Pose::Identity()), turned}) {
      if (exact_relation(a, pose, b, pose) != relation) FAIL("oracle: " << describe(pair));
      const PosedPairs pairs(pose, pose);
      const bool hit = pairs.decide(a, b).hit;
      if (hit != (relation != Relation::apart)) FAIL("decide: " << describe(pair));
      if (hit && pairs.cross(a, b) != (relation == Relation::crossing)) FAIL("cross: " << describe(pair));
    }
  }
  CHECK(found[Relation::touching] > 1000);
  CHECK(found[Relation::crossing] > 1000);
}
