// SPDX-License-Identifier: Apache-2.0
/// \file
/// Axis codes of a shape, and pairs that one axis alone separates.
#ifndef CCHIP_TESTS_UNIT_PAIR_TOOLS_HPP
#define CCHIP_TESTS_UNIT_PAIR_TOOLS_HPP

#include <cchip/internal/grid/coplanar.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/model/sat.hpp>
#include <cchip/stimulus/pair_source.hpp>
#include <cchip/stimulus/witness.hpp>

#include "bench.hpp"

namespace cchip::test {

inline AxisCode axis_code(AxisClass cls, std::size_t k, std::size_t l) {
  return {cls, static_cast<std::uint8_t>(k), static_cast<std::uint8_t>(l)};
}
inline Kind kind_of(std::size_t vertices) { return vertices == 4 ? Kind::quad : Kind::tri; }

/// Every code of a projected axis that exists for the shape.
inline std::vector<AxisCode> axis_codes(const model::Shape& shape) {
  const auto edges = [](std::size_t n) { return std::size_t{n == 4 ? 6U : 3U}; };
  const auto normals = [](std::size_t n) { return std::size_t{n == 4 ? 5U : 1U}; };
  std::vector<AxisCode> codes;
  for (std::size_t k = 0; k < normals(shape.a); ++k) codes.push_back(axis_code(AxisClass::normal_a, k, 0));
  for (std::size_t k = 0; k < normals(shape.b); ++k) codes.push_back(axis_code(AxisClass::normal_b, k, 0));
  for (std::size_t k = 0; k < edges(shape.a); ++k) {
    for (std::size_t l = 0; l < edges(shape.b); ++l) codes.push_back(axis_code(AxisClass::cross, k, l));
  }
  for (std::size_t d = 0; d < 3; ++d) {
    for (std::size_t k = 0; k < shape.a; ++k) codes.push_back(axis_code(AxisClass::in_plane_a, k, d));
    for (std::size_t k = 0; k < shape.b; ++k) codes.push_back(axis_code(AxisClass::in_plane_b, k, d));
  }
  return codes;
}

/// nA, nB and every e_k x f_l of the sides (eq. 1 of the paper).
inline std::vector<AxisCode> exhaustive_codes(const model::Shape& shape) {
  std::vector<AxisCode> codes = {{AxisClass::normal_a, 0, 0}, {AxisClass::normal_b, 0, 0}};
  for (std::size_t k = 0; k < shape.a; ++k) {
    for (std::size_t l = 0; l < shape.b; ++l) codes.push_back(axis_code(AxisClass::cross, k, l));
  }
  return codes;
}

/// For each axis of exhaustive_codes() a pair, not coplanar nor degenerate, that it separates and no other does.
inline std::vector<GridPair> pairs_separated_by_one(const model::Shape& shape, int coord_w, std::uint64_t seed) {
  const std::vector<AxisCode> codes = exhaustive_codes(shape);
  stimulus::PairSource source(coord_w, seed, kind_of(shape.a), kind_of(shape.b));
  std::vector<std::optional<GridPair>> found(codes.size());
  for (std::size_t missing = codes.size(); missing > 0;) {
    const GridPair pair =
        source.draw(source.coin() ? stimulus::PairClass::general_full : stimulus::PairClass::near_edge);
    if (is_degenerate(pair.a) || is_degenerate(pair.b) || is_coplanar(pair)) continue;
    std::size_t separating = 0;
    std::size_t last = 0;
    for (std::size_t i = 0; i < codes.size() && separating < 2; ++i) {
      if (!witness_separates(codes[i], pair)) continue;
      ++separating;
      last = i;
    }
    if (separating != 1 || found[last]) continue;
    found[last] = pair;
    --missing;
  }
  std::vector<GridPair> pairs;
  for (const auto& pair : found) pairs.push_back(*pair);
  return pairs;
}

}  // namespace cchip::test

#endif
