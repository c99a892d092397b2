// SPDX-License-Identifier: Apache-2.0
#include <cchip/levels/functional_api.hpp>

namespace cchip::levels {
namespace {

Vertices to_vertices(const GridPrimitive& p, std::size_t count) {
  Vertices result;
  for (std::size_t i = 0; i < count; ++i) result.v.at(i) = {p.v.at(i)[0], p.v.at(i)[1], p.v.at(i)[2]};
  return result;
}

}  // namespace

FunctionalApi::FunctionalApi(const sc_core::sc_module_name& name, const Stimulus& stimulus, sc_core::sc_time patience,
                             std::size_t sets)
    : Api(name, stimulus, patience), m("m", sets), a("a", sets), b("b", sets), hit("hit", sets) {}

std::size_t FunctionalApi::set_of(std::size_t index) const {
  if (m.size() == 1) return 0;
  return static_cast<std::size_t>(test_of(stimulus()[index])) - 1;
}

void FunctionalApi::send(std::size_t index) {
  const StimulusPair& pair = stimulus()[index];
  const std::size_t set = set_of(index);
  m[set].write(pair.m);
  Vertices of_a = to_vertices(pair.a, vertex_count_a(pair));
  if (pair.radius) of_a.v[1][0] = *pair.radius;
  a[set].write(of_a);
  b[set].write(to_vertices(pair.b, pair.b.vertex_count()));
}

std::pair<std::size_t, bool> FunctionalApi::receive() {
  const std::size_t index = answered();
  if (index == stimulus().size()) wait();  // for ever: all are answered
  return {index, hit[set_of(index)].read()};
}

}  // namespace cchip::levels
