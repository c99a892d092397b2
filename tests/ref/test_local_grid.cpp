// SPDX-License-Identifier: Apache-2.0
// quantise() against the definition, in big integers: all coordinates are taken as multiples of 2^-1200.
#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>
#include <cchip/internal/grid/local_grid.hpp>
#include <cchip/internal/wire/definitions.hpp>
#include <cmath>
#include <limits>
#include <optional>

#include "random_pairs.hpp"

using namespace cchip_test;
using boost::multiprecision::cpp_int;
using cchip::Primitive;
using cchip::QuantisedPair;
using cchip::Vec3d;

namespace {

constexpr int unit_exponent = -1200;

cpp_int units(double value) {
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
  return mantissa == 0 ? cpp_int(0) : cpp_int(cpp_int(mantissa) << (exponent - 53 - unit_exponent));
}

cpp_int units_of_step(int exponent) { return cpp_int(1) << (exponent - unit_exponent); }

struct Vertex {
  std::array<cpp_int, 3> exact;  ///< units
  Vec3i grid;                    ///< steps from the origin of the grid
};

std::vector<Vertex> vertices(const Primitive& a, const Primitive& b, const QuantisedPair& q) {
  std::vector<Vertex> result;
  const auto add = [&result](const Primitive& p, const GridPrimitive& g) {
    for (std::size_t i = 0; i < p.vertex_count(); ++i) {
      result.push_back({{units(p.v[i].x()), units(p.v[i].y()), units(p.v[i].z())}, g.v[i]});
    }
  };
  add(a, q.pair.a);
  add(b, q.pair.b);
  return result;
}

/// Nearest multiple of the step, ties to even, in steps.
cpp_int nearest(const cpp_int& value, const cpp_int& step) {
  const cpp_int magnitude = abs(value);
  cpp_int quotient = magnitude / step;
  const cpp_int twice_rest = 2 * (magnitude % step);
  if (twice_rest > step || (twice_rest == step && quotient % 2 != 0)) ++quotient;
  return value < 0 ? cpp_int(-quotient) : quotient;
}

/// Do the vertices, rounded to multiples of 2^exponent, span less than 2^coord_w steps on every axis?
bool box_fits(const std::vector<Vertex>& points, int exponent, int coord_w) {
  const cpp_int step = units_of_step(exponent);
  for (std::size_t d = 0; d < 3; ++d) {
    cpp_int least = nearest(points[0].exact[d], step);
    cpp_int greatest = least;
    for (const Vertex& p : points) {
      const cpp_int x = nearest(p.exact[d], step);
      least = min(least, x);
      greatest = max(greatest, x);
    }
    if (greatest - least >= cpp_int(1) << coord_w) return false;
  }
  return true;
}

bool positions_fit(const std::vector<Vertex>& points, int exponent) {
  const cpp_int limit = units_of_step(exponent) << 62;
  for (const Vertex& p : points) {
    for (const cpp_int& x : p.exact) {
      if (abs(x) >= limit) return false;
    }
  }
  return true;
}

/// Greatest exponent of which all coordinates are multiples; nothing if all are zero.
std::optional<int> coarsest_exact(const std::vector<Vertex>& points) {
  std::optional<int> lowest;
  for (const Vertex& p : points) {
    for (const cpp_int& x : p.exact) {
      if (x == 0) continue;
      const int bit = static_cast<int>(lsb(cpp_int(abs(x)))) + unit_exponent;
      lowest = std::min(lowest.value_or(bit), bit);
    }
  }
  return lowest;
}

bool can_be_exact(const std::vector<Vertex>& points, int coord_w) {
  const std::optional<int> exponent = coarsest_exact(points);
  return !exponent || (positions_fit(points, *exponent) && box_fits(points, *exponent, coord_w));
}

/// Everything that DESIGN and the header promise about a result.
void check_result(const std::vector<Vertex>& points, const QuantisedPair& q, int coord_w) {
  const cpp_int step = units_of_step(q.grid.exponent);
  const cpp_int half_range = cpp_int(1) << (coord_w - 1);
  bool legal = true;
  bool near = true;
  bool exact = true;
  for (const Vertex& p : points) {
    for (std::size_t d = 0; d < 3; ++d) {
      const cpp_int steps = p.grid[static_cast<Eigen::Index>(d)];
      const cpp_int error = abs(cpp_int((steps + q.grid.origin[d]) * step - p.exact[d]));
      legal = legal && steps >= -half_range && steps < half_range;
      near = near && 2 * error <= step;
      exact = exact && error == 0;
    }
  }
  CHECK(legal);
  CHECK(near);
  CHECK(q.pair.eta == (exact ? 0 : 1));
  CHECK((q.pair.eta == 0) == can_be_exact(points, coord_w));
  if (q.pair.eta == 1) CHECK_FALSE(box_fits(points, q.grid.exponent - 1, coord_w));
}

void check_pair(const Primitive& a, const Primitive& b, int coord_w, int& exact, int& rounded, int& refused) {
  std::ostringstream text;
  text.precision(17);
  for (const Primitive* p : {&a, &b}) {
    for (std::size_t i = 0; i < p->vertex_count(); ++i) text << " (" << p->v[i].transpose() << ")";
  }
  INFO("coord_w " << coord_w << ", seed " << seed() << text.str());
  try {
    const QuantisedPair q = quantise(a, b, coord_w);
    check_result(vertices(a, b, q), q, coord_w);
    CHECK(q.pair.a.kind == a.kind);
    CHECK(q.pair.b.kind == b.kind);
    ++(q.pair.eta == 0 ? exact : rounded);
  } catch (const cchip::GridError& error) {
    ++refused;
    const std::vector<Vertex> points = vertices(a, b, QuantisedPair());
    CHECK_FALSE(can_be_exact(points, coord_w));
    int finest = unit_exponent;
    while (!box_fits(points, finest, coord_w)) ++finest;
    CHECK_FALSE(positions_fit(points, finest));  // the finest grid for the box is too fine for the distance
  }
}

/// Ways to draw a coordinate.
enum class Magnitude { alike, unlike, few_bits, denormal, huge, far };
constexpr Magnitude magnitudes[] = {Magnitude::alike,    Magnitude::unlike, Magnitude::few_bits,
                                    Magnitude::denormal, Magnitude::huge,   Magnitude::far};

double draw(PairSource& source, Magnitude magnitude, int scale) {
  const double unit =
      std::ldexp(source.integer(-(1 << 30), 1 << 30), -30) + std::ldexp(source.integer(0, 1 << 22), -53);
  switch (magnitude) {
    case Magnitude::alike:
      return std::ldexp(unit, scale);
    case Magnitude::unlike:
      return std::ldexp(unit, source.integer(-300, 300));
    case Magnitude::few_bits:
      return std::ldexp(source.integer(-100, 100), scale % 20);
    case Magnitude::denormal:
      return std::ldexp(unit, source.integer(-1074, -1050));
    case Magnitude::huge:
      return std::ldexp(unit, 1023);
    case Magnitude::far:
      return std::ldexp(1.0, 40) + std::ldexp(unit, scale % 36);
  }
  return 0;
}

}  // namespace

TEST_CASE("local grid: random pairs keep every promise", "[ref][local_grid]") {
  PairSource source(-1, 1, 40);
  for (const Magnitude magnitude : magnitudes) {
    int exact = 0;
    int rounded = 0;
    int refused = 0;
    constexpr int pairs = 1000;
    for (int i = 0; i < pairs; ++i) {
      Primitive a;
      Primitive b;
      const int scale = source.integer(-60, 60);
      for (Primitive* p : {&a, &b}) {
        if (source.coin()) p->kind = Kind::quad;
        for (Vec3d& v : p->v) {
          for (double& c : v) c = draw(source, magnitude, scale);
        }
      }
      check_pair(a, b, source.integer(cchip::defs::coord_w_min, cchip::defs::coord_w_max), exact, rounded, refused);
    }
    INFO("magnitude class " << static_cast<int>(magnitude) << ": exact " << exact << ", rounded " << rounded);
    CHECK(exact + rounded + refused == pairs);
    if (magnitude == Magnitude::few_bits) CHECK(exact > pairs / 10);
    if (magnitude != Magnitude::few_bits) CHECK(rounded > pairs / 10);
    if (magnitude != Magnitude::far) CHECK(refused == 0);
  }
}

TEST_CASE("local grid: boxes at and around a full range", "[ref][local_grid]") {
  int exact = 0;
  int rounded = 0;
  int refused = 0;
  for (const int w : {4, 16, 20}) {
    const double full = std::ldexp(1.0, w) - 1;  // steps
    for (const double extent : {full - 1, full - 0.5, full, full + 0.25, full + 0.5, full + 0.75, full + 1, 2 * full}) {
      for (const double from : {0.0, -full, 0.25, 0.5, -1e6}) {
        for (const int scale : {0, -30, 200}) {
          const double low = std::ldexp(from, scale);
          const double high = std::ldexp(from + extent, scale);
          check_pair(make_triangle<Primitive>({low, 0, 0}, {low, high, 0}, {low, 0, low}),
                     make_triangle<Primitive>({high, 0, 0}, {0, low, 0}, {0, 0, 0}), w, exact, rounded, refused);
        }
      }
    }
  }
  CHECK(exact > 0);
  CHECK(rounded > 0);
  CHECK(refused == 0);
}

TEST_CASE("local grid: integers in range go in verbatim", "[ref][local_grid]") {
  for (const int w : {4, 8, 16, 20}) {
    const int lo = -(1 << (w - 1));
    const int hi = -lo - 1;
    PairSource source(lo, hi, static_cast<std::uint64_t>(w));
    for (int i = 0; i < 500; ++i) {
      GridPair pair = source.pair(PairClass::general, Kind::tri, Kind::quad);
      if (i % 2 == 0) {  // even numbers must not be put on a coarser grid
        for (GridPrimitive* p : {&pair.a, &pair.b}) {
          for (Vec3i& v : p->v) v = v / 2 * 2;
        }
      }
      Primitive a;
      Primitive b;
      b.kind = Kind::quad;
      for (std::size_t k = 0; k < 4; ++k) {
        a.v[k] = pair.a.v[k].cast<double>();
        b.v[k] = pair.b.v[k].cast<double>();
      }
      const QuantisedPair q = quantise(a, b, w);
      INFO(describe(pair));
      REQUIRE(q.pair.eta == 0);
      REQUIRE(q.grid.exponent == 0);
      REQUIRE(q.grid.origin == std::array<std::int64_t, 3>{0, 0, 0});
      REQUIRE(describe(q.pair) == describe(pair));
    }
  }
}

TEST_CASE("local grid: points, zeros and equal primitives", "[ref][local_grid]") {
  const Primitive zero = make_triangle<Primitive>(Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero());
  CHECK(quantise(zero, zero, 16).pair.eta == 0);
  const Vec3d p(0.1, -0.7, 1e9);
  int exact = 0;
  int rounded = 0;
  int refused = 0;
  check_pair(make_triangle<Primitive>(p, p, p), make_triangle<Primitive>(p, p, p), 16, exact, rounded, refused);
  check_pair(make_triangle<Primitive>(p, p, p), make_triangle<Primitive>(p, p, p), 4, exact, rounded, refused);
  check_pair(zero, make_triangle<Primitive>(p, p, p), 16, exact, rounded, refused);
  CHECK(rounded == 1);
}

TEST_CASE("local grid: pairs that no grid holds are refused in one line", "[ref][local_grid]") {
  const Primitive fine = make_triangle<Primitive>({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    CHECK_THROWS_WITH(quantise(fine, make_triangle<Primitive>({0, 0, 0}, {1, bad, 0}, {0, 1, 0}), 16),
                      Catch::Contains("vertex b1") && Catch::Contains("finite"));
    CHECK_THROWS_AS(quantise(make_triangle<Primitive>({bad, 0, 0}, {1, 0, 0}, {0, 1, 0}), fine, 16), cchip::GridError);
  }
  const auto remedy = Catch::Contains("move both primitives nearer to the origin");
  const Primitive far = make_triangle<Primitive>({1e6, 0, 0}, {1e6, 1.1e-12, 0}, {1e6, 0, 1e-12});
  CHECK_THROWS_WITH(quantise(far, far, 20), remedy);
  const Vec3d spread(1e300, 1e-300, 0);
  CHECK_THROWS_WITH(
      quantise(make_triangle<Primitive>(spread, spread, spread), make_triangle<Primitive>(spread, spread, spread), 16),
      remedy);
  CHECK_THROWS_AS(quantise(fine, fine, 3), std::invalid_argument);
  CHECK_THROWS_AS(quantise(fine, fine, 21), std::invalid_argument);
}
