// SPDX-License-Identifier: Apache-2.0
// Any 64 bytes as the descriptor of a query: it keeps its bits, and the query over two tori ends.
#include <algorithm>
#include <cchip/bvh/image.hpp>
#include <cchip/mesh/shapes.hpp>
#include <cchip/model/broad_phase.hpp>

#include "require.hpp"

using namespace cchip;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const bvh::Image image = [] {
    const Mesh mesh = make_torus(1, 0.4, 8, 6, Kind::quad);
    return bvh::make_image(mesh, bvh::build_tree(mesh));
  }();
  Line line = {};
  std::copy_n(data, std::min(size, line.size()), line.begin());
  const Query query = decode_query(line);
  require(encode(decode_query(encode(query))) == encode(query), "a query keeps its fields");
  model::BroadPhaseOptions options;
  options.step_limit = 50;
  const model::BroadPhaseResult result = model::run_query(query, image, image, options);
  require(result.counts.steps <= options.step_limit, "a query ends");
  require(result.done.pairs == result.pairs.size(), "the last record counts the others");
  return 0;
}
