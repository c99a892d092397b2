// SPDX-License-Identifier: Apache-2.0
// Spheres against faces: one pair against the nearest point of a face by distinction of cases in fractions, clouds
// against all pairs.
#include <algorithm>
#include <array>
#include <atomic>
#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>
#include <cchip/internal/exact/posed_distances.hpp>
#include <cchip/point_cloud.hpp>
#include <cchip/shapes.hpp>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <new>
#include <random>

#include "bvh_meshes.hpp"
#include "random_pairs.hpp"
#include "random_poses.hpp"

using namespace cchip;
using namespace cchip::testing;
using cchip_test::name;
using cchip_test::pair_classes;
using cchip_test::PairClass;
using cchip_test::PairSource;
using cchip_test::pose_classes;
using cchip_test::PoseClass;
using cchip_test::random_pose;
using cchip_test::scaled;
using cchip_test::seed;

namespace {

std::atomic<std::size_t> allocations = 0;

}  // namespace

// The other forms of new and delete call these. Inlined, GCC takes them for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

using Rational =
    boost::multiprecision::number<boost::multiprecision::cpp_rational::backend_type, boost::multiprecision::et_off>;
using Point = std::array<Rational, 3>;

constexpr double infinity = std::numeric_limits<double>::infinity();

// --- the oracle

Point operator-(const Point& p, const Point& q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }
Point operator+(const Point& p, const Point& q) { return {p[0] + q[0], p[1] + q[1], p[2] + q[2]}; }
Point operator*(const Rational& s, const Point& p) { return {s * p[0], s * p[1], s * p[2]}; }
Rational dot(const Point& p, const Point& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
Point cross(const Point& p, const Point& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
Rational square(const Point& p) { return dot(p, p); }

Point in_world(const Vec3d& v, const Pose& pose) {
  Point p;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    p[k] = Rational(pose(row, 3));
    for (Eigen::Index c = 0; c < 3; ++c) p[k] += Rational(pose(row, c)) * Rational(v[c]);
  }
  return p;
}

Rational to_segment(const Point& p, const Point& a, const Point& b) {
  const Point edge = b - a;
  const Rational length = square(edge);
  if (length == 0) return square(p - a);
  Rational t = dot(p - a, edge) / length;
  if (t < 0) t = 0;
  if (t > 1) t = 1;
  return square(p - (a + t * edge));
}

/// Square of the distance of p from a triangle: through its plane if the foot of the perpendicular lies on the inner
/// side of each edge, or else to the nearest edge.
Rational to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point normal = cross(b - a, c - a);
  const Rational size = square(normal);
  if (size != 0) {
    const Rational height = dot(p - a, normal) / size;
    const Point foot = p - height * normal;
    const bool inside = dot(cross(b - a, foot - a), normal) >= 0 && dot(cross(c - b, foot - b), normal) >= 0 &&
                        dot(cross(a - c, foot - c), normal) >= 0;
    if (inside) return square(p - foot);
  }
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

/// The same for the hull of four points: 0 in a tetrahedron, or else that of the nearest of its triangles.
Rational to_hull(const Point& p, const std::array<Point, 4>& v, std::size_t count) {
  if (count == 3) return to_triangle(p, v[0], v[1], v[2]);
  const auto volume = [](const Point& a, const Point& b, const Point& c, const Point& d) {
    return dot(cross(b - a, c - a), d - a);
  };
  const Rational whole = volume(v[0], v[1], v[2], v[3]);
  if (whole != 0) {
    const std::array<Rational, 4> part = {volume(p, v[1], v[2], v[3]), volume(v[0], p, v[2], v[3]),
                                          volume(v[0], v[1], p, v[3]), volume(v[0], v[1], v[2], p)};
    if (std::all_of(part.begin(), part.end(), [&](const Rational& x) { return x * whole >= 0; })) return 0;
  }
  return std::min({to_triangle(p, v[0], v[1], v[2]), to_triangle(p, v[0], v[1], v[3]), to_triangle(p, v[0], v[2], v[3]),
                   to_triangle(p, v[1], v[2], v[3])});
}

Rational square_of_distance(const Vec3d& point, const Pose& pose_point, const Primitive& face, const Pose& pose_face) {
  std::array<Point, 4> v;
  for (std::size_t i = 0; i < face.vertex_count(); ++i) v[i] = in_world(face.v[i], pose_face);
  return to_hull(in_world(point, pose_point), v, face.vertex_count());
}

// --- one sphere and one face

Mesh mesh_of(const Primitive& p) {
  Mesh mesh;
  mesh.faces.resize(1);
  mesh.faces[0].kind = p.kind;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    mesh.vertices.push_back(p.v[i]);
    mesh.faces[0].vertex[i] = static_cast<std::uint32_t>(i);
  }
  return mesh;
}

struct Count {
  std::size_t pairs = 0;
  std::size_t questions = 0;
  std::size_t exactly = 0;  ///< radii that are the distance
  std::size_t touched = 0;  ///< centres on the face
  std::size_t open = 0;
  friend std::ostream& operator<<(std::ostream& out, const Count& c) {
    return out << "pairs=" << c.pairs << " questions=" << c.questions << " exactly=" << c.exactly
               << " touched=" << c.touched << " open=" << c.open;
  }
};

bool meets(const Vec3d& point, double radius, const Pose& pose_point, const Object& face, const Pose& pose_face,
           Count& count) {
  const CloudResult result = collide(PointCloud({point}, radius), pose_point, face, pose_face);
  REQUIRE(result.contacts.size() == (result.hit ? 1U : 0U));
  count.open += result.stats.open;
  return result.hit;
}

/// Asks with radii about the distance.
void check(const Vec3d& point, const Pose& pose_point, const Primitive& face, const Pose& pose_face, Count& count,
           std::initializer_list<double> more_radii = {}) {
  const Rational distance_square = square_of_distance(point, pose_point, face, pose_face);
  const double root = std::min(std::sqrt(static_cast<double>(distance_square)), 0x1p1000);
  const Object object(mesh_of(face));
  ++count.pairs;
  count.touched += distance_square == 0;
  std::vector<double> radii = {
      0.0, root, std::nextafter(root, infinity), std::nextafter(root, 0.0), 0.9 * root, std::min(1.1 * root, 0x1p1000)};
  radii.insert(radii.end(), more_radii.begin(), more_radii.end());
  for (const double radius : radii) {
    if (!(radius <= 0x1p1000)) continue;
    const Rational r(radius);
    const int side = Rational(r * r).compare(distance_square);
    ++count.questions;
    count.exactly += side == 0;
    if (meets(point, radius, pose_point, object, pose_face, count) == (side >= 0)) continue;
    std::ostringstream text;
    text.precision(17);
    text << "point " << point.transpose() << " radius " << radius << " side " << side << "\nface ";
    for (std::size_t i = 0; i < face.vertex_count(); ++i) text << face.v[i].transpose() << "; ";
    text << '\n' << pose_point.affine() << '\n' << pose_face.affine() << "\nseed " << seed();
    FAIL(text.str());
  }
}

/// Points of a face with weights in eighths: in it, on its sides, at its vertices.
Vec3d point_of(const GridPrimitive& face, std::mt19937_64& random) {
  std::array<int, 4> weight = {};
  const std::size_t members = 1 + random() % face.vertex_count();
  for (int i = 0; i < 8; ++i) ++weight[random() % members];
  const std::size_t shift = random();
  Vec3d p = Vec3d::Zero();
  for (std::size_t i = 0; i < face.vertex_count(); ++i) {
    const Vec3i& v = face.v[(i + shift) % face.vertex_count()];
    for (Eigen::Index k = 0; k < 3; ++k) p[k] += weight[i] * static_cast<double>(v[static_cast<int>(k)]) / 8;
  }
  return p;
}

/// On a grid, where distances often are doubles.
void check_grid(int rounds, Count& count) {
  std::mt19937_64 random(seed() + 61);
  for (const PairClass c : pair_classes) {
    for (const int range : {2, 30}) {
      PairSource source(-range, range, static_cast<std::uint64_t>(c) + 350 + static_cast<std::uint64_t>(range));
      for (int i = 0; i < rounds; ++i) {
        const GridPair grid = source.pair(c, i % 3 == 0 ? Kind::quad : Kind::tri, Kind::tri);
        Vec3d point = point_of(grid.a, random);
        if (i % 4 == 1) {  // off the face along an axis
          point[static_cast<Eigen::Index>(random() % 3)] += static_cast<double>(random() % 9);
        } else if (i % 4 == 2) {
          for (Eigen::Index k = 0; k < 3; ++k) point[k] = grid.b.v[0][static_cast<int>(k)];
        }
        const int exponent = i % 5 == 0 ? std::array<int, 4>{-900, -300, 180, 400}[random() % 4] : -2;
        for (double& x : point) x = std::ldexp(x, exponent);
        check(point, Pose::Identity(), scaled(grid.a, exponent), Pose::Identity(), count);
      }
    }
  }
}

void check_posed(int rounds, Count& count) {
  std::mt19937_64 random(seed() + 62);
  for (const PairClass c : pair_classes) {
    PairSource source(-20, 20, static_cast<std::uint64_t>(c) + 450);
    for (int i = 0; i < rounds; ++i) {
      const GridPair grid = source.pair(c, i % 3 == 0 ? Kind::quad : Kind::tri, Kind::tri);
      Primitive face = scaled(grid.a, -3);
      Vec3d point = point_of(grid.a, random) / 8;
      if (i % 4 >= 2) point += Vec3d(1, 0.5, -0.25) * static_cast<double>(random() % 4);
      if (i % 8 == 3) {
        for (Vec3d& v : face.v) v += 1e-3 * Vec3d(std::sin(v.x() + 1), std::cos(v.y()), v.z());
      }
      const PoseClass pose_class = pose_classes[static_cast<std::size_t>(i / 2) % std::size(pose_classes)];
      const double range = i % 7 == 0 ? 0x1p30 : 4;
      Pose pose_face = random_pose(pose_class, range, random);
      Pose pose_point = i % 3 == 0 ? random_pose(pose_class, 2, random) : pose_face;
      if (i % 3 == 1) pose_point.translation() += Vec3d(1, 2, static_cast<double>(random() % 8));
      if (i % 11 == 0) {
        const double factor = std::array<double, 4>{0x1p-480, 0x1p-200, 0x1p250, 0x1p420}[random() % 4];
        pose_face = Pose(Eigen::Scaling(factor) * pose_face.affine());
        pose_point = Pose(Eigen::Scaling(factor) * pose_point.affine());
      }
      check(point, pose_point, face, pose_face, count, {0.25, 1.0});
    }
  }
}

}  // namespace

TEST_CASE("points: a sphere and a face on a grid", "[lib][points]") {
  Count count;
  check_grid(200, count);
  std::cout << count << '\n';
  CHECK(count.pairs == 2000);
  CHECK(count.touched > 300);
  CHECK(count.exactly > count.touched + 300);
  CHECK(count.open > 500);
}

TEST_CASE("points: a sphere and a face under poses", "[lib][points]") {
  Count count;
  check_posed(220, count);
  std::cout << count << '\n';
  CHECK(count.pairs == 1100);
  CHECK(count.touched > 50);
  CHECK(count.exactly > count.touched);
  CHECK(count.open > 200);
}

TEST_CASE("points: many spheres and faces", "[.long]") {
  Count count;
  check_grid(7000, count);
  std::cout << count << '\n';
  check_posed(6000, count);
  std::cout << count << '\n';
  CHECK(count.pairs == 100000);
}

// --- distances that are known

TEST_CASE("points: tangent to a face, a side and a vertex", "[lib][points]") {
  Primitive face;  // in the plane z = 0
  face.v = {Vec3d(0, 0, 0), Vec3d(16, 0, 0), Vec3d(0, 16, 0), Vec3d::Zero()};
  struct Case {
    Vec3d point;
    double distance;
  };
  // Above the inside, beside the side y = 0 (3-4-5), beside the vertex (2-3-6-7), on the long side's line (5-12-13).
  const Case cases[] = {{{4, 4, 5}, 5},   {{4, -3, 4}, 5}, {{-2, -3, 6}, 7},
                        {{18, -2, 1}, 3}, {{4, 5, 0}, 0},  {{8, 8, 0}, 0}};
  Count count;
  std::size_t which = 0;
  for (const double scale : {1.0, 0x1p-300, 0x1p-20, 0x1p40, 0x1p300}) {
    for (const bool mirror : {false, true}) {
      for (const Vec3d& turn : {Vec3d(0, 0, 0), Vec3d(90, 0, 0), Vec3d(0, 270, 90)}) {
        Pose pose = make_pose(scale * Vec3d(100, -7, 3), turn);
        pose.linear() *= scale;
        if (mirror) pose.linear().col(2) *= -1;
        const Object object(mesh_of(face));
        for (const Case& c : cases) {
          CAPTURE(scale, mirror, turn.transpose(), c.point.transpose(), which++);
          const double d = scale * c.distance;
          CHECK(meets(c.point, d, pose, object, pose, count));
          CHECK(meets(c.point, std::nextafter(d, infinity), pose, object, pose, count));
          if (d > 0) CHECK_FALSE(meets(c.point, std::nextafter(d, 0.0), pose, object, pose, count));
        }
      }
    }
  }
  CHECK(count.open > 100);
}

TEST_CASE("points: a small face at the origin, the cloud's frame far away", "[lib][points]") {
  // The face's first vertex is the origin whatever the rotation, and a corner of its box; the cloud's translation takes
  // its point there, too.
  std::mt19937_64 random(seed() + 67);
  std::uniform_real_distribution<double> unit(-1, 1);
  Count count;
  for (int i = 0; i < 500; ++i) {
    const double size = std::ldexp(1.0, -static_cast<int>(random() % 30));
    Primitive face;
    face.v = {Vec3d(0, 0, 0), Vec3d(size, 0, 0), Vec3d(0, size, 0), Vec3d::Zero()};
    const Pose pose_face = random_pose(PoseClass::rigid, 0, random);
    Vec3d point;
    for (double& x : point) x = std::ldexp(unit(random), static_cast<int>(random() % 40));
    Pose pose_point = Pose::Identity();
    pose_point.translation() = -point;
    CAPTURE(i, size, point.transpose(), seed());
    REQUIRE(meets(point, 0, pose_point, Object(mesh_of(face)), pose_face, count));
  }
}

TEST_CASE("points: the radius is in units of the world", "[lib][points]") {
  Primitive face;
  face.v = {Vec3d(0, 0, 0), Vec3d(16, 0, 0), Vec3d(0, 16, 0), Vec3d::Zero()};
  Pose twice = Pose::Identity();
  twice.linear() *= 2;
  const Object object(mesh_of(face));
  const Vec3d point(4, 4, 1);  // at a height of 2 in the world
  CHECK(collide(PointCloud({point}, 2.0), twice, object, twice).hit);
  CHECK_FALSE(collide(PointCloud({point}, 1.99), twice, object, twice).hit);
  // A radius of another magnitude than everything else, against one that just reaches the face.
  Pose above = twice;
  above.translation().z() = 0x1p300;
  CHECK(collide(PointCloud({point}, 0x1p300), twice, object, twice).hit);
  CHECK(collide(PointCloud({Vec3d(4, 4, 0)}, 0x1p300), above, object, twice).hit);
  CHECK_FALSE(collide(PointCloud({Vec3d(4, 4, 0)}, std::nextafter(0x1p300, 0.0)), above, object, twice).hit);
}

// --- clouds

namespace {

CloudRequest all() { return {CollisionRequest::Contacts::all}; }

/// To a grid on which quarter turns, powers of two and shifts of moderate size are exact.
void to_sixteenths(std::vector<Vec3d>& points) {
  for (Vec3d& p : points) p = (16 * p).array().round() / 16;
}

std::vector<Vec3d> random_points(std::size_t count, double range, std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(-range, range);
  std::vector<Vec3d> points(count);
  for (Vec3d& p : points) {
    for (double& x : p) x = place(random);
  }
  return points;
}

/// All pairs; `test_distance` tests what decides them.
std::vector<CloudContact> all_pairs(const std::vector<Vec3d>& points, const std::vector<double>& radii,
                                    const Pose& pose_points, const Mesh& mesh, const Pose& pose_mesh) {
  const PosedDistances distances(pose_points, pose_mesh);
  std::vector<CloudContact> found;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    Primitive point;
    point.v.fill(points[i]);
    for (std::uint32_t k = 0; k < mesh.faces.size(); ++k) {
      if (distances.within(point, mesh.primitive(k), radii[i]).hit) found.push_back({i, mesh.number_in_file(k)});
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<Mesh> meshes_of(std::mt19937_64& random) {
  Mesh tiny = make_torus(1, 0.4, 5, 3);
  for (Vec3d& v : tiny.vertices) v *= 1e-3;
  return {make_torus(1, 0.4, 12, 8), noisy(make_torus(1, 0.4, 8, 6, Kind::quad), 0.05, random), make_sphere(1, 4),
          tiny};
}

}  // namespace

TEST_CASE("points: clouds and meshes against all pairs", "[lib][points]") {
  std::mt19937_64 random(seed() + 63);
  std::size_t contacts = 0;
  std::size_t clear = 0;
  int round = 0;
  for (const PoseClass pose_class : pose_classes) {
    for (const Mesh& mesh : meshes_of(random)) {
      const Object object(mesh);
      for (const std::size_t size : {std::size_t{1}, std::size_t{15}, std::size_t{17}, std::size_t{300}}) {
        const double range = round % 3 == 0 ? 3 : 1.2;
        std::vector<Vec3d> points = random_points(size, range, random);
        if (round % 4 == 1) {  // on vertices and middles of sides
          for (std::size_t i = 0; i < points.size(); i += 2) {
            points[i] = mesh.vertices[random() % mesh.vertices.size()];
            if (i % 4 == 0) points[i] = (points[i] + mesh.vertices[random() % mesh.vertices.size()]) / 2;
          }
        }
        std::vector<double> radii(size, 0.0);
        for (double& r : radii) r = std::array<double, 4>{0, 0.01, 0.125, 0.3}[random() % 4];
        const Pose pose_mesh = random_pose(pose_class, 1, random);
        const Pose pose_points = round % 2 == 0 ? random_pose(pose_class, 1, random) : pose_mesh;
        ++round;
        const std::vector<CloudContact> expected = all_pairs(points, radii, pose_points, mesh, pose_mesh);
        const PointCloud cloud(points, radii);
        const CloudResult found = collide(cloud, pose_points, object, pose_mesh, all());
        CAPTURE(round, size, seed());
        REQUIRE(found.contacts == expected);
        REQUIRE(found.hit == !expected.empty());
        contacts += expected.size();
        clear += expected.empty();
        const CloudResult first = collide(cloud, pose_points, object, pose_mesh);
        REQUIRE(first.hit == found.hit);
        REQUIRE(first.contacts.size() == (found.hit ? 1U : 0U));
        if (first.hit) {
          REQUIRE(std::binary_search(expected.begin(), expected.end(), first.contacts[0]));
        }
        // One radius for all.
        const std::vector<double> same(size, 0.125);
        REQUIRE(collide(PointCloud(points, 0.125), pose_points, object, pose_mesh, all()).contacts ==
                all_pairs(points, same, pose_points, mesh, pose_mesh));
      }
    }
  }
  std::cout << "queries=" << round << " contacts=" << contacts << " clear=" << clear << '\n';
  CHECK(contacts > 10000);
  CHECK(clear > 10);
}

TEST_CASE("points: a cloud of many blocks leaves no point out", "[lib][points]") {
  // One point of the cloud lies on the plate, wherever the tree keeps it.
  std::mt19937_64 random(seed() + 64);
  Primitive plate;
  plate.kind = Kind::quad;
  plate.v = {Vec3d(-8, -8, 0), Vec3d(8, -8, 0), Vec3d(8, 8, 0), Vec3d(-8, 8, 0)};
  const Object object(mesh_of(plate));
  std::vector<Vec3d> points = random_points(20000, 4, random);
  for (Vec3d& p : points) p.z() = std::abs(p.z()) + 0.5;
  CHECK_FALSE(collide(PointCloud(points, 0.25), Pose::Identity(), object, Pose::Identity(), all()).hit);
  for (int i = 0; i < 60; ++i) {
    const std::size_t at = random() % points.size();
    const Vec3d kept = points[at];
    points[at].z() = 0.25;
    const CloudResult found = collide(PointCloud(points, 0.25), Pose::Identity(), object, Pose::Identity(), all());
    REQUIRE(found.contacts == std::vector<CloudContact>{{static_cast<std::uint32_t>(at), 0}});
    points[at] = kept;
  }
}

TEST_CASE("points: few blocks above one large face", "[lib][points]") {
  // A cloud of several nodes, an object of one leaf, whichever of them is larger.
  for (const double size : {0.25, 8.0}) {
    Primitive plate;
    plate.kind = Kind::quad;
    plate.v = {Vec3d(-size, -size, 0), Vec3d(size, -size, 0), Vec3d(size, size, 0), Vec3d(-size, size, 0)};
    const Object object(mesh_of(plate));
    std::vector<Vec3d> points;
    std::vector<CloudContact> expected;
    for (int i = 0; i < 300; ++i) {
      const bool low = i % 7 == 3;
      points.emplace_back(i % 20 - 9.5, (i / 20) - 7.0, low ? 0.25 : 0.5);
      const double beyond = std::max(std::max(std::abs(points.back().x()), std::abs(points.back().y())) - size, 0.0);
      // Beside the plate's corner, 0.25 away in both directions, is too far; no other point is that near.
      if (low && beyond == 0) expected.push_back({static_cast<std::uint32_t>(i), 0});
    }
    const CloudResult found = collide(PointCloud(points, 0.25), Pose::Identity(), object, Pose::Identity(), all());
    CHECK(found.contacts == expected);
    CHECK(found.stats.steps > 0);
    CHECK(found.stats.box_tests > found.stats.steps);
    CHECK(collide(PointCloud(points, 0.25), Pose::Identity(), object, Pose::Identity()).hit == !expected.empty());
  }
}

TEST_CASE("points: an object far from its own origin, brought back by its pose", "[lib][points]") {
  // On a grid of 1/16, which 2^36 more do not change.
  std::mt19937_64 random(seed() + 68);
  std::size_t contacts = 0;
  for (int round = 0; round < 12; ++round) {
    Mesh mesh = make_torus(1, 0.4, 6, 4, round % 2 == 0 ? Kind::quad : Kind::tri);
    to_sixteenths(mesh.vertices);
    std::vector<Vec3d> points = random_points(60, 1.5, random);
    to_sixteenths(points);
    // Some on the object's sides and vertices.
    for (std::size_t i = 0; i < 20; ++i) points[i] = mesh.vertices[random() % mesh.vertices.size()];
    std::vector<double> radii(points.size(), 0.0);
    for (std::size_t i = 10; i < radii.size(); ++i) radii[i] = static_cast<double>(random() % 5) / 16;
    const PointCloud cloud(points, radii);
    const std::vector<CloudContact> expected =
        collide(cloud, Pose::Identity(), Object(mesh), Pose::Identity(), all()).contacts;
    contacts += expected.size();
    Vec3d offset = Vec3d::Zero();
    offset[round % 3] = round % 4 < 2 ? 0x1p36 : -0x1p36;
    for (Vec3d& v : mesh.vertices) v += offset;
    Pose back = Pose::Identity();
    back.translation() = -offset;
    CHECK(collide(cloud, Pose::Identity(), Object(mesh), back, all()).contacts == expected);
    // And the cloud's frame there, too.
    Pose there = Pose::Identity();
    there.translation() = offset;
    CHECK(collide(cloud, there, Object(mesh), Pose::Identity(), all()).contacts == expected);
  }
  CHECK(contacts > 500);
}

TEST_CASE("points: outliers, equal points, points in a line and an empty cloud", "[lib][points]") {
  const Object ball(make_sphere(1, 3));
  const Pose here = Pose::Identity();
  CHECK_FALSE(collide(PointCloud({}, 1.0), here, ball, here, all()).hit);
  std::vector<Vec3d> points(1000, Vec3d(0, 0, 1.5));
  CHECK(collide(PointCloud(points, 0.5), here, ball, here, all()).contacts ==
        all_pairs(points, std::vector<double>(1000, 0.5), here, ball.mesh(), here));
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = Vec3d(0, 0, 0.01 * static_cast<double>(i));
  points[7] = Vec3d(0x1p1000, 0, 0);
  points[8] = Vec3d(0, -0x1p1000, 1);
  CHECK(collide(PointCloud(points, 0.5), here, ball, here, all()).contacts ==
        all_pairs(points, std::vector<double>(1000, 0.5), here, ball.mesh(), here));
  std::vector<double> radii(1000, 0.0);
  radii[7] = 0x1p1000;  // touches the plane of the origin: meets faces behind it
  CHECK(collide(PointCloud(points, radii), here, ball, here, all()).contacts ==
        all_pairs(points, radii, here, ball.mesh(), here));
}

// --- what changes nothing

TEST_CASE("points: common motions, scales and mirrors change nothing", "[lib][points]") {
  std::mt19937_64 random(seed() + 65);
  std::size_t contacts = 0;
  for (int round = 0; round < 60; ++round) {
    // On a grid of 1/16, so that quarter turns, shifts and powers of two are exact.
    Mesh mesh = make_torus(1, 0.4, 8, 5, round % 2 == 0 ? Kind::quad : Kind::tri);
    to_sixteenths(mesh.vertices);
    std::vector<Vec3d> points = random_points(200, 1.5, random);
    to_sixteenths(points);
    std::vector<double> radii(points.size());
    for (double& r : radii) r = static_cast<double>(random() % 5) / 16;
    const Pose pose_a = random_pose(PoseClass::quarter_turns, 0, random);
    Pose pose_b = random_pose(PoseClass::quarter_turns, 0, random);
    pose_b.translation() = Vec3d(0.125, -0.5, 0.25);
    const Object object(mesh);
    const PointCloud cloud(points, radii);
    const std::vector<CloudContact> expected = collide(cloud, pose_a, object, pose_b, all()).contacts;
    contacts += expected.size();
    Pose motion = random_pose(PoseClass::quarter_turns, 0, random);
    motion.translation() = Vec3d(5, -3, 0.75);
    CHECK(collide(cloud, motion * pose_a, object, motion * pose_b, all()).contacts == expected);
    // The inverse of the object's pose on the cloud's side.
    CHECK(collide(cloud, pose_b.inverse(Eigen::Isometry) * pose_a, object, Pose::Identity(), all()).contacts ==
          expected);
    Pose mirror = Pose::Identity();
    mirror.linear()(1, 1) = -1;
    CHECK(collide(cloud, mirror * pose_a, object, mirror * pose_b, all()).contacts == expected);
    for (const double scale : {2.0, 0x1p-480, 0x1p500}) {
      Pose larger = Pose::Identity();
      larger.linear() *= scale;
      std::vector<double> larger_radii = radii;
      for (double& r : larger_radii) r *= scale;
      CAPTURE(scale);
      const PointCloud larger_cloud(points, larger_radii);
      CHECK(collide(larger_cloud, larger * pose_a, object, larger * pose_b, all()).contacts == expected);
    }
    // Another order of the points.
    std::vector<Vec3d> turned(points.rbegin(), points.rend());
    const std::vector<double> turned_radii(radii.rbegin(), radii.rend());
    std::vector<CloudContact> back = collide(PointCloud(turned, turned_radii), pose_a, object, pose_b, all()).contacts;
    for (CloudContact& c : back) c.point = static_cast<std::uint32_t>(points.size() - 1 - c.point);
    std::sort(back.begin(), back.end());
    CHECK(back == expected);
  }
  CHECK(contacts > 2000);
}

// --- requests and errors

TEST_CASE("points: at most so many contacts, faces of the file, several objects", "[lib][points]") {
  const Pose here = Pose::Identity();
  Eigen::MatrixXd vertices(4, 3);  // a quad with a dent: two triangles that are one face
  vertices << 0, 0, 0, 4, 0, 0, 1, 1, 0, 0, 4, 0;
  Eigen::MatrixXi faces(1, 4);
  faces << 0, 1, 2, 3;
  const Object dented(make_mesh(vertices, faces));
  REQUIRE(dented.mesh().faces.size() == 2);
  const std::vector<Vec3d> points = {{0.5, 0.5, 1}, {0.75, 0.75, 1}, {9, 9, 9}, {0.5, 0.25, 1}};
  const PointCloud cloud(points, 1.0);
  const std::vector<CloudContact> three = {{0, 0}, {1, 0}, {3, 0}};
  CHECK(collide(cloud, here, dented, here, all()).contacts == three);
  CloudRequest request = all();
  for (const std::size_t most : {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{4}}) {
    request.max_contacts = most;
    CHECK(collide(cloud, here, dented, here, request).contacts.size() == std::min<std::size_t>(most, 3));
  }
  const Object ball(make_sphere(1, 3));
  Pose far = here;
  far.translation().x() = 50;
  std::vector<PlacedObject> objects = {{&ball, far}, {&dented, here}, {&ball, here}};
  std::vector<CloudResult> results(7);
  collide(cloud, here, objects, all(), results);
  REQUIRE(results.size() == 3);
  CHECK_FALSE(results[0].hit);
  CHECK(results[1].contacts == three);
  CHECK(results[2].contacts == collide(cloud, here, ball, here, all()).contacts);
  CHECK(first_met(cloud, here, objects) == 1);
  objects.resize(1);
  CHECK(first_met(cloud, here, objects) == 1);
}

TEST_CASE("points: queries take no memory from the heap", "[lib][points]") {
  std::mt19937_64 random(seed() + 66);
  const PointCloud cloud(random_points(5000, 2, random), 0.05);
  const Object ball(make_sphere(1, 8));
  std::vector<Pose> poses;
  for (int i = 0; i < 50; ++i) poses.push_back(random_pose(PoseClass::rigid, i % 2 == 0 ? 1 : 9, random));
  for (const CloudRequest& request : {CloudRequest{}, all()}) {
    CloudResult result;
    std::size_t contacts = 0;
    for (const Pose& pose : poses) collide(cloud, Pose::Identity(), ball, pose, request, result);
    const std::size_t before = allocations;
    for (const Pose& pose : poses) {
      collide(cloud, Pose::Identity(), ball, pose, request, result);
      contacts += result.contacts.size();
    }
    CHECK(allocations == before);
    CHECK(contacts > 20);
  }
}

TEST_CASE("points: what is refused", "[lib][points]") {
  const auto refused = [](const auto& call, const std::string& text) {
    CHECK_THROWS_WITH(call(), Catch::Matchers::Contains(text));
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused([] { PointCloud({{0, 0, 0}}, -1.0); }, "the radius is -1");
  refused([&] { PointCloud({{0, 0, 0}}, nan); }, "the radius is nan");
  refused([] { PointCloud({{0, 0, 0}}, infinity); }, "the radius is inf");
  refused([] { PointCloud({{0, 0, 0}, {1, 1, 1}}, std::vector<double>{0, -1}); }, "the radius of point 1 is -1");
  refused([] { PointCloud({{0, 0, 0}}, std::vector<double>{0, 1}); }, "2 radii for 1 points");
  for (const double bad : {nan, infinity, -infinity, 0x1.1p1000}) {
    refused([&] { PointCloud({{0, 0, 0}, {1, bad, 1}}, 1.0); }, "point 1 has a coordinate");
    refused([&] { PointCloud({{0, 0, 0}, {1, 1, bad}}, std::vector<double>{1, 1}); }, "point 1 has a coordinate");
  }
  PointCloud cloud({{0, 0, 0}}, 1.0);
  Object ball(make_sphere(1, 2));
  const Pose here = Pose::Identity();
  Pose bad = here;
  bad(1, 2) = nan;
  refused([&] { collide(cloud, bad, ball, here); }, "pose of the cloud: row 1, column 2");
  refused([&] { collide(cloud, here, ball, bad); }, "pose of the object: row 1, column 2");
  refused([&] { collide(cloud, here, ball, here, {CollisionRequest::Contacts::all, 0}); }, "max_contacts is 0");
  std::vector<CloudResult> results;
  refused([&] { collide(cloud, here, {{nullptr, here}}, {}, results); }, "object 0 is a null pointer");
  refused([&] { first_met(cloud, here, {{nullptr, here}}); }, "object 0 is a null pointer");
  const PointCloud moved = std::move(cloud);
  CHECK(moved.size() == 1);
  refused([&] { collide(cloud, here, ball, here); }, "it was moved from");  // NOLINT: on purpose
  refused([&] { cloud.size(); }, "it was moved from");
  const Object other = std::move(ball);
  refused([&] { collide(moved, here, ball, here); }, "it was moved from");  // NOLINT: on purpose
}
