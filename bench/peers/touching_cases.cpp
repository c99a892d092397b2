// SPDX-License-Identifier: Apache-2.0
#include "touching_cases.hpp"

#include <algorithm>
#include <cchip/shapes.hpp>
#include <cmath>
#include <utility>

#include "parts.hpp"

namespace cchip::testing {
namespace {

Pose moved(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }

Mesh tetrahedron(const Vec3d& origin, const std::array<Vec3d, 4>& corners) {
  Mesh mesh;
  for (const Vec3d& corner : corners) mesh.vertices.emplace_back(origin + corner);
  mesh.faces = {
      {Kind::tri, {0, 1, 2, 0}}, {Kind::tri, {0, 3, 1, 0}}, {Kind::tri, {1, 3, 2, 0}}, {Kind::tri, {2, 3, 0, 0}}};
  return mesh;
}

void add_quad(Mesh& mesh, const std::array<Vec3d, 4>& corners) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.faces.push_back({Kind::quad, {first, first + 1, first + 2, first + 3}});
}

}  // namespace

std::vector<TouchingCase> touching_cases() {
  std::vector<TouchingCase> cases;

  const Mesh cube = parts::box({0, 0, 0}, {1, 1, 1});
  const Mesh brick = parts::box({1, 0.25, 0.25}, {2, 0.75, 0.75});
  cases.push_back({"flush boxes", cube, brick});
  cases.push_back({"flush boxes, pressed in by 2^-53", cube, brick, moved(-0x1p-53, 0, 0)});
  cases.push_back({"flush boxes, pulled off by 2^-52", cube, brick, moved(0x1p-52, 0, 0)});
  // The brick from its own origin, placed by a product of two poses whose translation is rounded.
  Pose link = Pose::Identity();
  link.linear() << 0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1;
  link.translation() << 0.1, 0.2, 0.3;
  const Mesh brick_at_origin = parts::box({0, 0, 0}, {1, 0.5, 0.5});
  cases.push_back(
      {"flush boxes, poses multiplied in doubles", cube, brick_at_origin, link * moved(1, 0.25, 0.25), link});

  const Mesh on_edge = parts::prism({{0.5, 1}, {0.75, 1.25}, {0.5, 1.5}, {0.25, 1.25}}, 0.25, 0.75);
  cases.push_back({"box on its edge on a face", cube, on_edge});

  // The plane x + 2 y + 3 z = 0 through a point of a site's coordinates in millimetres, where doubles are 2^-20 apart.
  const Vec3d site(4.5e9, 5.2e9, 1e5);
  const Mesh ground = tetrahedron(site, {Vec3d(6, 0, -2), Vec3d(-4, 5, -2), Vec3d(-1, -4, 3), Vec3d(-2, -4, -6)});
  const Mesh tip = tetrahedron(site, {Vec3d(0, 0, 0), Vec3d(3, 4, 6), Vec3d(1, 5, 6), Vec3d(2, 3, 8)});
  cases.push_back({"vertex on a face far from the origin", ground, tip});
  cases.push_back({"vertex below a face far from the origin", ground, tip, moved(-0x1p-20, 0, 0)});
  cases.push_back({"vertex above a face far from the origin", ground, tip, moved(0x1p-20, 0, 0)});

  const Pose far_away(make_pose({1e6, -2e6, 3e6}, {10, 20, 30}));
  cases.push_back({"vertex on a face, both turned and far from the origin", ground, tip, far_away, far_away});

  const Mesh plate = parts::prism(parts::circle(2, 24), 0, 1, parts::circle(1, 24));
  const auto peg = [](double radius) { return parts::prism(parts::circle(radius, 24), -1, 2); };
  cases.push_back({"peg in its hole", plate, peg(1)});
  cases.push_back({"peg in its hole, both turned and far from the origin", plate, peg(1), far_away, far_away});
  cases.push_back({"peg in its hole, thicker by 2^-52", plate, peg(1 + 0x1p-52)});
  cases.push_back({"peg in its hole, thinner by 2^-53", plate, peg(1 - 0x1p-53)});

  const parts::Outline outline = parts::gear(9000, 11000, 16);
  const Mesh wheel = parts::prism(outline, -2000, 2000);
  const Mesh pinion = parts::prism(outline, -1000, 1000);
  const Pose in_mesh = parts::in_mesh(outline);
  cases.push_back({"gear pair in mesh", wheel, pinion, in_mesh});
  cases.push_back({"gear pair, moved on by 2^-30", wheel, pinion, moved(0, -0x1p-30, 0) * in_mesh});
  cases.push_back({"gear pair, moved back by 2^-30", wheel, pinion, moved(0, 0x1p-30, 0) * in_mesh});

  cases.push_back({"nested boxes", cube, parts::box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75})});
  cases.push_back({"identical objects", wheel, wheel});
  const double end = 0x1p-30;
  const Mesh bar = parts::box({0, 0, 0}, {3, 1, 1});
  cases.push_back({"bars of one section, pushed into each other", bar, bar, moved(2, 0, 0)});
  cases.push_back({"bars of one section, pushed into each other, one shrunk by 2^-30", bar,
                   parts::box({2 + end, end, end}, {5 - end, 1 - end, 1 - end})});
  // Cubes of side 2 whose faces are cut into four squares of side 1.
  Mesh raster;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d normal = 2 * Vec3d::Unit(axis);
    const Vec3d u = 2 * Vec3d::Unit((axis + 1) % 3);
    const Vec3d v = 2 * Vec3d::Unit((axis + 2) % 3);
    const Vec3d none = Vec3d::Zero();
    add_quad(raster, {none, v, Vec3d(u + v), u});
    add_quad(raster, {normal, Vec3d(normal + u), Vec3d(normal + u + v), Vec3d(normal + v)});
  }
  raster = subdivided(raster);
  cases.push_back(
      {"cubes cut on one raster, a corner of one at the centre of the other", raster, raster, moved(1, 1, 1)});
  const auto add_strip = [](Mesh& mesh, double from, double to) {
    add_quad(mesh, {Vec3d(from, -2, 0), Vec3d(to, -2, 0), Vec3d(to, 2, 0), Vec3d(from, 2, 0)});
  };
  Mesh floor;
  add_strip(floor, -1, 0);
  add_strip(floor, 0, 1);
  Mesh whole_floor;
  add_strip(whole_floor, -1, 1);
  Mesh sheet;
  add_quad(sheet, {Vec3d(0, -1, -1), Vec3d(0, 1, -1), Vec3d(0, 1, 1), Vec3d(0, -1, 1)});
  cases.push_back({"sheet through the common edge of two faces", floor, sheet});
  cases.push_back({"sheet beside the common edge of two faces", floor, sheet, moved(0x1p-53, 0, 0)});
  cases.push_back({"sheet through the same floor as one face", whole_floor, sheet});
  return cases;
}

std::vector<FarCase> far_cases() {
  // Whole millimetres, so that parts that are flush at the origin are flush everywhere, exactly.
  const parts::Outline octagon = {{60, 25},   {25, 60},   {-25, 60}, {-60, 25},
                                  {-60, -25}, {-25, -60}, {25, -60}, {60, -25}};
  const parts::Outline rim = {{120, 50},   {50, 120},   {-50, 120}, {-120, 50},
                              {-120, -50}, {-50, -120}, {50, -120}, {120, -50}};
  // Two wedges that lie on each other on a plane that has no axis in it: x + 2 y + 3 z = 0.
  const Mesh slope =
      tetrahedron({0, 0, 0}, {Vec3d(60, 0, -20), Vec3d(-40, 50, -20), Vec3d(-10, -40, 30), Vec3d(-20, -40, -60)});
  const Mesh wedge =
      tetrahedron({0, 0, 0}, {Vec3d(20, 5, -10), Vec3d(-10, 20, -10), Vec3d(0, -15, 10), Vec3d(20, 30, 80)});
  struct Part {
    const char* name;
    Mesh a, b;
    Vec3d out;  ///< moves B away from A, along one axis
  };
  const std::vector<Part> list = {
      {"box on a box", parts::box({0, 0, 0}, {100, 50, 20}), parts::box({100, 10, 5}, {150, 40, 15}), {1, 0, 0}},
      {"wedge on a slope", slope, wedge, {0, 0, 1}},
      {"bar across a hole", parts::prism(rim, 0, 20, octagon), parts::box({-100, -20, 20}, {100, 20, 30}), {0, 0, 1}}};
  std::vector<FarCase> cases;
  for (const Part& part : list) {
    for (const bool posed : {false, true}) {
      for (const auto& [place, distance] :
           {std::pair{"origin", 0.0}, std::pair{"5 km", 5e6}, std::pair{"50 km", 5e7}}) {
        for (const auto& [state, side] :
             {std::pair{"one bit apart", 1}, std::pair{"flush", 0}, std::pair{"one bit in", -1}}) {
          FarCase one = {part.name, place, posed ? "pose" : "coordinates", state, side <= 0, part.a, part.b};
          const Vec3d away(distance, distance, distance);
          if (posed) {
            one.pose = make_pose(away, {10, 20, 30});
          } else {
            for (Mesh* mesh : {&one.a, &one.b}) {
              for (Vec3d& v : mesh->vertices) v += away;
            }
          }
          // one bit of the largest coordinate of B: every vertex can take it
          double largest = 0;
          for (const Vec3d& v : one.b.vertices) largest = std::max(largest, v.cwiseAbs().maxCoeff());
          const double bit = std::nextafter(largest, 2 * largest) - largest;
          for (Vec3d& v : one.b.vertices) v += side * bit * part.out;
          cases.push_back(std::move(one));
        }
      }
    }
  }
  return cases;
}

}  // namespace cchip::testing
