// SPDX-License-Identifier: Apache-2.0
// glTF, GLB and 3MF files as assemblies. The files are written here; most hold a box of 1 x 2 x 3 from the origin.
#include <zip.h>

#include <Eigen/LU>
#include <array>
#include <catch2/catch.hpp>
#include <cchip/assembly.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace cchip;
namespace fs = std::filesystem;

namespace {

class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("cchip_sources_" + std::to_string(std::random_device()()))) {
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return file(name);
  }
  /// What is wrong with a file, without the folder.
  std::string error_of(const std::string& name, const AssemblyLoadOptions& options = {}) const {
    try {
      load_assembly(file(name), options);
    } catch (const std::runtime_error& error) {
      std::string what = error.what();
      const std::string folder = path_.string() + "/";
      for (auto at = what.find(folder); at != std::string::npos; at = what.find(folder)) what.erase(at, folder.size());
      CHECK(what.find('\n') == std::string::npos);
      CHECK(what.find("; ") != std::string::npos);  // what to do
      return what;
    }
    return "";
  }

 private:
  fs::path path_;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

bool contains(const std::string& text, const std::string& part) {
  INFO(text);
  return text.find(part) != std::string::npos;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  if (!values.empty()) std::memcpy(&bytes[0], values.data(), bytes.size());
  return bytes;
}

std::string base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63U];
  }
  return text;
}

/// Corners of the box, and its sides as quads that face outwards.
constexpr std::array<std::array<float, 3>, 8> corners = {
    {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {1, 2, 0}, {0, 0, 3}, {1, 0, 3}, {0, 2, 3}, {1, 2, 3}}};
constexpr std::array<std::array<std::uint16_t, 4>, 6> sides = {
    {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};

/// A file of glTF while it is written.
struct Gltf {
  std::string binary;
  std::string views;
  std::string accessors;
  std::size_t view_count = 0;
  std::size_t accessor_count = 0;
  std::string meshes;
  std::string nodes = R"({"mesh":0,"name":"a"},{"mesh":0,"name":"b","translation":[5,0,0]})";
  std::string scenes = R"("scene":0,"scenes":[{"nodes":[0,1]}])";
  std::string more;  ///< other keys, with a comma at the end

  std::size_t add_view(const std::string& bytes) {
    views += std::string(view_count == 0 ? "" : ",") + R"({"buffer":0,"byteOffset":)" + std::to_string(binary.size()) +
             R"(,"byteLength":)" + std::to_string(bytes.size()) + "}";
    binary += bytes;
    binary.resize((binary.size() + 3) / 4 * 4);
    return view_count++;
  }
  std::size_t add_accessor(const std::string& json) {
    accessors += (accessor_count == 0 ? "" : ",") + json;
    return accessor_count++;
  }
  std::size_t add_accessor(std::size_t view, int type, std::size_t count, const std::string& kind,
                           const std::string& rest = "") {
    return add_accessor("{\"bufferView\":" + std::to_string(view) + ",\"componentType\":" + std::to_string(type) +
                        ",\"count\":" + std::to_string(count) + ",\"type\":\"" + kind + "\"" + rest + "}");
  }
  std::size_t floats(const std::vector<float>& values, const std::string& kind) {
    const std::size_t size = kind == "VEC4" ? 4 : 3;
    return add_accessor(add_view(bytes_of(values)), 5126, values.size() / size, kind);
  }
  std::size_t indices(const std::vector<std::uint16_t>& values) {
    return add_accessor(add_view(bytes_of(values)), 5123, values.size(), "SCALAR");
  }
  void add_mesh(const std::string& primitives, const std::string& rest = "") {
    meshes += std::string(meshes.empty() ? "" : ",") + "{\"primitives\":[" + primitives + "]" + rest + "}";
  }
  std::string json(const std::string& uri) const {
    return R"({"asset":{"version":"2.0"},)" + more + scenes + ",\"nodes\":[" + nodes + "],\"meshes\":[" + meshes +
           "],\"accessors\":[" + accessors + "],\"bufferViews\":[" + views + "],\"buffers\":[{" + uri +
           "\"byteLength\":" + std::to_string(binary.size()) + "}]}";
  }
  std::string text() const { return json("\"uri\":\"data:application/octet-stream;base64," + base64(binary) + "\","); }
  std::string glb() const {
    std::string part = json("");
    part.resize((part.size() + 3) / 4 * 4, ' ');
    const auto size = [](std::size_t n) { return bytes_of(std::vector<std::uint32_t>{static_cast<std::uint32_t>(n)}); };
    return "glTF" + size(2) + size(28 + part.size() + binary.size()) + size(part.size()) + "JSON" + part +
           size(binary.size()) + std::string("BIN\0", 4) + binary;
  }
};

std::string primitive(std::size_t position, std::size_t indices, const std::string& rest = "") {
  return "{\"attributes\":{\"POSITION\":" + std::to_string(position) + "},\"indices\":" + std::to_string(indices) +
         rest + "}";
}

std::vector<float> corner_numbers() {
  std::vector<float> numbers;
  for (const auto& corner : corners) numbers.insert(numbers.end(), corner.begin(), corner.end());
  return numbers;
}

std::vector<std::uint16_t> triangle_corners() {
  std::vector<std::uint16_t> all;
  for (const auto& s : sides) all.insert(all.end(), {s[0], s[1], s[2], s[0], s[2], s[3]});
  return all;
}

/// The box twice, as parts "a" and "b".
Gltf boxes(const std::string& rest_of_mesh = "") {
  Gltf gltf;
  const std::size_t position = gltf.floats(corner_numbers(), "VEC3");
  gltf.add_mesh(primitive(position, gltf.indices(triangle_corners())), rest_of_mesh);
  return gltf;
}

Gltf boxes_at(const std::string& nodes) {
  Gltf gltf = boxes();
  gltf.nodes = nodes;
  return gltf;
}

Assembly load(const Folder& folder, const Gltf& gltf) { return load_assembly(folder.write("x.gltf", gltf.text())); }
std::string error(const Folder& folder, const Gltf& gltf) {
  folder.write("x.gltf", gltf.text());
  return folder.error_of("x.gltf");
}

/// Six times the signed volume of a part in the assembly.
double six_volumes(const AssemblyPart& part) {
  double sum = 0;
  for (const Mesh::Face& face : part.object.mesh().faces) {
    const auto at = [&](std::size_t i) -> Vec3d { return part.object.mesh().vertices[face.vertex[i]]; };
    sum += at(0).dot(at(1).cross(at(2)));
  }
  return sum * part.pose.linear().determinant();
}

/// Least and greatest coordinates of a part in the assembly.
std::array<Vec3d, 2> box_of(const AssemblyPart& part) {
  std::array<Vec3d, 2> box = {Vec3d::Constant(1e300), Vec3d::Constant(-1e300)};
  for (const Vec3d& vertex : part.object.mesh().vertices) {
    const Vec3d moved = part.pose * vertex;
    box = {Vec3d(box[0].cwiseMin(moved)), Vec3d(box[1].cwiseMax(moved))};
  }
  return box;
}

void check_box(const AssemblyPart& part, const Vec3d& low, const Vec3d& high) {
  INFO(part.name);
  CHECK(part.object.is_closed());
  CHECK(std::abs(six_volumes(part)) == 36);
  CHECK((box_of(part)[0] == low));
  CHECK((box_of(part)[1] == high));
}

std::string notes_of(const Assembly& assembly) {
  std::string all;
  for (const std::string& note : assembly.notes) all += note + "\n";
  return all;
}

/// A model of 3MF with the box as object 1.
std::string box_object(const std::string& attributes = R"(id="1" name="box")") {
  std::string text = "<object " + attributes + "><mesh><vertices>";
  for (const auto& c : corners) {
    text += "<vertex x=\"" + std::to_string(int(c[0])) + "\" y=\"" + std::to_string(int(c[1])) + "e0\" z=\"" +
            std::to_string(int(c[2])) + ".0\"/>";
  }
  text += "</vertices><triangles>";
  const std::vector<std::uint16_t> all = triangle_corners();
  for (std::size_t i = 0; i < all.size(); i += 3) {
    text += "<triangle v1=\"" + std::to_string(all[i]) + "\" v2=\"" + std::to_string(all[i + 1]) + "\" v3=\"" +
            std::to_string(all[i + 2]) + "\"/>";
  }
  return text + "</triangles></mesh></object>";
}

const std::string two_items = R"(<item objectid="1"/><item objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/>)";

std::string model(const std::string& objects, const std::string& items, const std::string& attributes = "") {
  return "<model xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
         "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" " +
         attributes + "><resources>" + objects + "</resources><build>" + items + "</build></model>";
}

using Files = std::vector<std::pair<std::string, std::string>>;

std::string write_zip(const Folder& folder, const Files& files) {
  const std::string path = folder.file("x.3mf");
  int code = 0;
  zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  REQUIRE(archive != nullptr);
  for (const auto& [name, content] : files) {
    zip_source_t* source = zip_source_buffer(archive, content.data(), content.size(), 0);
    REQUIRE(zip_file_add(archive, name.c_str(), source, ZIP_FL_OVERWRITE) >= 0);
  }
  REQUIRE(zip_close(archive) == 0);
  return path;
}

std::string write_model(const Folder& folder, const std::string& text) {
  return write_zip(folder, {{"3D/3dmodel.model", text}});
}
std::string model_error(const Folder& folder, const std::string& text) {
  write_model(folder, text);
  return folder.error_of("x.3mf");
}

}  // namespace

TEST_CASE("glTF: nodes are parts, one mesh is one object, in metres", "[assembly]") {
  const Folder folder;
  const Gltf gltf = boxes();
  folder.write("boxes data.bin", gltf.binary);
  for (const std::string& file : {folder.write("x.gltf", gltf.text()), folder.write("X.GLB", gltf.glb()),
                                  folder.write("y.gltf", gltf.json("\"uri\":\"boxes%20data.bin\","))}) {
    const Assembly assembly = load_assembly(file);
    CHECK(assembly.unit == "m");
    CHECK(assembly.notes.empty());
    REQUIRE(assembly.parts.size() == 2);
    CHECK(assembly.parts[0].name == "a");
    CHECK(assembly.parts[1].name == "b");
    CHECK(&assembly.parts[0].object.mesh() == &assembly.parts[1].object.mesh());
    check_box(assembly.parts[0], {0, 0, 0}, {1, 2, 3});
    check_box(assembly.parts[1], {5, 0, 0}, {6, 2, 3});
  }
  AssemblyLoadOptions options;
  options.unit = "mm";
  CHECK(load_assembly(folder.file("x.gltf"), options).unit == "mm");
}

TEST_CASE("glTF: primitives of a node are joined and closed by position", "[assembly]") {
  const Folder folder;
  Gltf gltf;  // six open primitives of four vertices, as CAD writes them
  std::string primitives;
  for (const auto& side : sides) {
    std::vector<float> points;
    for (const std::uint16_t corner : side) points.insert(points.end(), corners[corner].begin(), corners[corner].end());
    const std::size_t position = gltf.floats(points, "VEC3");
    primitives += (primitives.empty() ? "" : ",") + primitive(position, gltf.indices({0, 1, 2, 0, 2, 3}));
  }
  gltf.add_mesh(primitives);
  const Assembly assembly = load(folder, gltf);
  REQUIRE(assembly.parts.size() == 2);
  check_box(assembly.parts[0], {0, 0, 0}, {1, 2, 3});
}

TEST_CASE("glTF: strips, fans, and points and lines that are left out", "[assembly]") {
  const Folder folder;
  Gltf gltf;
  const std::size_t position = gltf.floats(corner_numbers(), "VEC3");
  std::string primitives;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto& s = sides[i];
    const bool fan = i % 2 == 0;
    const std::vector<std::uint16_t> order =
        fan ? std::vector<std::uint16_t>{s[0], s[1], s[2], s[3]} : std::vector<std::uint16_t>{s[0], s[1], s[3], s[2]};
    primitives += primitive(position, gltf.indices(order), fan ? ",\"mode\":6" : ",\"mode\":5") + ",";
  }
  const std::size_t line = gltf.indices({0, 1});
  gltf.add_mesh(primitives + primitive(position, line, ",\"mode\":1") + "," + primitive(position, line, ",\"mode\":0"));
  const Assembly assembly = load(folder, gltf);
  REQUIRE(assembly.parts.size() == 2);
  check_box(assembly.parts[0], {0, 0, 0}, {1, 2, 3});
  CHECK(six_volumes(assembly.parts[0]) == 36);  // none is turned over
  CHECK(contains(notes_of(assembly), "mesh 0: 2 primitives of points or lines left out"));
  gltf.meshes.clear();
  gltf.add_mesh(primitive(position, line, ",\"mode\":7"));
  CHECK(contains(error(folder, gltf), "mesh 0: primitive 0: 'mode' 7 is none of glTF"));
  gltf.meshes.clear();
  gltf.add_mesh(primitive(position, line, ",\"mode\":1"));
  CHECK(contains(error(folder, gltf), "scene 0 holds no triangle, so nothing can be said about it"));
}

/// The pose of part "root/x", which is the first of two.
Pose pose_in(const Folder& folder, const std::string& root, const std::string& x) {
  Gltf gltf = boxes_at("{\"name\":\"root\"," + root + "\"children\":[1]},{\"name\":\"x\",\"mesh\":0," + x +
                       "\"extras\":0},{\"mesh\":0,\"translation\":[99,0,0]}");
  gltf.scenes = R"("scenes":[{"nodes":[0,2]}])";
  const Assembly assembly = load(folder, gltf);
  REQUIRE(assembly.parts.size() == 2);
  CHECK(assembly.parts[0].name == "root/x");
  CHECK(assembly.parts[1].name == "node2");
  return assembly.parts[0].pose;
}

TEST_CASE("glTF: poses are whole products", "[assembly]") {
  const Folder folder;
  const double h = 0.5;
  // scaled by 2 along x behind a turn of 45 degrees, which shears
  const Pose sheared =
      pose_in(folder, R"("scale":[2,1,1],)", R"("rotation":[0,0,0.3826834323650898,0.9238795325112867],)");
  const double r = std::sqrt(h);
  Eigen::Matrix3d expected;
  expected << 2 * r, -2 * r, 0, r, r, 0, 0, 0, 1;
  CHECK((sheared.linear() - expected).cwiseAbs().maxCoeff() < 1e-15);
  // a matrix column by column, sheared, behind a translation
  const Pose matrix =
      pose_in(folder, R"("translation":[10,0,0],)", R"("matrix":[1,0,0,0, 0.5,1,0,0, 0,0,-1,0, 1,2,3,1],)");
  expected << 1, h, 0, 0, 1, 0, 0, 0, -1;
  CHECK((matrix.linear() == expected));
  CHECK((Vec3d(matrix.translation()) == Vec3d(11, 2, 3)));
  // quarter turns, as doubles and in the singles of several programs
  expected << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  for (const char* const digits : {"0.7071067811865475", "0.70710683", "0.70710677", "0.707107"}) {
    const std::string rotation = std::string("\"rotation\":[") + digits + ",0,0," + digits + "],";
    CHECK((pose_in(folder, "", rotation).linear() == expected));
  }
  CHECK(pose_in(folder, "", R"("scale":[-1,1,1],)").linear().determinant() == -1);
}

TEST_CASE("glTF: mirrored parts are solids that meet", "[assembly]") {
  const Folder folder;
  const Assembly assembly = load(folder, boxes_at(R"({"mesh":0,"name":"a"},{"mesh":0,"name":"b","scale":[-1,1,1]})"));
  check_box(assembly.parts[1], {-1, 0, 0}, {0, 2, 3});
  const AssemblyReport report = check(assembly);
  REQUIRE(report.pairs.size() == 1);
  CHECK(report.pairs[0].verdict == PairVerdict::touching);
}

TEST_CASE("glTF: names that are absent or doubled get numbers", "[assembly]") {
  const Folder folder;
  Gltf gltf = boxes_at(R"({"mesh":0,"name":"bolt"},{"mesh":0,"name":"bolt"},{"mesh":0},{"mesh":0,"name":"a\nb"})");
  gltf.scenes = R"("scenes":[{"nodes":[0,1,2,3]}])";
  const Assembly assembly = load(folder, gltf);
  REQUIRE(assembly.parts.size() == 4);
  CHECK(assembly.parts[0].name == "bolt");
  CHECK(assembly.parts[1].name == "bolt#2");
  CHECK(assembly.parts[2].name == "node2");
  CHECK(assembly.parts[3].name == "a b");
}

TEST_CASE("glTF: one scene is judged, and what is outside is counted", "[assembly]") {
  const Folder folder;
  Gltf gltf = boxes_at(R"({"mesh":0,"name":"a"},{"mesh":0,"name":"b"},{"mesh":0,"name":"c"})");
  gltf.scenes = R"("scene":1,"scenes":[{"nodes":[0]},{"nodes":[1,2]}])";
  const Assembly chosen = load(folder, gltf);
  CHECK(chosen.parts[0].name == "b");
  CHECK(contains(notes_of(chosen), "1 node with a mesh is outside scene 1 and left out"));
  gltf.scenes = R"("scenes":[{"nodes":[0,1]},{"nodes":[2]}])";
  const Assembly first = load(folder, gltf);
  CHECK(first.parts[0].name == "a");
  CHECK(contains(notes_of(first), "holds 2 scenes and does not say which; scene 0 is judged"));
  gltf.scenes = R"("scene":4,"scenes":[{"nodes":[0,1]}])";
  CHECK(contains(error(folder, gltf), "names scene 4, and there are 1"));
  gltf.scenes = R"("scenes":[])";
  CHECK(contains(error(folder, gltf), "holds no scene"));
}

TEST_CASE("glTF: sparse accessors and quantised positions", "[assembly]") {
  const Folder folder;
  SECTION("sparse, without a bufferView") {
    Gltf gltf;
    const std::vector<float> numbers = corner_numbers();
    const std::size_t where = gltf.add_view(bytes_of(std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7}));
    const std::size_t what = gltf.add_view(bytes_of(std::vector<float>(numbers.begin() + 3, numbers.end())));
    const std::size_t position = gltf.add_accessor(
        R"({"componentType":5126,"count":8,"type":"VEC3","sparse":{"count":7,"indices":{"componentType":5121,"bufferView":)" +
        std::to_string(where) + "},\"values\":{\"bufferView\":" + std::to_string(what) + "}}}");
    gltf.add_mesh(primitive(position, gltf.indices(triangle_corners())));
    check_box(load(folder, gltf).parts[0], {0, 0, 0}, {1, 2, 3});
    gltf.accessors = replaced(gltf.accessors, "\"count\":8", "\"count\":7");
    CHECK(contains(error(folder, gltf), "sparse: indices: names element 7, and there are 7"));
  }
  SECTION("integers") {
    for (const auto& [type, greatest, normalized] : std::vector<std::array<int, 3>>{
             {5120, 127, 1}, {5121, 255, 1}, {5122, 32767, 1}, {5123, 65535, 1}, {5122, 7, 0}}) {
      Gltf gltf;
      std::string bytes;
      for (const float number : corner_numbers()) {
        const auto value = static_cast<std::uint32_t>(number != 0 ? greatest : 0);
        bytes += static_cast<char>(value & 0xffU);
        if (type >= 5122) bytes += static_cast<char>(value >> 8);
      }
      const std::size_t position =
          gltf.add_accessor(gltf.add_view(bytes), type, 8, "VEC3", normalized != 0 ? ",\"normalized\":true" : "");
      gltf.add_mesh(primitive(position, gltf.indices(triangle_corners())));
      gltf.more = R"("extensionsRequired":["KHR_mesh_quantization"],)";
      const double side = normalized != 0 ? 1 : greatest;
      CHECK((box_of(load(folder, gltf).parts[0])[1] == Vec3d::Constant(side)));
    }
  }
  SECTION("the least integer is -1") {
    Gltf gltf;
    const std::size_t position =
        gltf.add_accessor(gltf.add_view(bytes_of(std::vector<std::int16_t>{-32768, 0, 0, 0, 32767, 0, 0, 0, 16384})),
                          5122, 3, "VEC3", ",\"normalized\":true");
    gltf.add_mesh(primitive(position, gltf.indices({0, 1, 2})));
    const auto box = box_of(load(folder, gltf).parts[0]);
    CHECK((box[0] == Vec3d(-1, 0, 0)));
    CHECK((box[1] == Vec3d(0, 1, 16384.0 / 32767)));
  }
}

TEST_CASE("glTF: instances, hidden parts, animations", "[assembly]") {
  const Folder folder;
  Gltf gltf = boxes();
  const std::size_t moves = gltf.floats({10, 0, 0, 20, 0, 0, 30, 0, 0}, "VEC3");
  gltf.more = R"("extensionsRequired":["EXT_mesh_gpu_instancing"],"animations":[{}],)";
  gltf.nodes =
      R"({"mesh":0,"name":"a","translation":[0,5,0],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":)" +
      std::to_string(moves) +
      R"(}}}},{"name":"b","children":[2],"extensions":{"KHR_node_visibility":{"visible":false}}},{"mesh":0,"name":"c"})";
  const Assembly assembly = load(folder, gltf);
  REQUIRE(assembly.parts.size() == 4);
  check_box(assembly.parts[2], {30, 5, 0}, {31, 7, 3});
  CHECK(assembly.parts[1].name == "a#2");
  CHECK(contains(notes_of(assembly), "part 'b/c' is hidden, and judged as the others"));
  CHECK(contains(notes_of(assembly), "1 animation is left out"));
  gltf.nodes = replaced(gltf.nodes, "TRANSLATION", "_OTHER");
  CHECK(contains(error(folder, gltf), "has none of TRANSLATION, ROTATION and SCALE"));
}

TEST_CASE("glTF: what is not read is refused by its name", "[assembly]") {
  const Folder folder;
  Gltf gltf = boxes();
  for (const std::string name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "VENDOR_new"}) {
    gltf.more = "\"extensionsRequired\":[\"" + name + "\"],";
    CHECK(error(folder, gltf) == "x.gltf: needs the extension " + name + ", which is not read; export it without");
  }
  gltf.more = R"("extensionsRequired":["KHR_materials_unlit","KHR_texture_transform"],)";
  CHECK(error(folder, gltf).empty());
  CHECK(contains(error(folder, boxes_at(R"({"mesh":0,"name":"a","skin":0},{"mesh":0})")), "node 0 ('a'): has a skin"));
  CHECK(contains(error(folder, boxes_at(R"({"mesh":0,"weights":[0,1]},{"mesh":0})")), "node 0: has a morph target"));
  CHECK(contains(error(folder, boxes(",\"weights\":[1]")), "has a morph target with a weight other than 0"));
  CHECK(error(folder, boxes(",\"weights\":[0]")).empty());
  Gltf packed;
  const std::size_t position = packed.add_accessor(R"({"componentType":5126,"count":8,"type":"VEC3"})");
  packed.add_mesh(primitive(position, packed.indices({0, 1, 2}), R"(,"extensions":{"KHR_draco_mesh_compression":{}})"));
  CHECK(contains(error(folder, packed), "is packed by KHR_draco_mesh_compression"));
  folder.write("x.gltf", boxes().json("\"extensions\":{\"EXT_meshopt_compression\":{}},"));
  CHECK(
      contains(folder.error_of("x.gltf"), "buffer 0: has no data that is read, only that of EXT_meshopt_compression"));
}

TEST_CASE("glTF: each mistake has its sentence", "[assembly]") {
  const Folder folder;
  const std::string sound = boxes().text();
  const auto with = [&](const std::string& from, const std::string& to) {
    folder.write("x.gltf", replaced(sound, from, to));
    return folder.error_of("x.gltf");
  };
  CHECK(contains(with("\"2.0\"", "\"1.0\""), "is glTF 1.0, and 2.0 is read"));
  CHECK(contains(with("\"2.0\"", "\"2.1\",\"minVersion\":\"2.1\""), "needs a reader of glTF 2.1"));
  CHECK(contains(with("\"version\"", "\"ver\""), "'asset' names no version"));
  CHECK(contains(with("{\"asset\"", "{\"asset\"\""), "its JSON is wrong at byte"));
  CHECK(contains(with("[5,0,0]", "[5,0]"), "node 1 ('b'): 'translation' must be a list of 3 numbers, and has 2"));
  CHECK(contains(with("[5,0,0]", "[5,0,1e999]"), "a number that no double holds"));
  CHECK(contains(with("[5,0,0]", "[5,0,1e200]"), "its pose has a number beyond 2^400"));
  CHECK(contains(with("[5,0,0]", "\"5\""), "'translation' must be a list"));
  CHECK(contains(with("\"translation\":[5,0,0]", "\"scale\":[1,0,1]"), "flattens space"));
  CHECK(contains(with("\"translation\":[5,0,0]", "\"rotation\":[0,0,0,0]"), "'rotation' has no length"));
  CHECK(contains(with("\"translation\":[5,0,0]", "\"matrix\":[1,0,0,5,0,1,0,0,0,0,1,0,0,0,0,1]"), "as its last row"));
  CHECK(contains(with("\"translation\":[5,0,0]", "\"children\":[0]"), "node 0 ('a'): is there twice in the tree"));
  CHECK(contains(with("\"translation\":[5,0,0]", "\"children\":[7]"), "names node 7, and there are 2"));
  CHECK(contains(with("\"mesh\":0", "\"mesh\":3"), "node 0 ('a'): names mesh 3, and there are 1"));
  CHECK(contains(with("\"mesh\":0", "\"mesh\":-1"), "'mesh' must be a whole number that is at least 0"));
  CHECK(contains(with("\"POSITION\":0", "\"POSITION\":9"), "names accessor 9, and there are 2"));
  CHECK(contains(with("\"POSITION\"", "\"NORMAL\""), "mesh 0: primitive 0: has no POSITION"));
  CHECK(contains(with("\"count\":8", "\"count\":9"), "accessor 0: reaches beyond its bufferView"));
  CHECK(contains(with("\"count\":8", "\"count\":7"), "names vertex 7, and there are 7"));
  CHECK(contains(with("\"count\":8", "\"count\":99999999999"), "takes more memory than the file may ask for"));
  CHECK(contains(with("\"count\":36", "\"count\":35"), "has 35 corners, which make no triangles"));
  CHECK(contains(with("5126", "5130"), "'componentType' 5130 is none of glTF"));
  CHECK(contains(with("5126", "5125"), "must hold floats or integers of 8 or 16 bits"));
  CHECK(contains(with("5123", "5122"), "indices must be unsigned integers"));
  CHECK(contains(with("VEC3", "VEC2"), "'type' must be VEC3"));
  CHECK(contains(with("\"byteLength\":96", "\"byteLength\":99999"), "bufferView 0: reaches beyond its buffer"));
  CHECK(contains(with("base64,", "base64,*"), "its data URI is not base64"));
  CHECK(contains(with("base64,AAAA", "base64,"), "bytes, and says"));
  Gltf broken = boxes();
  const std::vector<float> bad(1, std::numeric_limits<float>::quiet_NaN());
  broken.binary.replace(12, 4, bytes_of(bad));
  CHECK(contains(error(folder, broken), "accessor 0: element 1 is not a finite number"));
  for (const std::string uri : {"../x.bin", "/etc/passwd", "http://a/b", "..%2Fx.bin"}) {
    folder.write("x.gltf", boxes().json("\"uri\":\"" + uri + "\","));
    CHECK(contains(folder.error_of("x.gltf"), "is not in the folder of the file"));
  }
  folder.write("x.gltf", boxes().json("\"uri\":\"none.bin\","));
  CHECK(contains(folder.error_of("x.gltf"), "buffer 0: none.bin: "));
  const std::string glb = boxes().glb();
  for (const std::size_t size : {8U, 16U, 200U}) {
    folder.write("x.glb", glb.substr(0, size));
    CHECK(contains(folder.error_of("x.glb"), "the GLB is cut off or broken"));
  }
  folder.write("x.glb", replaced(glb, std::string("glTF\2", 5), std::string("glTF\1", 5)));
  CHECK(contains(folder.error_of("x.glb"), "is a GLB of version 1"));
  folder.write("x.glb", glb);
  AssemblyLoadOptions little;
  little.most_unpacked_bytes = 100;
  CHECK(contains(folder.error_of("x.glb", little), "takes more memory than the file may ask for"));
  folder.write("x.toml", "[[part]]\nfile = \"x.glb\"\n");
  CHECK(contains(folder.error_of("x.toml"), "x.glb is an assembly of its own, no mesh; give it as ASSEMBLY"));
}

TEST_CASE("3MF: items are placed meshes, in the unit of the file", "[assembly]") {
  const Folder folder;
  const Assembly assembly = load_assembly(write_model(folder, model(box_object(), two_items)));
  CHECK(assembly.unit == "mm");
  REQUIRE(assembly.parts.size() == 2);
  CHECK(assembly.parts[0].name == "box");
  CHECK(assembly.parts[1].name == "box#2");
  CHECK(&assembly.parts[0].object.mesh() == &assembly.parts[1].object.mesh());
  check_box(assembly.parts[1], {5, 0, 0}, {6, 2, 3});
  for (const auto& [name, unit] : {std::pair("micron", "um"), std::pair("inch", "in"), std::pair("foot", "ft"),
                                   std::pair("meter", "m"), std::pair("centimeter", "cm")}) {
    const std::string attribute = std::string("unit=\"") + name + "\"";
    CHECK(load_assembly(write_model(folder, model(box_object(), two_items, attribute))).unit == unit);
  }
  const std::string whole = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" +
                            replaced(model(box_object(), two_items), "<item ", "<item printable=\"0\" ");
  CHECK(load_assembly(write_model(folder, whole)).parts.size() == 2);
}

TEST_CASE("3MF: row vectors, component first, decimals as doubles", "[assembly]") {
  const Folder folder;
  const std::string objects = box_object() +
                              R"(<object id="2" name="pair"><components><component objectid="1"/>)"
                              R"(<component objectid="1" transform="-1 0 0 0 1 0 0 0 1 0.1000000000000001 0 0"/>)"
                              R"(</components></object>)";
  const Assembly assembly = load_assembly(
      write_model(folder, model(objects, R"(<item objectid="2" transform="0 1 0 -1 0 0 0 0 1 10 20 30"/>)")));
  REQUIRE(assembly.parts.size() == 2);
  CHECK(assembly.parts[0].name == "pair/box");
  CHECK(assembly.parts[1].name == "pair/box#2");
  CHECK((Vec3d(assembly.parts[0].pose * Vec3d(1, 0, 0)) == Vec3d(10, 21, 30)));
  CHECK((Vec3d(assembly.parts[1].pose * Vec3d(0, 0, 0)) == Vec3d(10, 20 + 0.1000000000000001, 30)));
  CHECK(assembly.parts[1].pose.linear().determinant() == -1);
  const std::string digits = replaced(model(box_object(), two_items), "x=\"1\"", "x=\"0.1000000000000001\"");
  CHECK(load_assembly(write_model(folder, digits)).parts[0].object.mesh().vertices[1].x() == 0.1000000000000001);
}

TEST_CASE("3MF: types, relations, other model parts", "[assembly]") {
  const Folder folder;
  const std::string support = box_object(R"(id="2" type="support")") + box_object(R"(id="3" type="solidsupport")");
  const Assembly assembly = load_assembly(write_model(
      folder,
      model(box_object() + support, two_items + R"(<item objectid="2"/><item objectid="3" partnumber="P7"/>)")));
  REQUIRE(assembly.parts.size() == 3);
  CHECK(assembly.parts[2].name == "P7");
  CHECK(contains(notes_of(assembly), "1 placed object of type support left out"));
  const std::string relations =
      R"(<Relationships><Relationship Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel" Target="/a/main.model"/></Relationships>)";
  const std::string other = R"(<item objectid="1" p:path="/b/Other.model"/>)";
  const std::string required = R"(requiredextensions="p")";
  const std::string through =
      R"(<object id="9" name="nine"><components><component objectid="1" p:path="/b/other.model"/></components></object>)";
  write_zip(folder, {{"_rels/.rels", relations},
                     {"a/main.model", model(through, other + R"(<item objectid="9"/>)", required)},
                     {"b/other.model", model(box_object(), "")}});
  const Assembly parts = load_assembly(folder.file("x.3mf"));
  REQUIRE(parts.parts.size() == 2);
  CHECK(parts.parts[1].name == "nine/box");
  write_zip(folder, {{"_rels/.rels", relations},
                     {"a/main.model", model("", other)},
                     {"b/other.model", model(box_object(), "", "unit=\"inch\"")}});
  CHECK(contains(folder.error_of("x.3mf"), "its unit is in, that of the main model mm, which is not read"));
  write_zip(folder, {{"_rels/.rels", relations}, {"a/main.model", model("", replaced(other, "/b/", "/../b/"))}});
  CHECK(contains(folder.error_of("x.3mf"), "which is not in the archive"));
  write_zip(folder, {{"_rels/.rels", relations}, {"a/main.model", model("", other)}});
  CHECK(contains(folder.error_of("x.3mf"), "holds no 'b/Other.model'"));
}

TEST_CASE("3MF: each mistake has its sentence", "[assembly]") {
  const Folder folder;
  const std::string sound = model(box_object(), two_items);
  const auto with = [&](const std::string& from, const std::string& to) {
    return model_error(folder, replaced(sound, from, to));
  };
  const std::string beams = "xmlns:b=\"http://b/2017\" requiredextensions=\"b\" ";
  CHECK(contains(with("xmlns:p", beams + "xmlns:p"), "needs the extension http://b/2017, which is not read"));
  CHECK(contains(with("</triangles>", "</triangles><b:beamlattice/>"), "object 1: has a beam lattice"));
  CHECK(contains(with("xmlns:p", "unit=\"ell\" xmlns:p"), "unit 'ell' is none of 3MF"));
  CHECK(contains(with("<model", "<modell"), "its XML is wrong at byte"));
  CHECK(contains(model_error(folder, "<html/>"), "holds no <model>"));
  CHECK(contains(with("objectid=\"1\"", "objectid=\"8\""), "item 1: names object '8', which is not there"));
  CHECK(contains(with("1 5 0 0", "1 5 0"), "item 2: 'transform' must be 12 numbers, and has 11"));
  CHECK(contains(with("1 5 0 0", "1 5 0 x"), "'transform' has 'x', which is no finite number"));
  CHECK(contains(with("1 0 0 0 1 0 0 0 1 5", "0 0 0 0 1 0 0 0 1 5"), "item 2: its pose flattens space"));
  CHECK(contains(with("x=\"1\"", "x=\"nan\""), "object 1: vertex 1: 'x' is 'nan', which is no finite number"));
  CHECK(contains(with("x=\"1\"", ""), "object 1: vertex 1: 'x' is ''"));
  CHECK(contains(with("v1=\"0\"", "v1=\"8\""), "object 1: triangle 0: 'v1' is 8, and there are 8 vertices"));
  CHECK(contains(with("id=\"1\" name", "id=\"1\" type=\"other\" name"),
                 "is of type other, which must not be in a build"));
  CHECK(contains(with("id=\"1\" name", "id=\"1\" type=\"new\" name"), "type 'new' is none of 3MF"));
  CHECK(contains(model_error(folder, model(box_object(), "")), "its build holds no triangle"));
  CHECK(contains(model_error(folder, model(box_object() + box_object(), two_items)), "object 1 is there twice"));
  const std::string shape = R"(<object id="1"><v:volume/></object>)";
  CHECK(
      contains(model_error(folder, model(shape, two_items)), "neither a mesh nor components, but v:volume, which is"));
  const std::string loop = R"(<object id="1"><components><component objectid="1"/></components></object>)";
  CHECK(contains(model_error(folder, model(loop, two_items)), "object 1 is a component of itself"));
  const std::string empty = R"(<object id="1"><mesh><vertices/><triangles/></mesh></object>)";
  CHECK(contains(model_error(folder, model(empty, two_items)), "its build holds no triangle"));
  write_model(folder, sound);
  AssemblyLoadOptions little;
  little.most_unpacked_bytes = 100;
  CHECK(contains(folder.error_of("x.3mf", little), "unpacks to more than the file may ask for"));
  std::string doubled = box_object(R"(id="0")");  // 2^40 boxes
  for (int i = 1; i <= 40; ++i) {
    const std::string component = "<component objectid=\"" + std::to_string(i - 1) + "\"/>";
    doubled +=
        "<object id=\"" + std::to_string(i) + "\"><components>" + component + component + "</components></object>";
  }
  write_model(folder, model(doubled, R"(<item objectid="40"/>)"));
  little.most_unpacked_bytes = 1'000'000;
  CHECK(contains(folder.error_of("x.3mf", little), "places more than the file may ask for"));
  folder.write("x.3mf", "no zip");
  CHECK(contains(folder.error_of("x.3mf"), "cannot be read as a zip archive"));
  write_zip(folder, {{"a.txt", "a"}});
  CHECK(contains(folder.error_of("x.3mf"), "holds no '3D/3dmodel.model', so it is no 3MF"));
}
