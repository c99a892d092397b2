// SPDX-License-Identifier: Apache-2.0
// The functional model of cchip_refit against images that are made from the moved mesh.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/bvh/image.hpp>
#include <cchip/collide/object.hpp>
#include <cchip/models/refit.hpp>
#include <cmath>
#include <iostream>

#include "bvh_meshes.hpp"

using namespace cchip;
using namespace cchip::bvh;
using namespace cchip::testing;

namespace {

/// The mesh around the origin, its vertices on a grid of 2^-bits of its size: every leaf then holds them exactly.
Mesh snapped(Mesh mesh, int bits) {
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
Mesh bent(Mesh mesh, double amount, std::mt19937_64& random) {
  double size = 0;
  for (const Vec3d& v : mesh.vertices) size = std::max(size, v.lpNorm<Eigen::Infinity>());
  for (Vec3d& v : mesh.vertices) {
    const Vec3d turned(v.y(), v.z(), v.x());
    v += amount * (turned.cwiseAbs() + size * random_vector(random, 0.25));
  }
  return mesh;
}

struct Frames {
  Image old;    ///< before the motion
  Image moved;  ///< what make_image() writes behind it
  Tree tree;    ///< behind it
};

Frames frames_of(const Mesh& before, const Mesh& behind) {
  Frames frames;
  const Object object(before);
  const Object moved = object.moved(behind.vertices);
  Tree tree = object.tree().topology();
  refit(tree, object.mesh());
  frames.old = make_image(object.mesh(), tree);
  refit(tree, moved.mesh());
  frames.moved = make_image(moved.mesh(), tree);
  frames.tree = tree;
  return frames;
}

/// What the host hands over: the new header and leaves, the nodes of before. `choice`: with the cut exponents of
/// `moved`.
std::vector<Line> handed_over(const Frames& frames, bool choice) {
  std::vector<Line> lines = frames.moved.lines;
  for (std::size_t n = 1; n < lines.size(); ++n) {
    if (frames.tree.nodes[n - 1].kind != NodeKind::inner) continue;
    const auto exponent = get(lines[n], inner_field::cut_exponent);
    lines[n] = frames.old.lines[n];
    if (choice) put(lines[n], inner_field::cut_exponent, exponent);
  }
  return lines;
}

model::RefitCommand command_of(const Image& image) {
  const HeaderLine header = image.header();
  return {header.lines, header.root};
}

}  // namespace

TEST_CASE("refit model: where leaves hold the mesh exactly, every line is the one of make_image", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::size_t lines = 0;
  std::size_t nodes = 0;
  std::size_t mismatches = 0;
  std::size_t other_choice = 0;
  std::size_t changed = 0;
  for (const Mesh& any : assorted_meshes(random)) {
    for (const double amount : {0.0, 0.01, 0.2, 1.0}) {
      const Mesh mesh = snapped(any, 18);
      const Frames frames = frames_of(mesh, snapped(bent(mesh, amount, random), 18));
      std::vector<Line> image = handed_over(frames, true);
      const std::vector<Line> stale = handed_over(frames, false);
      std::size_t rounded = 0;
      for (std::size_t n = 1; n < image.size(); ++n) {
        const NodeKind kind = frames.tree.nodes[n - 1].kind;
        if (kind != NodeKind::inner) {
          rounded += decode_leaf(image[n], kind).rounded ? 1 : 0;
          continue;
        }
        ++nodes;
        other_choice += stale[n] == image[n] ? 0 : 1;
        changed += frames.moved.lines[n] == image[n] ? 0 : 1;
      }
      INFO(any.name << ", moved by " << amount);
      CHECK(rounded == 0);
      const auto result = model::refit_image(image, command_of(frames.moved));
      CHECK(result.code == RefitCode::ok);
      CHECK(result.lines + 1 == image.size());
      lines += image.size() - 1;
      for (std::size_t n = 0; n < image.size(); ++n) mismatches += image[n] == frames.moved.lines[n] ? 0 : 1;
    }
  }
  std::cout << "nodes=" << nodes << " changed=" << changed << " of another cut exponent=" << other_choice << "\n"
            << "lines=" << lines << " mismatches=" << mismatches << "\n";
  REQUIRE(changed > 1000);
  REQUIRE(mismatches == 0);
}

TEST_CASE("refit model: where leaves are rounded, the image is valid, and few nodes differ from make_image", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::size_t nodes = 0;
  std::size_t differ = 0;
  for (const Mesh& mesh : assorted_meshes(random)) {
    const Frames frames = frames_of(mesh, bent(mesh, 0.05, random));
    Image image{handed_over(frames, true)};
    INFO(mesh.name);
    const auto result = model::refit_image(image.lines, command_of(frames.moved));
    REQUIRE(result.code == RefitCode::ok);
    for (std::size_t n = 1; n < image.lines.size(); ++n) {
      if (frames.tree.nodes[n - 1].kind != NodeKind::inner) continue;
      ++nodes;
      differ += image.lines[n] == frames.moved.lines[n] ? 0 : 1;
    }
    put(image.lines[0], header_field::crc, image_crc(image));
    REQUIRE_NOTHROW(parse_image(to_bytes(image)));
  }
  std::cout << "nodes=" << nodes << " differ=" << differ << "\n";
  REQUIRE(differ * 20 < nodes);
}
