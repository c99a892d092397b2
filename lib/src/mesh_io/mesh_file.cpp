// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cchip/mesh_file.hpp>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "file_content.hpp"
#include "mesh/cut_polygon.hpp"
#include "other_formats.hpp"
#include "polygon_soup.hpp"
#include "text.hpp"
#include "unpack.hpp"

namespace cchip {
namespace {

using mesh_io::FormatError;
using mesh_io::PolygonSoup;
using Reader = PolygonSoup (*)(std::string_view file, bool lenient);

/// A reader to which lenient makes no difference.
template <PolygonSoup (*read)(std::string_view file)>
PolygonSoup always(std::string_view file, bool) {
  return read(file);
}

struct Format {
  std::string_view name;
  std::string_view end;  ///< of a file's name
  Reader reader;
};
constexpr Format stl = {"STL", ".stl", always<mesh_io::read_stl>};
constexpr Format binary_stl = {"binary STL", ".stl", always<mesh_io::read_stl>};
constexpr Format ply = {"PLY", ".ply", always<mesh_io::read_ply>};
constexpr Format off = {"OFF", ".off", always<mesh_io::read_off>};

/// The format that the beginning of a file shows, regardless of its name; nothing for OBJ and for what is not known.
const Format* format_shown_by(std::string_view file) {
  if (mesh_io::is_binary_stl(file)) return &binary_stl;
  const std::string_view word = file.substr(0, file.find_first_of(" \t\r\n"));
  if (word == "ply") return &ply;
  if (word == "solid") return &stl;
  if (mesh_io::is_off_keyword(word)) return &off;
  return nullptr;
}

/// True if the first line that is no comment is one with which an OBJ begins.
bool begins_as_obj(std::string_view file) {
  mesh_io::Lines lines(file.substr(0, std::size_t{1} << 16), {true, false});
  if (!lines.next()) return false;
  constexpr std::array<std::string_view, 8> words = {"v", "vn", "vt", "o", "g", "s", "mtllib", "usemtl"};
  return std::find(words.begin(), words.end(), lines.words()[0]) != words.end();
}

/// The reader for the extension of a name, or else the one whose first word begins the file, or else nothing.
Reader reader_of(const std::string& path, std::string_view file) {
  const std::string end = mesh_io::extension_of(path);
  if (end == ".obj") return mesh_io::read_obj;
  if (end == ".off") return always<mesh_io::read_off>;
  if (end == ".ply") return always<mesh_io::read_ply>;
  if (end == ".stl") return always<mesh_io::read_stl>;
  const Format* shown = format_shown_by(file);
  if (shown != nullptr) return shown->reader;
  return begins_as_obj(file) ? mesh_io::read_obj : nullptr;
}

constexpr std::string_view gzip = "gzip";

/// The program that packed a file, by its first bytes; none of them is text.
std::string_view packer_of(std::string_view file) {
  using namespace std::string_view_literals;
  constexpr std::pair<std::string_view, std::string_view> packers[] = {{"\x1f\x8b"sv, gzip},
                                                                       {"PK\3\4"sv, "zip"},
                                                                       {"BZh"sv, "bzip2"},
                                                                       {"\xfd"
                                                                        "7zXZ\0"sv,
                                                                        "xz"},
                                                                       {"\x28\xb5\x2f\xfd"sv, "zstd"}};
  for (const auto& [begin, name] : packers) {
    if (!mesh_io::is_binary_stl(file) && file.substr(0, begin.size()) == begin) return name;
  }
  return {};
}

/// What to do about an error.
std::string remedy(const FormatError& error, Reader reader, std::string_view file) {
  const Format* shown = format_shown_by(file);
  if (shown != nullptr && shown->reader != reader) {
    return "; this looks like " + std::string(shown->name) + ": let the name end with " + std::string(shown->end);
  }
  if (!error.remedy.empty()) return "; " + std::string(error.remedy);
  return std::string_view(error.what()).find("; ") == std::string_view::npos ? "; repair the file or write it again"
                                                                             : "";
}

/// Adds the polygons of a file to a mesh one by one.
class Builder {
 public:
  Builder(PolygonSoup soup, const LoadOptions& options) : soup_(std::move(soup)), options_(options) {}

  Mesh build() {
    if (options_.single_precision) soup_.round_to_single();
    if (std::max(soup_.points.size(), soup_.polygons.size()) > std::numeric_limits<std::uint32_t>::max()) {
      throw FormatError("more than 2^32 vertices or faces are not read");
    }
    std::size_t begin = 0;
    for (std::size_t i = 0; i < soup_.polygons.size(); ++i) {
      const auto corners = soup_.corners.begin();
      polygon_.assign(corners + static_cast<std::ptrdiff_t>(begin),
                      corners + static_cast<std::ptrdiff_t>(soup_.polygons[i].end));
      try {
        add_polygon(i);
      } catch (const FormatError& error) {
        if (!options_.lenient) throw;
        leave_out(error);
      }
      begin = soup_.polygons[i].end;
    }
    if (options_.faces_left_out != nullptr) *options_.faces_left_out = faces_left_out_;
    if (faces_left_out_ > 0) {
      soup_.notes.push_back(std::to_string(faces_left_out_) + " faces were left out because they cannot be used");
    }
    if (mesh_.faces.empty()) refuse_empty();
    if (mesh_.polygons_cut == 0 && !left_out_) mesh_.file_face.clear();
    mesh_.vertices = std::move(soup_.points);
    for (const auto& [point, why] : soup_.unusable) {
      if (!mesh_.vertices[point].allFinite()) mesh_.vertices[point].setZero();  // no face uses it
    }
    mesh_.notes = std::move(soup_.notes);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void refuse_empty() const {
    const std::string vertices = std::to_string(soup_.points.size());
    const bool cloud = soup_.polygons.empty() && !soup_.points.empty();
    throw FormatError("the file holds no faces" +
                      (cloud ? ", only " + vertices + " vertices; " + std::string(mesh_io::points_come_first) : ""));
  }

  void add_polygon(std::size_t number) {
    const auto bad = soup_.bad_polygons.find(number);
    if (bad != soup_.bad_polygons.end()) throw FormatError(bad->second, soup_.polygons[number].line);
    for (const std::uint32_t corner : polygon_) {
      if (corner < soup_.points.size()) continue;
      refuse(number, ": vertex index " + std::to_string(corner + soup_.first_index()) +
                         " is out of range (the mesh has " + std::to_string(soup_.points.size()) + " vertices)");
    }
    if (polygon_.size() < 3) {
      left_out_ = true;
      return;
    }
    outline_.clear();
    for (const std::uint32_t corner : polygon_) {
      if (!soup_.unusable.empty()) check_usable(number, corner);
      outline_.push_back(soup_.points[corner]);
    }
    const outline::Faces made = outline::faces_of(outline_, options_.kinds == FaceKinds::triangles_and_quads);
    if (!made.error.empty()) refuse(number, made.error);
    mesh_.polygons_cut += made.cut;
    for (const outline::Faces::Face& from : made.faces) {
      Mesh::Face face;
      face.kind = from.kind;
      const std::size_t count = from.kind == Kind::quad ? 4 : 3;
      for (std::size_t i = 0; i < count; ++i) face.vertex[i] = polygon_[from.corner[i]];
      mesh_.faces.push_back(face);
      mesh_.file_face.push_back(static_cast<std::uint32_t>(number));
    }
  }

  /// Notes why a face cannot be used: the first ones one by one, all by their number.
  void leave_out(const FormatError& error) {
    constexpr std::size_t most_notes = 100;
    left_out_ = true;
    if (++faces_left_out_ > most_notes) return;
    const std::string line = error.line == 0 ? "" : "line " + std::to_string(error.line) + ": ";
    soup_.notes.push_back(line + error.what());
  }

  void check_usable(std::size_t number, std::uint32_t corner) const {
    const auto found = soup_.unusable.find(corner);
    if (found == soup_.unusable.end()) return;
    throw FormatError("vertex " + std::to_string(corner) + " " + found->second.what + ", and face " +
                          std::to_string(number) + " uses it",
                      found->second.line);
  }

  [[noreturn]] void refuse(std::size_t number, const std::string& what) const {
    throw FormatError("face " + std::to_string(number) + what, soup_.polygons[number].line);
  }

  PolygonSoup soup_;
  LoadOptions options_;
  std::vector<std::uint32_t> polygon_;  ///< the present one
  std::vector<Vec3d> outline_;          ///< its corners
  bool left_out_ = false;               ///< some polygons are no faces
  std::size_t faces_left_out_ = 0;      ///< because they cannot be used
  Mesh mesh_;
};

LoadOptions options_for(FaceKinds kinds) {
  LoadOptions options;
  options.kinds = kinds;
  return options;
}

}  // namespace

void round_to_single(Mesh& mesh) {
  const std::size_t bad = mesh_io::round_to_single(mesh.vertices);
  if (bad == mesh.vertices.size()) return;
  throw std::invalid_argument("round_to_single: vertex " + std::to_string(bad) +
                              " is beyond the range of single precision; keep its doubles");
}

Mesh load_mesh(const std::string& path, FaceKinds kinds) { return load_mesh(path, options_for(kinds)); }

Mesh load_mesh(const std::string& path, const LoadOptions& options) {
  return parse_mesh(mesh_io::read_file(path, "mesh"), path, options);
}

Mesh parse_mesh(std::string_view file, const std::string& name, FaceKinds kinds) {
  return parse_mesh(file, name, options_for(kinds));
}

namespace {

/// About a file that no reader takes.
std::string why_no_mesh(std::string_view file, const std::string& name) {
  std::string why = mesh_io::not_read_by_name(name);
  if (why.empty()) why = mesh_io::points_not_mesh(file, name);
  return why.empty() ? "cannot be read as a mesh; give an OBJ, OFF, PLY or STL file" : why;
}

/// \param name of the file; its extension says the format, messages begin with `path`
Mesh parse_unpacked(std::string_view content, const std::string& name, const std::string& path,
                    const LoadOptions& options) {
  const std::string_view file = mesh_io::is_binary_stl(content) ? content : mesh_io::without_mark(content);
  if (const std::string why = mesh_io::not_read_by_content(file, name); !why.empty()) {
    throw std::runtime_error(path + ": " + why);
  }
  const std::string format_not_read = mesh_io::not_read_by_name(name);
  if (const std::string_view packer = packer_of(file); !packer.empty()) {
    // Some formats, such as 3MF, are packed folders: unpacking them would not help.
    throw std::runtime_error(
        path + ": " +
        (format_not_read.empty() ? "is packed with " + std::string(packer) + "; unpack it first" : format_not_read));
  }
  const Reader reader = reader_of(name, file);
  if (reader == nullptr) throw std::runtime_error(path + ": " + why_no_mesh(file, name));
  try {
    Mesh mesh = Builder(reader(file, options.lenient), options).build();
    mesh.name = path;
    return mesh;
  } catch (const FormatError& error) {
    const std::string line = error.line == 0 ? "" : std::to_string(error.line) + ": ";
    throw std::runtime_error(path + ":" + (line.empty() ? " " : line) + error.what() + remedy(error, reader, file));
  }
}

}  // namespace

Mesh parse_mesh(std::string_view file, const std::string& name, const LoadOptions& options) {
  if (packer_of(file) != gzip || !mesh_io::can_unpack_gzip()) return parse_unpacked(file, name, name, options);
  std::string content;
  try {
    content = mesh_io::unpack_gzip(file, options.most_unpacked_bytes);
  } catch (const FormatError& error) {
    throw std::runtime_error(name + ": " + error.what());
  }
  if (content.empty()) throw std::runtime_error(name + ": the gzip file holds nothing; pack a mesh file");
  return parse_unpacked(content, mesh_io::name_inside(name), name, options);
}

}  // namespace cchip
