// SPDX-License-Identifier: Apache-2.0
/// \file
/// The exact oracle: orientation predicates over a multiprecision library; no separating axes, so it
/// shares neither arithmetic nor algorithm with the hardware, its model or the Eigen reference.
#ifndef CCHIP_INTERNAL_EXACT_ORACLE_HPP
#define CCHIP_INTERNAL_EXACT_ORACLE_HPP

#include <cchip/pose.hpp>
#include <cchip/primitive.hpp>
#include <cchip/relation.hpp>

namespace cchip {

/// True if the closed primitives share a point (touching counts). Coplanar and degenerate primitives included, quads as
/// hulls of their four vertices. Exact for any finite doubles: all coordinates are scaled by one power of two to
/// integers of arbitrary size.
/// \throws std::invalid_argument if a coordinate is not finite
bool exact_intersects(const Primitive& a, const Primitive& b);
/// The same for primitives under poses, in real arithmetic without rounding: a vertex v lies at linear() v +
/// translation(). PosedPairs answers the same faster.
bool exact_intersects(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b);

/// Whether the closed primitives are apart, touch or cross (docs/cpp/touching.md), for any finite doubles.
/// \throws std::invalid_argument if a coordinate is not finite
Relation exact_relation(const Primitive& a, const Primitive& b);
/// The same under poses.
Relation exact_relation(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b);

}  // namespace cchip

#endif
