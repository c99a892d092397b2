// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far must a part be moved until it shares no volume with another?
#ifndef CCHIP_ASSEMBLY_PARTING_WAY_HPP
#define CCHIP_ASSEMBLY_PARTING_WAY_HPP

#include <cchip/assembly.hpp>
#include <cstddef>
#include <optional>
#include <vector>

namespace cchip::assembly {

/// The least translation of B along a normal of a face in contact, either way, or along a sum of two or three of those
/// of most contacts, after which the parts share no volume; none if no such translation is found. After it the parts
/// were looked at again, so it is a witness. \param enough the first one that is not longer is taken \param
/// most_normals how many are tried, those of most contacts first
std::optional<PartingWay> parting_way(const AssemblyPart& a, const AssemblyPart& b, double enough,
                                      std::size_t most_normals);

/// A translation of B that parts it from A, for people: the least that brings all of B past all of A along a normal of
/// some faces in contact or along an axis.
PartingWay rough_parting_way(const AssemblyPart& a, const AssemblyPart& b);

/// Normals of the faces in contact, of unit length, each direction and its opposite once; those of most contacts first.
std::vector<Vec3d> normals_of_contacts(const AssemblyPart& a, const AssemblyPart& b);

}  // namespace cchip::assembly

#endif
