// SPDX-License-Identifier: Apache-2.0
/// \file
/// Random stimulus.
#ifndef CCHIP_LEVELS_GENERATOR_HPP
#define CCHIP_LEVELS_GENERATOR_HPP

#include <cchip/levels/stimulus.hpp>
#include <cstddef>
#include <cstdint>

namespace cchip::levels {

struct GeneratorOptions {
  std::size_t pairs = 102000;     ///< primitive pairs
  std::size_t object_pairs = 51;  ///< 1..pairs; they get the same number of primitive pairs, give or take one
  std::uint64_t seed = 1;         ///< the stimulus depends on the options only
  bool points = false;            ///< a fourth kind of object pairs: points with a radius against triangles
};

/// Successive object pairs differ in kind, the first three (with points four) have all kinds. Primitive pairs of every
/// class: general, a grid step apart, touching, coplanar, degenerate, quads planar, warped and collapsed. Half of the
/// matrices turn A by any angle, the others keep the class of the pair exactly: they permute and mirror axes, shift,
/// and scale by 1, 1/2 or 1/4. \throws std::invalid_argument the number of object pairs is out of range
Stimulus generate(const GeneratorOptions& options);

}  // namespace cchip::levels

#endif
