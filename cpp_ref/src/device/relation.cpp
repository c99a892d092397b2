// SPDX-License-Identifier: Apache-2.0
#include "relation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cchip {
namespace {

using Matrix = Eigen::Matrix3d;
constexpr double u = 0x1p-53;
constexpr double radius = bvh::support_most;

/// Not for NaN.
bool is_moderate(double size) { return size > 0x1p-200 && size < 0x1p200; }

/// Determinants of the 2 x 2 minors with their signs; over the determinant, the transposed inverse.
Matrix cofactors(const Matrix& l) {
  Matrix c;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Index i1 = (i + 1) % 3;
    const Eigen::Index i2 = (i + 2) % 3;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Eigen::Index k1 = (k + 1) % 3;
      const Eigen::Index k2 = (k + 2) % 3;
      c(i, k) = l(i1, k1) * l(i2, k2) - l(i1, k2) * l(i2, k1);
    }
  }
  return c;
}

/// Where an object's centre is, and how great the numbers are that were added up for it.
struct Centre {
  Vec3d at;
  Vec3d size;
};

Centre centre_of(const Object& object, const Pose& pose) {
  const Vec3d& c = object.tree().centre();
  return {pose.linear() * c + pose.translation(),
          pose.linear().cwiseAbs() * c.cwiseAbs() + pose.translation().cwiseAbs()};
}

}  // namespace

bool relate(const CollisionQuery& query, Relation& r) {
  const Object* moved = query.a;
  const Object* fixed = query.b;
  const Pose* pose_m = query.pose_a;
  const Pose* pose_f = query.pose_b;
  const double size_m = pose_m->linear().norm() * moved->tree().unit();
  const double size_f = pose_f->linear().norm() * fixed->tree().unit();
  r.swapped = size_m > size_f;
  if (r.swapped) {
    std::swap(moved, fixed);
    std::swap(pose_m, pose_f);
  }
  const double unit_m = moved->tree().unit();
  const double unit_f = fixed->tree().unit();
  const Matrix& lm = pose_m->linear();
  const Matrix& lf = pose_f->linear();
  if (!is_moderate(unit_f) || !is_moderate(lf.norm()) || !(unit_m < 0x1p200) || !(lm.norm() < 0x1p200)) return false;

  // w maps a direction of the fixed object to one of the world. off = lf^T w - 1 says how well.
  const Matrix cofactor = cofactors(lf);
  const double determinant = lf.row(0).dot(cofactor.row(0));
  const Matrix w = cofactor / determinant;
  const Matrix off = lf.transpose() * w - Matrix::Identity();
  const Matrix w_size = w.cwiseAbs();
  const double inverse_error = off.cwiseAbs().sum() + 8 * u * (lf.cwiseAbs().transpose() * w_size).sum();
  if (!(inverse_error <= 0x1p-20)) return false;  // NaN, too

  const double ratio = unit_m / unit_f;
  const Matrix m = (w.transpose() * lm) * ratio;
  const double m_error = 8 * u * (w_size.transpose() * lm.cwiseAbs()).sum() * ratio;
  const Centre centre_m = centre_of(*moved, *pose_m);
  const Centre centre_f = centre_of(*fixed, *pose_f);
  const Vec3d t = w.transpose() * (centre_m.at - centre_f.at) / unit_f;
  const double t_error = 16 * u * (w_size.transpose() * (centre_m.size + centre_f.size)).maxCoeff() / unit_f;

  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) r.m[static_cast<std::size_t>(3 * i + k)] = m(i, k);
    r.t[static_cast<std::size_t>(i)] = t[i];
  }
  r.norm = m.norm();
  r.row = m.rowwise().norm().maxCoeff();
  r.distance = t.norm();
  r.plane_error = radius * (inverse_error + m_error) + 3 * t_error;
  r.vertex_error = radius * m_error + t_error + 2 * inverse_error * (radius * r.norm + r.distance);
  // What may underflow is far below a unit: products of these numbers are above 2^-800.
  r.plane_error += 0x1p-100;
  r.vertex_error += 0x1p-100;
  return r.norm < 0x1p60 && r.distance < 0x1p60 && r.plane_error < 0x1p60 && r.vertex_error < 0x1p60;
}

}  // namespace cchip
