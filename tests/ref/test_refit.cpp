// SPDX-License-Identifier: Apache-2.0
// The functional model of cchip_refit against images that are made from the moved mesh.
#include <catch2/catch.hpp>
#include <iostream>

#include "refit_frames.hpp"

using namespace cchip;
using namespace cchip::bvh;
using namespace cchip::testing;

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

TEST_CASE("refit model: of the leaves alone it makes nodes that hold what the whole image holds", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::size_t nodes = 0;
  std::size_t alike = 0;
  for (const Mesh& any : assorted_meshes(random)) {
    const Mesh mesh = snapped(any, 18);
    const Object moved = Object(mesh).moved(snapped(bent(mesh, 0.2, random), 18).vertices);
    Tree tree = moved.tree().topology();
    std::vector<Line> image = make_leaves(moved.mesh(), tree).lines;
    refit(tree, moved.mesh());
    const Image whole = make_image(moved.mesh(), tree);
    INFO(any.name);
    REQUIRE(image.size() == whole.lines.size());
    HeaderLine header = decode_header(image[0]);
    header.crc = whole.header().crc;
    CHECK(encode(header) == whole.lines[0]);
    for (std::size_t n = 1; n < image.size(); ++n) {
      const TreeNode& node = tree.nodes[n - 1];
      if (node.kind != NodeKind::inner) {
        CHECK(image[n] == whole.lines[n]);
        continue;
      }
      const InnerLine structure = decode_inner(image[n]);
      const InnerLine full = decode_inner(whole.lines[n]);
      CHECK(structure.first == full.first);
      CHECK(structure.children == full.children);
      CHECK(structure.kind == full.kind);
    }
    CHECK(model::refit_image(image, command_of(whole)).code == RefitCode::ok);
    for (std::size_t n = 1; n < image.size(); ++n) {
      if (tree.nodes[n - 1].kind != NodeKind::inner) continue;
      ++nodes;
      const InnerLine full = decode_inner(whole.lines[n]);
      InnerLine made = decode_inner(image[n]);
      alike += image[n] == whole.lines[n] ? 1 : 0;
      // all but the cuts, whose unit is the engine's
      CHECK(made.origin == full.origin);
      CHECK(made.step == full.step);
      for (std::size_t i = 0; i < 4; ++i) {
        CHECK(made.child[i].least == full.child[i].least);
        CHECK(made.child[i].greatest == full.child[i].greatest);
      }
    }
  }
  CHECK(nodes > 100);
  CHECK(alike > nodes / 4);
}
