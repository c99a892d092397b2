// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes for the tests of trees and images.
#ifndef CCHIP_TESTS_LIB_BVH_MESHES_HPP
#define CCHIP_TESTS_LIB_BVH_MESHES_HPP

#include <array>
#include <cchip/mesh.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/shapes.hpp>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace cchip::testing {

/// Appends a face with its own vertices.
inline void add_face(Mesh& mesh, const std::vector<Vec3d>& vertices) {
  Mesh::Face face;
  face.kind = vertices.size() == 4 ? Kind::quad : Kind::tri;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    face.vertex[i] = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(vertices[i]);
  }
  mesh.faces.push_back(face);
}

/// A box of quads along the axes.
inline Mesh make_box(const Vec3d& low, const Vec3d& high) {
  Mesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(((i & 1U) != 0 ? high : low).x(), ((i & 2U) != 0 ? high : low).y(),
                               ((i & 4U) != 0 ? high : low).z());
  }
  for (const auto& face : {std::array<std::uint32_t, 4>{0, 2, 3, 1},
                           {4, 5, 7, 6},
                           {0, 1, 5, 4},
                           {2, 6, 7, 3},
                           {0, 4, 6, 2},
                           {1, 3, 7, 5}}) {
    mesh.faces.push_back({Kind::quad, face});
  }
  return mesh;
}

inline Vec3d random_vector(std::mt19937_64& random, double range) {
  std::uniform_real_distribution<double> coordinate(-range, range);
  const double x = coordinate(random);
  const double y = coordinate(random);
  return {x, y, coordinate(random)};
}

/// Moves every vertex by up to `range` along each axis.
inline Mesh noisy(Mesh mesh, double range, std::mt19937_64& random) {
  for (Vec3d& v : mesh.vertices) v += random_vector(random, range);
  return mesh;
}

inline Mesh scaled(Mesh mesh, double factor) {
  for (Vec3d& v : mesh.vertices) v *= factor;
  return mesh;
}

/// Polygons of three triangles each, with whole coordinates of 0 to 3, moved by x along the first axis.
inline Mesh polygons_in_parts(std::uint32_t triangles, double x, std::mt19937_64& random) {
  Mesh mesh;
  const auto whole = [&random] { return static_cast<double>(random() % 4); };
  for (std::uint32_t i = 0; i < triangles; ++i) {
    std::vector<Vec3d> face;
    for (int k = 0; k < 3; ++k) face.emplace_back(x + whole(), whole(), whole());
    add_face(mesh, face);
    mesh.file_face.push_back(i / 3);
  }
  return mesh;
}

/// Triangles and quads of random size anywhere; integer coordinates make some of them degenerate.
inline Mesh soup(std::size_t faces, bool integers, std::mt19937_64& random) {
  Mesh mesh;
  mesh.name = "soup";
  for (std::size_t i = 0; i < faces; ++i) {
    const double size = std::ldexp(1.0, -static_cast<int>(random() % 10));
    const Vec3d centre = random_vector(random, 1);
    std::vector<Vec3d> vertices;
    for (std::size_t v = 0; v < 3 + random() % 2; ++v) {
      Vec3d p = centre + random_vector(random, size);
      if (integers) p = (4 * p).array().round().matrix();
      vertices.push_back(p);
    }
    add_face(mesh, vertices);
  }
  return mesh;
}

/// The meshes of this list, each named after its special property.
inline std::vector<Mesh> assorted_meshes(std::mt19937_64& random) {
  std::vector<Mesh> meshes;
  const auto add = [&meshes](const std::string& name, Mesh mesh) {
    mesh.name = name;
    meshes.push_back(std::move(mesh));
  };
  add("torus", make_torus(2, 0.7, 24, 12));
  add("noisy torus of quads", noisy(make_torus(2, 0.7, 24, 12, Kind::quad), 0.01, random));
  add("gear", make_gear(1.4, 2, 0.6, 0.8, 12, 2));
  add("soup", soup(300, false, random));
  add("soup of integers", soup(300, true, random));
  Mesh mesh;
  add_face(mesh, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  add("one triangle", mesh);
  add_face(mesh, {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add("two triangles", mesh);
  mesh = {};
  add_face(mesh, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.25}});
  add("one quad", mesh);
  mesh = {};
  for (int i = 0; i < 100; ++i) add_face(mesh, {{3, -5, 7}, {3, -5, 7}, {3, -5, 7}});
  add("all in a point", mesh);
  mesh = {};
  for (int i = 0; i < 100; ++i) add_face(mesh, {{0.1, 0, 0}, {1, 0.3, 0}, {0, 1, 0.7}});
  add("coincident", mesh);
  mesh = {};
  for (int i = 0; i < 200; ++i) {
    const double x = std::ldexp(1.0, -i);  // each split by the heuristic takes one face off
    add_face(mesh, {{x, 0, 0}, {x, x, 0}, {0.9 * x, 0, x}});
  }
  add("shrinking", mesh);
  mesh = make_torus(2, 0.7, 12, 8);
  for (Vec3d& v : mesh.vertices) v = v * 0x1p-40 + Vec3d(1000, -3000, 1e6);
  add("small and far away", mesh);
  mesh = make_torus(2, 0.7, 12, 8);
  for (Vec3d& v : mesh.vertices) v *= 0x1p-990;
  add("tiny", mesh);
  mesh = make_torus(2, 0.7, 12, 8);
  for (Vec3d& v : mesh.vertices) v *= 0x1p997;
  add("huge", mesh);
  mesh = make_torus(2, 0.7, 12, 8);
  add_face(mesh, {{1000, 0, 0}, {1000, 1e-6, 0}, {1000, 0, 1e-6}});
  add_face(mesh, {{-1000, -1000, 0}, {-1000, 1000, 1}, {1000, 1000, 0}, {1000, -1000, 0}});
  add("sizes far apart", mesh);
  return meshes;
}

}  // namespace cchip::testing

#endif
