// SPDX-License-Identifier: Apache-2.0
// Files of points.
#include <catch2/catch.hpp>
#include <cchip/point_file.hpp>
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

TEST_CASE("point files: XYZ", "[lib][points]") {
  CHECK(parse_points("0.1 -2 3e5\n4 5.5 -6\n", "a.xyz") == two);
  CHECK(parse_points("# x y z r g b\r\n0.1\t-2 3e5 255 0 0\r\n\r\n4 5.5 -6 0 0 0", "a.txt") == two);
  CHECK(parse_points("\xef\xbb\xbf"
                     "0.1 -2 3e5\n4 5.5 -6 # last\n",
                     "a") == two);
  check_refused("1 2 3\n1 2\n", "a.xyz", "a.xyz:2: word 3 of the line is missing; repair the file or write it again");
  check_refused("1 2 3\n\n1 x 2\n", "a.xyz",
                "a.xyz:3: 'x' is not a number; each line holds x, y and z: begin others with #");
  check_refused("# nothing\n", "a.xyz", "a.xyz: the file holds no points; repair the file or write it again");
}

TEST_CASE("point files: text with commas, semicolons and titles", "[lib][points]") {
  for (const char* const text :
       {"0.1,-2,3e5\n4,5.5,-6\n", "0.1, -2, 3e5, 255\n4, 5.5, -6, 0", "0.1;-2;3e5\n4;5.5;-6\n",
        "0.1 ; -2 ; 3e5\n4 ; 5.5 ; -6", "X Y Z Intensity\n0.1 -2 3e5 12\n4 5.5 -6 12\n",
        "//X Y Z R G B\n0.1 -2 3e5 1 2 3\n4 5.5 -6 1 2 3\n", "//X,Y,Z\n0.1,-2,3e5\n4,5.5,-6\n",
        "\"x\",\"y\",\"z\"\n0.1,-2,3e5\n4,5.5,-6\n", "x[m];y[m];z[m]\n0.1;-2;3e5\n4;5.5;-6\n",
        "Intensity,Points:0,Points:1,Points:2\n9,0.1,-2,3e5\n9,4,5.5,-6\n", "i z y x\n0 3e5 -2 0.1\n0 -6 5.5 4\n",
        "# z y x\n3e5 -2 0.1\n-6 5.5 4\n", "# x y z are lengths\n0.1 -2 3e5\n4 5.5 -6\n",
        "#z y x w\n0.1 -2 3e5\n4 5.5 -6\n", "// made by hand\n0.1\t-2\t3e5\n4\t5.5\t-6\n",
        "x\ty\tz\r\n0.1\t-2\t3e5\r\n4\t5.5\t-6\r\n"}) {
    INFO(text);
    CHECK(parse_points(text, "a.txt") == two);
  }
  check_refused("Easting Northing Height\n1 2 3\n", "a.txt",
                "a.txt:1: the title line names no columns x, y and z; name them so, or begin the line with #");
  check_refused("x x y z\n1 2 3 4\n", "a.txt",
                "a.txt:1: the title line names no columns x, y and z; name them so, or begin the line with #");
  check_refused("Scan 7\n1 2 3\n", "a.txt",
                "a.txt:1: 'Scan' is not a number; each line holds x, y and z: begin others with #");
  for (const char* const text : {"1,5 2,5 3,5\n", "1,5;2,5;3,5\n"}) {
    check_refused(text, "a.csv", "a.csv:1: '1,5' has a decimal comma; write a decimal point");
  }
  check_refused("1,2,3\n1,,3\n", "a.csv", "a.csv:2: word 2 of the line is missing; repair the file or write it again");
  check_refused("1,2,3\n1,2\n", "a.csv", "a.csv:2: word 3 of the line is missing; repair the file or write it again");
}

TEST_CASE("point files: PTS and PTX", "[lib][points]") {
  CHECK(parse_points("2\n0.1 -2 3e5 0 117 130 149\n4 5.5 -6 0 1 2 3\n", "a.pts") == two);
  CHECK(parse_points("1\n0.1 -2 3e5\n0\n1\n4 5.5 -6\n", "a.pts") == two);
  check_refused("3\n0.1 -2 3e5\n4 5.5 -6\n", "a.pts",
                "a.pts:3: the file ends after 2 of the 3 points that it announces; repair the file or write it again");
  check_refused(
      "1\n0.1 -2 3e5\n4 5.5 -6\n", "a.pts",
      "a.pts:3: the file continues after the last point that it announces; repair the file or write it again");
  // Two columns of two points, one ray came back from nowhere. Rows of the matrix: where x, y, z and the origin go to.
  const std::string identity = "1 0 0 0\n0 1 0 0\n0 0 1 0\n";
  const std::string header = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  const std::string points = "1 2 3 0.5\n0 0 0 0.5\n4 5 6 0.5\n7 8 9 0.5\n";
  std::size_t left_out = 0;
  LoadPointsOptions options;
  options.points_left_out = &left_out;
  CHECK(parse_points("2\n2\n" + header + identity + "10 20 30 1\n" + points, "a.ptx", options) ==
        std::vector<Vec3d>{{11, 22, 33}, {14, 25, 36}, {17, 28, 39}});
  CHECK(left_out == 1);
  const std::string turned = "1\n1\n" + header + "0 1 0 0\n-1 0 0 0\n0 0 1 0\n0 0 0 1\n1 2 3 0.5 9 9 9\n";
  CHECK(parse_points(turned + turned, "a.ptx") == std::vector<Vec3d>{{-2, 1, 3}, {-2, 1, 3}});
  check_refused("2\n2\n" + header + identity + "0 0 0 1\n1 2 3 0.5\n", "a.ptx",
                "a.ptx:11: the file ends after 1 of the 4 points that it announces; repair the file or write it again");
  check_refused("2\n2\n0 0 0\n1 0 0 0\n", "a.ptx",
                "a.ptx:4: the header of the PTX needs a line with 3 numbers here; repair the file or write it again");
}

TEST_CASE("point files: rounded to single precision if asked for", "[lib][points]") {
  LoadPointsOptions options;
  options.single_precision = true;
  CHECK(parse_points("0.1 2 3\nnan 0 0\n", "a.xyz", options) == std::vector<Vec3d>{{static_cast<double>(0.1F), 2, 3}});
  CHECK_THROWS_WITH(parse_points("0 1e39 0\n", "a.xyz", options),
                    Catch::Contains("beyond the range of single precision"));
}

TEST_CASE("point files: what is no file of points is named", "[lib][points]") {
  CHECK_THROWS_WITH(parse_points("version https://git-lfs.github.com/spec/v1\n", "a.xyz"),
                    Catch::Contains("Git LFS pointer"));
  CHECK_THROWS_WITH(parse_points("<html><body>Not found", "a.pcd"), Catch::Contains("web page"));
}

TEST_CASE("point files: PLY without faces", "[lib][points]") {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n";
  CHECK(parse_points(header + "end_header\n0.1 -2 3e5\n4 5.5 -6\n", "a.ply") == two);
  CHECK(parse_points(header + "end_header\n0.1 -2 3e5\n4 5.5 -6\n", "without_ending") == two);
  CHECK(parse_points(header +
                         "element face 1\nproperty list uchar int vertex_indices\nend_header\n0.1 -2 3e5\n4 5.5 -6\n"
                         "3 0 1 0\n",
                     "a.PLY") == two);
  // PCL writes an element without properties behind the points.
  CHECK(parse_points(header + "element face 0\nend_header\n0.1 -2 3e5\n4 5.5 -6\n", "a.ply") == two);
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

TEST_CASE("point files: PCD", "[lib][points]") {
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

TEST_CASE("point files: compressed PCD", "[lib][points]") {
  // Fields one after the other: x of all points, then y, then z, as floats.
  const auto with = [](const std::string& packed, std::uint32_t unpacked = 24) {
    return pcd_header + "DATA binary_compressed\n" + bytes_of(static_cast<std::uint32_t>(packed.size())) +
           bytes_of(unpacked) + packed;
  };
  std::string values;
  for (const float x : {1.0F, 1.0F, 2.0F, 2.0F, 3.0F, 3.0F}) values += bytes_of(x);
  const std::vector<Vec3d> expected = {{1, 2, 3}, {1, 2, 3}};
  // As they are; then each second float as a copy of four bytes, four before; then lengths in a byte of their own.
  CHECK(parse_points(with(std::string(1, '\x17') + values), "a.pcd") == expected);
  std::string copies;
  for (std::size_t i = 0; i < 3; ++i) copies += '\3' + values.substr(8 * i, 4) + std::string("\x40\3", 2);
  CHECK(parse_points(with(copies), "a.pcd") == expected);
  const std::string repeat = '\3' + bytes_of(1.0F) + std::string("\xe0\x0b\3", 3);
  CHECK(parse_points(with(repeat), "a.pcd") == std::vector<Vec3d>{{1, 1, 1}, {1, 1, 1}});
  const std::string repair = "a.pcd: the compressed data is damaged; copy or download the file again";
  for (const std::string& damaged :
       {std::string(1, '\x17') + values.substr(1), std::string(1, '\x16') + values.substr(1),
        std::string(1, '\x18') + values + "x", copies + copies, copies.substr(0, copies.size() - 1),
        std::string("\x40\3", 2) + copies, '\3' + bytes_of(1.0F) + std::string("\xe0\x0c\3", 3),
        '\3' + bytes_of(1.0F) + std::string("\xe0\x0b\4", 3), '\3' + bytes_of(1.0F) + "\xe0",
        '\3' + bytes_of(1.0F) + std::string("\x5f\xff", 2), std::string()}) {
    CHECK_THROWS_WITH(parse_points(with(damaged), "a.pcd"), repair);
  }
  check_refused(
      with(copies, 36), "a.pcd",
      "a.pcd: the compressed data has 36 bytes, which are not 2 points of 12 bytes; repair the file or write it again");
  const std::string cut =
      "a.pcd: the file ends before the last point that the header announces; repair the file or write it again";
  check_refused(with(copies).substr(0, with(copies).size() - 1), "a.pcd", cut);
  check_refused(pcd_header + "DATA binary_compressed\n1234567", "a.pcd", cut);
  check_refused(
      with(copies) + "x", "a.pcd",
      "a.pcd: the file continues after the last point that the header announces; repair the file or write it again");
  // A count that the data cannot hold takes no memory.
  const std::string many =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 300000000\nDATA binary_compressed\n";
  check_refused(many + bytes_of(std::uint32_t{3}) + bytes_of(std::uint32_t{3600000000U}) + "abc", "a.pcd", repair);
}

TEST_CASE("point files: points that are not finite, other formats, missing files", "[lib][points]") {
  std::size_t left_out = 9;
  LoadPointsOptions options;
  options.points_left_out = &left_out;
  CHECK(parse_points("nan nan nan\n0.1 -2 3e5\n1 inf 3\n4 5.5 -6\n", "a.xyz", options) == two);
  CHECK(left_out == 2);
  options.leave_out_nan = false;
  CHECK_THROWS_WITH(parse_points("1 2 3\nnan nan nan\n", "a.xyz", options),
                    "a.xyz:2: point 1 is not finite; repair the file or write it again");
  check_refused("nan nan nan\n", "a.xyz", "a.xyz: the file holds no points; repair the file or write it again");
  CHECK_THROWS_WITH(parse_points("LASF", "a.las"),
                    Catch::Contains("a.las: is LAS, which is not read; write its points as text"));
  check_refused("solid x", "a.stl", "a.stl: is STL, a mesh; name the file of points first and the mesh behind it");
  check_refused("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj",
                "a.obj: is a mesh (OBJ with faces); name the file of points first and the mesh behind it");
  CHECK(parse_points("v 0.1 -2 3e5\nv 4 5.5 -6\n", "a.obj") == two);
  CHECK(parse_points("OFF 2 0 0\n0.1 -2 3e5\n4 5.5 -6\n", "a.off") == two);
  CHECK_THROWS_WITH(load_points("/nowhere/a.xyz"), "/nowhere/a.xyz: no such file; check the path");
}
