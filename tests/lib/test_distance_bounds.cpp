// SPDX-License-Identifier: Apache-2.0
// Bounds of the search for the distance against integers of any size.
#include <catch2/catch.hpp>
#include <cchip/distance.hpp>
#include <cchip/internal/tree/support_tree.hpp>
#include <cchip/shapes.hpp>
#include <cmath>
#include <functional>
#include <iostream>
#include <limits>

#include "bvh_meshes.hpp"
#include "distance_oracle.hpp"
#include "exact/fine_filter.hpp"
#include "exact/nearest_planes.hpp"
#include "random_poses.hpp"
#include "search/behind_plane.hpp"
#include "search/frame_gap.hpp"
#include "search/search.hpp"
#include "search/simd_distance.hpp"

using namespace cchip;
using namespace cchip::testing;
using namespace cchip_test;

namespace {

constexpr int unit_bits = 2300;

/// Coordinates on a coarse grid, on its neighbours among the doubles, and anywhere.
double coordinate(std::mt19937_64& random) {
  const double whole = static_cast<double>(random() % 9) - 4;
  switch (random() % 8) {
    case 0:
      return std::ldexp(static_cast<double>(random()), -63) - 1;
    case 1:
      return std::nextafter(whole, random() % 2 == 0 ? 9 : -9);
    case 2:
      return 0;
    default:
      return whole;
  }
}

Vec3d vector(std::mt19937_64& random) {
  const double x = coordinate(random);
  const double y = coordinate(random);
  return {x, y, coordinate(random)};
}

Mesh mesh_of_one_face(std::mt19937_64& random, double size) {
  Mesh mesh;
  const Vec3d p = size * vector(random);
  const Vec3d q = size * vector(random);
  add_face(mesh, {p, q, size * vector(random)});
  return mesh;
}

/// x in units of 2^-1200.
BigInt in_units(double x) { return BigInt(Parts(x).mantissa) << (Parts(x).exponent + 1200); }

/// Of any length, along an axis, a diagonal, or neither.
Vec3d axis(std::mt19937_64& random) {
  return std::ldexp(1.0, static_cast<int>(random() % 5) * 40 - 80) * vector(random);
}

std::vector<simd::DistanceKernels> all_kernels() {
  std::vector<simd::DistanceKernels> kernels;
  for (const std::string& target : simd_targets()) kernels.push_back(simd::distance_kernels(target));
  return kernels;
}

constexpr float any = 1e15F;

}  // namespace

TEST_CASE("distance bounds: gaps along a frame and a line", "[lib][distance]") {
  std::mt19937_64 random(sim::seed_from_environment() + 60);
  const std::vector<simd::DistanceKernels> kernels = all_kernels();
  int tight_faces = 0;
  int tight_slabs = 0;
  int tight_along = 0;
  int tight = 0;
  int tight_on_line = 0;
  int apart = 0;
  for (int i = 0; i < 6000; ++i) {
    const Mesh mesh_a = mesh_of_one_face(random, std::ldexp(1.0, static_cast<int>(random() % 3) * 15 - 15));
    const Mesh mesh_b = mesh_of_one_face(random, std::ldexp(1.0, static_cast<int>(random() % 3) * 15 - 15));
    const Object a(mesh_a);
    const Object b(mesh_b);
    const PoseClass c = pose_classes[static_cast<std::size_t>(i) % std::size(pose_classes)];
    Pose pose_a = random_pose(c, 4, random);
    Pose pose_b = random_pose(i % 3 == 0 ? PoseClass::rigid : c, 4, random);
    if (i % 4 == 0) pose_a.linear() = pose_b.linear() = Eigen::Matrix3d::Identity();
    if (i % 8 == 0) pose_a.translation() = vector(random);
    if (i % 8 == 0) pose_b.translation() = vector(random);
    if (i % 50 == 0) pose_a.linear() *= i % 100 == 0 ? 0x1p300 : 0x1p-300;
    const IntSquare<BigInt> square = square_of_distance(posed_points(mesh_a.primitive(0), pose_a, unit_bits),
                                                        posed_points(mesh_b.primitive(0), pose_b, unit_bits));
    FrameGap frame(a, pose_a, b, pose_b);
    const bvh::SupportLine& line_a = a.tree().lines()[a.tree().root().first()];
    const bvh::SupportLine& line_b = b.tree().lines()[b.tree().root().first()];
    const double root = rough_root(square, unit_bits);
    apart += root > 0;
    const PosedDistances posed(pose_a, pose_b);
    const DistanceBounds near = posed.bounds(mesh_a.primitive(0), mesh_b.primitive(0));
    for (int k = 0; k < 4; ++k) {
      const Vec3d n = k == 0 ? Vec3d(near.point_b - near.point_a) : axis(random);
      frame.set_axis(n);
      CAPTURE(i, k, n.transpose(), root, sim::seed_from_environment());
      simd::DistanceFrame single;
      const double unit = frame.in_single(single);
      for (const simd::DistanceKernels& kernel : kernels) {
        simd::NodeGaps gaps;
        simd::FaceGaps faces;
        REQUIRE(kernel.nodes(single, &line_a, 1, &line_b, 1, 0, any, gaps) == 1);
        const double in_single = std::sqrt(static_cast<double>(gaps.square[0])) * unit;
        const double by_slabs = frame.slab_gap(frame.slab_a(line_a, gaps.a[0]), frame.slab_b(line_b, gaps.b[0])) * unit;
        REQUIRE(kernel.leaves(single, a.tree().vertices(line_a.ref().first()), line_a.ref(),
                              b.tree().vertices(line_b.ref().first()), line_b.ref(), any, faces));
        const double lower = faces.lower[0] * unit;
        const double upper = faces.upper[0] * unit;
        const Vec3d between(faces.between[0][0], faces.between[1][0], faces.between[2][0]);
        const double along = posed.gap_along(frame.in_world(between), mesh_a.primitive(0), mesh_b.primitive(0));
        CAPTURE(in_single, by_slabs, lower, upper, along);
        for (const double bound : {in_single, by_slabs, lower, along}) {
          if (bound > 0) REQUIRE(compare(square, bound, unit_bits) >= 0);
        }
        if (upper < std::numeric_limits<double>::infinity()) REQUIRE(compare(square, upper, unit_bits) <= 0);
        (k == 0 ? tight : tight_on_line) += root > 0 && in_single > 0.99 * root ? 1 : 0;
        tight_faces += root > 0 && lower > 0.999 * root && upper < 1.001 * root ? 1 : 0;
        tight_along += root > 0 && along > root * (1 - 1e-6) ? 1 : 0;
        tight_slabs += root > 0 && by_slabs > 0.9 * root ? 1 : 0;
        // Beyond a limit, too, a lower bound stays one.
        if (root > 0 && !kernel.leaves(single, a.tree().vertices(line_a.ref().first()), line_a.ref(),
                                       b.tree().vertices(line_b.ref().first()), line_b.ref(),
                                       static_cast<float>(0.5 * root / unit), faces)) {
          REQUIRE(compare(square, faces.lower[0] * unit, unit_bits) >= 0);
        }
      }
    }
  }
  std::cout << "apart=" << apart << " tight=" << tight << " tight_on_line=" << tight_on_line
            << " tight_faces=" << tight_faces << " tight_slabs=" << tight_slabs << " tight_along=" << tight_along
            << '\n';
  CHECK(tight_faces > 10000);
  CHECK(tight_slabs > 1000);
  CHECK(tight_along > 10000);
  CHECK(apart > 3000);
  // Bounds that are never near the distance would prove little.
  CHECK(tight > 1000);
  CHECK(tight_on_line > 1000);
}

TEST_CASE("distance bounds: gaps of near objects, far from their origins", "[lib][distance]") {
  // What is added up nearly cancels: sizes of A and B, or of a centre and what lies around it. The length of the normal
  // is 7 and all coordinates are exact, so that the distance is known.
  std::mt19937_64 random(sim::seed_from_environment() + 65);
  const Vec3d normal(2, 3, 6);
  const Vec3d u(3, -2, 0);
  const Vec3d v(0, 2, -1);
  const Pose here = Pose::Identity();
  const std::vector<simd::DistanceKernels> kernels = all_kernels();
  int tight = 0;
  for (int i = 0; i < 1200; ++i) {
    const auto part = [&random](int bits) {
      return std::ldexp(static_cast<double>(random() % (1U << 20U)), bits - 20);
    };
    const double side = 1 + part(0);
    const double distance = std::ldexp(7.0, -24 - static_cast<int>(random() % 8));
    const double stretch = 1 + 0x1p-9 * part(0);
    const Vec3d p(part(3), part(3), part(3));
    const Vec3d over = p + 0.25 * side * (u + v) + distance / 7 * normal;
    Mesh mesh_a;
    Mesh mesh_b;
    add_face(mesh_a, {p, p + side * u, p + side * v});
    add_face(mesh_b, {over, over + stretch * u + 0x1p-10 * normal, over + stretch * v + 0x1p-10 * normal});
    const bool is_swapped = i % 2 != 0;
    const Object a(is_swapped ? mesh_b : mesh_a);
    const Object b(is_swapped ? mesh_a : mesh_b);
    FrameGap frame(a, here, b, here);
    frame.set_axis(i % 3 == 0 ? Vec3d(vector(random)) : normal);
    // A zero vector is refused, and the axes stay.
    if (i % 3 == 1) frame.set_axis(Vec3d::Zero());
    simd::DistanceFrame single;
    const double unit = frame.in_single(single);
    const bvh::SupportLine& line_a = a.tree().lines()[a.tree().root().first()];
    const bvh::SupportLine& line_b = b.tree().lines()[b.tree().root().first()];
    for (const simd::DistanceKernels& kernel : kernels) {
      simd::NodeGaps gaps;
      simd::FaceGaps faces;
      REQUIRE(kernel.nodes(single, &line_a, 1, &line_b, 1, 0, any, gaps) == 1);
      REQUIRE(kernel.leaves(single, a.tree().vertices(line_a.ref().first()), line_a.ref(),
                            b.tree().vertices(line_b.ref().first()), line_b.ref(), any, faces));
      const double by_nodes = std::sqrt(static_cast<double>(gaps.square[0])) * unit;
      const double lower = faces.lower[0] * unit;
      const double upper = faces.upper[0] * unit;
      CAPTURE(i, by_nodes, lower, upper, distance, sim::seed_from_environment());
      REQUIRE(by_nodes <= distance);
      REQUIRE(lower <= distance);
      REQUIRE(upper >= distance);
      tight += upper - lower < 64 * 0x1p-24 * unit ? 1 : 0;
    }
  }
  CHECK(tight > 800);
}

TEST_CASE("distance bounds: four nodes against four", "[lib][distance]") {
  std::mt19937_64 random(sim::seed_from_environment() + 68);
  const std::vector<simd::DistanceKernels> kernels = all_kernels();
  const auto faces_below = [](const Object& object, bvh::NodeRef node) {
    std::vector<std::uint32_t> faces;
    const std::function<void(bvh::NodeRef)> visit = [&](bvh::NodeRef at) {
      for (std::uint32_t k = at.first(); k < at.first() + at.count(); ++k) {
        if (at.is_leaf()) {
          faces.push_back(object.tree().faces()[k]);
        } else {
          visit(object.tree().lines()[k].ref());
        }
      }
    };
    visit(node);
    return faces;
  };
  int tight = 0;
  int pruned = 0;
  for (int i = 0; i < 60; ++i) {
    const Object a(make_sphere(1, 1 + i % 3));
    const Object b(make_torus(1, 0.25, 4 + i % 5, 5, i % 2 == 0 ? Kind::tri : Kind::quad));
    const Pose pose_a = random_pose(PoseClass::rigid, 1, random);
    Pose pose_b = random_pose(pose_classes[static_cast<std::size_t>(i) % std::size(pose_classes)], 1, random);
    pose_b.translation() += 3 * vector(random);
    FrameGap frame(a, pose_a, b, pose_b);
    frame.set_axis(pose_b.translation() - pose_a.translation());
    simd::DistanceFrame single;
    const double unit = frame.in_single(single);
    const bvh::NodeRef root_a = a.tree().root();
    const bvh::NodeRef root_b = b.tree().root();
    const bvh::SupportLine* const lines_a = a.tree().lines() + root_a.first();
    const bvh::SupportLine* const lines_b = b.tree().lines() + root_b.first();
    std::array<double, 16> distance;
    double median = 0;
    for (std::uint32_t k = 0; k < root_a.count(); ++k) {
      for (std::uint32_t l = 0; l < root_b.count(); ++l) {
        double& least = distance[4 * k + l];
        least = std::numeric_limits<double>::infinity();
        for (const std::uint32_t x : faces_below(a, lines_a[k].ref())) {
          for (const std::uint32_t y : faces_below(b, lines_b[l].ref())) {
            const PosedDistances posed(pose_a, pose_b);
            least = std::min(least, posed.bounds(a.mesh().primitive(x), b.mesh().primitive(y)).upper);
          }
        }
        median += least / (root_a.count() * root_b.count());
      }
    }
    const auto most = static_cast<float>(median * median / (unit * unit));
    for (const simd::DistanceKernels& kernel : kernels) {
      simd::NodeGaps gaps;
      simd::NodeGaps limited;
      const unsigned all = kernel.nodes(single, lines_a, root_a.count(), lines_b, root_b.count(), 0, any, gaps);
      const unsigned near = kernel.nodes(single, lines_a, root_a.count(), lines_b, root_b.count(), 0, most, limited);
      float left_out = std::numeric_limits<float>::infinity();
      for (std::uint32_t k = 0; k < 4; ++k) {
        for (std::uint32_t l = 0; l < 4; ++l) {
          const std::uint32_t at = 4 * k + l;
          const bool is_there = k < root_a.count() && l < root_b.count();
          CAPTURE(i, k, l, is_there, sim::seed_from_environment());
          REQUIRE((all >> at & 1U) == is_there);
          if (!is_there) {
            REQUIRE((near >> at & 1U) == 0);
            continue;
          }
          const double bound = std::sqrt(static_cast<double>(gaps.square[at])) * unit;
          REQUIRE(bound <= distance[at]);
          tight += distance[at] > 0 && bound > 0.9 * distance[at] ? 1 : 0;
          if (distance[at] < median) REQUIRE((near >> at & 1U) == 1);
          if ((near >> at & 1U) == 1) continue;
          ++pruned;
          REQUIRE(gaps.square[at] > most);
          left_out = std::min(left_out, limited.square[at]);
        }
      }
      // At least as great as what was pruned by the frame alone, at most by all.
      REQUIRE(limited.left_out <= left_out);
      REQUIRE((limited.left_out > most || left_out == std::numeric_limits<float>::infinity()));
    }
  }
  CHECK(tight > 100);
  CHECK(pruned > 100);
}

TEST_CASE("distance bounds: half spaces are exact", "[lib][distance]") {
  std::mt19937_64 random(sim::seed_from_environment() + 61);
  int on = 0;
  int beyond = 0;
  for (int i = 0; i < 100000; ++i) {
    exact::Vec<exact::BigInt> normal;
    std::array<BigInt, 3> same;
    for (std::size_t k = 0; k < 3; ++k) {
      auto entry = static_cast<std::int64_t>(random() % 7) - 3;
      if (random() % 4 == 0) entry = static_cast<std::int64_t>(random());
      const int shift = static_cast<int>(random() % 4) * (random() % 64 == 0 ? 500 : 40);
      normal[k] = exact::BigInt(entry) << shift;
      same[k] = BigInt(entry) << shift;
    }
    const Vec3d through = vector(random);
    Vec3d v = vector(random);
    if (i % 3 == 0) v = through;
    if (i % 6 == 0) v[static_cast<Eigen::Index>(random() % 3)] = coordinate(random);
    if (i % 100 == 0) v *= std::ldexp(1.0, static_cast<int>(random() % 2000) - 1000);
    BigInt height = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      height += same[k] * (in_units(v[at]) - in_units(through[at]));
    }
    CAPTURE(i, v.transpose(), through.transpose(), sim::seed_from_environment());
    REQUIRE(exact::HalfSpace(normal, {through, through, through}).contains(v) == (height <= 0));
    on += height == 0;
    beyond += height > 0;
  }
  CHECK(on > 20000);
  CHECK(beyond > 20000);
}

TEST_CASE("distance bounds: what lies behind the planes through the nearest points is not nearer", "[lib][distance]") {
  std::mt19937_64 random(sim::seed_from_environment() + 62);
  int behind = 0;
  int equal = 0;
  for (int i = 0; i < 6000; ++i) {
    const PoseClass c = pose_classes[static_cast<std::size_t>(i) % std::size(pose_classes)];
    const Pose pose_a = i % 3 == 0 ? Pose::Identity() : random_pose(c, 4, random);
    const Pose pose_b = i % 3 == 0 ? Pose::Identity() : random_pose(i % 2 == 0 ? c : PoseClass::rigid, 4, random);
    std::array<Primitive, 2> a;
    std::array<Primitive, 2> b;
    for (std::size_t k = 0; k < 2; ++k) {
      a[k] = mesh_of_one_face(random, 1).primitive(0);
      b[k] = mesh_of_one_face(random, 1).primitive(0);
    }
    if (i % 5 == 0) {  // nearly parallel: normals of edges lose most of their digits
      const Vec3d over = vector(random);
      const double off = std::ldexp(1.0, -static_cast<int>(random() % 60));
      for (std::size_t k = 0; k < 3; ++k) b[0].v[k] = a[0].v[k] + over + off * vector(random);
    }
    a[1].v[0] = a[0].v[random() % 3];  // neighbours
    b[1].v[0] = b[0].v[random() % 3];
    const auto points = [&](const Primitive& p, const Pose& pose) { return posed_points(p, pose, unit_bits); };
    const IntSquare<BigInt> square = square_of_distance(points(a[0], pose_a), points(b[0], pose_b));
    if (square.over == 0) continue;
    const PosedDistances distances(pose_a, pose_b);
    const exact::NearestPlanes planes(distances, a[0], b[0]);
    CAPTURE(i, sim::seed_from_environment());
    REQUIRE(compare(square, planes.bounds().lower, unit_bits) >= 0);
    REQUIRE(compare(square, planes.bounds().upper, unit_bits) <= 0);
    REQUIRE(planes.a().contains(a[0]));
    REQUIRE(planes.b().contains(b[0]));
    if (!planes.a().contains(a[1]) || !planes.b().contains(b[1])) continue;
    ++behind;
    const IntSquare<BigInt> other = square_of_distance(points(a[1], pose_a), points(b[1], pose_b));
    const BigInt difference = other.over * square.under - square.over * other.under;
    REQUIRE(difference >= 0);
    equal += difference == 0;
  }
  std::cout << "behind=" << behind << " equal=" << equal << '\n';
  CHECK(behind > 500);
  CHECK(equal > 20);
}

TEST_CASE("distance bounds: sums of two doubles know their sign", "[lib][distance]") {
  std::mt19937_64 random(sim::seed_from_environment() + 66);
  int known = 0;
  int close = 0;
  int zero = 0;
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {
    // Volumes of four points of which one lies in the plane of the others, but for rounding.
    std::array<Vec3d, 4> p = {vector(random), vector(random), vector(random), vector(random)};
    if (i % 2 == 0) p[3] = p[0] + 0.25 * (p[1] - p[0]) + 0.5 * (p[2] - p[0]);
    if (i % 20 == 0) {
      for (Vec3d& v : p) v = v.array().round();
    }
    for (Vec3d& v : p) v = (v.array().abs() < 0x1p-100).select(0.0, v);  // so that the scale loses nothing
    const double scale = std::ldexp(1.0, static_cast<int>(random() % 400) - 200);
    exact::Vec<exact::FineFilter> fine[3];
    exact::Vec<BigInt> whole_numbers[3];
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<Eigen::Index>(axis);
        fine[k][axis] = exact::FineFilter(scale * p[k + 1][at]) - exact::FineFilter(scale * p[0][at]);
        whole_numbers[k][axis] = in_units(p[k + 1][at]) - in_units(p[0][at]);
      }
    }
    using exact::cross;
    using exact::dot;
    const exact::FineFilter volume = dot(fine[0], cross(fine[1], fine[2]));
    const BigInt right = dot(whole_numbers[0], cross(whole_numbers[1], whole_numbers[2]));
    CAPTURE(i, sim::seed_from_environment());
    close += right != 0 && i % 2 == 0;
    zero += right == 0;
    if (!volume.is_known()) continue;
    ++known;
    REQUIRE(volume.sign() == right.sign());
  }
  std::cout << "known=" << known << " of " << count << " close=" << close << " zero=" << zero << '\n';
  CHECK(known > count * 99 / 100 - zero);
  CHECK(close > 1000);
}

TEST_CASE("distance bounds: slabs hold what lies below", "[lib][distance]") {
  std::mt19937_64 random(sim::seed_from_environment() + 67);
  for (int i = 0; i < 6; ++i) {
    Mesh mesh = make_sphere(1, 2 + 2 * i);
    for (Vec3d& v : mesh.vertices) v = v + 0.1 * vector(random) + Vec3d(1e3, 0, 0);
    const Object object(mesh);
    const bvh::SupportTree& tree = object.tree();
    std::size_t slabs = 0;
    const std::function<void(bvh::NodeRef, const std::function<void(const Vec3d&)>&)> visit =
        [&](bvh::NodeRef node, const std::function<void(const Vec3d&)>& take) {
          for (std::uint32_t k = node.first(); k < node.first() + node.count(); ++k) {
            if (!node.is_leaf()) {
              visit(tree.lines()[k].ref(), take);
              continue;
            }
            const Primitive face = mesh.primitive(tree.faces()[k]);
            for (std::size_t corner = 0; corner < face.vertex_count(); ++corner) take(face.v[corner]);
          }
        };
    for (std::size_t n = 0; n < tree.size(); ++n) {
      bvh::Slab slab;
      if (!bvh::slab_of(tree.lines()[n], slab)) continue;
      ++slabs;
      double most = -1e9;
      double least = 1e9;
      visit(tree.lines()[n].ref(), [&](const Vec3d& v) {
        const double height = slab.normal.dot(v - tree.centre()) / tree.unit();
        most = std::max(most, height);
        least = std::min(least, height);
      });
      CAPTURE(i, n, most, least, slab.along, slab.against);
      REQUIRE(most <= slab.along);
      REQUIRE(-least <= slab.against);
      CHECK(slab.along - most < 2.1);
      CHECK(slab.against + least < 2.1);
    }
    CHECK(slabs > tree.size() / 2);
  }
}

TEST_CASE("distance bounds: nodes behind a plane", "[lib][distance]") {
  std::mt19937_64 random(sim::seed_from_environment() + 63);
  Mesh mesh;
  for (int i = 0; i < 200; ++i) {
    const Vec3d p = vector(random);
    add_face(mesh, {p, p + 0.25 * vector(random), p + 0.25 * vector(random)});
  }
  const Object object(mesh);
  const TreeSide side{object.mesh(), object.tree()};
  int inside = 0;
  int outside = 0;
  for (int i = 0; i < 200; ++i) {
    exact::Vec<exact::BigInt> normal;
    for (exact::BigInt& x : normal) x = static_cast<std::int64_t>(random() % 9) - 4;
    const Vec3d through = random() % 2 == 0 ? mesh.vertices[random() % mesh.vertices.size()] : vector(random);
    const exact::HalfSpace space(normal, {through, through, through});
    BehindPlane behind(side, space);
    // All nodes: whether all faces below them are inside.
    const std::function<bool(bvh::NodeRef)> check = [&](bvh::NodeRef node) {
      bool all = true;
      for (std::uint32_t k = node.first(); k < node.first() + node.count(); ++k) {
        all &= node.is_leaf() ? space.contains(mesh.primitive(object.tree().faces()[k]))
                              : check(object.tree().lines()[k].ref());
      }
      REQUIRE(behind.contains(node) == all);
      ++(all ? inside : outside);
      return all;
    };
    check(object.tree().root());
  }
  CHECK(inside > 1000);
  CHECK(outside > 1000);
}

// Vertices and translations are 10^6 times as large as what they leave: the bound on rounding is theirs.
TEST_CASE("distance bounds: faces whose large coordinates cancel", "[lib][distance]") {
  std::mt19937_64 random(sim::seed_from_environment() + 65);
  int open = 0;
  for (int i = 0; i < 20; ++i) {
    std::array<Primitive, 2> face;
    std::array<Pose, 2> pose;
    for (std::size_t k = 0; k < 2; ++k) {
      const Vec3d far = 0x1p20 * vector(random);
      pose[k] = random_pose(PoseClass::rigid, 1, random);
      pose[k].translation() = 4.0 * static_cast<double>(k) * vector(random) - pose[k].linear() * far;
      for (std::size_t v = 0; v < 3; ++v) face[k].v[v] = far + vector(random);
    }
    const IntSquare<BigInt> square =
        square_of_distance(posed_points(face[0], pose[0], unit_bits), posed_points(face[1], pose[1], unit_bits));
    const PosedDistances distances(pose[0], pose[1]);
    CAPTURE(i, sim::seed_from_environment());
    for (const DistanceBounds& bounds :
         {distances.bounds(face[0], face[1]), distances.tight_bounds(face[0], face[1])}) {
      REQUIRE(compare(square, bounds.lower, unit_bits) >= 0);
      REQUIRE(compare(square, bounds.upper, unit_bits) <= 0);
      if (bounds.lower == 0) continue;
      for (const double d : {bounds.lower, std::nextafter(bounds.lower, 0.0), bounds.upper}) {
        const PosedDistances::Answer near = distances.within(face[0], face[1], d);
        REQUIRE(near.hit == (compare(square, d, unit_bits) <= 0));
        open += near.open;
      }
    }
  }
  CHECK(open > 10);
}

TEST_CASE("distance bounds: many pairs at the same distance take few tests", "[lib][distance]") {
  const auto plate = [](const Vec3d& corner, int n) {
    Mesh mesh;
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < n; ++k) {
        const Vec3d p = corner + Vec3d(i, k, 0) / n;
        add_face(mesh, {p, p + Vec3d(1.0 / n, 0, 0), p + Vec3d(1.0 / n, 1.0 / n, 0)});
        add_face(mesh, {p, p + Vec3d(1.0 / n, 1.0 / n, 0), p + Vec3d(0, 1.0 / n, 0)});
      }
    }
    return mesh;
  };
  std::mt19937_64 random(sim::seed_from_environment() + 64);
  for (const int n : {4, 16, 32}) {
    const Object a(plate({0, 0, 0}, n));
    const Object b(plate({0x1p-7, 0x1p-7, 0.125}, n));
    for (const bool is_turned : {false, true}) {
      Pose pose = random_pose(PoseClass::rigid, 1, random);
      if (!is_turned) pose.linear().setIdentity();
      const DistanceResult d = distance(a, pose, b, pose);
      CAPTURE(n, is_turned, sim::seed_from_environment());
      if (!is_turned) {
        CHECK(d.lower == 0.125);
        CHECK(d.upper == 0.125);
      }
      CHECK(d.upper == Approx(0.125).epsilon(1e-14));
      CHECK(d.stats.pairs < 400);  // of the last plates about 10,000 pairs are as near
      CHECK(d.stats.steps < 2000);
      CHECK(d.stats.open < 10);
    }
  }
}
