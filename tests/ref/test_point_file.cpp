// SPDX-License-Identifier: Apache-2.0
// Files of points.
#include <catch2/catch.hpp>
#include <cchip/mesh_io/point_file.hpp>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

using namespace cchip;

namespace {

template <class T>
std::string bytes_of(T value) {  // the tests run on little-endian computers
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

void check_refused(const std::string& file, const std::string& name, const std::string& message) {
  CHECK_THROWS_WITH(parse_points(file, name), message);
}

const std::vector<Vec3d> two = {{0.1, -2, 3e5}, {4, 5.5, -6}};

const std::string pcd_header =
    "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
    "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\n";

}  // namespace

TEST_CASE("point files: XYZ", "[ref][points]") {
  CHECK(parse_points("0.1 -2 3e5\n4 5.5 -6\n", "a.xyz") == two);
  CHECK(parse_points("# x y z r g b\r\n0.1\t-2 3e5 255 0 0\r\n\r\n4 5.5 -6 0 0 0", "a.txt") == two);
  CHECK(parse_points("\xef\xbb\xbf"
                     "0.1 -2 3e5\n4 5.5 -6 # last\n",
                     "a") == two);
  check_refused("1 2 3\n1 2\n", "a.xyz", "a.xyz:2: word 3 of the line is missing; repair the file or write it again");
  check_refused("1 2 3\n\n1 x 2\n", "a.xyz", "a.xyz:3: 'x' is not a number; repair the file or write it again");
  check_refused("# nothing\n", "a.xyz", "a.xyz: the file holds no points; repair the file or write it again");
}

TEST_CASE("point files: PLY without faces", "[ref][points]") {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n";
  CHECK(parse_points(header + "end_header\n0.1 -2 3e5\n4 5.5 -6\n", "a.ply") == two);
  CHECK(parse_points(header + "end_header\n0.1 -2 3e5\n4 5.5 -6\n", "without_ending") == two);
  CHECK(parse_points(header +
                         "element face 1\nproperty list uchar int vertex_indices\nend_header\n0.1 -2 3e5\n4 5.5 -6\n"
                         "3 0 1 0\n",
                     "a.PLY") == two);
  std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty uchar red\nproperty double x\nproperty double "
      "y\n"
      "property double z\nend_header\n";
  for (const Vec3d& p : two) binary += '\n' + bytes_of(p.x()) + bytes_of(p.y()) + bytes_of(p.z());
  CHECK(parse_points(binary, "a.ply") == two);
  check_refused(
      header + "end_header\n0.1 -2 3e5\n4 5.5\n", "a.ply",
      "a.ply:9: the file ends before the last value that the header announces; repair the file or write it again");
}

TEST_CASE("point files: PCD", "[ref][points]") {
  CHECK(parse_points(pcd_header + "DATA ascii\n0.1 -2 3e5\n4 5.5 -6\n", "a.pcd") == two);
  CHECK(parse_points(pcd_header + "DATA ascii\n0.1 -2 3e5\n4 5.5 -6\n", "without_ending") == two);
  std::string binary = pcd_header + "DATA binary\n";
  const std::vector<Vec3d> rounded = {{static_cast<double>(0.1F), -2, 3e5}, {4, 5.5, -6}};
  for (const Vec3d& p : rounded) {
    for (const double x : p) binary += bytes_of(static_cast<float>(x));
  }
  CHECK(parse_points(binary, "a.pcd") == rounded);
  check_refused(
      binary.substr(0, binary.size() - 1), "a.pcd",
      "a.pcd: the file ends before the last point that the header announces; repair the file or write it again");
  check_refused(
      binary + "x", "a.pcd",
      "a.pcd: the file continues after the last point that the header announces; repair the file or write it again");
  // Other fields between, integers and doubles, COUNT and WIDTH alone.
  const std::string mixed =
      "VERSION 0.7\nFIELDS n z x rgb y\nSIZE 1 8 2 4 4\nTYPE U F I F U\nCOUNT 3 1 1 1 1\nWIDTH 1\nHEIGHT 1\n";
  CHECK(parse_points(mixed + "DATA ascii\n9 9 9 0.25 -7 1e9 40\n", "a.pcd") == std::vector<Vec3d>{{-7, 40, 0.25}});
  CHECK(parse_points(mixed + "DATA binary\n" + "\1\2\3" + bytes_of(0.25) + bytes_of(std::int16_t{-7}) + bytes_of(1.0F) +
                         bytes_of(std::uint32_t{4000000000U}),
                     "a.pcd") == std::vector<Vec3d>{{-7, 4e9, 0.25}});
  const auto refused_header = [](const std::string& header, const std::string& message) {
    check_refused(header, "a.pcd", "a.pcd:" + message);
  };
  const std::string repair = "; repair the file or write it again";
  refused_header(pcd_header + "DATA ascii\n1 2 3\n4 5\n",
                 "13: the line has 2 words for 3 values of the fields" + repair);
  refused_header(pcd_header + "DATA ascii\n1 2 3\n",
                 "12: the file ends before the last point that the header announces" + repair);
  refused_header(pcd_header + "DATA ascii\n1 2 3\n1 2 3\n1 2 3\n",
                 "14: the file continues after the last point that the header announces" + repair);
  refused_header(pcd_header, "10: the file ends within the header" + repair);
  refused_header(
      pcd_header + "DATA binary_compressed\n",
      "11: compressed data is not read; write the file with `pcl_convert_pcd_ascii_binary in.pcd out.pcd 1`");
  refused_header("VERSION 0.7\nFIELDS x y\nPOINTS 1\nDATA ascii\n1 2\n", "4: the fields need one z" + repair);
  refused_header("VERSION 0.7\nFIELDS x y z\nSIZE 4 4\n",
                 "3: SIZE needs one word for each of FIELDS, which come first" + repair);
  refused_header("VERSION 0.7\nFIELDS x y z\nSIZE 4 4 3\n", "3: the size of a field is neither 1, 2, 4 nor 8" + repair);
  refused_header("VERSION 0.7\nFIELDS x y z\nDATA ascii\n", "3: the header has no POINTS" + repair);
  refused_header("VERSION 0.7\nFIELDS x y z\nWIDTH 3\nPOINTS 2\nDATA ascii\n",
                 "5: POINTS is not WIDTH times HEIGHT" + repair);
  // A count that the file cannot hold takes no memory.
  refused_header("VERSION 0.7\nFIELDS x y z\nPOINTS 9007199254740992\nDATA binary\n",
                 " the file ends before the last point that the header announces" + repair);
}

TEST_CASE("point files: points that are not finite, other formats, missing files", "[ref][points]") {
  std::size_t left_out = 9;
  LoadPointsOptions options;
  options.points_left_out = &left_out;
  CHECK(parse_points("nan nan nan\n0.1 -2 3e5\n1 inf 3\n4 5.5 -6\n", "a.xyz", options) == two);
  CHECK(left_out == 2);
  options.leave_out_nan = false;
  CHECK_THROWS_WITH(parse_points("1 2 3\nnan nan nan\n", "a.xyz", options),
                    "a.xyz:2: point 1 is not finite; repair the file or write it again");
  check_refused("nan nan nan\n", "a.xyz", "a.xyz: the file holds no points; repair the file or write it again");
  check_refused(
      "LASF", "a.las",
      "a.las: points of this format are not read; write them as PLY, PCD or XYZ, for example with CloudCompare");
  CHECK_THROWS_WITH(load_points("/nowhere/a.xyz"), "/nowhere/a.xyz: no such file; check the path");
}
