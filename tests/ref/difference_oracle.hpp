// SPDX-License-Identifier: Apache-2.0
/// \file
/// Whether two primitives cross, straight from the definition: is 0 in the interior of the hull of all differences of
/// their vertices? Knows no edges, faces or axes of the primitives.
#ifndef CCHIP_TESTS_REF_DIFFERENCE_ORACLE_HPP
#define CCHIP_TESTS_REF_DIFFERENCE_ORACLE_HPP

#include <algorithm>
#include <array>
#include <cchip/internal/wire/pair.hpp>
#include <cchip/primitive.hpp>
#include <cstdint>
#include <optional>

namespace cchip_test {

/// A vector whose products with the differences of all vertices of A and B are at most 0, so that a translation of A
/// along its negative parts the two; or nothing: 0 is in the interior. Zero if A - B has no area.
/// 0 lies outside the interior of a solid A - B if some vector u has u . x >= 0 for all differences x. These u are a
/// pointed cone; one of its edges is orthogonal to two of the differences, hence their cross product up to its sign.
/// \pre coordinates of at most 20 bits
inline std::optional<std::array<std::int64_t, 3>> parting_direction(const cchip::GridPair& pair) {
  __extension__ typedef __int128 Wide;
  std::array<std::array<std::int64_t, 3>, 16> x;
  std::size_t count = 0;
  for (std::size_t i = 0; i < pair.a.vertex_count(); ++i) {
    for (std::size_t k = 0; k < pair.b.vertex_count(); ++k) {
      for (std::size_t d = 0; d < 3; ++d) {
        const auto row = static_cast<Eigen::Index>(d);
        x[count][d] = std::int64_t{pair.a.v[i][row]} - pair.b.v[k][row];
      }
      ++count;
    }
  }
  bool has_area = false;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      std::array<std::int64_t, 3> u;
      for (std::size_t d = 0; d < 3; ++d) {
        const std::size_t e = (d + 1) % 3, f = (d + 2) % 3;
        u[d] = x[i][e] * x[k][f] - x[i][f] * x[k][e];
      }
      if (u[0] == 0 && u[1] == 0 && u[2] == 0) continue;
      has_area = true;
      Wide least = 0, greatest = 0;
      for (std::size_t n = 0; n < count; ++n) {
        const Wide along = Wide{u[0]} * x[n][0] + Wide{u[1]} * x[n][1] + Wide{u[2]} * x[n][2];
        least = std::min(least, along);
        greatest = std::max(greatest, along);
      }
      if (greatest == 0) return u;
      if (least == 0) return std::array<std::int64_t, 3>{-u[0], -u[1], -u[2]};
    }
  }
  if (!has_area) return std::array<std::int64_t, 3>{0, 0, 0};
  return std::nullopt;
}

}  // namespace cchip_test

#endif
