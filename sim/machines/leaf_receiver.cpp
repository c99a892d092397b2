// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/image/image_line.hpp>
#include <cchip/internal/model/leaf_pair.hpp>
#include <cchip/internal/model/programme.hpp>
#include <cchip/machines/leaf_receiver.hpp>

namespace cchip::sim {

std::uint64_t LeafReceiver::take(const LeafPair& leaves, const Query& query, std::uint64_t now,
                                 BroadPhaseAnswer& answer) {
  Result result{now, leaves.context, leaves.epoch, 0, 0, QueryCode::ok};
  const Work work = test(leaves, query, answer, result);
  // it makes room for the next one as soon as not too much waits in front of the lane
  credits_.push_back(std::max(lane_free_, now + options.ahead) - options.ahead);
  lane_free_ = std::max(lane_free_, now + options.transform) + work.beats;
  result.due = lane_free_ + options.first + options.others * (work.most - 1);
  if (options.jitter != 0) result.due += random_() % (options.jitter + 1);
  const auto place = std::upper_bound(results_.begin(), results_.end(), result.due,
                                      [](std::uint64_t due, const Result& r) { return due < r.due; });
  results_.insert(place, result);
  return work.beats;
}

LeafReceiver::Work LeafReceiver::test(const LeafPair& leaves, const Query& query, BroadPhaseAnswer& answer,
                                      Result& result) const {
  if (leaves.failed) {
    result.code = QueryCode::memory;
    return {1, 1};
  }
  const auto kind_a = static_cast<bvh::NodeKind>(leaves.kinds & 3);
  const auto kind_b = static_cast<bvh::NodeKind>(leaves.kinds >> 2);
  const bvh::LeafLine a = bvh::decode_leaf(leaves.lines[0], kind_a);
  const bvh::LeafLine b = bvh::decode_leaf(leaves.lines[1], kind_b);
  answer.leaf_pairs.emplace_back(a.id[0], b.id[0]);
  if (a.extent > bvh::extent_max || b.extent > bvh::extent_max) {
    result.code = QueryCode::corrupt;
    return {1, 1};
  }
  Work work;
  const model::MovedLeaves moved = model::move_leaves(a, kind_a, b, kind_b, query);
  for (std::size_t i = 0; i < bvh::primitives_in(kind_a); ++i) {
    for (std::size_t j = 0; j < bvh::primitives_in(kind_b); ++j) {
      GridPair pair = model::normalise(moved, kind_a, i, kind_b, j, defs::coord_w_default);
      if (pair.a.kind > pair.b.kind) std::swap(pair.a, pair.b);
      model::Options shape;
      shape.shape = {pair.a.vertex_count(), pair.b.vertex_count()};
      const model::Outcome outcome = model::run_programme(shape, pair, PairMode::directed, defs::coord_w_default);
      work.beats += static_cast<std::uint64_t>(outcome.beats);
      work.most = std::max(work.most, static_cast<std::uint64_t>(outcome.beats));
      if (!outcome.hit()) continue;
      std::uint32_t id_a = a.id[i];
      std::uint32_t id_b = b.id[j];
      if (query.swapped) std::swap(id_a, id_b);
      const bool definite = outcome.definite && !options.all_open;
      answer.pairs.push_back({query.tag, id_a, id_b, definite});
      ++(definite ? result.hits : result.open);
      if (definite && query.mode == QueryMode::first) return work;
    }
  }
  return work;
}

const LeafReceiver::Result* LeafReceiver::offer(std::uint64_t now) {
  if (!given_ && !options.held) {
    const auto ready = std::find_if(results_.begin(), results_.end(), [this, now](const Result& r) {
      return r.due <= now && (!options.only_hits || r.hits > 0);
    });
    if (ready != results_.end()) {
      given_ = *ready;
      results_.erase(ready);
    }
  }
  return given_ ? &*given_ : nullptr;
}

bool LeafReceiver::credit(std::uint64_t now) {
  if (options.held || credits_.empty() || credits_.front() > now) return false;
  credits_.pop_front();
  return true;
}

void LeafReceiver::clear() {
  results_.clear();
  given_.reset();
  credits_.clear();
  lane_free_ = 0;
}

}  // namespace cchip::sim
