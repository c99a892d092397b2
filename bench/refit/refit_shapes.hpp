// SPDX-License-Identifier: Apache-2.0
/// \file
/// Ten meshes, deformed ones of the same faces, and what a host hands to the refit engine.
#ifndef CCHIP_BENCH_REFIT_SHAPES_HPP
#define CCHIP_BENCH_REFIT_SHAPES_HPP

#include <Eigen/Geometry>
#include <array>
#include <cchip/internal/image/image.hpp>
#include <cchip/internal/tree/support_tree.hpp>
#include <cchip/internal/tree/tree.hpp>
#include <cchip/object.hpp>
#include <cchip/shapes.hpp>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace cchip::testing {

struct Shape {
  std::string name;
  Mesh mesh;
};

inline Mesh box_of_quads() {
  Mesh mesh;
  for (unsigned i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1U) != 0 ? 1 : -1, (i & 2U) != 0 ? 0.7 : -0.7, (i & 4U) != 0 ? 0.5 : -0.5);
  for (const auto& face :
       {std::array<std::uint32_t, 4>{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
    mesh.faces.push_back({Kind::quad, face});
  return mesh;
}

/// Triangles and quads in one mesh.
inline Mesh both(Mesh a, const Mesh& b) {
  const auto behind = static_cast<std::uint32_t>(a.vertices.size());
  for (const Vec3d& v : b.vertices) a.vertices.emplace_back(v + Vec3d(0.5, 0.5, 0.5));
  for (Mesh::Face face : b.faces) {
    for (std::size_t i = 0; i < (face.kind == Kind::quad ? 4U : 3U); ++i) face.vertex[i] += behind;
    a.faces.push_back(face);
  }
  return a;
}

inline std::vector<Shape> ten_shapes() {
  return {{"box", box_of_quads()},
          {"box, 96 quads", subdivided(subdivided(box_of_quads()))},
          {"sphere", make_sphere(1, 5)},
          {"rough sphere", make_sphere(1, 8, 0.2)},
          {"torus, triangles", make_torus(1, 0.4, 16, 10)},
          {"torus, quads", make_torus(1, 0.4, 36, 24, Kind::quad)},
          {"gear with bore", make_gear(0.8, 1, 0.3, 0.4, 16, 3)},
          {"gear", make_gear(0.8, 1, 0, 0.2, 24, 6)},
          {"body", make_body(10, 0.3, 3)},
          {"sphere and torus", both(make_sphere(1, 3), make_torus(1, 0.3, 12, 8, Kind::quad))}};
}

enum class Deformation : std::uint8_t { small, large };

/// small: each vertex moves by up to 1 % of the size. large: a quarter turn around z over the height, and 10 %.
inline Mesh deformed(Mesh mesh, Deformation deformation, std::mt19937_64& random) {
  double size = 0;
  for (const Vec3d& v : mesh.vertices) size = std::max(size, v.lpNorm<Eigen::Infinity>());
  const bool large = deformation == Deformation::large;
  std::uniform_real_distribution<double> shift(-size * (large ? 0.1 : 0.01), size * (large ? 0.1 : 0.01));
  for (Vec3d& v : mesh.vertices) {
    if (large) v = Eigen::AngleAxisd(1.5707963267948966 * v.z() / size, Vec3d::UnitZ()) * v;
    for (double& c : v) c += shift(random);
  }
  return mesh;
}

/// An object before and after a motion.
struct Motion {
  bvh::Image before, after;  ///< what make_image() writes
  bvh::Tree tree;

  Motion(const Object& object, const Object& moved) : tree(object.tree().topology()) {
    bvh::refit(tree, object.mesh());
    before = bvh::make_image(object.mesh(), tree);
    bvh::refit(tree, moved.mesh());
    after = bvh::make_image(moved.mesh(), tree);
  }
  bool is_node(std::size_t line) const { return line != 0 && tree.nodes[line - 1].kind == bvh::NodeKind::inner; }
  /// Header and leaves after the motion, nodes before it.
  std::vector<Line> handed_over() const {
    std::vector<Line> lines = after.lines;
    for (std::size_t n = 0; n < lines.size(); ++n) {
      if (is_node(n)) lines[n] = before.lines[n];
    }
    return lines;
  }
};

}  // namespace cchip::testing

#endif
