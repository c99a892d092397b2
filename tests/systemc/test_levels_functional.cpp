// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/levels/functional_api.hpp>
#include <cchip/levels/generator.hpp>
#include <cchip/levels/simulate.hpp>
#include <cchip/program/seed.hpp>
#include <random>

using namespace cchip;
using namespace cchip::levels;

namespace {

SatPrimitive to_sat(const GridPrimitive& p) {
  std::vector<Integers> v;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) v.push_back({p.v.at(i)[0], p.v.at(i)[1], p.v.at(i)[2]});
  return make_sat_primitive(v);
}

Vertices triangle(int x, int y, int z) {
  Vertices p;
  p.v = {{{x, y, z}, {x + 4, y, z}, {x, y + 4, z}, {99, 99, 99}}};
  return p;
}

/// Three functional tests of triangles, each pair of which has one answer.
class Script : public sc_core::sc_module {
 public:
  FunctionalChannels channels{"channel"};
  std::vector<int> hits;

  SC_HAS_PROCESS(Script);
  Script(const sc_core::sc_module_name& name, std::vector<std::pair<Vertices, Vertices>> pairs)
      : sc_module(name), pairs_(std::move(pairs)) {
    SC_THREAD(run);
  }

 private:
  void run() {
    for (const auto& [a, b] : pairs_) {
      channels.m.write({});
      channels.a.write(a);
      channels.b.write(b);
      bool hit = false;
      channels.hit.read(hit);
      hits.push_back(hit ? 1 : 0);
    }
  }
  std::vector<std::pair<Vertices, Vertices>> pairs_;
};

}  // namespace

TEST_CASE("levels functional: separating axes agree with the exact oracle, also swapped and permuted",
          "[systemc][levels]") {
  std::mt19937_64 random(sim::seed_from_environment());
  int hits = 0;
  for (const StimulusPair& pair : generate({30000, 30, sim::seed_from_environment()})) {
    GridPair grid = placed(pair);
    const bool expected = exact_intersects(grid);
    hits += expected ? 1 : 0;
    REQUIRE(sat_intersects(to_sat(grid.a), to_sat(grid.b)) == expected);
    for (GridPrimitive* p : {&grid.a, &grid.b}) {
      std::shuffle(p->v.begin(), p->v.begin() + static_cast<std::ptrdiff_t>(p->vertex_count()), random);
    }
    REQUIRE(sat_intersects(to_sat(grid.b), to_sat(grid.a)) == expected);
  }
  CHECK(hits > 1000);
}

TEST_CASE("levels functional: corners of the grid do not overflow", "[systemc][levels]") {
  std::mt19937_64 random(sim::seed_from_environment());
  for (int i = 0; i < 20000; ++i) {
    GridPair grid;
    for (GridPrimitive* p : {&grid.a, &grid.b}) {
      p->kind = random() % 2 == 0 ? Kind::tri : Kind::quad;
      for (Vec3i& v : p->v) {
        for (std::int32_t& x : v) x = (random() % 2 == 0 ? -32768 : 32767) + static_cast<int>(random() % 3) - 1;
        v = v.cwiseMax(-32768).cwiseMin(32767);
      }
    }
    REQUIRE(sat_intersects(to_sat(grid.a), to_sat(grid.b)) == exact_intersects(grid));
  }
}

TEST_CASE("levels functional: a module answers through FIFOs, one for one and in order", "[systemc][levels]") {
  const Vertices base = triangle(0, 0, 0);
  Vertices point = base;
  point.v[0] = point.v[1] = point.v[2] = {4, 0, 0};
  Script script("script", {{base, triangle(4, 0, 0)},  // a vertex touches
                           {base, triangle(5, 0, 0)},  // a step beside
                           {base, triangle(1, 1, 0)},  // overlap in one plane
                           {base, triangle(3, 3, 0)},  // apart in one plane, boxes overlap
                           {base, triangle(0, 0, 1)},  // parallel planes
                           {point, base},              // a point on a corner
                           {base, base}});
  FunctionalTriTri test("test");
  script.channels.bind(test);
  sc_core::sc_start();
  CHECK(script.hits == std::vector<int>{1, 0, 1, 0, 0, 1, 1});
}

TEST_CASE("levels functional: the API ends with an error if no answer comes", "[systemc][levels]") {
  const Stimulus stimulus = generate({50, 1, 1});
  FunctionalApi api("api", stimulus, sc_core::sc_time(1, sc_core::SC_MS), 1);
  FunctionalChannels channels("channel");
  channels.bind(api, 0);
  CHECK_THROWS_WITH(simulate(api), Catch::Contains("nothing happens for 1 ms: 0 of 50 primitive pairs are answered"));
}
