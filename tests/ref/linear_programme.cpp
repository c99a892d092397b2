// SPDX-License-Identifier: Apache-2.0
#include "linear_programme.hpp"

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <vector>

namespace cchip_test {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using Points = std::vector<std::array<Rational, 3>>;

/// Feasibility of sum l_i a_i = sum m_j b_j, sum l = sum m = 1, l, m >= 0, by phase 1 of the simplex
/// method with Bland's rule (which cannot cycle), in rationals.
bool share_a_point(const Points& a, const Points& b) {
  const std::size_t variables = a.size() + b.size();
  // Five equations with an artificial variable each; the last column is the right-hand side.
  std::vector<std::vector<Rational>> rows(5, std::vector<Rational>(variables + 1));
  for (std::size_t j = 0; j < variables; ++j) {
    const bool of_a = j < a.size();
    for (std::size_t d = 0; d < 3; ++d) rows[d][j] = of_a ? a[j][d] : Rational(-b[j - a.size()][d]);
    rows[of_a ? 3 : 4][j] = 1;
  }
  rows[3][variables] = rows[4][variables] = 1;
  std::vector<std::size_t> basis;  // indices from `variables` on are the artificial ones
  for (std::size_t i = 0; i < rows.size(); ++i) basis.push_back(variables + i);

  // The sum of the artificial variables, in terms of the others, must become 0.
  std::vector<Rational> infeasibility(variables + 1);
  for (const auto& row : rows) {
    for (std::size_t j = 0; j <= variables; ++j) infeasibility[j] += row[j];
  }
  for (;;) {
    std::size_t in = 0;
    while (in < variables && infeasibility[in] <= 0) ++in;
    if (in == variables) return infeasibility[variables] == 0;
    std::size_t out = rows.size();
    Rational least_ratio;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i][in] <= 0) continue;
      const Rational ratio = rows[i][variables] / rows[i][in];
      if (out == rows.size() || ratio < least_ratio || (ratio == least_ratio && basis[i] < basis[out])) {
        out = i;
        least_ratio = ratio;
      }
    }
    const Rational pivot = rows[out][in];
    for (Rational& x : rows[out]) x /= pivot;
    const auto eliminate = [&](std::vector<Rational>& row) {
      const Rational factor = row[in];
      if (factor == 0) return;
      for (std::size_t j = 0; j <= variables; ++j) row[j] -= factor * rows[out][j];
    };
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (i != out) eliminate(rows[i]);
    }
    eliminate(infeasibility);
    basis[out] = in;
  }
}

template <class AnyPrimitive>
Points rational_vertices(const AnyPrimitive& p) {
  Points points;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    points.push_back({Rational(p.v[i].x()), Rational(p.v[i].y()), Rational(p.v[i].z())});
  }
  return points;
}

}  // namespace

bool linear_programme_intersects(const cchip::GridPrimitive& a, const cchip::GridPrimitive& b) {
  return share_a_point(rational_vertices(a), rational_vertices(b));
}

bool linear_programme_intersects(const cchip::Primitive& a, const cchip::Primitive& b) {
  return share_a_point(rational_vertices(a), rational_vertices(b));
}

}  // namespace cchip_test
