// SPDX-License-Identifier: Apache-2.0
/// \file
/// Functional model of cchip_refit: the nodes of an image from its leaves, in integers.
#ifndef CCHIP_BLOCKS_REFIT_HPP
#define CCHIP_BLOCKS_REFIT_HPP

#include <cchip/internal/image/image_line.hpp>
#include <cchip/internal/wire/definitions.hpp>
#include <cstdint>
#include <vector>

namespace cchip::model {

struct RefitCommand {
  std::uint32_t lines = 0;  ///< of the image, its header included
  std::uint32_t root = 1;
};

struct RefitResult {
  RefitCode code = RefitCode::ok;
  std::uint32_t line = 0;   ///< of the image, at work when the refit ended; 0 if none was
  std::uint32_t lines = 0;  ///< lines read
};

/// Bounds of what lies below a line, on the 13 directions, in 2^-48 of the object's unit.
struct RefitBounds {
  std::array<std::int64_t, bvh::directions.size()> least = {};
  std::array<std::int64_t, bvh::directions.size()> greatest = {};
};

/// Bounds of a leaf: of its vertices, each of which may be off by half a step on every axis if the leaf is `rounded`.
RefitBounds leaf_bounds(const bvh::LeafLine& leaf, bvh::NodeKind kind);

/// Gives a node the volumes of its children. `first`, the kinds, the number of children and `cut_exponent` stay.
/// \return false if no step is coarse enough
bool set_volumes(bvh::InnerLine& node, const std::vector<RefitBounds>& children);

/// Gives every node of an image, whose leaves hold new vertices, new volumes. The header is neither read nor written.
/// \param levels of nodes that there is room for, leaves not included
RefitResult refit_image(std::vector<Line>& image, const RefitCommand& command, int levels = 48);

}  // namespace cchip::model

#endif
