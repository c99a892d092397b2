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

/// Uses of an edge by faces.
struct Edge {
  std::uint32_t low;
  std::uint32_t high;
  std::uint32_t face;       ///< the first one
  std::uint32_t last_face;  ///< the last one
  int uses = 1;
  int net = 1;  ///< uses from low to high less those from high to low
};

/// Edges with their uses, each once, by their ends; one whose ends coincide is none.
/// \param place as Object::same_place()
std::vector<Edge> find_edges(const Mesh& mesh, const std::vector<std::uint32_t>& place);

}  // namespace cchip

#endif
