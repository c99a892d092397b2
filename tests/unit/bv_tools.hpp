// SPDX-License-Identifier: Apache-2.0
/// \file
/// Poses, nodes and node pairs for the tests of rtl/bvtest, as the functional model has them.
#ifndef CCHIP_TESTS_UNIT_BV_TOOLS_HPP
#define CCHIP_TESTS_UNIT_BV_TOOLS_HPP

#include <Eigen/Geometry>
#include <algorithm>
#include <cchip/internal/image/image_fields.hpp>
#include <cchip/internal/model/box_test.hpp>
#include <cchip/stimulus/boundary.hpp>
#include <cmath>

#include "bench.hpp"

namespace cchip::test {

/// A number from least to most, any with the same chance.
inline int number(Random& random, int least, int most) {
  return least + static_cast<int>(random() % static_cast<std::uint64_t>(most - least + 1));
}
/// The same, often at an end of the range or at another boundary value.
inline int edge(Random& random, int least, int most) { return static_cast<int>(stimulus::draw(random, least, most)); }

/// A query with any map that a descriptor may hold: rotations, scaled ones, signed permutations, nearly those, shears,
/// reflections, turns by 45 degrees, and entries at 0, +-1/2, +-1 and a step beside them.
inline Query random_query(Random& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Eigen::Matrix3d m;
  for (bool allowed = false; !allowed;) {
    m = Eigen::Quaterniond(unit(random), unit(random), unit(random), unit(random)).normalized().toRotationMatrix();
    const int kind = number(random, 0, 7);
    if (kind == 0) m *= 0.2 + 0.4 * (unit(random) + 1);
    if (kind == 1 || kind == 2 || kind == 4) {
      m.setZero();
      const int first = number(random, 0, 2);
      const int flip = number(random, 1, 2);
      for (int i = 0; i < 3; ++i) m(i, (first + flip * i) % 3) = chance(random, 50) ? 1 : -1;
      if (kind == 2) m += Eigen::Matrix3d::NullaryExpr([&](auto...) { return unit(random) * 0x1p-15; });
      if (kind == 4) {  // and by 45 degrees around an axis of B
        m = Eigen::AngleAxisd(static_cast<double>(EIGEN_PI) / 4, Eigen::Vector3d::Unit(number(random, 0, 2)))
                .toRotationMatrix() *
            m;
        if (chance(random, 50)) m *= -1;
      }
    }
    if (kind == 3) m = Eigen::Matrix3d::NullaryExpr([&](auto...) { return unit(random); });
    if (kind == 5) {
      m = Eigen::Matrix3d::NullaryExpr([&](auto...) {
        const double entry = std::array{0.0, 0.0, 0.0, 0.5, 1.0, 1.0, std::abs(unit(random))}[random() % 7];
        return (chance(random, 50) ? entry : -entry) + 0x1p-17 * number(random, -1, 1);
      });
    }
    m = m.cwiseMax(-1.0).cwiseMin(1.0).eval();
    allowed = m.cwiseAbs().rowwise().sum().maxCoeff() < 2 - 0x1p-10;
    for (const auto& d : bvh::directions) {
      Eigen::Vector3d v = (m.transpose() * Eigen::Vector3d(d[0], d[1], d[2])).cwiseAbs();
      std::sort(v.begin(), v.end());
      allowed = allowed && v[2] < 2 - 0x1p-8 && v[0] + v[1] <= 2 + 0x1p-5;
    }
  }
  Query query;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j)
      query.m[i][j] = static_cast<std::int32_t>(
          std::lround(m(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) * 0x1p30));
    query.t[i] = chance(random, 20) ? stimulus::draw(random, -(std::int64_t{1} << 35), (std::int64_t{1} << 35) - 1)
                                    : std::llround(unit(random) * 0x1p31);
  }
  query.shift = chance(random, 40) ? 0 : edge(random, 0, query_shift_max);
  query.error = static_cast<std::uint32_t>(chance(random, 40) ? 0 : edge(random, 0, 4095));
  return query;
}

/// A node with any four children: boxes from a point at an end of the range to the whole of it.
inline bvh::InnerLine random_node(Random& random) {
  bvh::InnerLine node;
  for (auto& o : node.origin) o = edge(random, -131072, 131071);
  node.step = edge(random, 0, bvh::step_max);
  node.children = number(random, 1, 4);
  node.cut_exponent = number(random, 2, 3);
  for (auto& child : node.child) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int p = edge(random, -64, 63);
      const int q = chance(random, 15) ? p : edge(random, -64, 63);
      child.least[i] = std::min(p, q);
      child.greatest[i] = std::max(p, q);
    }
    for (auto& sides : child.cut) {
      for (int& cut : sides) cut = edge(random, 0, 7);
    }
  }
  return node;
}

/// The fields of a child in the order of its line.
inline void see_child(stimulus::Bins& bins, const bvh::ChildVolume& child) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis(1, static_cast<char>('x' + i));
    bins.see("least " + axis, child.least[i], -64, 63);
    bins.see("greatest " + axis, child.greatest[i], -64, 63);
  }
  for (std::size_t d = 0; d < child.cut.size(); ++d) {
    for (std::size_t side = 0; side < 2; ++side)
      bins.see("cut " + std::to_string(2 * d + side), child.cut[d][side], 0, 7);
  }
}
/// Pairs of ends that no legal child has: an inverted box.
constexpr const char* impossible_child = "least (.)=most with greatest \\1=least";

/// Writes child `i` of a node, as it is stored, to a port of 102 bits.
template <class Port>
void set_child(Port& port, const bvh::InnerLine& node, std::size_t i) {
  const Line line = encode(node);
  for (int byte = 0; byte < 102; byte += 6)
    sim::set_bits(port, byte, 6,
                  static_cast<std::uint64_t>(get(line, {"", 96 + 102 * i + static_cast<std::size_t>(byte), 6})));
}

/// Bits of a port that hold planes: `side` 0 is the upper one.
constexpr int plane_width(std::size_t d) { return d < bvh::first_face ? 12 : 13; }
constexpr int plane_at(std::size_t d, int side) {
  return static_cast<int>(d < bvh::first_face ? 24 * d : 72 + 26 * (d - bvh::first_face)) + side * plane_width(d);
}
template <class Port>
std::int64_t get_plane(const Port& port, std::size_t d, int side) {
  const std::uint64_t bits = sim::get_bits(port, plane_at(d, side), plane_width(d));
  const std::uint64_t sign = std::uint64_t{1} << (plane_width(d) - 1);
  return static_cast<std::int64_t>(bits ^ sign) - static_cast<std::int64_t>(sign);
}
template <class Port>
void set_planes(Port& port, const model::Planes& planes) {
  for (std::size_t d = 0; d < bvh::directions.size(); ++d) {
    sim::set_bits(port, plane_at(d, 0), plane_width(d), static_cast<std::uint64_t>(planes.upper[d]));
    sim::set_bits(port, plane_at(d, 1), plane_width(d), static_cast<std::uint64_t>(planes.lower[d]));
  }
}
template <class Port>
void expect_planes(const Port& port, const model::Planes& planes) {
  for (std::size_t d = 0; d < bvh::directions.size(); ++d) {
    CAPTURE(d);
    REQUIRE(get_plane(port, d, 0) == planes.upper[d]);
    REQUIRE(get_plane(port, d, 1) == planes.lower[d]);
  }
}

}  // namespace cchip::test

#endif
