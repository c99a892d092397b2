// SPDX-License-Identifier: Apache-2.0
/// \file
/// From two objects and their poses to the query that the chip takes.
#ifndef CCHIP_INTERNAL_IMAGE_PLACE_HPP
#define CCHIP_INTERNAL_IMAGE_PLACE_HPP

#include <cchip/internal/image/image_line.hpp>
#include <cchip/internal/wire/query.hpp>
#include <cchip/pose.hpp>
#include <optional>

namespace cchip::bvh {

/// The query for objects with these headers, object i placed by pose i, which may be any invertible affine map. Sets
/// only m, t, shift, error and swapped. The object with the finer unit plays A, whichever the user named first. The
/// error bound covers, by interval arithmetic, the inverse that relates the two poses (their doubles are taken as
/// exact) and the rounding to the query's format; it is 0 if the query is exact.
/// \returns nothing if the chip does not take this pair: units more than 2^15 apart, a map that is singular or so
///          ill-conditioned that the bound does not fit, or numbers that are not finite or overflow
std::optional<Query> make_query(const HeaderLine& a, const Pose& pose_a, const HeaderLine& b, const Pose& pose_b);

}  // namespace cchip::bvh

#endif
