// SPDX-License-Identifier: Apache-2.0
// What an outline means, from files and from arrays: docs/cpp/mesh_files.md has the rule.
#include <catch2/catch.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <cchip/program/seed.hpp>
#include <string>
#include <vector>

#include "outlines.hpp"

using cchip::FaceKinds;
using cchip::Kind;
using cchip::Mesh;
using cchip::Vec3d;

namespace {

Mesh load(const std::vector<Vec3d>& corners, FaceKinds kinds = FaceKinds::triangles) {
  std::string text;
  std::string face = "f";
  for (std::size_t i = 0; i < corners.size(); ++i) {
    text += "v";
    for (const double x : corners[i]) text += " " + std::to_string(x);
    text += "\n";
    face += " " + std::to_string(i + 1);
  }
  return cchip::parse_mesh(text + face + "\n", "t.obj", kinds);
}

Mesh from_array(const std::vector<Vec3d>& quad) {
  cchip::FaceMatrix face(1, 4);
  face << 0, 1, 2, 3;
  Eigen::MatrixXd corners(4, 3);
  for (Eigen::Index i = 0; i < 4; ++i) corners.row(i) = quad[static_cast<std::size_t>(i)];
  return cchip::make_mesh(corners, face);
}

bool covers(const Mesh& mesh, double x, double y, double low = -1, double high = 1) {
  cchip::Primitive needle;
  needle.v = {Vec3d(x, y, low), Vec3d(x, y, high), Vec3d(x, y, high), Vec3d::Zero()};
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    if (cchip::exact_intersects(mesh.primitive(i), needle)) return true;
  }
  return false;
}

std::string message_of(const std::vector<Vec3d>& corners) {
  try {
    load(corners);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

/// A quad from a file in both ways, and from an array.
std::vector<Mesh> everywhere(const std::vector<Vec3d>& quad) {
  return {load(quad), load(quad, FaceKinds::triangles_and_quads), from_array(quad)};
}

}  // namespace

TEST_CASE("outline: random ones against the even-odd rule", "[lib][outline]") {
  cchip::outlines::Campaign campaign(cchip::sim::seed_from_environment());
  for (int i = 0; i < 20000; ++i) {
    const std::string what = campaign.one();
    INFO(campaign.obj());
    REQUIRE(what == "");
  }
  CHECK(campaign.crossed > 1000);
}

TEST_CASE("outline: products of 28 bits decide about a dent", "[lib][outline]") {
  const std::vector<Vec3d> quad = {{701408733, 0, 0}, {0, 0, 0}, {433494437, 267914296, 0}, {701408733, 433494437, 0}};
  for (const Mesh& mesh : everywhere(quad)) {
    CHECK_FALSE(covers(mesh, 350704366.5, 216747218.5));
    CHECK(covers(mesh, 433494437, 267914296));
    CHECK(covers(mesh, 433494437, 200000000));
    CHECK(mesh.polygons_cut == 1);
    CHECK(mesh.number_in_file(1) == 0);
  }
}

TEST_CASE("outline: the view is chosen by exact areas", "[lib][outline]") {
  const Mesh mesh = load({{0, 0, 0},
                          {803742888, 496740423, 0},
                          {930234860, 574916761, 0},
                          {481810071, 297775000, 0},
                          {764654719, 472582606, 0}});
  CHECK_FALSE(covers(mesh, 635583592.125, 392812262.625));
}

TEST_CASE("outline: parts that outweigh each other have an area", "[lib][outline]") {
  // A figure eight whose loops meet in a corner.
  const Mesh eight = load({{0, 2, 0}, {1, 1, 0}, {2, 2, 0}, {3, 3, 0}, {4, 2, 0}, {3, 1, 0}, {2, 2, 0}, {1, 3, 0}});
  CHECK(covers(eight, 1, 2));
  CHECK(covers(eight, 3, 2.5));
  CHECK_FALSE(covers(eight, 2, 1.5));
  CHECK_FALSE(covers(eight, 2, 2.5));
  // Standing upright, as a plane in which neither loop outweighs the other.
  const Mesh upright = load({{0, 7, 2}, {1, 7, 1}, {2, 7, 2}, {3, 7, 3}, {4, 7, 2}, {3, 7, 1}, {2, 7, 2}, {1, 7, 3}});
  CHECK(covers(upright, 1, 7, 1.5, 1.75));
  CHECK_FALSE(covers(upright, 2, 7, 1, 1.75));
}

TEST_CASE("outline: sides that cross are named", "[lib][outline]") {
  const std::string message = message_of({{0, 0, 0}, {2, 2, 0}, {2, 1, 0}, {2, 0, 0}, {0, 2, 0}});
  CHECK(message ==
        "t.obj:6: face 0: its sides 0 and 3 cross (side 0 leads from the face's first corner to its second, seen along "
        "z); repair the file or write it again");
  CHECK(message_of({{0, 0, 5}, {2, 2, 5}, {2, 1, 5}, {2, 0, 5}, {0, 3, 5}}).find("sides 0 and 3 cross") !=
        std::string::npos);
}

TEST_CASE("outline: four corners in the wrong order are their hull, whoever asks", "[lib][outline]") {
  const std::vector<std::vector<Vec3d>> quads = {{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},
                                                 {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
                                                 {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 2, 0}}};
  for (const auto& quad : quads) {
    for (const Mesh& mesh : everywhere(quad)) {
      CHECK(covers(mesh, 0.5, 0.125));
      CHECK(covers(mesh, 0.125, 0.5));
      CHECK(covers(mesh, 0.5, 0.875));
      CHECK(covers(mesh, 0.875, 0.5));
      CHECK_FALSE(covers(mesh, 1.125, 0.5));
    }
  }
}

TEST_CASE("outline: four corners with a dent or a spike are cut, whoever asks", "[lib][outline]") {
  for (const Mesh& mesh : everywhere({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}})) {
    CHECK(covers(mesh, 0.5, 0.5));
    CHECK(covers(mesh, 3, 0.25));
    CHECK_FALSE(covers(mesh, 1.5, 1.5));
    CHECK(mesh.faces.size() == 2);
  }
  for (const Mesh& mesh : everywhere({{0, 0, 0}, {4, 0, 0}, {2, 0, 0}, {0, 4, 0}})) {
    CHECK(covers(mesh, 3, 0));
    CHECK(covers(mesh, 0.5, 0.5));
    CHECK_FALSE(covers(mesh, 2, 1));
  }
  // nearly flat ones, too: their hull would fill the dent
  for (const Mesh& mesh : everywhere({{0, 0, 0}, {4, 0, 0}, {1, 1, 0.0625}, {0, 4, 0}})) {
    CHECK_FALSE(covers(mesh, 1.5, 1.5));
  }
}

TEST_CASE("outline: spikes, and corners on other sides", "[lib][outline]") {
  const Mesh spike = load({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 4, 0}, {2, 6, 0}, {2, 4, 0}, {0, 4, 0}});
  CHECK(covers(spike, 2, 5.5));
  CHECK(covers(spike, 1, 1));
  CHECK_FALSE(covers(spike, 2.5, 5));
  CHECK_FALSE(covers(spike, 2, 6.5));
  const Mesh touching = load({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}});
  CHECK(covers(touching, 0.5, 1));
  CHECK(covers(touching, 3.5, 1));
  CHECK_FALSE(covers(touching, 2, 2));
}

TEST_CASE("outline: what the view hides is covered, too", "[lib][outline]") {
  // A step: two corners are above each other, seen along z.
  const Mesh step = load({{0, 0, 0}, {2, 0, 0}, {2, 0, 1}, {8, 0, 1}, {8, 8, 1}, {0, 8, 0}});
  CHECK(covers(step, 2, 0, 0.25, 0.5));
  CHECK(covers(step, 2, 0, 0.75, 0.875));
  // A corner is below another side.
  const Mesh below = load({{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {4, 0, -2}, {0, 8, 0}});
  CHECK(covers(below, 3, 0, -0.125, 0.125));
  CHECK(covers(below, 4, 0, -2, -1.75));
}

TEST_CASE("outline: thousands of corners", "[lib][outline]") {
  std::vector<Vec3d> ring;
  for (int i = 0; i < 16000; ++i) ring.emplace_back(i, i % 2 == 0 ? 1 : 2, 0);
  ring.emplace_back(15999, -3, 0);
  ring.emplace_back(0, -3, 0);
  const Mesh mesh = load(ring);
  CHECK(mesh.faces.size() == ring.size() - 2);
  CHECK(covers(mesh, 777, 1.875));
  CHECK_FALSE(covers(mesh, 778, 1.875));
  ring.resize(16385, Vec3d(0, 0, 0));
  CHECK(message_of(ring).find("face 0 has more than 16384 corners") != std::string::npos);
}
