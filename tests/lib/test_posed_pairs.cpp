// SPDX-License-Identifier: Apache-2.0
// Filtered answers against integers of any size.
#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <cchip/internal/exact/posed_pairs.hpp>
#include <cmath>
#include <iostream>
#include <limits>

#include "exact/posed_ints.hpp"
#include "random_pairs.hpp"
#include "random_poses.hpp"

using namespace cchip;
using namespace cchip_test;

namespace {

/// Some coordinates go to a neighbouring double.
void nudge(Primitive& p, std::mt19937_64& random) {
  for (Vec3d& v : p.v) {
    for (double& c : v) {
      if (random() % 4 == 0) c = std::nextafter(c, random() % 2 == 0 ? 1e300 : -1e300);
    }
  }
}

struct Count {
  int pairs = 0;
  int hits = 0;
  int open = 0;
};

void check(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b, const char* what,
           Count& count) {
  const PosedPairs::Answer answer = PosedPairs(pose_a, pose_b).decide(a, b);
  ++count.pairs;
  count.hits += answer.hit;
  count.open += answer.open;
  if (answer.hit == exact_intersects(a, pose_a, b, pose_b)) return;
  std::ostringstream text;
  text.precision(17);
  for (const Primitive* p : {&a, &b}) {
    for (std::size_t i = 0; i < p->vertex_count(); ++i) text << p->v[i].transpose() << "; ";
  }
  text << '\n' << pose_a.affine() << '\n' << pose_b.affine();
  FAIL(what << ", pair " << count.pairs << ", seed " << seed() << ", filter says " << answer.hit << ": " << text.str());
}

/// Every class of pairs of a grid, under one pose, so that touching, coplanar and degenerate pairs stay so, each also
/// with coordinates moved to neighbours, at many magnitudes; then with a pose for each primitive.
void compare(int rounds, Count& same, Count& nudged, Count& apart, Count& extreme) {
  std::mt19937_64 random(seed() + 77);
  for (const PairClass c : pair_classes) {
    PairSource source(-40, 40, static_cast<std::uint64_t>(c) + 50);
    for (int i = 0; i < rounds; ++i) {
      const GridPair grid = source.pair(c, i % 3 == 0 ? Kind::quad : Kind::tri, i % 4 == 0 ? Kind::quad : Kind::tri);
      Primitive a = scaled(grid.a, -4);
      Primitive b = scaled(grid.b, -4);
      const PoseClass pose_class = pose_classes[static_cast<std::size_t>(i) % std::size(pose_classes)];
      const Pose pose = random_pose(pose_class, 2, random);
      check(a, pose, b, pose, name(c), same);
      if (is_invertible(pose_class) &&
          exact_intersects(a, pose, b, pose) != exact_intersects(scaled(grid.a, 0), scaled(grid.b, 0))) {
        FAIL("the oracle is wrong about " << describe(grid));
      }
      check(a, pose, b, random_pose(pose_class, 2, random), name(c), apart);
      nudge(a, random);
      nudge(b, random);
      check(a, pose, b, pose, name(c), nudged);
      const auto exponent = [&random] { return std::array<int, 5>{-1060, -500, -330, 340, 500}[random() % 5]; };
      const int size = exponent();
      Pose huge = pose;
      huge.translation() *= std::ldexp(1.0, std::abs(size) < 600 ? size : 0);
      check(scaled(grid.a, size), huge, scaled(grid.b, size), huge, name(c), extreme);
      huge = pose;
      huge.linear() *= std::ldexp(1.0, std::max(-500, size));
      check(a, huge, scaled(grid.b, exponent()), random_pose(pose_class, std::ldexp(1.0, size), random), name(c),
            extreme);
    }
  }
}

void check_counts(const Count& c, double hits_least, double hits_most) {
  CAPTURE(c.pairs, c.hits, c.open);
  CHECK(c.hits > hits_least * c.pairs);
  CHECK(c.hits < hits_most * c.pairs);
  CHECK(c.open > 0);
  CHECK(c.open < c.pairs);
}

void compare_and_count(int rounds) {
  Count same;
  Count nudged;
  Count apart;
  Count extreme;
  compare(rounds, same, nudged, apart, extreme);
  check_counts(same, 0.3, 0.95);
  check_counts(nudged, 0.2, 0.9);
  check_counts(apart, 0.02, 0.9);
  check_counts(extreme, 0.05, 0.95);
  for (const Count& c : {same, nudged, apart, extreme}) {
    std::cout << "pairs=" << c.pairs << " hits=" << c.hits << " open=" << c.open << '\n';
  }
}

using Integer = boost::multiprecision::cpp_int;

/// Of up to 127 bits, often with long runs of equal bits.
template <class Random>
exact::SInt128 random_int128(Random& random) {
  const auto word = [&random]() -> std::uint64_t {
    const std::uint64_t w = random();
    switch (random() % 4) {
      case 0:
        return 0;
      case 1:
        return ~std::uint64_t{0};
      default:
        return w;
    }
  };
  const auto value = static_cast<exact::SInt128>(exact::UInt128{word()} << 64U | word());
  return value >> (1 + random() % 127);
}

Integer integer_of(exact::SInt128 value) {
  const bool negative = value < 0;
  const exact::UInt128 size = negative ? -static_cast<exact::UInt128>(value) : static_cast<exact::UInt128>(value);
  const Integer result = (Integer(static_cast<std::uint64_t>(size >> 64U)) << 64U) + static_cast<std::uint64_t>(size);
  return negative ? Integer(-result) : result;
}

template <std::size_t N>
void check_arithmetic(std::mt19937_64& random) {
  using Wide = exact::WideInt<N>;
  constexpr int shift_most = Wide::bits / 3 - 66;
  for (int i = 0; i < 20000; ++i) {
    std::array<Wide, 3> wide;
    std::array<Integer, 3> any;
    for (std::size_t k = 0; k < 3; ++k) {
      const exact::SInt128 value = random_int128(random) >> 64;
      const int shift = static_cast<int>(random() % static_cast<unsigned>(shift_most + 1));
      wide[k] = Wide(value, shift);
      any[k] = integer_of(value) * (Integer(1) << shift);
    }
    const auto& [x, y, z] = wide;
    const auto& [p, q, r] = any;
    REQUIRE(x.sign() == p.sign());
    REQUIRE((x < y) == (p < q));
    REQUIRE((x <= y) == (p <= q));
    REQUIRE((x * y * z - x * z + y).sign() == Integer(p * q * r - p * r + q).sign());
    REQUIRE((x * y - y * x).sign() == 0);
    // A number less its own value, however it was made, is 0; one more is positive.
    const exact::SInt128 value = random_int128(random);
    const int shift = static_cast<int>(random() % static_cast<unsigned>(Wide::bits - 128));
    Wide sum(0, 0);
    for (int bit = 0; bit < 128; ++bit) {
      if ((static_cast<exact::UInt128>(value) >> bit & 1U) == 0) continue;
      sum = bit == 127 ? sum - Wide(1, shift + bit) : sum + Wide(1, shift + bit);
    }
    REQUIRE((Wide(value, shift) - sum).sign() == 0);
    REQUIRE((Wide(value, shift) - sum + Wide(1, 0)).sign() == 1);
    REQUIRE((sum - Wide(value, shift) - Wide(1, 0)).sign() == -1);
  }
}

/// Pairs whose coordinates need as many bits as N words can take, of the greatest magnitudes and of the least.
template <std::size_t N>
void check_at_limit(std::mt19937_64& random, std::array<int, 3>& seen) {
  using exact::PosedInts;
  const int most = (exact::WideInt<N>::bits - 7) / 3;
  REQUIRE(exact::fits<N>(most));
  REQUIRE_FALSE(exact::fits<N>(most + 1));
  for (int i = 0; i < 3000; ++i) {
    const int low = -static_cast<int>(random() % 200);
    const int high = low + most;
    const auto coordinate = [&]() -> double {
      const double sign = random() % 2 == 0 ? 1 : -1;
      switch (random() % 6) {
        case 0:
          return 0;
        case 1:
          return sign * std::ldexp(1.0, low);
        case 2:
          return sign * std::ldexp(1.0, high - 1);
        default:
          return sign * std::ldexp(1 - 0x1p-53, high);
      }
    };
    Primitive a;
    Primitive b;
    a.kind = random() % 2 == 0 ? Kind::tri : Kind::quad;
    b.kind = random() % 2 == 0 ? Kind::tri : Kind::quad;
    for (Primitive* p : {&a, &b}) {
      for (std::size_t k = 0; k < p->vertex_count(); ++k) p->v[k] = Vec3d(coordinate(), coordinate(), coordinate());
    }
    a.v[0] = Vec3d(std::ldexp(1 - 0x1p-53, high), std::ldexp(1.0, low), 0);  // both ends of the range are in use
    const PosedInts ints_a(a, Pose::Identity());
    const PosedInts ints_b(b, Pose::Identity());
    const int exponent = std::min(ints_a.exponent(), ints_b.exponent());
    REQUIRE(std::max(ints_a.top(), ints_b.top()) - exponent == most);
    const auto hull_a = ints_a.hull<N>(exponent);
    const auto hull_b = ints_b.hull<N>(exponent);
    const Relation relation = exact_relation(a, b);
    REQUIRE(hulls_meet(hull_a, hull_b) == (relation != Relation::apart));
    if (relation != Relation::apart) REQUIRE(hulls_cross(hull_a, hull_b) == (relation == Relation::crossing));
    ++seen[static_cast<std::size_t>(relation)];
  }
}

}  // namespace

TEST_CASE("posed pairs: integers of fixed width agree with those of any size", "[lib][posed_pairs]") {
  std::mt19937_64 random(seed() + 17);
  check_arithmetic<4>(random);
  check_arithmetic<6>(random);
  check_arithmetic<8>(random);
}

TEST_CASE("posed pairs: integers of fixed width hold what they are asked to", "[lib][posed_pairs]") {
  std::mt19937_64 random(seed() + 19);
  std::array<int, 3> seen = {};
  check_at_limit<4>(random, seen);
  check_at_limit<6>(random, seen);
  check_at_limit<8>(random, seen);
  for (const int count : seen) CHECK(count > 100);
}

TEST_CASE("posed pairs: 10^5 agree with integers of any size", "[lib][posed_pairs]") { compare_and_count(4000); }

TEST_CASE("posed pairs: 10^6 agree with integers of any size", "[.long]") { compare_and_count(40000); }

TEST_CASE("posed pairs: whole numbers are decided without integers of any size", "[lib][posed_pairs]") {
  std::mt19937_64 random(seed());
  for (const PairClass c : pair_classes) {
    PairSource source(-200, 200, static_cast<std::uint64_t>(c) + 90);
    int open = 0;
    for (int i = 0; i < 2000; ++i) {
      const GridPair grid = source.pair(c, i % 3 == 0 ? Kind::quad : Kind::tri);
      const Pose pose = random_pose(PoseClass::integers, 3, random);
      open += PosedPairs(pose, pose).decide(scaled(grid.a, 0), scaled(grid.b, 0)).open;
      if (PosedPairs(Pose::Identity(), Pose::Identity()).decide(scaled(grid.a, 3), scaled(grid.b, 3)).hit !=
          exact_intersects(scaled(grid.a, 0), scaled(grid.b, 0))) {
        FAIL(describe(grid));
      }
    }
    CHECK(open == 0);
  }
}

TEST_CASE("posed pairs: flush faces across an axis are decided without integers of any size", "[lib][posed_pairs]") {
  std::mt19937_64 random(seed() + 11);
  std::uniform_real_distribution<double> unit(-1, 1);
  int hits = 0;
  int open = 0;
  constexpr int rounds = 3000;
  for (int i = 0; i < rounds; ++i) {
    const int axis = i % 3;
    const double height = unit(random);
    Pose pose_a = random_pose(PoseClass::quarter_turns, 1, random);
    Pose pose_b = pose_a;
    pose_b.translation() += pose_b.linear() * Vec3d::Unit((axis + 1) % 3) * unit(random);
    Primitive a;
    Primitive b;
    a.kind = i % 5 == 0 ? Kind::quad : Kind::tri;
    b.kind = i % 4 == 0 ? Kind::quad : Kind::tri;
    for (Primitive* p : {&a, &b}) {
      for (std::size_t k = 0; k < p->vertex_count(); ++k) {
        p->v[k] = Vec3d(unit(random), unit(random), unit(random));
        p->v[k][axis] = height;
      }
    }
    const PosedPairs pairs(pose_a, pose_b);
    const PosedPairs::Answer answer = pairs.decide(a, b);
    open += answer.open;
    hits += answer.hit;
    REQUIRE(answer.hit == exact_intersects(a, pose_a, b, pose_b));
    if (answer.hit) REQUIRE_FALSE(pairs.cross(a, b));
  }
  CAPTURE(hits);
  CHECK(open == 0);
  CHECK(hits > rounds / 3);
  CHECK(hits < rounds);
}

TEST_CASE("posed pairs: equal poses that have an inverse do not matter", "[lib][posed_pairs]") {
  std::mt19937_64 random(seed() + 13);
  std::array<int, 3> seen = {};
  for (const PairClass c : pair_classes) {
    PairSource source(-40, 40, static_cast<std::uint64_t>(c) + 70);
    for (int i = 0; i < 400; ++i) {
      const PoseClass pose_class = pose_classes[static_cast<std::size_t>(i) % std::size(pose_classes)];
      Pose pose = random_pose(pose_class, 2, random);
      if (i % 7 == 0) pose.linear().row(i % 3).setZero();  // singular
      if (i % 11 == 0) pose.linear() *= std::array<double, 4>{0x1p-400, 0x1p400, 0x1p-199, 0x1p199}[random() % 4];
      if (i % 13 == 0) pose.linear().col(i % 3) *= 0x1p-100;
      const GridPair grid = source.pair(c, i % 3 == 0 ? Kind::quad : Kind::tri);
      const Primitive a = scaled(grid.a, -3);
      const Primitive b = scaled(grid.b, -3);
      const PosedPairs pairs(pose, pose);
      const bool hit = pairs.decide(a, b).hit;
      const Relation relation = exact_relation(a, pose, b, pose);
      REQUIRE(hit == (relation != Relation::apart));
      if (hit) REQUIRE(pairs.cross(a, b) == (relation == Relation::crossing));
      ++seen[static_cast<std::size_t>(relation)];
    }
  }
  for (const int count : seen) CHECK(count > 100);

  // Turned together, flush faces lie as they do unturned: whole numbers stay whole.
  const Pose turned = make_pose({0.1, 0.2, 0.3}, {30, 40, 50});
  Primitive a;
  a.v = {Vec3d(0, 0, 1), Vec3d(4, 0, 1), Vec3d(0, 4, 1), Vec3d::Zero()};
  Primitive b = a;
  for (Vec3d& v : b.v) v += Vec3d(1, 1, 0);
  const PosedPairs::Answer answer = PosedPairs(turned, turned).decide(a, b);
  CHECK(answer.hit);
  CHECK_FALSE(answer.open);
}

TEST_CASE("posed pairs: a product that no double holds decides", "[lib][posed_pairs]") {
  // The point lies at 0.1 x 0.1 in exact arithmetic, which is not the double 0.1 * 0.1.
  Primitive point;
  point.v = {Vec3d(0.1, 0, 0), Vec3d(0.1, 0, 0), Vec3d(0.1, 0, 0), Vec3d::Zero()};
  Pose tenth = Pose::Identity();
  tenth.linear() *= 0.1;
  Primitive segment;  // from the exact product's rounded value away from it
  const double rounded = 0.1 * 0.1;
  const bool below = std::fma(0.1, 0.1, -rounded) < 0;
  for (const bool reaches : {false, true}) {
    const double end = below ? (reaches ? -1.0 : 1.0) : (reaches ? 1.0 : -1.0);
    segment.v = {Vec3d(rounded, 0, 0), Vec3d(end, 0, 0), Vec3d(end, 0, 0), Vec3d::Zero()};
    const PosedPairs::Answer answer = PosedPairs(tenth, Pose::Identity()).decide(point, segment);
    CHECK(answer.hit == reaches);
    CHECK(exact_intersects(point, tenth, segment, Pose::Identity()) == reaches);
  }
}

TEST_CASE("posed pairs: common translations do not matter", "[lib][posed_pairs]") {
  std::mt19937_64 random(seed() + 5);
  PairSource source(-30, 30, 5);
  int open = 0;
  for (int i = 0; i < 2000; ++i) {
    const GridPair grid = source.pair(PairClass::general);
    Pose pose_a = random_pose(PoseClass::rigid, 1, random);
    Pose pose_b = pose_a;
    pose_b.linear() *= 2;  // equal poses would leave the question
    const Primitive a = scaled(grid.a, -5);
    const Primitive b = scaled(grid.b, -6);
    const bool hit = PosedPairs(pose_a, pose_b).decide(a, b).hit;
    pose_a.translation().array() += 0x1p80;
    pose_b.translation() = pose_a.translation();
    const PosedPairs::Answer far = PosedPairs(pose_a, pose_b).decide(a, b);
    open += far.open;
    CHECK(far.hit == hit);
  }
  CHECK(open < 20);
}

TEST_CASE("posed pairs: what lies within the hull of four points meets it, whichever comes first",
          "[lib][posed_pairs]") {
  Primitive great;
  great.kind = Kind::quad;
  great.v = {Vec3d(0, 0, 0), Vec3d(8, 0, 0), Vec3d(0, 8, 0), Vec3d(0, 0, 8)};
  Pose turned = Pose::Identity();
  turned.linear() = Eigen::AngleAxisd(0.7, Vec3d(1, 2, 3).normalized()).toRotationMatrix();
  turned.translation() = Vec3d(0.1, -7, 1.0 / 3);
  for (const Kind kind : {Kind::tri, Kind::quad}) {
    Primitive within;
    within.kind = kind;
    within.v = {Vec3d(1, 1, 1), Vec3d(2, 1, 1), Vec3d(1, 2, 1), Vec3d(1, 1, 2)};
    Primitive beside = within;  // beyond the face that is not along an axis
    for (Vec3d& v : beside.v) v += Vec3d(2, 2, 2);
    for (const Pose& pose : {Pose(Pose::Identity()), turned}) {
      const PosedPairs pairs(pose, pose);
      CHECK(pairs.decide(great, within).hit);
      CHECK(pairs.decide(within, great).hit);
      CHECK_FALSE(pairs.decide(great, beside).hit);
      CHECK_FALSE(pairs.decide(beside, great).hit);
    }
  }
}

// Vertices and translation are 10^6 times as large as what they leave, so what counts is how far their sum is rounded.
TEST_CASE("posed pairs: a vertex at a plane, where large numbers cancel", "[lib][posed_pairs]") {
  std::mt19937_64 random(seed() + 78);
  Count count;
  const auto vector = [&random] {
    std::uniform_real_distribution<double> range(-1, 1);
    const double x = range(random);
    const double y = range(random);
    return Vec3d(x, y, range(random));
  };
  for (int i = 0; i < 60; ++i) {
    const Vec3d far = Vec3d(0x1p20, 0, 0) + vector();
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::AngleAxisd(0x1p-10, vector().normalized()).toRotationMatrix();
    pose.translation() = vector() - pose.linear() * far;
    Primitive a;
    for (std::size_t k = 0; k < 3; ++k) a.v[k] = far + vector();
    std::array<double, 3> height = {};
    for (std::size_t k = 0; k < 3; ++k) height[k] = (pose * a.v[k]).x();
    const double lowest = *std::min_element(height.begin(), height.end());
    for (int step = -3; step <= 3; ++step) {
      Primitive plane;
      const double x = lowest + step * 0x1p-35;
      plane.v = {Vec3d(x, -64, -64), Vec3d(x, 64, -64), Vec3d(x, 0, 64)};
      check(a, pose, plane, Pose::Identity(), "cancelled", count);
      check(plane, Pose::Identity(), a, pose, "cancelled", count);
    }
  }
  check_counts(count, 0.3, 0.7);
}

TEST_CASE("posed pairs: refuse what is not finite", "[lib][posed_pairs]") {
  Pose pose = Pose::Identity();
  pose.translation().y() = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(PosedPairs(pose, Pose::Identity()), std::invalid_argument);
  CHECK_THROWS_AS(PosedPairs(Pose::Identity(), pose), std::invalid_argument);
  Primitive p;
  CHECK_THROWS_AS(exact_intersects(p, pose, p, Pose::Identity()), std::invalid_argument);
  // In a coordinate that the pose multiplies by 0, too.
  Pose flat = Pose::Identity();
  flat.linear()(2, 2) = 0;
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      Primitive odd;
      odd.v[1][k] = bad;
      for (const Pose& place : {Pose(Pose::Identity()), flat}) {
        CHECK_THROWS_AS(PosedPairs(place, Pose::Identity()).decide(odd, p), std::invalid_argument);
        CHECK_THROWS_AS(PosedPairs(Pose::Identity(), place).decide(p, odd), std::invalid_argument);
      }
    }
  }
}
