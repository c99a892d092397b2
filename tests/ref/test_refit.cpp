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
