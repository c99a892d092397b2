// SPDX-License-Identifier: Apache-2.0
// Mesh files, among them some that nobody here made (Debian package assimp-testmodels).
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cchip/mesh_io/mesh_file.hpp>
#include <filesystem>
#include <fstream>

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
    std::ofstream(file) << content;
    return file;
  }
  std::string file(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
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
  } catch (const std::runtime_error& error) {
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

TEST_CASE("mesh file: transformations of nodes are applied", "[ref][mesh_file]") {
  const TemporaryFolder folder;
  const std::string triangle =
      "<library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" count=\"9\">"
      "0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source=\"#a\" count=\"3\" stride=\"3\">"
      "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/>"
      "</accessor></technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
      "source=\"#p\"/></vertices>"
      "<triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles>"
      "</mesh></geometry></library_geometries>";
  const std::string scene =
      "<library_visual_scenes><visual_scene id=\"s\"><node id=\"outer\"><translate>10 0 0</translate>"
      "<node id=\"inner\"><scale>2 2 2</scale><instance_geometry url=\"#g\"/></node>"
      "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes>"
      "<scene><instance_visual_scene url=\"#s\"/></scene>";
  const Mesh mesh =
      load_mesh(folder.write("nodes.dae",
                             "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
                             "version=\"1.4.1\"><asset><up_axis>Y_UP</up_axis></asset>" +
                                 triangle + scene + "</COLLADA>"));
  CHECK(mesh.faces.size() == 2);
  CHECK(extent(mesh).least == Vec3d(10, 0, 0));
  CHECK(extent(mesh).greatest == Vec3d(12, 2, 0));
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
