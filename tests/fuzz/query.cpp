// SPDX-License-Identifier: Apache-2.0
// Any 64 bytes as the descriptor of a query: it keeps its bits, and the query ends. The objects are as small as the
// kinds of leaves allow, so that the time goes into descriptors; the target of images descends into trees.
#include <algorithm>
#include <cchip/internal/image/image.hpp>
#include <cchip/internal/model/broad_phase.hpp>
#include <vector>

#include "require.hpp"

using namespace cchip;

namespace {

/// Faces with three corners and with four.
bvh::Image image_of(const std::vector<Vec3d>& vertices, const std::vector<std::vector<std::uint32_t>>& faces) {
  Mesh mesh;
  mesh.vertices = vertices;
  for (const auto& corners : faces) {
    Mesh::Face face;
    face.kind = corners.size() == 4 ? Kind::quad : Kind::tri;
    std::copy(corners.begin(), corners.end(), face.vertex.begin());
    mesh.faces.push_back(face);
  }
  return bvh::make_image(mesh, bvh::build_tree(mesh));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const bvh::Image a =
      image_of({{0, 0, 0}, {1, 0, 0.1}, {0, 1, 0}, {1, 1, 0.3}, {0.2, 0.3, 1}}, {{0, 1, 2}, {1, 3, 2}, {0, 1, 4}});
  static const bvh::Image b =
      image_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}, {0.5, 0.5, 1}}, {{0, 1, 2, 3}, {0, 1, 4}});
  Line line = {};
  std::copy_n(data, std::min(size, line.size()), line.begin());
  const Query query = decode_query(line);
  require(encode(decode_query(encode(query))) == encode(query), "a query keeps its fields");
  model::BroadPhaseOptions options;
  options.step_limit = 4;
  const model::BroadPhaseResult result = model::run_query(query, a, b, options);
  require(result.counts.steps <= options.step_limit, "a query ends");
  require(result.done.pairs == result.pairs.size(), "the last record counts the others");
  return 0;
}
