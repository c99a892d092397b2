// SPDX-License-Identifier: Apache-2.0
// Intersections of faces against brute force in fractions.
#include <catch2/catch.hpp>
#include <cchip/internal/exact/intersection.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <iostream>
#include <limits>
#include <map>

#include "intersection_oracle.hpp"
#include "random_pairs.hpp"
#include "random_poses.hpp"

using namespace cchip;
using namespace cchip_test;

namespace {

using Kinds = Intersection::Kind;

struct Count {
  int pairs = 0;
  std::map<Kinds, int> of;
  int rounded_together = 0;
  int beyond = 0;
  std::size_t most = 0;
};

bool less_point(const Vec3d& p, const Vec3d& q) {
  return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
}

std::vector<Vec3d> sorted(std::vector<Vec3d> points) {
  std::sort(points.begin(), points.end(), less_point);
  return points;
}

std::string text_of(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b) {
  std::ostringstream text;
  text.precision(17);
  for (const Primitive* p : {&a, &b}) {
    for (std::size_t i = 0; i < p->vertex_count(); ++i) text << p->v[i].transpose() << "; ";
  }
  text << '\n' << pose_a.affine() << '\n' << pose_b.affine() << "\nseed " << seed();
  return text.str();
}

std::string text_of(const std::vector<Vec3d>& points) {
  std::ostringstream text;
  text.precision(17);
  for (const Vec3d& p : points) text << p.transpose() << "; ";
  return text.str();
}

std::vector<RationalPoint> rational(const std::vector<IntPoint<BigInt>>& points, unsigned zeros) {
  std::vector<RationalPoint> result;
  for (const IntPoint<BigInt>& p : points) {
    RationalPoint& q = result.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) q.over[k] = p[k] / (BigInt(1) << zeros);
  }
  return result;
}

bool less_exactly(const RationalPoint& p, const RationalPoint& q) {
  const IntPoint<BigInt> d = arrow(p, q);
  const auto first = std::find_if(d.begin(), d.end(), [](const BigInt& x) { return x != 0; });
  return first != d.end() && *first > 0;
}

/// Polygons are convex and go once around, and begin as they should.
bool is_in_order(const std::vector<RationalPoint>& points) {
  const std::size_t n = points.size();
  for (std::size_t i = 1; i < n; ++i) {
    if (!less_exactly(points[0], points[i])) return false;
  }
  if (n < 3) return true;
  if (!less_exactly(points[1], points[n - 1])) return false;
  const IntPoint<BigInt> normal = cross_of(arrow(points[0], points[1]), arrow(points[0], points[2]));
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    for (std::size_t k = 0; k < n; ++k) {
      if (k == i || k == next) continue;
      const IntPoint<BigInt> side = cross_of(arrow(points[i], points[next]), arrow(points[i], points[k]));
      if (dot_of(normal, side) <= 0) return false;
    }
  }
  return true;
}

void check(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b, std::mt19937_64& random,
           Count& count) {
  ++count.pairs;
  const std::optional<Intersection> part = exact_intersection(a, pose_a, b, pose_b);
  if (part.has_value() != exact_intersects(a, pose_a, b, pose_b)) {
    FAIL("meet " << part.has_value() << ": " << text_of(a, pose_a, b, pose_b));
  }
  const std::optional<Intersection> swapped = exact_intersection(b, pose_b, a, pose_a);
  REQUIRE(part.has_value() == swapped.has_value());
  if (!part) return;
  ++count.of[part->kind];
  count.most = std::max(count.most, part->points.size());
  if (swapped->kind != part->kind || swapped->points != part->points) {
    FAIL("swapped: " << text_of(swapped->points) << " and " << text_of(part->points) << ": "
                     << text_of(a, pose_a, b, pose_b));
  }

  constexpr int unit_bits = 2300;
  const auto points_a = posed_points(a, pose_a, unit_bits);
  const auto points_b = posed_points(b, pose_b, unit_bits);
  BigInt all = 0;
  for (const auto* side : {&points_a, &points_b}) {
    for (const IntPoint<BigInt>& p : *side) {
      for (const BigInt& x : p) all |= abs(x);
    }
  }
  const unsigned zeros = all == 0 ? 0 : lsb(all);
  const std::vector<RationalPoint> corners =
      common_corners(rational(points_a, zeros), rational(points_b, zeros), random);
  std::vector<Vec3d> rounded;
  for (const RationalPoint& p : corners) {
    Vec3d& q = rounded.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      q[static_cast<Eigen::Index>(k)] = round_to_double(p.over[k], p.under, unit_bits - static_cast<int>(zeros));
    }
    count.beyond += !q.allFinite();
  }
  if (static_cast<int>(part->kind) != dimension_of(corners) || sorted(part->points) != sorted(rounded)) {
    FAIL("kind " << static_cast<int>(part->kind) << ", dimension " << dimension_of(corners) << ": "
                 << text_of(part->points) << " but " << text_of(sorted(rounded)) << ": "
                 << text_of(a, pose_a, b, pose_b));
  }
  // The order, if points can be told apart by what they are rounded to.
  const std::vector<Vec3d> in_order = sorted(rounded);
  if (std::adjacent_find(in_order.begin(), in_order.end()) != in_order.end()) {
    ++count.rounded_together;
    return;
  }
  std::vector<RationalPoint> exact;
  for (const Vec3d& p : part->points) {
    exact.push_back(corners[static_cast<std::size_t>(std::find(rounded.begin(), rounded.end(), p) - rounded.begin())]);
  }
  const bool right =
      part->kind == Kinds::polyhedron ? std::is_sorted(exact.begin(), exact.end(), less_exactly) : is_in_order(exact);
  if (!right) FAIL("order: " << text_of(part->points) << ": " << text_of(a, pose_a, b, pose_b));
}

/// Points of the mirrored and of the doubled pair are the mirrored and the doubled ones.
void check_images(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b) {
  const std::optional<Intersection> part = exact_intersection(a, pose_a, b, pose_b);
  for (const Vec3d& factor : {Vec3d(-1, 1, 1), Vec3d(1, -1, -1), Vec3d(2, 2, 2), Vec3d(0.5, 1, 4)}) {
    const auto image = [&](Pose pose) {
      pose.linear() = factor.asDiagonal() * pose.linear();
      pose.translation() = factor.asDiagonal() * pose.translation();
      return pose;
    };
    const std::optional<Intersection> of_image = exact_intersection(a, image(pose_a), b, image(pose_b));
    REQUIRE(of_image.has_value() == part.has_value());
    if (!part) continue;
    std::vector<Vec3d> expected;
    for (const Vec3d& p : part->points) expected.push_back(factor.asDiagonal() * p);
    if (of_image->kind != part->kind || sorted(of_image->points) != sorted(expected)) {
      FAIL("image by " << factor.transpose() << ": " << text_of(of_image->points) << " but " << text_of(expected)
                       << ": " << text_of(a, pose_a, b, pose_b));
    }
  }
  // The same vertices in another order.
  Primitive turned = a;
  std::rotate(turned.v.begin(), turned.v.begin() + 1, turned.v.begin() + static_cast<std::ptrdiff_t>(a.vertex_count()));
  const std::optional<Intersection> of_turned = exact_intersection(turned, pose_a, b, pose_b);
  REQUIRE(of_turned.has_value() == part.has_value());
  if (part) {
    REQUIRE(of_turned->kind == part->kind);
    REQUIRE(of_turned->points == part->points);
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

/// Flat, and mostly convex with the vertices in order.
GridPrimitive flat_quad(PairSource& source) {
  GridPrimitive p;
  p.kind = Kind::quad;
  p.v[0] = source.point() / 4;
  const Vec3i u = source.point() / 4;
  const Vec3i v = source.point() / 4;
  p.v[1] = p.v[0] + u;
  p.v[2] = p.v[0] + source.integer(1, 2) * u + source.integer(1, 2) * v;
  p.v[3] = p.v[0] + v;
  return p;
}

void compare(int rounds, Count& count) {
  std::mt19937_64 random(seed() + 15);
  for (const PairClass c : pair_classes) {
    for (const int range : {3, 40}) {
      PairSource source(-range, range, static_cast<std::uint64_t>(c) + 350 + static_cast<std::uint64_t>(range));
      for (int i = 0; i < rounds; ++i) {
        GridPair grid = source.pair(c, i % 4 == 0 ? Kind::quad : Kind::tri, i % 8 == 0 ? Kind::quad : Kind::tri);
        if (i % 8 == 1) grid.a = flat_quad(source);
        if (i % 16 == 1) {
          grid.b = grid.a;
          for (Vec3i& v : grid.b.v) v += grid.a.v[1] - grid.a.v[0];
        }
        const int size = i % 7 == 0 ? std::array<int, 5>{-1074, -1060, -500, 340, 980}[random() % 5] : -4;
        Primitive a = scaled(grid.a, size);
        Primitive b = scaled(grid.b, size);
        Pose pose_a = Pose::Identity();
        Pose pose_b = Pose::Identity();
        if (i % 2 == 1) {
          const PoseClass pose_class = pose_classes[static_cast<std::size_t>(i / 2) % std::size(pose_classes)];
          pose_a = random_pose(pose_class, i % 5 == 0 ? 0x1p30 : 4, random);
          pose_b = i % 3 == 0 ? random_pose(pose_class, 2, random) : pose_a;
          if (size != -4) {
            const double factor = std::ldexp(1.0, std::clamp(size, -500, 500));
            pose_a.translation() *= factor;
            pose_b.translation() *= factor;
            if (size == 980) {
              pose_a.linear() *= 0x1p39;
              pose_b.linear() *= 0x1p39;
            }
          }
          if (i % 9 == 0) {
            nudge(a, random);
            nudge(b, random);
          }
        }
        check(a, pose_a, b, pose_b, random, count);
        if (size == -4) check_images(a, pose_a, b, pose_b);
      }
    }
  }
  std::cout << "pairs=" << count.pairs;
  for (const auto& [kind, n] : count.of) std::cout << " kind" << static_cast<int>(kind) << '=' << n;
  std::cout << " most=" << count.most << " rounded_together=" << count.rounded_together
            << " coordinates_beyond=" << count.beyond << '\n';
  CHECK(count.of[Kinds::point] > count.pairs / 50);
  CHECK(count.of[Kinds::segment] > count.pairs / 20);
  CHECK(count.of[Kinds::polygon] > count.pairs / 50);
  CHECK(count.of[Kinds::polyhedron] > count.pairs / 200);
  CHECK(count.most >= 6);
}

Primitive triangle(const Vec3d& p, const Vec3d& q, const Vec3d& r) { return make_triangle<Primitive>(p, q, r); }
Primitive quad(const Vec3d& p, const Vec3d& q, const Vec3d& r, const Vec3d& s) {
  Primitive result = triangle(p, q, r);
  result.kind = Kind::quad;
  result.v[3] = s;
  return result;
}

Intersection part_of(const Primitive& a, const Primitive& b) {
  const std::optional<Intersection> part = exact_intersection(a, Pose::Identity(), b, Pose::Identity());
  REQUIRE(part.has_value());
  return *part;
}

using Points = std::vector<Vec3d>;

}  // namespace

TEST_CASE("intersection: faces by hand", "[lib][intersection]") {
  const Primitive floor = triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  // Through the floor.
  Intersection part = part_of(floor, triangle({1, 1, -1}, {1, 1, 1}, {1, -5, 0}));
  CHECK(part.kind == Kinds::segment);
  CHECK(part.points == Points{{1, 0, 0}, {1, 1, 0}});
  // A vertex on the floor, an edge on it, a shared edge and a shared vertex.
  part = part_of(floor, triangle({1, 1, 0}, {1, 1, 1}, {1, -5, 1}));
  CHECK(part.kind == Kinds::point);
  CHECK(part.points == Points{{1, 1, 0}});
  part = part_of(floor, triangle({1, 1, 0}, {0.5, 0.5, 0}, {1, -5, 1}));
  CHECK(part.points == Points{{0.5, 0.5, 0}, {1, 1, 0}});
  part = part_of(floor, triangle({4, 0, 0}, {0, 0, 0}, {1, -5, 1}));
  CHECK(part.points == Points{{0, 0, 0}, {4, 0, 0}});
  part = part_of(floor, triangle({4, 0, 0}, {9, 0, 0}, {5, -5, 1}));
  CHECK(part.points == Points{{4, 0, 0}});
  // In one plane: a hexagon, itself, an edge, a part of it.
  part = part_of(triangle({0, 0, 0}, {6, 0, 0}, {0, 6, 0}), triangle({4, 4, 0}, {-2, 4, 0}, {4, -2, 0}));
  CHECK(part.kind == Kinds::polygon);
  CHECK(part.points == Points{{0, 2, 0}, {0, 4, 0}, {2, 4, 0}, {4, 2, 0}, {4, 0, 0}, {2, 0, 0}});
  part = part_of(floor, triangle({0, 4, 0}, {4, 0, 0}, {0, 0, 0}));
  CHECK(part.points == Points{{0, 0, 0}, {0, 4, 0}, {4, 0, 0}});
  part = part_of(floor, triangle({1, 0, 0}, {6, 0, 0}, {3, -4, 0}));
  CHECK(part.kind == Kinds::segment);
  CHECK(part.points == Points{{1, 0, 0}, {4, 0, 0}});
  // Segments and points as triangles.
  part = part_of(triangle({0, 0, 0}, {2, 0, 0}, {1, 0, 0}), triangle({1, -1, 0}, {1, 3, 0}, {1, 1, 0}));
  CHECK(part.kind == Kinds::point);
  CHECK(part.points == Points{{1, 0, 0}});
  part = part_of(triangle({0, 0, 0}, {2, 0, 0}, {1, 0, 0}), triangle({1, 0, 0}, {3, 0, 0}, {3, 0, 0}));
  CHECK(part.points == Points{{1, 0, 0}, {2, 0, 0}});
  const Primitive origin = triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0});
  part = part_of(origin, origin);
  CHECK(part.kind == Kinds::point);
  CHECK(part.points == Points{{0, 0, 0}});
  CHECK_THROWS_WITH(part_of(floor, triangle({0, 0, 0}, {1, 0, std::nan("")}, {0, 1, 0})),
                    Catch::Contains("a coordinate is not finite"));
  part = part_of(triangle({1, 1, 0}, {1, 1, 0}, {1, 1, 0}), floor);
  CHECK(part.points == Points{{1, 1, 0}});
  CHECK_FALSE(exact_intersection(floor, Pose::Identity(), triangle({1, 1, 1}, {1, 1, 1}, {1, 1, 1}), Pose::Identity()));
}

TEST_CASE("intersection: quads by hand", "[lib][intersection]") {
  // Flush squares.
  Intersection part =
      part_of(quad({0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}), quad({1, 1, 1}, {1, 3, 1}, {3, 3, 1}, {3, 1, 1}));
  CHECK(part.kind == Kinds::polygon);
  CHECK(part.points == Points{{1, 1, 1}, {1, 2, 1}, {2, 2, 1}, {2, 1, 1}});
  // A tetrahedron with right angles at the origin, cut by a plane and by its mirror image, and touched by one.
  const Primitive corner = quad({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4});
  part = part_of(corner, triangle({-9, -9, 1}, {9, -9, 1}, {0, 20, 1}));
  CHECK(part.kind == Kinds::polygon);
  CHECK(part.points == Points{{0, 0, 1}, {0, 3, 1}, {3, 0, 1}});
  part = part_of(corner, quad({2, 2, 2}, {-2, 2, 2}, {2, -2, 2}, {2, 2, -2}));
  CHECK(part.kind == Kinds::polyhedron);
  CHECK(part.points == Points{{0, 0, 2}, {0, 2, 0}, {0, 2, 2}, {2, 0, 0}, {2, 0, 2}, {2, 2, 0}});
  part = part_of(corner, quad({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, -4}));
  CHECK(part.kind == Kinds::polygon);
  CHECK(part.points == Points{{0, 0, 0}, {0, 4, 0}, {4, 0, 0}});
  part = part_of(corner, quad({0, 0, 0}, {4, 0, 0}, {0, -4, 0}, {0, 0, -4}));
  CHECK(part.kind == Kinds::segment);
  CHECK(part.points == Points{{0, 0, 0}, {4, 0, 0}});
  // One inside the other.
  part = part_of(quad({-9, -9, -9}, {30, -9, -9}, {-9, 30, -9}, {-9, -9, 30}), corner);
  CHECK(part.points == Points{{0, 0, 0}, {0, 0, 4}, {0, 4, 0}, {4, 0, 0}});
}

TEST_CASE("intersection: coordinates are the nearest doubles", "[lib][intersection]") {
  // A line through (k, 0, 0) and (k + 1, 0, 3) has x = k + 1/3 where z = 1.
  const Primitive plane = triangle({-1e9, -1e9, 1}, {1e9, -1e9, 1}, {0, 1e9, 1});
  for (const double k : {0.0, 1.0, 7.0, 1024.0}) {
    const Intersection part = part_of(triangle({k, 0, 0}, {k + 1, 0, 3}, {k + 1, 0, 3}), plane);
    CHECK(part.points == Points{{(3 * k + 1) / 3, 0, 1}});  // one rounding: the numerator is exact
  }
  // Ties: the middle of neighbouring doubles goes to the even one, of the two least numbers to 0.
  const double odd = 1 + 0x1p-52;
  const double even = 1 + 0x1p-51;
  Intersection part = part_of(triangle({odd, 0, 0}, {even, 0, 2}, {even, 0, 2}), plane);
  CHECK(part.points == Points{{even, 0, 1}});
  part = part_of(triangle({1, 0, 0}, {odd, 0, 2}, {odd, 0, 2}), plane);
  CHECK(part.points == Points{{1, 0, 1}});
  constexpr double least = std::numeric_limits<double>::denorm_min();
  part = part_of(triangle({0, 0, 0}, {least, 0, 2}, {least, 0, 2}), plane);
  CHECK(part.points == Points{{0, 0, 1}});
  part = part_of(triangle({least, 0, 0}, {2 * least, 0, 2}, {2 * least, 0, 2}), plane);
  CHECK(part.points == Points{{2 * least, 0, 1}});
  // Different points with the same coordinates: still a segment.
  part = part_of(triangle({0, 0, 0}, {least, 0, 2}, {0, 0, 2}), plane);
  CHECK(part.kind == Kinds::segment);
  CHECK(part.points == Points{{0, 0, 1}, {0, 0, 1}});
  // Beyond the doubles.
  Pose pose = Pose::Identity();
  pose.linear() *= 0x1p500;
  const Primitive big = triangle({0x1p600, 0, 0}, {0, 0x1p600, 0}, {0, 0, 0});
  const auto whole = exact_intersection(big, pose, big, pose);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  REQUIRE(whole.has_value());
  CHECK(whole->points == Points{{0, 0, 0}, {0, infinity, 0}, {infinity, 0, 0}});
  CHECK_THROWS_AS(
      exact_intersection(triangle({0, 0, infinity}, {1, 0, 0}, {0, 1, 0}), Pose::Identity(), plane, Pose::Identity()),
      std::invalid_argument);
}

TEST_CASE("intersection: random faces", "[lib][intersection]") {
  Count count;
  compare(220, count);
}

TEST_CASE("intersection: many random faces", "[.long]") {
  Count count;
  compare(10000, count);
  CHECK(count.pairs == 100000);
  CHECK(count.beyond > 0);
}
