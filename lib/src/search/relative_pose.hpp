// SPDX-License-Identifier: Apache-2.0
/// \file
/// How two placed objects lie to each other, in units of one of them, with what rounding may cost.
#ifndef CCHIP_SEARCH_RELATIVE_POSE_HPP
#define CCHIP_SEARCH_RELATIVE_POSE_HPP

#include <array>
#include <cchip/collide.hpp>

#include "far_test.hpp"

namespace cchip {

/// The object with the finer unit plays `moved`, the other one `fixed`. A point y of the moved one, relative to its
/// centre and in its units, lies at m y + t relative to the fixed one's centre, in that one's units.
/// docs/cpp/exactness.md derives the bounds.
struct RelativePose {
  bool swapped = false;     ///< the moved object is B of the query
  std::array<double, 9> m;  ///< row by row
  std::array<double, 3> t;
  double norm = 0;         ///< of m, Frobenius
  double row = 0;          ///< greatest Euclidean norm of a row of m
  double distance = 0;     ///< |t|
  double plane_error = 0;  ///< units that the errors of m and t may add to a bound on a normalised direction
  double vertex_error =
      0;              ///< bound on how far m y + t lies from the exact place in each coordinate, |y| <= support_most
  double growth = 0;  ///< bound on the length of what a vector of the world as long as `within` becomes
};

/// \param line centre_line() of the query
/// \param within the distance that is asked for
/// \returns false if the relation cannot be computed well: a map that has no good inverse, or numbers that are so great
///          or small that products of three of them leave the range of doubles
bool relate(const CollisionQuery& query, const CentreLine& line, double within, RelativePose& relation);

}  // namespace cchip

#endif
