// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cchip/internal/geometry/rotation.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gltf_file.hpp"
#include "placed_meshes.hpp"

namespace cchip::assembly {
namespace {

constexpr const char* instancing = "EXT_mesh_gpu_instancing";
constexpr const char* draco = "KHR_draco_mesh_compression";

/// Does a reader of shapes read all of the extension, or may it pass over it?
bool is_known(const std::string& extension) {
  constexpr std::array<const char*, 3> read = {instancing, "KHR_mesh_quantization", "KHR_node_visibility"};
  if (std::find(read.begin(), read.end(), extension) != read.end()) return true;
  constexpr std::array<const char*, 5> of_looks = {"KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_",
                                                   "MSFT_texture_"};
  return std::any_of(of_looks.begin(), of_looks.end(),
                     [&](const std::string& begin) { return extension.compare(0, begin.size(), begin) == 0; });
}

/// Translation, rotation and scale as a map. \returns nothing if the quaternion has no length
std::optional<Pose> pose_of(const Vec3d& translation, const std::array<double, 4>& quaternion, const Vec3d& scale) {
  const std::optional<Eigen::Matrix3d> rotation = rotation_of(quaternion);
  if (!rotation) return std::nullopt;
  Pose pose = Pose::Identity();
  pose.linear() = *rotation * scale.asDiagonal();
  pose.translation() = translation;
  return pose;
}

Vec3d vector_at(const std::vector<double>& values, std::size_t number, const Vec3d& if_empty) {
  if (values.empty()) return if_empty;
  return {values[3 * number], values[3 * number + 1], values[3 * number + 2]};
}

std::array<double, 4> quaternion_at(const std::vector<double>& values, std::size_t number) {
  if (values.empty()) return {0, 0, 0, 1};
  return {values[4 * number], values[4 * number + 1], values[4 * number + 2], values[4 * number + 3]};
}

std::string times(std::size_t count, const std::string& one, const std::string& several) {
  return std::to_string(count) + " " + (count == 1 ? one : several);
}

class GltfReader {
 public:
  GltfReader(const std::string& path, std::uint64_t most_bytes)
      : file_(path, most_bytes),
        nodes_(file_.root().tables("nodes", "node")),
        meshes_(file_.root().tables("meshes", "mesh")),
        scenes_(file_.root().tables("scenes", "scene")),
        accessors_(file_.root().tables("accessors", "accessor")),
        seen_(nodes_.size(), false),
        mesh_of_(meshes_.size()) {}

  PlacedMeshes read() {
    check_extensions();
    result_.unit = "m";
    const std::size_t scene = chosen_scene();
    walk(file_.member(scenes_, scene, "scene", "the file").wholes("nodes"));
    note_what_is_outside(scene);
    const std::size_t animations = file_.root().tables("animations", "animation").size();
    if (animations > 0) {
      note(times(animations, "animation is", "animations are") +
           " left out: parts are where the nodes place them without");
    }
    if (result_.parts.empty()) {
      file_.refuse("scene " + std::to_string(scene) +
                   " holds no triangle, so nothing can be said about it; export the file with its meshes");
    }
    return std::move(result_);
  }

 private:
  /// A node that is to be visited, and where its parent is.
  struct Visit {
    std::size_t node;
    std::string path;  ///< of the names of those above it
    Pose pose;
    bool visible;
  };

  void note(const std::string& text) { result_.notes.push_back(text); }

  void check_extensions() const {
    for (const std::string& name : file_.root().texts("extensionsRequired")) {
      if (is_known(name)) continue;
      file_.refuse("needs the extension " + one_line(name) + ", which is not read; export it without");
    }
  }

  std::size_t chosen_scene() {
    const std::optional<std::size_t> scene = file_.root().whole("scene");
    if (scenes_.empty()) file_.refuse("holds no scene, so nothing is placed; export it with one");
    if (!scene && scenes_.size() > 1) {
      note("holds " + std::to_string(scenes_.size()) + " scenes and does not say which; scene 0 is judged");
    }
    return scene.value_or(0);
  }

  void walk(const std::vector<std::size_t>& roots) {
    std::vector<Visit> waiting;
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) {
      waiting.push_back({*root, "", Pose::Identity(), true});
    }
    while (!waiting.empty()) {
      const Visit visit = std::move(waiting.back());
      waiting.pop_back();
      const JsonTable& node = file_.member(nodes_, visit.node, "node", "the tree of nodes");
      if (seen_[visit.node]) node.refuse("is there twice in the tree of nodes; give each node one parent");
      seen_[visit.node] = true;
      const std::string name = one_line(node.text("name"));
      const std::string own = name.empty() ? "node" + std::to_string(visit.node) : name;
      const std::string path = visit.path.empty() ? own : visit.path + "/" + own;
      file_.spend(1, bytes_of_part + path.size(), node.who());
      const std::optional<JsonTable> visibility = node.extension("KHR_node_visibility");
      const bool visible = visit.visible && (!visibility || visibility->flag("visible", true));
      const Pose pose = visit.pose * node_pose(node);
      if (node.has("mesh")) add_node(node, path, pose, visible);
      const std::vector<std::size_t> children = node.wholes("children");
      for (auto child = children.rbegin(); child != children.rend(); ++child) {
        waiting.push_back({*child, path, pose, visible});
      }
    }
  }

  static Pose node_pose(const JsonTable& node) {
    if (node.has("matrix")) {
      const std::vector<double> x = node.numbers("matrix", 16);
      if (!(x[3] == 0 && x[7] == 0 && x[11] == 0 && x[15] == 1)) {
        node.refuse("'matrix' must have 0, 0, 0, 1 as its last row, and is stored column by column; export it anew");
      }
      Pose pose = Pose::Identity();
      for (Eigen::Index column = 0; column < 4; ++column) {
        for (Eigen::Index row = 0; row < 3; ++row) {
          pose.matrix()(row, column) = x[static_cast<std::size_t>(4 * column + row)];
        }
      }
      return pose;
    }
    const std::vector<double> translation = node.numbers("translation", 3);
    const std::vector<double> rotation = node.numbers("rotation", 4);
    const std::vector<double> scale = node.numbers("scale", 3);
    const std::optional<Pose> pose = pose_of(vector_at(translation, 0, Vec3d::Zero()), quaternion_at(rotation, 0),
                                             vector_at(scale, 0, Vec3d::Ones()));
    if (!pose) node.refuse("'rotation' has no length that can be used; write x, y, z, w of a rotation");
    return *pose;
  }

  void add_node(const JsonTable& node, const std::string& path, const Pose& pose, bool visible) {
    const std::size_t number = node.required_whole("mesh");
    const JsonTable& mesh = file_.member(meshes_, number, "mesh", node.who());
    if (node.has("skin")) {
      node.refuse("has a skin, whose joints move its vertices, which is not read; apply the armature and export anew");
    }
    check_weights(node, mesh);
    const std::optional<std::size_t> made = mesh_number(number);
    if (!made) return;
    if (!visible) note("part '" + path + "' is hidden, and judged as the others");
    const std::optional<JsonTable> instances = node.extension(instancing);
    if (instances) {
      add_instances(*instances, path, *made, pose);
    } else {
      add_part(node, path, *made, pose);
    }
  }

  void add_part(const JsonTable& node, const std::string& path, std::size_t mesh, const Pose& pose) {
    const std::string wrong = wrong_with(pose);
    if (!wrong.empty()) node.refuse(wrong);
    result_.parts.push_back({path, mesh, pose});
  }

  static void check_weights(const JsonTable& node, const JsonTable& mesh) {
    const std::vector<double> weights = (node.has("weights") ? node : mesh).numbers("weights");
    if (std::any_of(weights.begin(), weights.end(), [](double weight) { return weight != 0; })) {
      node.refuse("has a morph target with a weight other than 0, which is not read; apply it and export anew");
    }
  }

  void add_instances(const JsonTable& instances, const std::string& path, std::size_t mesh, const Pose& pose) {
    const std::optional<JsonTable> attributes = instances.table("attributes");
    std::size_t count = 0;
    const auto values = [&](const char* name, std::size_t components) {
      std::vector<double> all;
      if (!attributes || !attributes->has(name)) return all;
      all = file_.accessor(attributes->required_whole(name), components, GltfFile::Use::floats, instances.who());
      if (count != 0 && all.size() != count * components) {
        instances.refuse("its attributes have different counts; export the file anew");
      }
      count = all.size() / components;
      return all;
    };
    const std::vector<double> translation = values("TRANSLATION", 3);
    const std::vector<double> rotation = values("ROTATION", 4);
    const std::vector<double> scale = values("SCALE", 3);
    if (count == 0) {
      instances.refuse("has none of TRANSLATION, ROTATION and SCALE; export the file without the extension");
    }
    file_.spend(count, bytes_of_part + path.size(), instances.who());
    for (std::size_t i = 0; i < count; ++i) {
      const std::optional<Pose> own = pose_of(vector_at(translation, i, Vec3d::Zero()), quaternion_at(rotation, i),
                                              vector_at(scale, i, Vec3d::Ones()));
      if (!own) instances.refuse("ROTATION " + std::to_string(i) + " has no length; export the file anew");
      add_part(instances, path, mesh, pose * *own);
    }
  }

  /// The number of the mesh in the result; nothing if it has no triangle.
  std::optional<std::size_t> mesh_number(std::size_t number) {
    if (mesh_of_[number]) return *mesh_of_[number] == none ? std::nullopt : mesh_of_[number];
    Mesh mesh;
    mesh.name = file_.path();
    const JsonTable& json = meshes_[number];
    std::size_t left_out = 0;
    for (const JsonTable& primitive : json.tables("primitives", "primitive")) {
      if (!add_primitive(primitive, mesh)) ++left_out;
    }
    if (left_out > 0) {
      note(json.who() + ": " + times(left_out, "primitive", "primitives") + " of points or lines left out");
    }
    if (mesh.faces.empty()) {
      note(json.who() + " has no triangle, so its nodes are no parts");
      mesh_of_[number] = none;
      return std::nullopt;
    }
    mesh_of_[number] = result_.meshes.size();
    result_.meshes.push_back(std::move(mesh));
    return mesh_of_[number];
  }

  /// False if it holds points or lines.
  bool add_primitive(const JsonTable& primitive, Mesh& mesh) {
    const std::size_t mode = primitive.whole("mode", 4);
    if (mode < 4) return false;
    if (mode > 6) primitive.refuse("'mode' " + std::to_string(mode) + " is none of glTF; export the file anew");
    const std::optional<JsonTable> attributes = primitive.table("attributes");
    const std::optional<std::size_t> position = attributes ? attributes->whole("POSITION") : std::nullopt;
    if (!position) primitive.refuse("has no POSITION; export the file anew");
    if (primitive.extension(draco) && !has_data(*position)) {
      primitive.refuse(std::string("is packed by ") + draco + ", which is not read; export it without");
    }
    const std::vector<double> points = file_.accessor(*position, 3, GltfFile::Use::numbers, primitive.who());
    const std::size_t first = mesh.vertices.size();
    const std::size_t count = points.size() / 3;
    if (count > UINT32_MAX - first) primitive.refuse("has too many vertices; split the file");
    for (std::size_t i = 0; i < count; ++i) mesh.vertices.push_back(vector_at(points, i, Vec3d::Zero()));
    add_triangles(primitive, mode, corners_of(primitive, count), first, mesh);
    return true;
  }

  bool has_data(std::size_t accessor) const {
    return accessor < accessors_.size() && accessors_[accessor].has("bufferView");
  }

  std::vector<double> corners_of(const JsonTable& primitive, std::size_t count) {
    if (const std::optional<std::size_t> number = primitive.whole("indices")) {
      std::vector<double> corners = file_.accessor(*number, 1, GltfFile::Use::indices, primitive.who());
      for (const double corner : corners) {
        if (corner < static_cast<double>(count)) continue;
        primitive.refuse("names vertex " + std::to_string(static_cast<std::uint64_t>(corner)) + ", and there are " +
                         std::to_string(count) + "; export the file anew");
      }
      return corners;
    }
    file_.spend(count, sizeof(double), primitive.who());
    std::vector<double> corners(count);
    for (std::size_t i = 0; i < count; ++i) corners[i] = static_cast<double>(i);
    return corners;
  }

  void add_triangles(const JsonTable& primitive, std::size_t mode, const std::vector<double>& corners,
                     std::size_t first, Mesh& mesh) {
    const std::size_t count = corners.size();
    if (mode == 4 ? count % 3 != 0 : count < 3) {
      primitive.refuse("has " + std::to_string(count) + " corners, which make no triangles; export the file anew");
    }
    const std::size_t triangles = mode == 4 ? count / 3 : count - 2;
    file_.spend(triangles, sizeof(Mesh::Face), primitive.who());
    for (std::size_t i = 0; i < triangles; ++i) {
      std::array<std::size_t, 3> of = {3 * i, 3 * i + 1, 3 * i + 2};
      if (mode == 5) of = {i, i + 1 + i % 2, i + 2 - i % 2};
      if (mode == 6) of = {i + 1, i + 2, 0};
      Mesh::Face face;
      for (std::size_t k = 0; k < 3; ++k)
        face.vertex[k] = static_cast<std::uint32_t>(first + std::size_t(corners[of[k]]));
      const auto& v = face.vertex;
      const bool is_seam = v[0] == v[1] || v[1] == v[2] || v[2] == v[0];  // strips jump by triangles without area
      if (!(mode != 4 && is_seam)) mesh.faces.push_back(face);
    }
  }

  void note_what_is_outside(std::size_t scene) {
    std::size_t outside = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (!seen_[i] && nodes_[i].has("mesh")) ++outside;
    }
    if (outside == 0) return;
    note(times(outside, "node with a mesh is", "nodes with meshes are") + " outside scene " + std::to_string(scene) +
         " and left out");
  }

  static constexpr std::size_t none = SIZE_MAX;
  GltfFile file_;
  std::vector<JsonTable> nodes_;
  std::vector<JsonTable> meshes_;
  std::vector<JsonTable> scenes_;
  std::vector<JsonTable> accessors_;
  std::vector<bool> seen_;
  std::vector<std::optional<std::size_t>> mesh_of_;  ///< numbers in the result, by those of the file
  PlacedMeshes result_;
};

}  // namespace

PlacedMeshes read_gltf(const std::string& path, std::uint64_t most_bytes) {
  return GltfReader(path, most_bytes).read();
}

}  // namespace cchip::assembly
