// SPDX-License-Identifier: Apache-2.0
/// \file
/// Bounds on the distances of up to four by four nodes, and of the faces of two leaves, in single precision.
#ifndef CCHIP_SEARCH_SIMD_DISTANCE_HPP
#define CCHIP_SEARCH_SIMD_DISTANCE_HPP

#include <array>
#include <cchip/internal/tree/support_tree.hpp>
#include <cstdint>
#include <string>

namespace cchip::simd {

/// Lanes 2 k and 2 k + 1 are along axis k of the frame and against it; the last two are not used.
inline constexpr std::size_t reach_lanes = 8;

/// An object in the coordinates of an orthonormal frame, in a unit in which no sum of the search is above 1/2.
struct FrameSide {
  /// How far a node reaches along a lane: the sum of three of its words, at these bytes of their quarters of the line,
  /// times a factor each. Lanes of B are along the opposite directions of A's.
  alignas(16) std::array<std::uint16_t, reach_lanes> axis = {};
  alignas(16) std::array<std::uint16_t, reach_lanes> corner = {};
  alignas(16) std::array<std::uint16_t, reach_lanes> face_low = {};
  alignas(16) std::array<std::uint16_t, reach_lanes> face_high = {};
  alignas(32) std::array<float, reach_lanes> axis_factor = {};
  alignas(32) std::array<float, reach_lanes> corner_factor = {};
  alignas(32) std::array<float, reach_lanes> face_factor = {};
  std::array<float, 9> vertex = {};  ///< from SupportTree::vertices() to the frame, row by row
};

struct DistanceFrame {
  FrameSide a;
  FrameSide b;
  /// Between the centres along each lane, less what rounding may cost; in the lanes that are not used such that the gap
  /// is negative.
  alignas(32) std::array<float, reach_lanes> offset = {};
  std::array<float, 3> centre_b = {};  ///< the centre of B from that of A
  float shrink = 0;  ///< on squares, for axes that are orthonormal nearly and for the rounding of the squares
  float slack = 0;   ///< what rounding may cost a gap of faces along an axis, a unit of |axis|_1, and a distance
};

/// A coordinate of a vertex in the frame is a sum of four terms whose magnitudes add up to at most 1/2. With u = 2^-24
/// the vertex, its factor, the product and three sums cost u each, so it is off by less than 3 u; so are nearest
/// points, which are weighted means of vertices. A product with an axis, of magnitude |axis|_1 / 2 at most, costs 3 u
/// / 2. A gap along an axis is a difference of two such products: off by less than 12 u |axis|_1 with those of the axis
/// itself. A reach is a sum of three terms of magnitude 1/2 together: a gap of nodes is off by less than 8 u.
inline constexpr float single_slack = 16 * 0x1p-24F;
/// Relative, of a square root, a quotient and the sum of the squares of a vector.
inline constexpr float relative_slack = 0x1p-20F;

struct NodeGaps {
  /// Child i of A and k of B, at 4 i + k: at most the square of their distance in units of the frame.
  alignas(32) std::array<float, 16> square;
  /// Reaches of the children, lane by lane.
  alignas(32) std::array<std::array<float, reach_lanes>, 4> a;
  alignas(32) std::array<std::array<float, reach_lanes>, 4> b;
  float left_out;  ///< the least square above the limit; infinite if there is none
};

/// Of up to two by two faces, at 2 i + k: bounds on their distance in units of the frame.
struct FaceGaps {
  alignas(16) std::array<float, 4> lower;
  alignas(16) std::array<float, 4> upper;
  alignas(
      16) std::array<std::array<float, 4>, 3> between;  ///< near points, from A's to B's, along the axes of the frame
};

struct DistanceKernels {
  /// \param a, b four lines each, of which the first `count_a` and `count_b` are of interest
  /// \param least at most the square of each distance, from the nodes above
  /// \param most squares above it are of no interest
  /// \returns bit 4 i + k: child i of A and k of B may be as near
  unsigned (*nodes)(const DistanceFrame& frame, const bvh::SupportLine* a, std::uint32_t count_a,
                    const bvh::SupportLine* b, std::uint32_t count_b, float least, float most, NodeGaps& gaps);
  /// \param limit distances above it are of no interest: their upper bounds are infinite
  /// \returns false if all are above it
  bool (*leaves)(const DistanceFrame& frame, const float* vertices_a, bvh::NodeRef leaf_a, const float* vertices_b,
                 bvh::NodeRef leaf_b, float limit, FaceGaps& gaps);
};

/// Of the best instruction set that this computer has.
const DistanceKernels& distance_kernels();
/// \param target one of simd_targets()
/// \throws std::invalid_argument there is no such target
DistanceKernels distance_kernels(const std::string& target);

}  // namespace cchip::simd

#endif
