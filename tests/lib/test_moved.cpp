// SPDX-License-Identifier: Apache-2.0
// Objects whose vertices move, and faces of one object that touch each other.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/device.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <cchip/internal/judge/brute_force.hpp>
#include <cchip/internal/tree/support_tree.hpp>
#include <cchip/program/seed.hpp>
#include <cmath>
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

using Words = std::array<std::int16_t, bvh::support_words>;

/// The words of all nodes, one by one as SupportLine says, with the allowances for rounding: of vertices, from the
/// leaves up.
std::vector<Words> plain_words(const Mesh& mesh, const bvh::Tree& tree, const Vec3d& centre, double unit) {
  const double slack = 0x1p-49 * (centre.cwiseAbs().sum() + 4.0 * bvh::support_most * unit) + 0x1p-1060;
  std::vector<Words> all(tree.nodes.size());
  for (std::size_t n = all.size(); n-- > 0;) {
    const bvh::TreeNode& node = tree.nodes[n];
    Words& words = all[n];
    if (node.kind == bvh::NodeKind::inner) {
      words = all[node.first];
      for (std::size_t k = 1; k < node.count; ++k) {
        for (std::size_t w = 0; w < words.size(); ++w) words[w] = std::max(words[w], all[node.first + k][w]);
      }
      continue;
    }
    for (std::size_t w = 0; w < words.size(); ++w) {
      const std::array<int, 3> d = bvh::support_direction(w);
      if (d == std::array<int, 3>{0, 0, 0}) continue;
      const auto along = [&d](const Vec3d& v) { return d[0] * v[0] + d[1] * v[1] + d[2] * v[2]; };
      double reach = -std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < node.count; ++k) {
        const Primitive p = mesh.primitive(tree.faces[node.first + k]);
        for (std::size_t i = 0; i < p.vertex_count(); ++i)
          reach = std::max(reach, along(p.v[i]) - along(centre) + slack);
      }
      const double length = std::sqrt(static_cast<double>(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
      const double steps = std::ceil(reach / (length * unit) + 0x1p-30);
      const double most = bvh::support_most;
      words[w] = static_cast<std::int16_t>(std::max(1 - most, std::min(most, steps)));
    }
  }
  return all;
}

/// \param tree of the mesh
void require_plain(const bvh::SupportTree& got, const Mesh& mesh, const bvh::Tree& tree) {
  const bvh::Dop26& all = tree.nodes.front().dop;
  for (std::size_t k = 0; k < 3; ++k) {
    REQUIRE(got.centre()[static_cast<Eigen::Index>(k)] == all.least[k] / 2 + all.greatest[k] / 2);
  }
  double radius = 0;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const Primitive p = mesh.primitive(face);
    for (std::size_t i = 0; i < p.vertex_count(); ++i) {
      const Vec3d v = p.v[i] - got.centre();
      radius = std::max(radius, std::hypot(v.x(), v.y(), v.z()));
    }
  }
  REQUIRE(got.unit() == std::max(radius * (1 + 0x1p-40) / bvh::support_most, 0x1p-1000));
  REQUIRE(got.extent() == got.centre().cwiseAbs().maxCoeff() + bvh::support_most * got.unit());
  REQUIRE(got.size() + 1 == tree.nodes.size());
  const std::vector<Words> all_words = plain_words(mesh, tree, got.centre(), got.unit());
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    Words words = all_words[n];
    const bvh::SupportLine& line = got.lines()[n == 0 ? got.size() : n - 1];
    words[6] = line.word[6];
    words[7] = line.word[7];
    // The slab is of vertices, not of a volume: "distance bounds: slabs hold what lies below".
    for (std::size_t w = bvh::first_slab_word; w < words.size(); ++w) words[w] = line.word[w];
    REQUIRE(words == line.word);
    REQUIRE(line.ref().is_leaf() == (tree.nodes[n].kind != bvh::NodeKind::inner));
    REQUIRE(line.ref().count() == tree.nodes[n].count);
    if (!line.ref().is_leaf()) REQUIRE(line.ref().first() + 1 == tree.nodes[n].first);
  }
  const bvh::SupportLine& whole = got.lines()[got.size()];
  REQUIRE(got.whole_words() == whole.word);
  REQUIRE(got.root().bits() == whole.ref().bits());
  for (std::size_t k = 0; k < 3; ++k) {
    REQUIRE(got.half(k) == got.unit() * std::max(whole.word[2 * k], whole.word[2 * k + 1]));
  }
  for (std::size_t i = 1; i < 4; ++i) REQUIRE(got.lines()[got.size() + i].word == bvh::SupportLine().word);
}

/// Word by word.
void require_same(const bvh::SupportTree& x, const bvh::SupportTree& y) {
  REQUIRE(x.centre() == y.centre());
  REQUIRE(x.unit() == y.unit());
  REQUIRE(x.size() == y.size());
  REQUIRE(x.root().bits() == y.root().bits());
  REQUIRE(x.faces() == y.faces());
  for (std::size_t n = 0; n < x.size() + 4; ++n) REQUIRE(x.lines()[n].word == y.lines()[n].word);
  for (std::size_t v = 0; v < 6 * x.faces().size() + 24; ++v) REQUIRE(x.vertices(0)[v] == y.vertices(0)[v]);
}

}  // namespace

TEST_CASE("moved: the nodes of a tree come back from the object, and a refit restores their volumes",
          "[lib][collide]") {
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

TEST_CASE("moved: the tree is, word by word, that of its vertices after a refit", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::vector<Mesh> meshes = assorted_meshes(random);
  for (Mesh& mesh : bodies(random)) meshes.push_back(std::move(mesh));
  for (Mesh& mesh : meshes) {  // a vertex that no face uses, in the first place, where it moves all others
    if (random() % 2 == 0) continue;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    mesh.vertices.insert(mesh.vertices.begin(), random() % 2 == 0 ? Vec3d(nan, 0, 0) : Vec3d(0, 0x1p1010, 1));
    for (Mesh::Face& face : mesh.faces) {
      for (std::uint32_t& v : face.vertex) ++v;
    }
  }
  std::size_t fans_changed = 0;
  for (const Mesh& mesh : meshes) {
    INFO(mesh.name);
    const bvh::Tree built = bvh::build_tree(mesh);
    const Object rest(mesh);
    require_plain(rest.tree(), mesh, built);
    const auto scaled = [&mesh, &rest](int exponent) {  // to that size
      Mesh next = mesh;
      exponent -= std::ilogb(rest.tree().extent());
      for (Vec3d& v : next.vertices) v = v.unaryExpr([exponent](double c) { return std::ldexp(c, exponent); });
      return next;
    };
    const double size = rest.tree().extent();
    Mesh rounded = mesh;  // vertices fall together, so that triangles share edges that did not
    for (Vec3d& v : rounded.vertices) v = (3 / size * v).array().round().matrix();
    Mesh flat = mesh;
    for (Vec3d& v : flat.vertices) v.z() = -0.0;
    Mesh mixed = mesh;
    std::shuffle(mixed.vertices.begin() + 1, mixed.vertices.end(), random);
    if (!(std::abs(mesh.vertices[0].sum()) < 0x1p1002)) mixed.vertices[0] = mesh.vertices[0];
    Mesh far = mesh;
    for (Vec3d& v : far.vertices) v += size * Vec3d(1e5, -3e7, 0.1);
    const std::vector<Mesh> next = {mesh,
                                    noisy(mesh, 0.01 * size, random),
                                    noisy(mesh, size < 0x1p900 ? size : 0.02 * size, random),
                                    rounded,
                                    flat,
                                    mixed,
                                    size < 0x1p900 ? far : mesh,
                                    scaled(900),
                                    scaled(-900),
                                    scaled(-1060),
                                    scaled(-3000)};
    Object object = rest;
    for (const Mesh& to : next) {
      for (const Object* from : {&rest, static_cast<const Object*>(&object)}) {
        const Object moved = from->moved(to.vertices);
        bvh::Tree tree = built;
        bvh::refit(tree, to);
        require_plain(moved.tree(), to, tree);
        require_same(moved.tree(), bvh::SupportTree(to, tree));
        fans_changed += moved.tree().faces() != rest.tree().faces() ? 1 : 0;
        REQUIRE(moved.mesh().file_face == mesh.file_face);
        REQUIRE(moved.mesh().name == mesh.name);
      }
      object = object.moved(to.vertices);
    }
  }
  CHECK(fans_changed > 20);
}

TEST_CASE("support tree: a leaf holds the vertices of its faces, two triangles with an edge in common four",
          "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::array<std::size_t, 4> seen = {};  // triangle, two triangles, fan, quad
  std::vector<Mesh> meshes = assorted_meshes(random);
  for (Mesh& mesh : bodies(random)) meshes.push_back(std::move(mesh));
  for (const Mesh& mesh : meshes) {
    INFO(mesh.name);
    const bvh::SupportTree tree(mesh, bvh::build_tree(mesh));
    std::vector<std::uint32_t> faces;
    std::vector<bvh::NodeRef> nodes = {tree.root()};
    while (!nodes.empty()) {
      const bvh::NodeRef node = nodes.back();
      nodes.pop_back();
      if (!node.is_leaf()) {
        for (std::uint32_t i = 0; i < node.count(); ++i) nodes.push_back(tree.lines()[node.first() + i].ref());
        continue;
      }
      REQUIRE(node.first() % 2 == 0);
      ++seen[node.is_quad() ? 3 : node.is_fan() ? 2 : node.count() - 1];
      const std::size_t stride = 4 * node.vertex_sets();
      for (std::uint32_t i = 0; i < node.count(); ++i) {
        const std::uint32_t face = tree.faces()[node.first() + i];
        faces.push_back(face);
        const Primitive p = mesh.primitive(face);
        std::vector<std::array<float, 3>> wanted;
        for (std::size_t v = 0; v < p.vertex_count(); ++v) {
          const Vec3d at = (p.v[v] - tree.centre()) / tree.unit();
          wanted.push_back({static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())});
        }
        std::vector<std::array<float, 3>> held;
        const std::vector<std::size_t> lanes = node.is_fan() ? std::vector<std::size_t>{0, 1U + i, 2U + i}
                                               : node.is_quad()
                                                   ? std::vector<std::size_t>{0, 1, 2, 3}
                                                   : std::vector<std::size_t>{4U * i, 4U * i + 1, 4U * i + 2};
        for (const std::size_t lane : lanes) {
          const float* const v = tree.vertices(node.first()) + lane;
          held.push_back({v[0], v[stride], v[2 * stride]});
        }
        if (!node.is_quad()) {  // the order of a triangle's vertices means nothing
          std::sort(wanted.begin(), wanted.end());
          std::sort(held.begin(), held.end());
        }
        REQUIRE(held == wanted);
      }
    }
    std::sort(faces.begin(), faces.end());
    REQUIRE(faces.size() == mesh.faces.size());
    for (std::uint32_t i = 0; i < faces.size(); ++i) REQUIRE(faces[i] == i);
  }
  for (const std::size_t count : seen) CHECK(count > 0);
}

TEST_CASE("moved: an object with other vertices answers like brute force, and so does its image", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const CollisionRequest all = {CollisionRequest::Contacts::all};
  std::vector<std::unique_ptr<Device>> devices;
  for (const std::string& name : device_names()) devices.push_back(open_device(name));
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
          for (const std::unique_ptr<Device>& device : devices) {
            CAPTURE(device->name(), range, round);
            REQUIRE(same_faces(collide(*device, object, Pose::Identity(), other, pose, all).contacts, expected));
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

TEST_CASE("moved: vertices that make no sense are refused, and the object stays", "[lib][collide]") {
  const Object object(make_torus(1, 0.4, 6, 5));
  std::vector<Vec3d> vertices = object.mesh().vertices;
  vertices.pop_back();
  REQUIRE_THROWS_WITH(object.moved(vertices), Catch::Contains("29 vertices, the object has 30"));
  vertices = object.mesh().vertices;
  vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  REQUIRE_THROWS_WITH(object.moved(vertices), Catch::Contains("is not finite or beyond 2^1000"));
  REQUIRE(object.mesh().vertices.size() == 30);
}

TEST_CASE("self-contacts: those of brute force, without neighbours", "[lib][collide]") {
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
      const Object object(mesh);
      const std::size_t no_limit = std::numeric_limits<std::size_t>::max();
      REQUIRE(self_contacts(object, no_limit, Neighbours::left_out) == expected);
      if (!expected.empty()) REQUIRE(self_contacts(object, 1, Neighbours::left_out).size() == 1);
    }
  }
  for (const std::size_t count : relations) CHECK(count > 100);
}

TEST_CASE("self-contacts: of many faces round one vertex, those of each two faces alone", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment() + 5);
  std::size_t some = 0;
  for (const double noise : {0.0, 0.002, 0.05, 0.5}) {
    Mesh fan;
    const Vec3d hub(0.5, -1, 2);
    constexpr std::uint32_t faces = 150;
    for (std::uint32_t i = 0; i < faces; ++i) {
      const auto at = [&](std::uint32_t k) -> Vec3d {
        const double angle = 2 * 3.14159265358979 * (k % faces) / faces;
        return hub + Vec3d(std::cos(angle), std::sin(angle), 0.25);
      };
      add_face(fan, {hub, at(i) + random_vector(random, noise), at(i + 1)});
    }
    std::vector<Contact> expected;
    for (std::uint32_t i = 0; i < faces; ++i) {
      for (std::uint32_t k = i + 1; k < faces; ++k) {
        Mesh two;
        two.vertices = fan.vertices;
        two.faces = {fan.faces[i], fan.faces[k]};
        const std::vector<Contact> found = self_contacts(Object(std::move(two)));
        if (!found.empty()) expected.push_back({i, k, found.front().relation});
      }
    }
    CAPTURE(noise);
    CHECK(self_contacts(Object(fan)) == expected);
    some += expected.size();
  }
  CHECK(some > 100);
}

TEST_CASE("self-contacts: parts of a cut polygon are neighbours, closed shapes have none", "[lib][collide]") {
  REQUIRE(self_contacts(Object(make_torus(1, 0.4, 16, 12))).empty());
  Mesh cut;  // a pentagon in two parts that share no vertex, and a face across both
  add_face(cut, {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}});
  add_face(cut, {{0.5, 0.5, 0}, {3, 0, 0}, {3, 3, 0}});
  add_face(cut, {{0.6, 0.6, -1}, {0.6, 0.6, 1}, {1.5, 0.5, 1}});
  cut.file_face = {0, 0, 1};
  const std::vector<Contact> found = self_contacts(Object(cut));
  REQUIRE(found == std::vector<Contact>{{0, 1, Relation::crossing}});
  REQUIRE_THROWS_WITH(self_contacts(Object(cut), 0), Catch::Contains("ask for at least one"));
}

TEST_CASE("self-contacts: at most contacts, a face that was cut crosses if one of its parts does", "[lib][collide]") {
  for (const bool swapped : {false, true}) {
    Mesh mesh;
    if (!swapped) add_face(mesh, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
    add_face(mesh, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    if (swapped) add_face(mesh, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
    add_face(mesh, {{0.5, 0.5, 0}, {0.25, 0.75, -0.5}, {0.25, 0.75, 1}});
    add_face(mesh, {{0.5, 0.25, 0}, {0.5, 0.25, 1}, {0.5, 0.125, 1}});  // another contact
    mesh.file_face = {0, 0, 1, 2};
    for (const std::size_t most : {1, 2}) {
      for (const Contact& contact : self_contacts(Object(mesh), most)) {
        CHECK(contact.relation == (contact.face_b == 1 ? Relation::crossing : Relation::touching));
      }
    }
    CHECK(self_contacts(Object(mesh), 1).size() == 1);
  }
}

TEST_CASE("self-contacts: of polygons in many parts, at most contacts are some of all", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::array<int, 3> relations = {};
  const std::size_t no_limit = std::numeric_limits<std::size_t>::max();
  for (int round = 0; round < 500; ++round) {
    const Object object(polygons_in_parts(12, 0, random));
    const std::vector<Contact> all = self_contacts(object, no_limit);
    for (std::size_t most = 1; most <= all.size(); ++most) {
      const std::vector<Contact> some = self_contacts(object, most);
      REQUIRE(some.size() == most);
      for (const Contact& contact : some) {
        CAPTURE(round, most, contact.face_a, contact.face_b);
        REQUIRE(std::find(all.begin(), all.end(), contact) != all.end());
        ++relations[static_cast<std::size_t>(contact.relation.value())];
      }
    }
  }
  CHECK(relations[static_cast<std::size_t>(Relation::touching)] > 100);
  CHECK(relations[static_cast<std::size_t>(Relation::crossing)] > 1000);
}

TEST_CASE("self-contacts: vertices that no face uses do not matter", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int round = 0; round < 100; ++round) {
    Mesh strip;  // flat, of squares with vertices of their own, so that only positions make neighbours
    const auto add = [&](double x, double y) {
      strip.vertices.emplace_back(x, y, 0);
      const auto number = static_cast<std::uint32_t>(strip.vertices.size() - 1);
      for (auto n = random() % 4; n > 0; --n) strip.vertices.emplace_back(nan, nan, nan);
      return number;
    };
    for (int i = 0; i < 6; ++i) {
      const double x = i;
      strip.faces.push_back({Kind::tri, {add(x, 0), add(x + 1, 0), add(x + 1, 1), 0}});
      strip.faces.push_back({Kind::tri, {add(x, 0), add(x + 1, 1), add(x, 1), 0}});
    }
    REQUIRE(self_contacts(Object(strip)).empty());
    REQUIRE(self_contacts(Object(strip).moved(strip.vertices)).empty());
  }
}

TEST_CASE("object: what was moved from is refused by every call", "[lib][collide]") {
  Object from(make_torus(1, 0.3, 8, 6));
  const std::vector<Vec3d> vertices = from.mesh().vertices;
  const Object to = std::move(from);
  const char* const text = "object: it was moved from and has no mesh; use the Object that it was moved to";
  REQUIRE(from.id() == nullptr);  // NOLINT: that is what is tested
  REQUIRE_THROWS_WITH(from.moved(vertices), text);
  REQUIRE_THROWS_WITH(from.moved({}), text);
  REQUIRE_THROWS_WITH(from.mesh(), text);
  REQUIRE_THROWS_WITH(from.tree(), text);
  REQUIRE_THROWS_WITH(from.parts(0), text);
  REQUIRE_THROWS_WITH(self_contacts(from), text);
  REQUIRE(to.moved(vertices).mesh().vertices == vertices);
}

TEST_CASE("object: parts of a face that was cut", "[lib][collide]") {
  Mesh mesh = make_torus(1, 0.4, 3, 3);
  REQUIRE(Object(mesh).parts(5) == std::vector<std::uint32_t>{5});
  REQUIRE(Object(mesh).parts(static_cast<std::uint32_t>(mesh.faces.size())).empty());
  std::mt19937_64 random(sim::seed_from_environment());
  for (const bool ascending : {false, true}) {
    for (std::size_t i = 0; i < mesh.faces.size(); ++i)
      mesh.file_face.push_back(static_cast<std::uint32_t>(random() % 7));
    if (ascending) std::sort(mesh.file_face.begin(), mesh.file_face.end());
    const Object object(mesh);
    for (std::uint32_t number = 0; number < 8; ++number) {
      std::vector<std::uint32_t> expected;
      for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) {
        if (mesh.file_face[i] == number) expected.push_back(i);
      }
      REQUIRE(object.parts(number) == expected);
    }
    mesh.file_face.clear();
  }
}

TEST_CASE("self-contacts: neighbours that share more than a vertex or an edge", "[lib][collide]") {
  // The sizes are beyond what the first look in doubles takes on: exact arithmetic alone answers there.
  const double size = GENERATE(1.0, 0x1p300, 0x1p-350);
  CAPTURE(size);
  const std::size_t no_limit = std::numeric_limits<std::size_t>::max();
  const auto object_of = [size](const std::vector<std::vector<Vec3d>>& faces) {
    Mesh mesh;
    for (const std::vector<Vec3d>& face : faces) add_face(mesh, face);
    return Object(scaled(mesh, size));
  };
  const auto relation_of = [](const std::vector<Contact>& contacts) {
    REQUIRE(contacts.size() <= 1);
    return contacts.empty() ? Relation::apart : contacts.front().relation.value();
  };
  const auto found = [&](const std::vector<std::vector<Vec3d>>& faces) {
    const Object object = object_of(faces);
    CHECK(self_contacts(object, no_limit, Neighbours::left_out).empty());
    return relation_of(self_contacts(object));
  };
  // Triangles: u, v and one above in the plane.
  const Vec3d u(0, 0, 0);
  const Vec3d v(3, 0, 0);
  const std::vector<Vec3d> base = {u, v, {1, 2, 0}};
  CHECK(found({base, base}) == Relation::touching);                            // coincide
  CHECK(found({base, {v, u, {2, 2, 0}}}) == Relation::touching);               // fold, sides cross
  CHECK(found({base, {v, u, {1, 1, 0}}}) == Relation::touching);               // fold, one inside
  CHECK(found({base, {v, u, {1, 2, 0x1p-40}}}) == Relation::apart);            // nearly
  CHECK(found({base, {v, u, {1, -1, 0}}}) == Relation::apart);                 // flat
  CHECK(found({base, {v, u, {1, 0.5, 1}}}) == Relation::apart);                // a sharp fold
  CHECK(found({base, {v, u, {1, 0, 0}}}) == Relation::apart);                  // collapsed onto the edge
  CHECK(found({base, {v, u, {4, 0, 0}}}) == Relation::apart);                  // collapsed, beyond the edge
  CHECK(found({base, {u, {1, 1, 1}, {1, 1, -1}}}) == Relation::crossing);      // pierces
  CHECK(found({base, {u, {4, 4, 1}, {4, 4, -1}}}) == Relation::crossing);      // pierces, out through the far side
  CHECK(found({base, {u, {-1, -1, 1}, {-1, -1, -1}}}) == Relation::apart);     // behind
  CHECK(found({base, {u, {1, 0, 0}, {1, -1, 0}}}) == Relation::touching);      // along a part of the edge
  CHECK(found({base, {u, {5, 0, 0}, {1, -1, 0}}}) == Relation::touching);      // along all of it
  CHECK(found({base, {u, {-1, 0, 0}, {1, -1, 0}}}) == Relation::apart);        // a line, the other way
  CHECK(found({base, {{-1, 0, 0}, u, {1, 0, 0}}}) == Relation::touching);      // collapsed, u in the middle
  CHECK(found({base, {{-1, 0, 1}, u, {1, 0, -1}}}) == Relation::apart);        // collapsed, through u
  CHECK(found({base, {u, {-1, -3, 0}, {-1, 5, 0}}}) == Relation::apart);       // flat, beside
  CHECK(found({base, {u, {1, 3, 0}, {-1, 5, 0}}}) == Relation::apart);         // flat, beside, closer
  CHECK(found({base, {u, {1.125, 2, 0}, {-1, 5, 0}}}) == Relation::touching);  // flat, over
  CHECK(found({{u, v, v}, {v, u, u}}) == Relation::apart);                     // segments
  CHECK(found({{u, v, v}, {u, {1, 0, 0}, {1, 0, 0}}}) == Relation::touching);  // of them one in the other
  CHECK(found({{u, u, u}, base}) == Relation::apart);                          // a point
  // Quads, hulls of their vertices.
  const std::vector<Vec3d> quad = {u, v, {3, 2, 0}, {0, 2, 0}};
  CHECK(found({quad, quad}) == Relation::touching);
  CHECK(found({quad, {u, v, {3, -2, 0}, {0, -2, 0}}}) == Relation::apart);
  CHECK(found({quad, {u, v, {3, -2, 1}, {0, -2, 2}}}) == Relation::apart);
  CHECK(found({quad, {u, v, {3, 1, 0}, {0, 1, 0}}}) == Relation::touching);
  CHECK(found({quad, {u, {3, 2, 0}, {1, 1, 5}, {0, 0, 5}}}) == Relation::apart);      // stands on its diagonal
  CHECK(found({quad, {u, {3, 2, 0}, {1, 1, 5}, {1, 1, -5}}}) == Relation::crossing);  // through its diagonal
  CHECK(found({{u, v, {3, 2, 1}, {0, 2, -1}}, {u, v, {3, 1, 0}, {0, 1, 0}}}) == Relation::crossing);  // warped
  // One goes on beyond u, the other one beyond v.
  const std::vector<Vec3d> beyond_u = {u, v, {-3, 1, 0}, {-3, -1, 0}};
  CHECK(found({beyond_u, {u, v, {6, 1, 0}, {6, -1, 0}}}) == Relation::touching);  // in one plane
  CHECK(found({beyond_u, {u, v, {6, 0, 1}, {6, 0, -1}}}) == Relation::apart);
  CHECK(found({beyond_u, {u, v, {-6, 0, 1}, {-6, 0, -1}}}) == Relation::crossing);
  CHECK(found({beyond_u, {u, v, {-6, 0, 1}, {-5, 0, 2}}}) == Relation::apart);
  // Magnitudes that have nothing in common.
  const double far = size < 1 ? 0x1p600 : 0x1p300;
  CHECK(found({{u, far * v, {1, 2, 0}}, {u, far * v, {1, -2, 1}}}) == Relation::apart);  // a long edge
  CHECK(found({{u, far * v, {1, 2, 0}}, {u, far * v, {1, 1, 0}}}) == Relation::touching);
  CHECK(found({base, {u, {1, 1, far}, {1, 1, -far}}}) == Relation::crossing);
  CHECK(found({base, {u, {-1, 1, far}, {1, -1, -far}}}) == Relation::apart);
  // Without a common vertex.
  const auto beside_base = [&](const std::vector<Vec3d>& face) {
    const Object object = object_of({base, face});
    const std::vector<Contact> contacts = self_contacts(object);
    CHECK(self_contacts(object, no_limit, Neighbours::left_out) == contacts);
    return relation_of(contacts);
  };
  CHECK(beside_base({{1, 1, 1}, {1, 1, -1}, {1, 3, 0}}) == Relation::crossing);
  CHECK(beside_base({{1, 1, 1}, {1, 1, 0}, {1, 3, 1}}) == Relation::touching);
  CHECK(beside_base({{0.75, 1, 1}, {0, 1, -1}, {0, 1, 1}}) == Relation::apart);
  CHECK(beside_base({{1, 1, far}, {1, 1, -far}, {1, 3, 0}}) == Relation::crossing);
  CHECK(beside_base({{1, 1, 1}, {far, 1, 1}, {0, 3, -0.25}}) == Relation::apart);
}

TEST_CASE("self-contacts: a flat quad has those of its two triangles, in any order", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const auto whole = [&random](int n) { return static_cast<double>(random() % static_cast<unsigned>(n)); };
  std::array<int, 2> answers = {};
  for (int round = 0; round < 2000; ++round) {
    const double shift = whole(3);
    std::vector<Vec3d> quad = {{0, 0, 0}, {2, 0, 0}, {2 + shift, 2, 0}, {shift, 2, 0}};
    // Another face, collapsed or not, with vertices of the quad or on its edges.
    std::vector<Vec3d> other;
    for (int i = 0; i < (round % 2 == 0 ? 3 : 4); ++i) {
      other.push_back(random() % 2 == 0 ? quad[random() % 4]
                                        : Vec3d(whole(6) - 1, whole(5) - 1, round % 3 == 0 ? 0.0 : whole(3) - 1));
    }
    // What stands on the diagonal that the triangles do not have shares more than a vertex with each of them.
    const auto has = [&other](const Vec3d& v) { return std::find(other.begin(), other.end(), v) != other.end(); };
    if (has(quad[1]) && has(quad[3])) continue;
    const auto touches = [](const std::vector<std::vector<Vec3d>>& faces, const std::vector<std::uint32_t>& numbers) {
      Mesh mesh;
      for (const std::vector<Vec3d>& face : faces) add_face(mesh, face);
      mesh.file_face = numbers;
      return !self_contacts(Object(mesh)).empty();
    };
    const bool expected = touches({{quad[0], quad[1], quad[2]}, {quad[0], quad[2], quad[3]}, other}, {0, 0, 1});
    ++answers[expected ? 1 : 0];
    CAPTURE(round, shift, other);
    for (int turn = 0; turn < 4; ++turn) {
      std::rotate(quad.begin(), quad.begin() + 1, quad.end());
      if (turn % 2 == 0) std::reverse(quad.begin(), quad.end());
      std::shuffle(other.begin(), other.end(), random);
      REQUIRE(touches({quad, other}, {}) == expected);
      REQUIRE(touches({other, quad}, {}) == expected);
    }
  }
  for (const int count : answers) CHECK(count > 200);
}
