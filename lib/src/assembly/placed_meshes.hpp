// SPDX-License-Identifier: Apache-2.0
/// \file
/// What glTF and 3MF files hold: meshes, and where they are placed.
#ifndef CCHIP_ASSEMBLY_PLACED_MESHES_HPP
#define CCHIP_ASSEMBLY_PLACED_MESHES_HPP

#include <Eigen/LU>
#include <cchip/mesh.hpp>
#include <cchip/pose.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cchip::assembly {

struct PlacedMeshes {
  std::string unit;
  std::vector<Mesh> meshes;
  struct Part {
    std::string name;  ///< not unique
    std::size_t mesh;  ///< its number in `meshes`
    Pose pose;
  };
  std::vector<Part> parts;
  std::vector<std::string> notes;  ///< what was left out, or chosen, a line each
};

/// A bound on the memory that a small file may ask for.
class Allowance {
 public:
  explicit Allowance(std::uint64_t bytes) : left_(bytes) {}
  /// False if there are not so many left.
  bool spend(std::uint64_t count, std::uint64_t bytes_each) {
    if (bytes_each != 0 && count > left_ / bytes_each) return false;
    left_ -= count * bytes_each;
    return true;
  }

 private:
  std::uint64_t left_;
};

/// What a placed mesh takes, about.
constexpr std::uint64_t bytes_of_part = 512;

/// What is wrong with a pose, and what to do; empty: nothing.
inline std::string wrong_with(const Pose& pose) {
  const auto& numbers = pose.matrix();
  if (!numbers.allFinite() || numbers.cwiseAbs().maxCoeff() > 0x1p400) {
    return "its pose has a number beyond 2^400; write a smaller one";
  }
  if (pose.linear().determinant() == 0) {
    return "its pose flattens space, the determinant is 0; scale it by other numbers than 0, or remove it";
  }
  return "";
}

/// A name on one line.
inline std::string one_line(std::string name) {
  for (char& c : name) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return name;
}

/// The nodes with meshes of the chosen scene of a glTF or GLB, in the order of the tree.
/// \throws std::runtime_error one line: file, what is wrong, what to do; also if it holds no triangle
PlacedMeshes read_gltf(const std::string& path, std::uint64_t most_bytes);

/// The meshes of a 3MF, as its build places them.
/// \throws std::runtime_error as read_gltf(), and if the library was built without libzip and pugixml
PlacedMeshes read_3mf(const std::string& path, std::uint64_t most_bytes);

}  // namespace cchip::assembly

#endif
