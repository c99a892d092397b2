// SPDX-License-Identifier: Apache-2.0
/// \file
/// Objects before and behind a motion, for the tests of a refit of their images.
#ifndef CCHIP_TESTS_REFIT_FRAMES_HPP
#define CCHIP_TESTS_REFIT_FRAMES_HPP

#include <Eigen/Geometry>
#include <algorithm>
#include <cchip/blocks/refit.hpp>
#include <cchip/internal/image/image.hpp>
#include <cchip/internal/tree/support_tree.hpp>
#include <cchip/object.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "bvh_meshes.hpp"

namespace cchip::testing {

/// The mesh around the origin, its vertices on a grid of 2^-bits of its size: every leaf then holds them exactly.
inline Mesh snapped(Mesh mesh, int bits) {
  Eigen::AlignedBox3d box;
  for (const Vec3d& v : mesh.vertices) box.extend(v);
  const Vec3d centre = box.center();
  const double size = box.sizes().maxCoeff();
  const int exponent = size > 0 ? std::ilogb(size) - bits : 0;
  for (Vec3d& v : mesh.vertices) {
    for (double& c : v) c = std::ldexp(std::nearbyint(std::ldexp(c, -exponent)), exponent);
    v -= Vec3d(std::ldexp(std::nearbyint(std::ldexp(centre.x(), -exponent)), exponent),
               std::ldexp(std::nearbyint(std::ldexp(centre.y(), -exponent)), exponent),
               std::ldexp(std::nearbyint(std::ldexp(centre.z(), -exponent)), exponent));
  }
  return mesh;
}

/// The mesh bent and shaken: faces change their size and place.
inline Mesh bent(Mesh mesh, double amount, std::mt19937_64& random) {
  double size = 0;
  for (const Vec3d& v : mesh.vertices) size = std::max(size, v.lpNorm<Eigen::Infinity>());
  for (Vec3d& v : mesh.vertices) {
    const Vec3d turned(v.y(), v.z(), v.x());
    v += amount * (turned.cwiseAbs() + size * random_vector(random, 0.25));
  }
  return mesh;
}

struct Frames {
  bvh::Image old;    ///< before the motion
  bvh::Image moved;  ///< what make_image() writes behind it
  bvh::Tree tree;    ///< behind it
};

inline Frames frames_of(const Mesh& before, const Mesh& behind) {
  Frames frames;
  const Object object(before);
  const Object moved = object.moved(behind.vertices);
  bvh::Tree tree = object.tree().topology();
  bvh::refit(tree, object.mesh());
  frames.old = bvh::make_image(object.mesh(), tree);
  bvh::refit(tree, moved.mesh());
  frames.moved = bvh::make_image(moved.mesh(), tree);
  frames.tree = tree;
  return frames;
}

/// What the host hands over: the new header and leaves, the nodes of before. `choice`: with the cut exponents of
/// `moved`.
inline std::vector<Line> handed_over(const Frames& frames, bool choice) {
  std::vector<Line> lines = frames.moved.lines;
  for (std::size_t n = 1; n < lines.size(); ++n) {
    if (frames.tree.nodes[n - 1].kind != bvh::NodeKind::inner) continue;
    const auto exponent = get(lines[n], bvh::inner_field::cut_exponent);
    lines[n] = frames.old.lines[n];
    if (choice) put(lines[n], bvh::inner_field::cut_exponent, exponent);
  }
  return lines;
}

inline model::RefitCommand command_of(const bvh::Image& image) {
  const bvh::HeaderLine header = image.header();
  return {header.lines, header.root};
}

}  // namespace cchip::testing

#endif
