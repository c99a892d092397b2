// SPDX-License-Identifier: Apache-2.0
/// \file
/// The streams s_pair and m_result as values.
#ifndef CCHIP_MACHINES_PAIR_PORT_HPP
#define CCHIP_MACHINES_PAIR_PORT_HPP

#include <cchip/internal/wire/pair.hpp>
#include <cchip/sim/bits.hpp>
#include <cchip/sim/stream.hpp>
#include <random>
#include <type_traits>
#include <utility>

namespace cchip::sim {

/// Writes the vertices of a primitive to a vector: vertex i in bits [lsb + 3 coord_w i +: 3 coord_w], x lowest.
/// \throws std::invalid_argument a coordinate does not fit
template <class Port>
void set_vertices(Port& port, const std::array<Vec3i, 4>& vertices, int count, int coord_w, int lsb = 0) {
  for (int i = 0; i < count; ++i) {
    for (int d = 0; d < 3; ++d) {
      set_signed(port, lsb + coord_w * (3 * i + d), coord_w, vertices[static_cast<std::size_t>(i)][d]);
    }
  }
}

/// The primitive that set_vertices wrote.
template <class Port>
GridPrimitive get_primitive(const Port& port, Kind kind, int coord_w, int lsb = 0) {
  GridPrimitive p;
  p.kind = kind;
  for (int i = 0; i < defs::vertices; ++i) {
    for (int d = 0; d < 3; ++d) {
      p.v[static_cast<std::size_t>(i)][d] =
          static_cast<std::int32_t>(get_signed(port, lsb + coord_w * (3 * i + d), coord_w));
    }
  }
  return p;
}

/// Whether a model's streams are words, the records REQUEST and RESULT, or a port for each field.
template <class Model, class = void>
struct HasWords : std::false_type {};
template <class Model>
struct HasWords<Model, std::void_t<decltype(std::declval<Model&>().s_pair_data)>> : std::true_type {};

/// Pins of a primitive test, or of what stands around one.
template <class Model>
class PairPort {
 public:
  PairPort(Model& model, int coord_w) : model_(model), coord_w_(coord_w) {}

  /// Payload of s_pair; valid is not touched. Slot 3 of a triangle carries v[3] as it is: it must not matter.
  void put(const PairRequest& request) {
    const auto mode = static_cast<std::uint64_t>(request.mode);
    const auto err = static_cast<std::uint64_t>(request.pair.eta);
    if constexpr (HasWords<Model>::value) {
      auto& word = model_.s_pair_data;
      const auto put_field = [&](defs::Field field, std::uint64_t value) {
        set_bits(word, field.lsb, field.width, value);
      };
      set_vertices(word, request.pair.a.v, defs::vertices, coord_w_, defs::request_a(coord_w_).lsb);
      set_vertices(word, request.pair.b.v, defs::vertices, coord_w_, defs::request_b(coord_w_).lsb);
      put_field(defs::request_tag, request.tag);
      put_field(defs::request_mode(coord_w_), mode);
      put_field(defs::request_err(coord_w_), err);
    } else {
      set_vertices(model_.s_pair_a, request.pair.a.v, defs::vertices, coord_w_);
      set_vertices(model_.s_pair_b, request.pair.b.v, defs::vertices, coord_w_);
      model_.s_pair_tag = request.tag;
      set_bits(model_.s_pair_mode, 0, defs::mode_w, mode);
      set_bits(model_.s_pair_err, 0, defs::err_w, err);
    }
  }
  /// The payload that is on s_pair.
  PairRequest request(Kind kind_a, Kind kind_b) const {
    PairRequest r;
    if constexpr (HasWords<Model>::value) {
      const auto& word = model_.s_pair_data;
      const auto field = [&](defs::Field f) { return get_bits(word, f.lsb, f.width); };
      r.pair.a = get_primitive(word, kind_a, coord_w_, defs::request_a(coord_w_).lsb);
      r.pair.b = get_primitive(word, kind_b, coord_w_, defs::request_b(coord_w_).lsb);
      r.pair.eta = static_cast<int>(field(defs::request_err(coord_w_)));
      r.tag = static_cast<std::uint16_t>(field(defs::request_tag));
      r.mode = static_cast<PairMode>(field(defs::request_mode(coord_w_)));
    } else {
      r.pair.a = get_primitive(model_.s_pair_a, kind_a, coord_w_);
      r.pair.b = get_primitive(model_.s_pair_b, kind_b, coord_w_);
      r.pair.eta = model_.s_pair_err;
      r.tag = model_.s_pair_tag;
      r.mode = static_cast<PairMode>(model_.s_pair_mode);
    }
    return r;
  }
  /// Garbage on the payload of s_pair.
  void scramble(std::mt19937_64& random) {
    if constexpr (HasWords<Model>::value) {
      set_random(model_.s_pair_data, defs::request_w(coord_w_), random);
    } else {
      set_random(model_.s_pair_a, 3 * defs::vertices * coord_w_, random);
      set_random(model_.s_pair_b, 3 * defs::vertices * coord_w_, random);
      set_random(model_.s_pair_tag, defs::tag_w, random);
      set_random(model_.s_pair_mode, defs::mode_w, random);
      set_random(model_.s_pair_err, defs::err_w, random);
    }
  }
  /// Payload of m_result.
  PairResult result() const {
    if constexpr (HasWords<Model>::value) {
      const auto field = [this](defs::Field f) {
        return static_cast<int>(get_bits(model_.m_result_data, f.lsb, f.width));
      };
      return {static_cast<std::uint16_t>(field(defs::result_tag)),
              field(defs::result_hit) != 0,
              field(defs::result_grid) != 0,
              field(defs::result_definite) != 0,
              axis_code_from_bits(static_cast<std::uint16_t>(field(defs::result_axis))),
              field(defs::result_beats)};
    } else {
      return {model_.m_result_tag,
              model_.m_result_hit != 0,
              model_.m_result_grid != 0,
              model_.m_result_definite != 0,
              axis_code_from_bits(model_.m_result_axis),
              model_.m_result_beats};
    }
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
