// SPDX-License-Identifier: Apache-2.0
/// \file
/// What an object finds out about its edges when it is asked.
#ifndef CCHIP_COLLIDE_EDGES_HPP
#define CCHIP_COLLIDE_EDGES_HPP

#include <cchip/collide/object.hpp>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

namespace cchip {

struct Object::Edges {
  std::mutex mutex;  ///< of a call that fills this in
  bool known = false;
  std::vector<std::uint32_t> same_place;
  std::optional<OpenEdge> open;
};

}  // namespace cchip

#endif
