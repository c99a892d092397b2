// SPDX-License-Identifier: Apache-2.0
/// \file
/// Counts wrong answers about distances.
#ifndef CCHIP_BENCH_DISTANCE_COUNT_HPP
#define CCHIP_BENCH_DISTANCE_COUNT_HPP

#include <algorithm>
#include <cchip/distance.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "exact_distance.hpp"
#include "peer_library.hpp"

namespace cchip::testing {

/// lower <= distance <= upper of a query; brute force has proved it, or not looked at it.
struct TrueDistance {
  double lower = 0;
  double upper = 0;
};

/// Brute force in integers about what distance() says: is lower <= distance <= upper?
inline bool is_proved(const Mesh& a, const Pose& pose_a, const Mesh& b, const Pose& pose_b,
                      const DistanceResult& claim) {
  const PlacedFaces faces_a(a, pose_a);
  const PlacedFaces faces_b(b, pose_b);
  const ExactDistance exact = exact_distance(faces_a, faces_b, claim.upper, claim.point_b - claim.point_a);
  return exact.square.under != 0 && exact.compare(claim.lower) >= 0 && exact.compare(claim.upper) <= 0;
}

/// What became of a library's answers.
struct DistanceCount {
  std::size_t answers = 0;
  std::size_t wrong = 0;      ///< off by more than the tolerance, or no number
  std::size_t inexact = 0;    ///< off by anything: below `lower` or above `upper`
  double greatest_error = 0;  ///< of all answers; infinite: no number
  std::size_t points = 0;     ///< pairs of nearest points of objects that are apart
  std::size_t wrong_points = 0;
  std::size_t decisions = 0;  ///< answers of yes or no to: at most d?
  std::size_t wrong_decisions = 0;
  std::size_t edges = 0;  ///< the same with d just below the distance, and at it, or within an ulp of it
  std::size_t wrong_edges = 0;

  DistanceCount& operator+=(const DistanceCount& x) {
    answers += x.answers;
    wrong += x.wrong;
    inexact += x.inexact;
    greatest_error = std::max(greatest_error, x.greatest_error);
    points += x.points;
    wrong_points += x.wrong_points;
    decisions += x.decisions;
    wrong_decisions += x.wrong_decisions;
    edges += x.edges;
    wrong_edges += x.wrong_edges;
    return *this;
  }

  /// Returns whether the answer is wrong.
  bool add_distance(double claim, const TrueDistance& right, double tolerance) {
    ++answers;
    const double said = std::max(0.0, claim);  // a library may say "they meet" by a negative number
    const double error = std::isfinite(claim) ? std::max({0.0, said - right.upper, right.lower - said})
                                              : std::numeric_limits<double>::infinity();
    greatest_error = std::max(greatest_error, error);
    const bool is_wrong = error > tolerance;
    inexact += error > 0 ? 1 : 0;
    wrong += is_wrong ? 1 : 0;
    return is_wrong;
  }

  /// Points are right that lie on the surfaces, as far apart as the library says.
  void add_points(const PeerDistance& claim, const PlacedFaces& a, const PlacedFaces& b, double tolerance) {
    ++points;
    const double length = (claim.point_b - claim.point_a).norm();
    const bool fits = std::abs(length - claim.distance) <= tolerance;  // false for what is no number
    wrong_points += fits && is_near(claim.point_a, a, tolerance) && is_near(claim.point_b, b, tolerance) ? 0U : 1U;
  }

  /// A distance, and of objects that are apart the points.
  void add_answer(const PeerDistance& claim, const TrueDistance& right, double tolerance, const Mesh& a, const Mesh& b,
                  const PosePair& pose) {
    add_distance(claim.distance, right, tolerance);
    if (right.lower > tolerance) add_points(claim, PlacedFaces(a, pose.a), PlacedFaces(b, pose.b), tolerance);
  }

  /// A wrong answer about a distance within the tolerance of d is none.
  void add_decision(bool claim, double d, const TrueDistance& right, double tolerance) {
    ++decisions;
    const bool is_wrong = claim ? right.lower > d + tolerance : right.upper < d - tolerance;
    wrong_decisions += is_wrong ? 1 : 0;
  }

  /// No tolerance here: yes at the upper bound of the distance, no below its lower one. `within` is asked with d.
  template <class Within>
  void add_edges(const Within& within, const TrueDistance& right) {
    ++edges;
    wrong_edges += within(right.upper) ? 0 : 1;
    if (right.lower == 0) return;
    ++edges;
    wrong_edges += within(std::nextafter(right.lower, 0.0)) ? 1 : 0;
  }
};

/// The d of a query that is asked: half the distance and twice it; of objects that meet 0, and a thousandth of their
/// size, which is 1.
inline double half_distance(const TrueDistance& right) { return 0.5 * right.lower; }
inline double twice_distance(const TrueDistance& right) { return right.upper > 0 ? 2 * right.upper : 1e-3; }

/// All answers of a library about two meshes.
inline DistanceCount count_answers(const PeerMesh& peer_a, const PeerMesh& peer_b, double tolerance, const Mesh& a,
                                   const Mesh& b, const std::vector<PosePair>& poses,
                                   const std::vector<TrueDistance>& right) {
  DistanceCount count;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const PosePair& pose = poses[i];
    count.add_answer(peer_a.distance(pose.a, peer_b, pose.b), right[i], tolerance, a, b, pose);
    for (const double d : {half_distance(right[i]), twice_distance(right[i])}) {
      count.add_decision(peer_a.within(pose.a, peer_b, pose.b, d), d, right[i], tolerance);
    }
    count.add_edges([&](double d) { return peer_a.within(pose.a, peer_b, pose.b, d); }, right[i]);
  }
  return count;
}

}  // namespace cchip::testing

#endif
