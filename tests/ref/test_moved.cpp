// SPDX-License-Identifier: Apache-2.0
// Objects whose vertices move, and faces of one object that touch each other.
#include <catch2/catch.hpp>
#include <cchip/bvh/image.hpp>
#include <cchip/device/device.hpp>
#include <cchip/exact/oracle.hpp>
#include <cchip/reference/brute_force.hpp>
#include <cchip/sim/seed.hpp>
#include <limits>

#include "bvh_meshes.hpp"
#include "random_poses.hpp"

using namespace cchip;
using namespace cchip::testing;

namespace {

std::vector<Mesh> bodies(std::mt19937_64& random) {
  return {make_torus(1, 0.4, 6, 5), make_torus(1, 0.4, 5, 4, Kind::quad), make_gear(0.8, 1.2, 0.3, 0.5, 3, 1),
          soup(24, false, random), soup(24, true, random)};
}

bool same(const bvh::Dop26& x, const bvh::Dop26& y) { return x.least == y.least && x.greatest == y.greatest; }

}  // namespace

TEST_CASE("moved: the nodes of a tree come back from the object, and a refit restores their volumes",
          "[ref][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  for (const Mesh& mesh : assorted_meshes(random)) {
    INFO(mesh.name);
    const bvh::Tree built = bvh::build_tree(mesh);
    bvh::Tree tree = bvh::SupportTree(mesh, built).topology();
    REQUIRE(tree.faces == built.faces);
    REQUIRE(tree.depth == built.depth);
    REQUIRE(tree.nodes.size() == built.nodes.size());
    bvh::refit(tree, mesh);
    for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
      REQUIRE(tree.nodes[n].kind == built.nodes[n].kind);
      REQUIRE(tree.nodes[n].count == built.nodes[n].count);
      REQUIRE(tree.nodes[n].first == built.nodes[n].first);
      REQUIRE(same(tree.nodes[n].dop, built.nodes[n].dop));
    }
  }
}

TEST_CASE("moved: an object with other vertices answers like brute force, and so does its image", "[ref][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const CollisionRequest all = {CollisionRequest::Contacts::all};
  const auto cpu = open_device("cpu");
  const auto model = open_device("model");
  std::size_t hits = 0;
  std::size_t queries = 0;
  for (int round = 0; round < 6; ++round) {
    const std::vector<Mesh> meshes = bodies(random);
    for (const Mesh& mesh : meshes) {
      const Object rest(mesh);
      Object object = rest;
      // A little, much, and to another size and place altogether.
      for (const double range : {0.01, 0.5, 100.0}) {
        const Mesh next = noisy(object.mesh(), range, random);
        object = object.moved(next.vertices);
        REQUIRE(object.id() != rest.id());
        REQUIRE(object.mesh().vertices == next.vertices);
        const Object other(meshes[random() % meshes.size()]);
        for (int i = 0; i < 4; ++i) {
          const Pose pose = make_pose(random_vector(random, 0.5 + range), random_vector(random, 180));
          const auto expected = brute_force_contacts(object.mesh(), Pose::Identity(), other.mesh(), pose);
          hits += expected.empty() ? 0 : 1;
          ++queries;
          for (Device* device : {cpu.get(), model.get()}) {
            CAPTURE(device->name(), range, round);
            REQUIRE(collide(*device, object, Pose::Identity(), other, pose, all).contacts == expected);
            REQUIRE(collide(*device, object, Pose::Identity(), other, pose).hit == !expected.empty());
          }
        }
      }
      REQUIRE(rest.mesh().vertices == mesh.vertices);  // an object never changes
    }
  }
  CHECK(hits > queries / 5);
  CHECK(hits < queries);
}

TEST_CASE("moved: vertices that make no sense are refused, and the object stays", "[ref][collide]") {
  const Object object(make_torus(1, 0.4, 6, 5));
  std::vector<Vec3d> vertices = object.mesh().vertices;
  vertices.pop_back();
  REQUIRE_THROWS_WITH(object.moved(vertices), Catch::Contains("29 vertices, the object has 30"));
  vertices = object.mesh().vertices;
  vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  REQUIRE_THROWS_WITH(object.moved(vertices), Catch::Contains("is not finite or beyond 2^1000"));
  REQUIRE(object.mesh().vertices.size() == 30);
}

TEST_CASE("self-contacts: those of brute force, without neighbours", "[ref][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::array<std::size_t, 3> relations = {};
  for (int round = 0; round < 8; ++round) {
    for (const Mesh& body : bodies(random)) {
      const Mesh mesh = round == 0 ? body : noisy(body, 0.1 * round, random);
      std::vector<Contact> expected;
      for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) {
        for (std::uint32_t k = i + 1; k < mesh.faces.size(); ++k) {
          const Primitive a = mesh.primitive(i);
          const Primitive b = mesh.primitive(k);
          bool neighbours = false;
          for (std::size_t v = 0; v < a.vertex_count(); ++v) {
            for (std::size_t w = 0; w < b.vertex_count(); ++w) neighbours |= a.v[v] == b.v[w];
          }
          const Relation relation = exact_relation(a, b);
          ++relations[static_cast<std::size_t>(relation)];
          if (!neighbours && relation != Relation::apart) expected.push_back({i, k, relation});
        }
      }
      const std::vector<Contact> found = self_contacts(Object(mesh));
      REQUIRE(found == expected);
      for (std::size_t i = 0; i < found.size(); ++i) REQUIRE(found[i].relation == expected[i].relation);
      if (!expected.empty()) REQUIRE(self_contacts(Object(mesh), 1).size() == 1);
    }
  }
  for (const std::size_t count : relations) CHECK(count > 100);
}

TEST_CASE("self-contacts: parts of a cut polygon are neighbours, closed shapes have none", "[ref][collide]") {
  REQUIRE(self_contacts(Object(make_torus(1, 0.4, 16, 12))).empty());
  Mesh cut;  // a pentagon in two parts that share no vertex, and a face across both
  add_face(cut, {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}});
  add_face(cut, {{0.5, 0.5, 0}, {3, 0, 0}, {3, 3, 0}});
  add_face(cut, {{0.6, 0.6, -1}, {0.6, 0.6, 1}, {1.5, 0.5, 1}});
  cut.file_face = {0, 0, 1};
  const std::vector<Contact> found = self_contacts(Object(cut));
  REQUIRE(found == std::vector<Contact>{{0, 1, {}}});
  REQUIRE(found.front().relation == Relation::crossing);
  REQUIRE_THROWS_WITH(self_contacts(Object(cut), 0), Catch::Contains("ask for at least one"));
}
