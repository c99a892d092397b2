// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact models of rtl/transform: what leaf_pair.hpp computes, and when. Every model is a Moore machine: its
/// accessors show the outputs during the present clock, clock() is the rising edge that ends it.
#ifndef CCHIP_BLOCKS_TRANSFORM_HPP
#define CCHIP_BLOCKS_TRANSFORM_HPP

#include <array>
#include <cchip/blocks/tie.hpp>
#include <cchip/internal/model/leaf_pair.hpp>
#include <cchip/internal/tree/tree.hpp>
#include <cchip/internal/wire/definitions.hpp>
#include <cchip/internal/wire/line.hpp>
#include <cchip/internal/wire/pair.hpp>
#include <cchip/internal/wire/query.hpp>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace cchip::model {

/// cchip_round_shift: value 2^-shift to nearest, halves up.
struct RoundShift {
  std::int64_t value = 0;
  bool lost = false;  ///< that is not exact
};
RoundShift round_shift(std::int64_t value, int shift);

/// Something that shows on a certain clock.
template <class T>
class Schedule {
 public:
  const std::optional<T>& now() const { return now_; }
  /// \param clocks from the present clock, >= 1; not before what was put last
  void put(std::uint64_t clocks, T value) { due_.emplace_back(clock_ + clocks, std::move(value)); }
  void clock() {
    ++clock_;
    now_.reset();
    if (due_.empty() || due_.front().first != clock_) return;
    now_ = std::move(due_.front().second);
    due_.pop_front();
  }
  void reset() {
    due_.clear();
    now_.reset();
  }

 private:
  std::uint64_t clock_ = 0;
  std::deque<std::pair<std::uint64_t, T>> due_;
  std::optional<T> now_;
};

/// A vertex of A and one of B on their way to the normaliser.
struct MovedVertex {
  bool first = false;
  bool last = false;
  std::array<std::int64_t, 3> a = {};  ///< units
  std::array<std::int64_t, 3> b = {};
  bool origin_lost = false;
  bool lost_a = false;
  bool lost_b = false;
  /// Those of MovedVertices, units.
  std::int64_t error_a = 0;
  std::int64_t error_b = 0;
  bool open = false;
  auto tie() const { return std::tie(first, last, a, b, origin_lost, lost_a, lost_b, error_a, error_b, open); }
};

/// A vertex of A and one of B on the grid of their pair.
struct GridVertex {
  bool first = false;
  bool last = false;
  Vec3i a = Vec3i::Zero();
  Vec3i b = Vec3i::Zero();
  int eta = 0;
  auto tie() const { return std::tie(first, last, a, b, eta); }
};

/// A leaf pair and the map of its query.
struct LeafJob {
  Query query;  ///< m, t, shift and error
  bvh::NodeKind kind_a = bvh::NodeKind::triangle;
  bvh::NodeKind kind_b = bvh::NodeKind::triangle;
  Line line_a = {};
  Line line_b = {};
};

/// cchip_vertex_transform.
class VertexTransform {
 public:
  explicit VertexTransform(int passes) : passes_(static_cast<std::uint64_t>(passes)) {}
  bool s_ready() const { return ready_.now().has_value(); }
  /// Defined while s_ready().
  bool corrupt() const { return *ready_.now(); }
  /// Primitives {of A, of B} of the pair that begins.
  const std::optional<std::array<std::size_t, 2>>& launch() const { return launch_.now(); }
  const std::optional<MovedVertex>& m() const { return vertex_.now(); }

  /// \param s held until s_ready()
  void clock(const LeafJob* s, bool room);
  void reset();

 private:
  void begin(const LeafJob& job);

  std::uint64_t passes_;
  bool busy_ = false;
  Schedule<bool> ready_;
  Schedule<std::array<std::size_t, 2>> launch_;
  Schedule<MovedVertex> vertex_;
};

/// cchip_normaliser.
class Normaliser {
 public:
  Normaliser(int coord_w, int passes) : coord_w_(coord_w), latency_(defs::normaliser_latency(passes)) {}
  const std::optional<GridVertex>& m() const { return out_.now(); }
  void clock(const std::optional<MovedVertex>& s);
  void reset();

 private:
  int coord_w_;
  int latency_;
  std::uint64_t clock_ = 0;
  std::vector<std::pair<std::uint64_t, MovedVertex>> pair_;  ///< and the clock on which each came
  Schedule<GridVertex> out_;
};

/// What cchip_transform says of a pair of primitives.
struct PairIdentity {
  int kind = 0;  ///< ModuleId
  std::uint32_t face_a = 0;
  std::uint32_t face_b = 0;
  std::uint32_t id = 0;   ///< that came with the leaves
  bool exchange = false;  ///< A is a quad and B a triangle: they change places
  unsigned pair = 0;      ///< which of its leaf pair: 2 (second of A) + (second of B)
};

/// cchip_transform.
class Transform {
 public:
  Transform(int coord_w, int passes, int credit) : credit_(credit), vertices_(passes), normaliser_(coord_w, passes) {}
  bool s_ready() const { return vertices_.s_ready(); }
  bool corrupt() const { return vertices_.corrupt(); }
  /// The vertex with A and B as they leave.
  std::optional<GridVertex> m() const;
  /// Of the pair of m().
  const PairIdentity& identity() const { return identities_.front(); }
  /// Pairs of primitives that have begun and whose credit has not come back.
  int used() const { return used_; }

  void clock(const LeafJob* s, std::uint32_t id, bool s_credit);
  void reset();

 private:
  int credit_;
  int used_ = 0;
  bool room_ = false;
  VertexTransform vertices_;
  Normaliser normaliser_;
  std::deque<PairIdentity> identities_;
};

}  // namespace cchip::model

#endif
