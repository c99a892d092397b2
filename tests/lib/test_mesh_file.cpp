// SPDX-License-Identifier: Apache-2.0
// Mesh files, some of them from third parties (Debian package assimp-testmodels).
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <cchip/mesh_file.hpp>
#include <clocale>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <locale>
#include <sstream>
#include <thread>

using cchip::load_mesh;
using cchip::Mesh;
using cchip::Vec3d;

namespace {

const std::string models = "/usr/share/assimp/models/";

/// A folder that is deleted with its object.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_(std::filesystem::temp_directory_path() / ("cchip_mesh_" + std::to_string(getpid()))) {
    std::filesystem::create_directory(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string write(const std::string& name, const std::string& content) const {
    const std::string file = path_ / name;
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }
  std::string file(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// While it lives, this process gets at most 64 MB of additional memory; sanitizers need terabytes, so do not use it
/// with them.
class MemoryLimit {
 public:
  MemoryLimit() {
    getrlimit(RLIMIT_AS, &before_);
#if !defined(__SANITIZE_ADDRESS__)
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit limited = before_;
    limited.rlim_cur = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + (std::size_t{64} << 20);
    setrlimit(RLIMIT_AS, &limited);
#endif
  }
  ~MemoryLimit() { setrlimit(RLIMIT_AS, &before_); }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  rlimit before_{};
};

struct Extent {
  Vec3d least;
  Vec3d greatest;
};

Extent extent(const Mesh& mesh) {
  Extent e{mesh.vertices.at(0), mesh.vertices.at(0)};
  for (const Vec3d& p : mesh.vertices) {
    e.least = e.least.cwiseMin(p);
    e.greatest = e.greatest.cwiseMax(p);
  }
  return e;
}

std::string message_of(const std::string& path) {
  try {
    load_mesh(path);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

/// Face count that an OFF file states itself.
std::size_t faces_stated_by_off(const std::string& path) {
  std::ifstream file(path);
  std::string magic;
  std::size_t vertices = 0;
  std::size_t faces = 0;
  file >> magic >> vertices >> faces;
  REQUIRE(magic == "OFF");
  return faces;
}

}  // namespace

TEST_CASE("mesh file: one model in four formats", "[lib][mesh_file]") {
  const Mesh off = load_mesh(models + "OFF/Wuson.off");
  CHECK(off.faces.size() == faces_stated_by_off(models + "OFF/Wuson.off"));
  const Extent expected = extent(off);
  for (const char* name : {"OBJ/WusonOBJ.obj", "PLY/Wuson.ply", "STL/Wuson.stl"}) {
    INFO(name);
    const Mesh mesh = load_mesh(models + name);
    CHECK(mesh.faces.size() == off.faces.size());
    const Extent e = extent(mesh);
    CHECK((e.least - expected.least).norm() < 1e-4);
    CHECK((e.greatest - expected.greatest).norm() < 1e-4);
  }
}

TEST_CASE("mesh file: text and binary STL hold the same model", "[lib][mesh_file]") {
  const Mesh text = load_mesh(models + "STL/Spider_ascii.stl");
  const Mesh binary = load_mesh(models + "STL/Spider_binary.stl");
  REQUIRE(text.faces.size() == binary.faces.size());
  double worst = 0;
  for (std::size_t i = 0; i < text.faces.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      worst = std::max(worst, (text.primitive(i).v[k] - binary.primitive(i).v[k]).norm());
    }
  }
  CHECK(worst < 1e-3);
}

TEST_CASE("mesh file: several parts become one mesh", "[lib][mesh_file]") {
  const Mesh spider = load_mesh(models + "OBJ/spider.obj");
  CHECK(spider.faces.size() == load_mesh(models + "STL/Spider_ascii.stl").faces.size());
  for (const Mesh::Face& face : spider.faces) {
    REQUIRE(face.kind == cchip::Kind::tri);
    for (std::size_t i = 0; i < 3; ++i) REQUIRE(face.vertex[i] < spider.vertices.size());
  }
}

TEST_CASE("mesh file: polygons are cut into triangles, lines and points dropped", "[lib][mesh_file]") {
  const TemporaryFolder folder;
  const Mesh mesh = load_mesh(folder.write("mixed.obj",
                                           "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 2 6 0\n"
                                           "f 1 2 3 4\nf 4 3 5\nl 1 5\np 2\n"));
  CHECK(mesh.faces.size() == 3);
  double area = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const cchip::Primitive p = mesh.primitive(i);
    area += (p.v[1] - p.v[0]).cross(p.v[2] - p.v[0]).norm() / 2;
  }
  CHECK(area == Approx(16 + 4));
}

TEST_CASE("mesh file: quads are kept if asked for, other polygons cut", "[lib][mesh_file]") {
  using cchip::FaceKinds;
  using cchip::Kind;
  const TemporaryFolder folder;
  // In this order: point, quad, triangle, line, pentagon, quad with a dent, quad.
  const std::string file = folder.write("mixed.obj",
                                        "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 2 6 0\nv 3 3 0\nv 0 0 4\nv 4 0 4\n"
                                        "p 2\nf 1 2 3 4\nf 4 3 5\nl 1 5\nf 1 2 3 5 4\nf 2 3 4 6\nf 1 2 8 7\n");
  const Mesh mesh = load_mesh(file, FaceKinds::triangles_and_quads);
  CHECK(mesh.polygons_cut == 2);
  REQUIRE(mesh.faces.size() == 2 + 1 + 3 + 2);
  std::vector<std::vector<Vec3d>> quads;
  double area = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const cchip::Primitive p = mesh.primitive(i);
    if (p.kind == Kind::quad) quads.emplace_back(p.v.begin(), p.v.end());
    if (p.kind == Kind::tri) area += (p.v[1] - p.v[0]).cross(p.v[2] - p.v[0]).norm() / 2;
  }
  REQUIRE(quads.size() == 2);
  CHECK(quads[0] == std::vector<Vec3d>{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  CHECK(quads[1] == std::vector<Vec3d>{{0, 0, 0}, {4, 0, 0}, {4, 0, 4}, {0, 0, 4}});
  CHECK(area == Approx(4 + 20 + 4));  // the dent is left out

  const Mesh triangles = load_mesh(file);
  CHECK(triangles.polygons_cut == 4);
  CHECK(triangles.faces.size() == 2 + 1 + 3 + 2 + 2);
  for (const Mesh::Face& face : triangles.faces) CHECK(face.kind == Kind::tri);
}

TEST_CASE("mesh file: a box of quads that somebody else made", "[lib][mesh_file]") {
  const Mesh box = load_mesh(models + "OBJ/box.obj", cchip::FaceKinds::triangles_and_quads);
  REQUIRE(box.faces.size() == 6);
  CHECK(box.polygons_cut == 0);
  double area = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const cchip::Primitive p = box.primitive(i);
    REQUIRE(p.kind == cchip::Kind::quad);
    area += (p.v[2] - p.v[0]).cross(p.v[3] - p.v[1]).norm() / 2;
  }
  const Vec3d size = extent(box).greatest - extent(box).least;
  CHECK(area == Approx(2 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x())));
  CHECK(load_mesh(models + "OBJ/box.obj").faces.size() == 12);
}

namespace {

// --- files that the tests make

using Triangle = std::array<Vec3d, 3>;

std::string digits(double x) {
  std::ostringstream text;
  text << std::setprecision(17) << x;
  return text.str();
}

std::string to_line(const Vec3d& v) { return digits(v.x()) + " " + digits(v.y()) + " " + digits(v.z()) + "\n"; }

template <class Number>
std::string to_bytes(Number value, bool big_endian = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);  // the machines of the tests are little endian
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::string obj_of(const Triangle& t) {
  return "v " + to_line(t[0]) + "v " + to_line(t[1]) + "v " + to_line(t[2]) + "f 1 2 3\n";
}

std::string off_of(const Triangle& t) {
  return "OFF\n3 1 0\n" + to_line(t[0]) + to_line(t[1]) + to_line(t[2]) + "3 0 1 2\n";
}

std::string ply_header(const std::string& format, std::uint64_t vertices, std::uint64_t faces,
                       const std::string& type = "double", const std::string& list = "uchar int") {
  return "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(vertices) + "\nproperty " + type +
         " x\nproperty " + type + " y\nproperty " + type + " z\nelement face " + std::to_string(faces) +
         "\nproperty list " + list + " vertex_indices\nend_header\n";
}

std::string ascii_ply_of(const Triangle& t) {
  return ply_header("ascii", 3, 1) + to_line(t[0]) + to_line(t[1]) + to_line(t[2]) + "3 0 1 2\n";
}

std::string binary_ply_of(const Triangle& t, bool big_endian) {
  std::string text = ply_header(big_endian ? "binary_big_endian" : "binary_little_endian", 3, 1);
  for (const Vec3d& v : t) {
    for (int i = 0; i < 3; ++i) text += to_bytes(v[i], big_endian);
  }
  text += '\3';
  for (std::int32_t i = 0; i < 3; ++i) text += to_bytes(i, big_endian);
  return text;
}

std::string ascii_stl_of(const Triangle& t) {
  return "solid t\nfacet normal 0 0 1\nouter loop\nvertex " + to_line(t[0]) + "vertex " + to_line(t[1]) + "vertex " +
         to_line(t[2]) + "endloop\nendfacet\nendsolid t\n";
}

std::string binary_stl(std::uint32_t announced, std::size_t triangles) {
  std::string text(80, 's');
  text += to_bytes(announced);
  for (std::size_t i = 0; i < triangles; ++i) {
    for (const float x : {0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) text += to_bytes(x);
    text += std::string(2, '\0');
  }
  return text;
}

/// A strip of quads, each cut into two triangles.
std::string large_ascii_ply() {
  constexpr int vertices = 15000;
  std::string text = ply_header("ascii", vertices, vertices - 2);
  for (int i = 0; i < vertices; ++i) text += to_line(Vec3d(i / 2, i % 2, 0.25));
  for (int i = 0; i + 2 < vertices; ++i) {
    text += "3 " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 2) + "\n";
  }
  return text;
}

const Triangle ground = {Vec3d(0, 0, 1), Vec3d(4, 0, 1), Vec3d(0, 4, 1)};
const Triangle just_above = {Vec3d(0, 0, 1.000000001), Vec3d(4, 0, 1.000000001), Vec3d(0, 4, 1.000000001)};

}  // namespace

TEST_CASE("mesh file: positions are the doubles of the file", "[lib][mesh_file]") {
  const TemporaryFolder folder;
  const auto both = [&](const std::string& name, const std::string& low, const std::string& high) {
    INFO(name);
    const Mesh a = load_mesh(folder.write("low_" + name, low));
    const Mesh b = load_mesh(folder.write("high_" + name, high));
    REQUIRE(a.faces.size() == 1);
    REQUIRE(b.faces.size() == 1);
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(a.primitive(0).v[i] == ground[i]);
      CHECK(b.primitive(0).v[i] == just_above[i]);
    }
    CHECK_FALSE(cchip::exact_intersects(a.primitive(0), b.primitive(0)));
    CHECK(cchip::exact_intersects(a.primitive(0), a.primitive(0)));
  };
  both("t.obj", obj_of(ground), obj_of(just_above));
  both("t.off", off_of(ground), off_of(just_above));
  both("ascii.ply", ascii_ply_of(ground), ascii_ply_of(just_above));
  both("little.ply", binary_ply_of(ground, false), binary_ply_of(just_above, false));
  both("big.ply", binary_ply_of(ground, true), binary_ply_of(just_above, true));
  both("ascii.stl", ascii_stl_of(ground), ascii_stl_of(just_above));
}

TEST_CASE("mesh file: a large PLY that was cut is refused", "[lib][mesh_file]") {
  const TemporaryFolder folder;
  const std::string whole = large_ascii_ply();
  CHECK(load_mesh(folder.write("whole.ply", whole)).faces.size() == 14998);
  const std::size_t face_list = whole.find("3 0 1 2\n");
  for (const std::size_t length : {std::size_t{100}, std::size_t{5000}, face_list, face_list + 8, whole.size() - 7}) {
    CAPTURE(length);
    CHECK(message_of(folder.write("cut.ply", whole.substr(0, length))).find("cut.ply") != std::string::npos);
  }
}

TEST_CASE("mesh file: a file cut anywhere is refused", "[lib][mesh_file]") {
  const TemporaryFolder folder;
  // What comes after the last corner or the last keyword says nothing about the mesh. A truncated decimal number cannot
  // be detected, so the text files here end right after the last digit that must be present.
  struct File {
    std::string name;
    std::string content;
    std::size_t needed;
  };
  const std::string stl = ascii_stl_of(ground);
  const std::vector<File> files = {
      {"t.off", off_of(ground), off_of(ground).size() - 1},
      {"ascii.ply", ascii_ply_of(ground), ascii_ply_of(ground).size() - 1},
      {"little.ply", binary_ply_of(ground, false), binary_ply_of(ground, false).size()},
      {"big.ply", binary_ply_of(ground, true), binary_ply_of(ground, true).size()},
      {"ascii.stl", stl, stl.find("endsolid") + 8},
      {"binary.stl", binary_stl(2, 2), binary_stl(2, 2).size()},
      {"t.obj", obj_of(ground), obj_of(ground).size() - 1},
  };
  for (const File& file : files) {
    const std::string path = folder.write(file.name, file.content.substr(0, file.needed));
    INFO(file.name);
    CHECK(message_of(path) == "no error");
    for (std::size_t length = 0; length < file.needed; ++length) {
      CAPTURE(length);
      REQUIRE(message_of(folder.write(file.name, file.content.substr(0, length))) != "no error");
    }
  }
}

TEST_CASE("mesh file: a count that the file cannot hold is refused at once", "[lib][mesh_file]") {
  const TemporaryFolder folder;
  const std::string many = "1000000000000";
  const std::string three = "0 0 0\n1 0 0\n0 1 0\n";
  const std::vector<std::pair<std::string, std::string>> files = {
      {"vertices.off", "OFF\n" + many + " 1 0\n" + three + "3 0 1 2\n"},
      {"faces.off", "OFF\n3 " + many + " 0\n" + three + "3 0 1 2\n"},
      {"corners.off", "OFF\n3 1 0\n" + three + "4000000000 0 1 2\n"},
      {"vertices.ply", ply_header("ascii", 1000000000000, 1) + three + "3 0 1 2\n"},
      {"faces.ply", ply_header("ascii", 3, 1000000000000) + three + "3 0 1 2\n"},
      {"corners.ply", ply_header("ascii", 3, 1, "float", "uint int") + three + "4000000000 0 1 2\n"},
      {"corners_binary.ply", ply_header("binary_little_endian", 1, 1, "float", "uint int") + std::string(12, '\0') +
                                 to_bytes(std::uint32_t{4000000000}) + to_bytes(0)},
      {"vertices_binary.ply", ply_header("binary_little_endian", 1000000000000, 1) + std::string(12, '\0')},
      {"nothing.ply", "ply\nformat ascii 1.0\nelement nothing " + many +
                          "\nelement vertex 3\nproperty float x\n"
                          "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                          "end_header\n" +
                          three + "3 0 1 2\n"},
      {"binary.stl", binary_stl(4000000000, 2)},
  };
  for (const auto& [name, content] : files) {
    INFO(name);
    CHECK(content.size() < 300);
    const MemoryLimit limit;
    const std::string message = message_of(folder.write(name, content));
    CAPTURE(message);
    CHECK(message.find(name) != std::string::npos);
    CHECK(message.find("bad_alloc") == std::string::npos);
  }
}

TEST_CASE("mesh file: errors are one line with file, line, cause and remedy", "[lib][mesh_file]") {
  const TemporaryFolder folder;
  const auto check = [](const std::string& path, const std::string& place_and_cause, const char* remedy = "; ") {
    const std::string message = message_of(path);
    INFO(message);
    CHECK(message.rfind(path + place_and_cause + remedy, 0) == 0);
    CHECK(message.find('\n') == std::string::npos);
  };
  const std::string gone = ": no such file";
  check(folder.file("absent.obj"), gone);
  check(folder.file(""), ": is a folder");
  check("/dev/null", ": is a device, not a file or a pipe");
  check(folder.write("empty.obj", ""), ": the file is empty (0 bytes)");
  check(folder.write("part.step", "ISO-10303-21;"), ": is STEP (surfaces of CAD, not a mesh), which is not read",
        "; mesh it first, for example with `gmsh -2 part.step -o part.stl`");
  check(folder.write("scene.dae", "<COLLADA>"), ": is COLLADA, which is not read", "; convert it to PLY with MeshLab");
  for (const char* const name : {"scene.glb", "scene.gltf", "no_end"}) {
    check(folder.write(name, "glTF"), ": is glTF, which is not read",
          "; `cchip clash` judges the parts of .glb, .gltf and .3mf files; for one mesh convert it with trimesh");
  }
  // 3MF is a folder packed by zip.
  for (const char* const name : {"real.3mf", "REAL.3MF"}) {
    check(folder.write(name, "PK\3\4 and so on"), ": is 3MF, which is not read",
          "; `cchip clash` judges the parts of .glb, .gltf and .3mf files; for one mesh convert it with trimesh");
  }
  check(folder.write("notes.txt", "hello\n"), ": cannot be read as a mesh");
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const auto obj = [&](const std::string& text) { return folder.write("t.obj", text); };
  check(obj("v 0 0 0\nv 1 0 0\nl 1 2\np 1\n"), ": the file holds no faces, only 2 vertices");
  check(obj(three + "f 1 2 4\n"), ":4: face 0: vertex index 4 is out of range (the mesh has 3 vertices)");
  check(obj(three + "f 1 2 3\nf 1 2 0\n"),
        ":5: face 1: vertex index 0 is out of range (the mesh has 3 vertices so far)");
  check(obj(three + "f 1 2 -4\n"), ":4: face 0: vertex index -4 is out of range (the mesh has 3 vertices so far)");
  check(obj(three + "f 1 2 1e30\n"), ":4: face 0: vertex index 1e+30 is out of range (the mesh has 3 vertices so far)");
  check(obj(three + "f 1 2 1.5\n"), ":4: face 0: vertex index 1.5 is not a whole number");
  check(obj(three + "f 1 2 3x\n"), ":4: '3x' is not a number");
  check(obj(three + "f 1/1 2/2 3/x\n"), ":4: 'x' is not a number");
  check(obj(three + "\nf 1 2\n"), ":5: face 0 has fewer than three corners");
  check(obj(three + "f 1 2 \\\n\\\n3 9\n"), ":4: face 0: vertex index 9 is out of range (the mesh has 3 vertices)");
  check(obj("v 0 0\n"), ":1: word 4 of the line is missing");
  check(obj("v 0 0 1junk\n"), ":1: '1junk' is not a number");
  check(obj("v 0 0 1,5\n"), ":1: '1,5' has a decimal comma; write a decimal point", "");
  const std::string fourth = three + "f 1 2 3\nv ";
  check(obj(fourth + "0 0 nan\nf 1 2 4\n"), ":5: vertex 3 is not finite, and face 1 uses it");
  check(obj(fourth + "0 0 -inf\nf 1 2 4\n"), ":5: vertex 3 is not finite, and face 1 uses it");
  check(obj(fourth + "0 0 1e400\nf 1 2 4\n"), ":5: vertex 3 is not finite, and face 1 uses it");
  check(obj(fourth + "0 0 0 2\nf 1 2 4\n"), ":5: vertex 3 has a weight other than 1, and face 1 uses it");
  check(obj(three + "surf 0 1 0 1\n"), ":4: 'surf' is a statement of free-form surfaces, which are not read");
  check(obj(three + "vc 1 0 0\n"), ":4: 'vc' is no statement of OBJ", "; check the name of the file, or leave such");
  const auto off = [&](const std::string& text) { return folder.write("t.off", text); };
  const std::string square = "0 0 0\n1 0 0\n0 1 0\n";
  check(off("OFT\n3 1 0\n"), ":1: the file does not begin with OFF");
  check(off("OFF BINARY\n"), ":1: binary OFF is not read");
  check(off("4OFF\n3 1 0\n"), ":1: coordinates other than x, y, z are not read");
  check(off("nOFF\n3\n3 1 0\n"), ":1: coordinates other than x, y, z are not read");
  check(off("OFF\n3 -1 0\n"), ":2: '-1' is not a count");
  check(off("OFF\n3\n"), ":2: the counts of vertices and faces are missing");
  check(off("OFF\n3 1 0\n" + square + "3 0 1 3\n"),
        ":6: face 0: vertex index 3 is out of range (the mesh has 3 vertices)");
  check(off("OFF\n3 1 0\n" + square + "3 0 1\n"), ":6: word 4 of the line is missing");
  check(off("OFF\n3 1 0\n" + square + "2 0 1\n"), ": the file holds no faces");
  check(off("OFF\n3 2 0\n" + square + "3 0 1 2\n"), ":6: the file ends before face 1 of 2");
  check(off("OFF\n3 1 0\n" + square + "3 0 1 2\n3 0 1 2\n"),
        ":7: the file continues after the last face that it announces");
  check(off("OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), ":4: vertex 1 is not finite, and face 0 uses it");
  const auto ply = [&](const std::string& text) { return folder.write("t.ply", text); };
  const std::string short_ply = "the file ends before the last value that the header announces";
  check(ply(ply_header("ascii", 3, 2) + square + "3 0 1 7\n3 0 1 2\n"),
        ":13: face 0: vertex index 7 is out of range (the mesh has 3 vertices)");
  check(ply(ply_header("ascii", 3, 1) + square + "3 0 1 -1\n"),
        ":13: face 0: vertex index -1 is out of range (the mesh has 3 vertices so far)");
  check(ply(ply_header("ascii", 3, 1) + square + "3 0 1\n"), ":13: " + short_ply);
  check(ply(ply_header("ascii", 3, 1) + square + "-3 0 1 2\n"), ":13: the count of a list is wrong");
  check(ply(ply_header("ascii", 3, 1) + square + "3 0 1 2\n3 0 1 2\n"),
        ":14: the file continues after the last value that the header announces");
  check(ply(ply_header("binary_big_endian", 3, 1) + square), ": " + short_ply);
  check(ply(ply_header("ebcdic", 3, 1)), ":2: the format is unknown");
  check(ply(ply_header("ascii", 3, 1, "half")), ":4: the type of the property is unknown");
  check(ply("ply\nformat ascii 1.0\nelement vertex 3\n"), ":3: the file ends within the header");
  check(ply("ply\nformat ascii 1.0\nelement vertex\nend_header\n"),
        ":3: the line is not complete or stands in a wrong place");
  check(ply("ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nend_header\n1\n"),
        ": the vertices need one property y");
  check(ply("ply\nformat ascii 1.0\nelement face 1\nproperty int x\nend_header\n1\n"),
        ": the faces need one list vertex_indices");
  check(ply(ply_header("binary_little_endian", 1, 1) + to_bytes(0.0) + to_bytes(0.0) +
            to_bytes(std::numeric_limits<double>::infinity()) + '\3' + std::string(12, '\0')),
        ": vertex 0 is not finite, and face 0 uses it");
  const auto stl = [&](const std::string& text) { return folder.write("t.stl", text); };
  check(stl(binary_stl(3, 2)), ": the header announces 234 bytes, the file has 184");
  check(stl("short"), ": the file ends within the header of a binary STL");
  check(stl("solid x\nfacet normal 0 0 1\n"), ":2: 'outer' is missing");
  check(stl("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n"), ":5: 'vertex' is missing");
  check(stl("solid x\nendsolid x\n"), ": the file holds no faces");
  // formats under the names of others
  const char* const no_obj = " is no statement of OBJ; this looks like ";
  CHECK_THAT(message_of(obj(binary_stl(2, 2))),
             Catch::Contains(no_obj + std::string("binary STL: let the name end with .stl")));
  check(obj("solid x\nendsolid x\n"), ":1: 'solid'", (no_obj + std::string("STL: let the name end with .stl")).c_str());
  check(obj("OFF\n3 1 0\n"), ":1: 'OFF'", (no_obj + std::string("OFF: let the name end with .off")).c_str());
  check(stl(ply_header("ascii", 3, 1)), ": the", " header announces ");
  CHECK(message_of(folder.file("t.stl")).find("; this looks like PLY: let the name end with .ply") !=
        std::string::npos);
}

TEST_CASE("mesh file: a pipe is read like a file", "[lib][mesh_file]") {
  const TemporaryFolder folder;
  const std::string pipe = folder.file("pipe.obj");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::string text;  // more than a pipe holds, and than is read at once
  for (int i = 0; i < 20000; ++i) text += "v " + std::to_string(i) + " 0 1\n";
  text += "v 0 7 0\nf 1 2 -1\n";
  std::thread writer([&] { std::ofstream(pipe) << text; });
  const Mesh mesh = load_mesh(pipe);
  writer.join();
  CHECK(mesh.vertices.size() == 20001);
  CHECK(mesh.primitive(0).v[2] == Vec3d(0, 7, 0));
}

TEST_CASE("mesh file: a file is held once while it is read", "[lib][mesh_file]") {
  const TemporaryFolder folder;
  // 40 MB of comment, which leave nothing in the mesh. The limit of 64 MB would not hold a second copy.
  const std::string file =
      folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + std::string(std::size_t{40} << 20, '#') + "\n");
  const MemoryLimit limit;
  CHECK(load_mesh(file).faces.size() == 1);
}

TEST_CASE("mesh file: what the formats allow", "[lib][mesh_file]") {
  const TemporaryFolder folder;
  const auto corners = [&](const std::string& name, const std::string& content) {
    INFO(name);
    const Mesh mesh = load_mesh(folder.write(name, content));
    REQUIRE(mesh.faces.size() == 1);
    const cchip::Primitive p = mesh.primitive(0);
    CHECK(p.v[0] == Vec3d(0, 0, 0.1));
    CHECK(p.v[1] == Vec3d(1, 0, 0));
    CHECK(p.v[2] == Vec3d(0, 1e300, 5e-324));
  };
  const std::string v1 = "0 0 0.1";
  const std::string v2 = "1 -0 0";
  const std::string v3 = "0 +1E300 5e-324";
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
      text.replace(at, from.size(), to);
    }
    return text;
  };
  const std::string obj = "# f 1 1 1\nmtllib m\no thing\nv " + v1 + " # one\n\nv " + v2 + " 1\nvn 0 0 1\nvt 0 0\nv " +
                          v3 + " 0.5 0.5 0.5\ng a b\ns off\nusemtl m\n";
  corners("plain.obj", obj + "f 1 2 3\n");
  corners("no_end.obj", obj + "f 1 2 3");
  corners("tabs.obj", obj + "f\t1\t2\t3\n");
  corners("texture.obj", obj + "f 1/1 2/1 3/1\n");
  corners("normal.obj", obj + "f 1//1 2//1 3//1\n");
  corners("both.obj", obj + "f 1/1/1 2/1/1 3/1/1\nl 1 2\np 1\n");
  corners("back.obj", obj + "f -3 -2 -1\n");
  corners("continued.obj", obj + "f 1 \\\n 2 \\\n 3\n");
  corners("dos.OBJ", with(obj + "f 1 2 3\n", "\n", "\r\n"));
  const std::string off = "\n" + v1 + "\n# here\n\n" + v2 + "\n" + v3 + "\n";
  corners("plain.off", "OFF\n3 1 0" + off + "3 0 1 2\n");
  corners("one_line.off", "OFF 3 1 0 # counts" + off + "3 0 1 2 # last\n");
  corners("colours.off", "COFF\n3 1 0\n" + v1 + " 1 0 0 1\n" + v2 + " 1 0 0 1\n" + v3 + " 1 0 0 1\n3 0 1 2 255 0 0\n");
  corners("normals.off", "NOFF\n3 1 0\n" + v1 + " 0 0 1\n" + v2 + " 0 0 1\n" + v3 + " 0 0 1\n3 0 1 2\n");
  corners("all.off", "STCNOFF\n3 1\n" + v1 + " 0 0 1\n" + v2 + " 0 0 1\n" + v3 + " 0 0 1\n3 0 1 2\n");
  corners("dos.off", with("OFF\n3 1 0" + off + "3 0 1 2\n", "\n", "\r\n"));
  corners("off_without_end", "OFF\n3 1 0" + off + "3 0 1 2\n");
  const std::string rich_ply =
      "ply\nformat ascii 1.0\ncomment element vertex 9\nobj_info x\nMade by hand\nelement camera 1\nproperty float "
      "f\nproperty list "
      "uchar float k\nelement vertex 3\nproperty uchar red\nproperty float32 x\nproperty float64 y\nproperty float z\n"
      "property list int int near\nelement face 1\nproperty list uint8 int texture\nproperty list uint32 uint16 "
      "vertex_index\nproperty float quality\nend_header\n1.5 2 nan 4\n255 " +
      v1 + " 0\n1 " + v2 + " 1 7\n2 " + v3 + " 2 7 8\n0 3 0 1 2 nan\n";
  corners("rich.ply", rich_ply);
  corners("dos.ply", with(rich_ply, "\n", "\r\n"));
  corners("ply_without_end", rich_ply);
  const std::string stl =
      "facet normal nan 0 0\nouter loop\nvertex " + v1 + "\nvertex " + v2 + "\nvertex " + v3 + "\nendloop\nendfacet\n";
  corners("named.stl", "solid facet of a file\n" + stl + "endsolid facet of a file\n");
  corners("capitals.stl", "SOLID\n" + with(stl, "facet", "FACET") + "ENDSOLID\n");
  corners("two.stl", "solid a\nendsolid a\n\n  solid b\n" + stl + "endsolid\n");
  corners("dos.stl", with("solid a\n" + stl + "endsolid a\n", "\n", "\r\n"));
  corners("stl_without_end", "solid a\n" + stl + "endsolid a\n");
}

TEST_CASE("mesh file: line ends, byte order marks and padding mean nothing", "[lib][mesh_file]") {
  const auto with_ends = [](const std::string& text, const std::vector<std::string>& ends) {
    std::string result;
    std::size_t line = 0;
    for (const char c : text) result += c == '\n' ? ends[line++ % ends.size()] : std::string(1, c);
    return result;
  };
  const std::string corner_lines = "0 0 1\n4 0 1\n0 4 1\n";
  const std::vector<std::pair<std::string, std::string>> files = {
      {"t.obj", "# made by hand\nv 0 0 1\n\nv 4 0 1\nv 0 4 1\nf 1 2\\\n3\n"},
      {"t.off", "OFF # key\n3 1 0\n" + corner_lines + "3 0 1 2\n"},
      {"t.ply", ply_header("ascii", 3, 1) + corner_lines + "3 0 1 2\n"},
      {"binary.ply", ply_header("binary_little_endian", 3, 1)},
      {"t.stl",
       "solid a solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 4 0 1\nvertex 0 4 1\nendloop\n"
       "endfacet\nendsolid of facets\n"}};
  const std::string binary = binary_ply_of(ground, false).substr(ply_header("binary_little_endian", 3, 1).size());
  for (const auto& [name, text] : files) {
    for (const std::vector<std::string>& ends : std::vector<std::vector<std::string>>{
             {"\n"}, {"\r\n"}, {"\r"}, {"\r", "\n"}, {"\n", "\r", "\r\n"}, {"\r\n", "\r"}}) {
      for (const std::string mark : {"", "\xef\xbb\xbf"}) {
        for (const std::string& padding :
             {std::string(), std::string("\x1a"), std::string(500, '\0'), std::string("\r\n \x1a\0\0\n", 7)}) {
          INFO(name << " " << ends.size() << " " << mark.size() << " " << padding.size());
          const bool is_binary = name == "binary.ply";
          if (is_binary && (ends.size() > 1 || !padding.empty())) continue;
          const std::string content = mark + with_ends(text, ends) + (is_binary ? binary : padding);
          const Mesh mesh = cchip::parse_mesh(content, name);
          REQUIRE(mesh.faces.size() == 1);
          for (std::size_t i = 0; i < 3; ++i) CHECK(mesh.primitive(0).v[i] == ground[i]);
          if (name != "t.obj") CHECK(cchip::parse_mesh(content, "-").faces.size() == 1);  // by its first word
        }
      }
    }
  }
  // The first byte of binary values is no end of a line that ends with CR.
  std::string values = to_bytes(std::uint8_t{10}) + std::string(11, '\1');
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty uchar x\nproperty uchar y\n"
      "property uchar z\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
  values += std::string("\3\0\1\2", 4);
  CHECK(cchip::parse_mesh(with_ends(header, {"\r"}) + values, "t.ply").vertices[0] == Vec3d(10, 1, 1));
  CHECK(cchip::parse_mesh(with_ends(header, {"\n"}) + values, "t.ply").vertices[0] == Vec3d(10, 1, 1));
  // Lines are counted by any end.
  try {
    cchip::parse_mesh("v 0 0 0\rv 1 0 0\r\nv 0 1 0\n\rf 1 2 4\r", "t.obj");
    FAIL("no error");
  } catch (const std::runtime_error& error) {
    CHECK(std::string(error.what()).rfind("t.obj:5: face 0: vertex index 4", 0) == 0);
  }
}

TEST_CASE("mesh file: what other programs write, too", "[lib][mesh_file]") {
  // Two triangles, one above the other; which vertex is where is checked for both.
  const auto both = [](const std::string& name, const std::string& content) {
    INFO(name << "\n" << content.substr(0, 300));
    const Mesh mesh = cchip::parse_mesh(content, name);
    REQUIRE(mesh.faces.size() == 2);
    for (std::size_t face = 0; face < 2; ++face) {
      const double z = face == 0 ? 0 : 2;
      CHECK(mesh.primitive(face).v[0] == Vec3d(0, 0, z));
      CHECK(mesh.primitive(face).v[1] == Vec3d(4, 0, z));
      CHECK(mesh.primitive(face).v[2] == Vec3d(0, 4, z));
    }
    return mesh;
  };
  const std::vector<std::string> corners = {"0 0 0", "4 0 0", "0 4 0", "0 0 2", "4 0 2", "0 4 2"};
  const auto vertices = [&](const std::string& before, const std::string& behind) {
    std::string text;
    for (const std::string& corner : corners) text += before + corner + behind;
    return text;
  };
  const std::string faces = "3 0 1 2\n3 3 4 5\n";
  // OFF
  for (const std::string keyword :
       {"OFF6 2 0\n", "OFF 6 2\n", "6 2 0\n", "OFF\n6\n2\n0\n", "OFF\n6 2\n0\n", "OFF 6\n2 0\n"}) {
    both("t.off", keyword + vertices("", "\n") + faces);
    both("t.off", keyword + vertices("", " ") + faces);
    both("t.off", keyword + vertices("", " ") + "\n3 0 1 2 255 0 0\n3 3 4 5 0.5\n");
    both("t.off", keyword + vertices("", "\n") + "3 0 1 2 3 3\n4 5\n");
  }
  both("t.off", "OFF\n6 2 0\n0 0 0 4 0 0\n0 4 0\n0 0 2\n4 0 2 0 4 2\n" + faces);
  for (const std::string keyword :
       {"COFF", "CNOFF", "NCOFF", "NOFF", "STOFF", "NSTOFF", "CSTOFF", "STCNOFF", "STNCOFF"}) {
    std::string more;
    if (keyword.find('N') != std::string::npos) more += " 0 0 1";
    if (keyword.find('C') != std::string::npos) more += " 255 0 0 255";
    if (keyword.find("ST") != std::string::npos) more += " 0.5 0.5";
    both("t.off", keyword + "\n6 2 0\n" + vertices("", more + "\n") + faces);
    both("t.off", keyword + "\n6 2 0\n" + vertices("", more + " ") + faces);
    both("-", keyword + " 6 2 0\n" + vertices("", more + "\n") + faces);
  }
  // points and lines among the faces keep their numbers
  const std::string with_lines = "2 0 1\n1 3\n3 0 1 2\n0\n3 3 4 5\n";
  CHECK(both("t.off", "OFF 6 5 0\n" + vertices("", "\n") + with_lines).file_face == std::vector<std::uint32_t>{2, 4});
  CHECK(both("t.ply", ply_header("ascii", 6, 5) + vertices("", "\n") + with_lines).file_face ==
        std::vector<std::uint32_t>{2, 4});
  // STL
  const auto stl = [&](const std::string& normal, const std::string& loop, const std::string& facet,
                       const std::string& solid) {
    std::string text = "solid s\n";
    for (std::size_t i = 0; i < 6; ++i) {
      if (i % 3 == 0) text += "facet normal " + normal + "\nouter loop\n";
      text += "vertex " + corners[i] + "\n";
      if (i % 3 == 2) text += loop + "\n" + facet + "\n";
    }
    return text + solid + " s\n";
  };
  for (const std::string normal : {"0 0 1", "1.#QNAN -1.#IND 1.#INF", "nan -nan(ind) inf", "0,5 0 0"}) {
    both("t.stl", stl(normal, "endloop", "endfacet", "endsolid"));
    both("t.stl", stl(normal, "end loop", "end facet", "end solid"));
    both("t.stl", stl(normal, "ENDLOOP", "End Facet", "END SOLID"));
  }
  for (const std::string header : {"made by hand", "solid of somebody", "solid\n"}) {
    for (const std::string& behind :
         {std::string(), std::string("xy"), std::string(50, '\1'), std::string(3000, '\0')}) {
      std::string content =
          header + std::string(80 - header.size(), header == "solid\n" ? ' ' : '\0') + to_bytes(std::uint32_t{2});
      for (const float z : {0.F, 2.F}) {
        for (const float x : {0.F, 0.F, 1.F, 0.F, 0.F, z, 4.F, 0.F, z, 0.F, 4.F, z}) content += to_bytes(x);
        content += std::string(2, '\0');
      }
      both("t.stl", content + behind);
    }
  }
  // OBJ
  const std::string v = vertices("v ", "\n");
  both("t.obj", v + "f 1 2\\\n3\nf 4\\\n5\\\n6\n");
  const Mesh curves =
      both("t.obj", v + "v 0 0 nan\nv 1 1 1 0.5\ncstype rat bspline\ndeg 3\ncurv 0 1 1 2 7 8\nparm u 0 0 1 1\n"
                        "ctech cparm 1\nend\nf 1 2 3\nf 4 5 6\n");
  REQUIRE(curves.notes.size() == 1);
  CHECK(curves.notes[0] == "1 curves were left out, the first in line 11");
  // a vertex that no face uses
  const std::string unused = ply_header("ascii", 7, 2) + vertices("", "\n") + "nan inf 0\n" + faces;
  CHECK(both("t.ply", unused).vertices[6] == Vec3d(0, 0, 0));
  // PLY
  const std::string integers =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty int64 x\nproperty int64 y\nproperty int64 z\n"
      "element face 2\nproperty list uint64 int64 vertex_indices\nend_header\n";
  both("t.ply", integers + vertices("", "\n") + faces);
  for (const bool big : {false, true}) {
    std::string content = integers;
    content.replace(content.find("ascii"), 5, big ? "binary_big_endian" : "binary_little_endian");
    for (const std::int64_t z : {0, 2}) {
      for (const std::int64_t x : {std::int64_t{0}, std::int64_t{0}, z, std::int64_t{4}, std::int64_t{0}, z,
                                   std::int64_t{0}, std::int64_t{4}, z}) {
        content += to_bytes(x, big);
      }
    }
    for (const std::int64_t first : {0, 3}) {
      content += to_bytes(std::uint64_t{3}, big);
      for (std::int64_t i = 0; i < 3; ++i) content += to_bytes(first + i, big);
    }
    both("t.ply", content);
    std::string below = content;
    below.replace(below.size() - 24, 8, to_bytes(std::int64_t{-3}, big));
    CHECK_THROWS_WITH(cchip::parse_mesh(below, "t.ply"), Catch::Contains("vertex index -3 is out of range"));
  }
  const auto strips = [&](const std::string& text) {
    return "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\nelement "
           "tristrips 1\n"
           "property list int int vertex_indices\nend_header\n" +
           vertices("", "\n") + text;
  };
  both("t.ply", strips("7 0 1 2 -1 3 4 5\n"));
  const Mesh strip = cchip::parse_mesh(strips("10 0 1 2 4 4 4 -1 1 3 5\n"), "t.ply");
  REQUIRE(strip.faces.size() == 3);
  CHECK(strip.faces[1].vertex == std::array<std::uint32_t, 4>{2, 1, 4, 0});
  CHECK(strip.faces[2].vertex == std::array<std::uint32_t, 4>{1, 3, 5, 0});
}

TEST_CASE("mesh file: faces that cannot be used are left out if asked for", "[lib][mesh_file]") {
  const std::string text =
      "v 0 0 0\nv 2 2 0\nv 2 1 0\nv 2 0 0\nv 0 2 0\nv nan 0 0\nf 1 2 3 4 5\nf 1 4 5\nf 1 2 99\nf 1 2 -99\nf 1 2 6\nf 1 "
      "4 2\n";
  CHECK_THROWS_WITH(cchip::parse_mesh(text, "t.obj"), Catch::Contains("t.obj:7: face 0: its sides 0 and 3 cross"));
  cchip::LoadOptions options;
  options.lenient = true;
  std::size_t left_out = 99;
  options.faces_left_out = &left_out;
  const Mesh mesh = cchip::parse_mesh(text, "t.obj", options);
  CHECK(mesh.file_face == std::vector<std::uint32_t>{1, 5});
  REQUIRE(mesh.notes.size() == 5);
  CHECK(mesh.notes[0].rfind("line 7: face 0: its sides 0 and 3 cross", 0) == 0);
  CHECK(mesh.notes[1] == "line 9: face 2: vertex index 99 is out of range (the mesh has 6 vertices)");
  CHECK(mesh.notes[2] == "line 10: face 3: vertex index -99 is out of range (the mesh has 6 vertices so far)");
  CHECK(mesh.notes[3] == "line 6: vertex 5 is not finite, and face 4 uses it");
  CHECK(left_out == 4);
  CHECK(mesh.notes[4] == "4 faces were left out because they cannot be used");
  cchip::parse_mesh("v 0 0 0\nv 2 2 0\nv 2 1 0\nf 1 2 3\n", "t.obj", options);
  CHECK(left_out == 0);
  CHECK_THROWS_WITH(cchip::parse_mesh("v 0 0 0\nf 1 2 3\n", "t.obj", options),
                    Catch::Contains("the file holds no faces"));
  CHECK_THROWS_WITH(cchip::parse_mesh(text + "f 1 x 2\n", "t.obj", options), Catch::Contains("'x' is not a number"));
}

TEST_CASE("mesh file: lines of an OBJ with unknown words are left out if asked for", "[lib][mesh_file]") {
  const std::string text = "v 0 0 0\nv 4 0 0\nv 0 4 0\nvc 1 0 0\nvc 0 1 0\nf 1 2 3\n";
  cchip::LoadOptions options;
  options.lenient = true;
  std::size_t left_out = 99;
  options.faces_left_out = &left_out;
  const Mesh mesh = cchip::parse_mesh(text, "t.obj", options);
  CHECK(mesh.faces.size() == 1);
  CHECK(mesh.notes ==
        std::vector<std::string>{"2 statements that are not of OBJ were left out, the first 'vc' in line 4"});
  CHECK(left_out == 0);
  for (const char* const word : {"surf", "bzp", "res"}) {
    CHECK_THROWS_WITH(cchip::parse_mesh(text + word + " 0 1\n", "t.obj", options),
                      Catch::Contains("t.obj:7: '" + std::string(word) + "' is a statement of free-form surfaces"));
  }
}

TEST_CASE("mesh file: an OBJ without an end of its name", "[lib][mesh_file]") {
  for (const char* const begin : {"", "# made by hand\n\n", "mtllib a.mtl\n", "o part\n", "g\n", "s off\n"}) {
    CHECK(cchip::parse_mesh(begin + std::string("v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n"), "-").faces.size() == 1);
  }
  CHECK_THROWS_WITH(cchip::parse_mesh("velocity 1\n", "-"), Catch::Contains("cannot be read as a mesh"));
}

TEST_CASE("mesh file: a binary STL with more triangles than its header says", "[lib][mesh_file]") {
  const auto with_count = [](std::uint8_t count, std::size_t triangles) {
    std::string file = binary_stl(static_cast<std::uint32_t>(triangles), triangles);
    file[80] = static_cast<char>(count);
    return file;
  };
  const auto note_of = [](const std::string& file) {
    const Mesh mesh = cchip::parse_mesh(file, "t.stl");
    return std::to_string(mesh.faces.size()) + ": " + (mesh.notes.empty() ? "" : mesh.notes.at(0));
  };
  CHECK(note_of(with_count(3, 3)) == "3: ");
  for (const std::uint8_t count : {std::uint8_t{0}, std::uint8_t{1}, std::uint8_t{2}}) {
    const std::string expected =
        "3: the header announces " + std::to_string(count) + " triangles, the file holds 3: all of them were read";
    CHECK(note_of(with_count(count, 3)) == expected);
    std::string solid = with_count(count, 3);
    solid.replace(0, 6, std::string("solid\0", 6));
    CHECK(note_of(solid) == expected);
  }
  // Padding is none, other bytes are noted, and without a single triangle they are an error.
  CHECK(note_of(with_count(2, 2) + std::string(50, '\0')) == "2: ");
  CHECK(note_of(with_count(2, 2) + std::string(7, 'c')) ==
        "2: 7 bytes behind the 2 triangles that the header announces were left out; they are no triangles");
  CHECK(note_of(with_count(2, 2) + std::string(50, '\xff')) ==
        "2: 50 bytes behind the 2 triangles that the header announces were left out; they are no triangles");
  CHECK_THROWS_WITH(
      cchip::parse_mesh(with_count(0, 2) + "abc", "t.stl"),
      "t.stl: the header announces 0 triangles, and the 103 bytes behind it are none; write the file again");
  CHECK_THROWS_WITH(cchip::parse_mesh(with_count(3, 2), "t.stl"),
                    Catch::Contains("the header announces 234 bytes, the file has 184"));
}

TEST_CASE("mesh file: OFF with vertices on the line of counts", "[lib][mesh_file]") {
  const std::string points = "0 0 0 4 0 0 0 4 0 0 0 2 4 0 2 0 4 2";
  const std::string faces = "3 0 1 2 3 3 4 5";
  for (const std::string& text : std::vector<std::string>{
           "OFF 6 2 0 " + points + "\n" + faces, "OFF 6 2 0 " + points + " " + faces,
           "OFF\n6 2 0 " + points + "\n" + faces, "OFF 6\n2 0 0 0 0 4 0 0 0 4 0\n0 0 2 4 0 2 0 4 2 3 0 1 2\n3 3 4 5",
           "6 2 0 " + points + "\n" + faces, "OFF 6 2 0 " + points + "\n3 0 1 2 255 0 0\n3 3 4 5 0 255 0",
           "OFF 6 2\n" + points + "\n" + faces, "OFF 6 2\n" + points + "\n3 0 1 2 255 0 0\n3 3 4 5 0 255 0",
           "OFF 6 2 0.0 0 0 4 0 0 0 4 0 0 0 2 4 0 2 0 4 2\n" + faces}) {
    INFO(text);
    const Mesh mesh = cchip::parse_mesh(text, "t.off");
    REQUIRE(mesh.faces.size() == 2);
    CHECK(mesh.vertices.at(1) == Vec3d(4, 0, 0));
    CHECK(mesh.vertices.at(5) == Vec3d(0, 4, 2));
    CHECK(mesh.faces[1].vertex == std::array<std::uint32_t, 4>{3, 4, 5, 0});
  }
  CHECK_THROWS_WITH(cchip::parse_mesh("OFF 6 2 0 " + points + "\n3 0 1 2", "t.off"), Catch::Contains("t.off:"));
}

TEST_CASE("mesh file: coordinates are rounded to single precision if asked for", "[lib][mesh_file]") {
  const std::string text = "v 0.1 0 0\nv 4 1e-60 0\nv 0 5000.7 0\nf 1 2 3\n";
  cchip::LoadOptions options;
  options.single_precision = true;
  const Mesh read = cchip::parse_mesh(text, "t.obj", options);
  Mesh rounded = cchip::parse_mesh(text, "t.obj");
  CHECK(rounded.vertices != read.vertices);
  cchip::round_to_single(rounded);
  CHECK(rounded.vertices == read.vertices);
  CHECK(read.vertices ==
        std::vector<Vec3d>{{static_cast<double>(0.1F), 0, 0}, {4, 0, 0}, {0, static_cast<double>(5000.7F), 0}});
  // Before faces are cut: this dent is smaller than the rounding.
  const std::string dent = "v 1000 0 0\nv 1001 0 0\nv 1000.49999999 0.49999999 0\nv 1000 1 0\nf 1 2 3 4\n";
  options.kinds = cchip::FaceKinds::triangles_and_quads;
  CHECK(cchip::parse_mesh(dent, "t.obj", options).faces.size() == 1);
  CHECK(cchip::parse_mesh(dent, "t.obj", options.kinds).faces.size() == 2);
  CHECK_THROWS_WITH(cchip::parse_mesh("v 1 2 3\nv 4e38 0 0\nv 0 1 0\nf 1 2 3\n", "t.obj", options),
                    "t.obj: vertex 1 is beyond the range of single precision; leave out --single (single_precision)");
  rounded.vertices[2][0] = -1e300;
  CHECK_THROWS_AS(cchip::round_to_single(rounded), std::invalid_argument);
}

TEST_CASE("mesh file: what is no mesh is named, with what to do", "[lib][mesh_file]") {
  const auto message = [](const std::string& file, const std::string& name) -> std::string {
    try {
      cchip::parse_mesh(file, name);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  const std::string long_text(300, 'x');
  const auto check = [&](const std::string& file, const std::string& name, const std::string& begin) {
    const std::string text = message(file + long_text, name);
    INFO(text);
    CHECK(text.rfind(name + ": " + begin, 0) == 0);
    CHECK(text.find('\n') == std::string::npos);
    CHECK(text.find('%') == (name == "a.las" ? text.find("%.17g") : std::string::npos));
  };
  for (const char* const name : {"a.stl", "a.obj", "a.ply", "a.off", "a.dat", "a"}) {
    check("version https://git-lfs.github.com/spec/v1\noid sha256:12\n", name,
          "is a Git LFS pointer, not the file itself; run");
    check("<!DOCTYPE html>\n<html>", name, "is a web page (HTML), not a mesh; download");
    check("\n <HTML lang=en>", name, "is a web page (HTML)");
    check("ISO-10303-21;\nHEADER;FILE_SCHEMA(('IFC4'));", name, "is IFC, which is not read; write");
    check("ISO-10303-21;\nHEADER;FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));", name, "is STEP (surfaces");
  }
  check("# vtk DataFile Version 3.0\n", "a.vtk", "is VTK, which is not read; convert it with PyVista");
  check("<?xml version=\"1.0\"?><VTKFile>", "a.vtp", "is VTK, which is not read; convert it with PyVista");
  check("$MeshFormat\n", "a.msh", "is Gmsh, which is not read; convert it with `meshio convert a.msh part.obj`");
  check("#usda 1.0\n", "a.usd", "is USD, which is not read; open it in Blender");
  check("LASF", "a.las", "is LAS, which is not read; write its points as text");
  check("#VRML V2.0 utf8\n", "folder/part.wrl", "is VRML, which is not read; convert it to PLY with MeshLab");
  check("0 0 0\n1 1 1\n", "a.xyz",
        "holds points, no faces; to ask about a point cloud, name it first, as A, and give --points");
  check("0 0 0\n1 1 1\n", "scan.dat", "holds points, no faces");
  check("# .PCD v0.7\n", "scan", "holds points, no faces");
}

TEST_CASE("mesh file: a PLY with an element of no faces", "[lib][mesh_file]") {
  const std::string cloud =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face "
      "0\nend_header\n1 2 3\n";
  CHECK_THROWS_WITH(cchip::parse_mesh(cloud, "t.ply"),
                    "t.ply: the file holds no faces, only 1 vertices; to ask about a point cloud, name it first, as A, "
                    "and give --points (load_points())");
}

TEST_CASE("mesh file: gzip is unpacked", "[lib][mesh_file]") {
  // Python's gzip.compress() of "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n".
  const char bytes[] =
      "\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\xff\x2b\x53\x30\x00\x41\xae\x32\x05\x13\x28\x6d\x00"
      "\x62\x71\xa5\x29\x18\x2a\x18\x29\x18\x73\x01\x00\x93\x79\x44\xf9\x20\x00\x00\x00";
  const std::string packed(bytes, sizeof bytes - 1);
  // The name may end with .gz or not; what counts is the content.
  for (const char* const name : {"t.obj.gz", "folder.x/t.OBJ.GZ", "t.obj"}) {
    CAPTURE(name);
    const Mesh mesh = cchip::parse_mesh(packed, name);
    REQUIRE(mesh.faces.size() == 1);
    CHECK(mesh.primitive(0).v[2] == Vec3d(0, 4, 0));
    CHECK(mesh.name == name);
  }
  const TemporaryFolder folder;
  CHECK(load_mesh(folder.write("t.obj.gz", packed)).faces.size() == 1);
  // Two members are one content: of the same points and a face twice. What is behind the last one does not count.
  CHECK(cchip::parse_mesh(packed + packed, "t.obj.gz").faces.size() == 2);
  CHECK(cchip::parse_mesh(packed + std::string(512, '\0'), "t.obj.gz").faces.size() == 1);

  for (std::size_t length = 2; length < packed.size(); ++length) {
    CAPTURE(length);
    CHECK_THROWS_WITH(cchip::parse_mesh(packed.substr(0, length), "t.obj.gz"),
                      "t.obj.gz: the gzip file is truncated; copy or download it again");
  }
  for (const std::size_t place : {std::size_t{2}, std::size_t{12}, packed.size() - 8, packed.size() - 1}) {
    CAPTURE(place);
    std::string damaged = packed;
    damaged[place] = static_cast<char>(damaged[place] ^ 0x5a);
    CHECK_THROWS_WITH(cchip::parse_mesh(damaged, "t.obj.gz"), Catch::StartsWith("t.obj.gz: the gzip file is "));
  }
  cchip::LoadOptions options;
  options.most_unpacked_bytes = 32;
  CHECK(cchip::parse_mesh(packed, "t.obj.gz", options).faces.size() == 1);
  options.most_unpacked_bytes = 31;
  CHECK_THROWS_WITH(cchip::parse_mesh(packed, "t.obj.gz", options),
                    Catch::StartsWith("t.obj.gz: the gzip file holds more than 31 bytes, which is the limit; "));
  // A message about the content names the packed file and the line inside; the extension before .gz counts.
  CHECK_THROWS_WITH(cchip::parse_mesh(packed, "t.off.gz"), Catch::StartsWith("t.off.gz:1: "));
  CHECK(cchip::parse_mesh(packed, "t.gz").faces.size() == 1);
}

TEST_CASE("mesh file: packed files are named", "[lib][mesh_file]") {
  CHECK_THROWS_WITH(cchip::parse_mesh("PK\3\4 and so on", "t.obj"), Catch::Contains("packed with zip"));
}

TEST_CASE("mesh file: binary numbers of all types and both byte orders", "[lib][mesh_file]") {
  const TemporaryFolder folder;
  for (const bool big : {false, true}) {
    const std::string content =
        std::string("ply\nformat binary_") + (big ? "big" : "little") +
        "_endian 1.0\nelement vertex 3\nproperty char x\nproperty short y\nproperty int z\nproperty uchar a\n"
        "property list ushort double b\nelement face 1\nproperty list uint short vertex_indices\nend_header\n";
    std::string body;
    for (std::int32_t i = 0; i < 3; ++i) {
      body += to_bytes(static_cast<std::int8_t>(-100 + i), big) +
              to_bytes(static_cast<std::int16_t>(-1000 - i * i), big) + to_bytes(std::int32_t{-2000000000}, big) +
              '\377' + to_bytes(std::uint16_t{1}, big) + to_bytes(0.1, big);
    }
    body += to_bytes(std::uint32_t{3}, big);
    for (const std::int16_t i : {std::int16_t{2}, std::int16_t{0}, std::int16_t{1}}) body += to_bytes(i, big);
    const Mesh mesh = load_mesh(folder.write("types.ply", content + body));
    REQUIRE(mesh.faces.size() == 1);
    CHECK(mesh.primitive(0).v[0] == Vec3d(-98, -1004, -2e9));
    CHECK(mesh.primitive(0).v[1] == Vec3d(-100, -1000, -2e9));
    CHECK(mesh.primitive(0).v[2] == Vec3d(-99, -1001, -2e9));
  }
}

TEST_CASE("mesh file: faces know the polygon of the file", "[lib][mesh_file]") {
  const TemporaryFolder folder;
  const std::string pentagon = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 2 6 0\nf 1 2 3\nf 1 2 3 5 4\nf 1 2 3 4\n";
  const std::string file = folder.write("t.obj", pentagon);
  CHECK(load_mesh(file).file_face == std::vector<std::uint32_t>{0, 1, 1, 1, 2, 2});
  CHECK(load_mesh(file, cchip::FaceKinds::triangles_and_quads).file_face == std::vector<std::uint32_t>{0, 1, 1, 1, 2});
  CHECK(load_mesh(folder.write("u.obj", "v 0 0 0\nv 4 0 0\nv 4 4 0\nf 1 2 3\n")).file_face.empty());
}

namespace {

/// The corners as an OBJ with one face.
std::string polygon_obj(const std::vector<Vec3d>& corners) {
  std::string text;
  std::string face = "f";
  for (const Vec3d& v : corners) {
    text += "v " + to_line(v);
    face += " -" + std::to_string(corners.size() - static_cast<std::size_t>(&v - corners.data()));
  }
  return text + face + "\n";
}

double area_of(const Mesh& mesh) {
  double area = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const cchip::Primitive p = mesh.primitive(i);
    area += (p.v[1] - p.v[0]).cross(p.v[2] - p.v[0]).norm() / 2;
  }
  return area;
}

bool covers(const Mesh& mesh, double x, double y) {
  cchip::Primitive needle;
  needle.v[0] = Vec3d(x, y, -9);
  needle.v[1] = Vec3d(x, y, 9);
  needle.v[2] = needle.v[1];
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    if (cchip::exact_intersects(mesh.primitive(i), needle)) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("mesh file: concave polygons keep their outline", "[lib][mesh_file]") {
  const TemporaryFolder folder;
  // Teeth of a comb, with corners on its straight back. Area by hand: the back 2n x 1 and n teeth of 1 x 3.
  for (const int teeth : {1, 2, 5, 100}) {
    std::vector<Vec3d> comb;
    for (int i = 0; i < teeth; ++i) {
      comb.insert(comb.end(), {{2.0 * i, 1, 0}, {2.0 * i, 4, 0}, {2.0 * i + 1, 4, 0}, {2.0 * i + 1, 1, 0}});
    }
    comb.emplace_back(2.0 * teeth, 1, 0);
    for (int i = 2 * teeth; i >= 0; --i) comb.emplace_back(i, 0, 0);
    for (const bool backwards : {false, true}) {
      if (backwards) std::reverse(comb.begin(), comb.end());
      const Mesh mesh = load_mesh(folder.write("comb.obj", polygon_obj(comb)));
      CHECK(mesh.faces.size() == comb.size() - 2);
      CHECK(area_of(mesh) == Approx(2 * teeth + 3 * teeth));
      std::vector<bool> used(comb.size());
      for (const Mesh::Face& face : mesh.faces) {
        for (std::size_t i = 0; i < 3; ++i) used[face.vertex[i]] = true;
      }
      CHECK(std::count(used.begin(), used.end(), false) == 0);
      CHECK(covers(mesh, 0.5, 3.9));
      CHECK_FALSE(covers(mesh, 1.5, 3.9));
      CHECK_FALSE(covers(mesh, 1.5, 1.001));
      CHECK(covers(mesh, 1.5, 1));
    }
  }
}

TEST_CASE("mesh file: a polygon is cut the same way in any unit", "[lib][mesh_file]") {
  // Where areas underflow or overflow, integers of any size decide about every ear.
  const TemporaryFolder folder;
  std::vector<Vec3d> comb;
  for (int i = 0; i < 100; ++i) {
    comb.insert(comb.end(), {{2.0 * i, 1, 0}, {2.0 * i, 4, 0}, {2.0 * i + 1, 4, 0}, {2.0 * i + 1, 1, 0}});
  }
  comb.emplace_back(200, 0, 0);
  comb.emplace_back(0, 0, 0);
  const Mesh expected = load_mesh(folder.write("comb.obj", polygon_obj(comb)));
  for (const int exponent : {-1074, -700, 700, 1000}) {
    std::vector<Vec3d> scaled;
    for (const Vec3d& corner : comb) scaled.emplace_back(corner * std::ldexp(1.0, exponent));
    const Mesh mesh = load_mesh(folder.write("scaled.obj", polygon_obj(scaled)));
    REQUIRE(mesh.faces.size() == expected.faces.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) different += mesh.faces[i].vertex != expected.faces[i].vertex;
    CHECK(different == 0);
    const std::vector<Vec3d> dent = {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}};
    scaled.clear();
    for (const Vec3d& corner : dent) scaled.emplace_back(corner * std::ldexp(1.0, exponent));
    const std::string file = folder.write("dent.obj", polygon_obj(scaled));
    const Mesh cut = load_mesh(file, cchip::FaceKinds::triangles_and_quads);
    REQUIRE(cut.faces.size() == 2);
    for (const Mesh::Face& face : cut.faces) {
      CHECK(std::count(face.vertex.begin(), face.vertex.begin() + 3, 2U) == 1);  // each has the inner corner
      CHECK(std::count(face.vertex.begin(), face.vertex.begin() + 3, 0U) == 1);
    }
  }
}

TEST_CASE("mesh file: odd polygons", "[lib][mesh_file]") {
  const TemporaryFolder folder;
  const auto load = [&](const std::vector<Vec3d>& corners) {
    return load_mesh(folder.write("t.obj", polygon_obj(corners)));
  };
  // without area: the segment is covered
  const Mesh segment = load({{0, 0, 0}, {1, 0, 0}, {5, 0, 0}, {4, 0, 0}, {2, 0, 0}});
  CHECK(segment.faces.size() == 3);
  CHECK(covers(segment, 4.5, 0));
  CHECK(covers(segment, 0.5, 0));
  // a square with a hole, joined by a slit that the outline passes twice
  const Mesh ring = load(
      {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {0, 0, 0}, {3, 3, 0}, {3, 6, 0}, {6, 6, 0}, {6, 3, 0}, {3, 3, 0}});
  CHECK(area_of(ring) == Approx(81 - 9));
  CHECK_FALSE(covers(ring, 4.5, 4.5));
  CHECK(covers(ring, 1.5, 1.5));
  CHECK(covers(ring, 7, 4.5));
  // standing upright: the axis of projection must be chosen
  CHECK(area_of(load({{7, 0, 0}, {7, 4, 0}, {7, 4, 4}, {7, 2, 1}, {7, 0, 4}})) == Approx(16 - 6));
  // a dent that is invisible in single precision
  const double e = 1e-12;
  const Mesh dent = load({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 4 - e, 0}, {0, 4, 0}});
  CHECK(dent.faces.size() == 3);
  CHECK_FALSE(covers(dent, 2, 4 - e / 2));
  CHECK(covers(dent, 2, 4 - e));
}

TEST_CASE("mesh file: a written PLY holds the same faces and their colours", "[lib][mesh_file]") {
  const TemporaryFolder folder;
  Mesh mesh;
  mesh.vertices = {{0, 0, 0.1}, {1, 0, 1e-300}, {1, 1.000000001, 0}, {0, 1, 0}};
  const auto written = [&](const std::vector<Mesh::Face>& faces, const std::vector<cchip::Colour>& colours) {
    mesh.faces = faces;
    std::ostringstream out;
    cchip::write_ply(out, mesh, colours);
    return out.str();
  };
  const auto read = [&](const std::string& ply) {
    return load_mesh(folder.write("t.ply", ply), cchip::FaceKinds::triangles_and_quads);
  };
  const Mesh::Face triangle = {cchip::Kind::tri, {2, 1, 0, 0}};
  const Mesh::Face quad = {cchip::Kind::quad, {0, 1, 2, 3}};
  for (const Mesh::Face& face : {triangle, quad}) {
    const Mesh same = read(written({face, face}, {{1, 2, 3}, {4, 5, 6}}));
    REQUIRE(same.faces.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(same.faces[i].kind == face.kind);
      for (std::size_t k = 0; k < mesh.primitive(i).vertex_count(); ++k) {
        CHECK(same.primitive(i).v[k] == mesh.primitive(i).v[k]);
      }
    }
  }
  // Lists of one length only: a quad beside a triangle is cut.
  const std::string mixed = written({triangle, quad}, {{1, 2, 3}, {250, 251, 252}});
  const Mesh cut = read(mixed);
  REQUIRE(cut.faces.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) CHECK(cut.faces[i].kind == cchip::Kind::tri);
  CHECK(cut.faces[1].vertex == std::array<std::uint32_t, 4>{3, 4, 5, 0});
  CHECK(cut.faces[2].vertex == std::array<std::uint32_t, 4>{3, 5, 6, 0});
  const std::size_t vertices = mixed.find("end_header\n") + 11;
  for (std::size_t i = 0; i < 7; ++i) {
    CHECK(mixed.substr(vertices + 27 * i + 24, 3) == (i < 3 ? "\1\2\3" : "\xfa\xfb\xfc"));
  }
  std::ostringstream out;
  CHECK_THROWS_AS(cchip::write_ply(out, mesh, {{1, 2, 3}}), std::invalid_argument);
}

TEST_CASE("mesh file: a written PLY holds curves as edges", "[lib][mesh_file]") {
  const TemporaryFolder folder;
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.faces = {{cchip::Kind::tri, {0, 1, 2, 0}}};
  const std::vector<cchip::PlyCurve> curves = {
      {{{0, 0, 5}, {1, 0, 5}, {0, 1, 5}}, true, {1, 2, 3}}, {{{7, 0, 0}, {8, 0, 0}}, false, {4, 5, 6}}, {{}, true, {}}};
  std::ostringstream out;
  cchip::write_ply(out, mesh, {{9, 9, 9}}, curves);
  CHECK(out.str().find("element vertex 8\n") != std::string::npos);
  CHECK(out.str().find("element edge 4\nproperty int vertex1\nproperty int vertex2\nend_header\n") !=
        std::string::npos);
  // What follows the face: a triangle of the vertices 3, 4, 5 and a line from 6 to 7. Their vertices have the colours.
  std::string edges;
  for (const char* const edge : {"\3\4", "\4\5", "\5\3", "\6\7"}) {
    for (int k = 0; k < 2; ++k) edges += std::string(1, edge[k]) + std::string(3, '\0');
  }
  CHECK(out.str().substr(out.str().size() - edges.size()) == edges);
  const Mesh read = load_mesh(folder.write("t.ply", out.str()), cchip::FaceKinds::triangles_and_quads);
  REQUIRE(read.faces.size() == 1);
  REQUIRE(read.vertices.size() == 8);
  for (std::size_t k = 0; k < 3; ++k) CHECK(read.vertices[k] == mesh.vertices[k]);
  CHECK(read.vertices[5] == curves[0].points[2]);
  CHECK(read.vertices[7] == curves[1].points[1]);
  std::ostringstream without;
  cchip::write_ply(without, mesh, {{9, 9, 9}});
  CHECK(without.str().find("edge") == std::string::npos);
}

TEST_CASE("mesh file: numbers are read and written the same in every locale", "[lib][mesh_file]") {
  const std::pair<const char*, double> words[] = {
      {"0.5", 0.5}, {"1.5e-400", 0}, {"-2.5e-330", -0.0}, {"1234.5", 1234.5}};
  const auto check = [&] {
    for (const auto& [word, value] : words) {
      INFO(word);
      const Mesh mesh = cchip::parse_mesh("v " + std::string(word) + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "t.obj");
      CHECK(mesh.vertices[0].x() == value);
      CHECK(std::signbit(mesh.vertices[0].x()) == std::signbit(value));
    }
    CHECK_THROWS(cchip::parse_mesh("v 1.5e400 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "t.obj"));
  };
  check();
  // Hosts like Qt call setlocale(). Not every computer has one of these.
  for (const char* const name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"}) {
    if (std::setlocale(LC_ALL, name) != nullptr) check();
    std::setlocale(LC_ALL, "C");
  }
  // A stream whose locale groups digits.
  struct Grouping : std::numpunct<char> {
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.faces.assign(1234, {cchip::Kind::tri, {0, 1, 2, 0}});
  std::ostringstream out;
  out.imbue(std::locale(std::locale::classic(), new Grouping));
  cchip::write_ply(out, mesh, std::vector<cchip::Colour>(mesh.faces.size()));
  CHECK(out.str().find("element face 1234\n") != std::string::npos);
  CHECK(cchip::parse_mesh(out.str(), "t.ply").faces.size() == 1234);
}

TEST_CASE("mesh file: every model of Debian's package is read or refused", "[lib][mesh_file]") {
  std::size_t read = 0;
  std::size_t refused = 0;
  for (const char* const folder : {"OBJ", "OFF", "PLY", "STL", "invalid"}) {
    for (const auto& entry : std::filesystem::directory_iterator(models + folder)) {
      const std::string message = message_of(entry.path());
      INFO(message);
      ++(message == "no error" ? read : refused);
      if (std::string(folder) == "invalid") CHECK(message != "no error");
    }
  }
  CHECK(read >= 25);
  CHECK(refused > 10);
}
