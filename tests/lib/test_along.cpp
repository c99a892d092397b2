// SPDX-License-Identifier: Apache-2.0
// Moves along a direction: pairs of faces and meshes against brute force in fractions.
#include <catch2/catch.hpp>
#include <cchip/along.hpp>
#include <cchip/shapes.hpp>
#include <cmath>
#include <iostream>
#include <limits>

#include "along_oracle.hpp"
#include "bvh_meshes.hpp"
#include "exact/hulls.hpp"
#include "exact/scaled_points.hpp"
#include "random_pairs.hpp"
#include "random_poses.hpp"

using namespace cchip;
using namespace cchip_test;
using namespace cchip::testing;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const Pose here = Pose::Identity();

Pose shifted(double x, double y, double z) {
  Pose pose = here;
  pose.translation() = Vec3d(x, y, z);
  return pose;
}

Object object_of(const Primitive& p) {
  Mesh mesh;
  add_face(mesh, {p.v.begin(), p.v.begin() + static_cast<std::ptrdiff_t>(p.vertex_count())});
  return Object(mesh);
}

/// The doubles of an answer are those of this number.
bool is_rounded(const AlongResult& result, const Factor& s) {
  constexpr double most = std::numeric_limits<double>::max();
  if (result.upper == infinity) {
    return result.lower == most && compare(factor_of(most), s) < 0 &&
           (result.factor == most || result.factor == infinity);
  }
  if (result.lower == result.upper) return result.factor == result.lower && compare(factor_of(result.lower), s) == 0;
  if (std::nextafter(result.lower, infinity) != result.upper) return false;
  if (compare(factor_of(result.lower), s) >= 0 || compare(factor_of(result.upper), s) <= 0) return false;
  const Factor low = factor_of(result.lower);
  const Factor high = factor_of(result.upper);
  const int exponent = std::min(low.exponent, high.exponent);
  const Factor middle = {(low.over << (low.exponent - exponent)) + (high.over << (high.exponent - exponent)), 1,
                         exponent - 1};
  const int side = compare(s, middle);
  return side == 0 ? result.factor == result.lower || result.factor == result.upper
                   : result.factor == (side < 0 ? result.lower : result.upper);
}

bool same_doubles(const AlongResult& x, const AlongResult& y) {
  return x.touches == y.touches && x.factor == y.factor && x.lower == y.lower && x.upper == y.upper;
}

using Points = std::vector<IntPoint<BigInt>>;
using Meeting = std::optional<std::pair<Factor, Factor>>;

exact::Hull<exact::BigInt> hull_of(const Points& points) {
  std::array<exact::Vec<exact::BigInt>, 4> corners;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) corners[i][k] = exact::BigInt(points[i][k]);
  }
  return {corners, points.size()};
}

/// The oracle of pairs of faces, at one place of the way.
bool meet_at(const LineOracle& line, const Points& a, const Points& b, int unit_bits, const Factor& s) {
  const auto [own, other] = line.moved(a, b, unit_bits, s);
  return exact::hulls_meet(hull_of(own), hull_of(other));
}

/// A little less or more, by a part of 2^-400 of it.
Factor beside(const Factor& s, int sign) {
  if (s.over == 0) return {sign, 1, -5000};
  return {(s.over << 400) + abs(s.over) * sign, s.under, s.exponent - 400};
}

struct Count {
  int pairs = 0;
  int never = 0;    ///< the lines of the faces miss each other
  int now = 0;      ///< they meet as they are
  int leave = 0;    ///< of those, at 0 exactly
  int contact = 0;  ///< they meet only later
  int exactly = 0;  ///< factors that are doubles
  int moments = 0;  ///< they meet for one s only
};

void check_pair(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b, const Vec3d& direction,
                int unit_bits, bool prove, Count& count) {
  const LineOracle line(direction);
  const Points points_a = posed_points(a, pose_a, unit_bits);
  const Points points_b = posed_points(b, pose_b, unit_bits);
  const Meeting meeting = line.meeting(points_a, points_b, unit_bits);
  const Factor zero;
  const bool now = meeting && compare(meeting->first, zero) <= 0 && compare(meeting->second, zero) >= 0;
  const bool later = meeting && compare(meeting->first, zero) > 0;
  ++count.pairs;
  count.never += !meeting;
  count.now += now;
  count.leave += now && compare(meeting->second, zero) == 0;
  count.contact += later;
  count.moments += meeting && compare(meeting->first, meeting->second) == 0;
  bool good = meet_at(line, points_a, points_b, unit_bits, zero) == now;
  if (prove && meeting) {
    good = good && meet_at(line, points_a, points_b, unit_bits, meeting->first) &&
           meet_at(line, points_a, points_b, unit_bits, meeting->second) &&
           !meet_at(line, points_a, points_b, unit_bits, beside(meeting->first, -1)) &&
           !meet_at(line, points_a, points_b, unit_bits, beside(meeting->second, 1));
  }
  const Object object_a = object_of(a);
  const Object object_b = object_of(b);
  const AlongResult clear = clear_along(object_a, pose_a, object_b, pose_b, direction);
  const AlongResult first = first_contact(object_a, pose_a, object_b, pose_b, direction);
  count.exactly += (now && clear.factor != 0 && clear.lower == clear.upper) || (later && first.lower == first.upper);
  good = good && clear.touches == now && is_rounded(clear, now ? meeting->second : zero);
  good = good && first.touches == (now || later);
  if (first.touches) {
    good = good && is_rounded(first, now ? zero : meeting->first);
  } else {
    good = good && first.factor == infinity && first.lower == infinity && first.upper == infinity;
  }
  // What moves is a matter of words.
  const Vec3d against = -direction;
  good = good && same_doubles(clear, clear_along(object_b, pose_b, object_a, pose_a, against)) &&
         same_doubles(first, first_contact(object_b, pose_b, object_a, pose_a, against));
  if (good) return;
  std::ostringstream text;
  text.precision(17);
  for (const Primitive* p : {&a, &b}) {
    for (std::size_t i = 0; i < p->vertex_count(); ++i) text << p->v[i].transpose() << "; ";
  }
  text << '\n'
       << pose_a.affine() << '\n'
       << pose_b.affine() << "\ndirection " << direction.transpose() << " now " << now << " later " << later
       << " clear " << clear.touches << ' ' << clear.lower << ' ' << clear.factor << ' ' << clear.upper << " first "
       << first.touches << ' ' << first.lower << ' ' << first.upper << " seed " << seed();
  FAIL(text.str());
}

/// Any, along an axis or a diagonal, or along an edge.
Vec3d random_direction(const Primitive& a, const Pose& pose_a, std::mt19937_64& random) {
  Vec3d d = random_vector(random, 1);
  switch (random() % 4) {
    case 0:
      d = (2 * d).array().round();
      break;
    case 1:
      d = pose_a.linear() * (a.v[1] - a.v[0]);
      break;
    case 2:
      d = pose_a.linear() * (a.v[2] + a.v[1] - 2 * a.v[0]);
      break;
    default:
      break;
  }
  if (d.isZero(0) || !(d.cwiseAbs().maxCoeff() > 0x1p-1000)) d = Vec3d(0, 1, 0);
  return random() % 8 == 0 ? Vec3d(std::ldexp(1.0, static_cast<int>(random() % 1800) - 900) * d.normalized()) : d;
}

void check_grid_pairs(int rounds, Count& count) {
  std::mt19937_64 random(seed() + 70);
  for (const PairClass c : pair_classes) {
    for (const int range : {2, 40}) {
      PairSource source(-range, range, static_cast<std::uint64_t>(c) + 350 + static_cast<std::uint64_t>(range));
      for (int i = 0; i < rounds; ++i) {
        GridPair grid = source.pair(c, i % 3 == 0 ? Kind::quad : Kind::tri, i % 4 == 0 ? Kind::quad : Kind::tri);
        Vec3d direction;
        for (double& x : direction) x = static_cast<double>(random() % 5) - 2;
        if (direction.isZero(0)) direction = Vec3d(0, 0, 1);
        // Some start on the way to each other.
        const double by = i % 2 == 0 ? 0 : static_cast<double>(random() % 40);
        check_pair(scaled(grid.a, -4), here, scaled(grid.b, -4), Pose(Eigen::Translation3d(-by / 16 * direction)),
                   direction, 150, i % 8 == 0, count);
      }
    }
  }
}

void check_posed_pairs(int rounds, Count& count) {
  std::mt19937_64 random(seed() + 71);
  for (const PairClass c : pair_classes) {
    PairSource source(-40, 40, static_cast<std::uint64_t>(c) + 450);
    for (int i = 0; i < rounds; ++i) {
      const GridPair grid = source.pair(c, i % 3 == 0 ? Kind::quad : Kind::tri, i % 4 == 0 ? Kind::quad : Kind::tri);
      const int size = i % 7 == 0 ? std::array<int, 4>{-1060, -500, 340, 440}[random() % 4] : -4;
      const Primitive a = scaled(grid.a, size);
      const Primitive b = scaled(grid.b, size);
      const PoseClass pose_class = pose_classes[static_cast<std::size_t>(i / 2) % std::size(pose_classes)];
      Pose pose_a = random_pose(pose_class, i % 5 == 0 ? 0x1p30 : 2, random);
      Pose pose_b = i % 3 == 0 ? random_pose(pose_class, 2, random) : pose_a;
      if (i % 3 == 1) pose_b.translation() += Vec3d(1, 2, static_cast<double>(random() % 8));
      if (size != -4) {
        const double factor = std::ldexp(1.0, std::max(size, -500));
        pose_a.translation() *= factor;
        pose_b.translation() *= factor;
      }
      Vec3d direction = random_direction(a, pose_a, random);
      // Of some that lie far from each other, a vertex is aimed at a vertex.
      if (i % 5 == 1) direction = pose_a * a.v[0] - pose_b * b.v[0];
      if (direction.isZero(0) || !direction.allFinite()) direction = Vec3d(1, 0, 0);
      check_pair(a, pose_a, b, pose_b, direction, 2300, i % 8 == 0, count);
    }
  }
}

void print(const Count& count) {
  std::cout << "pairs=" << count.pairs << " never=" << count.never << " now=" << count.now << " leave=" << count.leave
            << " contact=" << count.contact << " exact=" << count.exactly << " moments=" << count.moments << '\n';
  CHECK(count.never > count.pairs / 20);
  CHECK(count.now > count.pairs / 20);
  CHECK(count.leave > count.pairs / 200);
  CHECK(count.contact > count.pairs / 50);
  CHECK(count.exactly > count.pairs / 50);
  CHECK(count.moments > count.pairs / 100);
}

}  // namespace

TEST_CASE("along: faces on a grid", "[lib][along]") {
  Count count;
  check_grid_pairs(600, count);
  print(count);
}

TEST_CASE("along: faces under poses", "[lib][along]") {
  Count count;
  check_posed_pairs(300, count);
  CHECK(count.never > count.pairs / 20);
  CHECK(count.now > count.pairs / 20);
  CHECK(count.contact > count.pairs / 50);
}

TEST_CASE("along: many faces", "[.long]") {
  Count count;
  check_grid_pairs(9000, count);
  print(count);
  check_posed_pairs(3000, count);
}

TEST_CASE("along: what the direction and the order change", "[lib][along]") {
  std::mt19937_64 random(seed() + 72);
  const Object a(soup(30, false, random));
  const Object b(soup(30, true, random));
  int touches = 0;
  for (int i = 0; i < 60; ++i) {
    const PoseClass c = pose_classes[random() % std::size(pose_classes)];
    const Pose pose_a = random_pose(c, 1, random);
    const Pose pose_b = random_pose(c, 2, random);
    const Vec3d d = random_vector(random, 1);
    for (const auto& query : {clear_along, first_contact}) {
      const AlongResult result = query(a, pose_a, b, pose_b, d);
      touches += result.touches && result.factor > 0;
      for (const int power : {1, -1, 40, -40}) {
        AlongResult other = query(a, pose_a, b, pose_b, Vec3d(std::ldexp(1.0, power) * d));
        for (double* x : {&other.factor, &other.lower, &other.upper}) *x = std::ldexp(*x, power);
        CHECK(same_doubles(other, result));
      }
      CHECK(same_doubles(query(b, pose_b, a, pose_a, Vec3d(-d)), result));
      // Axes change places, one turns round; all grows.
      Pose map = here;
      map.linear() << 0, 0, -1, 1, 0, 0, 0, 1, 0;
      CHECK(same_doubles(query(a, map * pose_a, b, map * pose_b, map.linear() * d), result));
      map.linear() *= 0x1p60;
      CHECK(same_doubles(query(a, map * pose_a, b, map * pose_b, map.linear() * d), result));
    }
  }
  CHECK(touches > 20);
}

namespace {

struct FacesMeet {
  std::uint32_t a;
  std::uint32_t b;
  Factor first;
  Factor last;
};

/// All pairs of faces against all, then along the line from 0.
void check_meshes(const Mesh& mesh_a, const Pose& pose_a, const Mesh& mesh_b, const Pose& pose_b, const Vec3d& d,
                  int& touching, int& far) {
  const LineOracle line(d);
  constexpr int unit_bits = 400;
  const auto all_points = [](const Mesh& mesh, const Pose& pose) {
    std::vector<Points> points;
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
      points.push_back(posed_points(mesh.primitive(i), pose, unit_bits));
    }
    return points;
  };
  const auto points_a = all_points(mesh_a, pose_a);
  const auto points_b = all_points(mesh_b, pose_b);
  std::vector<FacesMeet> meet;
  for (std::uint32_t i = 0; i < points_a.size(); ++i) {
    for (std::uint32_t k = 0; k < points_b.size(); ++k) {
      const Meeting meeting = line.meeting(points_a[i], points_b[k], unit_bits);
      if (meeting) meet.push_back({i, k, meeting->first, meeting->second});
    }
  }
  std::sort(meet.begin(), meet.end(),
            [](const FacesMeet& x, const FacesMeet& y) { return compare(x.first, y.first) < 0; });
  const Factor zero;
  std::optional<Factor> front;
  std::optional<Factor> contact;
  for (const FacesMeet& faces : meet) {
    if (compare(faces.last, zero) < 0) continue;
    const Factor& first = compare(faces.first, zero) < 0 ? zero : faces.first;
    if (!contact || compare(first, *contact) < 0) contact = first;
    if (compare(first, front ? *front : zero) > 0) continue;
    if (!front || compare(faces.last, *front) > 0) front = faces.last;
  }
  touching += front.has_value();
  far += !front && contact;

  const Object a(mesh_a), b(mesh_b);
  const AlongResult clear = clear_along(a, pose_a, b, pose_b, d);
  const AlongResult first = first_contact(a, pose_a, b, pose_b, d);
  INFO("seed " << seed() << " direction " << d.transpose() << '\n' << pose_a.affine() << '\n' << pose_b.affine());
  REQUIRE(clear.touches == front.has_value());
  CHECK(is_rounded(clear, front ? *front : zero));
  REQUIRE(first.touches == contact.has_value());
  if (contact) CHECK(is_rounded(first, *contact));
  // The faces decide.
  const auto found = [&](const AlongResult& result) {
    return std::find_if(meet.begin(), meet.end(),
                        [&](const FacesMeet& x) { return x.a == result.face_a && x.b == result.face_b; });
  };
  if (front) {
    REQUIRE(found(clear) != meet.end());
    CHECK(compare(found(clear)->last, *front) == 0);
  }
  if (contact) {
    REQUIRE(found(first) != meet.end());
    CHECK(compare(found(first)->first, *contact) <= 0);
    CHECK(compare(found(first)->last, *contact) >= 0);
  }
}

std::vector<Mesh> small_meshes(std::mt19937_64& random) {
  Mesh plate;  // on a grid
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) {
      const Vec3d p = Vec3d(i, k, 0) * 0.25;
      add_face(plate, {p, p + Vec3d(0.25, 0, 0), p + Vec3d(0.25, 0.25, 0), p + Vec3d(0, 0.25, 0)});
    }
  }
  return {make_torus(1, 0.4, 8, 5),
          noisy(make_torus(1, 0.4, 6, 4, Kind::quad), 0.05, random),
          make_gear(0.8, 1.2, 0.3, 0.5, 3, 1),
          soup(20, false, random),
          soup(20, true, random),
          plate,
          make_box({0, 0, 0}, {1, 1, 1})};
}

}  // namespace

TEST_CASE("along: meshes against all pairs of faces", "[lib][along]") {
  std::mt19937_64 random(seed() + 73);
  int touching = 0;
  int far = 0;
  int queries = 0;
  for (int round = 0; round < 2; ++round) {
    const std::vector<Mesh> meshes = small_meshes(random);
    for (const Mesh& a : meshes) {
      for (const Mesh& b : meshes) {
        const PoseClass c = std::array<PoseClass, 4>{PoseClass::rigid, PoseClass::quarter_turns, PoseClass::shear,
                                                     PoseClass::integers}[random() % 4];
        Pose pose_a = random_pose(c, 1, random);
        Pose pose_b = random_pose(c, 1.5, random);
        Vec3d d = random_vector(random, 1);
        if (c != PoseClass::rigid) {  // so that faces lie in one plane and slide
          for (Pose* pose : {&pose_a, &pose_b}) pose->translation() = (4 * pose->translation()).array().round() / 4;
          d = (2 * d).array().round();
        }
        if (d.isZero(0)) d = Vec3d(0, 0, -1);
        check_meshes(a, pose_a, b, pose_b, d, touching, far);
        ++queries;
      }
    }
  }
  std::cout << "queries=" << queries << " touching=" << touching << " far=" << far << '\n';
  CHECK(touching > queries / 5);
  CHECK(far > queries / 20);
}

TEST_CASE("along: boxes", "[lib][along]") {
  const Object box(make_box({0, 0, 0}, {1, 1, 1}));
  const auto clear = [&](const Pose& place, const Vec3d& d) { return clear_along(box, here, box, place, d); };
  const auto first = [&](const Pose& place, const Vec3d& d) { return first_contact(box, here, box, place, d); };
  // Overlapping: out along +x, along -x and along a diagonal, whatever its length.
  CHECK(clear(shifted(0.5, 0, 0), {1, 0, 0}).factor == 0.5);
  CHECK(clear(shifted(0.5, 0, 0), {-1, 0, 0}).factor == 1.5);
  CHECK(clear(shifted(0.5, 0.25, 0), {1, 1, 1}).factor == 0.5);
  CHECK(clear(shifted(0.5, 0.25, 0), {0x1p-700, 0x1p-700, 0x1p-700}).factor == 0x1p699);
  // A third of a vector is no double.
  const AlongResult third = clear(shifted(0.5, 0, 0), {1.5, 0, 0});
  CHECK(third.factor == 1.0 / 3);
  CHECK(third.lower == 1.0 / 3);
  CHECK(third.upper == std::nextafter(1.0 / 3, 1));
  // Flush: it leaves at once, or slides until the faces end.
  CHECK(clear(shifted(1, 0, 0), {1, 0, 0}).factor == 0);
  CHECK(clear(shifted(1, 0, 0), {1, 0, 0}).touches);
  CHECK(clear(shifted(1, 0, 0), {0x1p-1074, 1, 0}).factor == 0);
  CHECK(clear(shifted(1, 0, 0), {0, 1, 0}).factor == 1);
  CHECK(clear(shifted(1, 0.25, 0), {0, 1, 0}).factor == 0.75);
  CHECK(clear(shifted(1, 0, 0), {-0x1p-30, 1, 0}).factor == 1);
  CHECK(clear(shifted(1, 1, 1), {1, 1, 1}).factor == 0);
  CHECK(clear(shifted(1, 1, 1), {-1, -1, -1}).factor == 2);
  // Apart now.
  CHECK(clear(shifted(2, 0, 0), {-1, 0, 0}).factor == 0);
  CHECK_FALSE(clear(shifted(2, 0, 0), {-1, 0, 0}).touches);
  CHECK(first(shifted(2, 0, 0), {-1, 0, 0}).factor == 1);
  CHECK(first(shifted(2, 0, 0), {-3, 0, 0}).lower < first(shifted(2, 0, 0), {-3, 0, 0}).upper);
  CHECK(first(shifted(2, 1, 0), {-1, 0, 0}).factor == 1);  // edges graze
  CHECK_FALSE(first(shifted(2, std::nextafter(1, 2), 0), {-1, 0, 0}).touches);
  CHECK(first(shifted(2, std::nextafter(1, 2), 0), {-1, 0, 0}).factor == infinity);
  CHECK_FALSE(first(shifted(2, 0, 0), {1, 0, 0}).touches);
  CHECK(first(shifted(0.5, 0, 0), {1, 0, 0}).factor == 0);
  // Far beyond the doubles.
  const AlongResult beyond = first(shifted(0x1p400, 0, 0), {-0x1p-900, 0, 0});
  CHECK(beyond.touches);
  CHECK(beyond.lower == std::numeric_limits<double>::max());
  CHECK(beyond.upper == infinity);

  // Surfaces: a small one inside touches nothing, then the wall, from inside to outside.
  const Object small(make_box({0, 0, 0}, {0.25, 0.25, 0.25}));
  CHECK_FALSE(clear_along(box, here, small, shifted(0.5, 0.5, 0.5), {1, 0, 0}).touches);
  CHECK(first_contact(box, here, small, shifted(0.5, 0.5, 0.5), {1, 0, 0}).factor == 0.25);
  CHECK(clear_along(box, here, small, shifted(0.75, 0.5, 0.5), {1, 0, 0}).factor == 0.25);
  CHECK(clear_along(box, here, small, shifted(0, 0.5, 0.5), {1, 0, 0}).factor == 0);  // it touches the wall from inside
}

TEST_CASE("along: balls of a thousand faces", "[lib][along]") {
  // Balls of radius 1 whose vertices are multiples of 2^-10, moved by such: the way is made of exact places.
  Mesh mesh = make_sphere(1, 8);
  for (Vec3d& v : mesh.vertices) v = (1024 * v).array().round() / 1024;
  const Object ball(mesh);
  for (const Vec3d& d : {Vec3d(1, 0, 0), Vec3d(1, 0.5, -0.25), Vec3d(0, -1, 1)}) {
    const Pose place = shifted(0.5, 0.25, -0.125);
    const auto hit_at = [&](double s) {
      Pose moved = place;
      moved.translation() += s * d;
      return collide(ball, here, ball, moved).hit;
    };
    const AlongResult clear = clear_along(ball, here, ball, place, d);
    CHECK(clear.touches);
    CHECK(clear.factor > 0.5);
    for (int i = 0; i <= 64; ++i) CHECK(hit_at(std::floor(clear.lower * 1024) / 1024 * i / 64));
    const double after = std::ldexp(std::floor(std::ldexp(clear.upper, 30)) + 1, -30);
    CHECK_FALSE(hit_at(after));
    Pose outside = place;
    outside.translation() += 4 * d;
    const AlongResult back = first_contact(ball, here, ball, outside, -d);
    CHECK(back.touches);
    CHECK(back.factor <= 4 - clear.lower);  // the way out and the way in are the same line
    CHECK(back.factor >= 4 - after);
  }
}

TEST_CASE("along: the faces that meet first are named, each of its own object", "[lib][along]") {
  Mesh one;
  add_face(one, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  Mesh three;
  for (const double z : {9.0, 5.0, 2.0}) add_face(three, {{0.25, 0.25, z}, {3, 3, z + 1}, {3, 4, z + 1}});
  const AlongResult down = first_contact(Object(one), here, Object(three), here, {0, 0, -1});
  CHECK(down.factor == 2);
  CHECK(down.face_a == 0);
  CHECK(down.face_b == 2);
  const AlongResult up = first_contact(Object(three), here, Object(one), here, {0, 0, 1});
  CHECK(up.factor == 2);
  CHECK(up.face_a == 2);
  CHECK(up.face_b == 0);
}

TEST_CASE("along: objects that touch now name the faces that touch", "[lib][along]") {
  Mesh one;
  add_face(one, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  Mesh three;
  for (const double z : {9.0, 5.0, 0.0}) add_face(three, {{0.25, 0.25, z}, {3, 3, z + 1}, {3, 4, z + 1}});
  for (const auto& query : {clear_along, first_contact}) {
    const AlongResult up = query(Object(one), here, Object(three), here, {0, 0, 1});
    CHECK(up.touches);
    CHECK(up.factor == 0);
    CHECK(up.face_a == 0);
    CHECK(up.face_b == 2);
  }
}

TEST_CASE("along: faces that are certain never to meet are not decided exactly", "[lib][along]") {
  // In two parallel planes, moved along them: their volumes are too thick to tell. In the plane's own coordinates one
  // begins at 0, the other a step above.
  const auto oblique = [](double step) {
    Mesh mesh;
    const Vec3d p = step * Vec3d(0.25, 0.25, 0.25);
    add_face(mesh, {p, p + Vec3d(5, -1, -1), p + Vec3d(-1, 5, -3)});
    return mesh;
  };
  const Object a(oblique(0)), b(oblique(1));
  const Pose place = shifted(10, -2, -2);
  const AlongResult result = first_contact(a, here, b, place, {-5, 1, 1});
  CHECK_FALSE(result.touches);
  CHECK(result.stats.pairs == 1);
  CHECK(result.stats.open == 0);
  // In one plane they meet, which takes exact numbers.
  const AlongResult meets = first_contact(a, here, a, place, {-5, 1, 1});
  CHECK(meets.touches);
  CHECK(meets.stats.pairs == 1);
  CHECK(meets.stats.open == 1);
}

TEST_CASE("along: the search counts its own work beside that of the first look", "[lib][along]") {
  Mesh mesh = make_sphere(1, 4);
  const Object ball(mesh);
  const Pose place = shifted(3, 0.25, 0.125);
  const CollisionStats now = collide(ball, here, ball, place).stats;
  const CollisionStats all = first_contact(ball, here, ball, place, {-1, 0, 0}).stats;
  CHECK(all.steps > now.steps);
  CHECK(all.box_tests >= now.box_tests + (all.steps - now.steps));  // at least one for each node
  CHECK(all.pairs > now.pairs);
  CHECK(all.open > now.open);
}

TEST_CASE("along: many faces that meet at one moment that is no double", "[lib][along]") {
  // Steps of 2^-5 and 2^9, so that neither numerators nor denominators are in whole units.
  for (const double unit : {0x1p-5, 1.0, 0x1p9}) {
    const Object box(make_box({0, 0, 0}, unit * Vec3d(1, 1, 1)));
    const Vec3d d = Vec3d(-3, 0, 0) * unit;
    for (const double y : {0.0, 0.25, 1.0}) {
      const AlongResult first = first_contact(box, here, box, shifted(2 * unit, y * unit, 0), d);
      CHECK(first.touches);
      CHECK(first.factor == 1.0 / 3);
      CHECK(first.lower == 1.0 / 3);
      CHECK(first.upper == std::nextafter(1.0 / 3, 1));
      const AlongResult clear = clear_along(box, here, box, shifted(0, y * unit, 0), -d);
      CHECK(clear.touches);
      CHECK(clear.factor == 1.0 / 3);
      CHECK(clear.upper == std::nextafter(1.0 / 3, 1));
    }
  }
}

TEST_CASE("along: moments below the least double above 0", "[lib][along]") {
  // A cube of 2^-1100 in the world, moved by its length: between 0 and the least double.
  const Object box(make_box({0, 0, 0}, 0x1p-600 * Vec3d(1, 1, 1)));
  Pose tiny = here;
  tiny.linear() *= 0x1p-500;
  constexpr double least = std::numeric_limits<double>::denorm_min();
  const AlongResult clear = clear_along(box, tiny, box, tiny, {1, 0, 0});
  CHECK(clear.touches);
  CHECK(clear.factor == 0);
  CHECK(clear.lower == 0);
  CHECK(clear.upper == least);
  // The least double away, it reaches the other one that much less its length later.
  Pose away = tiny;
  away.translation().x() = least;
  const AlongResult first = first_contact(box, tiny, box, away, {-1, 0, 0});
  CHECK(first.touches);
  CHECK(first.factor == least);
  CHECK(first.lower == 0);
  CHECK(first.upper == least);
}

TEST_CASE("along: objects whose coordinates in the world no double holds", "[lib][along]") {
  Pose huge = here;
  huge.linear() *= 0x1p500;
  const Object box(make_box({0, 0, 0}, 0x1p600 * Vec3d(1, 1, 1)));
  const Object away(make_box(0x1p600 * Vec3d(3, 0, 0), 0x1p600 * Vec3d(4, 1, 1)));
  const AlongResult first = first_contact(box, huge, away, huge, {-0x1p999, 0, 0});
  CHECK(first.touches);
  CHECK(first.factor == 0x1p102);
  CHECK_FALSE(first_contact(box, huge, away, huge, {0x1p999, 0, 0}).touches);
  CHECK(clear_along(box, huge, box, huge, {0, 0x1p999, 0}).factor == 0x1p101);
}

TEST_CASE("along: arguments that make no sense", "[lib][along]") {
  const Object box(make_box({0, 0, 0}, {1, 1, 1}));
  for (const auto& query : {clear_along, first_contact}) {
    CHECK_THROWS_AS(query(box, here, box, here, Vec3d(0, 0, 0)), std::invalid_argument);
    CHECK_THROWS_AS(query(box, here, box, here, Vec3d(0, infinity, 0)), std::invalid_argument);
    CHECK_THROWS_AS(query(box, here, box, here, Vec3d(0, 0, std::nan(""))), std::invalid_argument);
    Pose bad = here;
    bad(0, 0) = infinity;
    CHECK_THROWS_AS(query(box, here, box, bad, Vec3d(1, 0, 0)), std::invalid_argument);
    Object gone(box);
    const Object kept(std::move(gone));
    CHECK_THROWS_AS(query(gone, here, box, here, Vec3d(1, 0, 0)), std::invalid_argument);  // NOLINT
  }
}
