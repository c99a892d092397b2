// SPDX-License-Identifier: Apache-2.0
/// \file
/// Points and triangles of point_triangle_source.hpp as pairs that the hardware takes, and their answers.
#ifndef CCHIP_TESTS_REF_POINT_PAIR_HPP
#define CCHIP_TESTS_REF_POINT_PAIR_HPP

#include <cchip/internal/model/point_tri.hpp>
#include <cchip/sim/scoreboard.hpp>
#include <string>

#include "point_triangle_source.hpp"

namespace cchip_test {

/// \param coord_w width of a signed coordinate, bit
inline cchip::GridPair grid_pair(const PointTriangle& drawn, int coord_w) {
  const auto to_vec = [](const std::array<std::int64_t, 3>& v) {
    return cchip::Vec3i(static_cast<int>(v[0]), static_cast<int>(v[1]), static_cast<int>(v[2]));
  };
  cchip::GridPair pair;
  pair.a = cchip::model::point_operand(to_vec(drawn.point), static_cast<int>(drawn.radius), coord_w);
  for (std::size_t i = 0; i < 3; ++i) pair.b.v[i] = to_vec(drawn.triangle[i]);
  return pair;
}

/// The answer of the functional model; the exact distance confirms it.
/// \throws cchip::sim::SimulationError it does not
inline cchip::PairResult confirmed_point_answer(const cchip::PairRequest& request, int coord_w) {
  const cchip::GridPair& pair = request.pair;
  IntTriangle triangle;
  for (std::size_t i = 0; i < 3; ++i) {
    const cchip::Vec3i v = pair.b.v[i] - pair.a.v[0];
    triangle[i] = {v.x(), v.y(), v.z()};
  }
  const auto square = nearest<Int256>(triangle).square;
  const cchip::PairResult answer = cchip::model::point_tri_answer(request, coord_w);
  cchip::sim::require(answer.grid == (compare(square, cchip::model::radius_of(pair.a, coord_w)) <= 0),
                      "the model contradicts the exact distance, tag " + std::to_string(request.tag));
  return answer;
}

}  // namespace cchip_test

#endif
