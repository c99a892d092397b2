// SPDX-License-Identifier: Apache-2.0
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cchip/shapes.hpp>
#include <cmath>
#include <cstdint>
#include <utility>

#include "robot.hpp"

namespace cchip::assembly {
namespace {

constexpr std::uint32_t cylinder_sides = 64;
constexpr int sphere_cuts = 12;
constexpr double for_rounding = 1 + 0x1p-40;

}  // namespace

Mesh box_mesh(const Vec3d& size) {
  Mesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    const auto side = [i](unsigned axis) { return (i >> axis & 1U) != 0 ? 0.5 : -0.5; };
    mesh.vertices.push_back(size.cwiseProduct(Vec3d(side(0), side(1), side(2))));
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> sides = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& side : sides) mesh.faces.push_back({Kind::quad, side});
  return mesh;
}

Mesh cylinder_mesh(double radius, double length) {
  const double pi = std::acos(-1.0);
  const double outer = radius / std::cos(pi / cylinder_sides) * for_rounding;
  Mesh mesh;
  for (std::uint32_t i = 0; i < cylinder_sides; ++i) {
    const double angle = 2 * pi * i / cylinder_sides;
    for (const double z : {-length / 2, length / 2}) {
      mesh.vertices.emplace_back(outer * std::cos(angle), outer * std::sin(angle), z);
    }
  }
  for (std::uint32_t i = 0; i < cylinder_sides; ++i) {
    const std::uint32_t low = 2 * i;
    const std::uint32_t next = 2 * ((i + 1) % cylinder_sides);
    mesh.faces.push_back({Kind::quad, {low, next, next + 1, low + 1}});  // a side is flat: two edges are parallel
    if (i == 0 || i + 1 == cylinder_sides) continue;
    mesh.faces.push_back({Kind::tri, {0, next, low, 0}});
    mesh.faces.push_back({Kind::tri, {1, low + 1, next + 1, 0}});
  }
  return mesh;
}

Mesh sphere_mesh(double radius) {
  Mesh mesh = make_sphere(1, sphere_cuts);
  double inner = 1;
  for (const Mesh::Face& face : mesh.faces) {
    const Vec3d& p = mesh.vertices[face.vertex[0]];
    const Vec3d normal = (mesh.vertices[face.vertex[1]] - p).cross(mesh.vertices[face.vertex[2]] - p).normalized();
    inner = std::min(inner, normal.dot(p));
  }
  for (Vec3d& vertex : mesh.vertices) vertex *= radius / inner * for_rounding;
  return mesh;
}

Mesh joined(const std::vector<const Mesh*>& meshes, const std::vector<Pose>& places) {
  Mesh all;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    const bool mirrored = places[i].linear().determinant() < 0;
    for (const Vec3d& vertex : meshes[i]->vertices) all.vertices.push_back(places[i] * vertex);
    for (const Mesh::Face& face : meshes[i]->faces) {
      const auto corner = [&](std::size_t k) { return first + face.vertex[k]; };
      const auto add = [&](std::size_t k) {
        std::array<std::uint32_t, 4> corners = {corner(0), corner(k), corner(k + 1), 0};
        if (mirrored) std::swap(corners[1], corners[2]);
        all.faces.push_back({Kind::tri, corners});
      };
      add(1);
      if (face.kind == Kind::quad) add(2);
    }
  }
  return all;
}

}  // namespace cchip::assembly
