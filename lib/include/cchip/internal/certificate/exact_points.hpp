// SPDX-License-Identifier: Apache-2.0
/// \file
/// What check.hpp computes with: the vertices of two meshes in their poses and the numbers of certificates, as
/// integers.
#ifndef CCHIP_INTERNAL_CERTIFICATE_EXACT_POINTS_HPP
#define CCHIP_INTERNAL_CERTIFICATE_EXACT_POINTS_HPP

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cchip/certificate_tree.hpp>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace cchip::certificate_check {

using Int = boost::multiprecision::cpp_int;
using Point = std::array<Int, 3>;

/// x / 2^exponent. \pre 2^exponent divides x
inline Int whole(double x, int exponent) {
  if (x == 0) return 0;
  int e = 0;
  const auto m = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &e), 53));
  const int shift = e - 53 - exponent;
  return shift >= 0 ? Int(m) << shift : Int(m / (std::int64_t{1} << -shift));
}

/// The point times a power of two. \throws std::invalid_argument it is not finite
inline Point whole_point(const Vec3d& p) {
  require(p.allFinite(), "a number of a mesh or a pose is not finite");
  PowerOfTwo unit;
  for (const double x : p) unit.add(x);
  return {whole(p[0], unit.exponent()), whole(p[1], unit.exponent()), whole(p[2], unit.exponent())};
}

inline Int dot(const Point& p, const Point& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

/// Two meshes in their poses, and a length: all in one unit, a power of two, in which they are integers.
class Placement {
 public:
  /// The value of a direction on points of a mesh in its pose.
  struct Functional {
    Point factors;  ///< of coordinates of the mesh
    Int constant;
    Int operator()(const Point& of_mesh) const { return dot(factors, of_mesh) + constant; }
  };

  /// Keeps references to the meshes.
  /// \throws std::invalid_argument a number of a pose is not finite
  Placement(const std::array<const CheckedMesh*, 2>& mesh, const std::array<const Pose*, 2>& pose, double length = 0)
      : mesh_(mesh) {
    PowerOfTwo entry, shift;
    for (const Pose* p : pose) {
      require(p->matrix().allFinite(), "a number of a mesh or a pose is not finite");
      for (const double x : p->linear().reshaped()) entry.add(x);
      for (const double x : p->translation()) shift.add(x);
    }
    shift.add(length);
    const auto of_products = [&](std::size_t side) { return mesh[side]->unit().exponent() + entry.exponent(); };
    const int unit = std::min({of_products(0), of_products(1), shift.exponent()});
    const auto in_unit = [&](double x) { return whole(x, shift.exponent()) << (shift.exponent() - unit); };
    length_ = in_unit(length);
    for (const std::size_t side : {0U, 1U}) {
      for (std::size_t row = 0; row < 3; ++row) {
        const auto at = [&](int column) { return (*pose[side])(static_cast<int>(row), column); };
        for (int i = 0; i < 3; ++i) {
          rows_[side][row][static_cast<std::size_t>(i)] = whole(at(i), entry.exponent()) << (of_products(side) - unit);
        }
        shifts_[side][row] = in_unit(at(3));
      }
    }
  }

  const Int& length() const { return length_; }
  /// Coordinates of the mesh, in its own unit.
  Point of_mesh(std::size_t side, const Vec3d& p) const {
    const int exponent = mesh_[side]->unit().exponent();
    return {whole(p[0], exponent), whole(p[1], exponent), whole(p[2], exponent)};
  }
  Point posed(std::size_t side, const Vec3d& p) const {
    const Point x = of_mesh(side, p);
    const std::array<Point, 3>& rows = rows_[side];
    const Point& shift = shifts_[side];
    return {dot(rows[0], x) + shift[0], dot(rows[1], x) + shift[1], dot(rows[2], x) + shift[2]};
  }
  Functional functional(std::size_t side, const Point& direction) const {
    Functional result;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t row = 0; row < 3; ++row) result.factors[i] += direction[row] * rows_[side][row][i];
    }
    result.constant = dot(direction, shifts_[side]);
    return result;
  }

 private:
  std::array<const CheckedMesh*, 2> mesh_;
  Int length_;
  std::array<std::array<Point, 3>, 2> rows_;
  std::array<Point, 2> shifts_;
};

/// The vertices of the faces of both meshes in their poses, all multiplied by the same power of two; exact.
inline std::array<std::vector<Point>, 2> posed_vertices(const Placement& placement,
                                                        const std::array<const Mesh*, 2>& mesh) {
  std::array<std::vector<Point>, 2> points;
  for (const std::size_t side : {0U, 1U}) {
    points[side].resize(mesh[side]->vertices.size());
    std::vector<bool> placed(points[side].size());
    for (const Mesh::Face& face : mesh[side]->faces) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(face.kind); ++k) {
        const std::uint32_t v = face.vertex[k];
        if (!placed[v]) points[side][v] = placement.posed(side, mesh[side]->vertices[v]);
        placed[v] = true;
      }
    }
  }
  return points;
}
inline std::array<std::vector<Point>, 2> posed_vertices(const std::array<const Mesh*, 2>& mesh,
                                                        const std::array<const Pose*, 2>& pose) {
  const CheckedMesh a(*mesh[0]), b(*mesh[1]);
  return posed_vertices(Placement({&a, &b}, pose), mesh);
}

/// Reads integers of a certificate.
inline std::vector<Int> integers(const std::vector<Digits>& texts, std::size_t count) {
  require(texts.size() == count, "wrong number of weights or components");
  std::vector<Int> result;
  for (const Digits& text : texts) {
    require(is_integer(text), "not an integer of at most 20000 digits");
    result.emplace_back(text);
  }
  return result;
}

/// Reads a direction.
inline Point direction_of(const std::vector<Digits>& texts) {
  const std::vector<Int> d = integers(texts, 3);
  require(d[0] != 0 || d[1] != 0 || d[2] != 0, "the direction is 0");
  return {d[0], d[1], d[2]};
}

}  // namespace cchip::certificate_check

#endif
