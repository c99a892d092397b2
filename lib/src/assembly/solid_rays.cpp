// SPDX-License-Identifier: Apache-2.0
#include "solid_rays.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>

namespace cchip::assembly {
namespace {

using certificate_check::Int;
using certificate_check::Point;

/// Directions of rays; the second component is above 0. Some, for a ray may meet an edge.
constexpr std::array<std::array<int, 3>, 8> rays = {{{1009, 757, 1327},
                                                     {-811, 1511, 643},
                                                     {29, 1, 17},
                                                     {-3, 7, -1999},
                                                     {4001, 5, -2},
                                                     {-613, 1201, -787},
                                                     {71, 9973, 113},
                                                     {-5087, 2011, 3}}};

Int determinant(const Point& u, const Point& v, const Point& w) {
  return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0]);
}

/// A ray from a point, and what it meets.
class Ray {
 public:
  Ray(const Point& from, const std::array<int, 3>& direction) : from_(from), direction_(direction) {}

  /// \returns false if it meets an edge or the triangle holds the point, so that nothing is known
  bool meet(const Point& a, const Point& b, const Point& c) {
    std::array<Point, 3> corner = {a, b, c};
    std::array<std::array<Int, 2>, 3> flat;  // along the ray all have the same place
    std::array<bool, 4> beyond = {true, true, true, true};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) corner[i][axis] -= from_[axis];
      flat[i] = {direction_[1] * corner[i][0] - direction_[0] * corner[i][1],
                 direction_[2] * corner[i][1] - direction_[1] * corner[i][2]};
      for (std::size_t k = 0; k < 2; ++k) {
        beyond[2 * k] = beyond[2 * k] && flat[i][k] > 0;
        beyond[2 * k + 1] = beyond[2 * k + 1] && flat[i][k] < 0;
      }
    }
    if (std::find(beyond.begin(), beyond.end(), true) != beyond.end()) return true;
    bool any_left = false;
    bool any_right = false;
    bool any_on = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t k = (i + 1) % 3;
      const Int turn = flat[i][0] * flat[k][1] - flat[i][1] * flat[k][0];
      any_left = any_left || turn > 0;
      any_right = any_right || turn < 0;
      any_on = any_on || turn == 0;
    }
    if (any_left && any_right) return true;  // its line passes by
    if (any_on) return false;
    const Int height = determinant(corner[0], corner[1], corner[2]);
    if (height == 0) return false;
    if ((height > 0) != any_left) return true;  // it is behind
    is_odd_ = !is_odd_;
    winding_ += any_left ? 1 : -1;
    return true;
  }
  PointSide side() const { return {true, is_odd_, winding_ != 0}; }

 private:
  const Point& from_;
  const std::array<int, 3>& direction_;
  bool is_odd_ = false;
  int winding_ = 0;
};

}  // namespace

PointSide side_of(const Point& at, const Mesh& mesh, const std::vector<Point>& points) {
  for (const std::array<int, 3>& direction : rays) {
    Ray ray(at, direction);
    const bool is_clear = std::all_of(mesh.faces.begin(), mesh.faces.end(), [&](const Mesh::Face& face) {
      const auto corner = [&](std::size_t i) -> const Point& { return points[face.vertex[i]]; };
      return ray.meet(corner(0), corner(1), corner(2)) &&
             (face.kind == Kind::tri || ray.meet(corner(0), corner(2), corner(3)));
    });
    if (is_clear) return ray.side();
  }
  return {};
}

std::vector<std::uint32_t> vertex_of_each_piece(const Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&parent](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::map<std::array<double, 3>, std::uint32_t> first;
  for (std::uint32_t v = 0; v < parent.size(); ++v) {
    const Vec3d& at = mesh.vertices[v];
    parent[v] = first.emplace(std::array<double, 3>{at[0], at[1], at[2]}, v).first->second;
  }
  for (const Mesh::Face& face : mesh.faces) {
    for (std::size_t i = 1; i < static_cast<std::size_t>(face.kind); ++i) {
      parent[root(face.vertex[i])] = root(face.vertex[0]);
    }
  }
  std::vector<std::uint32_t> found;
  std::vector<bool> seen(parent.size(), false);
  for (const Mesh::Face& face : mesh.faces) {
    const std::uint32_t piece = root(face.vertex[0]);
    if (!seen[piece]) found.push_back(face.vertex[0]);
    seen[piece] = true;
  }
  return found;
}

bool is_common_point(const Vec3d& point, const AssemblyPart& a, const AssemblyPart& b) {
  Mesh alone;
  alone.vertices = {point};
  alone.faces = {{Kind::tri, {0, 0, 0, 0}}};
  const Pose still = Pose::Identity();
  std::array<PointSide, 2> side;
  for (const std::size_t i : {0U, 1U}) {
    const AssemblyPart& part = i == 0 ? a : b;
    const auto points = certificate_check::posed_vertices({&alone, &part.object.mesh()}, {&still, &part.pose});
    side[i] = side_of(points[0][0], part.object.mesh(), points[1]);
    if (!side[i].is_known) return false;
  }
  return (side[0].is_odd && side[1].is_odd) || (side[0].winds && side[1].winds);
}

}  // namespace cchip::assembly
