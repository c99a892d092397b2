// SPDX-License-Identifier: Apache-2.0
/// \file
/// Queries the slow way: no tree, no filter.
#ifndef CCHIP_INTERNAL_JUDGE_BRUTE_FORCE_HPP
#define CCHIP_INTERNAL_JUDGE_BRUTE_FORCE_HPP

#include <cchip/collide.hpp>
#include <vector>

namespace cchip {

/// All contacts of two meshes under poses, with their relations, in ascending order, none twice: every face of one
/// against every face of the other, each by the exact oracle in integers of any size. Takes about 20 microseconds a
/// pair of faces.
///
/// \throws std::invalid_argument a number is not finite
std::vector<Contact> brute_force_contacts(const Mesh& a, const Pose& pose_a, const Mesh& b, const Pose& pose_b);

}  // namespace cchip

#endif
