// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cchip/pose.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/program/usage_error.hpp>
#include <cmath>
#include <random>

#include "pose.hpp"
#include "support.hpp"

using namespace cchip;
using namespace cchip::app;
using Eigen::Vector3d;

TEST_CASE("pose: translation, quarter turns exactly", "[system][pose]") {
  CHECK(parse_pose("1,2.5,-3") * Vector3d(1, 1, 1) == Vector3d(2, 3.5, -2));
  CHECK(parse_pose("0,0,0,90,0,0") * Vector3d(1, 2, 3) == Vector3d(1, -3, 2));
  CHECK(parse_pose("0,0,0,0,90,0") * Vector3d(1, 2, 3) == Vector3d(3, 2, -1));
  CHECK(parse_pose("0,0,0,0,0,90") * Vector3d(1, 2, 3) == Vector3d(-2, 1, 3));
  CHECK(parse_pose("0,0,0,0,0,-90") * Vector3d(1, 2, 3) == Vector3d(2, -1, 3));
  CHECK(parse_pose("0,0,0,0,0,180") * Vector3d(1, 2, 3) == Vector3d(-1, -2, 3));
  CHECK(parse_pose("0,0,0,0,0,-630") * Vector3d(1, 2, 3) == Vector3d(-2, 1, 3));
  // x first, then y, then z, then the translation: (1,2,3) -> (1,-3,2) -> (2,-3,-1) -> (3,2,-1) -> (13,2,-1)
  CHECK(parse_pose("10,0,0,90,90,90") * Vector3d(1, 2, 3) == Vector3d(13, 2, -1));
}

TEST_CASE("pose: any angle is a rotation about the axis by that angle", "[system][pose]") {
  std::mt19937_64 random(cchip::sim::seed_from_environment());
  std::uniform_real_distribution<double> degrees(-720, 720);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d r(degrees(random), degrees(random), degrees(random));
    const Vector3d radians = r * (std::acos(-1.0) / 180);
    const Eigen::Matrix3d expected =
        (Eigen::AngleAxisd(radians.z(), Vector3d::UnitZ()) * Eigen::AngleAxisd(radians.y(), Vector3d::UnitY()) *
         Eigen::AngleAxisd(radians.x(), Vector3d::UnitX()))
            .toRotationMatrix();
    REQUIRE((make_pose({0, 0, 0}, r).linear() - expected).cwiseAbs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("pose: matrix row by row, rigid only", "[system][pose]") {
  CHECK(parse_pose_matrix("0,-1,0,10, 1,0,0,20, 0,0,1,30") * Vector3d(1, 2, 3) == Vector3d(8, 21, 33));
  CHECK_NOTHROW(parse_pose_matrix("1,0,0,0,0,1,0,0,0,0,1.0000000001,0"));
  for (const char* text : {"1,0,0,0,0,1,0,0,0,0,1.00000001,0",  // scaled
                           "1,0,0,0,0,1,0,0,0,0,-1,0",          // mirrored
                           "1,0.1,0,0,0,1,0,0,0,0,1,0",         // sheared
                           "1,0,0,0,0,1,0,0,0,0,1", "1,0,0,0,0,1,0,0,0,0,1,0,0", "1,0,0,0,0,x,0,0,0,0,1,0", ""}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_pose_matrix(text), UsageError);
  }
  CHECK(parse_affine_matrix("-1,0.5,0,1, 0,2,0,0, 0,0,0,3") * Vector3d(1, 2, 3) == Vector3d(1, 4, 3));
  for (const char* text : {"1,0,0,0,0,1,0,0,0,0,1", "1,0,0,0,0,1,0,0,0,0,1,0,0", "1,0,0,0,0,x,0,0,0,0,1,0", ""}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_affine_matrix(text), UsageError);
  }
  for (const char* text : {"", "1", "1,2", "1,2,3,4", "1,2,3,4,5", "1,2,3,4,5,6,7", "1,2,nan", "1,,3"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_pose(text), UsageError);
  }
}

namespace {

Pose row_of(const std::vector<std::string>& names, const std::vector<std::string>& values) {
  return PoseColumns({1, names}, "poses.csv", "").parse({2, values}).pose;
}

}  // namespace

TEST_CASE("pose: columns of a translation alone and of each rotation", "[system][pose]") {
  const Pose quarter(parse_pose("1,2,3,0,0,90"));
  const std::string half = "0.70710678118654757";
  const std::string below = "0.70710678118654746";
  CHECK(row_of({"tx", "ty", "tz"}, {"1", "2", "3"}).isApprox(Pose(parse_pose("1,2,3")), 0));
  CHECK(row_of({"tz", "ty", "tx", "rz", "ry", "rx"}, {"3", "2", "1", "90", "0", "0"}).isApprox(quarter, 0));
  CHECK(row_of({"tx", "ty", "tz", "roll", "pitch", "yaw"}, {"1", "2", "3", "0", "0", "1.5707963267948966"})
            .isApprox(quarter, 0));
  for (const std::string& qz : {half, below}) {
    CHECK(row_of({"tx", "ty", "tz", "qx", "qy", "qz", "qw"}, {"1", "2", "3", "0", "0", qz, half}).isApprox(quarter, 0));
  }
  // one that is no quarter turn: about z by 60 degrees, with other columns in between
  const Pose third = row_of({"qw", "note", "qx", "qy", "qz", "tx", "ty", "tz"},
                            {"0.8660254037844386", "x", "0", "0", "0.5", "0", "0", "0"});
  CHECK(third.isApprox(Pose(parse_pose("0,0,0,0,0,60")), 1e-15));
  CHECK(third(2, 2) == 1);
  // beside a matrix they are passed through
  const std::vector<std::string> matrix = {"r00", "r01", "r02", "r10", "r11", "r12", "r20",
                                           "r21", "r22", "tx",  "ty",  "tz",  "yaw"};
  CHECK(row_of(matrix, {"2", "0", "0", "0", "1", "0", "0", "0", "1", "1", "2", "3", "?"})(0, 0) == 2);
}

TEST_CASE("pose: columns that are no pose", "[system][pose]") {
  using Catch::Contains;
  CHECK_THROWS_WITH(row_of({"tx", "ty"}, {"1", "2"}), Contains("column tz is missing") && Contains("rx,ry,rz"));
  CHECK_THROWS_WITH(row_of({"tx", "ty", "tz", "rx", "rz"}, {}), Contains("column ry is missing"));
  CHECK_THROWS_WITH(row_of({"tx", "ty", "tz", "rx", "ry", "rz", "yaw"}, {}), Contains("columns rx and roll are there"));
  CHECK_THROWS_WITH(row_of({"tx", "ty", "tz", "qx", "qy", "qz", "qw"}, {"0", "0", "0", "0", "0", "0", "0"}),
                    Contains("poses.csv:2") && Contains("the quaternion is 0"));
  CHECK_THROWS_WITH(row_of({"tx", "ty", "tz"}, {"0", "0", "x"}), Contains("column tz: 'x' is not a number"));
}
