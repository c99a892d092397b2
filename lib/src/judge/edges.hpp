// SPDX-License-Identifier: Apache-2.0
/// \file
/// What an object finds out about its surface when it is asked.
#ifndef CCHIP_JUDGE_EDGES_HPP
#define CCHIP_JUDGE_EDGES_HPP

#include <cchip/internal/judge/shells.hpp>
#include <cchip/object.hpp>
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
  std::optional<OpenEdge> twisted;
  std::mutex shells_mutex;  ///< of a call that fills this in
  std::optional<Shells> shells;
};

}  // namespace cchip

#endif
