// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/tree/support_tree.hpp>
#include <cchip/object.hpp>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "edges.hpp"
#include "exact/float_mode.hpp"

namespace cchip {
namespace {

/// What Object::parts() looks up: none if file_face serves as it is.
std::vector<std::uint32_t> faces_by_file(const Mesh& mesh) {
  const std::vector<std::uint32_t>& number = mesh.file_face;
  if (std::is_sorted(number.begin(), number.end())) return {};
  std::vector<std::uint32_t> faces(number.size());
  std::iota(faces.begin(), faces.end(), 0U);
  std::stable_sort(faces.begin(), faces.end(),
                   [&number](std::uint32_t i, std::uint32_t k) { return number[i] < number[k]; });
  return faces;
}

}  // namespace

Object::Object(Mesh mesh) {
  check_float_mode();
  auto tree = std::make_shared<const bvh::SupportTree>(mesh, bvh::build_topology(mesh));
  std::vector<std::uint32_t> by_file = faces_by_file(mesh);
  data_ = std::make_shared<const Data>(
      Data{std::move(mesh), std::move(tree), std::move(by_file), std::make_shared<Edges>(), false});
}

void Object::refuse_moved_from() {
  throw std::invalid_argument("object: it was moved from and has no mesh; use the Object that it was moved to");
}

std::vector<std::uint32_t> Object::parts(std::uint32_t number) const {
  const std::vector<std::uint32_t>& numbers = mesh().file_face;
  std::vector<std::uint32_t> parts;
  if (numbers.empty()) {
    if (number < mesh().faces.size()) parts.push_back(number);
  } else if (data().by_file.empty()) {
    const auto [first, last] = std::equal_range(numbers.begin(), numbers.end(), number);
    for (auto i = first; i != last; ++i) parts.push_back(static_cast<std::uint32_t>(i - numbers.begin()));
  } else {
    const std::vector<std::uint32_t>& faces = data().by_file;
    auto i = std::lower_bound(faces.begin(), faces.end(), number,
                              [&numbers](std::uint32_t face, std::uint32_t wanted) { return numbers[face] < wanted; });
    for (; i != faces.end() && numbers[*i] == number; ++i) parts.push_back(*i);
  }
  return parts;
}

Object Object::moved(std::vector<Vec3d> vertices) const {
  check_float_mode();
  if (vertices.size() != this->mesh().vertices.size()) {
    throw std::invalid_argument("moved: " + std::to_string(vertices.size()) + " vertices, the object has " +
                                std::to_string(this->mesh().vertices.size()));
  }
  const Mesh& old = this->mesh();
  Mesh mesh = {old.name, std::move(vertices), old.faces, old.polygons_cut, old.file_face, old.notes};
  bvh::check_vertices(mesh);
  auto tree = std::make_shared<const bvh::SupportTree>(data().tree->moved(mesh));
  Object object;
  object.data_ = std::make_shared<const Data>(
      Data{std::move(mesh), std::move(tree), data().by_file, std::make_shared<Edges>(), true});
  return object;
}

}  // namespace cchip
