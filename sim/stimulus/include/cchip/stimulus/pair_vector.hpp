// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lines of a vector file: a pair and the result that is expected of it, as bench_primtest.v reads them.
#ifndef CCHIP_STIMULUS_PAIR_VECTOR_HPP
#define CCHIP_STIMULUS_PAIR_VECTOR_HPP

#include <bitset>
#include <cchip/internal/wire/definitions.hpp>
#include <cchip/internal/wire/pair.hpp>
#include <cchip/primitive.hpp>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace cchip::bench {

constexpr int coord_w = defs::coord_w_default;
constexpr int side_w = 3 * defs::vertices * coord_w;

/// Position of a field, bit.
struct Field {
  int lsb, width;
  constexpr int end() const { return lsb + width; }
};
constexpr Field side_a{0, side_w};
constexpr Field side_b{side_a.end(), side_w};
constexpr Field tag{side_b.end(), defs::tag_w};
constexpr Field mode{tag.end(), defs::mode_w};
constexpr Field err{mode.end(), defs::err_w};
constexpr Field hit{err.end(), 1};
constexpr Field grid{hit.end(), 1};
constexpr Field definite{grid.end(), 1};
constexpr Field axis{definite.end(), defs::axis_code_w};
constexpr Field beats{axis.end(), defs::beats_w};
constexpr Field rm_id{beats.end(), defs::rm_id_w};
constexpr int digits = rm_id.end() / 4;
static_assert(4 * digits == rm_id.end());

/// One line.
class Vector {
 public:
  Vector() = default;
  /// \throws std::invalid_argument not a line of a vector file
  explicit Vector(const std::string& line) {
    if (line.size() != digits) throw std::invalid_argument("a vector has " + std::to_string(digits) + " digits");
    for (int i = 0; i < digits; ++i) {
      set({4 * i, 4}, std::stoul(line.substr(static_cast<std::size_t>(digits - 1 - i), 1), nullptr, 16));
    }
  }
  std::string line() const {
    std::string text;
    for (int i = digits - 1; i >= 0; --i) text += "0123456789abcdef"[get({4 * i, 4})];
    return text;
  }

  /// Fields of up to 64 bits.
  void set(Field field, std::uint64_t value) {
    for (int i = 0; i < field.width; ++i) bits_[static_cast<std::size_t>(field.lsb + i)] = (value >> i & 1) != 0;
  }
  std::uint64_t get(Field field) const {
    std::uint64_t value = 0;
    for (int i = 0; i < field.width; ++i) {
      value |= std::uint64_t{bits_[static_cast<std::size_t>(field.lsb + i)]} << i;
    }
    return value;
  }
  /// All four vertex slots of a primitive.
  void set(Field side, const GridPrimitive& primitive) {
    for (int i = 0; i < 3 * defs::vertices; ++i) {
      const std::int32_t coordinate = primitive.v[static_cast<std::size_t>(i / 3)][i % 3];
      set({side.lsb + coord_w * i, coord_w}, static_cast<std::uint64_t>(coordinate));
    }
  }

 private:
  std::bitset<4 * digits> bits_;
};

/// \throws std::runtime_error the file cannot be read or contains no vector
inline std::vector<Vector> read_vectors(const std::string& path) {
  std::vector<Vector> vectors;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) vectors.emplace_back(line);
  if (vectors.empty()) throw std::runtime_error(path + ": no vectors; write them with cchip_pair_vectors");
  return vectors;
}

}  // namespace cchip::bench

#endif
