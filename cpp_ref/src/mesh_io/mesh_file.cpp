// SPDX-License-Identifier: Apache-2.0
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cchip/mesh_io/mesh_file.hpp>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <vector>

namespace cchip {
namespace {

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::replace(text.begin(), text.end(), '\r', ' ');
  return text;
}

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw std::runtime_error(path + ": " + one_line(what) + ": repair the file");
}

/// Refuses what importers let through from damaged files: triangulation stops the whole program on faces
/// without vertices and does not check indices.
void require_intact(const aiMesh& part, const std::string& path) {
  const std::string of_part = part.mName.length == 0 ? "" : std::string(" of part \"") + part.mName.C_Str() + "\"";
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& p = part.mVertices[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      refuse(path, "vertex " + std::to_string(i) + of_part + " is not finite");
    }
  }
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    const auto is_known = [&part](unsigned vertex) { return vertex < part.mNumVertices; };
    if (face.mNumIndices == 0 || !std::all_of(face.mIndices, face.mIndices + face.mNumIndices, is_known)) {
      refuse(path, "face " + std::to_string(i) + of_part + " has no or unknown vertices");
    }
  }
}

/// True if no corner of the outline turns against the quad's normal (V2 - V0) x (V3 - V1).
bool is_convex_quad(const aiMesh& part, const aiFace& face) {
  if (face.mNumIndices != 4) return false;
  std::array<Vec3d, 4> v;
  for (std::size_t i = 0; i < 4; ++i) {
    const aiVector3D& p = part.mVertices[face.mIndices[i]];
    v[i] = Vec3d(p.x, p.y, p.z);
  }
  const Vec3d normal = (v[2] - v[0]).cross(v[3] - v[1]);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d& corner = v[(i + 1) % 4];
    if ((corner - v[i]).cross(v[(i + 2) % 4] - corner).dot(normal) < 0) return false;
  }
  return true;
}

std::size_t count_polygons(const aiMesh& part) {
  return static_cast<std::size_t>(std::count_if(part.mFaces, part.mFaces + part.mNumFaces,
                                                [](const aiFace& face) { return face.mNumIndices > 3; }));
}

/// The faces of one sub-mesh that triangulation would cut although they are to be kept. They leave a point in
/// their place, which triangulation does not touch.
struct KeptQuads {
  /// For each point of the sub-mesh, in order: the quad behind it, or nothing if it always was a point.
  std::vector<std::optional<std::array<std::uint32_t, 4>>> behind_point;
};

KeptQuads take_quads(aiMesh& part) {
  KeptQuads kept;
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    aiFace& face = part.mFaces[i];
    if (face.mNumIndices == 1) kept.behind_point.emplace_back();
    if (!is_convex_quad(part, face)) continue;
    const unsigned* v = face.mIndices;
    const std::array<std::uint32_t, 4> quad = {v[0], v[1], v[2], v[3]};
    kept.behind_point.emplace_back(quad);
    face.mNumIndices = 1;
    part.mPrimitiveTypes |= aiPrimitiveType_POINT;
  }
  // triangulation stops the program where it expects polygons and finds none
  if (count_polygons(part) == 0) part.mPrimitiveTypes &= ~static_cast<unsigned>(aiPrimitiveType_POLYGON);
  return kept;
}

/// Appends the faces of one sub-mesh; its points and lines are dropped.
void append(const aiMesh& part, const KeptQuads& kept, const Eigen::Affine3d& placement, Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& p = part.mVertices[i];
    mesh.vertices.push_back(placement * Vec3d(p.x, p.y, p.z));
  }
  auto quad = kept.behind_point.begin();
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    const unsigned* v = face.mIndices;
    if (face.mNumIndices == 3) mesh.faces.push_back({Kind::tri, {first + v[0], first + v[1], first + v[2], 0}});
    if (face.mNumIndices != 1 || kept.behind_point.empty()) continue;
    if (const auto& q = *quad++) {
      mesh.faces.push_back({Kind::quad, {first + (*q)[0], first + (*q)[1], first + (*q)[2], first + (*q)[3]}});
    }
  }
}

Eigen::Affine3d to_eigen(const aiMatrix4x4& m) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.matrix().topRows<3>() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4;
  return result;
}

void append(const aiScene& scene, const std::vector<KeptQuads>& kept, const aiNode& node, const Eigen::Affine3d& parent,
            Mesh& mesh) {
  const Eigen::Affine3d placement = parent * to_eigen(node.mTransformation);
  if (!placement.matrix().allFinite()) {
    refuse(mesh.name, std::string("transformation of node \"") + node.mName.C_Str() + "\" is not finite");
  }
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    append(*scene.mMeshes[node.mMeshes[i]], kept.at(node.mMeshes[i]), placement, mesh);
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) append(scene, kept, *node.mChildren[i], placement, mesh);
}

}  // namespace

Mesh load_mesh(const std::string& path, FaceKinds kinds) {
  if (!std::filesystem::is_regular_file(path)) {
    throw std::runtime_error(path + ": no such file: check the path");
  }
  Mesh mesh;
  mesh.name = path;
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, 0);
  std::vector<KeptQuads> kept;
  if (scene != nullptr) {
    kept.resize(scene->mNumMeshes);
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
      require_intact(*scene->mMeshes[i], path);
      if (kinds == FaceKinds::triangles_and_quads) kept[i] = take_quads(*scene->mMeshes[i]);
      mesh.polygons_cut += count_polygons(*scene->mMeshes[i]);
    }
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  }
  if (scene == nullptr) {
    throw std::runtime_error(path + ": cannot be read as a mesh (" + one_line(importer.GetErrorString()) +
                             "): give an intact OBJ, STL, PLY or OFF file");
  }
  if (scene->mRootNode != nullptr) append(*scene, kept, *scene->mRootNode, Eigen::Affine3d::Identity(), mesh);
  if (mesh.faces.empty()) {
    throw std::runtime_error(path + ": holds no faces: give a mesh with triangles or polygons");
  }
  return mesh;
}

}  // namespace cchip
