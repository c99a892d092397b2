// SPDX-License-Identifier: Apache-2.0
// The count of wrong answers in docs/cpp/distance.md: libraries that lie in one way each are found out, and so would be
// distance() by brute force in integers.
#include <catch2/catch.hpp>
#include <cchip/shapes.hpp>
#include <cmath>
#include <fstream>
#include <limits>

#include "distance_count.hpp"
#include "distance_python.hpp"

using namespace cchip;
using namespace cchip::testing;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Two squares of side 1 in the planes z = 0 and z = 0.125, one above the other: 1/8 apart, without any arithmetic.
Mesh square(double z) {
  Mesh mesh;
  mesh.vertices = {Vec3d(0, 0, z), Vec3d(1, 0, z), Vec3d(1, 1, z), Vec3d(0, 1, z)};
  mesh.faces = {{Kind::tri, {0, 1, 2, 0}}, {Kind::tri, {0, 2, 3, 0}}};
  return mesh;
}

struct Lie {
  double distance = 0.125;
  double height = 0.125;  ///< of the point of B
  double side = 0.5;      ///< x of both points
  double within = 0;      ///< added to the distance when it says yes or no
};
Lie lie;

void* make(const double*, std::size_t, const std::uint32_t*, std::size_t) { return &lie; }
void destroy(void*) {}
int no_hit(void*, const double*, void*, const double*) { return 0; }
double lying_distance(void*, const double*, void*, const double*, double, double* points) {
  const double said[] = {lie.side, 0.5, 0, lie.side, 0.5, lie.height};
  std::copy(std::begin(said), std::end(said), points);
  return lie.distance;
}
int lying_within(void*, const double*, void*, const double*, double d) { return 0.125 + lie.within <= d; }
constexpr CchipPeer liar = {"liar", make, destroy, no_hit, nullptr, lying_distance, lying_within, 1e-6};

DistanceCount count_of(const Lie& x) {
  lie = x;
  const PeerLibrary library(liar);
  const Mesh a = square(0);
  const Mesh b = square(0.125);
  return count_answers(library.mesh(a), library.mesh(b), library.distance_tolerance(), a, b, {PosePair(), PosePair()},
                       {{0.125, 0.125}, {0.125, 0.125}});
}

bool proved(double lower, double upper) {
  const Mesh a = square(0);
  const Mesh b = square(0.125);
  DistanceResult claim;
  claim.lower = lower;
  claim.upper = upper;
  claim.point_a = Vec3d(0.5, 0.5, 0);
  claim.point_b = Vec3d(0.5, 0.5, upper);
  const Pose here = Pose::Identity();
  return is_proved(a, here, b, here, claim);
}

}  // namespace

TEST_CASE("distance count: who tells the truth has no wrong answer", "[ref][distance_count]") {
  const DistanceCount count = count_of({});
  CHECK(count.answers == 2);
  CHECK(count.wrong == 0);
  CHECK(count.greatest_error == 0);
  CHECK(count.points == 2);
  CHECK(count.wrong_points == 0);
  CHECK(count.decisions == 4);
  CHECK(count.wrong_decisions == 0);
  CHECK(count.edges == 4);
  CHECK(count.wrong_edges == 0);
  CHECK(count.inexact == 0);
}

TEST_CASE("distance count: wrong distances are counted, either way", "[ref][distance_count]") {
  for (const double error : {2e-6, -2e-6, 1.0, -0.125}) {
    const DistanceCount count = count_of({0.125 + error, 0.125 + error});
    INFO(error);
    CHECK(count.wrong == 2);
    CHECK(std::abs(count.greatest_error - std::abs(error)) < 1e-15);
  }
  CHECK(count_of({infinity}).wrong == 2);
  CHECK(count_of({std::nan("")}).wrong == 2);
  CHECK(count_of({std::nan("")}).greatest_error == infinity);
  // within the tolerance: an error, but not a wrong answer
  CHECK(count_of({0.125 + 0x1p-21, 0.125 + 0x1p-21}).wrong == 0);
  CHECK(count_of({0.125 + 0x1p-21, 0.125 + 0x1p-21}).greatest_error == 0x1p-21);
  CHECK(count_of({0.125 + 0x1p-21, 0.125 + 0x1p-21}).inexact == 2);
}

TEST_CASE("distance count: wrong points are counted", "[ref][distance_count]") {
  CHECK(count_of({0.125, 0.25}).wrong_points == 2);        // not as far apart as said
  CHECK(count_of({0.25, 0.25}).wrong_points == 2);         // that far apart, but not on B
  CHECK(count_of({0.125, 0.125, 1.5}).wrong_points == 2);  // that far apart, but beside both
  CHECK(count_of({0.125, std::nan("")}).wrong_points == 2);
  CHECK(count_of({0.125, 0.125, 1 + 0x1p-21}).wrong_points == 0);
  CHECK(count_of({0.125, 0.25}).wrong == 0);
}

TEST_CASE("distance count: wrong decisions are counted", "[ref][distance_count]") {
  CHECK(count_of({0.125, 0.125, 0.5, 1}).wrong_decisions == 2);     // no to twice the distance
  CHECK(count_of({0.125, 0.125, 0.5, -0.1}).wrong_decisions == 2);  // yes to half of it
  for (const double error : {1e-9, -1e-9}) {                        // wrong at the distance alone
    const DistanceCount count = count_of({0.125, 0.125, 0.5, error});
    CHECK(count.wrong_decisions == 0);
    CHECK(count.wrong_edges == 2);
  }
}

TEST_CASE("distance count: lies through the pipe of Python's libraries are counted", "[ref][distance_count]") {
  const Mesh a = square(0);
  const Mesh b = square(0.125);
  const auto ask = [&](const std::string& line, int lines) {
    // It reads vertices and triangles of both meshes and the two queries: 6 lines of 12, 6, 12, 6, 26 and 26 words.
    std::ofstream script("distance_count_liar.py");
    script << "import sys\n"
              "words = [len(line.split()) for line in open(sys.argv[1])]\n"
              "assert words == [12, 6, 12, 6, 26, 26], words\n"
              "print('Liar', '1.0', (1e-6).hex())\n"
           << "for _ in range(" << lines << "): print('" << line << "')\n";
    script.close();
    const auto answers = ask_python(CCHIP_PYTHON, "distance_count_liar.py", "distance_count_queries.txt", a, b,
                                    {PosePair(), PosePair()}, {{0.125, 0.125}, {0.125, 0.125}});
    REQUIRE(answers.size() == 1);
    CHECK(answers[0].name == "Liar");
    CHECK(answers[0].times[3] == 4);
    return answers[0].count;
  };
  const DistanceCount honest = ask("0x1p-3  0x1p-1 0x1p-1 0  0x1p-1 0x1p-1 0x1p-3  0 1 0  1 2 3 4", 2);
  CHECK(honest.answers == 2);
  CHECK(honest.points == 2);
  CHECK(honest.decisions == 6);
  CHECK(honest.wrong + honest.wrong_points + honest.wrong_decisions == 0);
  const DistanceCount lies = ask("0x1p-2  0x1p-1 0x1p-1 0  0x1p-1 0x1p-1 0x1p-3  1 0 1  1 2 3 4", 2);
  CHECK(lies.wrong == 2);
  CHECK(lies.wrong_points == 2);
  CHECK(lies.wrong_decisions == 6);
  CHECK(ask("nan  0x1p-1 0x1p-1 0  nan nan nan  0 1 0  1 2 3 4", 2).wrong == 2);
  CHECK_THROWS_WITH(ask("0 0", 1), Catch::Contains("ended too early"));
  CHECK_THROWS_WITH(ask("yes", 1), Catch::Contains("is no number"));
}

TEST_CASE("distance count: objects that meet", "[ref][distance_count]") {
  DistanceCount count;
  CHECK_FALSE(count.add_distance(-1, {0, 0}, 1e-6));
  CHECK_FALSE(count.add_distance(0, {0, 0}, 1e-6));
  CHECK(count.add_distance(2e-6, {0, 0}, 1e-6));
  CHECK(count.add_distance(-1, {0.5, 0.5}, 1e-6));
  CHECK(count.wrong == 2);
  CHECK(count.greatest_error == 0.5);
}

TEST_CASE("distance count: brute force proves 1/8 and nothing beside it", "[ref][distance_count]") {
  CHECK(proved(0.125, 0.125));
  CHECK(proved(0.125 - 0x1p-56, 0.125 + 0x1p-55));
  CHECK_FALSE(proved(0.125 + 0x1p-55, 0.125 + 0x1p-55));
  CHECK_FALSE(proved(0.125 - 0x1p-56, 0.125 - 0x1p-56));
  CHECK_FALSE(proved(0, 0));
  CHECK_FALSE(proved(0.25, 0.25));
}

TEST_CASE("distance count: brute force of spheres of 1,280 faces under turned poses", "[ref][distance_count]") {
  const Object a(make_sphere(1, 8));
  const Object b(make_sphere(0.5, 8));
  REQUIRE(a.mesh().faces.size() == 1280);
  const Pose pose_a = make_pose({1, -2, 3}, {10, 20, 30});
  for (const Vec3d& away : {Vec3d(1.6, 0.2, 0.1), Vec3d(-0.3, 0, 2.5), Vec3d(0.7, 0.7, 0.7)}) {
    const Pose pose_b = make_pose(Vec3d(1, -2, 3) + away, {-40, 50, 60});
    DistanceResult claim = distance(a, pose_a, b, pose_b);
    CAPTURE(away.transpose(), claim.lower, claim.upper);
    CHECK(is_proved(a.mesh(), pose_a, b.mesh(), pose_b, claim));
    DistanceResult beside = claim;
    beside.lower = beside.upper = std::nextafter(claim.upper, infinity);
    CHECK_FALSE(is_proved(a.mesh(), pose_a, b.mesh(), pose_b, beside));
    if (claim.upper == 0) continue;
    beside.lower = beside.upper = std::nextafter(claim.lower, 0.0);
    CHECK_FALSE(is_proved(a.mesh(), pose_a, b.mesh(), pose_b, beside));
  }
}
