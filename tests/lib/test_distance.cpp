// SPDX-License-Identifier: Apache-2.0
// Distances of faces against brute force in integers.
#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>
#include <cchip/distance.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <cchip/internal/exact/posed_distances.hpp>
#include <cchip/shapes.hpp>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <optional>

#include "bvh_meshes.hpp"
#include "distance_oracle.hpp"
#include "random_pairs.hpp"
#include "random_poses.hpp"

using namespace cchip;
using namespace cchip_test;

namespace {

__extension__ using Int128 = __int128;

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Count {
  int pairs = 0;
  int meet = 0;
  int open = 0;   ///< questions that took integers
  int exact = 0;  ///< distances that are doubles
};

std::string text_of(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b, double d) {
  std::ostringstream text;
  text.precision(17);
  for (const Primitive* p : {&a, &b}) {
    for (std::size_t i = 0; i < p->vertex_count(); ++i) text << p->v[i].transpose() << "; ";
  }
  text << '\n' << pose_a.affine() << '\n' << pose_b.affine() << "\nd " << d << " seed " << seed();
  return text.str();
}

/// Questions whose answers change at the distance, and the enclosures.
void check(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b,
           const IntSquare<BigInt>& square, int unit_bits, Count& count) {
  REQUIRE(square.under > 0);
  ++count.pairs;
  count.meet += square.over == 0;
  const PosedDistances distances(pose_a, pose_b);
  const double root = rough_root(square, unit_bits);
  for (const double d :
       {0.0, root, std::nextafter(root, infinity), std::nextafter(root, 0.0), 0.75 * root, 1.5 * root}) {
    if (!(d < infinity)) continue;
    const int sign = compare(square, d, unit_bits);
    const PosedDistances::Answer within = distances.within(a, b, d);
    const PosedDistances::Answer nearer = distances.nearer(a, b, d);
    count.open += within.open;
    if (within.hit == (sign <= 0) && nearer.hit == (sign < 0)) continue;
    FAIL("within " << within.hit << ", nearer " << nearer.hit << ", sign " << sign << ": "
                   << text_of(a, pose_a, b, pose_b, d));
  }
  const DistanceBounds rough = distances.bounds(a, b);
  const DistanceBounds tight = distances.tight_bounds(a, b);
  for (const DistanceBounds& bounds : {rough, tight}) {
    if (compare(square, bounds.lower, unit_bits) >= 0 &&
        (bounds.upper == infinity || compare(square, bounds.upper, unit_bits) <= 0)) {
      continue;
    }
    FAIL("bounds " << bounds.lower << ' ' << bounds.upper << ": " << text_of(a, pose_a, b, pose_b, root));
  }
  count.exact += tight.lower == tight.upper;
  if (tight.upper > std::nextafter(tight.lower, infinity) ||
      (tight.lower < tight.upper &&
       (compare(square, tight.lower, unit_bits) == 0 || compare(square, tight.upper, unit_bits) == 0))) {
    FAIL("not tight: " << tight.lower << ' ' << tight.upper << ": " << text_of(a, pose_a, b, pose_b, root));
  }
}

/// Some coordinates go to a neighbouring double.
void nudge(Primitive& p, std::mt19937_64& random) {
  for (Vec3d& v : p.v) {
    for (double& c : v) {
      if (random() % 4 == 0) c = std::nextafter(c, random() % 2 == 0 ? 1e300 : -1e300);
    }
  }
}

std::vector<IntPoint<Int128>> grid_points(const GridPrimitive& p) {
  std::vector<IntPoint<Int128>> points;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) points.push_back({p.v[i][0], p.v[i][1], p.v[i][2]});
  return points;
}

BigInt big(Int128 x) {
  const bool negative = x < 0;
  const auto size = static_cast<unsigned long long>((negative ? -x : x) >> 64);
  const BigInt value = (BigInt(size) << 64) + static_cast<unsigned long long>(negative ? -x : x);
  return negative ? BigInt(-value) : value;
}

}  // namespace

TEST_CASE("distance: faces on a grid", "[lib][distance]") {
  Count count;
  std::mt19937_64 random(seed() + 5);
  for (const PairClass c : pair_classes) {
    for (const int range : {2, 40}) {
      PairSource source(-range, range, static_cast<std::uint64_t>(c) + 150 + static_cast<std::uint64_t>(range));
      for (int i = 0; i < 10000; ++i) {
        GridPair grid = source.pair(c, i % 3 == 0 ? Kind::quad : Kind::tri, i % 4 == 0 ? Kind::quad : Kind::tri);
        // Touching and shared pairs are moved apart along an axis, so that features face each other.
        const int along = static_cast<int>(random() % 3);
        const int by = i % 2 == 0 ? 0 : static_cast<int>(random() % 64);
        for (Vec3i& v : grid.b.v) v[along] += by;
        const IntSquare<Int128> square = square_of_distance(grid_points(grid.a), grid_points(grid.b));
        REQUIRE((square.over == 0) == exact_intersects(scaled(grid.a, 0), scaled(grid.b, 0)));
        check(scaled(grid.a, -4), Pose::Identity(), scaled(grid.b, -4), Pose::Identity(),
              {big(square.over), big(square.under)}, 4, count);
      }
    }
  }
  std::cout << "pairs=" << count.pairs << " meet=" << count.meet << " open=" << count.open << " exact=" << count.exact
            << '\n';
  CHECK(count.pairs == 100000);
  CHECK(count.meet > 20000);
  CHECK(count.meet < 80000);
  CHECK(count.exact > count.meet + 5000);
  CHECK(count.open > 1000);
}

namespace {

void compare_posed(int rounds, Count& count) {
  std::mt19937_64 random(seed() + 6);
  for (const PairClass c : pair_classes) {
    PairSource source(-40, 40, static_cast<std::uint64_t>(c) + 250);
    for (int i = 0; i < rounds; ++i) {
      const GridPair grid = source.pair(c, i % 3 == 0 ? Kind::quad : Kind::tri, i % 4 == 0 ? Kind::quad : Kind::tri);
      const int size = i % 7 == 0 ? std::array<int, 4>{-1060, -500, 340, 500}[random() % 4] : -4;
      Primitive a = scaled(grid.a, size);
      Primitive b = scaled(grid.b, size);
      const PoseClass pose_class = pose_classes[static_cast<std::size_t>(i / 2) % std::size(pose_classes)];
      const double range = i % 5 == 0 ? 0x1p30 : 4;
      Pose pose_a = random_pose(pose_class, range, random);
      Pose pose_b = i % 3 == 0 ? random_pose(pose_class, 2, random) : pose_a;
      if (i % 3 == 1) pose_b.translation() += Vec3d(1, 2, static_cast<double>(random() % 8));
      if (size != -4) {
        const double factor = std::ldexp(1.0, std::max(size, -500));
        pose_a.translation() *= factor;
        pose_b.translation() *= factor;
      }
      if (i % 2 == 1) {
        nudge(a, random);
        nudge(b, random);
      }
      constexpr int unit_bits = 2300;
      const IntSquare<BigInt> square =
          square_of_distance(posed_points(a, pose_a, unit_bits), posed_points(b, pose_b, unit_bits));
      REQUIRE((square.over == 0) == exact_intersects(a, pose_a, b, pose_b));
      check(a, pose_a, b, pose_b, square, unit_bits, count);
    }
  }
  std::cout << "pairs=" << count.pairs << " meet=" << count.meet << " open=" << count.open << " exact=" << count.exact
            << '\n';
  CHECK(count.meet > count.pairs / 20);
  CHECK(count.meet < count.pairs * 9 / 10);
  CHECK(count.open > count.pairs / 10);
}

}  // namespace

TEST_CASE("distance: faces under poses", "[lib][distance]") {
  Count count;
  compare_posed(400, count);
}

TEST_CASE("distance: of points to a surface, all faces looked at in integers", "[lib][distance]") {
  std::mt19937_64 random(seed() + 40);
  const Object object(make_sphere(1, 2, 0.25));
  const Mesh& mesh = object.mesh();
  std::map<std::string, int> drawn;
  for (const PoseClass c :
       {PoseClass::integers, PoseClass::rigid, PoseClass::affine, PoseClass::mirror, PoseClass::flat}) {
    Pose pose = random_pose(c, 2, random);
    if (c == PoseClass::integers) pose.setIdentity();
    std::vector<Vec3d> points = {pose.translation(), Vec3d(1e6, 3, -0.1)};
    for (int i = 0; i < 6; ++i) points.push_back(pose * (2 * testing::random_vector(random, 1)));
    for (int i = 0; i < 3; ++i) points.push_back(pose * mesh.vertices[random() % mesh.vertices.size()]);  // about on it
    const std::vector<DistanceResult> results = distances(object, pose, points, {}, 1);
    REQUIRE(results.size() == points.size());
    constexpr int unit_bits = 400;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::vector<IntPoint<BigInt>> at =
          posed_points({Kind::tri, {points[i], points[i], points[i], {}}}, Pose::Identity(), unit_bits);
      std::optional<boost::multiprecision::cpp_rational> least;
      for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
        const IntSquare<BigInt> square =
            square_of_distance(posed_points(mesh.primitive(face), pose, unit_bits), {at[0]});
        const boost::multiprecision::cpp_rational value(square.over, square.under);
        if (!least || value < *least) least = value;
      }
      const auto squared = [&](double x) {
        boost::multiprecision::cpp_rational result(x);
        return boost::multiprecision::cpp_rational(result * result * (BigInt(1) << 2 * unit_bits));
      };
      CAPTURE(int(c), i);
      CHECK(squared(results[i].lower) <= *least);
      CHECK(squared(results[i].upper) >= *least);
      CHECK((results[i].lower == results[i].upper ||
             results[i].upper == std::nextafter(results[i].lower, std::numeric_limits<double>::infinity())));
      CHECK((results[i].point_b - points[i]).norm() <= 1e-12 * (1 + points[i].norm()));
      ++drawn[*least == 0 ? "on it" : "off it"];
    }
  }
  for (const auto& [kind, count] : drawn) std::cout << kind << ' ' << count << '\n';
  CHECK(drawn.size() == 2);
  // Threads give the same, in the same order.
  std::vector<Vec3d> many;
  for (int i = 0; i < 1000; ++i) many.push_back(2 * testing::random_vector(random, 1));
  const std::vector<DistanceResult> one = distances(object, Pose::Identity(), many, {}, 1);
  const std::vector<DistanceResult> three = distances(object, Pose::Identity(), many, {}, 3);
  for (std::size_t i = 0; i < many.size(); ++i) CHECK(one[i].lower == three[i].lower);
  CHECK(distances(object, Pose::Identity(), {}).empty());
  many[700].y() = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(distances(object, Pose::Identity(), many), Catch::Contains("point 700"));
}

TEST_CASE("distance: many faces under poses", "[.long]") {
  Count count;
  compare_posed(20000, count);
}
