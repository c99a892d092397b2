// SPDX-License-Identifier: Apache-2.0
// Random outlines and an oracle that knows the even-odd rule only. An outline is drawn on a small grid, where the
// oracle decides with integers; the library gets it sheared, far from the origin and as a plane in space.
#ifndef CCHIP_TESTS_LIB_OUTLINES_HPP
#define CCHIP_TESTS_LIB_OUTLINES_HPP

#include <algorithm>
#include <array>
#include <cchip/mesh_file.hpp>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace cchip::outlines {

using Grid = std::array<std::int64_t, 2>;

inline std::int64_t area(const Grid& a, const Grid& b, const Grid& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

inline bool on_segment(const Grid& p, const Grid& a, const Grid& b) {
  if (area(a, b, p) != 0) return false;
  for (std::size_t k = 0; k < 2; ++k) {
    if (p[k] < std::min(a[k], b[k]) || p[k] > std::max(a[k], b[k])) return false;
  }
  return true;
}

/// True if p lies on the outline, or a ray from it to the right passes the outline an odd number of times.
inline bool even_odd(const Grid& p, const std::vector<Grid>& outline) {
  bool inside = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Grid& a = outline[i];
    const Grid& b = outline[(i + 1) % outline.size()];
    if (on_segment(p, a, b)) return true;
    if ((a[1] > p[1]) == (b[1] > p[1])) continue;
    if ((area(a, b, p) > 0) == (b[1] > a[1])) inside = !inside;  // p is to the left of the side
  }
  return inside;
}

/// True if two sides cross in a point within both.
inline bool crosses_itself(const std::vector<Grid>& outline) {
  const auto differ = [](std::int64_t x, std::int64_t y) { return (x < 0 && y > 0) || (x > 0 && y < 0); };
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Grid& a = outline[i];
      const Grid& b = outline[(i + 1) % n];
      const Grid& c = outline[k];
      const Grid& d = outline[(k + 1) % n];
      if (differ(area(a, b, c), area(a, b, d)) && differ(area(c, d, a), area(c, d, b))) return true;
    }
  }
  return false;
}

inline bool in_triangle(const Grid& p, const Grid& a, const Grid& b, const Grid& c) {
  const std::int64_t whole = area(a, b, c);
  if (whole == 0) return on_segment(p, a, b) || on_segment(p, b, c) || on_segment(p, c, a);
  const std::int64_t sign = whole > 0 ? 1 : -1;
  return sign * area(a, b, p) >= 0 && sign * area(b, c, p) >= 0 && sign * area(c, a, p) >= 0;
}

/// True if p lies in the hull of four points.
inline bool in_hull(const Grid& p, const std::vector<Grid>& q) {
  return in_triangle(p, q[0], q[1], q[2]) || in_triangle(p, q[0], q[1], q[3]) || in_triangle(p, q[0], q[2], q[3]) ||
         in_triangle(p, q[1], q[2], q[3]);
}

class Campaign {
 public:
  explicit Campaign(std::uint64_t seed) : random_(seed) {}

  /// Makes an outline and tries it. Returns what is wrong, or nothing.
  std::string one() {
    draw();
    place();
    ++outlines;
    const bool crossing = crosses_itself(outline_);
    const bool quad = outline_.size() == 4;
    crossed += crossing;
    const std::string from_file = try_mesh(crossing && !quad, [this] { return parse_mesh(obj(), "t.obj"); });
    if (!from_file.empty() || !quad) return from_file;
    return try_mesh(false, [this] { return parse_mesh(obj(), "t.obj", FaceKinds::triangles_and_quads); }) +
           try_mesh(false, [this] {
             FaceMatrix face(1, 4);
             face << 0, 1, 2, 3;
             Eigen::MatrixXd corners(4, 3);
             for (Eigen::Index i = 0; i < 4; ++i) corners.row(i) = corners_[static_cast<std::size_t>(i)];
             return make_mesh(corners, face);
           });
  }

  /// The last outline as an OBJ.
  std::string obj() const {
    std::string text;
    std::string face = "f";
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      text += "v";
      for (const double x : corners_[i]) text += " " + std::to_string(static_cast<std::int64_t>(x));
      text += "\n";
      face += " " + std::to_string(i + 1);
    }
    return text + face + "\n";
  }

  std::uint64_t outlines = 0;
  std::uint64_t crossed = 0;
  std::uint64_t points = 0;  ///< that were compared

 private:
  static constexpr std::int64_t side = 6;  ///< of the grid on which corners lie
  static constexpr std::int64_t fine = 4;  ///< points to be compared for each step of it

  std::int64_t number(std::int64_t least, std::int64_t greatest) {
    return std::uniform_int_distribution<std::int64_t>(least, greatest)(random_);
  }
  Grid point() { return {fine * number(0, side), fine * number(0, side)}; }

  /// Grows a triangle: a corner more, a spike or a hole at the end of a bridge, wherever nothing crosses. Some outlines
  /// are points in any order.
  void draw() {
    outline_.clear();
    const bool any = number(0, 5) == 0;
    const auto corners = static_cast<std::size_t>(number(4, 12));
    for (std::size_t i = 0; i < (any ? corners : 3); ++i) outline_.push_back(point());
    for (int i = 0; i < 60 && outline_.size() < corners; ++i) {
      std::vector<Grid> grown = outline_;
      const auto at = number(1, static_cast<std::int64_t>(grown.size()));
      const Grid before = grown[static_cast<std::size_t>(at) - 1];
      std::vector<Grid> more = {point()};
      const auto kind = number(0, 9);
      if (kind == 0) more = {point(), before};
      if (kind == 1) {
        const Grid bridge = point();
        more = {bridge, point(), point(), bridge, before};
      }
      if (kind == 2) more = {grown[static_cast<std::size_t>(number(0, static_cast<std::int64_t>(grown.size()) - 1))]};
      grown.insert(grown.begin() + at, more.begin(), more.end());
      if (!crosses_itself(grown)) outline_ = grown;
    }
  }

  /// A map of determinant 1 or -1 with numbers of up to about 26 bits, a plane in space, a place far away.
  void place() {
    std::array<std::int64_t, 4> m = {1, 0, 0, 1};
    const auto steps = number(0, 12);
    for (std::int64_t i = 0; i < steps; ++i) {
      const auto k = number(-3, 3);
      m = {m[2] + k * m[0], m[3] + k * m[1], m[0], m[1]};
    }
    const std::array<std::int64_t, 4> plane = {number(-9, 9), number(-9, 9), number(0, 1), number(0, 1)};
    const std::int64_t far = number(0, 2) == 0 ? 0 : std::int64_t{1} << number(0, 48);
    const std::array<std::int64_t, 3> place = {number(-far, far), number(-far, far), number(-far, far)};
    const auto turn = static_cast<std::size_t>(number(0, 2));
    corners_.clear();
    for (const Grid& p : outline_) {
      const std::int64_t x = m[0] * p[0] + m[1] * p[1];
      const std::int64_t y = m[2] * p[0] + m[3] * p[1];
      const std::array<std::int64_t, 3> v = {x, y, plane[2] * (plane[0] * x + plane[1] * y)};
      Vec3d corner;
      for (std::size_t i = 0; i < 3; ++i) {
        corner[static_cast<Eigen::Index>((i + turn) % 3)] = static_cast<double>(v[i] + place[i]);
      }
      corners_.push_back(corner);
    }
  }

  template <class Make>
  std::string try_mesh(bool refused, const Make& make) {
    Mesh mesh;
    try {
      mesh = make();
    } catch (const std::runtime_error& error) {
      const bool says_so = std::string(error.what()).find(" cross (side 0") != std::string::npos;
      return refused && says_so ? "" : error.what();
    }
    if (refused) return "it crosses itself, which is not refused";
    for (std::int64_t x = -1; x <= fine * side + 1; ++x) {
      for (std::int64_t y = -1; y <= fine * side + 1; ++y) {
        ++points;
        const Grid p = {x, y};
        const bool expected =
            outline_.size() == 4 && crosses_itself(outline_) ? in_hull(p, outline_) : even_odd(p, outline_);
        if (expected == covers(mesh, p)) continue;
        return std::string(expected ? "not covered" : "covered") + " is (" + std::to_string(x) + ", " +
               std::to_string(y) + ") of the grid";
      }
    }
    return "";
  }

  bool covers(const Mesh& mesh, const Grid& p) const {
    return std::any_of(mesh.faces.begin(), mesh.faces.end(), [&](const Mesh::Face& face) {
      const Grid& a = outline_[face.vertex[0]];
      const Grid& b = outline_[face.vertex[1]];
      const Grid& c = outline_[face.vertex[2]];
      if (face.kind == Kind::quad) return in_hull(p, {a, b, c, outline_[face.vertex[3]]});
      return in_triangle(p, a, b, c);
    });
  }

  std::mt19937_64 random_;
  std::vector<Grid> outline_;
  std::vector<Vec3d> corners_;  ///< where the library gets them
};

}  // namespace cchip::outlines

#endif
