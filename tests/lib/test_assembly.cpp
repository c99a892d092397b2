// SPDX-License-Identifier: Apache-2.0
// Assemblies of boxes whose places say what the verdicts must be.
#include <array>
#include <catch2/catch.hpp>
#include <cchip/assembly.hpp>
#include <cchip/html_page.hpp>
#include <cchip/program/seed.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <string>
#include <utility>

#include "bvh_meshes.hpp"
#include "random_poses.hpp"

using namespace cchip;
using cchip::testing::make_box;
namespace fs = std::filesystem;

namespace cchip {
std::ostream& operator<<(std::ostream& out, PairVerdict verdict) { return out << name_of(verdict); }
}  // namespace cchip

namespace {

using RuleKind = AssemblyRule::Kind;

Object box(const Vec3d& low, const Vec3d& high) { return Object(make_box(low, high)); }
Pose shifted(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }

/// A unit cube without its roof.
Object open_box() {
  Mesh mesh = make_box({0, 0, 0}, {1, 1, 1});
  mesh.faces.erase(mesh.faces.begin() + 1);
  return Object(mesh);
}

/// Parts a and b.
Assembly two(const Object& a, const Object& b, const Pose& pose_b = Pose::Identity()) {
  Assembly assembly;
  assembly.parts = {{"a", a}, {"b", b, pose_b}};
  return assembly;
}

AssemblyRule rule(RuleKind kind, double limit = 0) {
  AssemblyRule made;
  made.kind = kind;
  made.limit = limit;
  made.parts = {"a", "b"};
  if (kind == RuleKind::anything) made.reason = "pressed in";
  return made;
}

bool is_violation(Assembly assembly, const AssemblyRule& with) {
  assembly.rules = {with};
  return check(assembly).violations == 1;
}

AssemblyPair only_pair(const Assembly& assembly) {
  const AssemblyReport report = check(assembly);
  REQUIRE(report.pairs.size() == 1);
  return report.pairs[0];
}

const Object cube = box({0, 0, 0}, {1, 1, 1});

class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("cchip_assembly_" + std::to_string(std::random_device()()))) {
    fs::create_directories(path_);
    write("box.off", cube_text);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return (path_ / name).string();
  }
  std::string path() const { return path_.string(); }
  /// What is wrong with an assembly file, without the folder.
  std::string error(const std::string& text, const std::string& name = "x.toml") const {
    return error_of(write(name, text));
  }
  std::string error_of(const std::string& file) const {
    try {
      load_assembly(file);
    } catch (const std::runtime_error& error) {
      std::string what = error.what();
      for (std::size_t at = what.find(path() + "/"); at != std::string::npos; at = what.find(path() + "/")) {
        what.erase(at, path().size() + 1);
      }
      return what;
    }
    return "";
  }

 private:
  static constexpr const char* cube_text =
      "OFF\n8 6 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n"
      "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
  fs::path path_;
};

const std::string part = "[[part]]\nfile = \"box.off\"\n";

}  // namespace

TEST_CASE("assembly: verdicts of closed parts", "[assembly]") {
  CHECK(check(two(cube, cube, shifted(3, 0, 0))).pairs.empty());
  CHECK(only_pair(two(cube, cube, shifted(1, 0, 0))).verdict == PairVerdict::touching);
  CHECK(only_pair(two(cube, cube, shifted(0.5, 0, 0))).verdict == PairVerdict::overlap);
  CHECK(only_pair(two(cube, cube)).verdict == PairVerdict::duplicate);
  CHECK(only_pair(two(cube, box({0, 0, 0}, {1, 1, 1}))).verdict == PairVerdict::duplicate);
  const Object large = box({-1, -1, -1}, {2, 2, 2});
  CHECK(only_pair(two(cube, large)).verdict == PairVerdict::a_in_b);
  CHECK(only_pair(two(large, cube)).verdict == PairVerdict::b_in_a);
  CHECK(only_pair(two(large, cube, shifted(1, 1, 1))).verdict == PairVerdict::b_in_a);  // flush in its corner
}

TEST_CASE("assembly: mirrored placements are solids", "[assembly]") {
  Pose mirrored = shifted(0.25, 0, 0);
  mirrored.linear()(0, 0) = -1;  // x from -0.75 to 0.25
  const AssemblyPair pair = only_pair(two(cube, cube, mirrored));
  CHECK(pair.verdict == PairVerdict::overlap);
  REQUIRE(pair.way);
  CHECK(pair.way->depth == Approx(0.25).epsilon(1e-12));
}

TEST_CASE("assembly: an overlap has a depth and the way that parts it", "[assembly]") {
  // By 0.125 along x, by more along y and z.
  const AssemblyPair pair = only_pair(two(cube, cube, shifted(0.875, 0.25, -0.25)));
  REQUIRE(pair.way);
  CHECK(pair.way->depth == Approx(0.125).epsilon(1e-12));
  CHECK(pair.way->direction.isApprox(Vec3d(1, 0, 0)));
  CHECK(pair.way->depth >= 0.125);
}

TEST_CASE("assembly: a way into the other part is none", "[assembly]") {
  // 0.01 of a small cube looks out of a large one: 0.01 inwards the surfaces are clear, but it is inside.
  const Object large = box({-10, -10, -10}, {10, 10, 10});
  const Pose out = shifted(9.01, 0, 0);
  CHECK(only_pair(two(large, cube, out)).way->depth == Approx(0.99).epsilon(1e-12));
  CHECK(is_violation(two(large, cube, out), rule(RuleKind::overlap, 0.1)));
  CHECK_FALSE(is_violation(two(large, cube, out), rule(RuleKind::overlap, 1)));
}

TEST_CASE("assembly: each rule accepts what it says", "[assembly]") {
  const Assembly apart = two(cube, cube, shifted(1.5, 0, 0));
  const Assembly touching = two(cube, cube, shifted(1, 0, 0));
  const Assembly overlap = two(cube, cube, shifted(0.75, 0, 0));
  const Assembly same = two(cube, cube);
  const Assembly inside = two(cube, box({-1, -1, -1}, {2, 2, 2}));
  const Assembly around = two(box({-1, -1, -1}, {2, 2, 2}), cube);
  const auto row = [&](const AssemblyRule& with) {
    std::string marks;
    for (const Assembly* one : {&apart, &touching, &overlap, &same, &inside, &around}) {
      marks += is_violation(*one, with) ? '!' : '.';
    }
    return marks;
  };
  CHECK(row(rule(RuleKind::nothing)) == ".!!!!!");
  CHECK(row(rule(RuleKind::touching)) == "..!!!!");
  CHECK(row(rule(RuleKind::overlap, 0.2)) == "..!!!!");
  CHECK(row(rule(RuleKind::overlap, 0.3)) == "...!!!");
  CHECK(row(rule(RuleKind::anything)) == "......");
  CHECK(row(rule(RuleKind::clearance, 0.5)) == ".!!!!!");
  CHECK(row(rule(RuleKind::clearance, 0.6)) == "!!!!!!");
  CHECK(row(rule(RuleKind::inside)) == "!!!!.!");
  CHECK(row(rule(RuleKind::same)) == "!!!.!!");
  AssemblyRule turned = rule(RuleKind::inside);
  turned.parts = {"b", "a"};
  CHECK(row(turned) == "!!!!!.");
}

TEST_CASE("assembly: clearance is exact and names the nearest points", "[assembly]") {
  Assembly assembly = two(cube, cube, shifted(1.5, 0, 0));
  assembly.clearance = 0.5;
  CHECK(check(assembly).violations == 0);
  assembly.clearance = std::nextafter(0.5, 1);
  const AssemblyPair pair = only_pair(assembly);
  CHECK(pair.verdict == PairVerdict::too_near);
  CHECK(pair.is_violation);
  CHECK(pair.distance_lower == 0.5);
  CHECK(pair.distance_upper == 0.5);
  CHECK(pair.nearest[0].x() == 1);
  CHECK(pair.nearest[1].x() == 1.5);
  assembly.rules = {rule(RuleKind::touching)};
  CHECK(check(assembly).violations == 0);
}

TEST_CASE("assembly: the most special rule counts, then the last", "[assembly]") {
  Assembly assembly = two(cube, cube, shifted(1, 0, 0));
  assembly.parts[0].groups = {"g"};
  assembly.parts[1].groups = {"h"};
  AssemblyRule all = rule(RuleKind::touching);
  all.parts.clear();
  AssemblyRule groups = rule(RuleKind::nothing);
  groups.parts.clear();
  groups.groups = {"h", "g"};  // in any order
  const AssemblyRule names = rule(RuleKind::touching);
  const auto counting = [&assembly](std::vector<AssemblyRule> rules) {
    assembly.rules = std::move(rules);
    return only_pair(assembly).rule;
  };
  CHECK_FALSE(counting({}));
  CHECK(counting({all}) == 0U);
  CHECK(counting({groups, all}) == 0U);
  CHECK(counting({names, groups, all}) == 0U);
  CHECK(counting({all, groups, names}) == 2U);
  CHECK(counting({names, names}) == 1U);
  CHECK(counting({groups, groups}) == 1U);
  CHECK(counting({all, all}) == 1U);
  assembly.rules = {names, groups, all};
  CHECK(check(assembly).unused_rules == std::vector<std::size_t>{1, 2});
  AssemblyRule stale = names;
  stale.parts[1] = "nobody";
  assembly.rules = {names, stale};
  CHECK(check(assembly).unused_rules == std::vector<std::size_t>{1});
  CHECK(why_unused(assembly, 1).find("no part is named 'nobody'") != std::string::npos);
}

TEST_CASE("assembly: open meshes are surfaces", "[assembly]") {
  const AssemblyReport through = check(two(open_box(), cube, shifted(0.5, 0.25, 0.25)));
  REQUIRE(through.pairs.size() == 1);
  CHECK(through.pairs[0].verdict == PairVerdict::overlap);
  CHECK(through.pairs[0].note.find("a is judged as a surface") == 0);
  REQUIRE(through.notes.size() == 1);
  CHECK(through.notes[0].find("a is an open mesh") == 0);
  const Object large = box({-1, -1, -1}, {2, 2, 2});
  CHECK(only_pair(two(open_box(), large)).verdict == PairVerdict::a_in_b);
  CHECK(only_pair(two(large, open_box())).verdict == PairVerdict::b_in_a);
  CHECK(only_pair(two(open_box(), open_box())).verdict == PairVerdict::duplicate);
  // In an open mesh nothing is inside.
  CHECK(check(two(open_box(), box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}))).pairs.empty());
  // It touches, and whether it runs on inside is not known: with a rule that allows touching it is not judged.
  Assembly touching = two(open_box(), cube, shifted(1, 0, 0));
  touching.rules = {rule(RuleKind::touching)};
  const AssemblyReport report = check(touching);
  CHECK(report.violations == 0);
  CHECK(report.not_judged == 1);
}

namespace {

/// An L with its notch at (5, 5), 10 high.
Mesh bracket() {
  constexpr std::array<std::array<double, 2>, 6> outline = {{{0, 0}, {10, 0}, {10, 5}, {5, 5}, {5, 10}, {0, 10}}};
  Mesh mesh;
  for (const double z : {0.0, 10.0}) {
    for (const auto& p : outline) mesh.vertices.emplace_back(p[0], p[1], z);
  }
  for (std::uint32_t i = 0; i < 6; ++i) mesh.faces.push_back({Kind::quad, {i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6}});
  mesh.faces.push_back({Kind::quad, {0, 3, 2, 1}});
  mesh.faces.push_back({Kind::quad, {0, 5, 4, 3}});
  mesh.faces.push_back({Kind::quad, {6, 7, 8, 9}});
  mesh.faces.push_back({Kind::quad, {6, 9, 10, 11}});
  return mesh;
}

}  // namespace

TEST_CASE("assembly: a part in a corner leaves all faces at once", "[assembly]") {
  const Object corner(bracket());
  REQUIRE(corner.is_closed());
  std::mt19937_64 random(sim::seed_from_environment());
  for (const bool turned : {false, true}) {
    const Pose all = turned ? cchip_test::random_pose(cchip_test::PoseClass::rigid, 3, random) : Pose::Identity();
    for (const double depth : {0.0, 1e-12, 1e-5}) {
      for (const double depth_y : {0.0, 1e-12, 1e-5}) {
        Assembly assembly = two(corner, Object(make_box({0, 0, 0}, {2, 2, 2})), shifted(5 - depth, 5 - depth_y, 4));
        for (AssemblyPart& part : assembly.parts) part.pose = all * part.pose;
        CAPTURE(turned, depth, depth_y);
        CHECK_FALSE(is_violation(assembly, rule(RuleKind::overlap, 1e-4)));
        if (depth == 1e-5) CHECK(is_violation(assembly, rule(RuleKind::overlap, 1e-6)));
      }
    }
  }
}

TEST_CASE("assembly: shells that overlap hide nothing", "[assembly]") {
  Mesh doubled = make_box({0, 0, 0}, {1, 1, 1});
  const Mesh once = doubled;
  for (Mesh::Face face : once.faces) {
    for (std::uint32_t& v : face.vertex) v += 8;
    doubled.faces.push_back(face);
  }
  doubled.vertices.insert(doubled.vertices.end(), once.vertices.begin(), once.vertices.end());
  // By the rule odd a cube that is there twice holds nothing.
  const AssemblyPair pair = only_pair(two(Object(doubled), box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75})));
  CHECK(pair.verdict == PairVerdict::b_in_a);
  CHECK(pair.note.find("shells of a overlap") == 0);
}

TEST_CASE("assembly: flush parts in odd poses pass, parts 0.01 too deep do not", "[assembly]") {
  const std::uint64_t seed = sim::seed_from_environment();
  std::mt19937_64 random(seed);
  const Mesh a = make_box({0, 0, 0}, {80, 20, 10});
  for (const double depth : {0.0, 0.01}) {
    const Mesh b = make_box({10, 20 - depth, 2}, {60, 45, 9});
    for (int i = 0; i < 40; ++i) {
      Pose pose = cchip_test::random_pose(cchip_test::PoseClass::rigid, i % 2 == 0 ? 0 : 1000, random);
      Mesh placed_a = transformed(a, pose);
      Mesh placed_b = transformed(b, pose);
      for (Mesh* mesh : {&placed_a, &placed_b}) {
        if (i % 4 < 2) continue;
        for (Vec3d& v : mesh->vertices) v = v.cast<float>().cast<double>();
      }
      // Single precision warps quads, so triangles.
      for (Mesh* mesh : {&placed_a, &placed_b}) {
        std::vector<Mesh::Face> triangles;
        for (const Mesh::Face& face : mesh->faces) {
          triangles.push_back({Kind::tri, {face.vertex[0], face.vertex[1], face.vertex[2], 0}});
          triangles.push_back({Kind::tri, {face.vertex[0], face.vertex[2], face.vertex[3], 0}});
        }
        mesh->faces = triangles;
      }
      INFO("seed " << seed << " case " << i << " depth " << depth);
      CHECK(is_violation(two(Object(placed_a), Object(placed_b)), rule(RuleKind::overlap, 1e-4)) == (depth > 0));
    }
  }
}

TEST_CASE("assembly: a report does not depend on the threads", "[assembly]") {
  std::mt19937_64 random(sim::seed_from_environment());
  Assembly assembly;
  for (int i = 0; i < 40; ++i) {
    assembly.parts.push_back(
        {std::to_string(i), cube, cchip_test::random_pose(cchip_test::PoseClass::rigid, 2, random)});
  }
  assembly.clearance = 0.25;
  const auto text = [&assembly](unsigned threads) {
    AssemblyCheckOptions options;
    options.threads = threads;
    const AssemblyReport report = check(assembly, options);
    std::string all;
    for (const AssemblyPair& pair : report.pairs) all += sentence(assembly, pair) + "\n";
    return all;
  };
  const std::string one = text(1);
  CHECK(one.size() > 1000);
  CHECK(text(3) == one);
  CHECK(text(0) == one);
}

TEST_CASE("assembly: sizes and units that look wrong are named", "[assembly]") {
  Assembly assembly = two(cube, box({0, 0, 0}, {1000, 2, 3}), shifted(5, 0, 0));
  const AssemblyReport report = check(assembly);
  CHECK(report.size == std::array<double, 3>{1005, 2, 3});
  REQUIRE(report.notes.size() == 1);
  CHECK(report.notes[0].find("check the units") != std::string::npos);
}

TEST_CASE("assembly: a page of pairs has each shown part once", "[assembly]") {
  std::vector<Mesh> parts = {make_box({0, 0, 0}, {1, 1, 1}), make_box({1, 0, 0}, {2, 1, 1}),
                             make_box({9, 0, 0}, {10, 1, 1})};
  parts[0].name = "plate</script>";
  parts[1].name = "bolt \"1\"";
  parts[2].name = "far";
  const std::vector<PagePair> pairs = {{1, 0, "violation", "they & touch", {{0, 1, Relation::touching}}, {}},
                                       {0, 1, "accepted", "again", {}, {{{{0, 0, 0}, {1, 0, 0}}, false}}}};
  const std::string page = pairs_page(parts, "x<y", "a summary", pairs, {"/*the library*/", "controls"});
  const auto count = [&page](const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = page.find(what); at != std::string::npos; at = page.find(what, at + 1)) ++found;
    return found;
  };
  CHECK(count("plate\\u003c/script>") == 1);
  CHECK(count("bolt \\u00221\\u0022") == 1);
  CHECK(count("\"name\":\"far\"") == 0);
  CHECK(count("<title>x&lt;y</title>") == 1);
  CHECK(count("\"kind\":\"violation\"") == 1);
  CHECK(count("\"contacts\":[[0,1,1]],\"curves\":[]") == 1);
  CHECK(count("</script>") == 1);  // its own; those of the pair's page are in a text
  CHECK(count("/*the library*/") == 1);
  CHECK(count("@VIEWER@") == 0);
}

TEST_CASE("assembly: parts that are made by hand are checked", "[assembly]") {
  Assembly assembly = two(cube, cube);
  assembly.parts[1].name = "a";
  CHECK_THROWS_WITH(check(assembly), Catch::Contains("have the same name, 'a'"));
  assembly.parts[1].name = "b";
  assembly.rules = {rule(RuleKind::anything)};
  assembly.rules[0].reason.clear();
  CHECK_THROWS_WITH(check(assembly), Catch::Contains("takes a reason"));
  assembly.rules = {rule(RuleKind::clearance, -1)};
  CHECK_THROWS_WITH(check(assembly), Catch::Contains("at least 0"));
}

TEST_CASE("assembly: a TOML file places parts", "[assembly]") {
  const Folder folder;
  const Assembly assembly = load_assembly(folder.write(
      "x.toml", "unit = \"mm\"\nclearance = 0.5\n" + part + "name = \"bolt\"\ngroups = [\"bolts\"]\n" + part +
                    "xyz = [1, 2, 3]\nrpy = [0, 0, 90]\n" + part +
                    "quaternion = [0, 0, 0.7071067811865475, 0.7071067811865475]\nxyz = [4, 0, 0]\n" + part +
                    "pose = [1, 0, 0, 7, 0, 1, 0, 8, 0, 0, 1, 9]\nunit = \"in\"\n" + part +
                    "name = \"bolt\"\npose = [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n" +
                    "[[rule]]\nparts = [\"bolt\", \"box\"]\nallow = \"overlap\"\neps = 1e-4\n" +
                    "[[rule]]\ngroups = [\"bolts\", \"bolts\"]\nwant = \"same\"\n[[rule]]\nclearance = 2\n"));
  REQUIRE(assembly.parts.size() == 5);
  const char* const names[] = {"bolt", "box", "box#2", "box#3", "bolt#2"};
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(assembly.parts[i].name == names[i]);
    CHECK(assembly.parts[i].object.id() == assembly.parts[0].object.id());
  }
  Eigen::Matrix3d quarter;
  quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  CHECK(assembly.parts[1].pose.linear() == quarter);
  CHECK(assembly.parts[1].pose.translation() == Vec3d(1, 2, 3));
  CHECK(assembly.parts[2].pose.linear() == quarter);
  CHECK(assembly.parts[2].pose.translation() == Vec3d(4, 0, 0));
  CHECK(assembly.parts[3].pose.linear() == Eigen::Matrix3d(25.4 * Eigen::Matrix3d::Identity()));
  CHECK(assembly.parts[3].pose.translation() == Vec3d(7, 8, 9));
  CHECK(assembly.parts[4].pose.linear()(0, 0) == -1);
  CHECK(assembly.parts[0].groups == std::vector<std::string>{"bolts"});
  CHECK(assembly.unit == "mm");
  CHECK(assembly.clearance == 0.5);
  REQUIRE(assembly.rules.size() == 3);
  CHECK(assembly.rules[0].kind == RuleKind::overlap);
  CHECK(assembly.rules[0].limit == 1e-4);
  CHECK(assembly.rules[1].kind == RuleKind::same);
  CHECK(assembly.rules[2].kind == RuleKind::clearance);
}

TEST_CASE("assembly: folders and OBJ files", "[assembly]") {
  const Folder folder;
  CHECK(folder.error_of(folder.path()).find("holds one part") != std::string::npos);
  folder.write("wedge.obj", "v 0 0 0.1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Assembly parts = load_assembly(folder.path());
  REQUIRE(parts.parts.size() == 2);
  CHECK(parts.parts[0].name == "box.off");
  CHECK(parts.parts[1].name == "wedge.obj");
  const std::string obj =
      "v 0 0 0.1\nv 1 0 0\nv 0 1 0\nf 1 2 3\no lid\nv 5 0 0\nv 6 0 0\nv 5 1 0\nv 6 1 0\ng x\nf -4 -3 -1 -2\ng y\nf 4 5 "
      "6\n"
      "o lid\nf 1 2 6\n";
  const Assembly objects = load_assembly(folder.write("all.obj", obj));
  REQUIRE(objects.parts.size() == 3);
  CHECK(objects.parts[0].name == "all");
  CHECK(objects.parts[1].name == "lid");
  CHECK(objects.parts[2].name == "lid#2");
  CHECK(objects.parts[0].object.mesh().vertices[0].z() == 0.1);  // no single precision
  CHECK(objects.parts[1].object.mesh().faces.size() == 3);       // a quad in two, and a triangle
  CHECK(folder.error(obj + "o empty\n", "y.obj") ==
        "y.obj:16: the part 'empty' has no faces, so nothing can be said about it; remove this line or add its faces");
  CHECK(folder.error("v 0 0 0\no a\no b\n", "z.obj").find("no faces") != std::string::npos);
  CHECK(folder.error("#usda 1.0", "z.usd").find("is no assembly; give a TOML file") != std::string::npos);
}

TEST_CASE("assembly: what is wrong with a file, where and what to do", "[assembly]") {
  const Folder folder;
  const auto check_error = [&folder](const std::string& text, const std::string& expected) {
    CHECK_THAT(folder.error(text), Catch::Contains(expected));
  };
  check_error("unit = ", "x.toml:1: ");
  check_error("unit = \"mm\"\n", "there are no parts; add a table [[part]]");
  check_error("unit = \"parsec\"\n" + part,
              "x.toml:1: key 'unit' is 'parsec', which is no unit here; write um, mm, cm");
  check_error("colour = 1\n" + part, "x.toml:1: key 'colour' is unknown; the keys here are unit, clearance");
  check_error("part = 1\n", "key 'part' must be a list of tables; head each with [[part]]");
  check_error("clearance = \"1\"\n" + part, "key 'clearance' must be a length that is at least 0");
  check_error("clearance = -1\n" + part, "key 'clearance' must be a length that is at least 0");
  check_error(part + "pos = [1]\n", "x.toml:3: part 1: key 'pos' is unknown");
  check_error("[[part]]\nname = \"a\"\n", "x.toml:1: part 1: key 'file' is missing; add it");
  check_error("[[part]]\nfile = 3\n", "x.toml:2: part 1: key 'file' must be a text in quotes");
  check_error(part + "xyz = [1, 2]\n", "part 1: key 'xyz' must be a list of 3 finite numbers, and has 2");
  check_error(part + "xyz = [1, 2, nan]\n", "must be a list of 3 finite numbers; correct it");
  check_error(part + "pose = [1, 2]\n", "must be a list of 12 or 16 finite numbers, and has 2");
  check_error(part + "pose = [1,0,0,0,0,1,0,0,0,0,1,0,5,0,0,1]\n", "is written column by column; write");
  check_error(part + "pose = [1,0,0,0,0,1,0,0,0,0,0,0]\n", "the pose flattens space");
  check_error(part + "pose = [1,0,0,0,0,1,0,0,0,0,1,0]\nxyz = [1,2,3]\n", "exclude each other; keep one");
  check_error(part + "rpy = [0,0,0]\nquaternion = [0,0,0,1]\n", "exclude each other; keep one");
  check_error(part + "quaternion = [0,0,0,0]\n", "has no length that can be used");
  check_error(part + part + "unit = \"in\"\n", "says in, but the assembly has no unit to convert to; add unit");
  check_error("[[part]]\nfile = \"none.off\"\n" + part, "x.toml:1: none.off: ");
  check_error(part, "holds one part, which cannot clash");
  const std::string rule_head = part + part + "[[rule]]\n";
  check_error(rule_head, "x.toml:5: rule 1: it says nothing; add the key allow, want or clearance");
  check_error(rule_head + "allow = \"all\"\n", "key 'allow' is 'all'; write nothing, touching, overlap or anything");
  check_error(rule_head + "allow = \"overlap\"\n", "needs eps");
  check_error(rule_head + "allow = \"touching\"\neps = 1\n", "goes with allow = \"overlap\" only");
  check_error(rule_head + "allow = \"anything\"\n", "takes a reason here; add reason");
  check_error(rule_head + "want = \"inside\"\n", "is about all pairs here; name two");
  check_error(rule_head + "want = \"outside\"\n", "key 'want' is 'outside'; write inside or same");
  check_error(rule_head + "allow = \"touching\"\nclearance = 1\n", "exclude each other");
  check_error(rule_head + "parts = [\"a\"]\nallow = \"touching\"\n", "key 'parts' has 1 entries; a rule names two");
  check_error(rule_head + "parts = [\"a\", \"a\"]\nallow = \"touching\"\n", "names 'a' twice");
  check_error(rule_head + "parts = [\"a\", 1]\nallow = \"touching\"\n", "must be a list of texts");
  check_error("rules = [\"other.toml\"]\n" + part + part, "other.toml");
  folder.write("empty.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n");
  check_error("[[part]]\nfile = \"empty.off\"\n" + part, "holds no faces");
}

TEST_CASE("assembly: what was accepted passes, and something new does not", "[assembly]") {
  const Folder folder;
  Assembly assembly;
  assembly.clearance = 0.5;
  assembly.parts = {{"a", cube},
                    {"touches \"a\"", cube, shifted(1, 0, 0)},
                    {"overlaps a", cube, shifted(-0.875, 0.25, 0.25)},
                    {"is a", cube},
                    {"in a", box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75})},
                    {"near a", cube, shifted(0, 0, 1.25)}};
  CHECK(check(assembly).violations > 5);
  assembly.rules = load_rules(folder.write("accepted.toml", accepting_rules(assembly, check(assembly))));
  const AssemblyReport accepted = check(assembly);
  CHECK(accepted.violations == 0);
  CHECK(accepted.unused_rules.empty());
  assembly.parts[5].pose = shifted(0, 0, 1.125);
  CHECK(check(assembly).violations > 0);
}
