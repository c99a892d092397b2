// SPDX-License-Identifier: Apache-2.0
/// \file
/// How two closed sets lie to each other.
#ifndef CCHIP_RELATION_HPP
#define CCHIP_RELATION_HPP

namespace cchip {

/// For convex sets: they cross if every small enough translation of one leaves them in contact, that is if 0 lies in
/// the interior of A - B; they touch if they share a point and do not cross, so that some translation, however small,
/// parts them. For objects: crossing if a pair of faces crosses, else touching if one touches, else apart
/// (docs/cpp/touching.md). In ascending order.
enum class Relation { apart, touching, crossing };

}  // namespace cchip

#endif
