// SPDX-License-Identifier: Apache-2.0
/// \file
/// Points of meshes and in solids, without the integers that they are found by.
#ifndef CCHIP_ASSEMBLY_SOLID_POINTS_HPP
#define CCHIP_ASSEMBLY_SOLID_POINTS_HPP

#include <cchip/assembly.hpp>
#include <cstdint>
#include <vector>

namespace cchip::assembly {

/// The number of a vertex of each piece of a mesh; pieces hang together by vertices in the same place.
std::vector<std::uint32_t> vertex_of_each_piece(const Mesh& mesh);

/// Is the point, of the world, inside both parts, by the same rule?
bool is_common_point(const Vec3d& point, const AssemblyPart& a, const AssemblyPart& b);

}  // namespace cchip::assembly

#endif
