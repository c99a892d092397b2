// SPDX-License-Identifier: Apache-2.0
#include <cchip/levels/functional_api.hpp>
#include <cchip/levels/level.hpp>
#include <cchip/levels/simulate.hpp>

namespace cchip::levels {

LevelResult run_l0(const Stimulus& stimulus, const LevelOptions&) {
  FunctionalApi api("api", stimulus, sc_core::sc_time(1, sc_core::SC_MS), defs::kinds_max);
  FunctionalTriTri tri_tri("tri_tri");
  FunctionalTriQuad tri_quad("tri_quad");
  FunctionalQuadQuad quad_quad("quad_quad");
  FunctionalPointTri point_tri("point_tri");
  FunctionalChannels to_tri_tri("to_tri_tri");
  FunctionalChannels to_tri_quad("to_tri_quad");
  FunctionalChannels to_quad_quad("to_quad_quad");
  FunctionalChannels to_point_tri("to_point_tri");
  to_tri_tri.bind(api, 0);
  to_tri_tri.bind(tri_tri);
  to_tri_quad.bind(api, 1);
  to_tri_quad.bind(tri_quad);
  to_quad_quad.bind(api, 2);
  to_quad_quad.bind(quad_quad);
  to_point_tri.bind(api, 3);
  to_point_tri.bind(point_tri);
  return simulate(api);
}

}  // namespace cchip::levels
