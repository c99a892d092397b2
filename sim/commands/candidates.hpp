// SPDX-License-Identifier: Apache-2.0
/// \file
/// Candidate pairs of two posed meshes.
#ifndef CCHIP_COMMANDS_CANDIDATES_HPP
#define CCHIP_COMMANDS_CANDIDATES_HPP

#include <cchip/mesh.hpp>
#include <cchip/stimulus/pair_job.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "mesh_source.hpp"

namespace cchip::app {

/// Calls `take` for every pair of faces whose boxes overlap, at most `limit` times (0: no limit).
void for_each_candidate(const Mesh& a, const Mesh& b, std::uint64_t limit, const std::function<void(PairJob)>& take);
/// How often for_each_candidate() calls `take`.
std::uint64_t count_candidates(const Mesh& a, const Mesh& b, std::uint64_t limit);

/// Marks the faces of a candidate pair of for_each_candidate() that hit.
void add_hit(HitPicture& picture, const PairJob& job);

}  // namespace cchip::app

#endif
