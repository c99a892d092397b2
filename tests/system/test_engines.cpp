// SPDX-License-Identifier: Apache-2.0
// The dispatcher over the three modules, with the model and the RTL behind it.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cchip/exact/oracle.hpp>
#include <cchip/geometry/canonical.hpp>
#include <cchip/sim/seed.hpp>
#include <map>
#include <random>

#include "engines.hpp"

using namespace cchip;
using namespace cchip::app;

namespace {

using Vec3l = Eigen::Matrix<std::int64_t, 3, 1>;

class Source {
 public:
  explicit Source(std::uint64_t stream) : random_(sim::seed_from_environment() * 1000003 + stream) {}
  int integer(int least, int greatest) { return std::uniform_int_distribution<int>(least, greatest)(random_); }

  /// Any kinds; from small grids, so that coplanar, degenerate, self-crossing and dented ones abound.
  GridPair pair() {
    const int limit = integer(1, 4) == 1 ? 1000 : integer(1, 4);
    GridPair result{primitive(limit), primitive(limit), integer(0, 15)};
    if (integer(0, 2) == 0) {
      const int d = integer(0, 2);
      for (Vec3i& v : result.a.v) v[d] = 0;
      if (integer(0, 1) == 0) {
        for (Vec3i& v : result.b.v) v[d] = 0;
      }
    }
    if (integer(0, 1) == 0) {  // beside each other
      const int d = integer(0, 2);
      for (Vec3i& v : result.b.v) v[d] += limit;
    }
    return result;
  }

 private:
  GridPrimitive primitive(int limit) {
    GridPrimitive p;
    p.kind = integer(0, 1) == 0 ? Kind::tri : Kind::quad;
    for (Vec3i& v : p.v) v = {integer(-limit, limit), integer(-limit, limit), integer(-limit, limit)};
    return p;
  }
  std::mt19937_64 random_;
};

Vec3l edge(const GridPrimitive& p, std::size_t k) {
  const std::size_t n = p.vertex_count();
  const std::size_t from = k < 4 ? k : k - 4;
  const std::size_t to = k < 4 ? (k + 1) % n : k - 2;
  return (p.v.at(to) - p.v.at(from)).cast<std::int64_t>();
}

Vec3l normal(const GridPrimitive& p, std::size_t k) {
  if (k == 0 && p.kind == Kind::tri) return edge(p, 0).cross(edge(p, 1));
  if (k == 0) {  // zero for some orders of the vertices in a plane, but the plane is the same
    const GridPrimitive c = canonical_quad(p);
    return edge(c, 4).cross(edge(c, 5));
  }
  const auto difference = [&](std::size_t i) -> Vec3l {
    return (p.v.at((k + i) % 4) - p.v.at(k % 4)).cast<std::int64_t>();
  };
  return difference(1).cross(difference(2));  // of vertices k, k + 1, k + 2: all but k - 1
}

Vec3l unit(std::size_t d) {
  Vec3l u = Vec3l::Zero();
  u[static_cast<Eigen::Index>(d)] = 1;
  return u;
}

Vec3l axis_of(const GridPair& pair, const AxisCode& axis) {
  switch (axis.cls) {
    case AxisClass::normal_a:
      return normal(pair.a, axis.k);
    case AxisClass::normal_b:
      return normal(pair.b, axis.k);
    case AxisClass::cross:
      return edge(pair.a, axis.k).cross(edge(pair.b, axis.l));
    case AxisClass::in_plane_a:
      return edge(pair.a, axis.k).cross(unit(axis.l));
    case AxisClass::in_plane_b:
      return edge(pair.b, axis.k).cross(unit(axis.l));
    case AxisClass::box:
      return unit(axis.l);
    default:
      return Vec3l::Zero();
  }
}

bool separates(const GridPair& pair, const Vec3l& axis) {
  const auto interval = [&axis](const GridPrimitive& p) {
    std::vector<std::int64_t> at;
    for (std::size_t i = 0; i < p.vertex_count(); ++i) at.push_back(axis.dot(p.v.at(i).cast<std::int64_t>()));
    const auto ends = std::minmax_element(at.begin(), at.end());
    return std::pair{*ends.first, *ends.second};
  };
  const auto a = interval(pair.a);
  const auto b = interval(pair.b);
  return a.second < b.first || b.second < a.first;
}

std::unique_ptr<PairEngine> engine_of(EngineKind kind) {
  EngineOptions options;
  options.kind = kind;
  return make_engine(options);
}

}  // namespace

TEST_CASE("engines: any kinds and modes mixed: exact, every no with a witness in the caller's terms",
          "[system][engines]") {
  const EngineKind kind = GENERATE(EngineKind::model, EngineKind::rtl);
  Source source(1);
  std::vector<GridPair> pairs;
  std::vector<PairMode> modes;
  for (int i = 0; i < 20000; ++i) {
    pairs.push_back(source.pair());
    modes.push_back(source.integer(0, 1) == 0 ? PairMode::exhaustive : PairMode::directed);
  }
  const auto answers = engine_of(kind)->run(pairs, modes);
  REQUIRE(answers.size() == pairs.size());
  std::size_t not_canonical = 0;
  std::size_t hits = 0;
  std::map<AxisClass, std::size_t> witnesses;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    CAPTURE(i, static_cast<int>(modes[i]));
    const HardwareAnswer& hardware = *answers[i].hardware;
    REQUIRE(answers[i].grid == exact_intersects(pairs[i]));
    REQUIRE(hardware.grid == answers[i].grid);
    if (pairs[i].eta == 0) REQUIRE(answers[i].definite);
    CAPTURE(to_words(hardware.axis));
    if (answers[i].grid) REQUIRE(hardware.axis.cls == AxisClass::none);
    if (!answers[i].grid) REQUIRE(separates(pairs[i], axis_of(pairs[i], hardware.axis)));
    ++witnesses[hardware.axis.cls];
    hits += answers[i].grid;
    not_canonical += !is_canonical(pairs[i].a) || !is_canonical(pairs[i].b);
  }
  CHECK(hits > 1000);
  CHECK(not_canonical > 1000);
  for (const AxisClass cls : {AxisClass::normal_a, AxisClass::normal_b, AxisClass::cross, AxisClass::in_plane_a,
                              AxisClass::in_plane_b, AxisClass::box}) {
    CHECK(witnesses[cls] > 10);
  }
}

TEST_CASE("engines: RTL and its model agree in every field, batch after batch", "[system][engines]") {
  Source source(2);
  const auto rtl = engine_of(EngineKind::rtl);
  const auto model = engine_of(EngineKind::model);
  for (const int size : {1, 0, 500, 3000}) {
    std::vector<GridPair> pairs;
    std::vector<PairMode> modes;
    for (int i = 0; i < size; ++i) {
      pairs.push_back(source.pair());
      modes.push_back(source.integer(0, 1) == 0 ? PairMode::exhaustive : PairMode::directed);
    }
    const auto from_rtl = rtl->run(pairs, modes);
    const auto from_model = model->run(pairs, modes);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      CAPTURE(i);
      const HardwareAnswer& x = *from_rtl[i].hardware;
      const HardwareAnswer& y = *from_model[i].hardware;
      REQUIRE(x.hit == y.hit);
      REQUIRE(x.grid == y.grid);
      REQUIRE(x.definite == y.definite);
      REQUIRE(x.axis == y.axis);
      REQUIRE(x.beats == y.beats);
      REQUIRE(x.clock_in == y.clock_in);
      REQUIRE(x.clock_out == y.clock_out);
    }
    CHECK(rtl->statistics().clocks == model->statistics().clocks);
    CHECK(rtl->statistics().beats == model->statistics().beats);
    CHECK(rtl->statistics().waiting_clocks == model->statistics().waiting_clocks);
  }
}

TEST_CASE("engines: statistics are sums over the modules", "[system][engines]") {
  Source source(3);
  std::vector<GridPair> pairs;
  pairs.reserve(3000);
  for (int i = 0; i < 3000; ++i) pairs.push_back(source.pair());
  const auto engine = engine_of(EngineKind::model);
  const auto answers = engine->run(pairs, PairMode::directed);
  std::uint64_t beats = 0;
  for (const EngineAnswer& answer : answers) beats += static_cast<std::uint64_t>(answer.beats);
  CHECK(engine->statistics().beats == beats);
  CHECK(engine->statistics().waiting_clocks >= beats);
  CHECK(engine->statistics().clocks > beats);
}
