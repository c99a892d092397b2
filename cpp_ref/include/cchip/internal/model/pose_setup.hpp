// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the chip makes of a query before the first box test: B's 13 directions as seen from A.
#ifndef CCHIP_INTERNAL_MODEL_POSE_SETUP_HPP
#define CCHIP_INTERNAL_MODEL_POSE_SETUP_HPP

#include <array>
#include <cchip/internal/tree/dop26.hpp>
#include <cchip/internal/wire/query.hpp>
#include <cstdint>

namespace cchip::model {

/// One direction d of B. With m = M^T d, |m_j| sorted a >= b >= c: m = (a - b) axis + (b - c) face + c corner, with
/// axis, face and corner among A's 26 directions. So A's support along m is that of its box less (b - c) times a face
/// cut less c times a corner cut.
struct DirectionSetup {
  /// |m_j|, 9 fraction bits, rounded up: a greater box is a safe box. 10 bits.
  std::array<std::int32_t, 3> magnitude = {};
  /// b - c, 6 fraction bits, and c, 7 fraction bits, rounded down: a smaller cut is a safe cut. 7 bits each, the second
  /// at most 127/128.
  std::int32_t face_factor = 0;
  std::int32_t corner_factor = 0;
  /// Numbers among bvh::directions; `*_reversed`: it is the opposite direction, so upper and lower cuts change places.
  std::size_t face = bvh::first_face;
  std::size_t corner = bvh::first_corner;
  bool face_reversed = false;
  bool corner_reversed = false;
};

inline constexpr int box_m_fraction = 17;
inline constexpr int box_t_fraction = 24;

struct PoseSetup {
  /// M rounded to nearest, 17 fraction bits, -1 and 1 included.
  std::array<std::array<std::int32_t, 3>, 3> m = {};
  /// t rounded to nearest, 24 fraction bits.
  std::array<std::int32_t, 3> t = {};
  int shift = 0;
  /// Bound, in 2^-24, on the error of every coordinate of a point of A that the rounded M and t give.
  std::int32_t epsilon = 0;
  std::array<DirectionSetup, bvh::directions.size()> direction;
};

PoseSetup set_up(const Query& query);

}  // namespace cchip::model

#endif
