// SPDX-License-Identifier: Apache-2.0
// Triangle pairs worked out by hand.
#include <catch2/catch.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/reference/eigen_sat.hpp>

#include "linear_programme.hpp"
#include "random_pairs.hpp"

using namespace cchip_test;

namespace {

struct Row {
  const char* what;
  std::array<std::array<int, 3>, 3> a;
  std::array<std::array<int, 3>, 3> b;
  bool hit;
};

using T = std::array<std::array<int, 3>, 3>;
constexpr int lo = -32768;
constexpr int hi = 32767;
constexpr T floor8{{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}}};            // x, y >= 0, x + y <= 8, z = 0
constexpr T floor_full{{{lo, lo, 0}, {hi, lo, 0}, {lo, hi, 0}}};  // x + y <= -1

const Row table[] = {
    {"edge through the face", floor8, {{{2, 2, -4}, {2, 2, 4}, {9, 9, 4}}}, true},
    {"crosses the plane beside the face", floor8, {{{5, 5, -4}, {5, 5, 4}, {9, 9, 4}}}, false},
    {"vertex on face", floor8, {{{2, 2, 0}, {2, 2, 5}, {3, 4, 5}}}, true},
    {"vertex one step above the face", floor8, {{{2, 2, 1}, {2, 2, 5}, {3, 4, 5}}}, false},
    {"vertex on vertex", floor8, {{{0, 0, 0}, {-1, -3, 5}, {-4, -1, 5}}}, true},
    {"vertex one step from vertex", floor8, {{{-1, 0, 0}, {-1, -3, 5}, {-4, -1, 5}}}, false},
    {"vertex on edge", floor8, {{{4, 4, 0}, {9, 9, 3}, {9, 9, -3}}}, true},
    {"vertex one step from edge", floor8, {{{5, 4, 0}, {9, 9, 3}, {9, 9, -3}}}, false},
    {"edge on edge, planes crossing", floor8, {{{4, 0, -4}, {4, 0, 4}, {4, -6, 0}}}, true},
    {"edge one step from edge, planes crossing", floor8, {{{4, -1, -4}, {4, -1, 4}, {4, -6, 0}}}, false},
    {"edges cross in one point", {{{-8, 0, 0}, {8, 0, 0}, {0, -8, -8}}}, {{{0, -8, 0}, {0, 8, 0}, {8, 0, 8}}}, true},
    {"edges pass by one step", {{{-8, 0, 0}, {8, 0, 0}, {0, -8, -8}}}, {{{0, -8, 1}, {0, 8, 1}, {8, 0, 9}}}, false},
    {"edge ends in edge", {{{-8, 0, 0}, {8, 0, 0}, {0, -8, -8}}}, {{{0, 0, 0}, {0, 8, 0}, {8, 0, 8}}}, true},
    {"shared edge, folded", floor8, {{{0, 0, 0}, {8, 0, 0}, {0, 0, 8}}}, true},
    {"shared vertex", floor8, {{{0, 0, 0}, {-3, 0, 5}, {0, -3, 5}}}, true},
    {"parallel planes one step apart", floor8, {{{0, 0, 1}, {8, 0, 1}, {0, 8, 1}}}, false},
    {"equal", floor8, floor8, true},
    {"equal, turned around", floor8, {{{0, 8, 0}, {8, 0, 0}, {0, 0, 0}}}, true},
    {"coplanar, overlapping", floor8, {{{2, 2, 0}, {10, 2, 0}, {2, 10, 0}}}, true},
    {"coplanar, B inside", floor8, {{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}}, true},
    {"coplanar, A inside", floor8, {{{-9, -9, 0}, {30, -9, 0}, {-9, 30, 0}}}, true},
    {"coplanar, apart", floor8, {{{9, 9, 0}, {12, 9, 0}, {9, 12, 0}}}, false},
    {"coplanar, vertex on edge", floor8, {{{4, 4, 0}, {9, 5, 0}, {5, 9, 0}}}, true},
    {"coplanar, one step apart", floor8, {{{5, 4, 0}, {9, 5, 0}, {5, 9, 0}}}, false},
    {"coplanar, boxes overlap, apart", floor8, {{{8, 8, 0}, {8, 1, 0}, {1, 8, 0}}}, false},
    {"coplanar, shared edge", floor8, {{{0, 0, 0}, {8, 0, 0}, {4, -5, 0}}}, true},
    {"coplanar, part of an edge shared", floor8, {{{6, 0, 0}, {12, 0, 0}, {9, -5, 0}}}, true},
    {"coplanar, edges on one line, apart", floor8, {{{9, 0, 0}, {12, 0, 0}, {9, -5, 0}}}, false},
    {"coplanar, shared vertex", floor8, {{{0, 0, 0}, {-5, -1, 0}, {-1, -5, 0}}}, true},
    {"coplanar star, no vertex inside",
     {{{0, 0, 0}, {12, 0, 0}, {6, 9, 0}}},
     {{{0, 6, 0}, {12, 6, 0}, {6, -3, 0}}},
     true},
    {"coplanar on a slanted plane, overlapping",
     {{{0, 0, 0}, {8, 0, 8}, {0, 8, 8}}},
     {{{2, 2, 4}, {9, 2, 11}, {2, 9, 11}}},
     true},
    {"coplanar on a slanted plane, one step apart",
     {{{0, 0, 0}, {8, 0, 8}, {0, 8, 8}}},
     {{{5, 4, 9}, {9, 5, 14}, {5, 9, 14}}},
     false},
    {"segment through face", floor8, {{{2, 2, -3}, {2, 2, 3}, {2, 2, 0}}}, true},
    {"segment beside face", floor8, {{{5, 4, -3}, {5, 4, 3}, {5, 4, 0}}}, false},
    {"segment ends on face", floor8, {{{2, 2, 0}, {2, 2, 3}, {2, 2, 5}}}, true},
    {"segment ends one step above face", floor8, {{{2, 2, 1}, {2, 2, 3}, {2, 2, 5}}}, false},
    {"segment in the plane, across", floor8, {{{-1, 1, 0}, {9, 1, 0}, {4, 1, 0}}}, true},
    {"segment in the plane, inside", floor8, {{{1, 1, 0}, {2, 2, 0}, {3, 3, 0}}}, true},
    {"segment in the plane, beside", floor8, {{{9, -1, 0}, {9, 9, 0}, {9, 4, 0}}}, false},
    {"segments cross", {{{-4, 0, 0}, {4, 0, 0}, {0, 0, 0}}}, {{{0, -4, 0}, {0, 4, 0}, {0, 1, 0}}}, true},
    {"segments pass by one step", {{{-4, 0, 0}, {4, 0, 0}, {0, 0, 0}}}, {{{0, -4, 1}, {0, 4, 1}, {0, 1, 1}}}, false},
    {"segments in one plane, lines cross outside",
     {{{-4, 0, 0}, {4, 0, 0}, {0, 0, 0}}},
     {{{5, -4, 0}, {5, 4, 0}, {5, 1, 0}}},
     false},
    {"segments on one line overlap", {{{0, 0, 0}, {4, 4, 4}, {2, 2, 2}}}, {{{3, 3, 3}, {7, 7, 7}, {5, 5, 5}}}, true},
    {"segments on one line touch", {{{0, 0, 0}, {4, 4, 4}, {2, 2, 2}}}, {{{4, 4, 4}, {7, 7, 7}, {5, 5, 5}}}, true},
    {"segments on one line, one step apart",
     {{{0, 0, 0}, {4, 4, 4}, {2, 2, 2}}},
     {{{5, 5, 5}, {7, 7, 7}, {6, 6, 6}}},
     false},
    {"parallel segments", {{{0, 0, 0}, {8, 0, 0}, {4, 0, 0}}}, {{{0, 1, 0}, {8, 1, 0}, {4, 1, 0}}}, false},
    {"point on face", floor8, {{{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}}, true},
    {"point above face", floor8, {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, false},
    {"point on edge", floor8, {{{4, 4, 0}, {4, 4, 0}, {4, 4, 0}}}, true},
    {"point beside edge, in the plane", floor8, {{{5, 4, 0}, {5, 4, 0}, {5, 4, 0}}}, false},
    {"point on segment", {{{0, 0, 0}, {4, 4, 4}, {1, 1, 1}}}, {{{2, 2, 2}, {2, 2, 2}, {2, 2, 2}}}, true},
    {"point beside segment", {{{0, 0, 0}, {4, 4, 4}, {1, 1, 1}}}, {{{2, 2, 3}, {2, 2, 3}, {2, 2, 3}}}, false},
    {"point behind segment", {{{0, 0, 0}, {4, 4, 4}, {1, 1, 1}}}, {{{5, 5, 5}, {5, 5, 5}, {5, 5, 5}}}, false},
    {"equal points", {{{3, 1, 2}, {3, 1, 2}, {3, 1, 2}}}, {{{3, 1, 2}, {3, 1, 2}, {3, 1, 2}}}, true},
    {"points one step apart", {{{3, 1, 2}, {3, 1, 2}, {3, 1, 2}}}, {{{3, 1, 3}, {3, 1, 3}, {3, 1, 3}}}, false},
    {"corner of the range shared",
     {{{lo, lo, lo}, {hi, lo, lo}, {lo, hi, lo}}},
     {{{lo, lo, lo}, {hi, lo, hi}, {lo, hi, hi}}},
     true},
    {"full range, one step apart",
     {{{lo, lo, lo}, {hi, lo, lo}, {lo, hi, lo}}},
     {{{lo, lo, lo + 1}, {hi, lo, lo + 1}, {lo, hi, lo + 1}}},
     false},
    {"full range, edge meets edge", floor_full, {{{0, -1, lo}, {0, -1, hi}, {hi, hi, 0}}}, true},
    {"full range, edge one step from edge", floor_full, {{{0, 0, lo}, {0, 0, hi}, {hi, hi, 0}}}, false},
    {"full range, most negative point on corner", floor_full, {{{lo, lo, lo}, {lo, lo, hi}, {lo, lo, 5}}}, true},
};

GridPrimitive triangle(const T& t, int first, int step) {
  GridPrimitive p;
  for (int i = 0; i < 3; ++i) {
    const auto& v = t[static_cast<std::size_t>((first + i * step + 6) % 3)];
    p.v[static_cast<std::size_t>(i)] = Vec3i(v[0], v[1], v[2]);
  }
  return p;
}

}  // namespace

TEST_CASE("triangle table: every answer in every order", "[ref][triangle_table]") {
  for (const Row& row : table) {
    for (const int step : {1, -1}) {
      for (int first = 0; first < 9; ++first) {
        const GridPrimitive a = triangle(row.a, first % 3, step);
        const GridPrimitive b = triangle(row.b, first / 3, 1);
        for (const GridPair& pair : {GridPair{a, b, 0}, GridPair{b, a, 0}}) {
          INFO(row.what << ": " << describe(pair));
          CHECK(cchip::exact_intersects(pair) == row.hit);
          CHECK(cchip::eigen_intersects(pair, 16) == row.hit);
          CHECK(cchip::eigen_intersects(pair, 20) == row.hit);
        }
      }
    }
  }
}

TEST_CASE("triangle table: linear programming agrees", "[ref][triangle_table]") {
  for (const Row& row : table) {
    INFO(row.what);
    CHECK(linear_programme_intersects(triangle(row.a, 0, 1), triangle(row.b, 0, 1)) == row.hit);
  }
}
