// SPDX-License-Identifier: Apache-2.0
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cchip/mesh.hpp>
#include <filesystem>
#include <stdexcept>

namespace cchip {
namespace {

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::replace(text.begin(), text.end(), '\r', ' ');
  return text;
}

/// Appends the triangles of one sub-mesh; its points and lines are dropped.
void append(const aiMesh& part, const Eigen::Affine3d& placement, Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& p = part.mVertices[i];
    const Vec3d vertex = placement * Vec3d(p.x, p.y, p.z);
    if (!vertex.allFinite()) {
      throw std::runtime_error(mesh.name + ": vertex " + std::to_string(i) + " of part \"" +
                               one_line(part.mName.C_Str()) + "\" is not finite: repair the file");
    }
    mesh.vertices.push_back(vertex);
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
  for (unsigned i = 0; i < node.mNumMeshes; ++i) append(*scene.mMeshes[node.mMeshes[i]], placement, mesh);
  for (unsigned i = 0; i < node.mNumChildren; ++i) append(scene, *node.mChildren[i], placement, mesh);
}

}  // namespace

Mesh load_mesh(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) {
    throw std::runtime_error(path + ": no such file: check the path");
  }
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr) {
    throw std::runtime_error(path + ": cannot be read as a mesh (" + one_line(importer.GetErrorString()) +
                             "): give an intact OBJ, STL, PLY or OFF file");
  }
  Mesh mesh;
  mesh.name = path;
  if (scene->mRootNode != nullptr) append(*scene, *scene->mRootNode, Eigen::Affine3d::Identity(), mesh);
  if (mesh.faces.empty()) {
    throw std::runtime_error(path + ": holds no faces: give a mesh with triangles or polygons");
  }
  return mesh;
}

}  // namespace cchip
