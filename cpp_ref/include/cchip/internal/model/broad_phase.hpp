// SPDX-License-Identifier: Apache-2.0
/// \file
/// A whole query in the chip's integers: traversal of two images, leaf pairs, primitive tests, records.
#ifndef CCHIP_INTERNAL_MODEL_BROAD_PHASE_HPP
#define CCHIP_INTERNAL_MODEL_BROAD_PHASE_HPP

#include <cchip/internal/image/image.hpp>
#include <cchip/internal/wire/pair.hpp>
#include <cchip/internal/wire/query.hpp>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace cchip::model {

struct BroadPhaseOptions {
  int coord_w = defs::coord_w_default;
  PairMode mode = PairMode::directed;
  std::size_t stack = 64;                   ///< entries
  std::uint32_t step_limit = 0xffffffff;    ///< node pairs
  std::uint32_t open_limit = 16;            ///< open pairs at which a FIRST query goes to the host
  std::mt19937_64* random_order = nullptr;  ///< visit node pairs in any order instead of the best first
  /// If set: gets every leaf pair whose boxes overlap, as lines of A and B.
  std::vector<std::pair<std::uint32_t, std::uint32_t>>* leaf_pairs = nullptr;
};

struct BroadPhaseCounts {
  std::uint64_t steps = 0;            ///< node pairs expanded
  std::uint64_t box_tests = 0;        ///< pairs of children compared
  std::uint64_t leaf_pairs = 0;       ///< leaf pairs whose boxes overlap
  std::uint64_t primitive_pairs = 0;  ///< sent to a primitive test
  std::uint64_t beats = 0;            ///< axes of the primitive tests
  std::uint64_t open_pairs = 0;       ///< hits that are not definite
  std::size_t stack_most = 0;         ///< entries
};

struct BroadPhaseResult {
  std::vector<PairRecord> pairs;
  DoneRecord done;
  BroadPhaseCounts counts;
};

/// Runs the query as the chip would with one node pair in flight. If an ALL query ends with QueryCode::ok, its set of
/// pairs and all counts but stack_most do not depend on the order of the node pairs. A FIRST query gives every open
/// pair up to its end, then the pair that is certainly in contact, if there is one. base_a and base_b are ignored.
BroadPhaseResult run_query(const Query& query, const bvh::Image& a, const bvh::Image& b,
                           const BroadPhaseOptions& options = {});

}  // namespace cchip::model

#endif
