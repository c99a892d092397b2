// SPDX-License-Identifier: Apache-2.0
/// \file
/// Files that are no mesh or no points of ours: what they are, and what to do.
#ifndef CCHIP_MESH_IO_OTHER_FORMATS_HPP
#define CCHIP_MESH_IO_OTHER_FORMATS_HPP

#include <string>
#include <string_view>

namespace cchip::mesh_io {

/// What to do with points where a mesh is wanted.
constexpr std::string_view points_come_first =
    "to ask about a point cloud, name it first, as A, and give --points (load_points())";

/// The end of a name in small letters, with its dot.
std::string extension_of(const std::string& name);

/// What a file is that is not read, and what to do, by its first bytes: "is a web page (HTML); download ...". Empty for
/// all others.
std::string not_read_by_content(std::string_view file, const std::string& name);

/// The same by the end of its name.
std::string not_read_by_name(const std::string& name);

/// The same, with the remedy for a file of points.
std::string no_points_by_name(const std::string& name);

/// Why a file that no reader of meshes knows may hold points, and what to do; empty if it does not look like points.
std::string points_not_mesh(std::string_view file, const std::string& name);

}  // namespace cchip::mesh_io

#endif
