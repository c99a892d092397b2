// SPDX-License-Identifier: Apache-2.0
/// \file
/// A first look at two placed objects, before their poses are related: are they apart along the line of their centres?
/// docs/cpp/exactness.md, "Far apart", derives the bounds.
#ifndef CCHIP_SEARCH_FAR_TEST_HPP
#define CCHIP_SEARCH_FAR_TEST_HPP

#include <array>
#include <cchip/collide.hpp>

namespace cchip {

/// Where the centres of two placed objects lie to each other, in the world.
struct CentreLine {
  std::array<double, 3> between;  ///< that of B minus that of A; each component off by at most 6 u size
  double size;                    ///< bound on the sum of the magnitudes that are added up for any point of the objects
  double entries_a;               ///< sum of the magnitudes of the entries of the linear map of A
  double entries_b;
  bool moderate;  ///< no product of the tests below overflows, and what underflows is within the limit
};

/// Bound on the rounding of a gap along an axis, in units of `size` and of the axis's greatest component: 24 u. 13.4 u
/// are needed.
inline constexpr double far_limit = 24 * 0x1p-53;
/// Shorter axes separate nothing: products with them might underflow.
inline constexpr double far_axis_least = 0x1p-100;

CentreLine centre_line(const CollisionQuery& query);

/// True only if the objects are farther apart than `within`: along the line of their centres, by the 26-DOP of each.
/// Takes every map.
/// \param margin factor on the bound, 1 but in tests
bool is_far(const CollisionQuery& query, const CentreLine& line, double within, double margin);

}  // namespace cchip

#endif
