// SPDX-License-Identifier: Apache-2.0
#include "relative_pose.hpp"

#include <algorithm>
#include <cchip/internal/tree/support_tree.hpp>
#include <cmath>

#include "exact/ieee.hpp"

namespace cchip {
namespace {

constexpr double u = 0x1p-53;
constexpr double radius = bvh::support_most;

/// Three columns. Plain loops over few numbers: expressions of a matrix library cost several times as much here.
using Matrix = std::array<std::array<double, 3>, 3>;
using Vector = std::array<double, 3>;

Matrix linear_of(const Pose& pose) {
  Matrix m;
  const double* const from = pose.data();  // columns of four
  for (std::size_t c = 0; c < 3; ++c) m[c] = {from[4 * c], from[4 * c + 1], from[4 * c + 2]};
  return m;
}

double dot(const Vector& p, const Vector& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
Vector cross(const Vector& p, const Vector& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
/// Square of the Frobenius norm.
double square(const Matrix& m) { return dot(m[0], m[0]) + dot(m[1], m[1]) + dot(m[2], m[2]); }

/// Bound on the spectral norm: its square is the greatest eigenvalue of w^T w, at most a sum of magnitudes in a row.
/// For a rotation that is 1, where the Frobenius norm is sqrt(3). Covers that w is the inverse up to 2^-20 only.
double greatest_stretch(const Matrix& w) {
  double most = 0;
  for (const Vector& p : w) {
    most = std::max(most, std::abs(dot(p, w[0])) + std::abs(dot(p, w[1])) + std::abs(dot(p, w[2])));
  }
  return std::sqrt(most) * (1 + 0x1p-18);
}

/// Not for NaN.
bool is_moderate(double square) { return square > 0x1p-400 && square < 0x1p400; }

}  // namespace

bool relate(const CollisionQuery& query, const CentreLine& line, double within, RelativePose& r) {
  const double unit_a = query.a->tree().unit();
  const double unit_b = query.b->tree().unit();
  const double square_a = square(linear_of(*query.pose_a));
  const double square_b = square(linear_of(*query.pose_b));
  r.swapped = square_a * (unit_a * unit_a) > square_b * (unit_b * unit_b);
  const Matrix lm = linear_of(r.swapped ? *query.pose_b : *query.pose_a);
  const Matrix lf = linear_of(r.swapped ? *query.pose_a : *query.pose_b);
  const double square_m = r.swapped ? square_b : square_a;
  const double square_f = r.swapped ? square_a : square_b;
  const double unit_m = r.swapped ? unit_b : unit_a;
  const double unit_f = r.swapped ? unit_a : unit_b;
  if (!(unit_f > 0x1p-200 && unit_f < 0x1p200) || !is_moderate(square_f) || !(unit_m < 0x1p200) ||
      !(square_m < 0x1p400)) {
    return false;
  }

  // w maps a direction of the fixed object to one of the world: the transposed inverse of lf, from its cofactors.
  // lf^T w - 1 says how well.
  Matrix w = {cross(lf[1], lf[2]), cross(lf[2], lf[0]), cross(lf[0], lf[1])};
  const double inverse_determinant = 1 / dot(lf[0], w[0]);
  for (Vector& column : w) {
    for (double& x : column) x *= inverse_determinant;
  }
  const double norm_w = std::sqrt(square(w));
  // Sums of magnitudes are bounds on the norms, known already. That of w would be too coarse for great distances.
  const double norm_m = r.swapped ? line.entries_b : line.entries_a;
  const double norm_f = r.swapped ? line.entries_a : line.entries_b;
  double off = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) off += std::abs(dot(lf[i], w[k]) - (i == k ? 1 : 0));
  }
  // Sums over all entries of |lf|^T |w| are at most 3 norms of both.
  const double inverse_error = off + 24 * u * norm_f * norm_w;
  if (!(inverse_error <= 0x1p-20)) return false;  // NaN, too

  const double per_unit = 1 / unit_f;
  const double ratio = unit_m * per_unit;
  double square_r = 0;
  double row = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    double square_row = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double m = dot(w[i], lm[k]) * ratio;
      r.m[3 * i + k] = m;
      square_row += m * m;
    }
    square_r += square_row;
    row = std::max(row, square_row);
  }
  const double m_error = 24 * u * norm_w * norm_m * ratio;
  const double towards = r.swapped ? 1 : -1;  // from the fixed centre to the moved one
  const Vector between = {towards * line.between[0], towards * line.between[1], towards * line.between[2]};
  for (std::size_t i = 0; i < 3; ++i) r.t[i] = dot(w[i], between) * per_unit;
  const double t_error = 32 * u * norm_w * line.size * per_unit;

  r.norm = std::sqrt(square_r);
  r.row = std::sqrt(row);
  r.distance = std::sqrt(dot(r.t, r.t));
  r.plane_error = radius * (inverse_error + m_error) + 3 * t_error;
  r.vertex_error = radius * m_error + t_error + 2 * inverse_error * (radius * r.norm + r.distance);
  // What may underflow is far below a unit: see the bounds on the numbers above.
  r.plane_error += 0x1p-100;
  r.vertex_error += 0x1p-100;
  r.growth = within > 0 ? within * per_unit * greatest_stretch(w) : 0;
  // Within these limits no product of the search leaves single precision: docs/cpp/exactness.md derives them.
  return r.norm < 0x1p26 && r.distance < 0x1p40 && r.plane_error + r.growth < 0x1p36 &&
         r.vertex_error + r.growth < 0x1p36;
}

}  // namespace cchip
