// SPDX-License-Identifier: Apache-2.0
/// \file
/// Parts that fit together exactly, for touching.cpp and the tests of docs/cpp/touching.md.
#ifndef CCHIP_EXAMPLES_PARTS_HPP
#define CCHIP_EXAMPLES_PARTS_HPP

#include <array>
#include <cchip/mesh.hpp>
#include <cchip/pose.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

namespace parts {

struct Point {
  double x;
  double y;
};
/// A polygon, counter-clockwise.
using Outline = std::vector<Point>;

/// The walls over `outline` from z = low to z = high, of quads, and two caps of triangles. A cap is a fan around the
/// mean of the outline's points, which must see all of them; with a bore, an outline of as many points, it is a band.
inline cchip::Mesh prism(const Outline& outline, double low, double high, const Outline& bore = {}) {
  cchip::Mesh mesh;
  const auto count = static_cast<std::uint32_t>(outline.size());
  for (const Outline* ring : {&outline, &bore}) {
    for (const double z : {low, high}) {
      for (const Point& p : *ring) mesh.vertices.emplace_back(p.x, p.y, z);
    }
  }
  if (bore.empty()) {
    Point mean = {0, 0};
    for (const Point& p : outline) mean = {mean.x + p.x / count, mean.y + p.y / count};
    for (const double z : {low, high}) mesh.vertices.emplace_back(mean.x, mean.y, z);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t n = (i + 1) % count;
    mesh.faces.push_back({cchip::Kind::quad, {i, n, count + n, count + i}});
    if (bore.empty()) {
      mesh.faces.push_back({cchip::Kind::tri, {2 * count, n, i, 0}});
      mesh.faces.push_back({cchip::Kind::tri, {2 * count + 1, count + i, count + n, 0}});
      continue;
    }
    const std::uint32_t j = 2 * count + i;  // the bore's ring below
    const std::uint32_t m = 2 * count + n;
    mesh.faces.push_back({cchip::Kind::quad, {m, j, count + j, count + m}});
    for (const auto& [first, second, third] : {std::array{i, j, m}, std::array{i, m, n}}) {
      mesh.faces.push_back({cchip::Kind::tri, {first, second, third, 0}});
      mesh.faces.push_back({cchip::Kind::tri, {count + third, count + second, count + first, 0}});
    }
  }
  return mesh;
}

inline cchip::Mesh box(const cchip::Vec3d& low, const cchip::Vec3d& high) {
  return prism({{low.x(), low.y()}, {high.x(), low.y()}, {high.x(), high.y()}, {low.x(), high.y()}}, low.z(), high.z());
}

/// A regular polygon around the origin, its corners rounded to doubles.
inline Outline circle(double radius, int corners) {
  Outline outline;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::acos(-1.0) * i / corners;
    outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return outline;
}

/// A spur gear with straight flanks, in whole micrometres: points 4 k to 4 k + 3 are tooth k, first and last on the
/// root circle.
inline Outline gear(double root_radius, double tip_radius, int teeth) {
  Outline outline;
  const double pitch = 2 * std::acos(-1.0) / teeth;
  for (int tooth = 0; tooth < teeth; ++tooth) {
    for (const Point& p : {Point{root_radius, -0.22}, {tip_radius, -0.12}, {tip_radius, 0.12}, {root_radius, 0.22}}) {
      const double angle = pitch * (tooth + p.y);
      outline.push_back({std::round(p.x * std::cos(angle)), std::round(p.x * std::sin(angle))});
    }
  }
  return outline;
}

/// Where a second gear of the same outline meshes with the first: turned half a turn about a point of the left flank of
/// tooth 0, so that two flanks lie in one plane, and an eighth of a flank outwards, so that tips and roots keep clear.
/// All of it without rounding.
inline cchip::Pose in_mesh(const Outline& gear) {
  const Point tip = gear[2];
  const Point root = gear[3];
  cchip::Pose pose = cchip::Pose::Identity();
  pose.linear().diagonal() << -1, -1, 1;
  pose.translation() << root.x + tip.x + (tip.x - root.x) / 8, root.y + tip.y + (tip.y - root.y) / 8, 0;
  return pose;
}

}  // namespace parts

#endif
