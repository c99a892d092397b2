// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cchip/internal/grid/resolve.hpp>

using cchip::PairResult;
using cchip::Primitive;
using cchip::resolve;
using cchip::Vec3d;

TEST_CASE("resolve: a definite answer stands, an open one is decided on the doubles", "[ref][resolve]") {
  Primitive a;
  a.v = {Vec3d(0, 0, 0), Vec3d(4, 0, 4), Vec3d(0, 4, 0), Vec3d::Zero()};
  Primitive touching;
  touching.v = {Vec3d(1, 1, 1), Vec3d(1, 1, 3), Vec3d(1, 2, 3), Vec3d::Zero()};
  Primitive lifted = touching;
  lifted.v[0].z() += 1e-15;  // a hit on any grid
  for (const bool grid : {false, true}) {
    const PairResult definite{0, grid, grid, true, {}, 0};
    CHECK(resolve(a, touching, definite) == grid);
    CHECK(resolve(a, lifted, definite) == grid);
    const PairResult open{0, true, grid, false, {}, 0};
    CHECK(resolve(a, touching, open));
    CHECK_FALSE(resolve(a, lifted, open));
  }
  Primitive quad = a;
  quad.kind = cchip::Kind::quad;
  quad.v[3] = Vec3d(-4, 4, -4);
  CHECK(resolve(quad, touching, PairResult{}));
}
