// SPDX-License-Identifier: Apache-2.0
// Plain separating axis test. Why the axis set is complete: two convex sets are disjoint if and only
// if the origin is outside their Minkowski difference D, a polytope whose edges are parallel to edges
// of A or B. According to the dimension of D, the origin is separated from it by
//   3: the normal of a facet: a face normal of A or of B, or e_k x f_l;
//   2: the normal of its plane (one of the same), or, within the plane, a vector orthogonal to one of
//      its edges e: e x u_d does, if the unit vector u_d is not parallel to the plane;
//   1: a vector orthogonal to the line (the e x u_d span these), or along it: some u_d;
//   0: some u_d.
#include <Eigen/Geometry>
#include <cchip/internal/reference/eigen_sat.hpp>
#include <cchip/internal/wire/definitions.hpp>
#include <limits>
#include <stdexcept>

namespace cchip {
namespace {

constexpr int double_coord_w_max = 17;
static_assert(std::numeric_limits<double>::digits >= defs::proj_abs_w(double_coord_w_max), "double is not exact");
static_assert(std::numeric_limits<long double>::digits >= defs::proj_abs_w(defs::coord_w_max),
              "long double is not exact: this machine cannot run the reference for the widest coordinates");

/// Up to N vectors as columns.
template <class Real, int N>
using Columns = Eigen::Matrix<Real, 3, Eigen::Dynamic, 0, 3, N>;

template <class Real>
Columns<Real, 4> vertices(const GridPrimitive& p) {
  Columns<Real, 4> result(3, p.vertex_count());
  for (std::size_t i = 0; i < p.vertex_count(); ++i) result.col(Eigen::Index(i)) = p.v[i].cast<Real>();
  return result;
}

/// Differences of every two vertices: 3 of a triangle, 6 of a quad (sides and diagonals).
template <class Real>
Columns<Real, 6> edges(const Columns<Real, 4>& v) {
  Columns<Real, 6> result(3, v.cols() * (v.cols() - 1) / 2);
  Eigen::Index n = 0;
  for (Eigen::Index i = 0; i < v.cols(); ++i) {
    for (Eigen::Index j = i + 1; j < v.cols(); ++j) result.col(n++) = v.col(j) - v.col(i);
  }
  return result;
}

/// The complete axis set: at most 4 + 4 face normals, 6 x 6 + 2 x 6 x 3 cross products, 3 unit vectors.
template <class Real>
class Axes {
 public:
  Axes(const Columns<Real, 4>& a, const Columns<Real, 4>& b) {
    const Columns<Real, 6> e = edges<Real>(a);
    const Columns<Real, 6> f = edges<Real>(b);
    const Columns<Real, 6> u = Eigen::Matrix<Real, 3, 3>::Identity();
    add_face_normals(a);
    add_face_normals(b);
    add_cross_products(e, f);
    add_cross_products(e, u);
    add_cross_products(f, u);
    for (Eigen::Index d = 0; d < 3; ++d) add(u.col(d));
  }

  /// Dot products, one row for each axis, one column for each point.
  auto project(const Columns<Real, 4>& points) const {
    return axes_.leftCols(count_).transpose().lazyProduct(points).eval();
  }

 private:
  static constexpr int max_axes = 4 + 4 + 6 * 6 + 2 * 6 * 3 + 3;

  void add(const Eigen::Matrix<Real, 3, 1>& axis) { axes_.col(count_++) = axis; }
  /// One triangle, or the four triangles of a quad's vertices.
  void add_face_normals(const Columns<Real, 4>& v) {
    for (Eigen::Index i = 0; i < v.cols(); ++i) {
      for (Eigen::Index j = i + 1; j < v.cols(); ++j) {
        for (Eigen::Index k = j + 1; k < v.cols(); ++k) add((v.col(j) - v.col(i)).cross(v.col(k) - v.col(i)));
      }
    }
  }
  void add_cross_products(const Columns<Real, 6>& e, const Columns<Real, 6>& f) {
    for (Eigen::Index k = 0; k < e.cols(); ++k) {
      for (Eigen::Index l = 0; l < f.cols(); ++l) add(e.col(k).cross(f.col(l)));
    }
  }

  Eigen::Matrix<Real, 3, max_axes> axes_;
  Eigen::Index count_ = 0;
};

template <class Real>
bool intersects(const GridPair& pair) {
  const Columns<Real, 4> a = vertices<Real>(pair.a);
  const Columns<Real, 4> b = vertices<Real>(pair.b);
  const Axes<Real> axes(a, b);
  const auto on_a = axes.project(a);
  const auto on_b = axes.project(b);
  const bool a_below_b = (on_a.rowwise().maxCoeff().array() < on_b.rowwise().minCoeff().array()).any();
  const bool b_below_a = (on_b.rowwise().maxCoeff().array() < on_a.rowwise().minCoeff().array()).any();
  return !a_below_b && !b_below_a;
}

}  // namespace

bool eigen_intersects(const GridPair& pair, int coord_w) {
  if (coord_w < defs::coord_w_min || coord_w > defs::coord_w_max) {
    throw std::invalid_argument("Eigen reference: coord_w " + std::to_string(coord_w) + " is not in 4..20");
  }
  return coord_w <= double_coord_w_max ? intersects<double>(pair) : intersects<long double>(pair);
}

}  // namespace cchip
