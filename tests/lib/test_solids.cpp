// SPDX-License-Identifier: Apache-2.0
// Solids against sets of unit cubes, tetrahedra against the oracle of pairs, and points inside against parity.
#include <array>
#include <catch2/catch.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <cchip/pose.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/shapes.hpp>
#include <cchip/solids.hpp>
#include <iostream>
#include <map>
#include <random>
#include <set>

#include "bvh_meshes.hpp"
#include "random_poses.hpp"

using namespace cchip;
using namespace cchip_test;
using cchip::testing::add_face;
using cchip::testing::make_box;

namespace cchip {
std::ostream& operator<<(std::ostream& out, SolidRelation relation) { return out << name_of(relation); }
}  // namespace cchip

namespace {

const Pose here = Pose::Identity();

SolidRelation swapped(SolidRelation relation) {
  if (relation == SolidRelation::a_in_b) return SolidRelation::b_in_a;
  if (relation == SolidRelation::b_in_a) return SolidRelation::a_in_b;
  return relation;
}

void append(Mesh& mesh, const Mesh& more) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (Mesh::Face face : more.faces) {
    for (std::uint32_t& v : face.vertex) v += offset;
    mesh.faces.push_back(face);
  }
}

Mesh both(Mesh mesh, const Mesh& more) {
  append(mesh, more);
  return mesh;
}

Pose shifted(double x, double y, double z) {
  Pose pose = here;
  pose.translation() = Vec3d(x, y, z);
  return pose;
}

Mesh box(double x0, double y0, double z0, double x1, double y1, double z1) {
  return make_box({x0, y0, z0}, {x1, y1, z1});
}

/// In both orders.
void expect(const Mesh& a, const Mesh& b, SolidRelation relation, const Pose& pose_b = here) {
  const Object object_a(a), object_b(b);
  CHECK(solids(object_a, here, object_b, pose_b) == relation);
  CHECK(solids(object_b, pose_b, object_a, here) == swapped(relation));
}

using Cell = std::array<int, 3>;
using Cells = std::set<Cell>;

/// How the faces of a set of cubes are made.
struct Style {
  bool walls;      ///< faces between two cubes of the set, twice
  bool triangles;  ///< along any diagonal
  bool flip;       ///< faces either way round
  bool fine;       ///< each into four
};

Mesh mesh_of(const Cells& cells, const Style& style, std::mt19937_64& random) {
  Mesh mesh;
  for (const Cell& cell : cells) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        Cell beyond = cell;
        beyond[axis] += side == 0 ? -1 : 1;
        if (!style.walls && cells.count(beyond) != 0) continue;
        std::vector<Vec3d> corners;
        for (const auto& [du, dv] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
          Cell p = cell;
          p[axis] += side;
          p[(axis + 1) % 3] += du;
          p[(axis + 2) % 3] += dv;
          corners.emplace_back(p[0], p[1], p[2]);
        }
        if (style.flip && random() % 2 != 0) std::reverse(corners.begin(), corners.end());
        std::rotate(corners.begin(), corners.begin() + static_cast<int>(random() % 4), corners.end());
        if (style.triangles) {
          add_face(mesh, {corners[0], corners[1], corners[2]});
          add_face(mesh, {corners[0], corners[2], corners[3]});
        } else {
          add_face(mesh, corners);
        }
      }
    }
  }
  return style.fine ? subdivided(mesh) : mesh;
}

SolidRelation truth(const Cells& a, const Cells& b) {
  std::size_t common = 0;
  bool near = false;
  for (const Cell& x : a) {
    common += b.count(x);
    for (int i = 0; i < 27 && !near; ++i)
      near = b.count({x[0] + i % 3 - 1, x[1] + i / 3 % 3 - 1, x[2] + i / 9 - 1}) != 0;
  }
  if (common == 0) return near ? SolidRelation::touching : SolidRelation::disjoint;
  if (common == a.size()) return common == b.size() ? SolidRelation::equal : SolidRelation::a_in_b;
  return common == b.size() ? SolidRelation::b_in_a : SolidRelation::overlapping;
}

/// Subset of a box of cells.
Cells random_cells(std::mt19937_64& random) {
  const unsigned most = random() % 16 == 0 ? 3 : 2;
  const auto length = [&random, most] { return 1 + static_cast<unsigned>(random() % most); };
  const std::array<unsigned, 3> size = {length(), length(), length()};
  const auto share = 1 + random() % 4;
  Cells cells;
  while (cells.empty()) {
    for (unsigned x = 0; x < size[0]; ++x) {
      for (unsigned y = 0; y < size[1]; ++y) {
        for (unsigned z = 0; z < size[2]; ++z) {
          if (random() % 4 < share) cells.insert({static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)});
        }
      }
    }
  }
  return cells;
}

/// Like `a` with a few cells more, or a few less, or the same, or any.
Cells random_other(const Cells& a, std::mt19937_64& random) {
  Cells b;
  const auto kind = random() % 6;
  if (kind == 0) return a;
  if (kind <= 3) {
    Cells others = random_cells(random);
    const auto shift = [&random] { return static_cast<int>(random() % 3) - 1; };
    const Cell by = {shift(), shift(), shift()};
    for (const Cell& x : others) {
      const Cell moved = {x[0] + by[0], x[1] + by[1], x[2] + by[2]};
      if (kind != 3 || a.count(moved) == 0) b.insert(moved);
    }
  } else {
    for (const Cell& x : a) {
      if (kind == 4 ? random() % 3 != 0 : true) b.insert(x);
      if (kind == 5) {
        for (int i = 0; i < 27; ++i) {
          if (random() % 8 == 0) b.insert({x[0] + i % 3 - 1, x[1] + i / 3 % 3 - 1, x[2] + i / 9 - 1});
        }
      }
    }
  }
  if (b.empty()) b.insert({0, 0, 0});
  return b;
}

Style random_style(std::mt19937_64& random) {
  return {random() % 4 == 0, random() % 2 == 0, random() % 2 == 0, random() % 16 == 0};
}

void check_cubes(int pairs) {
  std::mt19937_64 random(sim::seed_from_environment());
  std::map<SolidRelation, int> count;
  for (int i = 0; i < pairs; ++i) {
    const Cells a = random_cells(random);
    const Cells b = random_other(a, random);
    const Object object_a(mesh_of(a, random_style(random), random));
    const Object object_b(mesh_of(b, random_style(random), random));
    REQUIRE(object_a.is_closed());
    REQUIRE(object_b.is_closed());
    const SolidRelation expected = truth(a, b);
    ++count[expected];
    // A pose that keeps the solids apart from each other does not change the answer, however its numbers are rounded.
    Pose pose = here;
    if (i % 4 == 0) {
      const PoseClass kinds[] = {PoseClass::rigid, PoseClass::quarter_turns, PoseClass::mirror, PoseClass::shear};
      pose = random_pose(kinds[random() % 4], 10, random);
    }
    const SolidRelation found =
        i % 2 == 0 ? solids(object_a, pose, object_b, pose) : swapped(solids(object_b, pose, object_a, pose));
    if (found == expected) continue;
    FAIL("pair " << i << ": " << found << ", not " << expected << ", seed " << sim::seed_from_environment());
  }
  for (const auto& [relation, times] : count) std::cout << relation << ' ' << times << ' ';
  std::cout << '\n';
  CHECK(count.size() == 6);
  for (const auto& [relation, times] : count) CHECK(times > pairs / 100);
}

/// A tetrahedron: the hull of the four points of this primitive.
using Tetrahedron = Primitive;

Tetrahedron random_tetrahedron(int range, std::mt19937_64& random) {
  std::uniform_int_distribution<int> coordinate(-range, range);
  Tetrahedron t;
  t.kind = Kind::quad;
  do {
    for (Vec3d& v : t.v) {
      for (Eigen::Index i = 0; i < 3; ++i) v[i] = coordinate(random);
    }
  } while ((t.v[1] - t.v[0]).cross(t.v[2] - t.v[0]).dot(t.v[3] - t.v[0]) == 0);  // small whole numbers: exact
  return t;
}

Mesh mesh_of(const Tetrahedron& t) {
  Mesh mesh;
  for (std::size_t i = 0; i < 4; ++i) add_face(mesh, {t.v[i], t.v[(i + 1) % 4], t.v[(i + 2) % 4]});
  return mesh;
}

Primitive point(const Vec3d& p) {
  Primitive result;
  result.v = {p, p, p, p};
  return result;
}

bool holds(const Tetrahedron& a, const Pose& pose_a, const Tetrahedron& b, const Pose& pose_b) {
  return std::all_of(b.v.begin(), b.v.end(),
                     [&](const Vec3d& v) { return exact_intersects(a, pose_a, point(v), pose_b); });
}

SolidRelation truth(const Tetrahedron& a, const Pose& pose_a, const Tetrahedron& b, const Pose& pose_b) {
  const Relation relation = exact_relation(a, pose_a, b, pose_b);
  if (relation == Relation::apart) return SolidRelation::disjoint;
  if (relation == Relation::touching) return SolidRelation::touching;
  const bool in_b = holds(b, pose_b, a, pose_a);
  const bool in_a = holds(a, pose_a, b, pose_b);
  if (in_a && in_b) return SolidRelation::equal;
  return in_b ? SolidRelation::a_in_b : in_a ? SolidRelation::b_in_a : SolidRelation::overlapping;
}

/// A box from a corner of small whole numbers to another.
using Corners = std::array<Cell, 2>;

/// The cells in an odd number of boxes, or in any.
Cells cells_of(const std::vector<Corners>& boxes, InsideRule rule) {
  Cells cells;
  for (const Corners& c : boxes) {
    for (int x = c[0][0]; x < c[1][0]; ++x) {
      for (int y = c[0][1]; y < c[1][1]; ++y) {
        for (int z = c[0][2]; z < c[1][2]; ++z) {
          if (!cells.insert({x, y, z}).second && rule == InsideRule::odd) cells.erase({x, y, z});
        }
      }
    }
  }
  return cells;
}

/// The surface of a box is where one coordinate is that of a corner.
bool surfaces_meet(const Corners& p, const Corners& q) {
  for (int i = 0; i < 36; ++i) {
    Corners a = p, b = q;
    const auto flatten = [](Corners& x, int side) {
      const auto axis = static_cast<std::size_t>(side / 2);
      x[static_cast<std::size_t>(side % 2)][axis] = x[static_cast<std::size_t>(1 - side % 2)][axis];
    };
    flatten(a, i / 6);
    flatten(b, i % 6);
    bool meet = true;
    for (std::size_t k = 0; k < 3; ++k) meet = meet && a[0][k] <= b[1][k] && b[0][k] <= a[1][k];
    if (meet) return true;
  }
  return false;
}

SolidRelation truth(const std::vector<Corners>& a, const std::vector<Corners>& b, InsideRule rule) {
  const Cells cells_a = cells_of(a, rule), cells_b = cells_of(b, rule);
  std::size_t common = 0;
  for (const Cell& x : cells_a) common += cells_b.count(x);
  if (common != 0) {
    if (common == cells_a.size()) return common == cells_b.size() ? SolidRelation::equal : SolidRelation::a_in_b;
    return common == cells_b.size() ? SolidRelation::b_in_a : SolidRelation::overlapping;
  }
  for (const Corners& p : a) {
    for (const Corners& q : b) {
      if (surfaces_meet(p, q)) return SolidRelation::touching;
    }
  }
  return SolidRelation::disjoint;
}

/// Rectangles cut along any diagonal, from any vertex, or whole; with their normals outward.
Mesh mesh_of(const std::vector<Corners>& boxes, std::mt19937_64& random) {
  Mesh mesh;
  const bool whole = random() % 2 == 0;
  for (const Corners& c : boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const std::size_t side : {0U, 1U}) {
        std::vector<Vec3d> corners;
        for (const auto& [u, v] : {std::pair<std::size_t, std::size_t>{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
          Cell p = {};
          p[axis] = c[side][axis];
          p[(axis + 1) % 3] = c[u][(axis + 1) % 3];
          p[(axis + 2) % 3] = c[v][(axis + 2) % 3];
          corners.emplace_back(p[0], p[1], p[2]);
        }
        if (side == 0) std::reverse(corners.begin(), corners.end());
        std::rotate(corners.begin(), corners.begin() + static_cast<int>(random() % 4), corners.end());
        if (whole) {
          add_face(mesh, corners);
        } else {
          add_face(mesh, {corners[0], corners[1], corners[2]});
          add_face(mesh, {corners[0], corners[2], corners[3]});
        }
      }
    }
  }
  return mesh;
}

std::vector<Corners> random_boxes(std::mt19937_64& random) {
  std::vector<Corners> boxes(1 + random() % 2);
  for (Corners& c : boxes) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = static_cast<int>(random() % 3);
      c[0][k] = from;
      c[1][k] = from + 1 + static_cast<int>(random() % static_cast<unsigned>(3 - from));
    }
  }
  return boxes;
}

void check_parity(std::uint64_t seed, std::map<SolidRelation, int>& count) {
  std::mt19937_64 random(seed);
  const std::vector<Corners> a = random_boxes(random);
  const std::vector<Corners> b = random_boxes(random);
  const Object object_a(mesh_of(a, random)), object_b(mesh_of(b, random));
  CAPTURE(seed);
  for (const InsideRule rule : {InsideRule::odd, InsideRule::nonzero}) {
    const SolidRelation expected = truth(a, b, rule);
    ++count[expected];
    REQUIRE(solids(object_a, here, object_b, here, {rule}) == expected);
  }
}

}  // namespace

TEST_CASE("solids: boxes by hand", "[lib][solids]") {
  const Mesh cube = box(0, 0, 0, 4, 4, 4);
  expect(cube, box(5, 0, 0, 6, 1, 1), SolidRelation::disjoint);
  expect(cube, box(4, 0, 0, 6, 4, 4), SolidRelation::touching);  // flush
  expect(cube, box(4, 1, 1, 6, 2, 2), SolidRelation::touching);  // flush, smaller
  expect(cube, box(4, 4, 0, 6, 6, 4), SolidRelation::touching);  // along an edge
  expect(cube, box(4, 4, 4, 6, 6, 6), SolidRelation::touching);  // at a vertex
  expect(cube, box(1, 1, 1, 2, 2, 2), SolidRelation::b_in_a);    // no contact
  expect(cube, box(0, 1, 1, 2, 2, 2), SolidRelation::b_in_a);    // flush from inside
  expect(cube, box(0, 0, 0, 4, 4, 2), SolidRelation::b_in_a);    // flush on five sides
  expect(cube, box(0, 0, 0, 4, 4, 4), SolidRelation::equal);
  expect(cube, box(-1, 1, 1, 5, 2, 2), SolidRelation::overlapping);  // faces cross
  expect(cube, box(2, 0, 0, 6, 4, 4), SolidRelation::overlapping);   // bars of one section: no faces cross
  expect(cube, cube, SolidRelation::overlapping, shifted(2, 2, 2));  // on one raster
  expect(subdivided(cube), cube, SolidRelation::equal);              // other faces
  expect(subdivided(cube), box(2, 0, 0, 6, 4, 4), SolidRelation::overlapping);
}

TEST_CASE("solids: components, cavities and shells", "[lib][solids]") {
  const Mesh hollow = both(box(0, 0, 0, 8, 8, 8), box(2, 2, 2, 6, 6, 6));
  expect(hollow, box(3, 3, 3, 4, 4, 4), SolidRelation::disjoint);
  expect(hollow, box(2, 2, 2, 6, 6, 6), SolidRelation::touching);  // fills the cavity
  expect(hollow, box(2, 3, 3, 4, 4, 4), SolidRelation::touching);
  expect(hollow, box(1, 3, 3, 4, 4, 4), SolidRelation::overlapping);
  expect(hollow, box(1, 1, 1, 7, 7, 7), SolidRelation::overlapping);  // no contact of surfaces: a box in the shell
  expect(hollow, box(0, 0, 0, 8, 8, 8), SolidRelation::a_in_b);
  expect(hollow, box(0, 0, 0, 1, 1, 1), SolidRelation::b_in_a);
  const Mesh nested = both(hollow, box(3, 3, 3, 5, 5, 5));  // a core in the cavity
  expect(nested, hollow, SolidRelation::b_in_a);
  expect(nested, box(3, 3, 3, 5, 5, 5), SolidRelation::b_in_a);
  expect(nested, both(box(2, 2, 2, 6, 6, 6), box(3, 3, 3, 5, 5, 5)), SolidRelation::touching);
  const Mesh two = both(box(0, 0, 0, 1, 1, 1), box(4, 0, 0, 5, 1, 1));
  expect(two, box(-1, -1, -1, 2, 2, 2), SolidRelation::overlapping);  // one component inside, one outside; no contact
  expect(two, box(-1, -1, -1, 6, 2, 2), SolidRelation::a_in_b);
  expect(two, box(1, 0, 0, 4, 1, 1), SolidRelation::touching);
  expect(two, both(box(4, 0, 0, 5, 1, 1), box(0, 0, 0, 1, 1, 1)), SolidRelation::equal);
  // Two boxes with a wall in common: the wall bounds nothing.
  const Mesh joined = both(box(0, 0, 0, 1, 1, 1), box(1, 0, 0, 2, 1, 1));
  expect(joined, box(0, 0, 0, 2, 1, 1), SolidRelation::equal);
  expect(joined, box(0.5, 0.25, 0.25, 1.5, 0.75, 0.75), SolidRelation::b_in_a);
}

TEST_CASE("solids: surfaces that run through each other at edges alone", "[lib][solids]") {
  // A bar whose edges lie in the faces of another one that is turned by 45 degrees.
  Pose turned = here;
  turned.linear() << 1, -1, 0, 1, 1, 0, 0, 0, 1;
  expect(box(-2, -2, -2, 2, 2, 2), box(-1, -1, -1, 1, 1, 1), SolidRelation::b_in_a, turned);
  expect(box(-2, -2, -2, 2, 2, 2), box(-1, -1, -2, 1, 1, 2), SolidRelation::b_in_a, turned);
  expect(box(-1, -1, -1, 1, 1, 1), box(-1, -1, -1, 1, 1, 1), SolidRelation::a_in_b, turned);
  expect(box(-2, -2, -1, 1, 1, 1), box(-1, -1, -1, 1, 1, 1), SolidRelation::overlapping, turned);
}

TEST_CASE("solids: open surfaces and flat poses are refused in one line", "[lib][solids]") {
  Mesh open = box(0, 0, 0, 1, 1, 1);
  CHECK(Object(open).is_closed());
  open.faces.pop_back();
  const Object lid(open), cube(box(0, 0, 0, 1, 1, 1));
  REQUIRE(lid.open_edge());
  CHECK(lid.open_edge()->face == 0);
  CHECK_FALSE(lid.is_closed());
  // Of several open edges one of the first face, though its vertices are the last.
  Mesh islands = box(0, 0, 0, 1, 1, 1);
  const std::size_t first = islands.faces.size();
  add_face(islands, {{5, 5, 5}, {6, 5, 5}, {5, 6, 5}});
  add_face(islands, {{0, 0, 5}, {1, 0, 5}, {0, 1, 5}});
  std::swap(islands.faces[first], islands.faces[first + 1]);
  const std::optional<OpenEdge> edge = Object(islands).open_edge();
  REQUIRE(edge);
  CHECK(edge->face == first);
  CHECK(edge->from == Vec3d(0, 0, 5));
  CHECK(edge->to == Vec3d(1, 0, 5));
  CHECK_THROWS_WITH(
      solids(cube, here, lid, here),
      "solids: the surface of B is open at the edge from (1, 0, 0) to (1, 1, 0) of face 0: an odd number of "
      "faces use it; close the mesh, or ask collide() about the surface");
  Pose flat = here;
  flat.linear().col(2) = flat.linear().col(0) + 0.5 * flat.linear().col(1);
  CHECK_THROWS_WITH(solids(cube, flat, cube, here),
                    "solids: the pose of A flattens space (its determinant is 0), so that the object has no volume");
  Object gone = cube;
  const Object taken = std::move(gone);
  CHECK_THROWS_AS(solids(gone, here, taken, here), std::invalid_argument);  // NOLINT: that is the test
  CHECK_THROWS_AS(gone.is_closed(), std::invalid_argument);
}

TEST_CASE("solids: shells that overlap or are there twice are never silently apart", "[lib][solids]") {
  const Mesh cube = box(0, 0, 0, 4, 4, 4);
  const auto ask = [](const Mesh& a, const Mesh& b, InsideRule rule) {
    return solids(Object(a), here, Object(b), here, {rule});
  };
  const Mesh two = both(cube, box(2, 1, 1, 6, 3, 3));
  const Mesh common = box(2.5, 1.5, 1.5, 3, 2, 2);  // in the space that the shells share
  const SolidResult odd = ask(two, common, InsideRule::odd);
  CHECK(odd.relation == SolidRelation::disjoint);
  REQUIRE(odd.overlap_a);
  CHECK(odd.overlap_a->relation == Relation::crossing);
  CHECK_FALSE(odd.overlap_b);
  CHECK(ask(common, two, InsideRule::odd).overlap_b);
  CHECK(ask(two, common, InsideRule::nonzero) == SolidRelation::b_in_a);
  CHECK(ask(two, cube, InsideRule::nonzero) == SolidRelation::b_in_a);
  CHECK(ask(two, box(4, 1, 1, 6, 3, 3), InsideRule::nonzero) == SolidRelation::b_in_a);
  const Mesh twice = both(cube, cube);
  CHECK(ask(twice, common, InsideRule::odd).relation == SolidRelation::disjoint);
  CHECK(ask(twice, common, InsideRule::odd).overlap_a);
  CHECK(ask(twice, common, InsideRule::nonzero) == SolidRelation::b_in_a);
  CHECK(ask(twice, cube, InsideRule::nonzero) == SolidRelation::equal);
  // One of them the other way round: nothing winds round any point, and the answer still says that they overlap.
  Mesh turned = twice;
  for (std::size_t f = cube.faces.size(); f < turned.faces.size(); ++f) {
    auto& vertex = turned.faces[f].vertex;
    std::reverse(vertex.begin(), vertex.begin() + static_cast<int>(turned.faces[f].kind));
  }
  CHECK(ask(turned, common, InsideRule::nonzero).relation == SolidRelation::disjoint);
  CHECK(ask(turned, common, InsideRule::nonzero).overlap_a);
  // A wall in common is an area in common; what meets at edges alone is none.
  CHECK(ask(both(cube, box(4, 0, 0, 6, 4, 4)), common, InsideRule::odd).overlap_a);
  CHECK_FALSE(ask(both(cube, box(4, 4, 0, 6, 6, 4)), common, InsideRule::odd).overlap_a);
  CHECK_FALSE(ask(both(cube, box(4, 1, 4, 6, 2, 6)), common, InsideRule::odd).overlap_a);
  CHECK_FALSE(ask(both(cube, box(1, 1, 1, 2, 2, 2)), common, InsideRule::odd).overlap_a);
  // A shell inside another the same way round is a cavity by one rule alone.
  const Mesh nested = both(cube, box(1, 1, 1, 3, 3, 3));
  CHECK(ask(nested, box(1.5, 1.5, 1.5, 2, 2, 2), InsideRule::odd) == SolidRelation::disjoint);
  CHECK(ask(nested, box(1.5, 1.5, 1.5, 2, 2, 2), InsideRule::nonzero) == SolidRelation::b_in_a);
  CHECK(ask(nested, cube, InsideRule::nonzero) == SolidRelation::equal);
  // Faces that are not all the same way round wind round nothing.
  Tetrahedron corner;
  corner.kind = Kind::quad;
  corner.v = {Vec3d(0, 0, 0), Vec3d(4, 0, 0), Vec3d(0, 4, 0), Vec3d(0, 0, 4)};
  const Mesh mixed = mesh_of(corner);  // cyclic corners: every other face is the other way round
  CHECK(ask(mixed, cube, InsideRule::odd) != SolidRelation::disjoint);
  CHECK_THROWS_WITH(ask(mixed, cube, InsideRule::nonzero),
                    Catch::Contains("the faces of A are not the same way round"));
  CHECK_THROWS_WITH(ask(cube, mixed, InsideRule::nonzero),
                    Catch::Contains("the faces of B are not the same way round"));
}

TEST_CASE("closed surfaces: vertices by coordinates, edges by parity", "[lib][solids]") {
  std::mt19937_64 random(sim::seed_from_environment());
  // Faces with vertices of their own, as from STL, with both zeros.
  Mesh soup = mesh_of({{0, 0, 0}, {1, 1, 0}}, {false, true, true, false}, random);  // an edge of four faces
  for (Vec3d& v : soup.vertices) {
    if (v.x() == 0 && random() % 2 == 0) v.x() = -0.0;
  }
  CHECK(Object(soup).is_closed());
  CHECK(Object(make_torus(2, 1, 8, 6, Kind::quad)).is_closed());
  CHECK(Object(make_gear(1, 2, 0.5, 1, 8, 2)).is_closed());
  Mesh fin = box(0, 0, 0, 1, 1, 1);
  add_face(fin, {{0, 0, 0}, {1, 0, 0}, {0, -1, -1}});
  CHECK_FALSE(Object(fin).is_closed());
  add_face(fin, {{0, 0, 0}, {0, -1, -1}, {1, 0, 0}});  // twice: bounds nothing
  CHECK(Object(fin).is_closed());
  expect(fin, box(0, 0, 0, 1, 1, 1), SolidRelation::equal);
  expect(fin, box(0, -2, -2, 1, -0.5, -0.5), SolidRelation::touching);  // meets the fin
  // An edge that one face uses whole and others in parts, at any place and in any direction.
  const auto tetrahedron = [](const Vec3d& split, double bulge) {
    const std::array<Vec3d, 4> v = {Vec3d(0, 0, 0), Vec3d(3, 0.75, 1.5), Vec3d(0, 2, 0), Vec3d(1, 1, 5)};
    const Vec3d m = v[0] + split.x() * (v[1] - v[0]) + Vec3d(0, bulge, 0);
    Mesh mesh;
    add_face(mesh, {v[0], m, v[2]});
    add_face(mesh, {m, v[1], v[2]});
    add_face(mesh, {v[0], v[3], v[1]});  // whole
    add_face(mesh, {v[1], v[3], v[2]});
    add_face(mesh, {v[2], v[3], v[0]});
    return mesh;
  };
  for (const double at : {0.25, 0.5, 0.75}) {
    const Object closed(tetrahedron({at, 0, 0}, 0));
    CHECK(closed.is_closed());
    CHECK(closed.twisted_edge() == std::nullopt);
    const Object open(tetrahedron({at, 0, 0}, 0x1p-50));
    CHECK_FALSE(open.is_closed());
    CHECK(open.open_edge()->face == 0);
    Pose inside = here;
    inside.translation() = Vec3d(1, 1, 1);
    inside.linear() *= 0x1p-6;
    CHECK(solids(closed, here, Object(box(0, 0, 0, 1, 1, 1)), inside) == SolidRelation::b_in_a);
  }
  // Two pieces of one line that do not make up the third.
  Mesh torn = tetrahedron({0.5, 0, 0}, 0);
  torn.faces.erase(torn.faces.begin());
  CHECK_FALSE(Object(torn).is_closed());
}

TEST_CASE("solids: faces without an area change nothing", "[lib][solids]") {
  const Mesh cube = box(0, 0, 0, 4, 4, 4);
  Mesh spiked = cube;
  add_face(spiked, {{0, 0, 0}, {4, 0, 0}, {4, 0, 0}});  // an edge of the cube
  add_face(spiked, {{4, 4, 4}, {4, 4, 4}, {4, 4, 4}});
  add_face(spiked, {{2, 2, 4}, {2, 2, 6}, {2, 2, 6}});  // stands on the cube
  add_face(spiked, {{2, 2, 2}, {2, 2, 3}, {2, 2, 3}});  // in the cube
  CHECK(Object(spiked).is_closed());
  expect(spiked, cube, SolidRelation::equal);
  expect(spiked, spiked, SolidRelation::equal);
  expect(spiked, box(1, 1, 1, 3, 3, 3), SolidRelation::b_in_a);
  expect(spiked, box(-1, -1, -1, 9, 9, 9), SolidRelation::a_in_b);
  expect(spiked, box(3, 3, 3, 5, 5, 5), SolidRelation::overlapping);
  expect(spiked, box(4, 0, 0, 8, 4, 4), SolidRelation::touching);
  expect(spiked, box(5, 5, 5, 6, 6, 6), SolidRelation::disjoint);
}

TEST_CASE("solids: more contacts than the first question asks for", "[lib][solids]") {
  const Mesh torus = make_torus(2, 1, 16, 12);
  expect(torus, torus, SolidRelation::equal);
}

TEST_CASE("solids: quads that are not flat are two triangles", "[lib][solids]") {
  Mesh roof = box(0, 0, 0, 4, 4, 4);
  roof.vertices[7].z() = 6;  // the top is cut from corner 4 to 7: a ridge; the other diagonal would be a valley
  REQUIRE(roof.faces[1].vertex == std::array<std::uint32_t, 4>{4, 5, 7, 6});
  const Mesh inside = box(1.75, 1.75, 4.5, 2.25, 2.25, 4.55);
  expect(roof, inside, SolidRelation::b_in_a);
  std::swap(roof.faces[1].vertex, roof.faces[0].vertex);
  roof.faces[0].vertex = {5, 7, 6, 4};
  expect(roof, inside, SolidRelation::disjoint);  // in the hull of the quad, above the valley
}

TEST_CASE("solids: tetrahedra against the oracle of pairs", "[lib][solids]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::map<SolidRelation, int> count;
  for (int i = 0; i < 4000; ++i) {
    Tetrahedron a = random_tetrahedron(1 + static_cast<int>(random() % 4), random);
    Tetrahedron b = i % 40 == 0 ? a : random_tetrahedron(1 + static_cast<int>(random() % 4), random);
    std::shuffle(b.v.begin(), b.v.end(), random);
    Pose pose_a = here;
    Pose pose_b = here;
    if (i % 5 == 1) pose_a = pose_b = random_pose(PoseClass::affine, 3, random);
    if (i % 5 == 2) pose_b = random_pose(PoseClass::rigid, 1, random);
    if (i % 5 == 3) {
      pose_a = random_pose(PoseClass::affine, 1, random);
      pose_b = random_pose(PoseClass::quarter_turns, 1, random);
    }
    if (i % 5 == 4) pose_b.linear() *= 3;
    const SolidRelation expected = truth(a, pose_a, b, pose_b);
    ++count[expected];
    const SolidRelation found = solids(Object(mesh_of(a)), pose_a, Object(mesh_of(b)), pose_b);
    if (found == expected) continue;
    FAIL("pair " << i << ": " << found << ", not " << expected << ", seed " << sim::seed_from_environment());
  }
  for (const auto& [relation, times] : count) std::cout << relation << ' ' << times << ' ';
  std::cout << '\n';
  CHECK(count.size() == 6);
}

TEST_CASE("solids: points of tetrahedra that overlap, by parity", "[lib][solids]") {
  std::mt19937_64 random(sim::seed_from_environment());
  int told = 0;
  for (int i = 0; i < 300; ++i) {
    std::array<std::vector<Tetrahedron>, 2> parts;
    std::array<Mesh, 2> mesh;
    for (const std::size_t side : {0U, 1U}) {
      for (std::size_t k = 0; k <= random() % 3; ++k) {
        const bool taken = side == 1 && random() % 3 == 0;  // from A, so that surfaces coincide
        parts[side].push_back(taken ? parts[0][random() % parts[0].size()] : random_tetrahedron(3, random));
        append(mesh[side], mesh_of(parts[side].back()));
      }
    }
    const SolidRelation found = solids(Object(mesh[0]), here, Object(mesh[1]), here);
    std::array<std::array<bool, 2>, 2> seen = {};
    std::uniform_int_distribution<int> coordinate(-3 * 64, 3 * 64);
    for (int k = 0; k < 300; ++k) {
      const Primitive p = point(Vec3d(coordinate(random), coordinate(random), coordinate(random)) / 64);
      std::array<bool, 2> in = {};
      bool on_surface = false;
      for (const std::size_t side : {0U, 1U}) {
        for (const Tetrahedron& t : parts[side]) {
          const Relation relation = exact_relation(t, p);
          on_surface = on_surface || relation == Relation::touching;
          if (relation == Relation::crossing) in[side] = !in[side];
        }
      }
      if (!on_surface) seen[in[0]][in[1]] = true;
    }
    INFO("pair " << i << ": " << found << ", seed " << sim::seed_from_environment());
    const bool apart = found == SolidRelation::disjoint || found == SolidRelation::touching;
    if (seen[1][1]) CHECK_FALSE(apart);
    if (seen[1][0]) CHECK((apart || found == SolidRelation::overlapping || found == SolidRelation::b_in_a));
    if (seen[0][1]) CHECK((apart || found == SolidRelation::overlapping || found == SolidRelation::a_in_b));
    told += seen[1][1] && seen[1][0] && seen[0][1];
    if (seen[1][1] && seen[1][0] && seen[0][1]) CHECK(found == SolidRelation::overlapping);
  }
  CHECK(told > 50);
}

namespace {

/// The places of points to a set of unit cubes, from their coordinates.
PointPlace place_in(const std::set<std::array<int, 3>>& cubes, const Vec3d& p) {
  bool any_in = false;
  bool all_in = true;
  for (unsigned corner = 0; corner < 8; ++corner) {  // of the cubes around the point
    std::array<int, 3> cube = {};
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = p[static_cast<Eigen::Index>(i)];
      const bool is_whole = x == std::floor(x);
      cube[i] = static_cast<int>(std::floor(x)) - (is_whole && (corner >> i & 1U) != 0 ? 1 : 0);
    }
    const bool is_in = cubes.count(cube) != 0;
    any_in = any_in || is_in;
    all_in = all_in && is_in;
  }
  return all_in ? PointPlace::inside : any_in ? PointPlace::on_surface : PointPlace::outside;
}

}  // namespace

TEST_CASE("inside: points and sets of cubes", "[lib][solids]") {
  std::mt19937_64 random(1000 * sim::seed_from_environment() + 77);
  std::map<std::string, int> places;
  for (int n = 0; n < 15; ++n) {
    // The surface of a set of cubes: faces between one that is in it and one that is not.
    std::set<std::array<int, 3>> cubes;
    for (int i = 0; i < 12; ++i) cubes.insert({int(random() % 3), int(random() % 3), int(random() % 3)});
    Mesh mesh;
    for (const auto& [x, y, z] : cubes) {
      const Mesh one = subdivided(box(x, y, z, x + 1, y + 1, z + 1));
      for (const Mesh::Face& face : one.faces) {
        Vec3d middle = Vec3d::Zero();
        for (std::size_t i = 0; i < 3; ++i) middle += one.vertices[face.vertex[i]] / 3;
        std::array<int, 3> beyond = {x, y, z};
        for (std::size_t i = 0; i < 3; ++i) {
          const double at = middle[Eigen::Index(i)] - beyond[i];
          if (std::abs(at) < 1e-9) beyond[i] -= 1;
          if (std::abs(at - 1) < 1e-9) beyond[i] += 1;
        }
        if (cubes.count(beyond) != 0) continue;
        const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
        for (std::size_t i = 0; i < static_cast<std::size_t>(face.kind); ++i) {
          mesh.vertices.push_back(one.vertices[face.vertex[i]]);
        }
        mesh.faces.push_back({face.kind, {offset, offset + 1, offset + 2, face.kind == Kind::quad ? offset + 3 : 0}});
      }
    }
    std::vector<Vec3d> points;
    for (int i = 0; i < 2000; ++i) {  // on quarters of the grid, and off it by little
      Vec3d p;
      for (double& x : p) {
        x = double(int(random() % 17) - 2) / 4;
        if (random() % 4 == 0) x = std::nextafter(x, random() % 2 == 0 ? 9 : -9);
      }
      points.push_back(p);
    }
    const Object object(mesh);
    REQUIRE(object.is_closed());
    const std::vector<PointPlace> found = inside(object, here, points, {}, 1 + unsigned(random() % 3));
    for (std::size_t i = 0; i < points.size(); ++i) {
      INFO(points[i].transpose());
      REQUIRE(name_of(found[i]) == std::string(name_of(place_in(cubes, points[i]))));
      ++places[name_of(found[i])];
    }
    // Turned by a quarter and moved: the same places.
    const Pose pose = make_pose(Vec3d(5, -3, 0.5), Vec3d(90, 0, 180));
    std::vector<Vec3d> there;
    std::vector<PointPlace> same;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3d p = pose * points[i];
      if (pose.inverse() * p != points[i]) continue;  // rounded
      there.push_back(p);
      same.push_back(found[i]);
    }
    CHECK(there.size() > 300);
    CHECK(inside(object, pose, there) == same);
  }
  for (const auto& [place, count] : places) std::cout << place << ' ' << count << ' ';
  std::cout << '\n';
  CHECK(places.size() == 3);
}

TEST_CASE("inside: rules, quads that are not flat, errors", "[lib][solids]") {
  const Object twice(both(box(0, 0, 0, 2, 1, 1), box(1, 0, 0, 3, 1, 1)));  // shells that overlap
  const std::vector<Vec3d> points = {{0.5, 0.5, 0.5}, {1.5, 0.5, 0.5}, {1, 0.5, 0.5}, {4, 0.5, 0.5}};
  using Places = std::vector<PointPlace>;
  CHECK(inside(twice, here, points) ==
        Places{PointPlace::inside, PointPlace::outside, PointPlace::on_surface, PointPlace::outside});
  CHECK(inside(twice, here, points, {InsideRule::nonzero}) ==
        Places{PointPlace::inside, PointPlace::inside, PointPlace::on_surface, PointPlace::outside});
  CHECK(inside(twice, here, {}).empty());

  Mesh bent = box(0, 0, 0, 1, 1, 1);  // the last corner of the roof is higher: two triangles, cut by a diagonal
  for (Vec3d& v : bent.vertices) v = v == Vec3d(1, 1, 1) ? Vec3d(1, 1, 2) : v;
  const Object roof(bent);
  const std::vector<PointPlace> on = inside(roof, here, {{0.5, 0.5, 1}, {0.5, 0.5, 1.25}, {0.5, 0.5, 1.5}});
  const auto count = std::count(on.begin(), on.end(), PointPlace::on_surface);
  CHECK(count == 1);  // one of the two diagonals; what is between is in the hull, and on neither triangle
  CHECK(on[1] != PointPlace::on_surface);

  Mesh open = box(0, 0, 0, 1, 1, 1);
  open.faces.pop_back();
  CHECK_THROWS_WITH(inside(Object(open), here, points), Catch::StartsWith("solids: the surface of the object is open"));
  CHECK_THROWS_WITH(inside(roof, here, {{0, 0, std::nan("")}}), Catch::Contains("point"));
}

TEST_CASE("solids: a scene, a device", "[lib][solids]") {
  Tetrahedron corner;  // beyond a corner of the last cube, though their boxes overlap
  corner.kind = Kind::quad;
  corner.v = {Vec3d(5.75, 1.5, 1), Vec3d(6.5, 0.75, 1), Vec3d(6.25, 1.25, 0.75), Vec3d(6.5, 1.5, 1.5)};
  const Object cube(box(0, 0, 0, 1, 1, 1)), core(box(0.25, 0.25, 0.25, 0.5, 0.5, 0.5));
  Scene scene;
  scene.add(cube);
  scene.add(cube, shifted(1, 0, 0));
  scene.add(core);
  scene.add(cube, shifted(5, 0, 0));
  scene.add(Object(mesh_of(corner)));
  CHECK(scene.candidates().back() == std::pair<Scene::Id, Scene::Id>{4, 5});
  const auto device = open_cpu_device();
  const std::vector<SolidPair> pairs = solids(*device, scene);
  REQUIRE(pairs.size() == 2);
  CHECK((pairs[0].a == 1 && pairs[0].b == 2 && pairs[0].relation == SolidRelation::touching));
  CHECK((pairs[1].a == 1 && pairs[1].b == 3 && pairs[1].relation == SolidRelation::b_in_a));
  CHECK(solids(*device, core, here, cube, here) == SolidRelation::a_in_b);
}

TEST_CASE("solids: sets of cubes", "[lib][solids]") { check_cubes(5000); }
TEST_CASE("solids: more sets of cubes", "[.long]") { check_cubes(300000); }

TEST_CASE("solids: boxes that overlap, by parity", "[lib][solids]") {
  std::map<SolidRelation, int> count;
  for (std::uint64_t i = 0; i < 50; ++i) check_parity(sim::seed_from_environment() + 59 + i, count);
  CHECK(count[SolidRelation::touching] >= 5);
  CHECK(count[SolidRelation::overlapping] >= 5);
}

TEST_CASE("solids: tetrahedra of which only one piece of a face shows the overlap", "[lib][solids]") {
  const auto tetrahedron = [](const Vec3d& p, const Vec3d& q, const Vec3d& r, const Vec3d& s) {
    Tetrahedron t;
    t.kind = Kind::quad;
    t.v = {p, q, r, s};
    return t;
  };
  const std::array<Tetrahedron, 2> pairs[] = {
      {tetrahedron({-1, 0, -1}, {-2, 2, 2}, {-1, 2, 1}, {0, -2, 2}),
       tetrahedron({-1, 1, 0}, {0, 2, 1}, {-1, 2, -2}, {-1, 1, 1})},
      {tetrahedron({-2, 2, -2}, {2, -2, -2}, {1, 1, -2}, {-2, 0, -1}),
       tetrahedron({-1, -1, -2}, {0, 2, 1}, {0, -2, 1}, {-2, -1, 2})},
      {tetrahedron({0, -1, -2}, {2, 2, -1}, {1, 1, -1}, {1, -1, 2}),
       tetrahedron({0, 0, -2}, {0, 0, 1}, {-2, 2, -2}, {1, -2, 1})},
  };
  for (const auto& [a, b] : pairs) {
    REQUIRE(truth(a, here, b, here) == SolidRelation::overlapping);
    // With any vertex first: faces and the cuts in them begin elsewhere.
    for (int turn = 0; turn < 4; ++turn) {
      Tetrahedron turned = b;
      std::rotate(turned.v.begin(), turned.v.begin() + turn, turned.v.end());
      expect(mesh_of(a), mesh_of(turned), SolidRelation::overlapping);
    }
  }
}

TEST_CASE("solids: a fold that bounds nothing and hangs on to a box inside another", "[lib][solids]") {
  // The first faces of the inner surface lie in one place, so neither is a boundary; the box is.
  Mesh fin;
  add_face(fin, {{0, 0, 0}, {1, 0, 0}, {0, -1, -1}});
  add_face(fin, {{0, 0, 0}, {0, -1, -1}, {1, 0, 0}});
  expect(box(-9, -9, -9, 9, 9, 9), both(fin, box(0, 0, 0, 1, 1, 1)), SolidRelation::b_in_a);
  expect(box(-9, -9, -9, 9, 9, 9), fin, SolidRelation::disjoint);
}

TEST_CASE("solids: coordinates in the world beyond the doubles", "[lib][solids]") {
  Pose pose = here;
  pose.linear() *= 0x1p500;
  const auto big = [](double x0, double y0, double z0, double x1, double y1, double z1) {
    return make_box(0x1p600 * Vec3d(x0, y0, z0), 0x1p600 * Vec3d(x1, y1, z1));
  };
  const auto relation = [&](const Mesh& a, const Mesh& b) { return solids(Object(a), pose, Object(b), pose); };
  for (const double at : {-9.0, -2.0, 0.0, 5.0}) {  // all below 0, some, none
    const auto cube = [&](double from, double to) {
      return big(at + from, at + from, at + from, at + to, at + to, at + to);
    };
    CAPTURE(at);
    CHECK(relation(cube(0, 4), cube(0, 4)) == SolidRelation::equal);
    CHECK(relation(cube(1, 2), cube(0, 4)) == SolidRelation::a_in_b);
    CHECK(relation(cube(0, 4), cube(0, 2)) == SolidRelation::b_in_a);
    CHECK(relation(cube(0, 4), cube(2, 6)) == SolidRelation::overlapping);
    CHECK(relation(cube(0, 4), cube(4, 6)) == SolidRelation::touching);
    CHECK(relation(cube(0, 4), cube(5, 6)) == SolidRelation::disjoint);
  }
}
