// SPDX-License-Identifier: Apache-2.0
#include "obj_parts.hpp"

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "mesh_io/file_content.hpp"
#include "mesh_io/polygon_soup.hpp"
#include "mesh_io/text.hpp"
#include "mesh_io/unpack.hpp"

namespace cchip::assembly {
namespace {

struct Section {
  std::string name;
  std::size_t line;       ///< of its `o`; 0: before the first
  std::size_t faces_end;  ///< the number of faces of it and of those before it
};

/// Where each `o` begins, with the number of faces of the file up to its end.
std::vector<Section> sections_of(std::string_view file) {
  std::vector<Section> sections = {{"", 0, 0}};
  mesh_io::Lines lines(file, {true, true});
  std::size_t faces = 0;
  while (lines.next()) {
    const std::string_view statement = lines.words()[0];
    if (statement == "f" || statement == "fo") sections.back().faces_end = ++faces;
    if (statement != "o") continue;
    std::string name;
    for (std::size_t i = 1; i < lines.words().size(); ++i) {
      name += (i > 1 ? " " : "") + std::string(lines.words()[i]);
    }
    sections.push_back({name, lines.number(), faces});
  }
  return sections;
}

/// The next faces of a mesh, those with numbers below `end` in the file, with their vertices.
/// \param face the first that is not taken yet; moved on
Mesh take_faces(const Mesh& all, std::size_t& face, std::size_t end) {
  Mesh part;
  part.name = all.name;
  std::unordered_map<std::uint32_t, std::uint32_t> vertices;
  for (; face < all.faces.size(); ++face) {
    const std::uint32_t number = all.number_in_file(static_cast<std::uint32_t>(face));
    if (number >= end) break;
    Mesh::Face taken = all.faces[face];
    for (std::size_t i = 0; i < static_cast<std::size_t>(taken.kind); ++i) {
      const std::uint32_t vertex = taken.vertex[i];
      const auto [place, is_new] = vertices.emplace(vertex, static_cast<std::uint32_t>(part.vertices.size()));
      if (is_new) part.vertices.push_back(all.vertices[vertex]);
      taken.vertex[i] = place->second;
    }
    part.faces.push_back(taken);
    part.file_face.push_back(number);
  }
  return part;
}

std::string unpacked(std::string content, const std::string& path, std::uint64_t most_bytes) {
  if (mesh_io::name_inside(path) == path || !mesh_io::can_unpack_gzip()) return content;
  try {
    return mesh_io::unpack_gzip(content, most_bytes);
  } catch (const mesh_io::FormatError& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

}  // namespace

std::vector<ObjPart> load_obj_parts(const std::string& path, const LoadOptions& options,
                                    std::vector<std::string>& notes) {
  const std::string file = unpacked(mesh_io::read_file(path, "mesh"), path, options.most_unpacked_bytes);
  const Mesh all = parse_mesh(file, mesh_io::name_inside(path), options);
  for (const std::string& note : all.notes) notes.push_back(path + ": " + note);
  std::vector<ObjPart> parts;
  std::size_t face = 0;
  for (const Section& section : sections_of(mesh_io::without_mark(file))) {
    Mesh mesh = take_faces(all, face, section.faces_end);
    if (!mesh.faces.empty()) {
      parts.push_back({section.name, std::move(mesh)});
    } else if (section.line != 0) {
      throw std::runtime_error(path + ":" + std::to_string(section.line) + ": the part '" + section.name +
                               "' has no faces, so nothing can be said about it; remove this line or add its faces");
    }
  }
  return parts;
}

}  // namespace cchip::assembly
