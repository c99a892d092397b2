// SPDX-License-Identifier: Apache-2.0
#include "edges.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <tuple>

#include "exact/scaled_points.hpp"

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

}  // namespace

std::vector<Edge> find_edges(const Mesh& mesh, const std::vector<std::uint32_t>& place) {
  std::vector<Edge> edges;
  edges.reserve(mesh.faces.size() * 3);
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const Mesh::Face& face = mesh.faces[f];
    const auto corners = static_cast<std::size_t>(face.kind);
    for (std::size_t i = 0; i < corners; ++i) {
      const std::uint32_t from = place[face.vertex[i]];
      const std::uint32_t to = place[face.vertex[(i + 1) % corners]];
      if (from < to) edges.push_back({from, to, f, f, 1, 1});
      if (from > to) edges.push_back({to, from, f, f, 1, -1});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
    return std::tie(x.low, x.high, x.face) < std::tie(y.low, y.high, y.face);
  });
  std::size_t count = 0;
  for (const Edge& edge : edges) {
    if (count > 0 && edges[count - 1].low == edge.low && edges[count - 1].high == edge.high) {
      edges[count - 1].uses += 1;
      edges[count - 1].net += edge.net;
      edges[count - 1].last_face = edge.face;
    } else {
      edges[count++] = edge;
    }
  }
  edges.resize(count);
  return edges;
}

namespace {

/// A line through two points: its direction without a common factor, and the moment of the direction, so that equal
/// lines have equal numbers. In any unit that is common to all points.
class Line {
 public:
  using BigInt = exact::BigInt;
  using Vector = exact::Vec<BigInt>;

  Line(const Vec3d& from, const Vec3d& to, int exponent) {
    const Vector p = whole(from, exponent);
    const Vector q = whole(to, exponent);
    BigInt factor = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      direction_[k] = q[k] - p[k];
      factor = gcd(factor, abs(direction_[k]));
    }
    for (BigInt& x : direction_) x /= factor;
    is_reversed_ = direction_[nonzero()].sign() < 0;
    if (is_reversed_) {
      for (BigInt& x : direction_) x = -x;
    }
    moment_ = exact::cross(p, direction_);
  }
  /// The ends come in the opposite order along the line.
  bool is_reversed() const { return is_reversed_; }
  friend bool operator==(const Line& x, const Line& y) {
    return x.direction_ == y.direction_ && x.moment_ == y.moment_;
  }
  friend bool operator<(const Line& x, const Line& y) {
    return x.direction_ != y.direction_ ? x.direction_ < y.direction_ : x.moment_ < y.moment_;
  }

 private:
  std::size_t nonzero() const { return direction_[0].sign() != 0 ? 0 : direction_[1].sign() != 0 ? 1 : 2; }
  static Vector whole(const Vec3d& p, int exponent) {
    Vector result;
    for (std::size_t k = 0; k < 3; ++k) {
      const exact::Scaled x(p[static_cast<Eigen::Index>(k)]);
      if (x.mantissa != 0) result[k] = BigInt(x.mantissa) << (x.exponent - exponent);
    }
    return result;
  }
  Vector direction_;
  Vector moment_;
  bool is_reversed_ = false;
};

/// An end of an edge on a line.
struct End {
  const Line* line;
  std::uint32_t vertex;
  int count;  ///< what the edge adds to the uses of the line behind its first end, and takes away behind its last
  const Edge* edge;
};

/// The first of these edges that is not made up by others on its line, by what `count` says of each: an edge that one
/// face uses whole and others in parts is closed. Vertices of a line are in the order of a coordinate, so what is used
/// ends where it began if what begins and ends at each vertex adds up to 0.
template <class Count>
std::optional<OpenEdge> find_unmatched(const Mesh& mesh, const std::vector<Edge>& edges, int modulus,
                                       const Count& count) {
  std::vector<const Edge*> odd;
  for (const Edge& edge : edges) {
    if (count(edge) != 0) odd.push_back(&edge);
  }
  if (odd.empty()) return std::nullopt;
  int exponent = 0;
  for (const Edge* edge : odd) {
    for (const std::uint32_t vertex : {edge->low, edge->high}) {
      for (const double x : mesh.vertices[vertex]) {
        if (x != 0) exponent = std::min(exponent, exact::Scaled(x).exponent);
      }
    }
  }
  std::vector<Line> lines;
  lines.reserve(odd.size());
  std::vector<End> ends;
  for (const Edge* edge : odd) {
    lines.emplace_back(mesh.vertices[edge->low], mesh.vertices[edge->high], exponent);
    const int along = lines.back().is_reversed() ? -count(*edge) : count(*edge);
    ends.push_back({&lines.back(), edge->low, along, edge});
    ends.push_back({&lines.back(), edge->high, -along, edge});
  }
  std::sort(ends.begin(), ends.end(),
            [](const End& x, const End& y) { return x.vertex != y.vertex ? x.vertex < y.vertex : *x.line < *y.line; });
  const Edge* first = nullptr;
  for (std::size_t i = 0; i < ends.size();) {
    std::size_t next = i;
    int sum = 0;
    for (; next < ends.size() && ends[next].vertex == ends[i].vertex && *ends[next].line == *ends[i].line; ++next) {
      sum += ends[next].count;
    }
    for (; i < next; ++i) {
      const Edge* edge = ends[i].edge;
      if (sum % modulus == 0) continue;
      if (first == nullptr || std::tie(edge->face, edge) < std::tie(first->face, first)) first = edge;
    }
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
  const std::vector<Edge> all = find_edges(mesh(), edges.same_place);
  edges.open = find_unmatched(mesh(), all, 2, [](const Edge& edge) { return edge.uses % 2; });
  edges.twisted =
      find_unmatched(mesh(), all, std::numeric_limits<int>::max(), [](const Edge& edge) { return edge.net; });
  edges.known = true;
  return edges;
}

std::optional<OpenEdge> Object::open_edge() const { return edges().open; }

std::optional<OpenEdge> Object::twisted_edge() const { return edges().twisted; }

const std::vector<std::uint32_t>& Object::same_place() const { return edges().same_place; }

}  // namespace cchip
