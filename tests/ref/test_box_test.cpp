// SPDX-License-Identifier: Apache-2.0
// The box test never separates volumes that share a point. Cases are made so that two volumes touch in one point, at
// the very end of their intervals on one direction: then every rounding counts. CCHIP_BOX_CASES sets their number.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cchip/model/box_test.hpp>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>

using namespace cchip;
using namespace cchip::bvh;
using namespace cchip::model;

namespace {

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
}

struct Touch {
  InnerLine a;
  InnerLine b;
  Query query;
};

class Generator {
 public:
  explicit Generator(std::uint64_t seed) : random_(seed) {}

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
  double real(double least, double most) { return std::uniform_real_distribution<double>(least, most)(random_); }
  bool one_in(int n) { return whole(1, n) == 1; }

  Eigen::Matrix3d rotation() {
    return Eigen::Quaterniond(real(-1, 1), real(-1, 1), real(-1, 1), real(-1, 1)).normalized().toRotationMatrix();
  }

  /// Any kind of map that the descriptor can represent; entries of 30 fraction bits.
  Eigen::Matrix3d map() {
    Eigen::Matrix3d m = rotation();
    switch (whole(0, 5)) {
      case 0:  // signed permutation
      case 1: {
        m.setZero();
        const std::int64_t first = whole(0, 2);
        const std::int64_t flip = whole(1, 2);
        for (std::int64_t i = 0; i < 3; ++i) m(i, (first + flip * i) % 3) = one_in(2) ? 1 : -1;
        if (one_in(2)) {  // or nearly one, with near ties of |m|
          for (double& x : m.reshaped()) x += real(-0x1p-15, 0x1p-15);
        }
        break;
      }
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
    for (const auto& d : directions) {
      Eigen::Vector3d v = (m.transpose() * Eigen::Vector3d(d[0], d[1], d[2])).cwiseAbs();
      std::sort(v.begin(), v.end());
      if (v[2] >= 2 - 0x1p-8 || v[0] + v[1] > 2 + 0x1p-5) return false;
    }
    return true;
  }

  ChildVolume volume() {
    ChildVolume v;
    for (std::size_t i = 0; i < 3; ++i) {
      const bool greatest = one_in(3);
      const int p = greatest ? -64 : static_cast<int>(whole(-64, 63));
      const int q = greatest ? 63 : static_cast<int>(whole(-64, 63));
      v.least[i] = std::min(p, q);
      v.greatest[i] = std::max(p, q);
    }
    return v;
  }

  /// Corner of the box that is furthest along v, half steps.
  static Eigen::Vector3d corner_along(const ChildVolume& volume, const Eigen::Vector3d& v) {
    Eigen::Vector3d p;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      p[i] = 2 * (v[i] < 0 ? volume.least[k] : volume.greatest[k]);
    }
    return p;
  }

  static bool inside(const InnerLine& node, const Eigen::Vector3d& p) {
    const ChildVolume& volume = node.child[0];
    for (std::size_t d = 0; d < directions.size(); ++d) {
      const Eigen::Vector3d n(directions[d][0], directions[d][1], directions[d][2]);
      double upper = n.dot(corner_along(volume, n));
      double lower = n.dot(corner_along(volume, -n));
      if (d >= first_face) {
        const int unit = node.cut_exponent + (d >= first_corner ? 1 : 0);
        upper -= std::ldexp(volume.cut[d - first_face][0], unit);
        lower += std::ldexp(volume.cut[d - first_face][1], unit);
      }
      const double position = n.dot(p);
      if (position > upper || position < lower) return false;
    }
    return true;
  }

  /// Cuts off what lies beyond the plane of n, which is the direction `v` points in up to its magnitudes; returns the
  /// cut in half steps.
  double cut(InnerLine& node, const Eigen::Vector3d& n) {
    for (std::size_t d = first_face; d < directions.size(); ++d) {
      const Eigen::Vector3d e(directions[d][0], directions[d][1], directions[d][2]);
      if (e != n && e != -n) continue;
      const int amount = one_in(4) ? 0 : static_cast<int>(whole(1, 7));
      node.child[0].cut[d - first_face][e == n ? 0 : 1] = amount;
      return std::ldexp(amount, node.cut_exponent + (d >= first_corner ? 1 : 0));
    }
    return 0;
  }

  /// A volume and its furthest point along m: where its axis, face and corner planes meet.
  bool make_support(InnerLine& node, const Eigen::Vector3d& m, Eigen::Vector3d& p) {
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
  bool make_facing(InnerLine& node, const Eigen::Vector3d& n, Eigen::Vector3d& p) {
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
  bool put(InnerLine& node, Eigen::Vector3d& p) {
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
    query.shift = one_in(2) ? 0 : static_cast<int>(whole(0, 15));
    touch.a.step = static_cast<int>(whole(0, 18));
    const int level = touch.a.step - query.shift;  // in B's step: mostly near A's
    touch.b.step =
        static_cast<int>(std::clamp<std::int64_t>(level + (one_in(4) ? whole(-12, 12) : whole(-6, 6)), 0, 18));
    const auto& d = directions[static_cast<std::size_t>(whole(0, 12))];
    const Eigen::Vector3d n = (one_in(2) ? 1.0 : -1.0) * Eigen::Vector3d(d[0], d[1], d[2]);
    Eigen::Vector3d p_a;
    Eigen::Vector3d p_b;
    if (!make_support(touch.a, m.transpose() * n, p_a) || !make_facing(touch.b, -n, p_b)) return false;
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
    query.error = static_cast<std::uint32_t>(std::ceil(error * 0x1p38));
    return query.error < 4096;
  }

  std::mt19937_64 random_;
};

/// A rounding rule left out.
struct Mutation {
  std::string name;
  std::function<void(const Touch&, PoseSetup&)> pose;
  std::function<void(const Touch&, const PoseSetup&, NodeGrid&)> grid;
};

/// M^T d, 17 fraction bits, magnitudes.
std::array<std::int32_t, 3> magnitudes(const PoseSetup& pose, std::size_t direction) {
  std::array<std::int32_t, 3> m = {};
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) m[j] += directions[direction][i] * pose.m[i][j];
    m[j] = std::abs(m[j]);
  }
  return m;
}

std::vector<Mutation> mutations() {
  const auto each_direction = [](const auto& change) {
    return [change](const Touch&, PoseSetup& pose) {
      for (std::size_t d = 0; d < directions.size(); ++d) {
        std::array<std::int32_t, 3> m = magnitudes(pose, d);
        change(pose.direction[d], m);
      }
    };
  };
  using Magnitudes = std::array<std::int32_t, 3>;
  const auto slack = [](std::int64_t less) {
    return [less](const Touch&, const PoseSetup&, NodeGrid& grid) {
      grid.slack = std::max<std::int64_t>(0, grid.slack - less);
    };
  };
  const auto epsilon = [](std::int64_t dropped_38) {
    return [dropped_38](const Touch& touch, PoseSetup& pose) {
      const std::int64_t of_m = (std::int64_t{3} << 19) >> touch.query.shift;
      const std::int64_t whole = of_m + (1 << 13) + touch.query.error;
      const std::int64_t dropped = dropped_38 < 0 ? of_m : std::min(dropped_38, whole);
      pose.epsilon = static_cast<std::int32_t>((whole - dropped) >> 14);
    };
  };
  std::vector<Mutation> list;
  list.push_back({"|m| rounded down",
                  each_direction([](DirectionSetup& s, const Magnitudes& m) {
                    for (std::size_t j = 0; j < 3; ++j) s.magnitude[j] = m[j] >> 8;
                  }),
                  {}});
  list.push_back({"b - c rounded up",
                  each_direction([](DirectionSetup& s, Magnitudes m) {
                    std::sort(m.begin(), m.end());
                    s.face_factor = std::min(127, (m[1] - m[0] + 2047) >> 11);
                  }),
                  {}});
  list.push_back({"c rounded up",
                  each_direction([](DirectionSetup& s, Magnitudes m) {
                    std::sort(m.begin(), m.end());
                    s.corner_factor = std::min(127, (m[0] + 1023) >> 10);
                  }),
                  {}});
  list.push_back({"no bound on M", epsilon(-1), {}});
  list.push_back({"no bound on t and the query's error", epsilon(1 << 14), {}});
  list.push_back({"floors left out of the slack", {}, [](const Touch& touch, const PoseSetup& pose, NodeGrid& grid) {
                    const int g = touch.a.step - touch.query.shift + grid.x + 1;
                    const std::int64_t of_position = (1024 * std::int64_t{pose.epsilon}) >> (g + 6);
                    const std::int64_t with_floors =
                        (1024 * std::int64_t{pose.epsilon} + (std::int64_t{96} << g) - 1) >> (g + 6);
                    grid.slack -= with_floors - of_position;
                  }});
  list.push_back({"A as a point", {}, [slack](const Touch& t, const PoseSetup& p, NodeGrid& grid) {
                    if (grid.a_is_point) slack(std::int64_t{1} << std::max(0, 10 - grid.x))(t, p, grid);
                  }});
  list.push_back({"B as a point", {}, [slack](const Touch& t, const PoseSetup& p, NodeGrid& grid) {
                    if (grid.b_is_point) slack(std::int64_t{1} << std::max(0, 9 - grid.y))(t, p, grid);
                  }});
  list.push_back({"slack cut off at its width", {}, [](const Touch&, const PoseSetup&, NodeGrid& grid) {
                    if (grid.near) grid.slack = slack_max;
                    grid.near = false;
                  }});
  list.push_back({"offset of 16 bits", {}, [](const Touch&, const PoseSetup&, NodeGrid& grid) {
                    for (const std::int64_t w : grid.offset) grid.far = grid.far || w >= 1 << 15 || w < -(1 << 15);
                  }});
  return list;
}

bool separated(const Touch& touch, const Mutation* mutation) {
  PoseSetup pose = set_up(touch.query);
  if (mutation != nullptr && mutation->pose) mutation->pose(touch, pose);
  NodeGrid grid = grid_of(touch.a, touch.b, pose);
  if (mutation != nullptr && mutation->grid) mutation->grid(touch, pose, grid);
  return (test_boxes(touch.a, touch.b, pose, grid).overlap & 1U) == 0;
}

}  // namespace

TEST_CASE("box test: volumes that share a point are never separated", "[ref]") {
  const std::uint64_t seed = from_environment("CCHIP_SEED", 1);
  const std::uint64_t cases = from_environment("CCHIP_BOX_CASES", 200000);
  CAPTURE(seed);
  Generator generator(seed);
  std::uint64_t wrong = 0;
  std::uint64_t far_offsets = 0;
  std::array<std::uint64_t, 4> kinds = {};
  for (std::uint64_t n = 0; n < cases; ++n) {
    const Touch touch = generator.next();
    const NodeGrid grid = grid_of(touch.a, touch.b, set_up(touch.query));
    kinds[0] += grid.a_is_point ? 1 : 0;
    kinds[1] += grid.b_is_point ? 1 : 0;
    kinds[2] += grid.near ? 1 : 0;
    kinds[3] += grid.x == 0 && grid.y <= 1 ? 1 : 0;
    for (const std::int64_t w : grid.offset) far_offsets += std::abs(w) >= 1 << 14 ? 1 : 0;
    if (separated(touch, nullptr) && wrong++ == 0) {
      WARN("first at case " << n << ": steps " << touch.a.step << ", " << touch.b.step << ", shift "
                            << touch.query.shift << ", x " << grid.x << ", y " << grid.y);
    }
  }
  WARN("box_cases=" << cases << " violations=" << wrong << " a_point=" << kinds[0] << " b_point=" << kinds[1]
                    << " near=" << kinds[2] << " with_cuts=" << kinds[3] << " seed=" << seed);
  REQUIRE(wrong == 0);
  for (const std::uint64_t count : kinds) REQUIRE(count > cases / 100);
  REQUIRE(far_offsets > 0);
}

TEST_CASE("box test: each rounding rule is needed", "[ref]") {
  const std::uint64_t seed = from_environment("CCHIP_SEED", 1);
  CAPTURE(seed);
  for (const Mutation& mutation : mutations()) {
    Generator generator(seed);
    std::uint64_t cases = 0;
    while (cases < 2000000 && !separated(generator.next(), &mutation)) ++cases;
    INFO(mutation.name);
    CHECK(cases < 2000000);
    WARN("without \"" << mutation.name << "\": first violation at case " << cases);
  }
}
