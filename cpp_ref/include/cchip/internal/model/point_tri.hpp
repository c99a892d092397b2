// SPDX-License-Identifier: Apache-2.0
/// \file
/// Models of cchip_point_axes and cchip_primtest_point_tri: the sphere of a point and a triangle.
#ifndef CCHIP_INTERNAL_MODEL_POINT_TRI_HPP
#define CCHIP_INTERNAL_MODEL_POINT_TRI_HPP

#include <bitset>
#include <cchip/internal/model/stream.hpp>
#include <cchip/internal/wire/pair.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace cchip::model {

/// The operand A of a point: centre in vertex 0, radius in x of vertex 1, as an unsigned number of `coord_w` bits.
/// \param radius 0..2^coord_w - 1
/// \throws std::invalid_argument radius out of range
GridPrimitive point_operand(const Vec3i& centre, std::int32_t radius, int coord_w);
/// The radius of such an operand.
std::int32_t radius_of(const GridPrimitive& point, int coord_w);

/// cchip_point_axes: bit 0 for the face, 1 to 3 for the edges, 4 to 6 for the vertices: 1 if this axis separates.
std::bitset<7> point_axes(const GridPrimitive& point, const GridPrimitive& triangle, int coord_w);

/// The answer of cchip_primtest_point_tri, without clocks.
PairResult point_tri_answer(const PairRequest& request, int coord_w);

/// cchip_primtest_point_tri, exact on every clock.
class PointTri {
 public:
  /// \param contexts pairs in flight
  PointTri(int coord_w, std::size_t contexts);

  bool s_pair_ready() const { return ready_; }
  bool m_result_valid() const { return results_.m_valid(); }
  /// Defined while m_result_valid().
  const PairResult& m_result() const { return results_.m_data(); }
  bool idle() const { return idle_; }

  /// Rising edge. `pair` is s_pair with its valid.
  void clock(const std::optional<PairRequest>& pair, bool m_result_ready);
  /// Rising edge with rst = 1.
  void reset();

 private:
  int coord_w_;
  std::size_t contexts_;
  std::size_t pairs_ = 0;
  bool ready_ = false;
  bool awake_ = false;
  bool idle_ = true;
  int busy_ = 0;  // clocks until the axes take the next pair
  Fifo<PairRequest> waiting_;
  Delay<std::optional<PairResult>> axes_;
  Fifo<PairResult> results_;
};

}  // namespace cchip::model

#endif
