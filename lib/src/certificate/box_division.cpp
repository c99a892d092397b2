// SPDX-License-Identifier: Apache-2.0
#include "box_division.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace cchip {
namespace {

/// A direction of integers near the given one, without common factors; 0 if that is not finite or 0.
Vec3d whole_direction(const Vec3d& direction, double greatest) {
  const double size = direction.cwiseAbs().maxCoeff();
  if (!(size > 0) || !std::isfinite(size)) return Vec3d::Zero();
  const Vec3d rounded = (direction * (greatest / size)).array().round();
  std::int64_t divisor = 0;
  for (const double x : rounded) divisor = std::gcd(divisor, static_cast<std::int64_t>(x));
  return rounded / static_cast<double>(divisor);
}

std::vector<Digits> digits(const Vec3d& direction, double sign) {
  std::vector<Digits> result;
  for (const double x : direction) result.push_back(std::to_string(static_cast<std::int64_t>(sign * x)));
  return result;
}

/// The greatest exponent of a power of two not above any of the numbers' sizes; none of 0.
template <class Numbers>
std::optional<int> exponent_of(const Numbers& numbers) {
  const double greatest = numbers.cwiseAbs().maxCoeff();
  if (greatest == 0) return std::nullopt;
  return std::ilogb(greatest);
}

}  // namespace

BoxDivision::BoxDivision(const std::array<const CertificateTree*, 2>& trees, const std::array<const Pose*, 2>& poses,
                         double within, const std::optional<Vec3d>& along)
    : trees_(trees), within_(within) {
  int exponent = within > 0 ? std::ilogb(within) : std::numeric_limits<int>::min();
  std::array<Vec3d, 2> greatest;  // coordinates of the mesh
  for (const std::size_t side : {0U, 1U}) {
    const CertificateTree::Box box = box_of(side, trees[side]->all());
    greatest[side] = box.low.cwiseAbs().cwiseMax(box.high.cwiseAbs());
    linear_[side] = poses[side]->linear();
    shift_[side] = poses[side]->translation();
    const auto of_linear = exponent_of(linear_[side]), of_mesh = exponent_of(greatest[side]);
    if (of_linear && of_mesh) exponent = std::max(exponent, *of_linear + *of_mesh);
    if (const auto of_shift = exponent_of(shift_[side])) exponent = std::max(exponent, *of_shift);
  }
  if (exponent == std::numeric_limits<int>::min()) exponent = 0;
  const auto scale = [exponent](double& x) { x = std::ldexp(x, -exponent); };
  scale(within_);
  for (const std::size_t side : {0U, 1U}) {
    for (double& x : linear_[side].reshaped()) scale(x);
    for (double& x : shift_[side]) scale(x);
    scale_ += (linear_[side].cwiseAbs() * greatest[side] + shift_[side].cwiseAbs()).maxCoeff();
  }
  if (along) along_ = certificate_check::whole_point(*along);
  make_directions();
}

int BoxDivision::rise(const Vec3d& direction) const {
  certificate_check::Point d;
  for (std::size_t i = 0; i < 3; ++i) d[i] = static_cast<std::int64_t>(direction[static_cast<Eigen::Index>(i)]);
  return certificate_check::dot(d, *along_).sign();
}

void BoxDivision::make_directions() {
  std::array<std::array<Vec3d, 3>, 2> edges, normals;
  for (const std::size_t side : {0U, 1U}) {
    for (Eigen::Index i = 0; i < 3; ++i)
      edges[side][static_cast<std::size_t>(i)] = linear_[side].col(i).stableNormalized();
    for (std::size_t i = 0; i < 3; ++i) normals[side][i] = edges[side][(i + 1) % 3].cross(edges[side][(i + 2) % 3]);
  }
  std::vector<Vec3d> wanted(normals[0].begin(), normals[0].end());
  wanted.insert(wanted.end(), normals[1].begin(), normals[1].end());
  for (const Vec3d& p : edges[0]) {
    for (const Vec3d& q : edges[1]) wanted.push_back(p.cross(q));
  }
  for (std::size_t k = 0; k < count; ++k) {
    Vec3d d = Vec3d::Zero();
    if (k < wanted.size() && wanted[k].norm() > 0x1p-20) d = whole_direction(wanted[k], 1023);
    if (d.isZero(0)) d = Vec3d::Unit(static_cast<Eigen::Index>(k % 3));
    direction_[k] = d;
    const auto lane = static_cast<Eigen::Index>(k);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      components_[i][lane] = d[axis];
      for (const std::size_t side : {0U, 1U}) reach_[side][i][lane] = std::abs(d.dot(linear_[side].col(axis)));
    }
    lengths_[lane] = d.norm();
    margins_[lane] = margin(d);
    least_[lane] = (1 + 0x1p-40) * within_ * d.norm();
    for (const std::size_t opposite : {0U, 1U}) {
      const double sign = opposite == 0 ? 1 : -1;
      text_[k][opposite] = digits(d, sign);
      may_rise_[k][opposite] = !along_ || rise(sign * d) >= 0;
    }
  }
}

CertificateTree::Box BoxDivision::box_of(std::size_t side, const CertificateTree::Set& set) const {
  return set.size() > CertificateTree::most_faces_without_box ? trees_[side]->box(set)
                                                              : trees_[side]->box_of_vertices(set);
}

BoxDivision::Node BoxDivision::node(std::size_t side, const CertificateTree::Set& set) const {
  Node n;
  n.set = set;
  const CertificateTree::Box box = box_of(side, set);
  n.half = 0.5 * box.high - 0.5 * box.low;
  n.centre = linear_[side] * (0.5 * box.high + 0.5 * box.low) + shift_[side];
  n.size = (linear_[side].cwiseAbs() * n.half).sum();
  return n;
}

certificate_check::Faces BoxDivision::faces(std::size_t side, const Node& n) const {
  return {trees_[side]->order().data(), n.set, trees_[side]};
}

BoxDivision::Proposal BoxDivision::part_boxes(const Node& a, const Node& b) const {
  const Vec3d way = b.centre - a.centre;
  const Lanes value = components_[0] * way[0] + components_[1] * way[1] + components_[2] * way[2];
  Lanes gap = value.abs() - least_;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    gap -= reach_[0][i] * a.half[axis] + reach_[1][i] * b.half[axis];
  }
  Eigen::Index best = 0;
  if (!along_) {
    (gap / lengths_).maxCoeff(&best);
  } else {
    double greatest = -std::numeric_limits<double>::infinity();
    for (Eigen::Index k = 0; k < count; ++k) {
      if (!may_rise_[static_cast<std::size_t>(k)][value[k] < 0 ? 1 : 0] || gap[k] <= greatest * lengths_[k]) continue;
      greatest = gap[k] / lengths_[k];
      best = k;
    }
  }
  const std::size_t opposite = value[best] < 0 ? 1 : 0;
  const auto number = static_cast<std::size_t>(best);
  // Boxes that only touch are parted where the translation takes one away.
  if (!(gap[best] > (along_ ? -margins_[best] : 0)) || !may_rise_[number][opposite]) return {};
  return {text_[number][opposite], gap[best] > margins_[best]};
}

const BoxDivision::Hull& BoxDivision::hull(std::size_t side, const Node& n) const {
  Hull& result = n.hull;
  if (!result.empty()) return result;
  const Mesh& mesh = trees_[side]->mesh();
  const auto on_faces = [&](const CertificateTree::Set& set) {
    for (std::size_t i = set.begin; i < set.end; ++i) {
      const Mesh::Face& face = mesh.faces[trees_[side]->order()[i]];
      for (std::size_t k = 0; k < static_cast<std::size_t>(face.kind); ++k) {
        result.push_back({mesh.vertices[face.vertex[k]], Vec3d::Zero()});
      }
    }
  };
  const auto on_box = [&](const CertificateTree::Box& box) {
    result.push_back({0.5 * box.high + 0.5 * box.low, 0.5 * box.high - 0.5 * box.low});
  };
  trees_[side]->for_hull(n.set, on_faces, on_box);
  return result;
}

Vec3d BoxDivision::extreme(std::size_t side, const Hull& hull, const Vec3d& direction) const {
  const Vec3d turned = linear_[side].transpose() * direction;
  const std::array<Vec3d, 2>* best = nullptr;
  double greatest = -std::numeric_limits<double>::infinity();
  for (const std::array<Vec3d, 2>& box : hull) {
    const double value = turned.dot(box[0]) + turned.cwiseAbs().dot(box[1]);
    if (value > greatest || best == nullptr) {
      greatest = value;
      best = &box;
    }
  }
  const Vec3d way = (turned.array() < 0).select(-(*best)[1], (*best)[1]);
  return linear_[side] * ((*best)[0] + way) + shift_[side];
}

void BoxDivision::part_along(const Vec3d& direction, const Hull& a, const Hull& b, std::vector<Proposal>& found) const {
  if (direction.isZero(0)) return;
  const double least = (1 + 0x1p-40) * within_ * direction.norm();
  for (const double sign : {1.0, -1.0}) {
    const Vec3d d = sign * direction;
    const double gap = d.dot(extreme(1, b, -d) - extreme(0, a, d)) - least;
    if (!(gap > (along_ ? -margin(d) : 0))) continue;
    if (along_ && rise(d) < 0) continue;
    found.push_back({digits(direction, sign), gap > margin(d)});
  }
}

std::vector<BoxDivision::Proposal> BoxDivision::part_hulls(const Node& a, const Node& b) const {
  const Hull &hull_a = hull(0, a), &hull_b = hull(1, b);
  std::vector<Proposal> found;
  const auto add = [&](const Vec3d& direction) {
    part_along(direction, hull_a, hull_b, found);
    return !found.empty() && found.back().is_certain;
  };
  // E. G. Gilbert, "An iterative procedure for computing the minimum of a quadratic form on a convex set", 1966: the
  // way from A to B becomes the shortest one.
  Vec3d way = b.centre - a.centre;
  for (int step = 0; step < 10 && !along_; ++step) {
    const Vec3d first = extreme(0, hull_a, way), last = extreme(1, hull_b, -way);
    const Vec3d next = last - first;
    if (way.dot(next) > (1 + 0x1p-40) * within_ * way.norm()) {
      for (const double greatest : {15.0, 255.0, 4095.0, 0x1p20}) {
        if (add(whole_direction(way, greatest))) return found;
      }
    }
    const Vec3d turn = way - next;
    const double share = way.dot(turn) / turn.squaredNorm();
    if (!(share > 0x1p-10)) break;  // it is the shortest, about
    way -= std::min(share, 1.0) * turn;
  }
  if (along_) {
    for (const Vec3d& direction : direction_) {
      if (add(direction)) return found;
    }
  }
  if (a.set.size() > 1 || b.set.size() > 1) return found;
  // The axes of the separating axis test, rounded.
  constexpr double greatest = 0x1p20;
  std::array<std::vector<Vec3d>, 2> edges;
  for (const std::size_t side : {0U, 1U}) {
    const Hull& p = side == 0 ? hull_a : hull_b;
    for (std::size_t k = 0; k < p.size(); ++k) {
      edges[side].push_back(linear_[side] * (p[(k + 1) % p.size()][0] - p[k][0]));
    }
    if (add(whole_direction(edges[side][0].cross(edges[side][1]), greatest))) return found;
  }
  for (const Vec3d& p : edges[0]) {
    for (const Vec3d& q : edges[1]) {
      if (add(whole_direction(p.cross(q), greatest))) return found;
    }
  }
  return found;
}

std::vector<std::uint32_t> certificate_order(const Mesh& mesh) {
  std::vector<std::uint32_t> order(mesh.faces.size());
  std::iota(order.begin(), order.end(), 0U);
  std::vector<Vec3d> middle;
  middle.reserve(mesh.faces.size());
  for (const Mesh::Face& face : mesh.faces) {
    const auto corners = static_cast<std::size_t>(face.kind);
    Vec3d sum = Vec3d::Zero();
    for (std::size_t k = 0; k < corners; ++k) sum += mesh.vertices[face.vertex[k]] / static_cast<double>(corners);
    middle.push_back(sum);
  }
  std::vector<CertificateTree::Set> open = {{0, order.size()}};
  while (!open.empty()) {
    const CertificateTree::Set set = open.back();
    open.pop_back();
    if (set.size() < 2) continue;
    const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    Vec3d low = middle[*at(set.begin)], high = low;
    std::for_each(at(set.begin), at(set.end), [&](std::uint32_t face) {
      low = low.cwiseMin(middle[face]);
      high = high.cwiseMax(middle[face]);
    });
    Eigen::Index axis = 0;
    (high / 2 - low / 2).maxCoeff(&axis);
    std::nth_element(at(set.begin), at(set.middle()), at(set.end), [&](std::uint32_t x, std::uint32_t y) {
      return middle[x][axis] < middle[y][axis] || (middle[x][axis] == middle[y][axis] && x < y);
    });
    open.push_back(set.first_half());
    open.push_back(set.second_half());
  }
  return order;
}

}  // namespace cchip
