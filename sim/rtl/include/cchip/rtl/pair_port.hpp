// SPDX-License-Identifier: Apache-2.0
/// \file
/// The streams s_pair and m_result of the primitive tests as values.
#ifndef CCHIP_RTL_PAIR_PORT_HPP
#define CCHIP_RTL_PAIR_PORT_HPP

#include <cchip/sim/bits.hpp>
#include <cchip/sim/stream.hpp>
#include <cchip/wire/pair.hpp>
#include <random>
#include <utility>

namespace cchip::sim {

/// Writes the vertices of a primitive to a vector: vertex i in bits [3 coord_w i +: 3 coord_w], x lowest.
/// \throws std::invalid_argument a coordinate does not fit
template <class Port>
void set_vertices(Port& port, const std::array<Vec3i, 4>& vertices, int count, int coord_w) {
  for (int i = 0; i < count; ++i) {
    for (int d = 0; d < 3; ++d) {
      set_signed(port, coord_w * (3 * i + d), coord_w, vertices[static_cast<std::size_t>(i)][d]);
    }
  }
}

/// Pins of a primitive test.
template <class Model>
class PairPort {
 public:
  PairPort(Model& model, int coord_w) : model_(model), coord_w_(coord_w) {}

  /// Payload of s_pair; valid is not touched. Slot 3 of a triangle carries v[3] as it is: it must not matter.
  void put(const PairRequest& request) {
    set_vertices(model_.s_pair_a, request.pair.a.v, defs::vertices, coord_w_);
    set_vertices(model_.s_pair_b, request.pair.b.v, defs::vertices, coord_w_);
    model_.s_pair_tag = request.tag;
    model_.s_pair_mode = static_cast<CData>(request.mode);
    model_.s_pair_err = static_cast<CData>(request.pair.eta & 15);
  }
  /// Garbage on the payload of s_pair.
  void scramble(std::mt19937_64& random) {
    set_random(model_.s_pair_a, 3 * defs::vertices * coord_w_, random);
    set_random(model_.s_pair_b, 3 * defs::vertices * coord_w_, random);
    set_random(model_.s_pair_tag, defs::tag_w, random);
    set_random(model_.s_pair_mode, defs::mode_w, random);
    set_random(model_.s_pair_err, defs::err_w, random);
  }
  /// Payload of m_result.
  PairResult result() const {
    return {model_.m_result_tag,
            model_.m_result_hit != 0,
            model_.m_result_grid != 0,
            model_.m_result_definite != 0,
            axis_code_from_bits(model_.m_result_axis),
            model_.m_result_beats};
  }

  /// Agents on both streams. This object must outlive them.
  StreamDriver<PairRequest> driver(Pattern pattern = Pattern::always()) {
    return {"s_pair", model_.s_pair_valid, model_.s_pair_ready, [this](const PairRequest& request) { put(request); },
            std::move(pattern)};
  }
  StreamSink<PairResult> sink(Pattern pattern = Pattern::always()) {
    return {"m_result", model_.m_result_valid, model_.m_result_ready, [this] { return result(); }, std::move(pattern)};
  }

 private:
  Model& model_;
  int coord_w_;
};

}  // namespace cchip::sim

#endif
