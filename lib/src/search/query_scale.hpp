// SPDX-License-Identifier: Apache-2.0
/// \file
/// Brings the numbers of a query near 1.
#ifndef CCHIP_SEARCH_QUERY_SCALE_HPP
#define CCHIP_SEARCH_QUERY_SCALE_HPP

#include <cchip/collide.hpp>
#include <cchip/pose.hpp>

namespace cchip {

/// Both poses of a query times one power of two: the same query in another unit of length, without rounding. A query
/// whose sizes lie between 2^-100 and 2^100 keeps its unit. So error bounds that hold for numbers of moderate size hold
/// for all queries but those whose poses have, beside entries that matter, others that would become subnormal or
/// infinite: these keep a unit in which all entries are exact.
class QueryScale {
 public:
  /// \pre check_query() accepts the query
  explicit QueryScale(const CollisionQuery& query);

  /// The pose in the unit of the search.
  Pose operator()(const Pose& pose) const;

  /// A length of the caller's in the unit of the search, rounded up; infinite beyond the doubles.
  double rounded_up(double length) const;

  /// Lengths and points of the search in the caller's unit: lengths rounded down to a finite one, or up.
  double lower(double length) const;
  double upper(double length) const;
  Vec3d point(const Vec3d& p) const;

 private:
  int exponent_ = 0;  ///< a length of the caller's is 2^exponent_ times as long in the search
};

}  // namespace cchip

#endif
