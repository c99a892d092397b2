// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pairs of bounding volumes that touch in one point, at the very end of their intervals on one direction, so that
/// every rounding of the box test counts; and the proof of it in integers, which shares nothing with the box test.
#ifndef CCHIP_STIMULUS_TOUCHING_VOLUMES_HPP
#define CCHIP_STIMULUS_TOUCHING_VOLUMES_HPP

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cchip/internal/image/image_line.hpp>
#include <cchip/internal/wire/query.hpp>
#include <cchip/stimulus/boundary.hpp>
#include <cmath>
#include <cstdint>
#include <random>

namespace cchip::stimulus {

/// Two nodes of one child each, and a query under which the children have a point in common.
struct Touch {
  bvh::InnerLine a;
  bvh::InnerLine b;
  Query query;
  /// The point: of A in half steps from the origin of its node, likewise of B.
  std::array<std::int64_t, 3> point_a = {};
  std::array<std::int64_t, 3> point_b = {};
};

class TouchingVolumes {
 public:
  explicit TouchingVolumes(std::uint64_t seed) : random_(seed) {}

  /// Two nodes of one child each that touch in a point.
  Touch next() {
    for (;;) {
      Touch touch;
      if (attempt(touch)) return touch;
    }
  }

 private:
  std::int64_t whole(std::int64_t least, std::int64_t most) {
    return std::uniform_int_distribution<std::int64_t>(least, most)(random_);
  }
  int edge(std::int64_t least, std::int64_t most) { return static_cast<int>(draw(random_, least, most)); }
  double real(double least, double most) { return std::uniform_real_distribution<double>(least, most)(random_); }
  bool one_in(int n) { return whole(1, n) == 1; }

  Eigen::Matrix3d rotation() {
    return Eigen::Quaterniond(real(-1, 1), real(-1, 1), real(-1, 1), real(-1, 1)).normalized().toRotationMatrix();
  }

  /// Any kind of map that the descriptor can represent; entries of 30 fraction bits.
  Eigen::Matrix3d map() {
    Eigen::Matrix3d m = rotation();
    switch (whole(0, 8)) {
      case 0:  // signed permutation
      case 1:
      case 6: {
        m.setZero();
        const std::int64_t first = whole(0, 2);
        const std::int64_t flip = whole(1, 2);
        for (std::int64_t i = 0; i < 3; ++i) m(i, (first + flip * i) % 3) = one_in(2) ? 1 : -1;
        if (one_in(3)) {  // or nearly one, with near ties of |m|
          for (double& x : m.reshaped()) x += real(-0x1p-15, 0x1p-15);
        } else if (one_in(4)) {  // or turned by 45 degrees about an axis of B
          m = Eigen::AngleAxisd(std::atan(1.0), Eigen::Vector3d::Unit(whole(0, 2))).toRotationMatrix() * m;
        }
        break;
      }
      case 7:  // entries at 0, +-1/2, +-1 and a step beside them
        for (double& x : m.reshaped()) {
          const double size = std::array{0.0, 0.0, 0.0, 0.5, 1.0, real(0, 1)}[static_cast<std::size_t>(whole(0, 5))];
          x = (one_in(2) ? size : -size) + 0x1p-17 * static_cast<double>(whole(-1, 1));
        }
        break;
      case 8:  // reflection
        m = -m;
        break;
      case 2:  // shear, any numbers
        for (double& x : m.reshaped()) x = real(-1, 1);
        break;
      case 3:  // rows and columns at their limits
        m.setZero();
        m.row(whole(0, 2)) = Eigen::RowVector3d(real(0.9, 1), real(0.4, 0.6), real(0.3, 0.5));
        m.col(whole(0, 2)) += Eigen::Vector3d(real(0, 0.4), real(0, 0.4), real(0, 0.4));
        break;
      case 4:
        m *= real(0.2, 1);
        break;
      default:
        break;
    }
    return (m * 0x1p17).array().round().matrix() * 0x1p-17;
  }

  /// Moves the entries to just off the middle between two multiples of 2^-17, so that rounding them takes M p as far as
  /// it can towards -n; or just anywhere.
  void set_off(Eigen::Matrix3d& m, const Eigen::Vector3d& n, const Eigen::Vector3d& p) {
    const bool worst = !one_in(4);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double most = 0x1p-18 - 0x1p-30;
        m(i, j) += worst ? (n[i] * p[j] < 0 ? -most : most) : real(-most, most);
        m(i, j) = std::clamp(m(i, j), -1.0, 1.0);
      }
    }
  }

  static bool allowed(const Eigen::Matrix3d& m) {
    if (m.cwiseAbs().maxCoeff() > 1 || m.cwiseAbs().rowwise().sum().maxCoeff() >= 2 - 0x1p-10) return false;
    for (const auto& d : bvh::directions) {
      Eigen::Vector3d v = (m.transpose() * Eigen::Vector3d(d[0], d[1], d[2])).cwiseAbs();
      std::sort(v.begin(), v.end());
      if (v[2] >= 2 - 0x1p-8 || v[0] + v[1] > 2 + 0x1p-5) return false;
    }
    return true;
  }

  bvh::ChildVolume volume() {
    bvh::ChildVolume v;
    for (std::size_t i = 0; i < 3; ++i) {
      const int p = edge(bvh::box_least, bvh::box_most);
      const int q = one_in(6) ? p : edge(bvh::box_least, bvh::box_most);
      v.least[i] = std::min(p, q);
      v.greatest[i] = std::max(p, q);
    }
    return v;
  }

  /// Corner of the box that is furthest along v, half steps.
  static Eigen::Vector3d corner_along(const bvh::ChildVolume& volume, const Eigen::Vector3d& v) {
    Eigen::Vector3d p;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      p[i] = 2 * (v[i] < 0 ? volume.least[k] : volume.greatest[k]);
    }
    return p;
  }

  static bool inside(const bvh::InnerLine& node, const Eigen::Vector3d& p) {
    const bvh::ChildVolume& volume = node.child[0];
    for (std::size_t d = 0; d < bvh::directions.size(); ++d) {
      const Eigen::Vector3d n(bvh::directions[d][0], bvh::directions[d][1], bvh::directions[d][2]);
      double upper = n.dot(corner_along(volume, n));
      double lower = n.dot(corner_along(volume, -n));
      if (d >= bvh::first_face) {
        const int unit = node.cut_exponent + (d >= bvh::first_corner ? 1 : 0);
        upper -= std::ldexp(volume.cut[d - bvh::first_face][0], unit);
        lower += std::ldexp(volume.cut[d - bvh::first_face][1], unit);
      }
      const double position = n.dot(p);
      if (position > upper || position < lower) return false;
    }
    return true;
  }

  /// Cuts off what lies beyond the plane of n, which is the direction `v` points in up to its magnitudes; returns the
  /// cut in half steps.
  double cut(bvh::InnerLine& node, const Eigen::Vector3d& n) {
    for (std::size_t d = bvh::first_face; d < bvh::directions.size(); ++d) {
      const Eigen::Vector3d e(bvh::directions[d][0], bvh::directions[d][1], bvh::directions[d][2]);
      if (e != n && e != -n) continue;
      const int amount = edge(0, 7);
      node.child[0].cut[d - bvh::first_face][e == n ? 0 : 1] = amount;
      return std::ldexp(amount, node.cut_exponent + (d >= bvh::first_corner ? 1 : 0));
    }
    return 0;
  }

  /// A volume and its furthest point along m: where its axis, face and corner planes meet.
  bool make_support(bvh::InnerLine& node, const Eigen::Vector3d& m, Eigen::Vector3d& p) {
    node.cut_exponent = static_cast<int>(whole(2, 3));
    node.child[0] = volume();
    std::array<int, 3> order = {0, 1, 2};
    std::sort(order.begin(), order.end(), [&m](int i, int j) { return std::abs(m[i]) > std::abs(m[j]); });
    Eigen::Vector3d n = Eigen::Vector3d::Zero();
    const auto sign = [&](int k) { return m[order[static_cast<std::size_t>(k)]] < 0 ? -1.0 : 1.0; };
    n[order[0]] = sign(0);
    n[order[1]] = sign(1);
    const double face = cut(node, n);
    n[order[2]] = sign(2);
    const double corner = cut(node, n);
    p = corner_along(node.child[0], m);
    p[order[1]] -= sign(1) * face;
    p[order[2]] -= sign(2) * (corner - face);
    return inside(node, p);
  }

  /// A volume and a point on its lower plane of direction d (as an outward normal n).
  bool make_facing(bvh::InnerLine& node, const Eigen::Vector3d& n, Eigen::Vector3d& p) {
    node.cut_exponent = static_cast<int>(whole(2, 3));
    node.child[0] = volume();
    const double amount = cut(node, n);
    p = corner_along(node.child[0], n);
    int axis = static_cast<int>(whole(0, 2));
    while (n[axis] == 0) axis = (axis + 1) % 3;
    p[axis] -= n[axis] * amount;
    for (int i = 0; i < 3; ++i) {  // anywhere along an axis parallel to the plane
      const auto k = static_cast<std::size_t>(i);
      if (n[i] == 0) p[i] = 2 * static_cast<double>(whole(node.child[0].least[k], node.child[0].greatest[k]));
    }
    return inside(node, p);
  }

  /// Puts the node's origin somewhere so that the point, half steps from it, is in the unit; then the point in the
  /// unit.
  bool put(bvh::InnerLine& node, Eigen::Vector3d& p) {
    for (int i = 0; i < 3; ++i) {
      const double offset = std::ldexp(p[i], node.step - 25);
      const double least = std::ceil(std::ldexp(std::max(-0.5, -0.5 - offset), 18));
      const double most = std::floor(std::ldexp(std::min(0.5 - 0x1p-18, 0.5 - offset), 18));
      if (least > most) return false;
      const bool edge = one_in(2);  // |u| = 1/2 makes the most of the error of M
      const std::int64_t origin = edge ? static_cast<std::int64_t>(one_in(2) ? least : most)
                                       : whole(static_cast<std::int64_t>(least), static_cast<std::int64_t>(most));
      node.origin[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(origin);
      p[i] = std::ldexp(static_cast<double>(origin), -18) + offset;
    }
    return true;
  }

  bool attempt(Touch& touch) {
    Eigen::Matrix3d m = map();
    Query& query = touch.query;
    query.shift = one_in(2) ? 0 : edge(0, query_shift_max);
    touch.a.step = edge(0, bvh::step_max);
    const int level = touch.a.step - query.shift;  // in B's step: mostly near A's
    touch.b.step =
        static_cast<int>(std::clamp<std::int64_t>(level + (one_in(4) ? whole(-12, 12) : whole(-6, 6)), 0, 18));
    const auto& d = bvh::directions[static_cast<std::size_t>(whole(0, 12))];
    const Eigen::Vector3d n = (one_in(2) ? 1.0 : -1.0) * Eigen::Vector3d(d[0], d[1], d[2]);
    Eigen::Vector3d p_a;
    Eigen::Vector3d p_b;
    if (!make_support(touch.a, m.transpose() * n, p_a) || !make_facing(touch.b, -n, p_b)) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      touch.point_a[k] = static_cast<std::int64_t>(p_a[static_cast<Eigen::Index>(k)]);
      touch.point_b[k] = static_cast<std::int64_t>(p_b[static_cast<Eigen::Index>(k)]);
    }
    if (!put(touch.a, p_a) || !put(touch.b, p_b)) return false;
    if (!one_in(4)) set_off(m, n, p_a);
    if (!allowed(m)) return false;
    const Eigen::Vector3d t = p_b - std::ldexp(1.0, -query.shift) * (m * p_a);
    double error = 0x1p-50;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      double row = 0;
      for (int j = 0; j < 3; ++j) {
        const double entry = std::nearbyint(m(i, j) * 0x1p30);
        query.m[k][static_cast<std::size_t>(j)] = static_cast<std::int32_t>(entry);
        row += std::abs(m(i, j) - entry * 0x1p-30);
      }
      // as wrong as the bound allows, away from B
      const double wrong = one_in(2) ? 0 : -n[i] * 0x1p-27;
      const double entry = std::nearbyint((t[i] + wrong) * 0x1p32);
      if (std::abs(entry) >= 0x1p35) return false;
      query.t[k] = static_cast<std::int64_t>(entry);
      error = std::max(error, std::ldexp(row, -query.shift - 1) + std::abs(t[i] - entry * 0x1p-32) + 0x1p-50);
    }
    const double bound = std::ceil(error * 0x1p38);
    query.error = static_cast<std::uint32_t>(std::min(bound, 4096.0));
    return query.error < 4096;
  }

  std::mt19937_64 random_;
};

/// The children of the nodes certainly have a point in common under some map that the query allows: the witness's two
/// points lie in their volumes, boxes less cuts, and the query takes one to the other but for its error. Whole numbers
/// throughout: half steps for the volumes, 2^-70 for the map.
inline bool share_the_point(const Touch& touch) {
  const auto holds = [](const bvh::InnerLine& node, const std::array<std::int64_t, 3>& point) {
    const bvh::ChildVolume& volume = node.child[0];
    for (std::size_t d = 0; d < bvh::directions.size(); ++d) {
      std::int64_t at = 0, upper = 0, lower = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int64_t sign = bvh::directions[d][i];
        at += sign * point[i];
        upper += 2 * sign * (sign > 0 ? volume.greatest[i] : volume.least[i]);
        lower += 2 * sign * (sign > 0 ? volume.least[i] : volume.greatest[i]);
      }
      if (d >= bvh::first_face) {
        const std::int64_t unit = std::int64_t{1} << (node.cut_exponent + (d >= bvh::first_corner ? 1 : 0));
        upper -= unit * volume.cut[d - bvh::first_face][0];
        lower += unit * volume.cut[d - bvh::first_face][1];
      }
      if (at > upper || at < lower) return false;
    }
    return true;
  };
  if (!holds(touch.a, touch.point_a) || !holds(touch.b, touch.point_b)) return false;
  __extension__ using Wide = __int128;
  const auto position = [](const bvh::InnerLine& node, const std::array<std::int64_t, 3>& point, std::size_t i) {
    return (Wide{node.origin[i]} << 7) + (Wide{point[i]} << node.step);  // 2^-25
  };
  for (std::size_t i = 0; i < 3; ++i) {
    Wide moved = Wide{touch.query.t[i]} << (70 - query_t_fraction);
    for (std::size_t j = 0; j < 3; ++j) {
      moved += (touch.query.m[i][j] * position(touch.a, touch.point_a, j))
               << (70 - query_m_fraction - 25 - touch.query.shift);
    }
    const Wide off = moved - (position(touch.b, touch.point_b, i) << (70 - 25));
    const Wide most = Wide{touch.query.error} << (70 - query_error_fraction);
    if (off > most || -off > most) return false;
  }
  return true;
}

}  // namespace cchip::stimulus

#endif
