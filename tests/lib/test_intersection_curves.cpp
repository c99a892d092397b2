// SPDX-License-Identifier: Apache-2.0
// Intersections of the faces of contacts, the curves they form, normals.
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <catch2/catch.hpp>
#include <cchip/cchip.hpp>
#include <cchip/program/seed.hpp>
#include <cmath>
#include <random>
#include <set>

#include "random_poses.hpp"

using namespace cchip;

namespace {

using Points = std::vector<Vec3d>;
using Kinds = Intersection::Kind;

const CollisionRequest every = {CollisionRequest::Contacts::all};

/// Box of quads or of triangles from `least` to `greatest`.
Mesh make_box(const Vec3d& least, const Vec3d& greatest, Kind kind) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1 ? greatest : least).x(), (i & 2 ? greatest : least).y(),
                               (i & 4 ? greatest : least).z());
  }
  const std::uint32_t sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& s : sides) {
    if (kind == Kind::quad) {
      mesh.faces.push_back({kind, {s[0], s[1], s[2], s[3]}});
    } else {
      mesh.faces.push_back({kind, {s[0], s[1], s[2], 0}});
      mesh.faces.push_back({kind, {s[0], s[2], s[3], 0}});
    }
  }
  return mesh;
}

double length_of(const IntersectionCurve& curve) {
  double sum = 0;
  for (std::size_t i = 1; i < curve.points.size(); ++i) sum += (curve.points[i] - curve.points[i - 1]).norm();
  return curve.closed ? sum + (curve.points.front() - curve.points.back()).norm() : sum;
}

bool has(const IntersectionCurve& curve, const Vec3d& p) {
  return std::find(curve.points.begin(), curve.points.end(), p) != curve.points.end();
}

struct PointBefore {
  bool operator()(const Vec3d& p, const Vec3d& q) const {
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  }
};
struct SegmentBefore {
  bool operator()(const std::pair<Vec3d, Vec3d>& p, const std::pair<Vec3d, Vec3d>& q) const {
    if (p.first != q.first) return PointBefore()(p.first, q.first);
    return PointBefore()(p.second, q.second);
  }
};
using Segments = std::set<std::pair<Vec3d, Vec3d>, SegmentBefore>;

std::pair<Vec3d, Vec3d> segment(const Vec3d& p, const Vec3d& q) {
  return PointBefore()(p, q) ? std::pair(p, q) : std::pair(q, p);
}

}  // namespace

TEST_CASE("intersection curves: two boxes", "[lib][intersection]") {
  for (const Kind kind : {Kind::quad, Kind::tri}) {
    const Object a(make_box({0, 0, 0}, {2, 2, 2}, kind));
    const Object b(make_box({0, 0, 0}, {2, 2, 2}, kind));
    const Pose here = Pose::Identity();
    Pose there = here;
    // One corner in the other box: a closed curve of six edges.
    there.translation() = Vec3d(1, 1, 1);
    const CollisionQuery query = {&a, &here, &b, &there};
    const CollisionResult result = collide(a, here, b, there, every);
    std::vector<IntersectionCurve> curves = intersection_curves(query, result.contacts);
    REQUIRE(curves.size() == 1);
    CHECK(curves[0].closed);
    CHECK(length_of(curves[0]) == 6);
    for (const Vec3d& p : Points{{1, 2, 2}, {1, 1, 2}, {2, 1, 2}, {2, 1, 1}, {2, 2, 1}, {1, 2, 1}}) {
      CHECK(has(curves[0], p));
    }
    if (kind == Kind::quad) CHECK(curves[0].points.size() == 6);
    // In any order of the contacts.
    std::vector<Contact> contacts = result.contacts;
    std::reverse(contacts.begin(), contacts.end());
    CHECK(intersection_curves(query, contacts)[0].points == curves[0].points);
    // Some of the contacts: an open curve.
    std::vector<Contact> some;
    for (const Contact& contact : result.contacts) {
      if (face_normal(a, here, contact.face_a) == Vec3d(1, 0, 0)) some.push_back(contact);
    }
    curves = intersection_curves(query, some);
    REQUIRE(curves.size() == 1);
    CHECK_FALSE(curves[0].closed);
    CHECK(curves[0].points.front() == Vec3d(2, 1, 2));
    CHECK(curves[0].points.back() == Vec3d(2, 2, 1));
    CHECK(length_of(curves[0]) == 2);
    CHECK(intersection_curves(query, {}).empty());

    // Flush: a square, framed by a curve.
    there.translation() = Vec3d(1, 1, 2);
    const CollisionResult flush = collide(a, here, b, there, every);
    double area = 0;
    for (const auto& parts : intersections(query, flush.contacts)) {
      REQUIRE(parts.size() == 1);
      if (parts[0].kind != Kinds::polygon) continue;
      for (std::size_t i = 2; i < parts[0].points.size(); ++i) {
        area += (parts[0].points[i - 1] - parts[0].points[0]).cross(parts[0].points[i] - parts[0].points[0]).norm() / 2;
      }
    }
    CHECK(area == 1);
    curves = intersection_curves(query, flush.contacts);
    double frame = 0;
    for (const IntersectionCurve& curve : curves) frame += length_of(curve);
    if (kind == Kind::quad) {
      REQUIRE(curves.size() == 1);
      CHECK(curves[0].closed);
      CHECK(curves[0].points == Points{{1, 1, 2}, {1, 2, 2}, {2, 2, 2}, {2, 1, 2}});
      CHECK(frame == 4);
    }
    // Apart, and within a distance: nothing in common.
    there.translation() = Vec3d(0, 0, 2.5);
    for (const auto& parts : intersections(query, within(a, here, b, there, 0.5, every).contacts)) CHECK(parts.empty());
  }
}

TEST_CASE("intersection curves: closed surfaces", "[lib][intersection]") {
  const Object ring(make_torus(1, 0.25, 24, 12)), ball(make_sphere(0.5, 6));
  std::mt19937_64 random(cchip::sim::seed_from_environment() + 3);
  std::size_t curves_in_all = 0;
  for (int i = 0; i < 20; ++i) {
    const Pose a = cchip_test::random_pose(cchip_test::PoseClass::rigid, 0, random);
    Pose b = cchip_test::random_pose(cchip_test::PoseClass::rigid, 0.2, random);
    b.translation() += a.linear().col(0);
    const CollisionQuery query = {&ring, &a, &ball, &b};
    const CollisionResult result = collide(ring, a, ball, b, every);
    Segments segments;
    for (const auto& parts : intersections(query, result.contacts)) {
      for (const Intersection& part : parts) {
        if (part.kind == Kinds::segment) segments.insert(segment(part.points[0], part.points[1]));
      }
    }
    Segments chained;
    for (const IntersectionCurve& curve : intersection_curves(query, result.contacts)) {
      CHECK(curve.closed);  // no surface has an edge
      ++curves_in_all;
      for (std::size_t k = 0; k < curve.points.size(); ++k) {
        const auto s = segment(curve.points[k], curve.points[(k + 1) % curve.points.size()]);
        CHECK(chained.insert(s).second);
      }
    }
    CHECK(chained == segments);
  }
  CHECK(curves_in_all >= 20);
}

TEST_CASE("intersection curves: where more than two segments meet", "[lib][intersection]") {
  // Two walls that cross on a floor.
  Mesh walls;
  walls.vertices = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}, {0, -1, -1}, {0, 0, -1},
                    {0, 1, -1},  {0, 1, 1},  {0, 0, 1}, {0, -1, 1}, {0, 0, 1},   {0, 0, -1}};
  walls.faces = {
      {Kind::quad, {0, 5, 8, 3}}, {Kind::quad, {5, 1, 2, 8}}, {Kind::quad, {4, 5, 8, 9}}, {Kind::quad, {5, 6, 7, 8}}};
  Mesh floor;
  floor.vertices = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
  floor.faces = {{Kind::quad, {0, 1, 2, 3}}};
  const Object a(walls), b(floor);
  const Pose here = Pose::Identity();
  const CollisionQuery query = {&a, &here, &b, &here};
  const auto curves = intersection_curves(query, collide(a, here, b, here, every).contacts);
  REQUIRE(curves.size() == 4);
  for (const IntersectionCurve& curve : curves) {
    CHECK_FALSE(curve.closed);
    CHECK(curve.points.size() == 2);
    CHECK(has(curve, Vec3d::Zero()));
  }
}

TEST_CASE("intersection curves: a point is one exactly, not by its rounded coordinates", "[lib][intersection]") {
  // Two fins end close to each other on a floor, at numbers that are rounded to the same double.
  Mesh fins;
  fins.vertices = {{0, 0, -1}, {0, 0, 1}, {1, 0, -1},           {1 + 0x1p-52, 0, 2},
                   {2, 0, -1}, {2, 0, 1}, {1 + 0x1p-52, 0, -1}, {1, 0, 2.0 / 3}};
  fins.faces = {{Kind::quad, {0, 1, 3, 2}}, {Kind::quad, {4, 5, 7, 6}}};
  Mesh floor;
  floor.vertices = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
  floor.faces = {{Kind::quad, {0, 1, 2, 3}}};
  const Object a(fins), b(floor);
  const Pose here = Pose::Identity();
  const CollisionQuery query = {&a, &here, &b, &here};
  const auto contacts = collide(a, here, b, here, every).contacts;
  // The ends are about 1 + 2^-52 / 3 and 1 + 2^-52 (2 / 5).
  const auto curves = intersection_curves(query, contacts);
  REQUIRE(curves.size() == 2);
  CHECK(curves[0].points == Points{{0, 0, 0}, {1, 0, 0}});
  CHECK(curves[1].points == Points{{1, 0, 0}, {2, 0, 0}});
}

TEST_CASE("intersections: faces that were cut, and what is refused", "[lib][intersection]") {
  // An arrow head, a quad with a dent, is cut into two triangles.
  Eigen::MatrixXd vertices(4, 3);
  vertices << -2, 0, 0, 0, 1, 0, 2, 0, 0, 0, 3, 0;
  Eigen::MatrixXi faces(1, 4);
  faces << 0, 1, 2, 3;
  const Object arrow(make_mesh(vertices, faces));
  REQUIRE(arrow.mesh().faces.size() == 2);
  const Object wall(make_box({-5, 0.5, -1}, {5, 9, 1}, Kind::quad));
  const Pose here = Pose::Identity();
  const CollisionQuery query = {&arrow, &here, &wall, &here};
  const CollisionResult result = collide(arrow, here, wall, here, every);
  REQUIRE(result.contacts.size() == 1);
  const std::vector<Intersection> parts = intersections(query, result.contacts[0]);
  REQUIRE(parts.size() == 2);  // a prong each
  for (const Intersection& part : parts) {
    CHECK(part.kind == Kinds::segment);
    CHECK(part.points[0].y() == 0.5);
    CHECK(part.points[1].y() == 0.5);
    CHECK(part.points[1].x() - part.points[0].x() == Approx(2.0 / 3));
  }
  CHECK(face_normal(arrow, here, 0).cwiseAbs() == Vec3d(0, 0, 1));

  CHECK_THROWS_AS(intersections(query, Contact{1, 0}), std::invalid_argument);
  CHECK_THROWS_AS(intersections(query, Contact{0, 6}), std::invalid_argument);
  CHECK_THROWS_AS(intersection_curves(query, {Contact{0, 6}}), std::invalid_argument);
  CHECK_THROWS_AS(face_normal(arrow, here, 1), std::invalid_argument);
  CHECK_THROWS_AS(intersections({&arrow, &here, nullptr, &here}, result.contacts), std::invalid_argument);
  Pose bad = here;
  bad(0, 0) = 1e300;
  CHECK_THROWS_AS(intersections({&arrow, &here, &wall, &bad}, result.contacts), std::invalid_argument);
}

TEST_CASE("face normals", "[lib][intersection]") {
  const Object box(make_box({0, 0, 0}, {1, 2, 3}, Kind::quad));
  const Vec3d outwards[] = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}};
  Pose pose = Pose::Identity();
  for (std::uint32_t i = 0; i < 6; ++i) CHECK(face_normal(box, pose, i) == outwards[i]);
  // Turned, stretched: orthogonal to the posed face; mirrored: turned about.
  pose = make_pose({5, 6, 7}, {10, 20, 30});
  for (std::uint32_t i = 0; i < 6; ++i) {
    CHECK((face_normal(box, pose, i) - pose.linear() * outwards[i]).norm() < 1e-15);
  }
  pose = Eigen::Scaling(-1.0, 1.0, 1.0);
  CHECK(face_normal(box, pose, 0) == Vec3d(0, 0, 1));
  CHECK(face_normal(box, pose, 5) == Vec3d(1, 0, 0));
  // Thin to the last bit, far away, huge and tiny.
  Mesh mesh;
  mesh.vertices = {{1, 0, 0}, {1 + 0x1p-52, 0, 0}, {1, 0x1p-1070, 0}, {0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  mesh.faces = {{Kind::tri, {0, 1, 2, 0}}, {Kind::tri, {3, 4, 5, 0}}};
  const Object thin(mesh);
  pose = Pose::Identity();
  CHECK(face_normal(thin, pose, 0) == Vec3d(0, 0, 1));
  CHECK(face_normal(thin, pose, 1) == Vec3d::Zero());
  pose.translation().setConstant(0x1p450);
  pose.linear() *= 0x1p-400;
  CHECK(face_normal(thin, pose, 0) == Vec3d(0, 0, 1));
}

#if defined(__SSE2__)
TEST_CASE("intersections: a thread that flushes small numbers to zero is refused", "[lib][intersections]") {
  const Object box(make_box({0, 0, 0}, {1, 1, 1}, Kind::tri));
  const Pose pose = Pose::Identity();
  const unsigned before = _mm_getcsr();
  std::string said = "nothing";
  _mm_setcsr(before | 0x8040U);
  try {
    intersections({&box, &pose, &box, &pose}, Contact{0, 0, std::nullopt});
  } catch (const std::runtime_error& error) {
    said = error.what();
  }
  _mm_setcsr(before);
  CHECK_THAT(said, Catch::StartsWith("this thread flushes small numbers to zero"));
}
#endif
