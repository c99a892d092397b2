// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pairs of primitives on the grid -1..1: 27 points, 27^3 ordered triangles.
#ifndef CCHIP_BENCH_GRID_PAIRS_HPP
#define CCHIP_BENCH_GRID_PAIRS_HPP

#include <algorithm>
#include <array>
#include <cchip/internal/grid/canonical.hpp>
#include <cchip/stimulus/campaign.hpp>
#include <random>
#include <vector>

namespace cchip::campaign {

constexpr int points = 27;
constexpr int triangles = points * points * points;

inline Vec3i point(int number) { return {number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1}; }
inline int number_of(const Vec3i& p) { return p.x() + 1 + 3 * (p.y() + 1) + 9 * (p.z() + 1); }

inline GridPrimitive triangle(int number) {
  GridPrimitive p;
  p.v = {point(number % points), point(number / points % points), point(number / (points * points)), Vec3i::Zero()};
  return p;
}

/// Images of the 27 points under the 48 symmetries of the cube.
inline std::vector<std::array<int, points>> symmetries() {
  std::vector<std::array<int, points>> result;
  std::array<int, 3> axis = {0, 1, 2};
  do {
    for (int mirror = 0; mirror < 8; ++mirror) {
      std::array<int, points> image{};
      for (int i = 0; i < points; ++i) {
        const Vec3i p = point(i);
        Vec3i q;
        for (int d = 0; d < 3; ++d) {
          const int c = p[axis[static_cast<std::size_t>(d)]];
          q[d] = (mirror >> d & 1) != 0 ? -c : c;
        }
        image[static_cast<std::size_t>(i)] = number_of(q);
      }
      result.push_back(image);
    }
  } while (std::next_permutation(axis.begin(), axis.end()));
  return result;
}

/// One ordered triangle, the smallest, of every class under the symmetries of the cube. Orders of the vertices are
/// kept: the programmes depend on them.
inline std::vector<int> first_triangles() {
  const auto images = symmetries();
  std::vector<int> result;
  for (int t = 0; t < triangles; ++t) {
    const std::array<int, 3> v = {t % points, t / points % points, t / (points * points)};
    bool least = true;
    for (const auto& image : images) {
      const auto to = [&image](int p) { return image[static_cast<std::size_t>(p)]; };
      least = least && to(v[0]) + points * (to(v[1]) + points * to(v[2])) >= t;
    }
    if (least) result.push_back(t);
  }
  return result;
}

inline GridPair triangle_pair(const std::vector<int>& firsts, std::uint64_t index) {
  return {triangle(firsts[index / triangles]), triangle(static_cast<int>(index % triangles)), 0};
}

inline GridPrimitive random_primitive(Kind kind, std::mt19937_64& random) {
  std::uniform_int_distribution<int> number(0, points - 1);
  GridPrimitive p;
  p.kind = kind;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) p.v[i] = point(number(random));
  return canonical_quad(p);
}

inline GridPair random_pair(const ShapeInfo& shape, std::mt19937_64& random) {
  const GridPrimitive a = random_primitive(shape.a, random);
  return {a, random_primitive(shape.b, random), 0};
}

/// Pair number `index` of `count`: all of them, or spread evenly over them.
inline std::uint64_t spread(std::uint64_t index, std::uint64_t count, std::uint64_t all) {
  return static_cast<std::uint64_t>(static_cast<double>(index) / static_cast<double>(count) * static_cast<double>(all));
}

/// Pairs of one shape, in parts.
class GridPairs {
 public:
  GridPairs(const ShapeInfo& shape, std::uint64_t count, const std::vector<int>& firsts)
      : shape_(shape), count_(count), firsts_(firsts) {}

  template <class Visit>
  void visit(std::uint64_t part, std::uint64_t seed, const Visit& visit) const {
    std::mt19937_64 random(seed);
    const std::uint64_t all = firsts_.size() * triangles;
    for (std::uint64_t i = 0; i < pairs_of_part(count_, part); ++i) {
      const std::uint64_t index = part * part_pairs + i;
      const bool triangles_only = shape_.b == Kind::tri;
      visit(triangles_only ? triangle_pair(firsts_, spread(index, count_, all)) : random_pair(shape_, random));
    }
  }

 private:
  const ShapeInfo& shape_;
  std::uint64_t count_;
  const std::vector<int>& firsts_;
};

}  // namespace cchip::campaign

#endif
