// SPDX-License-Identifier: Apache-2.0
#include "solid_side.hpp"

#include <algorithm>
#include <cchip/internal/judge/near_parts.hpp>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace cchip {
namespace {

using exact::BigInt;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Lower and upper bound of x / w * 2^exponent.
std::pair<double, double> range_of(const BigInt& x, const BigInt& w, int exponent) {
  if (x.is_zero()) return {0, 0};
  const BigInt size = abs(x);
  const int shift = 64 + static_cast<int>(msb(w)) - static_cast<int>(msb(size));  // the quotient has 64 or 65 bits
  const BigInt quotient = shift >= 0 ? BigInt((size << shift) / w) : BigInt(size / (w << -shift));
  const double value = std::ldexp(quotient.convert_to<double>(), exponent - shift);
  const double low = value * (1 - 0x1p-50) - 0x1p-1070;
  const double high = value * (1 + 0x1p-50) + 0x1p-1070;
  return x.sign() > 0 ? std::pair<double, double>(low, high) : std::pair<double, double>(-high, -low);
}

BigInt dot(const SolidSide::Vector& p, const SolidSide::Vector& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

}  // namespace

SolidSide::SolidSide(const Object& object, const Pose& pose) : object_(object), pose_(pose) {
  const bvh::SupportTree& tree = object.tree();
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const Vec3d m = pose.linear().row(row).transpose();
    reach_[k] = LineReach(m, tree.unit());
    centre_[k] = m.dot(tree.centre()) + pose(row, 3);
    // As in FrameGap::slack().
    const double size =
        m.cwiseAbs().sum() * (tree.centre().cwiseAbs().maxCoeff() + 2 * bvh::support_most * tree.unit()) +
        std::abs(pose(row, 3));
    slack_[k] = size < 0x1p1000 ? 0x1p-46 * size + 0x1p-1000 : infinity;
  }
  whole_ = box_of(tree.lines()[tree.size()]);
}

std::array<std::uint32_t, 3> SolidSide::vertices(Triangle t) const {
  const auto& v = object_.mesh().faces[face(t)].vertex;
  return t % 2 == 0 ? std::array<std::uint32_t, 3>{v[0], v[1], v[2]} : std::array<std::uint32_t, 3>{v[0], v[2], v[3]};
}

Primitive SolidSide::primitive(Triangle t) const {
  Primitive p;
  const std::array<std::uint32_t, 3> v = vertices(t);
  for (std::size_t i = 0; i < 3; ++i) p.v[i] = object_.mesh().vertices[v[i]];
  return p;
}

int SolidSide::exponent() const {
  int linear = std::numeric_limits<int>::max();
  int all = linear;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      if (pose_(row, column) == 0) continue;
      int& least = column < 3 ? linear : all;
      least = std::min(least, exact::odd(exact::Scaled(pose_(row, column))).exponent);
    }
  }
  return linear == std::numeric_limits<int>::max() ? all : std::min(all, linear + shells().exponent);
}

const SolidSide::Placed& SolidSide::placed(Triangle t) {
  const auto [at, is_new] = placed_.try_emplace(t);
  Placed& result = at->second;
  if (!is_new) return result;
  exact::for_each_product(
      primitive(t), pose_, [&](std::size_t i, std::size_t k, const exact::Scaled& x, const exact::Scaled& y) {
        // Odd mantissas: small numbers for models in whole units.
        const exact::Scaled p = exact::odd(x);
        const exact::Scaled q = exact::odd(y);
        result.corner[i][k] += (BigInt(p.mantissa) * q.mantissa) << (p.exponent + q.exponent - exponent_);
      });
  using exact::operator-;
  result.normal = exact::cross(result.corner[1] - result.corner[0], result.corner[2] - result.corner[0]);
  return result;
}

SolidSide::Box SolidSide::box_of(const bvh::SupportLine& line) const {
  Box box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] = centre_[k] - reach_[k].against(line) - slack_[k];
    box.high[k] = centre_[k] + reach_[k].along(line) + slack_[k];
    if (slack_[k] == infinity) {  // whatever the rest is
      box.low[k] = -infinity;
      box.high[k] = infinity;
    }
  }
  return box;
}

AxisBox<3> SolidSide::box_of(const SolidPoint& p) const {
  Box box;
  for (std::size_t k = 0; k < 3; ++k) std::tie(box.low[k], box.high[k]) = range_of(p.x[k], p.w, exponent_);
  return box;
}

bool SolidSide::is_passed(Triangle t, const SolidSample& sample) {
  const std::size_t u = (sample.axis + 1) % 3;
  const std::size_t v = (sample.axis + 2) % 3;
  const std::array<Vector, 3>& corner = corners(t);
  int seen = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector& from = corner[i];
    const Vector& to = corner[(i + 1) % 3];
    const BigInt along_u = to[u] - from[u];
    const BigInt along_v = to[v] - from[v];
    int s =
        BigInt(along_u * (sample.at.x[v] - from[v] * sample.at.w) - along_v * (sample.at.x[u] - from[u] * sample.at.w))
            .sign();
    if (s == 0) s = BigInt(along_u * sample.w[v] - along_v * sample.w[u]).sign();
    if (s == 0) s = BigInt(along_u * sample.t[v] - along_v * sample.t[u]).sign();
    if (s == 0 || s == -seen) return false;
    seen = s;
  }
  return true;
}

void SolidSide::pass(bvh::NodeRef node, const Box& column, const SolidSample& sample, PassedTriangles& passed) {
  const bvh::SupportTree& tree = object_.tree();
  for (std::uint32_t i = node.first(); i < node.first() + node.count(); ++i) {
    if (!node.is_leaf()) {
      const bvh::SupportLine& line = tree.lines()[i];
      if (box_of(line).overlaps(column)) pass(line.ref(), column, sample, passed);
      continue;
    }
    const std::uint32_t face = tree.faces()[i];
    if (!world_box(pose_, object_.mesh(), face).overlaps(column)) continue;
    for_each_triangle(face, [&](Triangle t) {
      if (!is_passed(t, sample)) return;
      const Vector& n = normal(t);
      int s = BigInt(dot(n, sample.at.x) - dot(n, corners(t)[0]) * sample.at.w).sign();
      if (s == 0) s = dot(n, sample.w).sign();
      if (s == 0) s = dot(n, sample.t).sign();
      const int turn = n[sample.axis].sign();
      s *= turn;
      PassedTriangles::Count& count = s == 0 ? passed.here : s > 0 ? passed.below : passed.above;
      ++count.all;
      count.net += turn;
    });
  }
}

PassedTriangles SolidSide::passed(const SolidSample& sample) {
  Box column = box_of(sample.at);
  column.low[sample.axis] = -infinity;
  column.high[sample.axis] = infinity;
  PassedTriangles passed;
  pass(object_.tree().root(), column, sample, passed);
  return passed;
}

}  // namespace cchip
