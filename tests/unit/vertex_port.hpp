// SPDX-License-Identifier: Apache-2.0
/// \file
/// The way into a slot and out of it, s_vertex and m_result, records VERTEX and SLOT_RESULT: pairs as values, sent
/// vertex by vertex within the credit of the module.
#ifndef CCHIP_TESTS_UNIT_VERTEX_PORT_HPP
#define CCHIP_TESTS_UNIT_VERTEX_PORT_HPP

#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/model/programme.hpp>
#include <cchip/sim/scoreboard.hpp>
#include <cchip/stimulus/pair_source.hpp>
#include <deque>
#include <map>

#include "bench.hpp"
#include "point_pair.hpp"

namespace cchip::test {

/// The kinds that this module serves.
inline std::vector<ModuleId> kinds_served(ModuleId id) {
  std::vector<ModuleId> kinds;
  for (int kind = 1; kind <= defs::kinds_max; ++kind) {
    if (defs::rm_serves(static_cast<int>(id), kind) != 0) kinds.push_back(static_cast<ModuleId>(kind));
  }
  return kinds;
}

/// Pairs for one of the modules, every class, both programmes, tags that do not repeat.
class SlotRequests {
 public:
  SlotRequests(int coord_w, std::uint64_t seed) : coord_w_(coord_w), random_(seed), points_(coord_w, seed) {
    for (const ModuleId id : {ModuleId::tri_tri, ModuleId::tri_quad, ModuleId::quad_quad}) {
      sources_.emplace_back(coord_w, seed + static_cast<std::uint64_t>(id), kinds_of(id)[0], kinds_of(id)[1]);
    }
  }

  /// A pair of the kind of this module.
  PairRequest draw(ModuleId id) {
    PairRequest request;
    if (id == ModuleId::point_tri) {
      request.pair = cchip_test::grid_pair(points_.draw(), coord_w_);
    } else {
      stimulus::PairSource& source = sources_.at(static_cast<std::size_t>(id) - 1);
      const auto classes = stimulus::classes_of(kinds_of(id)[0], kinds_of(id)[1]);
      request.pair = source.draw(classes.at(source.draw_class()).value);
    }
    request.mode = static_cast<PairMode>(random_() & 1);
    request.tag = tag_++;
    return request;
  }
  /// The answer of the functional model of this module, which takes triangles as quads if it tests quads; the exact
  /// oracle confirms it.
  PairResult answer(const PairRequest& request, ModuleId id) const {
    if (id == ModuleId::point_tri) return cchip_test::confirmed_point_answer(request, coord_w_);
    GridPair pair = request.pair;
    const auto widen = [](GridPrimitive& p, Kind kind) {
      if (kind == Kind::quad && p.kind == Kind::tri) p.v[3] = p.v[2];
      p.kind = kind;
    };
    widen(pair.a, kinds_of(id)[0]);
    widen(pair.b, kinds_of(id)[1]);
    const auto vertices = [](Kind kind) { return static_cast<std::size_t>(kind); };
    const model::Options options{{vertices(pair.a.kind), vertices(pair.b.kind)}, true};
    const model::Outcome o = model::run_programme(options, pair, request.mode, coord_w_);
    sim::require(o.grid == exact_intersects(request.pair),
                 "the model contradicts the oracle, tag " + std::to_string(request.tag));
    return {request.tag, o.hit(), o.grid, o.definite, o.witness, o.beats};
  }

 private:
  int coord_w_;
  Random random_;
  cchip_test::PointTriangleSource points_;
  std::vector<stimulus::PairSource> sources_;
  std::uint16_t tag_ = 1;
};

/// Sends pairs and takes their results. What is inside is known by number, as in cchip_slot_ledger.
template <class Model>
class VertexPort : public sim::Agent {
 public:
  /// \param credit most pairs inside
  VertexPort(Model& model, int coord_w, std::size_t credit, std::uint64_t seed, sim::Pattern pattern)
      : model_(model),
        coord_w_(coord_w),
        credit_(credit),
        numbers_(credit),
        random_(seed),
        pattern_(std::move(pattern)) {
    model_.s_vertex_valid = 0;
  }
  void push(const PairRequest& request) { waiting_.push_back(request); }
  std::size_t waiting() const { return waiting_.size() + (sending_ ? 1 : 0); }
  std::size_t inside() const { return inside_.size(); }
  /// Numbers of pairs are below this, at first the credit.
  void set_numbers(std::size_t numbers) { numbers_ = numbers; }
  /// A pair has begun: some of its vertices have been sent.
  bool begun() const { return sending_ && next_ > 0; }
  /// No further pair is begun.
  void stop(bool yes) { stopped_ = yes; }
  /// Drops the pairs inside and outside.
  void clear() {
    waiting_.clear();
    inside_.clear();
    sending_.reset();
  }
  /// A result on this clock, with the tag of its pair; that of an unknown number has tag 0.
  std::function<void(const PairResult&, bool known)> on_result;
  std::function<void(const PairRequest&)> on_sent;  ///< with its last vertex

  void drive(const sim::ClockInfo& now) override {
    model_.s_vertex_valid = 0;
    sim::set_random(model_.s_vertex_data, defs::vertex_w(coord_w_), random_);
    if (now.in_reset) {
      sending_.reset();
      return;
    }
    if (!sending_ && !stopped_ && !waiting_.empty() && inside_.size() < credit_) {
      sending_ = waiting_.front();
      waiting_.pop_front();
      next_ = 0;
      do {
        id_ = static_cast<int>(random_() % numbers_);
      } while (inside_.count(id_) != 0);
    }
    if (!sending_ || !pattern_.next()) return;
    const GridPair& pair = sending_->pair;
    const int vertices = pair.b.kind == Kind::quad ? 4 : 3;
    const auto put = [&](defs::Field f, std::uint64_t value) {
      sim::set_bits(model_.s_vertex_data, f.lsb, f.width, value);
    };
    const auto put_vertex = [&](int lsb, const GridPrimitive& p) {
      const int i = p.kind == Kind::tri && next_ == 3 ? 2 : next_;
      for (int d = 0; d < 3; ++d) {
        sim::set_signed(model_.s_vertex_data, lsb + coord_w_ * d, coord_w_, p.v[static_cast<std::size_t>(i)][d]);
      }
    };
    put_vertex(defs::vertex_a(coord_w_).lsb, pair.a);
    put_vertex(defs::vertex_b(coord_w_).lsb, pair.b);
    put(defs::vertex_first, next_ == 0 ? 1 : 0);
    put(defs::vertex_last, next_ + 1 == vertices ? 1 : 0);
    if (next_ == 0) {  // beside the others it does not matter
      put(defs::vertex_id, static_cast<std::uint64_t>(id_));
      put(defs::vertex_err, static_cast<std::uint64_t>(pair.eta));
      put(defs::vertex_mode, static_cast<std::uint64_t>(sending_->mode));
    }
    model_.s_vertex_valid = 1;
    if (++next_ < vertices) return;
    inside_[id_] = sending_->tag;
    if (on_sent) on_sent(*sending_);
    sending_.reset();
  }
  void sample(const sim::ClockInfo& now) override {
    if (now.in_reset || model_.m_result_valid == 0) return;
    const auto get = [&](defs::Field f) {
      return static_cast<int>(sim::get_bits(model_.m_result_data, f.lsb, f.width));
    };
    const auto it = inside_.find(get(defs::slot_result_id));
    const bool known = it != inside_.end();
    const PairResult result{known ? it->second : std::uint16_t{0},
                            get(defs::slot_result_hit) != 0,
                            get(defs::slot_result_grid) != 0,
                            get(defs::slot_result_definite) != 0,
                            axis_code_from_bits(static_cast<std::uint16_t>(get(defs::slot_result_axis))),
                            get(defs::slot_result_beats)};
    if (known) inside_.erase(it);
    if (on_result) on_result(result, known);
  }

 private:
  Model& model_;
  int coord_w_;
  std::size_t credit_;
  std::size_t numbers_;
  Random random_;
  sim::Pattern pattern_;
  std::deque<PairRequest> waiting_;
  std::map<int, std::uint16_t> inside_;  // tag by number
  std::optional<PairRequest> sending_;
  int next_ = 0;  // vertex
  int id_ = 0;
  bool stopped_ = false;
};

}  // namespace cchip::test

#endif
