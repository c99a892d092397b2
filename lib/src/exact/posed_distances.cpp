// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/exact/posed_distances.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "feature_pairs.hpp"
#include "fine_filter.hpp"
#include "nearest_planes.hpp"
#include "posed_filter.hpp"
#include "scaled_points.hpp"

namespace cchip {
namespace {

using exact::BigInt;
using exact::cross;
using exact::dot;
using exact::FeaturePair;
using exact::Filter;
using exact::FineFilter;
using exact::greatest_component;
using exact::Known;
using exact::Vec;
using exact::operator-;

constexpr double unit = std::numeric_limits<double>::epsilon() / 2;  // greatest relative error of one operation
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double greatest_double = std::numeric_limits<double>::max();

/// Vertices of both primitives relative to `base`, rounded.
struct Rounded {
  std::array<Vec3d, 4> a;
  std::array<Vec3d, 4> b;
  std::size_t count_a = 0;
  std::size_t count_b = 0;
  Vec3d base;             ///< in the world
  double error = 0;       ///< bound on the error of each coordinate
  double greatest = 0;    ///< magnitude of a coordinate relative to the base
  bool moderate = false;  ///< no square overflows, and what underflows is far below the error
};

/// Points of the two hulls that are near each other, relative to the base; nearest up to rounding if the hulls have no
/// point in common.
struct NearPoints {
  Vec3d a = Vec3d::Zero();
  Vec3d b = Vec3d::Zero();
  double square = infinity;
  FeaturePair pair = {0, 0};  ///< on which they lie
  void offer(const Vec3d& p, const Vec3d& q, std::size_t feature_a, std::size_t feature_b) {
    const double here = (p - q).squaredNorm();
    if (!(here < square)) return;
    square = here;
    a = p;
    b = q;
    pair = {static_cast<std::uint8_t>(feature_a), static_cast<std::uint8_t>(feature_b)};
  }
};

double clamped(double fraction) { return fraction > 0 ? std::min(fraction, 1.0) : 0; }  // NaN becomes 0

/// Number in exact::features of the edge between vertices `low` and `high`.
std::size_t edge_number(std::size_t low, std::size_t high) { return 4 + high * (high - 1) / 2 + low; }

/// The edge from vertex `low` to vertex `high`, or the end at which a point of it lies.
std::size_t edge_or_end(double at, std::size_t low, std::size_t high) {
  return at == 0 ? low : at == 1 ? high : edge_number(low, high);
}

/// The edges p + s u and q + t v.
void offer_edges(const Vec3d& p, const Vec3d& u, std::array<std::size_t, 2> ends_a, const Vec3d& q, const Vec3d& v,
                 std::array<std::size_t, 2> ends_b, NearPoints& best) {
  const Vec3d w = q - p;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double uw = u.dot(w);
  const double vw = v.dot(w);
  const double determinant = uu * vv - uv * uv;
  double s = determinant > 0 ? clamped((uw * vv - vw * uv) / determinant) : 0;
  const double t = clamped((s * uv - vw) / vv);
  s = clamped((t * uv + uw) / uu);
  best.offer(p + s * u, q + t * v, edge_or_end(s, ends_a[0], ends_a[1]), edge_or_end(t, ends_b[0], ends_b[1]));
}

/// A point and the inside of a triangle. \returns whether the triangle's plane has one
bool foot_in_face(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c, Vec3d& foot) {
  const Vec3d u = b - a;
  const Vec3d v = c - a;
  const Vec3d w = p - a;
  const Vec3d normal = u.cross(v);
  const double square = normal.squaredNorm();
  const double s = w.cross(v).dot(normal) / square;
  const double t = u.cross(w).dot(normal) / square;
  if (!(s >= 0 && t >= 0 && s + t <= 1)) return false;
  foot = a + s * u + t * v;
  return true;
}

NearPoints near_points(const Rounded& r) {
  NearPoints best;
  for (std::size_t i = 1; i < r.count_a; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3d u = r.a[i] - r.a[j];
      for (std::size_t k = 1; k < r.count_b; ++k) {
        for (std::size_t l = 0; l < k; ++l) offer_edges(r.a[j], u, {j, i}, r.b[l], r.b[k] - r.b[l], {l, k}, best);
      }
    }
  }
  const auto faces = [](std::size_t count, const std::array<Vec3d, 4>& v, const auto& visit) {
    const exact::FeatureRange range = exact::features_of(3, count);
    for (std::size_t i = range.first; i < range.first + range.size; ++i) {
      const auto& at = exact::features[i].at;
      visit(v[at[0]], v[at[1]], v[at[2]], i);
    }
  };
  Vec3d foot;
  faces(r.count_b, r.b, [&](const Vec3d& u, const Vec3d& v, const Vec3d& w, std::size_t face) {
    for (std::size_t i = 0; i < r.count_a; ++i) {
      if (foot_in_face(r.a[i], u, v, w, foot)) best.offer(r.a[i], foot, i, face);
    }
  });
  faces(r.count_a, r.a, [&](const Vec3d& u, const Vec3d& v, const Vec3d& w, std::size_t face) {
    for (std::size_t k = 0; k < r.count_b; ++k) {
      if (foot_in_face(r.b[k], u, v, w, foot)) best.offer(foot, r.b[k], face, k);
    }
  });
  return best;
}

/// A point where the hulls meet, nearly, if they do: the best that an edge of one and a face of the other offer.
Vec3d common_point(const Rounded& r, const NearPoints& best) {
  Vec3d point = 0.5 * (best.a + best.b);
  double least = best.square;
  const auto pierce = [&](const std::array<Vec3d, 4>& e, std::size_t count_e, const std::array<Vec3d, 4>& f,
                          std::size_t count_f) {
    const exact::FeatureRange range = exact::features_of(3, count_f);
    for (std::size_t i = range.first; i < range.first + range.size; ++i) {
      const auto& at = exact::features[i].at;
      const Vec3d& u = f[at[0]];
      const Vec3d normal = (f[at[1]] - u).cross(f[at[2]] - u);
      for (std::size_t k = 1; k < count_e; ++k) {
        for (std::size_t l = 0; l < k; ++l) {
          const double from = normal.dot(e[l] - u);
          const double to = normal.dot(e[k] - u);
          const Vec3d at_plane = e[l] + clamped(from / (from - to)) * (e[k] - e[l]);
          Vec3d foot;
          if (!foot_in_face(at_plane, u, f[at[1]], f[at[2]], foot)) continue;
          const double here = (at_plane - foot).squaredNorm();
          if (!(here < least)) continue;
          least = here;
          point = at_plane;
        }
      }
    }
  };
  pierce(r.a, r.count_a, r.b, r.count_b);
  pierce(r.b, r.count_b, r.a, r.count_a);
  return point;
}

/// At most the distance; an axis from B to A proves a gap as in PosedPairs. \pre r.moderate, and so is the length
double proved_gap(const Rounded& r, const Vec3d& axis, double length) {
  double from = infinity;
  double to = -infinity;
  for (std::size_t i = 0; i < r.count_a; ++i) from = std::min(from, axis.dot(r.a[i]));
  for (std::size_t i = 0; i < r.count_b; ++i) to = std::max(to, axis.dot(r.b[i]));
  const double size = axis.cwiseAbs().sum();
  const double gap = (from - to) - size * (2.5 * r.error + 16 * unit * r.greatest);
  return gap > 0 ? gap / length * (1 - 16 * unit) : 0;
}

/// What the points prove. The exact points differ from the rounded vertices' by `error` in each coordinate, those of
/// the hulls from their combinations by at most 24 units of the greatest coordinate.
void prove(const Rounded& r, const NearPoints& best, double& lower, double& upper) {
  lower = 0;
  upper = infinity;
  if (!r.moderate || !(best.square < infinity)) return;
  const Vec3d axis = best.a - best.b;
  const double length = std::sqrt(axis.squaredNorm());
  upper = length * (1 + 8 * unit) + 4 * (r.error + 24 * unit * r.greatest);
  if (!(length > 0x1p-300)) return;
  lower = proved_gap(r, axis, length);
}

/// The square of d in units of 2^(2 exponent).
BigInt square_in_units(const exact::Scaled& d, int exponent) {
  if (d.mantissa == 0) return 0;
  const BigInt x = BigInt(d.mantissa) << (d.exponent - exponent);
  return x * x;
}

/// Numerator and denominator, not below 0 and above it, in units of 2^(2 exponent).
struct Fraction {
  BigInt over;
  BigInt under;
  int exponent = 0;
};

/// value * 2^exponent, rounded down to a double. \pre value >= 0
double rounded_down(BigInt value, int exponent) {
  if (value == 0) return 0;
  constexpr int digits = std::numeric_limits<double>::digits;
  constexpr int least = std::numeric_limits<double>::min_exponent - digits;  // of a subnormal number
  const int top = static_cast<int>(boost::multiprecision::msb(value));
  if (top + exponent >= std::numeric_limits<double>::max_exponent) return greatest_double;
  const int drop = std::max(top + 1 - digits, least - exponent);
  if (drop > top) return 0;
  if (drop > 0) value >>= drop;
  return std::ldexp(static_cast<double>(static_cast<std::uint64_t>(value)), exponent + std::max(drop, 0));
}

/// The root, or the doubles beside it.
void root_of(const Fraction& square, DistanceBounds& result) {
  if (square.over == 0) {
    result.lower = result.upper = 0;
    return;
  }
  // 2^(2 shift) over / under has at least 128 bits, so its root has more than a double.
  const int bits = static_cast<int>(boost::multiprecision::msb(square.over)) -
                   static_cast<int>(boost::multiprecision::msb(square.under));
  const int shift = std::max(0, 66 - bits / 2);
  const BigInt scaled = square.over << (2 * shift);
  const BigInt root = boost::multiprecision::sqrt(BigInt(scaled / square.under));
  result.lower = rounded_down(root, square.exponent - shift);
  // Exact if the double's square is the fraction.
  result.upper = result.lower;
  const exact::Scaled x(result.lower);
  const int to = std::min(square.exponent, x.exponent);
  if (result.lower != 0 && square_in_units(x, to) * square.under == square.over << (2 * (square.exponent - to))) {
    return;
  }
  result.upper = std::nextafter(result.lower, infinity);
}

/// The transpose of the linear part times n.
Vec<FineFilter> in_frame(const Eigen::Matrix3d& linear, const Vec<FineFilter>& n) {
  Vec<FineFilter> m;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      m[k] += n[i] * FineFilter(linear(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)));
    }
  }
  return m;
}

Vec<FineFilter> operator-(const Vec<FineFilter>& v) { return {-v[0], -v[1], -v[2]}; }

/// Is the line between the nearest points at right angles to a plane: that of a face, or that which two edges span?
bool have_plane(FeaturePair pair) { return exact::features[pair.a].count + exact::features[pair.b].count == 4; }

/// Across that plane, on either side. \pre have_plane(pair)
template <class Num>
Vec<Num> across_plane(const std::array<Vec<Num>, 4>& a, const std::array<Vec<Num>, 4>& b, FeaturePair pair) {
  const exact::Feature& f = exact::features[pair.a];
  const exact::Feature& g = exact::features[pair.b];
  return f.count == 3   ? cross(a[f.at[1]] - a[f.at[0]], a[f.at[2]] - a[f.at[0]])
         : g.count == 3 ? cross(b[g.at[1]] - b[g.at[0]], b[g.at[2]] - b[g.at[0]])
                        : cross(a[f.at[1]] - a[f.at[0]], b[g.at[1]] - b[g.at[0]]);
}

/// A multiple, with a positive factor, of the vector from the nearest point of A's feature to that of B's.
template <class Num>
Vec<Num> between_features(const std::array<Vec<Num>, 4>& a, const std::array<Vec<Num>, 4>& b, FeaturePair pair) {
  const exact::Feature& f = exact::features[pair.a];
  const exact::Feature& g = exact::features[pair.b];
  const Vec<Num> between = b[g.at[0]] - a[f.at[0]];
  if (f.count == 1 && g.count == 1) return between;
  if (f.count + g.count == 3) {  // what is left of it across the edge
    const Vec<Num> edge = f.count == 2 ? a[f.at[1]] - a[f.at[0]] : b[g.at[1]] - b[g.at[0]];
    const Num square = dot(edge, edge);
    const Num along = dot(edge, between);
    Vec<Num> across;
    for (std::size_t k = 0; k < 3; ++k) across[k] = between[k] * square - edge[k] * along;
    return across;
  }
  Vec<Num> normal = across_plane(a, b, pair);
  if (dot(normal, between).sign() < 0) {
    for (Num& x : normal) x = -x;
  }
  return normal;
}

/// Pairs of features that may be nearer than d, in doubles with error bounds.
struct OpenPairs {
  bool certain = false;  ///< one is
  std::size_t count = 0;
  std::array<FeaturePair, exact::feature_pairs_most> pair;  ///< those of which it is not known, if none is
};

}  // namespace

PosedDistances::PosedDistances(const Pose& pose_a, const Pose& pose_b)
    : pairs_(pose_a, pose_b), pose_a_(pose_a), pose_b_(pose_b) {
  const exact::Offset offset(pose_a, pose_b);
  offset_ = offset.value;
  offset_error_ = offset.error;
  same_linear_ = pose_a.linear() == pose_b.linear();
  row_sum_a_ = pose_a.linear().cwiseAbs().rowwise().sum().maxCoeff();
  row_sum_b_ = pose_b.linear().cwiseAbs().rowwise().sum().maxCoeff();
}

/// The steps of the members of PosedDistances for one pair.
class PosedDistances::Pair {
 public:
  Pair(const PosedDistances& poses, const Primitive& a, const Primitive& b)
      : poses_(poses), a_(a), b_(b), r_(rounded(poses, a, b)), near_(near_points(r_)) {
    prove(r_, near_, lower_, upper_);
  }
  static Rounded rounded(const PosedDistances& poses, const Primitive& a, const Primitive& b) {
    Rounded r;
    r.count_a = a.vertex_count();
    r.count_b = b.vertex_count();
    // As in PosedPairs: both frames lose B's translation, then b's first vertex, rounded, is the origin.
    r.base = poses.pose_b_.linear() * b.v[0];
    for (std::size_t i = 0; i < r.count_a; ++i) {
      r.a[i] = (poses.pose_a_.linear() * a.v[i] + poses.offset_) - r.base;
      r.greatest = std::max(r.greatest, r.a[i].cwiseAbs().maxCoeff());
    }
    for (std::size_t i = 0; i < r.count_b; ++i) {
      r.b[i] = poses.pose_b_.linear() * b.v[i] - r.base;
      r.greatest = std::max(r.greatest, r.b[i].cwiseAbs().maxCoeff());
    }
    const double magnitude = poses.row_sum_a_ * greatest_component(a) + poses.row_sum_b_ * greatest_component(b) +
                             poses.offset_.cwiseAbs().maxCoeff();
    r.error = 8 * unit * magnitude + 0x1p-1070;
    r.moderate = magnitude < 0x1p400 && (r.greatest == 0 || r.greatest > 0x1p-400);
    return r;
  }

  double lower() const { return lower_; }
  double upper() const { return upper_; }
  /// Features on which the nearest points lie, up to rounding.
  FeaturePair features() const { return near_.pair; }
  DistanceBounds bounds() const {
    const Vec3d origin = r_.base + poses_.pose_b_.translation();
    return {lower_, upper_, near_.a + origin, near_.b + origin};
  }
  Vec3d point_in_common() const { return common_point(r_, near_) + (r_.base + poses_.pose_b_.translation()); }

  /// \pre the primitives share no point
  OpenPairs open_pairs(double d, bool strictly, bool keep_certain) const {
    const auto a =
        exact::filter_points(a_, poses_.pose_a_.linear(), exact::filter_offset(poses_.offset_, poses_.offset_error_));
    const auto b = exact::filter_points(b_, poses_.pose_b_.linear(), Vec<Filter>{});
    const Filter square = Filter(d) * Filter(d);
    OpenPairs open;
    exact::for_each_feature_pair(r_.count_a, r_.count_b, [&](FeaturePair pair) {
      const Known known = is_near(exact::square_of(a, b, pair), square, strictly);
      if (known == Known::open || (known == Known::yes && keep_certain)) open.pair[open.count++] = pair;
      open.certain = open.certain || known == Known::yes;
      return !open.certain || keep_certain;
    });
    return open;
  }

  /// The distance, or the doubles beside it, by the features that are nearest up to rounding, in sums of two doubles.
  struct Fine {
    DistanceBounds bounds;
    Vec<FineFilter> normal_a;  ///< outward at the nearest point, in A's coordinates
    Vec<FineFilter> normal_b;  ///< the same of B
  };
  /// \returns nothing if they cannot tell
  std::optional<Fine> fine() const {
    if (!r_.moderate) return std::nullopt;
    const Vec3d& from = poses_.pose_b_.translation();
    const Vec3d& to = poses_.pose_a_.translation();
    Vec<FineFilter> offset;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      offset[k] = FineFilter(to[i]) - FineFilter(from[i]);
    }
    const auto a = exact::filter_points(a_, poses_.pose_a_.linear(), offset);
    const auto b = exact::filter_points(b_, poses_.pose_b_.linear(), Vec<FineFilter>{});
    const exact::SquareOfPair<FineFilter> square = exact::square_of(a, b, near_.pair);
    for (std::size_t k = 0; k < square.inside_count; ++k) {
      if (square.inside[k].sign() <= 0) return std::nullopt;
    }
    // All vertices but the features' own lie behind the planes through the nearest points.
    const auto is_behind = [](const Vec<FineFilter>& outward, const std::array<Vec<FineFilter>, 4>& v,
                              std::size_t count, const exact::Feature& feature) {
      for (std::size_t i = 0; i < count; ++i) {
        const auto* const end = feature.at.begin() + feature.count;
        if (std::find(feature.at.begin(), end, i) != end) continue;
        const FineFilter height = exact::dot(outward, v[i] - v[feature.at[0]]);
        if (!height.is_known() || height.sign() > 0) return false;
      }
      return true;
    };
    const auto are_behind = [&](const Vec<FineFilter>& normal, const std::array<Vec<FineFilter>, 4>& v_a,
                                const std::array<Vec<FineFilter>, 4>& v_b) {
      return is_behind(normal, v_a, r_.count_a, exact::features[near_.pair.a]) &&
             is_behind(-normal, v_b, r_.count_b, exact::features[near_.pair.b]);
    };
    const Vec<FineFilter> normal = between_features(a, b, near_.pair);
    const std::optional<Vec<FineFilter>> common = common_normal(a, b, normal);
    const bool all_behind = common ? are_behind(*common, unmoved(a_), unmoved(b_)) : are_behind(normal, a, b);
    if (!all_behind) return std::nullopt;
    const auto fine_of = [&](const DistanceBounds& bounds) {
      if (common) return Fine{bounds, *common, -*common};
      return Fine{bounds, in_frame(poses_.pose_a_.linear(), normal), in_frame(poses_.pose_b_.linear(), -normal)};
    };
    // The greatest double whose square is not more, and the next one if it is less.
    const auto excess = [&square](double x) { return square.over - FineFilter(x) * FineFilter(x) * square.under; };
    DistanceBounds result = bounds();
    result.lower = std::sqrt(square.over.value() / square.under.value());
    if (!(result.lower > 0x1p-400 && result.lower < 0x1p400)) return std::nullopt;
    for (int step = 0; step < 3; ++step) {
      const FineFilter here = excess(result.lower);
      if (!here.is_known()) break;
      result.upper = here.sign() == 0 ? result.lower : std::nextafter(result.lower, infinity);
      if (here.sign() == 0) return fine_of(result);
      if (here.sign() < 0) {
        result.lower = std::nextafter(result.lower, 0.0);
        continue;
      }
      const FineFilter next = excess(result.upper);
      if (!next.is_known()) break;
      if (next.sign() < 0) return fine_of(result);
      result.lower = result.upper;
    }
    return std::nullopt;
  }

  /// The vertices as integers in units of 2^exponent(), which is at most `exponent`.
  struct Integers {
    std::array<Vec<BigInt>, 4> a;
    std::array<Vec<BigInt>, 4> b;
    int exponent;
  };
  Integers integers(int exponent) const {
    Pose pose_a = poses_.pose_a_;
    Pose pose_b = poses_.pose_b_;
    if (poses_.offset_error_.isZero(0)) {  // what is left of the translations has fewer bits
      pose_a.translation() = poses_.offset_;
      pose_b.translation().setZero();
    }
    const int common = exact::common_exponent(b_, pose_b, exact::common_exponent(a_, pose_a, exponent));
    return {exact::scaled_points(a_, pose_a, common), exact::scaled_points(b_, pose_b, common), common};
  }

 private:
  static std::array<Vec<FineFilter>, 4> unmoved(const Primitive& p) {
    return exact::filter_points(p, Eigen::Matrix3d::Identity(), Vec<FineFilter>{});
  }
  /// Where both objects are under the same linear map L, a plane has the same normal in the coordinates of both, and it
  /// is that of their own vertices: L^T (L u x L v) = det L (u x v). So vertices on the plane are known to be there.
  /// \param normal of the same plane in the world, from A to B
  /// \returns nothing if the maps are not the same, or a sign is not known
  std::optional<Vec<FineFilter>> common_normal(const std::array<Vec<FineFilter>, 4>& a,
                                               const std::array<Vec<FineFilter>, 4>& b,
                                               const Vec<FineFilter>& normal) const {
    if (!poses_.same_linear_ || !have_plane(near_.pair)) return std::nullopt;
    const Vec<FineFilter> unsigned_normal = across_plane(a, b, near_.pair);
    const Eigen::Matrix3d& linear = poses_.pose_a_.linear();
    std::array<Vec<FineFilter>, 3> column;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        column[k][i] = linear(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
      }
    }
    const int sign =
        exact::dot(unsigned_normal, normal).sign() * exact::dot(exact::cross(column[0], column[1]), column[2]).sign();
    if (sign == 0) return std::nullopt;
    const Vec<FineFilter> own = across_plane(unmoved(a_), unmoved(b_), near_.pair);
    return sign > 0 ? own : -own;
  }

  const PosedDistances& poses_;
  const Primitive& a_;
  const Primitive& b_;
  Rounded r_;
  NearPoints near_;
  double lower_ = 0;
  double upper_ = infinity;
};

PosedDistances::Answer PosedDistances::compare(const Primitive& a, const Primitive& b, double d, bool strictly) const {
  if (d == 0) {
    if (strictly) return {};
    const PosedPairs::Answer met = pairs_.decide(a, b);
    return {met.hit, met.open};
  }
  const Pair pair(*this, a, b);
  if (strictly ? pair.upper() < d : pair.upper() <= d) return {true, false};
  if (strictly ? pair.lower() >= d : pair.lower() > d) return {};
  const PosedPairs::Answer met = pairs_.decide(a, b);
  if (met.hit) return {true, met.open};
  const OpenPairs open = pair.open_pairs(d, strictly, false);
  if (open.certain) return {true, met.open};
  if (open.count == 0) return {false, met.open};
  const exact::Scaled scaled(d);
  const Pair::Integers exact = pair.integers(scaled.exponent);
  const BigInt square = square_in_units(scaled, exact.exponent);
  for (std::size_t i = 0; i < open.count; ++i) {
    if (is_near(exact::square_of(exact.a, exact.b, open.pair[i]), square, strictly) == Known::yes) return {true, true};
  }
  return {false, true};
}

DistanceBounds PosedDistances::bounds(const Primitive& a, const Primitive& b) const {
  return Pair(*this, a, b).bounds();
}

double PosedDistances::gap_along(const Vec3d& axis, const Primitive& a, const Primitive& b) const {
  const Rounded r = Pair::rounded(*this, a, b);
  const double length = axis.norm();
  return r.moderate && length > 0x1p-300 && length < 0x1p300 ? proved_gap(r, -axis, length) : 0;
}

DistanceBounds PosedDistances::tight_bounds(const Primitive& a, const Primitive& b) const {
  const Pair pair(*this, a, b);
  DistanceBounds result = pair.bounds();
  if (!(result.lower > 0) && pairs_.decide(a, b).hit) {
    result.lower = result.upper = 0;
    result.point_a = result.point_b = pair.point_in_common();
    return result;
  }
  return exact::NearestPlanes(*this, a, b).bounds();
}

namespace exact {
namespace {

/// factor * the transpose of the linear part times n, in any unit.
Vec<BigInt> in_frame(const Eigen::Matrix3d& linear, const Vec<BigInt>& n, int factor) {
  int least = std::numeric_limits<int>::max();
  for (const double entry : linear.reshaped()) {
    if (entry != 0) least = std::min(least, Scaled(entry).exponent);
  }
  Vec<BigInt> m;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Scaled entry(linear(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)));
      if (entry.mantissa != 0) m[k] += n[i] * BigInt(factor * entry.mantissa) << (entry.exponent - least);
    }
  }
  return m;
}

/// x / 2^exponent, |x| at most that.
FineFilter fine_filter_of(BigInt x, int exponent) {
  FineFilter sum;
  for (int part = 0; part < 3 && x != 0; ++part) {  // 2^-105 of the greatest is left
    const int drop = std::max(0, static_cast<int>(boost::multiprecision::msb(abs(x))) - 52);
    if (drop - exponent < -1000) break;
    const BigInt top = (abs(x) >> drop) * x.sign();
    const double value = std::ldexp(static_cast<double>(static_cast<std::int64_t>(top)), drop - exponent);
    sum += FineFilter(value);
    x -= BigInt(top << drop);
  }
  return x == 0 ? sum : FineFilter(sum, std::abs(sum.value()) * 0x1p-104 + 0x1p-900);
}

Vec<FineFilter> fine_filters_of(const Vec<BigInt>& normal) {
  int exponent = 0;
  for (const BigInt& x : normal) {
    if (x != 0) exponent = std::max(exponent, static_cast<int>(boost::multiprecision::msb(abs(x))) + 1);
  }
  return {fine_filter_of(normal[0], exponent), fine_filter_of(normal[1], exponent),
          fine_filter_of(normal[2], exponent)};
}

/// Is each component known to far less than the rounding of the greatest one? Edges that are nearly parallel lose
/// digits.
bool is_precise(const Vec<FineFilter>& normal) {
  double greatest = 0;
  double error = 0;
  for (const FineFilter& x : normal) {
    greatest = std::max(greatest, std::abs(x.value()));
    error = std::max(error, x.error());
  }
  return error <= 0x1p-60 * greatest;
}

std::array<Vec3d, 3> points_of(const Primitive& p, const Feature& feature) {
  return {p.v[feature.at[0]], p.v[feature.at[feature.count > 1 ? 1 : 0]], p.v[feature.at[feature.count > 2 ? 2 : 0]]};
}

}  // namespace

HalfSpace::HalfSpace(const Vec<FineFilter>& normal, const std::array<Vec3d, 3>& on_plane,
                     std::function<Vec<BigInt>()> exact)
    : normal_(normal), on_plane_(on_plane), make_exact_(std::move(exact)) {
  for (std::size_t k = 0; k < 3; ++k) rounded_[static_cast<Eigen::Index>(k)] = normal[k].value();
  const double greatest = rounded_.cwiseAbs().maxCoeff();
  if (greatest > 0 && greatest < infinity) rounded_ *= std::ldexp(1.0, -std::ilogb(greatest) - 1);
  for (std::size_t k = 0; k < 3; ++k) is_zero_[k] = normal[k].is_known() && normal[k].sign() == 0;
  for (int k = 0; k < 3; ++k) {
    if (is_zero_[static_cast<std::size_t>(k + 1) % 3] && is_zero_[static_cast<std::size_t>(k + 2) % 3] &&
        normal[static_cast<std::size_t>(k)].sign() != 0) {
      along_ = k;
    }
  }
}

HalfSpace::HalfSpace(const Vec<BigInt>& normal, const std::array<Vec3d, 3>& on_plane)
    : HalfSpace(fine_filters_of(normal), on_plane, nullptr) {
  exact_ = normal;
}

bool HalfSpace::contains(const Vec3d& v) const {
  if (along_ >= 0) return rounded_[along_] > 0 ? v[along_] <= through()[along_] : v[along_] >= through()[along_];
  // Along the plane from a point of it, in exact numbers.
  for (const Vec3d& p : on_plane_) {
    if ((v.x() == p.x() || is_zero_[0]) && (v.y() == p.y() || is_zero_[1]) && (v.z() == p.z() || is_zero_[2])) {
      return true;
    }
  }
  // Components of the normal are off by 2^-50 of the greatest, which is below 1; differences, products and sums by a
  // few 2^-53 and by what underflows.
  const Vec3d between = v - through();
  const double rounded = rounded_.dot(between);
  if (std::abs(rounded) > 0x1p-47 * between.cwiseAbs().sum() + 0x1p-1000) return rounded < 0;
  FineFilter height;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    height += normal_[k] * (FineFilter(v[i]) - FineFilter(through()[i]));
  }
  if (height.is_known()) return height.sign() <= 0;
  if (!exact_) exact_ = make_exact_();
  int least = std::numeric_limits<int>::max();
  for (const double x : {v[0], v[1], v[2], through()[0], through()[1], through()[2]}) {
    if (x != 0) least = std::min(least, Scaled(x).exponent);
  }
  const auto whole = [least](double x) {
    const Scaled scaled(x);
    return scaled.mantissa == 0 ? BigInt(0) : BigInt(scaled.mantissa) << (scaled.exponent - least);
  };
  BigInt exact = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    exact += (*exact_)[k] * (whole(v[i]) - whole(through()[i]));
  }
  return exact.sign() <= 0;
}

bool HalfSpace::contains(const Primitive& p) const {
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    if (!contains(p.v[i])) return false;
  }
  return true;
}

bool HalfSpace::contains(const std::vector<Vec3d>& points) const {
  if (along_ < 0) return std::all_of(points.begin(), points.end(), [this](const Vec3d& v) { return contains(v); });
  const double sign = rounded_[along_] > 0 ? 1 : -1;
  const double most = sign * through()[along_];
  bool all = true;  // without branches
  for (const Vec3d& v : points) all = all & (sign * v[along_] <= most);
  return all;
}

NearestPlanes::NearestPlanes(const PosedDistances& distances, const Primitive& a, const Primitive& b) {
  const PosedDistances::Pair pair(distances, a, b);
  const std::optional<PosedDistances::Pair::Fine> fine = pair.fine();
  Vec<FineFilter> normal_a;
  Vec<FineFilter> normal_b;
  if (fine) {
    normal_a = fine->normal_a;
    normal_b = fine->normal_b;
  }
  if (!fine || !is_precise(normal_a) || !is_precise(normal_b)) {
    make_exactly(distances, a, b);
    return;
  }
  bounds_ = fine->bounds;
  const FeaturePair features_of_both = pair.features();
  const auto exact = [&distances, a, b, features_of_both](const Pose& pose, int sign) {
    const PosedDistances::Pair::Integers integers = PosedDistances::Pair(distances, a, b).integers(0);
    return in_frame(pose.linear(), between_features(integers.a, integers.b, features_of_both), sign);
  };
  a_ = HalfSpace(normal_a, points_of(a, features[features_of_both.a]),
                 [&distances, exact] { return exact(distances.pose_a_, 1); });
  b_ = HalfSpace(normal_b, points_of(b, features[features_of_both.b]),
                 [&distances, exact] { return exact(distances.pose_b_, -1); });
}

void NearestPlanes::make_exactly(const PosedDistances& distances, const Primitive& a, const Primitive& b) {
  const PosedDistances::Pair pair(distances, a, b);
  bounds_ = pair.bounds();
  const PosedDistances::Pair::Integers integers = pair.integers(0);
  const auto make_planes = [&](FeaturePair features_of_both) {
    const Vec<BigInt> between = between_features(integers.a, integers.b, features_of_both);
    a_ = HalfSpace(in_frame(distances.pose_a_.linear(), between, 1), points_of(a, features[features_of_both.a]));
    b_ = HalfSpace(in_frame(distances.pose_b_.linear(), between, -1), points_of(b, features[features_of_both.b]));
  };
  const auto square_if_inside = [&](FeaturePair features_of_both, Fraction& square) {
    const SquareOfPair<BigInt> s = square_of(integers.a, integers.b, features_of_both);
    for (std::size_t k = 0; k < s.inside_count; ++k) {
      if (s.inside[k].sign() <= 0) return false;
    }
    square = {s.over, s.under, integers.exponent};
    return true;
  };
  // The features that doubles found are the nearest ones if the faces lie behind the planes.
  Fraction least;
  if (square_if_inside(pair.features(), least)) {
    make_planes(pair.features());
    if (a_.contains(a) && b_.contains(b)) {
      root_of(least, bounds_);
      return;
    }
  }
  // Otherwise all that are not certainly farther apart than is known already.
  const OpenPairs left = pair.open_pairs(pair.upper(), false, true);
  bool found = false;
  FeaturePair nearest = {0, 0};
  for (std::size_t i = 0; i < left.count; ++i) {
    Fraction square;
    if (!square_if_inside(left.pair[i], square)) continue;
    if (found && square.over * least.under >= least.over * square.under) continue;
    found = true;
    least = square;
    nearest = left.pair[i];
  }
  if (!found) throw std::logic_error("distance: no pair of features is nearest; report this with both primitives");
  make_planes(nearest);
  root_of(least, bounds_);
}

}  // namespace exact

}  // namespace cchip
