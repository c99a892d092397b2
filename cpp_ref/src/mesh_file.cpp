// SPDX-License-Identifier: Apache-2.0
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cchip/mesh.hpp>
#include <cmath>
#include <filesystem>
#include <stdexcept>

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

/// Appends the triangles of one sub-mesh; its points and lines are dropped.
void append(const aiMesh& part, const Eigen::Affine3d& placement, Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& p = part.mVertices[i];
    mesh.vertices.push_back(placement * Vec3d(p.x, p.y, p.z));
  }
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;
    const unsigned* vertex = face.mIndices;
    mesh.faces.push_back({Kind::tri, {first + vertex[0], first + vertex[1], first + vertex[2], 0}});
  }
}

Eigen::Affine3d to_eigen(const aiMatrix4x4& m) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.matrix().topRows<3>() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4;
  return result;
}

void append(const aiScene& scene, const aiNode& node, const Eigen::Affine3d& parent, Mesh& mesh) {
  const Eigen::Affine3d placement = parent * to_eigen(node.mTransformation);
  if (!placement.matrix().allFinite()) {
    refuse(mesh.name, std::string("transformation of node \"") + node.mName.C_Str() + "\" is not finite");
  }
  for (unsigned i = 0; i < node.mNumMeshes; ++i) append(*scene.mMeshes[node.mMeshes[i]], placement, mesh);
  for (unsigned i = 0; i < node.mNumChildren; ++i) append(scene, *node.mChildren[i], placement, mesh);
}

}  // namespace

Mesh load_mesh(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) {
    throw std::runtime_error(path + ": no such file: check the path");
  }
  Mesh mesh;
  mesh.name = path;
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene != nullptr) {
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) require_intact(*scene->mMeshes[i], path);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  }
  if (scene == nullptr) {
    throw std::runtime_error(path + ": cannot be read as a mesh (" + one_line(importer.GetErrorString()) +
                             "): give an intact OBJ, STL, PLY or OFF file");
  }
  if (scene->mRootNode != nullptr) append(*scene, *scene->mRootNode, Eigen::Affine3d::Identity(), mesh);
  if (mesh.faces.empty()) {
    throw std::runtime_error(path + ": holds no faces: give a mesh with triangles or polygons");
  }
  return mesh;
}

}  // namespace cchip
