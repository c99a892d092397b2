// SPDX-License-Identifier: Apache-2.0
#include "mesh_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cchip/mesh_file.hpp>
#include <cchip/program/usage_error.hpp>
#include <filesystem>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace cchip::app {
namespace {

constexpr Colour grey_a = {216, 218, 222};
constexpr Colour grey_b = {188, 194, 204};
constexpr Colour orange = {235, 94, 40};
constexpr Colour blue = {30, 110, 210};
constexpr Colour yellow = {245, 190, 50};
constexpr Colour cyan = {110, 200, 225};
constexpr Colour black = {20, 20, 20};

/// Faces in colour: those that hit, and those that only touch.
struct Coloured {
  const std::set<std::size_t>& hits;
  Colour hit;
  const std::set<std::size_t>& touches;
  Colour touch;
  Colour other;
};

void append(const Mesh& mesh, const Coloured& x, Mesh& all, std::vector<Colour>& colours) {
  const auto first = static_cast<std::uint32_t>(all.vertices.size());
  all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    Mesh::Face face = mesh.faces[i];
    for (std::uint32_t& vertex : face.vertex) vertex += first;
    all.faces.push_back(face);
    colours.push_back(x.hits.count(i) != 0 ? x.hit : x.touches.count(i) != 0 ? x.touch : x.other);
  }
}

Mesh read_standard_input(std::istream& in, const LoadOptions& options) {
  const std::string text = read_all(in);
  if (text.empty()) throw UsageError("-: standard input is empty; send a mesh");
  return parse_mesh(text, "-", options);
}

}  // namespace

std::string read_all(std::istream& in) { return {std::istreambuf_iterator<char>(in), {}}; }

Mesh MeshReader::read(const std::string& path) {
  std::size_t left_out = 0;
  LoadOptions options;
  options.kinds = FaceKinds::triangles_and_quads;
  options.lenient = lenient_;
  options.single_precision = single_;
  options.faces_left_out = &left_out;
  try {
    Mesh mesh = path == "-" ? read_standard_input(streams_.in, options) : load_mesh(path, options);
    faces_left_out_ += left_out;
    if (mesh.polygons_cut > 0) {
      streams_.err << fmt::format("cchip: {}: {} faces with more than four corners or a dent were cut into triangles\n",
                                  path, mesh.polygons_cut);
    }
    for (const std::string& note : mesh.notes) streams_.err << fmt::format("cchip: {}: {}\n", path, note);
    return mesh;
  } catch (const std::runtime_error& error) {
    throw UsageError(error.what());
  }
}

Object MeshReader::read_object(const std::string& path) {
  Mesh mesh = read(path);
  try {
    return Object(std::move(mesh));
  } catch (const std::invalid_argument& error) {
    throw UsageError(path + ": " + error.what());
  }
}

void check_standard_input(const std::vector<std::string>& paths) {
  if (std::count(paths.begin(), paths.end(), "-") > 1) {
    throw UsageError("-: standard input can be read once only; name a file for all but one");
  }
}

void check_picture_name(const std::string& path) {
  const std::string end = std::filesystem::path(path).extension().string();
  if (end.empty() || end == ".ply" || end == ".PLY") return;
  throw UsageError(fmt::format("--ply {}: the picture is a PLY file; give a name that ends with .ply", path));
}

const std::vector<std::string>& mesh_pair_names() {
  static const std::vector<std::string> names = {"face_a", "face_b"};
  return names;
}

void HitPicture::add_curve(const std::vector<Vec3d>& points, bool closed) {
  curves_.push_back({points, closed, black});
}

void HitPicture::write(const Mesh& a, const Mesh& b) {
  Mesh all;
  std::vector<Colour> colours;
  append(a, {hits_a_, orange, touches_a_, yellow, grey_a}, all, colours);
  append(b, {hits_b_, blue, touches_b_, cyan, grey_b}, all, colours);
  write_ply(file_.stream(), all, colours, curves_);
  file_.commit();
}

}  // namespace cchip::app
