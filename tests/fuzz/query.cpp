// SPDX-License-Identifier: Apache-2.0
// Any 64 bytes as the descriptor of a query: it keeps its bits, and the query over a triangle mesh and a quad mesh ends.
// The meshes are small so that most of the time goes into new descriptors.
#include <algorithm>
#include <cchip/bvh/image.hpp>
#include <cchip/mesh/shapes.hpp>
#include <cchip/model/broad_phase.hpp>

#include "require.hpp"

using namespace cchip;

namespace {

bvh::Image image_of(const Mesh& mesh) { return bvh::make_image(mesh, bvh::build_tree(mesh)); }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const bvh::Image a = image_of(make_sphere(1, 1, 0.2));
  static const bvh::Image b = image_of(make_torus(1, 0.4, 3, 3, Kind::quad));
  Line line = {};
  std::copy_n(data, std::min(size, line.size()), line.begin());
  const Query query = decode_query(line);
  require(encode(decode_query(encode(query))) == encode(query), "a query keeps its fields");
  model::BroadPhaseOptions options;
  options.step_limit = 2;
  const model::BroadPhaseResult result = model::run_query(query, a, b, options);
  require(result.counts.steps <= options.step_limit, "a query ends");
  require(result.done.pairs == result.pairs.size(), "the last record counts the others");
  return 0;
}
