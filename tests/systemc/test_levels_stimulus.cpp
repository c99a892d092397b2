// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cchip/internal/grid/coplanar.hpp>
#include <cchip/internal/reference/eigen_sat.hpp>
#include <cchip/levels/functional_test.hpp>
#include <cchip/levels/generator.hpp>
#include <cchip/levels/stimulus_file.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/program/usage_error.hpp>
#include <functional>
#include <map>
#include <random>
#include <sstream>

using namespace cchip;
using namespace cchip::levels;

namespace {

std::string text_of(const Stimulus& stimulus) {
  std::ostringstream out;
  write_stimulus(out, stimulus);
  return out.str();
}

Stimulus read_text(const std::string& text) {
  std::istringstream in(text);
  return read_stimulus(in, "pairs.csv");
}

std::string error_of(const std::string& text) {
  try {
    read_text(text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

std::string error_of(const StimulusPair& pair) {
  try {
    check_pair(pair);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

StimulusPair triangles() {
  StimulusPair pair;
  pair.a.v = {Vec3i{0, 0, 0}, Vec3i{4, 0, 0}, Vec3i{0, 4, 0}, Vec3i::Zero()};
  pair.b = pair.a;
  return pair;
}

bool is_warped(const GridPrimitive& p) {
  const auto v = [&](std::size_t i) -> Eigen::Vector3d { return p.v.at(i).cast<double>() - p.v[0].cast<double>(); };
  return p.kind == Kind::quad && v(1).cross(v(2)).dot(v(3)) != 0;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("levels stimulus: successive object pairs differ in kind and share the pairs evenly", "[systemc][levels]") {
  const Stimulus stimulus = generate({1000, 13, sim::seed_from_environment()});
  REQUIRE(stimulus.size() == 1000);
  const std::vector<ObjectPair> objects = object_pairs(stimulus);
  REQUIRE(objects.size() == 13);
  CHECK(objects[0].test != objects[2].test);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    CHECK((objects[i].count == 76 || objects[i].count == 77));
    if (i > 0) CHECK(objects[i].test != objects[i - 1].test);
    for (std::size_t k = 0; k < objects[i].count; ++k)
      CHECK(test_of(stimulus[objects[i].first + k]) == objects[i].test);
  }
}

TEST_CASE("levels stimulus: depends on the seed and on nothing else", "[systemc][levels]") {
  const std::uint64_t seed = sim::seed_from_environment();
  CHECK(text_of(generate({200, 4, seed})) == text_of(generate({200, 4, seed})));
  CHECK(text_of(generate({200, 4, seed})) != text_of(generate({200, 4, seed + 1})));
}

TEST_CASE("levels stimulus: pairs of every class, hits and misses", "[systemc][levels]") {
  struct Counts {
    int pairs = 0, hits = 0, near = 0, coplanar = 0, degenerate = 0, warped = 0, planar = 0, exact = 0;
  };
  std::map<ModuleId, Counts> counts;
  for (const StimulusPair& pair : generate({9000, 30, sim::seed_from_environment()})) {
    CHECK_NOTHROW(check_pair(pair));
    Counts& c = counts[test_of(pair)];
    const GridPair grid = placed(pair);
    const bool hit = eigen_intersects(grid, coord_w);
    bool near = false;
    for (int d = 0; d < 6 && !near; ++d) {
      GridPair beside = grid;
      for (Vec3i& v : beside.a.v) v[d / 2] += d % 2 == 0 ? 1 : -1;
      near = eigen_intersects(beside, coord_w + 1) != hit;
    }
    ++c.pairs;
    c.hits += hit ? 1 : 0;
    c.near += near ? 1 : 0;
    c.coplanar += is_coplanar(grid) ? 1 : 0;
    c.degenerate += is_degenerate(grid.a) || is_degenerate(grid.b) ? 1 : 0;
    c.warped += is_warped(grid.b) ? 1 : 0;
    c.planar += is_warped(grid.b) ? 0 : 1;
    c.exact += pair.m.entry[0] * pair.m.entry[5] * pair.m.entry[10] == 0 ? 1 : 0;
  }
  REQUIRE(counts.size() == 3);
  for (const auto& [test, c] : counts) {
    INFO("test " << static_cast<int>(test) << ", " << c.pairs << " pairs");
    CHECK(c.hits > c.pairs / 4);
    CHECK(c.hits < 3 * c.pairs / 4);
    CHECK(c.near > c.pairs / 10);
    CHECK(c.coplanar > c.pairs / 100);
    CHECK(c.degenerate > c.pairs / 100);
    CHECK(c.planar > c.pairs / 10);
    CHECK((test == ModuleId::tri_tri || c.warped > c.pairs / 20));
    CHECK(c.exact > c.pairs / 10);
  }
}

TEST_CASE("levels stimulus: object pairs without primitive pairs are refused", "[systemc][levels]") {
  CHECK_THROWS_WITH(generate({10, 11, 1}), Catch::Contains("11 object pairs of 10"));
  CHECK_THROWS_AS(generate({10, 0, 1}), std::invalid_argument);
}

TEST_CASE("levels stimulus: a matrix is applied exactly and halves are rounded up", "[systemc][levels]") {
  StimulusPair pair = triangles();
  pair.m.entry = {0.5, 0, 0, 10, 0, 1, 0, 0.5, 0, 0, 1, -0.5009765625};
  pair.a.v = {Vec3i{1, 0, 0}, Vec3i{-1, 0, 0}, Vec3i{-3, 7, 1}, Vec3i::Zero()};
  const GridPrimitive p = placed(pair).a;
  CHECK(p.v[0] == Vec3i{11, 1, -1});  // 10.5, 0.5, -0.50...
  CHECK(p.v[1] == Vec3i{10, 1, -1});  // 9.5
  CHECK(p.v[2] == Vec3i{9, 8, 0});    // 8.5
}

TEST_CASE("levels stimulus: functional modules and static side place alike", "[systemc][levels]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const auto draw = [&](int largest) { return std::uniform_int_distribution<int>(-largest, largest)(random); };
  for (int i = 0; i < 20000; ++i) {
    Matrix m;
    const bool small = i % 2 == 0;
    for (std::size_t k = 0; k < 12; ++k) {
      const int largest = k % 4 == 3 ? unplaced_max : matrix_entry_max;
      m.entry.at(k) = static_cast<double>(draw(small ? 2000 : largest * matrix_unit)) / matrix_unit;
    }
    GridPrimitive p;
    p.kind = Kind::quad;
    Vertices v;
    for (std::size_t k = 0; k < 4; ++k) {
      for (int d = 0; d < 3; ++d) v.v[k].at(static_cast<std::size_t>(d)) = p.v[k][d] = draw(small ? 9 : unplaced_max);
    }
    const GridPrimitive expected = place(m, p);
    const std::vector<Integers> got = placed_vertices_of(v, 4, m);
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t d = 0; d < 3; ++d) REQUIRE(got[k][d] == expected.v[k][static_cast<Eigen::Index>(d)]);
    }
  }
}

TEST_CASE("levels stimulus: pairs that cannot be tested are refused", "[systemc][levels]") {
  const auto with = [](const std::function<void(StimulusPair&)>& change) {
    StimulusPair pair = triangles();
    change(pair);
    return error_of(pair);
  };
  CHECK(error_of(triangles()) == "no error");
  CHECK_THAT(with([](auto& p) { p.a.kind = Kind::quad; }), Catch::Contains("make the triangle a"));
  CHECK_THAT(with([](auto& p) { p.m.entry[5] = 17; }), Catch::Contains("m11 is beyond 16"));
  CHECK_THAT(with([](auto& p) { p.m.entry[5] = std::nan(""); }), Catch::Contains("m11 is beyond 16"));
  CHECK_THAT(with([](auto& p) { p.m.entry[3] = 524289; }), Catch::Contains("m03 is beyond 524288"));
  CHECK_THAT(with([](auto& p) { p.m.entry[10] = 0.0001; }), Catch::Contains("m22 is no multiple of 1/1024"));
  CHECK_THAT(with([](auto& p) { p.a.v[2][0] = 524289; }), Catch::Contains("vertex 2 of a is beyond 2^19"));
  CHECK_THAT(with([](auto& p) { p.m.entry[7] = 32768; }), Catch::Contains("vertex 0 of m a is off the grid"));
  CHECK_THAT(with([](auto& p) { p.b.v[1][2] = -32769; }), Catch::Contains("vertex 1 of b is off the grid"));
  CHECK(with([](auto& p) { p.b.v[1][2] = -32768; }) == "no error");
  CHECK(with([](auto& p) { p.b.v[3][2] = 99999; }) == "no error");  // no vertex of a triangle
}

TEST_CASE("levels stimulus: a file is read back as it was written", "[systemc][levels]") {
  const Stimulus stimulus = generate({300, 7, sim::seed_from_environment()});
  const Stimulus again = read_text(text_of(stimulus));
  REQUIRE(again.size() == stimulus.size());
  for (std::size_t i = 0; i < stimulus.size(); ++i) {
    INFO("pair " << i);
    CHECK(again[i].object_pair == stimulus[i].object_pair);
    CHECK(again[i].mode == stimulus[i].mode);
    CHECK(again[i].m == stimulus[i].m);
    for (const auto& [p, q] : {std::pair(again[i].a, stimulus[i].a), std::pair(again[i].b, stimulus[i].b)}) {
      REQUIRE(p.kind == q.kind);
      for (std::size_t k = 0; k < p.vertex_count(); ++k) CHECK(p.v.at(k) == q.v.at(k));
    }
  }
}

TEST_CASE("levels stimulus: columns may be in any order and there may be others", "[systemc][levels]") {
  const std::string text = text_of({triangles()});
  std::istringstream lines(text);
  std::string header;
  std::string row;
  std::getline(lines, header);
  std::getline(lines, row);
  const std::size_t comma = header.find(',');
  const std::string turned =
      "note," + header.substr(comma + 1) + ",object_pair\nhello," + row.substr(row.find(',') + 1) + ",7\n";
  const Stimulus stimulus = read_text(turned);
  REQUIRE(stimulus.size() == 1);
  CHECK(stimulus[0].object_pair == 7);
  CHECK(stimulus[0].a.v[1] == Vec3i{4, 0, 0});
}

TEST_CASE("levels stimulus: a wrong file is refused with file, line and what to do", "[systemc][levels]") {
  StimulusPair second = triangles();
  second.object_pair = 1;
  const std::string good = text_of({triangles(), second});
  REQUIRE(error_of(good) == "no error");
  CHECK_THAT(error_of(std::string()), Catch::StartsWith("pairs.csv: the file is empty"));
  CHECK_THAT(error_of(good.substr(0, good.find('\n') + 1)), Catch::StartsWith("pairs.csv: no pairs"));
  CHECK_THAT(error_of(replaced(good, "b2y", "b2Y")), Catch::StartsWith("pairs.csv:1: column b2y is missing"));
  CHECK_THAT(error_of(replaced(good, "\n0,", "\n-1,")), Catch::StartsWith("pairs.csv:2: column object_pair: write a"));
  CHECK_THAT(error_of(replaced(good, "exhaustive", "all")),
             Catch::StartsWith("pairs.csv:2: column mode: write directed"));
  CHECK_THAT(error_of(replaced(good, "tri", "line")),
             Catch::StartsWith("pairs.csv:2: column kind_a: write quad or tri"));
  CHECK_THAT(error_of(replaced(good, ",tri,0,", ",tri,0.5,")),
             Catch::StartsWith("pairs.csv:2: column a0x: write a whole"));
  CHECK_THAT(error_of(replaced(good, ",tri,0,", ",tri,x,")),
             Catch::StartsWith("pairs.csv:2: column a0x: 'x' is not a"));
  CHECK_THAT(error_of(replaced(good, "\n1,", "\n1\n1,")), Catch::StartsWith("pairs.csv:3: column mode is missing"));
  CHECK_THAT(error_of(replaced(good, "exhaustive,1,", "exhaustive,0.3,")),
             Catch::StartsWith("pairs.csv:2: m00 is no multiple"));

  second.b.kind = Kind::quad;
  CHECK(error_of(text_of({triangles(), second})) == "no error");
  second.object_pair = 0;
  CHECK_THAT(error_of(text_of({triangles(), second})),
             Catch::StartsWith("pairs.csv:3: object_pair 0 has tri-tri and tri-quad"));
  StimulusPair first = triangles();
  first.object_pair = 2;
  CHECK_THAT(error_of(text_of({first, triangles()})), Catch::StartsWith("pairs.csv:3: object_pair 0 follows 2; sort"));
}
