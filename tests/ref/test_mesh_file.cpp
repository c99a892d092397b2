// SPDX-License-Identifier: Apache-2.0
// Mesh files, among them some that nobody here made (Debian package assimp-testmodels).
#include <sys/resource.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cchip/exact/oracle.hpp>
#include <cchip/mesh_io/mesh_file.hpp>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <sstream>

using cchip::load_mesh;
using cchip::Mesh;
using cchip::Vec3d;

namespace {

const std::string models = "/usr/share/assimp/models/";

/// A folder that goes away with its object.
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

/// As long as it lives this process gets at most 64 MB of memory more; sanitizers need terabytes, so not with them.
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

TEST_CASE("mesh file: one model in four formats", "[ref][mesh_file]") {
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

TEST_CASE("mesh file: text and binary STL hold the same model", "[ref][mesh_file]") {
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

TEST_CASE("mesh file: several parts become one mesh", "[ref][mesh_file]") {
  const Mesh spider = load_mesh(models + "OBJ/spider.obj");
  CHECK(spider.faces.size() == load_mesh(models + "STL/Spider_ascii.stl").faces.size());
  for (const Mesh::Face& face : spider.faces) {
    REQUIRE(face.kind == cchip::Kind::tri);
    for (std::size_t i = 0; i < 3; ++i) REQUIRE(face.vertex[i] < spider.vertices.size());
  }
}

TEST_CASE("mesh file: polygons are cut into triangles, lines and points dropped", "[ref][mesh_file]") {
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

TEST_CASE("mesh file: quads are kept if asked for, other polygons cut", "[ref][mesh_file]") {
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

TEST_CASE("mesh file: a box of quads that somebody else made", "[ref][mesh_file]") {
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

TEST_CASE("mesh file: positions are the doubles of the file", "[ref][mesh_file]") {
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

TEST_CASE("mesh file: a large PLY that was cut is refused", "[ref][mesh_file]") {
  const TemporaryFolder folder;
  const std::string whole = large_ascii_ply();
  CHECK(load_mesh(folder.write("whole.ply", whole)).faces.size() == 14998);
  const std::size_t face_list = whole.find("3 0 1 2\n");
  for (const std::size_t length : {std::size_t{100}, std::size_t{5000}, face_list, face_list + 8, whole.size() - 7}) {
    CAPTURE(length);
    CHECK(message_of(folder.write("cut.ply", whole.substr(0, length))).find("cut.ply") != std::string::npos);
  }
}

TEST_CASE("mesh file: a file cut anywhere is refused", "[ref][mesh_file]") {
  const TemporaryFolder folder;
  // What comes after the last corner or behind the last keyword says nothing about the mesh. Of a decimal number
  // that was cut nobody can tell: files of text end behind the last digit that must be there.
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

TEST_CASE("mesh file: a count that the file cannot hold is refused at once", "[ref][mesh_file]") {
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

TEST_CASE("mesh file: errors are one line with file, cause and remedy", "[ref][mesh_file]") {
  const TemporaryFolder folder;
  const auto check = [](const std::string& path, const char* cause) {
    const std::string message = message_of(path);
    INFO(message);
    CHECK(message.find(path) == 0);
    CHECK(message.find(cause) != std::string::npos);
    CHECK(message.find('\n') == std::string::npos);
    CHECK(message.rfind(": ") > message.find(cause));  // the remedy comes last
  };
  check(folder.file("absent.obj"), "no such file");
  check(folder.file(""), "no such file");
  check(folder.write("notes.txt", "hello\n"), "cannot be read as a mesh");
  check(folder.write("broken.stl", "solid x\nfacet normal 0 0 1\n"), "");
  check(folder.write("empty.obj", ""), "");
  check(folder.write("points.obj", "v 0 0 0\nv 1 0 0\n"), "");
  check(folder.write("lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"), "no faces");
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 2\nproperty list uchar uint vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 ";
  check(folder.write("index.ply", ply + "7\n3 0 1 2\n"), "face 0 has no or unknown vertices");
  std::string cut(3000, ' ');
  std::ifstream(models + "PLY/Wuson.ply").read(cut.data(), 3000);
  check(folder.write("cut.ply", cut), "face 0 has no or unknown vertices");
  check(folder.write("nan.off", "OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), "not finite");
  check(folder.write("inf.obj", "v 0 0 0\nv 1 inf 0\nv 0 1 0\nf 1 2 3\n"), "not finite");
}
