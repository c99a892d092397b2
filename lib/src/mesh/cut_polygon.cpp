// SPDX-License-Identifier: Apache-2.0
#include "cut_polygon.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace cchip::outline {
namespace {

using Integer = boost::multiprecision::cpp_int;
using Point = std::array<double, 2>;

// --- exact signs

/// Exponent of a double's last bit, 0 for zero.
int last_bit(double x) { return x == 0 ? 0 : std::ilogb(x) - 52; }

int last_bit(const Point& p) { return std::min(last_bit(p[0]), last_bit(p[1])); }

/// x 2^-exponent; `exponent` is at most last_bit(x).
Integer scaled(double x, int exponent) {
  if (x == 0) return 0;
  const int last = last_bit(x);
  return Integer(static_cast<std::int64_t>(std::scalbn(x, -last))) << static_cast<unsigned>(last - exponent);
}

/// Twice the area of the triangle a, b, c, times 2^(-2 exponent). Integers and not rationals: coordinates of very
/// different magnitudes have denominators of a thousand bits, whose common divisors cost milliseconds.
Integer exact_cross(const Point& a, const Point& b, const Point& c, int exponent) {
  const auto minus = [exponent](double x, double y) { return Integer(scaled(x, exponent) - scaled(y, exponent)); };
  return minus(b[0], a[0]) * minus(c[1], a[1]) - minus(b[1], a[1]) * minus(c[0], a[0]);
}

constexpr double no_underflow = 1e-280;

/// Sign of the area of the triangle a, b, c: positive if counter-clockwise. Doubles decide if their error bound
/// allows it (Shewchuk, "Adaptive Precision Floating-Point Arithmetic", 1997, section 4.3), else integers.
int turn(const Point& a, const Point& b, const Point& c) {
  const double left = (b[0] - a[0]) * (c[1] - a[1]);
  const double right = (b[1] - a[1]) * (c[0] - a[0]);
  const double area = left - right;
  const double bound = 4e-16 * (std::abs(left) + std::abs(right));
  if (bound > no_underflow && std::abs(area) > bound) return area > 0 ? 1 : -1;
  if (a == b || b == c || a == c) return 0;
  return exact_cross(a, b, c, std::min({last_bit(a), last_bit(b), last_bit(c)})).sign();
}

// --- the view

Point along(const Vec3d& v, std::size_t axis) {
  return {v[static_cast<Eigen::Index>((axis + 1) % 3)], v[static_cast<Eigen::Index>((axis + 2) % 3)]};
}

/// The coordinate that is left out, and the sign of the outline's area in what remains.
struct View {
  std::size_t axis = 3;  ///< 3: all corners lie on one line
  int sign = 0;
};

using Integers = std::array<Integer, 3>;

Integers minus(const Integers& a, const Integers& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Integers cross(const Integers& a, const Integers& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

std::size_t largest(const Integers& v) {
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (abs(v[i]) > abs(v[axis])) axis = i;
  }
  return axis;
}

template <class Points>
View exact_view(const Points& polygon) {
  int exponent = 0;
  for (const Vec3d& v : polygon) exponent = std::min({exponent, last_bit(v.x()), last_bit(v.y()), last_bit(v.z())});
  const auto integers = [exponent](const Vec3d& v) {
    return Integers{scaled(v.x(), exponent), scaled(v.y(), exponent), scaled(v.z(), exponent)};
  };
  const Integers first = integers(polygon[0]);
  Integers area = {0, 0, 0};
  Integers last = minus(integers(polygon[1]), first);
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const Integers next = minus(integers(polygon[i]), first);
    const Integers part = cross(last, next);
    for (std::size_t k = 0; k < 3; ++k) area[k] += part[k];
    last = next;
  }
  const std::size_t axis = largest(area);
  if (area[axis] != 0) return {axis, area[axis].sign()};
  // The parts outweigh each other: the plane of the first three corners that are not on one line.
  const auto other = std::find_if(polygon.begin(), polygon.end(), [&](const Vec3d& v) { return v != polygon[0]; });
  if (other == polygon.end()) return {};
  const Integers edge = minus(integers(*other), first);
  for (auto third = other + 1; third != polygon.end(); ++third) {
    const Integers normal = cross(edge, minus(integers(*third), first));
    const std::size_t dropped = largest(normal);
    if (normal[dropped] != 0) return {dropped, 0};
  }
  return {};
}

/// The axis along which the outline's area is largest, the first of equal ones. Doubles decide if they can.
template <class Points>
View view_of(const Points& polygon) {
  std::array<double, 3> area = {0, 0, 0};
  std::array<double, 3> size = {0, 0, 0};
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Point a = along(polygon[0], axis);
      const Point b = along(polygon[i], axis);
      const Point c = along(polygon[i + 1], axis);
      const double left = (b[0] - a[0]) * (c[1] - a[1]);
      const double right = (b[1] - a[1]) * (c[0] - a[0]);
      area[axis] += left - right;
      size[axis] += std::abs(left) + std::abs(right);
    }
  }
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (std::abs(area[i]) > std::abs(area[axis])) axis = i;
  }
  // Each part has the relative error of turn(), and each of the additions at most one rounding of the sum of sizes.
  const double relative = 2.5e-16 * static_cast<double>(polygon.size() + 4);
  const auto error = [&](std::size_t i) { return relative * size[i] + no_underflow; };
  const double least = std::abs(area[axis]) - error(axis);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(least > (i == axis ? 0 : std::abs(area[i]) + error(i)))) return exact_view(polygon);
  }
  if (!std::isfinite(least)) return exact_view(polygon);
  return {axis, area[axis] > 0 ? 1 : -1};
}

/// True if the projections of the corner c and of side a, b show c on their line along every axis.
bool on_one_line(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (turn(along(a, axis), along(b, axis), along(c, axis)) != 0) return false;
  }
  return true;
}

// --- cutting

using Vertex = std::uint32_t;

/// Parts of sides, from the vertex that the sweep meets first to the other one.
struct Edge {
  Vertex from;
  Vertex to;
  bool odd;  ///< the outline passes here an odd number of times
};

class Cutter {
 public:
  Cutter(const std::vector<Vec3d>& polygon, const View& view)
      : polygon_(polygon), view_(view), vertex_of_(polygon.size()), on_side_(polygon.size()) {
    for (const Vec3d& v : polygon) points_.push_back(along(v, view.axis));
    number_vertices();
  }

  Cut run() {
    if (!find_touches()) return std::move(cut_);
    make_edges();
    for (Vertex v = 0; v < corner_.size(); ++v) visit(v);
    cover_sides();
    return std::move(cut_);
  }

 private:
  /// Part of an edge that the sweep has met but not left, and what lies above it up to the next one.
  struct Active {
    Edge edge;
    bool inside_above;
    /// If that is inside: the border of what is covered, from the beginning of this edge to that of the next one.
    /// It bulges to the right, so only its ends can see each other along it.
    std::vector<Vertex> chain;
  };

  std::size_t next(std::size_t corner) const { return corner + 1 == points_.size() ? 0 : corner + 1; }
  const Point& at(Vertex v) const { return points_[corner_[v]]; }

  /// Numbers the different points in the order of the sweep: by the first coordinate, then by the second.
  void number_vertices() {
    std::vector<std::size_t> order(points_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [this](std::size_t i, std::size_t k) { return points_[i] < points_[k]; });
    for (const std::size_t corner : order) {
      if (corner_.empty() || points_[corner_.back()] != points_[corner]) corner_.push_back(corner);
      vertex_of_[corner] = static_cast<Vertex>(corner_.size() - 1);
    }
  }

  /// Notes the vertices within sides; false if two sides cross or there are too many.
  bool find_touches() {
    const std::size_t n = points_.size();
    const auto begin = [this](std::size_t side) { return std::min(vertex_of_[side], vertex_of_[next(side)]); };
    const auto end = [this](std::size_t side) { return std::max(vertex_of_[side], vertex_of_[next(side)]); };
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) { return begin(i) < begin(k); });
    for (std::size_t i = 0; i < n; ++i) {
      const Vertex last = end(order[i]);
      for (std::size_t k = i + 1; k < n && begin(order[k]) <= last; ++k) {
        if (!compare(order[i], order[k])) return false;
      }
    }
    return true;
  }

  bool compare(std::size_t i, std::size_t k) {
    const Point& a = points_[i];
    const Point& b = points_[next(i)];
    const Point& c = points_[k];
    const Point& d = points_[next(k)];
    if (std::max(a[1], b[1]) < std::min(c[1], d[1]) || std::max(c[1], d[1]) < std::min(a[1], b[1])) return true;
    const int side_c = turn(a, b, c);
    const int side_d = turn(a, b, d);
    if (side_c * side_d > 0) return true;
    const int side_a = turn(c, d, a);
    const int side_b = turn(c, d, b);
    if (side_a * side_b > 0) return true;
    if (side_a * side_b < 0 && side_c * side_d < 0) {
      cut_.error = ": its sides " + std::to_string(std::min(i, k)) + " and " + std::to_string(std::max(i, k)) +
                   " cross (side 0 leads from the face's first corner to its second, seen along " +
                   std::string(1, "xyz"[view_.axis]) + ")";
      return false;
    }
    if (side_c == 0) note(i, vertex_of_[k]);
    if (side_d == 0) note(i, vertex_of_[next(k)]);
    if (side_a == 0) note(k, vertex_of_[i]);
    if (side_b == 0) note(k, vertex_of_[next(i)]);
    if (touches_ > most_touches) {
      cut_.error = " touches itself more than " + std::to_string(most_touches) + " times";
      return false;
    }
    return true;
  }

  /// Notes a vertex on the line of a side if it is between the ends.
  void note(std::size_t side, Vertex v) {
    const Vertex a = vertex_of_[side];
    const Vertex b = vertex_of_[next(side)];
    if (!(std::min(a, b) < v && v < std::max(a, b))) return;
    on_side_[side].push_back(v);
    ++touches_;
  }

  /// Splits the sides and counts how often each part is passed.
  void make_edges() {
    std::vector<std::pair<Vertex, Vertex>> parts;
    for (std::size_t side = 0; side < points_.size(); ++side) {
      auto& stops = on_side_[side];
      std::sort(stops.begin(), stops.end());
      stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
      const auto [first, last] = std::minmax(vertex_of_[side], vertex_of_[next(side)]);
      if (first == last) continue;
      Vertex from = first;
      for (const Vertex stop : stops) {
        parts.emplace_back(from, stop);
        from = stop;
      }
      parts.emplace_back(from, last);
    }
    std::sort(parts.begin(), parts.end());
    for (std::size_t i = 0; i < parts.size();) {
      std::size_t end = i;
      while (end < parts.size() && parts[end] == parts[i]) ++end;
      edges_.push_back({parts[i].first, parts[i].second, (end - i) % 2 == 1});
      i = end;
    }
    for (auto from = edges_.begin(); from != edges_.end();) {  // upwards around each vertex
      const auto to = std::find_if(from, edges_.end(), [&](const Edge& e) { return e.from != from->from; });
      std::sort(from, to, [this](const Edge& e, const Edge& f) { return turn(at(e.from), at(e.to), at(f.to)) > 0; });
      from = to;
    }
  }

  void add(Vertex a, Vertex b, Vertex c) { add_corners(corner_[a], corner_[b], corner_[c]); }

  void add_corners(std::size_t a, std::size_t b, std::size_t c) {
    if (view_.sign < 0) std::swap(b, c);
    cut_.triangles.push_back({a, b, c});
  }

  bool sees(Vertex v, Vertex low, Vertex high) const { return turn(at(low), at(v), at(high)) > 0; }

  /// Cuts off what v sees of the upper end of a chain, and makes v its end.
  void extend_up(std::vector<Vertex>& chain, Vertex v) {
    while (chain.size() > 1 && sees(v, chain[chain.size() - 2], chain.back())) {
      add(chain[chain.size() - 2], v, chain.back());
      chain.pop_back();
    }
    chain.push_back(v);
  }

  /// The same for its lower end.
  void extend_down(std::vector<Vertex>& chain, Vertex v) {
    std::size_t k = 0;
    for (; k + 1 < chain.size() && sees(v, chain[k], chain[k + 1]); ++k) add(chain[k], v, chain[k + 1]);
    if (k == 0) {
      chain.insert(chain.begin(), v);
    } else {
      chain.erase(chain.begin(), chain.begin() + static_cast<std::ptrdiff_t>(k - 1));
      chain[0] = v;
    }
  }

  /// The sweep comes to v.
  void visit(Vertex v) {
    const auto side = [&](std::size_t i) { return turn(at(pool_[i].edge.from), at(pool_[i].edge.to), at(v)); };
    const auto low = std::partition_point(active_.begin(), active_.end(), [&](std::size_t i) { return side(i) > 0; });
    const auto high = std::partition_point(low, active_.end(), [&](std::size_t i) { return side(i) == 0; });
    Active* const below = low == active_.begin() ? nullptr : &pool_[*(low - 1)];
    const bool inside_below = below != nullptr && below->inside_above;
    std::vector<Vertex> above;  // chain of the region above v
    if (low == high) {
      if (inside_below) {
        // v sees the vertex that the sweep met last in this region
        auto& chain = below->chain;
        const auto latest = std::max_element(chain.begin(), chain.end());
        above.assign(latest, chain.end());
        chain.erase(latest + 1, chain.end());
        extend_up(chain, v);
        extend_down(above, v);
      }
    } else {
      if (inside_below) extend_up(below->chain, v);
      for (auto i = low; i + 1 != high; ++i) {
        const auto& chain = pool_[*i].chain;
        for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
          if (sees(v, chain[k], chain[k + 1])) add(chain[k], v, chain[k + 1]);
        }
      }
      Active& last = pool_[*(high - 1)];
      above = std::move(last.chain);
      if (last.inside_above) extend_down(above, v);
    }
    const auto first_edge = edge_;
    while (edge_ < edges_.size() && edges_[edge_].from == v) ++edge_;
    std::vector<std::size_t> begun;
    bool inside = inside_below;
    for (std::size_t e = first_edge; e < edge_; ++e) {
      const Edge& edge = edges_[e];
      if (!edge.odd && !inside) add(edge.from, edge.to, edge.to);  // nothing else covers it
      inside = inside != edge.odd;
      begun.push_back(e);
      pool_.push_back({edge, inside, {}});
      if (inside) pool_.back().chain = e + 1 == edge_ ? std::move(above) : std::vector<Vertex>{v};
      if (inside && pool_.back().chain.empty()) pool_.back().chain = {v};
    }
    if (begun.empty() && inside_below) {  // the regions below and above become one
      Active& joined = pool_[*(low - 1)];
      joined.chain.insert(joined.chain.end(), above.begin() + 1, above.end());
    }
    const auto at_low = active_.erase(low, high);
    active_.insert(at_low, begun.begin(), begun.end());
  }

  /// Corners that the view shows in one place, or on a side, may be elsewhere along the view: what lies between each
  /// side and the edges that were used for it is covered, too.
  void cover_sides() {
    for (std::size_t a = 0; a < points_.size(); ++a) {
      const std::size_t b = next(a);
      std::vector<std::size_t> path = {corner_[vertex_of_[a]]};
      for (const Vertex v : on_side_[a]) path.push_back(corner_[v]);
      if (vertex_of_[a] > vertex_of_[b]) std::reverse(path.begin() + 1, path.end());
      if (vertex_of_[a] != vertex_of_[b]) path.push_back(corner_[vertex_of_[b]]);
      const bool straight = std::all_of(path.begin() + 1, path.end(), [&](std::size_t c) {
        return on_one_line(polygon_[a], polygon_[b], polygon_[c]);
      });
      const bool same_ends = polygon_[path.front()] == polygon_[a] && polygon_[path.back()] == polygon_[b];
      if (straight && same_ends) continue;
      add_corners(a, b, path[0]);
      for (std::size_t i = 0; i + 1 < path.size(); ++i) add_corners(b, path[i], path[i + 1]);
    }
  }

  const std::vector<Vec3d>& polygon_;
  View view_;
  std::vector<Point> points_;        ///< the corners in the view
  std::vector<std::size_t> corner_;  ///< of each vertex the first corner that is there
  std::vector<Vertex> vertex_of_;    ///< by corner
  std::vector<std::vector<Vertex>> on_side_;
  std::size_t touches_ = 0;
  std::vector<Edge> edges_;
  std::size_t edge_ = 0;             ///< the first one that has not begun
  std::vector<Active> pool_;         ///< by edge
  std::vector<std::size_t> active_;  ///< numbers in pool_, upwards
  Cut cut_;
};

}  // namespace

std::optional<std::array<std::size_t, 4>> hull_order(const std::array<Vec3d, 4>& quad) {
  constexpr std::array<std::size_t, 4> given = {0, 1, 2, 3};
  const View view = view_of(quad);
  if (view.axis == 3) return given;
  std::array<Point, 4> p;
  for (std::size_t i = 0; i < 4; ++i) p[i] = along(quad[i], view.axis);
  std::array<int, 4> turns{};  // of the corners i, i + 1, i + 2
  for (std::size_t i = 0; i < 4; ++i) turns[i] = turn(p[i], p[(i + 1) % 4], p[(i + 2) % 4]);
  const auto [least, greatest] = std::minmax_element(turns.begin(), turns.end());
  if (*least >= 0 || *greatest <= 0) return given;
  // Two sides cross if each has the ends of the other on different sides.
  if (turns[0] * turns[3] < 0 && turns[1] * turns[2] < 0) return {{0, 2, 1, 3}};
  if (turns[0] * turns[1] < 0 && turns[2] * turns[3] < 0) return {{0, 1, 3, 2}};
  return {};
}

Cut cut_polygon(const std::vector<Vec3d>& polygon) {
  if (polygon.size() > most_corners) return {{}, " has more than " + std::to_string(most_corners) + " corners"};
  const View view = view_of(polygon);
  if (view.axis < 3) return Cutter(polygon, view).run();
  Cut cut;  // on one line: a fan covers all of it
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) cut.triangles.push_back({0, i, i + 1});
  return cut;
}

Faces faces_of(const std::vector<Vec3d>& polygon, bool keep_quads) {
  Faces faces;
  if (polygon.size() == 3) {
    faces.faces = {{Kind::tri, {0, 1, 2, 0}}};
    return faces;
  }
  if (polygon.size() == 4) {
    if (const auto order = hull_order({polygon[0], polygon[1], polygon[2], polygon[3]})) {
      if (keep_quads) {
        faces.faces = {{Kind::quad, {0, 1, 2, 3}}};
        return faces;
      }
      faces.cut = true;
      const auto& [a, b, c, d] = *order;
      faces.faces = {{Kind::tri, {a, b, c, 0}}, {Kind::tri, {a, c, d, 0}}};
      return faces;
    }
  }
  faces.cut = true;
  Cut cut = cut_polygon(polygon);
  faces.error = std::move(cut.error);
  for (const auto& t : cut.triangles) faces.faces.push_back({Kind::tri, {t[0], t[1], t[2], 0}});
  return faces;
}

}  // namespace cchip::outline
