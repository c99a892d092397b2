// SPDX-License-Identifier: Apache-2.0
#include "edges.hpp"

#include <algorithm>
#include <numeric>

namespace cchip {
namespace {

bool comes_before(const Vec3d& p, const Vec3d& q) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (p[i] != q[i]) return p[i] < q[i];
  }
  return false;
}

std::vector<std::uint32_t> find_same_place(const Mesh& mesh) {
  std::vector<std::uint32_t> place(mesh.vertices.size());
  std::iota(place.begin(), place.end(), 0U);
  std::vector<std::uint32_t> used;
  used.reserve(mesh.faces.size() * 3);
  for (const Mesh::Face& face : mesh.faces) {
    used.insert(used.end(), face.vertex.begin(), face.vertex.begin() + static_cast<int>(face.kind));
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::stable_sort(used.begin(), used.end(), [&mesh](std::uint32_t i, std::uint32_t k) {
    return comes_before(mesh.vertices[i], mesh.vertices[k]);
  });
  for (std::size_t i = 1; i < used.size(); ++i) {
    if (mesh.vertices[used[i]] == mesh.vertices[used[i - 1]]) place[used[i]] = place[used[i - 1]];
  }
  return place;
}

struct Edge {
  std::uint32_t low;
  std::uint32_t high;
  std::uint32_t face;
  bool same_ends(const Edge& x) const { return low == x.low && high == x.high; }
};

std::optional<OpenEdge> find_open_edge(const Mesh& mesh, const std::vector<std::uint32_t>& place) {
  std::vector<Edge> edges;
  edges.reserve(mesh.faces.size() * 3);
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const Mesh::Face& face = mesh.faces[f];
    const auto corners = static_cast<std::size_t>(face.kind);
    for (std::size_t i = 0; i < corners; ++i) {
      const auto [low, high] = std::minmax({place[face.vertex[i]], place[face.vertex[(i + 1) % corners]]});
      if (low != high) edges.push_back({low, high, f});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
    if (x.low != y.low) return x.low < y.low;
    return x.high != y.high ? x.high < y.high : x.face < y.face;
  });
  const Edge* first = nullptr;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t next = i + 1;
    while (next < edges.size() && edges[next].same_ends(edges[i])) ++next;
    if ((next - i) % 2 != 0 && (first == nullptr || edges[i].face < first->face)) first = &edges[i];
    i = next;
  }
  if (first == nullptr) return std::nullopt;
  return OpenEdge{mesh.vertices[first->low], mesh.vertices[first->high], mesh.number_in_file(first->face)};
}

}  // namespace

const Object::Edges& Object::edges() const {
  Edges& edges = *data().edges;
  const std::lock_guard<std::mutex> lock(edges.mutex);
  if (edges.known) return edges;
  edges.same_place = find_same_place(mesh());
  edges.open = find_open_edge(mesh(), edges.same_place);
  edges.known = true;
  return edges;
}

std::optional<OpenEdge> Object::open_edge() const { return edges().open; }

const std::vector<std::uint32_t>& Object::same_place() const { return edges().same_place; }

}  // namespace cchip
