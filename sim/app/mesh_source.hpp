// SPDX-License-Identifier: Apache-2.0
/// \file
/// Candidate pairs of two posed meshes.
#ifndef CCHIP_APP_MESH_SOURCE_HPP
#define CCHIP_APP_MESH_SOURCE_HPP

#include <cchip/mesh/mesh.hpp>
#include <cchip/stimulus/pair_job.hpp>
#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace cchip::app {

/// Triangles and quads of a file; a line on `notices` if other faces had to be cut.
/// \throws UsageError the file is missing, broken or has no faces
Mesh load_mesh_file(const std::string& path, std::ostream& notices);

/// Columns of the candidate pairs: the face numbers, counted from 0.
const std::vector<std::string>& mesh_pair_names();

/// Calls `take` for every pair of faces whose boxes overlap, at most `limit` times (0: no limit).
void for_each_candidate(const Mesh& a, const Mesh& b, std::uint64_t limit, const std::function<void(PairJob)>& take);

}  // namespace cchip::app

#endif
