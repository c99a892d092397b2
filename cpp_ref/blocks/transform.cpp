// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/blocks/transform.hpp>
#include <cchip/internal/image/image_line.hpp>

namespace cchip::model {

using bvh::NodeKind;

RoundShift round_shift(std::int64_t value, int shift) {
  if (shift == 0) return {value, false};
  if (shift > 63) return {0, value != 0};  // |value| < 2^63: less than half
  const std::int64_t cut = value >> shift;
  const bool half = (value >> (shift - 1) & 1) != 0;
  const std::int64_t rest = static_cast<std::int64_t>(static_cast<std::uint64_t>(value) << (64 - shift));
  return {cut + (half ? 1 : 0), rest != 0};
}

// ---- cchip_vertex_transform

void VertexTransform::begin(const LeafJob& job) {
  const bvh::LeafLine a = bvh::decode_leaf(job.line_a, job.kind_a);
  const bvh::LeafLine b = bvh::decode_leaf(job.line_b, job.kind_b);
  busy_ = true;
  if (a.extent > bvh::extent_max || b.extent > bvh::extent_max) {
    ready_.put(1, true);
    return;
  }
  const MovedLeaves moved = move_leaves(a, job.kind_a, b, job.kind_b, job.query);
  const bool four = job.kind_a == NodeKind::quad || job.kind_b == NodeKind::quad;
  const std::size_t count = four ? 4 : 3;
  // The origin takes the first `passes` clocks; `last` is the one on which a vertex is complete.
  std::uint64_t last = passes_ - 1;
  for (std::size_t i = 0; i < bvh::primitives_in(job.kind_a); ++i) {
    for (std::size_t j = 0; j < bvh::primitives_in(job.kind_b); ++j) {
      for (std::size_t n = 0; n < count; ++n) {
        last += passes_;
        // The last vertex of a triangle comes twice.
        const std::size_t in_a = job.kind_a == NodeKind::quad ? n : 3 * i + std::min<std::size_t>(n, 2);
        const std::size_t in_b = job.kind_b == NodeKind::quad ? n : 3 * j + std::min<std::size_t>(n, 2);
        if (n == 0) launch_.put(last + 1, {i, j});
        MovedVertex vertex;
        vertex.first = n == 0;
        vertex.last = n + 1 == count;
        vertex.a = moved.a.vertex[in_a];
        vertex.b = moved.b.vertex[in_b];
        vertex.origin_lost = moved.a.origin_lost;
        vertex.lost_a = moved.a.lost[in_a];
        vertex.lost_b = moved.b.lost[in_b];
        vertex.error_a = moved.a.error;
        vertex.error_b = moved.b.error;
        vertex.open = moved.open;
        vertex_.put(last + 1 + static_cast<std::uint64_t>(defs::vertex_launch(static_cast<int>(passes_))), vertex);
      }
    }
  }
  ready_.put(last, false);
}

void VertexTransform::clock(const LeafJob* s, bool room) {
  const bool taken = s_ready();
  if (s != nullptr && !busy_ && room) begin(*s);
  if (taken) busy_ = false;
  ready_.clock();
  launch_.clock();
  vertex_.clock();
}

void VertexTransform::reset() {
  busy_ = false;
  ready_.reset();
  launch_.reset();
  vertex_.reset();
}

// ---- cchip_normaliser

void Normaliser::clock(const std::optional<MovedVertex>& s) {
  if (s) {
    if (s->first) pair_.clear();
    pair_.emplace_back(clock_, *s);
    if (s->last) {
      // Three vertices are a triangle, four a quad: that of a triangle is its last vertex again, which changes neither
      // the span nor what was lost.
      const NodeKind kind = pair_.size() == 4 ? NodeKind::quad : NodeKind::triangle;
      MovedLeaves leaves;
      leaves.open = s->open;
      leaves.a.origin_lost = s->origin_lost;
      leaves.a.error = s->error_a;
      leaves.b.error = s->error_b;
      for (std::size_t n = 0; n < pair_.size(); ++n) {
        const MovedVertex& vertex = pair_[n].second;
        leaves.a.vertex[n] = vertex.a;
        leaves.b.vertex[n] = vertex.b;
        leaves.a.lost[n] = vertex.lost_a;
        leaves.b.lost[n] = vertex.lost_b;
      }
      const GridPair grid = normalise(leaves, kind, 0, kind, 0, coord_w_);
      for (std::size_t n = 0; n < pair_.size(); ++n) {
        const std::uint64_t due = pair_[n].first + static_cast<std::uint64_t>(latency_);
        out_.put(due - clock_, {n == 0, n + 1 == pair_.size(), grid.a.v[n], grid.b.v[n], grid.eta});
      }
      pair_.clear();
    }
  }
  out_.clock();
  ++clock_;
}

void Normaliser::reset() {
  pair_.clear();
  out_.reset();
}

// ---- cchip_transform

std::optional<GridVertex> Transform::m() const {
  std::optional<GridVertex> vertex = normaliser_.m();
  if (vertex && identity().exchange) std::swap(vertex->a, vertex->b);
  return vertex;
}

void Transform::clock(const LeafJob* s, std::uint32_t id, bool s_credit) {
  if (const auto& launch = vertices_.launch()) {
    const bvh::LeafLine a = bvh::decode_leaf(s->line_a, s->kind_a);
    const bvh::LeafLine b = bvh::decode_leaf(s->line_b, s->kind_b);
    const Kind kind_a = s->kind_a == NodeKind::quad ? Kind::quad : Kind::tri;
    const Kind kind_b = s->kind_b == NodeKind::quad ? Kind::quad : Kind::tri;
    identities_.push_back({static_cast<int>(module_of(kind_a, kind_b)), a.id[(*launch)[0]], b.id[(*launch)[1]], id,
                           kind_a == Kind::quad && kind_b == Kind::tri,
                           static_cast<unsigned>(2 * (*launch)[0] + (*launch)[1])});
  }
  const bool room = room_;
  room_ = used_ <= credit_ - 4;
  used_ += (vertices_.launch() ? 1 : 0) - (s_credit ? 1 : 0);
  if (normaliser_.m() && normaliser_.m()->last) identities_.pop_front();
  normaliser_.clock(vertices_.m());
  vertices_.clock(s, room);
}

void Transform::reset() {
  used_ = 0;
  room_ = false;
  vertices_.reset();
  normaliser_.reset();
  identities_.clear();
}

}  // namespace cchip::model
