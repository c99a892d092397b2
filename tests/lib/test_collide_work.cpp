// SPDX-License-Identifier: Apache-2.0
// Meshes and poses that trees of bounding volumes like least: exact answers, and a bound on the work.
//
// The work is bounded in pairs of faces whose boxes overlap. A device may widen its volumes by 2^-12 of the smaller
// object, so these boxes are widened by as much. They lie along the axes of B.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/shapes.hpp>
#include <string>

#include "bvh_meshes.hpp"
#include "random_poses.hpp"

using namespace cchip;
using namespace cchip::testing;
using cchip_test::PoseClass;
using cchip_test::random_pose;

namespace {

const CollisionRequest all = {CollisionRequest::Contacts::all};

struct Box {
  Vec3d low;
  Vec3d high;
};

Box box_of(const Primitive& face, const Pose& pose, double widening) {
  Box box = {pose * face.v[0], pose * face.v[0]};
  for (std::size_t i = 1; i < face.vertex_count(); ++i) {
    box.low = box.low.cwiseMin(pose * face.v[i]);
    box.high = box.high.cwiseMax(pose * face.v[i]);
  }
  box.low.array() -= widening;
  box.high.array() += widening;
  return box;
}

/// Greatest extent along an axis.
double reach(const Mesh& mesh, const Pose& pose) {
  Vec3d low = pose * mesh.vertices.front();
  Vec3d high = low;
  for (const Vec3d& v : mesh.vertices) {
    low = low.cwiseMin(pose * v);
    high = high.cwiseMax(pose * v);
  }
  return (high - low).maxCoeff();
}

/// Greatest magnitude on the way to a vertex' place: its rounding error is below 2^-48 of this.
double magnitude(const Mesh& mesh, const Pose& pose) {
  double greatest = 0;
  for (const Vec3d& v : mesh.vertices) greatest = std::max(greatest, v.cwiseAbs().maxCoeff());
  return 3 * greatest * pose.linear().cwiseAbs().maxCoeff() + pose.translation().cwiseAbs().maxCoeff();
}

/// Pairs of faces whose widened boxes overlap; all that touch are among them.
std::vector<Contact> overlapping(const Mesh& a, const Mesh& b, const PosePair& poses) {
  // Relative to B's origin and in a unit in which B's pose is near 1.
  int exponent = 0;
  std::frexp(poses.b.linear().cwiseAbs().maxCoeff(), &exponent);
  Pose pose_a = poses.a;
  Pose pose_b = poses.b;
  pose_a.translation() -= pose_b.translation();
  pose_b.translation().setZero();
  for (Pose* pose : {&pose_a, &pose_b}) pose->matrix().topRows<3>() *= std::ldexp(1.0, -exponent);
  double error = 0x1p-48 * (magnitude(a, pose_a) + magnitude(b, pose_b));
  // Along the axes of B if they are well defined, otherwise along those of the world.
  const double determinant = std::abs(pose_b.linear().determinant());  // entries are below 1
  if (determinant > 0x1p-16) {
    pose_a = Pose(pose_b.linear().inverse() * pose_a.matrix().topRows<3>());
    pose_b = Pose::Identity();
    error *= 16 / determinant;
  }
  const double widening = std::max(error, 0x1p-12 * std::min(reach(a, pose_a), reach(b, pose_b)));
  std::vector<Box> boxes;
  for (std::size_t k = 0; k < b.faces.size(); ++k) boxes.push_back(box_of(b.primitive(k), pose_b, widening));
  std::vector<Contact> result;
  for (std::uint32_t i = 0; i < a.faces.size(); ++i) {
    const Box box = box_of(a.primitive(i), pose_a, 0);
    for (std::uint32_t k = 0; k < boxes.size(); ++k) {
      if ((box.low.array() <= boxes[k].high.array()).all() && (boxes[k].low.array() <= box.high.array()).all()) {
        result.push_back({i, k});
      }
    }
  }
  return result;
}

struct Cost {
  CollisionResult everything;
  CollisionResult first;
};

/// Checks both kinds of request against exact integers, and their work against pairs of boxes that overlap, with every
/// instruction set. Returns what the best of them found.
Cost check(const std::string& what, const Object& a, const Object& b, const PosePair& poses) {
  const std::vector<Contact> candidates = overlapping(a.mesh(), b.mesh(), poses);
  std::vector<Contact> expected;
  for (const Contact& c : candidates) {
    if (exact_intersects(a.mesh().primitive(c.face_a), poses.a, b.mesh().primitive(c.face_b), poses.b)) {
      expected.push_back(c);
    }
  }
  static const std::vector<std::string> targets = cpu_targets();
  Cost best;
  for (const std::string& target : targets) {
    const auto device = open_cpu_device({1, target});
    const Cost cost = {collide(*device, a, poses.a, b, poses.b, all), collide(*device, a, poses.a, b, poses.b)};
    const std::size_t overlaps = candidates.size();
    const CollisionStats& counts = cost.everything.stats;
    INFO(what << ", " << target << ": overlapping=" << overlaps << " contacts=" << expected.size()
              << " found=" << cost.everything.contacts.size() << " pairs=" << counts.pairs << " steps=" << counts.steps
              << " box_tests=" << counts.box_tests << " open=" << counts.open
              << " first_pairs=" << cost.first.stats.pairs << " first_steps=" << cost.first.stats.steps);
    CHECK(same_faces(cost.everything.contacts, expected));
    CHECK(cost.everything.hit == !expected.empty());
    CHECK(cost.first.hit == !expected.empty());
    if (cost.first.hit) {
      REQUIRE(cost.first.contacts.size() == 1);
      CHECK(std::binary_search(expected.begin(), expected.end(), cost.first.contacts.front()));
    }
    // A leaf holds up to two faces; the volumes of A are those of B's directions by way of A's own; and planes of 16
    // bits are coarse for an object 10^6 times smaller than the other.
    for (const CollisionStats& c : {counts, cost.first.stats}) {
      CHECK(c.pairs <= 8 * overlaps + 64);
      CHECK(c.steps <= 2 * overlaps + a.mesh().faces.size() + b.mesh().faces.size() + 64);
      CHECK(c.box_tests <= 16 * c.steps + 1);
    }
    CHECK(cost.first.stats.pairs <= counts.pairs);
    CHECK(counts.pairs >= expected.size());
    if (target == targets.front()) best = cost;
  }
  return best;
}

PosePair at(const Vec3d& translation) { return {Pose::Identity(), Pose(make_pose(translation, {0, 0, 0}))}; }

/// A plane of n x n squares of two triangles each, or of quads, of size 1.
Mesh plane(int n, Kind kind) {
  Mesh mesh;
  mesh.name = "plane";
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) mesh.vertices.emplace_back(x * (1.0 / 64), y * (1.0 / 64), 0);
  }
  const auto number = [n](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const std::uint32_t i = number(x, y);
      const std::uint32_t j = number(x + 1, y);
      const std::uint32_t k = number(x + 1, y + 1);
      const std::uint32_t l = number(x, y + 1);
      if (kind == Kind::quad) {
        mesh.faces.push_back({Kind::quad, {i, j, k, l}});
      } else {
        mesh.faces.push_back({Kind::tri, {i, j, k, 0}});
        mesh.faces.push_back({Kind::tri, {i, k, l, 0}});
      }
    }
  }
  return mesh;
}

/// Triangles of length 1 and width 10^-6 in random directions through a ball.
Mesh needles(int count, std::mt19937_64& random) {
  Mesh mesh;
  mesh.name = "needles";
  for (int i = 0; i < count; ++i) {
    const Vec3d middle = random_vector(random, 0.5);
    const Vec3d along = random_vector(random, 1).normalized() / 2;
    add_face(mesh, {middle - along, middle + along, middle + along + random_vector(random, 1e-6)});
  }
  return mesh;
}

}  // namespace

TEST_CASE("work: coincident meshes", "[lib][collide][work]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const Object body(make_body(8, 0.3));  // 1,280 faces
  const Object quads(noisy(make_torus(1, 0.4, 40, 24, Kind::quad), 0.01, random));
  const auto both = [&](const Object& object, PoseClass c) {
    const Pose pose = random_pose(c, 1, random);
    const Cost cost = check("coincident " + object.mesh().name, object, object, {pose, pose});
    CHECK(cost.everything.contacts.size() > object.mesh().faces.size());
    CHECK(cost.first.stats.pairs <= 64);
  };
  both(body, PoseClass::rigid);
  both(quads, PoseClass::quarter_turns);
  both(quads, PoseClass::mirror);
}

TEST_CASE("work: thousands of coplanar faces", "[lib][collide][work]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const Object triangles(plane(40, Kind::tri));
  const Object quads(plane(40, Kind::quad));
  for (const double height : {0.0, 0x1p-30, -0x1p-60}) {
    check("coplanar, moved along the plane", triangles, quads, at({0.3, 0.2, height}));
    PosePair turned = at({0.3, 0.2, height});
    turned.b.linear() = make_pose({0, 0, 0}, {0, 0, 30}).linear();
    check("coplanar, turned in the plane", triangles, triangles, turned);
    const Pose anywhere = random_pose(PoseClass::rigid, 1, random);
    turned.a = anywhere * turned.a;
    turned.b = anywhere * turned.b;
    check("coplanar but for rounding, anywhere", triangles, triangles, turned);
  }
}

TEST_CASE("work: needles", "[lib][collide][work]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const Object some(needles(300, random));
  const Object others(needles(300, random));
  const Object body(make_body(8, 0.3));
  for (int i = 0; i < 3; ++i) {
    const PosePair poses = {random_pose(PoseClass::rigid, 0.3, random), random_pose(PoseClass::rigid, 0.3, random)};
    check("needles", some, others, poses);
    check("needles and body", some, body, poses);
  }
  check("needles on themselves", some, some, {});
}

TEST_CASE("work: all faces in one point", "[lib][collide][work]") {
  Mesh point;
  point.name = "point";
  for (int i = 0; i < 100; ++i) {
    std::vector<Vec3d> vertices(i % 2 == 0 ? 3 : 4, Vec3d(0.25, -0.5, 0.125));
    add_face(point, vertices);
  }
  const Object points(point);
  const Object torus(make_torus(1, 0.4, 24, 12));
  const Object plate(plane(20, Kind::quad));
  CHECK(check("points on themselves", points, points, {}).first.stats.pairs <= 64);
  check("points apart", points, points, at({0x1p-40, 0, 0}));
  const Vec3d vertex = torus.mesh().vertices[17];
  for (const Vec3d& off : {Vec3d(0, 0, 0), Vec3d(0x1p-45, 0, 0), Vec3d(0.1, 0.1, 0.1)}) {
    check("points at a vertex", torus, points, at(vertex - point.vertices[0] + off));
    check("points at a plate", points, plate, at(point.vertices[0] - Vec3d(0.125, 0.0625, 0) + off));
  }
}

TEST_CASE("work: one object 10^4 and 10^6 times smaller than the other", "[lib][collide][work]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const Mesh large = make_body(12, 0.3);
  const Object body(large);
  for (const double scale : {1e-4, 1e-6}) {
    const Object small(scaled(make_body(8, 0.3, 2), scale));  // its size in the coordinates of its mesh
    const Object same(make_body(8, 0.3, 2));                  // or in its pose
    for (int i = 0; i < 4; ++i) {
      const Mesh::Face& face = large.faces[random() % large.faces.size()];
      const Vec3d vertex = large.vertices[face.vertex[0]];
      const Vec3d middle = (vertex + large.vertices[face.vertex[1]] + large.vertices[face.vertex[2]]) / 3;
      PosePair poses;
      poses.b = random_pose(PoseClass::rigid, 1, random);
      const Vec3d aside = random_vector(random, scale);
      for (const Vec3d& place : {vertex, middle, Vec3d(middle + 1.5 * aside), Vec3d(1.1 * middle)}) {
        poses.b.translation() = place;
        const std::string name = "1 : " + std::to_string(static_cast<int>(std::round(1 / scale)));
        check(name + " by its mesh", body, small, poses);
        PosePair shrunk = poses;
        shrunk.b.linear() *= scale;
        check(name + " by its pose", body, same, shrunk);
        std::swap(poses.a, poses.b);
        check(name + ", the other way round", small, body, poses);
        std::swap(poses.a, poses.b);
      }
    }
  }
}

TEST_CASE("work: does not depend on the unit", "[lib][collide][work]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const Mesh mesh_a = make_body(6, 0.5);
  const Mesh mesh_b = make_torus(0.5, 0.2, 24, 12, Kind::quad);
  const Object a(mesh_a);
  const Object b(mesh_b);
  for (int i = 0; i < 4; ++i) {
    const PosePair poses = {random_pose(PoseClass::rigid, 1, random), random_pose(PoseClass::rigid, 1, random)};
    const Cost unscaled = check("unit 1", a, b, poses);
    for (const int exponent : {-500, 500}) {
      const double scale = std::ldexp(1.0, exponent);
      // The meshes are scaled and the poses scale back; both or one of them.
      const Object large_a(scaled(mesh_a, scale));
      const Object large_b(scaled(mesh_b, scale));
      PosePair back = poses;
      back.a.linear() /= scale;
      check("unit 2^" + std::to_string(exponent) + " of A", large_a, b, back);
      back.b.linear() /= scale;
      check("unit 2^" + std::to_string(exponent), large_a, large_b, back);
      // The poses scale up, so the world is large or small.
      PosePair world = poses;
      for (Pose* pose : {&world.a, &world.b}) {
        pose->linear() *= scale;
        pose->translation() *= scale;
        if (exponent > 0) pose->matrix().topRows<3>() /= 4;  // entries may reach 2^500, not more
      }
      const Cost cost = check("world 2^" + std::to_string(exponent), a, b, world);
      CHECK((cost.everything.contacts == unscaled.everything.contacts));
    }
  }
}

TEST_CASE("work: poses with shear, mirror and singular maps", "[lib][collide][work]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const Object a(make_body(6, 0.5));
  const Object b(make_torus(0.8, 0.3, 30, 20, Kind::quad));
  for (const PoseClass c : {PoseClass::shear, PoseClass::mirror, PoseClass::affine, PoseClass::flat, PoseClass::point,
                            PoseClass::integers, PoseClass::far_away}) {
    for (int i = 0; i < 3; ++i) {
      PosePair poses = {random_pose(i == 0 ? PoseClass::rigid : c, 0.5, random), random_pose(c, 0.5, random)};
      if (i == 1) poses.b.linear() = random_pose(PoseClass::rigid, 1, random).linear();
      check("class " + std::to_string(static_cast<int>(c)), a, b, poses);
    }
  }
}

TEST_CASE("work: small objects beside a face askew cost no test of faces", "[lib][collide][work]") {
  std::mt19937_64 random(sim::seed_from_environment());
  // A triangle, a quad, a fan of two triangles, and two triangles in one plane, which are a leaf, too.
  const Vec3d p(0, 0, 0);
  const Vec3d u(8, 1, -3);
  const Vec3d v(-2, 7, 4);
  std::array<Mesh, 4> faces;
  add_face(faces[0], {p, u, v});
  add_face(faces[1], {p, u, u + v, v});
  add_face(faces[2], {p, u, v});
  add_face(faces[2], {u, u + v, v});
  add_face(faces[3], {p, u, v});
  add_face(faces[3], {u + v, 0.875 * u + v, u + 0.875 * v});
  const Vec3d normal = u.cross(v).normalized();
  for (const Mesh& mesh : faces) {
    for (int mirror = 0; mirror < 8; ++mirror) {
      Mesh turned = mesh;
      const Vec3d signs((mirror & 1) != 0 ? -1 : 1, (mirror & 2) != 0 ? -1 : 1, (mirror & 4) != 0 ? -1 : 1);
      for (Vec3d& vertex : turned.vertices) vertex = vertex.cwiseProduct(signs);
      const Object great(turned);
      const Object small(make_body(1, 0.3));
      for (const std::string& target : cpu_targets()) {
        if (target == "plain") continue;  // its volumes are those of the nodes alone
        const auto device = open_cpu_device({1, target});
        for (int i = 0; i < 8; ++i) {
          Pose pose = random_pose(PoseClass::rigid, 1, random);
          pose.linear() *= 0x1p-7;
          const Vec3d beside = 0.25 * u + 0.25 * v + (i % 2 == 0 ? 0.0625 : -0.0625) * normal;
          pose.translation() = beside.cwiseProduct(signs);
          CAPTURE(target, mirror, i);
          CHECK(collide(*device, great, Pose::Identity(), small, pose).stats.pairs == 0);
          CHECK(collide(*device, small, pose, great, Pose::Identity()).stats.pairs == 0);
        }
      }
    }
  }
}
