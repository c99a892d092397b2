// SPDX-License-Identifier: Apache-2.0
// Robots as assemblies. Their files are written here.
#include <array>
#include <catch2/catch.hpp>
#include <cchip/assembly.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>

using namespace cchip;
namespace fs = std::filesystem;

namespace {

class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("cchip_urdf_" + std::to_string(std::random_device()()))) {
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string write(const std::string& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return (path_ / name).string();
  }
  Assembly load(const std::string& text, const AssemblyLoadOptions& options = {}) const {
    return load_assembly(write("robot.urdf", text), options);
  }
  std::string error(const std::string& text, const AssemblyLoadOptions& options = {}) const {
    try {
      load(text, options);
    } catch (const std::runtime_error& error) {
      const std::string what = error.what();
      CHECK(what.find("robot.urdf") != std::string::npos);
      CHECK(what.find('\n') == std::string::npos);
      CHECK(what.find("; ") != std::string::npos);  // what to do
      return what;
    }
    return "";
  }
  std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

bool contains(const std::string& text, const std::string& part) {
  INFO(text);
  return text.find(part) != std::string::npos;
}

bool has_note(const Assembly& assembly, const std::string& part) {
  for (const std::string& note : assembly.notes) {
    if (note.find(part) != std::string::npos) return true;
  }
  return false;
}

const std::string cube_off =
    "OFF\n8 6 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n"
    "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";

std::string robot(const std::string& content) { return "<robot name=\"r\">" + content + "</robot>"; }

std::string shape(const std::string& geometry, const std::string& xyz = "0 0 0", const std::string& rpy = "0 0 0") {
  return "<collision><origin xyz=\"" + xyz + "\" rpy=\"" + rpy + "\"/><geometry>" + geometry +
         "</geometry></collision>";
}
const std::string unit_box = "<box size=\"1 1 1\"/>";
std::string link(const std::string& name, const std::string& content = shape(unit_box)) {
  return "<link name=\"" + name + "\">" + content + "</link>";
}
const std::string wide = "<limit lower=\"-4\" upper=\"4\" effort=\"1\" velocity=\"1\"/>";
std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& xyz, const std::string& rest = wide, const std::string& rpy = "0 0 0") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/><origin xyz=\"" + xyz + "\" rpy=\"" + rpy + "\"/>" + rest + "</joint>";
}
const std::string about_z = "<axis xyz=\"0 0 1\"/>";

/// Links a and b, joined by j.
std::string two(const std::string& type, const std::string& rest) {
  return robot(link("a") + link("b") + joint("j", type, "a", "b", "2 0 0", rest));
}

Vec3d at(const Assembly& assembly, std::size_t part, const Vec3d& point = Vec3d::Zero()) {
  return assembly.parts.at(part).pose * point;
}

}  // namespace

TEST_CASE("urdf: links with collision shapes are parts, in metres", "[assembly][urdf]") {
  const Folder folder;
  const Assembly assembly =
      folder.load(robot(link("root", "") + link("a") + link("b") + joint("r", "fixed", "root", "a", "0 0 0", "") +
                        joint("j", "fixed", "a", "b", "0.5 0 0", "")));
  REQUIRE(assembly.parts.size() == 2);
  CHECK(assembly.unit == "m");
  CHECK(assembly.parts[1].name == "b");
  CHECK(at(assembly, 1) == Vec3d(0.5, 0, 0));
  CHECK(has_note(assembly, "1 of 3 links have no collision"));
  // They overlap, and a joint joins them.
  REQUIRE(assembly.left_out.size() == 1);
  CHECK(check(assembly).judged == 0);
  AssemblyLoadOptions options;
  options.neighbours = true;
  CHECK(check(load_assembly(folder.path() + "/robot.urdf", options)).violations == 1);
}

TEST_CASE("urdf: a rule that names neighbours counts", "[assembly][urdf]") {
  const Folder folder;
  Assembly assembly = folder.load(robot(link("a") + link("b") + joint("j", "fixed", "a", "b", "0.5 0 0", "")));
  AssemblyRule rule;
  rule.parts = {"b", "a"};
  assembly.rules = {rule};
  CHECK(check(assembly).violations == 1);
  assembly.rules[0].kind = AssemblyRule::Kind::anything;
  assembly.rules[0].reason = "a hinge";
  CHECK(check(assembly).judged == 0);
}

TEST_CASE("urdf: shapes contain what they stand for", "[assembly][urdf]") {
  const Folder folder;
  const Assembly assembly =
      folder.load(robot(link("a", shape("<cylinder radius=\"2\" length=\"3\"/>")) +
                        link("b", shape("<sphere radius=\"2\"/>")) + joint("j", "fixed", "a", "b", "9 0 0", "")));
  for (const AssemblyPart& part : assembly.parts) {
    CHECK(part.object.is_closed());
    const Mesh& mesh = part.object.mesh();
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
      const Primitive face = mesh.primitive(i);
      const Vec3d normal = (face.v[1] - face.v[0]).cross(face.v[2] - face.v[0]).normalized();
      const bool end = part.name == "a" && std::abs(normal.z()) > 0.5;
      CHECK(normal.dot(face.v[0]) >= (end ? 1.5 : 2.0));
    }
    for (const Vec3d& vertex : mesh.vertices) {
      CHECK((part.name == "a" ? vertex.head<2>().norm() : vertex.norm()) <= (part.name == "a" ? 2.0026 : 2.007));
    }
  }
}

TEST_CASE("urdf: quarter turns are exact", "[assembly][urdf]") {
  const Folder folder;
  const Assembly assembly = folder.load(
      robot(link("a", shape(unit_box, "0 0 0", "1.5707963267948966 0 0")) + link("b") +
            joint("j", "revolute", "a", "b", "1 0 0", about_z + wide, "0 1.5707963267948966 -3.141592653589793")),
      [] {
        AssemblyLoadOptions options;
        options.joints = {{"j", std::acos(0.0)}};
        return options;
      }());
  CHECK(assembly.parts[0].pose.linear() == make_pose({0, 0, 0}, {90, 0, 0}).linear());
  CHECK(assembly.parts[1].pose.linear() ==
        Eigen::Matrix3d(make_pose({0, 0, 0}, {0, 90, 180}).linear() * make_pose({0, 0, 0}, {0, 0, 90}).linear()));
}

TEST_CASE("urdf: meshes, their scale and where they are found", "[assembly][urdf]") {
  const Folder folder;
  folder.write("meshes/a.off", cube_off);
  folder.write("pkgs/arm/meshes/b.off", cube_off);
  const std::string half = "<mesh filename=\"meshes/a.off\" scale=\"-1 2 0.5\"/>";
  const auto with = [](const std::string& name) {
    return robot(link("a", shape("<mesh filename=\"" + name + "\"/>")) + link("b") +
                 joint("j", "fixed", "a", "b", "3 0 0", ""));
  };
  SECTION("scale of one shape and of several, mirrored") {
    const Assembly assembly = folder.load(robot(link("a", shape(half)) + link("b", shape(half) + shape(half, "5 0 0")) +
                                                joint("j", "fixed", "a", "b", "30 0 0", "")));
    CHECK(at(assembly, 0, {1, 1, 1}) == Vec3d(-1, 2, 0.5));
    const Object& both = assembly.parts[1].object;
    REQUIRE(both.mesh().faces.size() == 24);
    double volume = 0;
    for (std::size_t i = 0; i < 24; ++i) {
      const Primitive face = both.mesh().primitive(i);
      volume += face.v[0].dot(face.v[1].cross(face.v[2])) / 6;
    }
    CHECK(volume == Approx(2));  // the faces look outwards
  }
  SECTION("package:// by a root and by walking up, file://") {
    AssemblyLoadOptions options;
    options.packages = folder.path() + "/pkgs";
    CHECK(folder.load(with("package://arm/meshes/b.off"), options).parts.size() == 2);
    options.packages += "/arm/";  // the package itself
    CHECK(folder.load(with("package://arm/meshes/b.off"), options).parts.size() == 2);
    CHECK(
        contains(folder.error(with("package://arm/meshes/b.off")), "link 'a': 'package://arm/meshes/b.off' is in no"));
    const std::string inside = folder.write("pkgs/arm/urdf/x.urdf", with("package://arm/meshes/b.off"));
    CHECK(load_assembly(inside).parts.size() == 2);
    CHECK(folder.load(with("file://" + folder.path() + "/meshes/a.off")).parts.size() == 2);
    CHECK(contains(folder.error(with("http://x/a.off")), "'http://x/a.off' is not read"));
  }
  SECTION("refused by name") {
    folder.write("a.dae", "<COLLADA/>");
    CHECK(contains(folder.error(with("a.dae")), "is COLLADA, which is not read"));
    CHECK(contains(folder.error(with("none.off")), "link 'a': "));
  }
}

TEST_CASE("urdf: what urdfdom drops is an error", "[assembly][urdf]") {
  const Folder folder;
  const auto error = [&](const std::string& more) {
    return folder.error(
        robot(link("a", more + shape(unit_box)) + link("b") + joint("j", "fixed", "a", "b", "3 0 0", "")));
  };
  CHECK(error("").empty());
  CHECK(
      contains(error("<visual><geometry><mesh filename=\"x.stl\" scale=\"2\"/></geometry></visual>"), "urdfdom says"));
  CHECK(contains(error("<visual><origin xyz=\"1,5 0 0\"/><geometry>" + unit_box + "</geometry></visual>"),
                 "urdfdom says"));
  CHECK(contains(error(shape("<mesh filename=\"x.stl\" scale=\"2\"/>")), "urdfdom says"));
  CHECK(contains(error(shape("<capsule radius=\"1\" length=\"1\"/>")), "urdfdom says"));
  CHECK(contains(error(shape(unit_box, "nan 0 0")), "urdfdom says"));
  CHECK(contains(error(shape("<sphere radius=\"-1\"/>")), "the radius of a shape is -1"));
  CHECK(contains(error(shape("<mesh filename=\"x.stl\" scale=\"1 0 1\"/>")), "flattens"));
  CHECK(contains(folder.error(robot(link("a") + link("a"))), "urdfdom says"));
  CHECK(contains(folder.error(robot("<xacro:include filename=\"x\"/>")), "xacro"));
  // What xacro wrote may have macros in comments.
  CHECK(folder
            .error(robot(link("a") + "<!-- <xacro:include filename=\"x\"/> -->" + link("b") +
                         joint("j", "fixed", "a", "b", "5 0 0", "")))
            .empty());
  CHECK(contains(folder.error("nothing"), "; "));
}

TEST_CASE("urdf: axes and limits", "[assembly][urdf]") {
  const Folder folder;
  AssemblyLoadOptions moved;
  moved.joints = {{"j", 1}};
  const Assembly slide = folder.load(two("prismatic", "<axis xyz=\"0 0 2\"/>" + wide), moved);
  CHECK(at(slide, 1) == Vec3d(2, 0, 1));
  CHECK(has_note(slide, "joint 'j': its axis has the length 2"));
  CHECK(at(folder.load(two("prismatic", wide), moved), 1) == Vec3d(3, 0, 0));  // without an axis it is x
  CHECK(contains(folder.error(two("revolute", "<axis xyz=\"0 0 0\"/>" + wide)), "joint 'j': its axis is 0"));
  CHECK(contains(folder.error(two("revolute", about_z)), "urdfdom says"));
  const auto limits = [](const std::string& ends) {
    return about_z + "<limit " + ends + " effort=\"1\" velocity=\"1\"/>";
  };
  CHECK(
      contains(folder.error(two("revolute", limits("lower=\"1\" upper=\"-1\""))), "joint 'j': its limits are 1 to -1"));
  CHECK(has_note(folder.load(two("revolute", limits(""))), "joint 'j' cannot move"));
  CHECK(contains(folder.error(two("revolute", limits("")), moved), "joint 'j': the value 1 is beyond its limits"));
  const Assembly raised = folder.load(two("prismatic", limits("lower=\"0.5\" upper=\"1\"")));
  CHECK(at(raised, 1) == Vec3d(2, 0, 0.5));
  CHECK(has_note(raised, "joint 'j' is at 0.5"));
  moved.joints = {{"j", 100}};
  CHECK_NOTHROW(folder.load(two("continuous", about_z), moved));
  CHECK(contains(folder.error(two("fixed", ""), moved), "joint 'j': is fixed"));
  CHECK(contains(folder.error(two("planar", about_z), moved), "joint 'j': is planar"));
  CHECK_NOTHROW(folder.load(two("floating", "")));
  moved.joints = {{"k", 1}};
  CHECK(contains(folder.error(two("continuous", about_z), moved), "joint 'k': there is no such joint; name one of j"));
}

TEST_CASE("urdf: joints that follow others", "[assembly][urdf]") {
  const Folder folder;
  const auto chain = [](const std::string& of2, const std::string& of3) {
    const auto mimic = [](const std::string& of, const std::string& how) {
      return about_z + wide + "<mimic joint=\"" + of + "\" " + how + "/>";
    };
    return robot(link("a") + link("b") + link("c") + link("d") +
                 joint("j1", "prismatic", "a", "b", "2 0 0", about_z + wide) +
                 joint("j2", "prismatic", "a", "c", "4 0 0", mimic(of2, "multiplier=\"1.5\"")) +
                 joint("j3", "prismatic", "a", "d", "6 0 0", mimic(of3, "multiplier=\"2\" offset=\"0.25\"")));
  };
  AssemblyLoadOptions options;
  options.joints = {{"j1", 1.5}};
  Assembly assembly = folder.load(chain("j1", "j2"), options);
  std::map<std::string, double> height;
  for (const AssemblyPart& part : assembly.parts) height[part.name] = part.pose.translation().z();
  CHECK(height["c"] == 2.25);
  CHECK(height["d"] == 4.75);
  CHECK(has_note(assembly, "joint 'j3' follows 'j1' to 4.75, beyond its limits, -4 to 4"));
  CHECK_THROWS_AS(move_joints(assembly, {{"j2", 0}}), std::invalid_argument);
  CHECK(move_joints(assembly, {{"j1", 0}}).empty());
  CHECK(contains(folder.error(chain("j1", "j3")), "joint 'j3': follows itself"));
  CHECK(contains(folder.error(chain("j3", "j2")), "follows itself"));
  CHECK(contains(folder.error(chain("j1", "j9")), "joint 'j3': follows 'j9', and there is no such joint"));
}

TEST_CASE("urdf: what is no tree", "[assembly][urdf]") {
  const Folder folder;
  const std::string links = link("a") + link("b") + link("c");
  CHECK(contains(
      folder.error(robot(links + joint("j", "fixed", "a", "b", "0 0 0", "") +
                         joint("k", "fixed", "b", "c", "0 0 0", "") + joint("l", "fixed", "a", "c", "0 0 0", ""))),
      "link 'c': joints 'k' and 'l' both carry it"));
  CHECK(contains(folder.error(robot(links + joint("j", "fixed", "b", "c", "0 0 0", "") +
                                    joint("k", "fixed", "c", "b", "0 0 0", ""))),
                 "no chain of joints leads to it"));
  CHECK(!folder.error(robot(links)).empty());
}

TEST_CASE("urdf: an SRDF allows pairs", "[assembly][urdf]") {
  const Folder folder;
  const std::string text = robot(link("a") + link("b") + link("c") + joint("j", "fixed", "a", "b", "0.5 0 0", "") +
                                 joint("k", "fixed", "b", "c", "0.25 0 0", ""));
  const auto srdf = [&](const std::string& pairs) {
    AssemblyLoadOptions options;
    options.srdf = folder.write("robot.srdf", "<?xml version=\"1.0\"?>\n<robot name=\"r\">\n" + pairs + "</robot>");
    return options;
  };
  CHECK(check(folder.load(text)).violations == 1);  // a and c
  const Assembly allowed =
      folder.load(text, srdf("<disable_collisions link1=\"a\" link2=\"b\" reason=\"Adjacent\"/>\n"
                             "<disable_collisions link1=\"c\" link2=\"a\" reason=\"Default\"/>\n"));
  REQUIRE(allowed.rules.size() == 1);  // a and b are left out
  CHECK(allowed.rules[0].reason == "Default");
  CHECK(contains(allowed.rules[0].place, "robot.srdf:4"));
  const AssemblyReport report = check(allowed);
  CHECK(report.violations == 0);
  CHECK(report.accepted == 1);
  const auto error = [&](const std::string& pairs) {
    try {
      folder.load(text, srdf(pairs));
    } catch (const std::runtime_error& thrown) {
      return std::string(thrown.what());
    }
    return std::string();
  };
  const Assembly of_variants = folder.load(text, srdf("<disable_collisions link1=\"a\" link2=\"z\"/>\n"
                                                      "<disable_collisions link1=\"c\" link2=\"b\"/>\n"));
  CHECK(of_variants.rules.empty());
  REQUIRE(of_variants.notes.size() == 1);
  CHECK(contains(of_variants.notes[0], "robot.srdf:3: link2 is 'z', and the robot has no such link"));
  const std::string apart = robot(link("a") + link("b") + link("c") + joint("j", "fixed", "a", "b", "5 0 0", "") +
                                  joint("k", "fixed", "b", "c", "5 0 0", ""));
  const Assembly never = folder.load(apart, srdf("<disable_collisions link1=\"c\" link2=\"a\" reason=\"Never\"/>\n"));
  CHECK(never.rules.size() == 1);
  CHECK(check(never).unused_rules.empty());  // it lists pairs that never meet, too
  CHECK(contains(error("<disable_collisions link1=\"a\""), "its XML is wrong"));
}

TEST_CASE("urdf: options of robots are refused elsewhere", "[assembly][urdf]") {
  const Folder folder;
  folder.write("parts/a.off", cube_off);
  folder.write("parts/b.off", cube_off);
  AssemblyLoadOptions options;
  options.joints = {{"j", 1}};
  CHECK_THROWS_WITH(load_assembly(folder.path() + "/parts", options), Catch::Contains("is no robot"));
}
