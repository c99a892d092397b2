// SPDX-License-Identifier: Apache-2.0
// The reader of robots that scripts/run bench-robot uses, on a robot of its own.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "robot.hpp"

using namespace cchip;
using namespace cchip::testing;

namespace {

/// base - turns about z - arm - slides along y - two fingers, the second mirrors the first; a tool is fixed to the arm.
const std::string urdf = R"(<robot name="small">
  <link name="base"/>
  <link name="arm">
    <collision><origin xyz="1 0 0"/><geometry><box size="2 0.5 0.25"/></geometry></collision>
    <collision><geometry><mesh filename="package://robots/one.obj" scale="2 3 4"/></geometry></collision>
  </link>
  <link name="tool"/>
  <link name="left"/>
  <link name="right"/>
  <joint name="l" type="prismatic"><origin xyz="2 0 0" rpy="0 0 1.57079632679489661923"/><parent link="tool"/>
    <child link="left"/><axis xyz="0 5 0"/><limit lower="0" upper="0.5"/></joint>
  <joint name="r" type="prismatic"><origin xyz="2 0 0"/><parent link="tool"/><child link="right"/><axis xyz="0 1 0"/>
    <mimic joint="l" multiplier="-2" offset="0.125"/></joint>
  <joint name="t" type="fixed"><origin xyz="0 0 1"/><parent link="arm"/><child link="tool"/></joint>
  <joint name="turn" type="revolute"><origin xyz="0 0 3"/><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="2"/></joint>
</robot>
)";

/// A folder of its own, removed at the end.
struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("cchip_test_robot_" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path); }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name) << text;
    return path / name;
  }
};

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = urdf;
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

TEST_CASE("Robot: links, joints and poses of a URDF", "[ref][robot]") {
  const Folder folder;
  folder.write("one.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n");
  const Robot robot(folder.write("small.urdf", urdf), folder.path);

  REQUIRE(robot.links().size() == 5);
  const Mesh& arm = robot.links()[1].mesh;
  REQUIRE(arm.faces.size() == 13);
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < 8; ++i) box.extend(arm.vertices[i]);
  CHECK(box.min() == Vec3d(0, -0.25, -0.125));
  CHECK(box.max() == Vec3d(2, 0.25, 0.125));
  CHECK(arm.vertices[arm.faces[12].vertex[2]] == Vec3d(0, 0, 4));

  REQUIRE(robot.axes().size() == 2);
  CHECK(robot.axes()[0].joint == "l");
  CHECK(robot.axes()[1].lower == -1);
  CHECK(robot.axes()[1].upper == 2);

  CHECK(robot.adjacent(0, 1));
  CHECK(robot.adjacent(0, 2));  // the tool moves with the arm
  CHECK(robot.adjacent(1, 2));
  CHECK(robot.adjacent(1, 3));
  CHECK_FALSE(robot.adjacent(0, 3));
  CHECK_FALSE(robot.adjacent(3, 4));

  constexpr double quarter = 1.57079632679489661923;
  const std::vector<Pose> poses = robot.poses({0.25, quarter});
  CHECK(poses[0].isApprox(Pose::Identity()));
  CHECK((poses[1] * Vec3d(1, 0, 0)).isApprox(Vec3d(0, 1, 3)));
  CHECK((poses[2] * Vec3d(1, 0, 0)).isApprox(Vec3d(0, 1, 4)));
  // along its own y, which is -x of the arm; half a turn about z in all
  CHECK(poses[3].translation().isApprox(Vec3d(0, 1.75, 4)));
  CHECK((poses[3].linear() * Vec3d(1, 0, 0)).isApprox(Vec3d(-1, 0, 0)));
  CHECK(poses[4].translation().isApprox(Vec3d(0.375, 2, 4)));
}

TEST_CASE("Robot: the faces of a box look outside", "[ref][robot]") {
  const Mesh box = make_box({1, 2, 3});
  REQUIRE(box.faces.size() == 12);
  double volume = 0;
  for (const Mesh::Face& face : box.faces) {
    const Vec3d& a = box.vertices[face.vertex[0]];
    const Vec3d normal = (box.vertices[face.vertex[1]] - a).cross(box.vertices[face.vertex[2]] - a);
    CHECK(normal.dot(a) > 0);
    volume += normal.dot(a) / 6;
  }
  CHECK(volume == Approx(6));
}

TEST_CASE("Robot: what is wrong with a URDF", "[ref][robot]") {
  using Catch::Contains;
  const Folder folder;
  folder.write("one.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n");
  const auto refused = [&](const std::string& text, const std::string& message) {
    const std::filesystem::path file = folder.write("wrong.urdf", text);
    CHECK_THROWS_WITH(Robot(file, folder.path), Contains(message));
  };
  CHECK_THROWS_WITH(Robot(folder.path / "none.urdf", folder.path),
                    Contains("none.urdf: no such file") && Contains("scripts/run robots"));
  refused(replaced("</robot>", ""), "XML_ERROR");
  refused("<a/>", "no <robot>");
  refused(replaced("robots/one.obj", "robots/two.obj"), "wrong.urdf:5: no mesh ");
  refused(replaced("<box size=\"2 0.5 0.25\"/>", "<sphere radius=\"1\"/>"),
          "wrong.urdf:4: collision geometry is sphere");
  refused(replaced("size=\"2 0.5 0.25\"", "size=\"2 0.5\""), "attribute size is not three numbers");
  refused(replaced("lower=\"-1\"", "lower=\"low\""), "attribute lower is no number");
  refused(replaced("upper=\"2\"", "upper=\"-2\""), "lower limit above the upper one");
  refused(replaced("axis xyz=\"0 5 0\"", "axis xyz=\"0 0 0\""), "has no direction");
  refused(replaced("<link name=\"tool\"/>", ""), "no link of this name");
  refused(replaced("<link name=\"tool\"/>", "<link name=\"arm\"/>"), "second link 'arm'");
  refused(replaced("mimic joint=\"l\"", "mimic joint=\"r\""), "no joint with limits of this name");
  refused(replaced("type=\"fixed\"", "type=\"floating\""), "joint of type floating");
  refused(replaced("<limit lower=\"0\" upper=\"0.5\"/>", ""), "without <limit>");
  refused(replaced("<child link=\"right\"/>", "<child link=\"left\"/>"), "two joints move link 'left'");
  refused(replaced("<child link=\"arm\"/>", "<child link=\"base\"/>"), "not one tree");
}

}  // namespace
