// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/grid/local_grid.hpp>
#include <cchip/mesh_file.hpp>
#include <cchip/program/csv_reader.hpp>
#include <cchip/program/usage_error.hpp>
#include <map>

#include "candidates.hpp"
#include "engines.hpp"
#include "mesh_source.hpp"
#include "pose.hpp"
#include "support.hpp"

using namespace cchip;
using namespace cchip::app;
using namespace cchip::test;

namespace {

std::string model(const std::string& path) { return std::string(CCHIP_TEST_MODELS) + "/" + path; }

/// Summary of meshpairs.
std::string summary_of(const std::string& a, const std::string& b, std::vector<std::string> options) {
  std::vector<std::string> arguments = {"meshpairs", a, b, "--format", "csv"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = run_cchip(arguments);
  CAPTURE(a, b, outcome.err);
  REQUIRE(outcome.code == exit_ok);
  return last_line(outcome.err);
}

bool boxes_overlap(const Primitive& p, const Primitive& q) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto less = [axis](const Vec3d& v, const Vec3d& w) { return v[axis] < w[axis]; };
    const auto low = [&](const Primitive& t) {
      return (*std::min_element(t.v.data(), t.v.data() + t.vertex_count(), less))[axis];
    };
    const auto high = [&](const Primitive& t) {
      return (*std::max_element(t.v.data(), t.v.data() + t.vertex_count(), less))[axis];
    };
    if (low(p) > high(q) || low(q) > high(p)) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("meshpairs: rows are all pairs with overlapping boxes, answers exact", "[system][meshpairs]") {
  const std::string file_a = model("OBJ/box.obj");  // of quads
  const std::string file_b = model("STL/Spider_ascii.stl");
  const std::string pose = "0.3,0.1,0.2,10,20,30";
  const std::string program = GENERATE("exhaustive", "directed");
  const Outcome outcome = run_cchip(
      {"meshpairs", file_a, file_b, "--pose", pose, "--engine", "model", "--program", program, "--format", "csv"});
  REQUIRE(outcome.code == exit_ok);
  CHECK(lines(outcome.err).size() == 1);

  const Mesh a = load_mesh(file_a, FaceKinds::triangles_and_quads);
  const Mesh b = transformed(load_mesh(file_b), parse_pose(pose));
  std::vector<std::string> expected;
  for (std::size_t i = 0; i < a.faces.size(); ++i) {
    for (std::size_t j = 0; j < b.faces.size(); ++j) {
      if (!boxes_overlap(a.primitive(i), b.primitive(j))) continue;
      const bool hit = exact_intersects(a.primitive(i), b.primitive(j));
      expected.push_back(std::to_string(i) + "," + std::to_string(j) + "," + (hit ? "1" : "0"));
    }
  }
  REQUIRE_FALSE(expected.empty());

  std::istringstream in(outcome.out);
  CsvReader reader(in, "output");
  CsvRow row;
  REQUIRE(reader.next(row));
  CHECK(row.fields.at(0) == "face_a");
  CHECK(row.fields.at(1) == "face_b");
  CHECK(row.fields.at(2) == "hit");
  std::vector<std::string> got;
  while (reader.next(row)) got.push_back(row.fields.at(0) + "," + row.fields.at(1) + "," + row.fields.at(2));
  std::sort(got.begin(), got.end());
  std::sort(expected.begin(), expected.end());
  CHECK(got == expected);
}

TEST_CASE("meshpairs: the engines agree on the grid of real meshes", "[system][meshpairs]") {
  struct Case {
    std::string a;
    std::string b;
    std::string pose;
  };
  const Case c = GENERATE(values<Case>({{"OFF/Wuson.off", "OBJ/WusonOBJ.obj", "0.5,0.25,-0.125,0,0,20"},
                                        {"OBJ/spider.obj", "STL/Spider_binary.stl", "3,5,7,0,90,0"},
                                        {"PLY/cube.ply", "OFF/Cube.off", "0.5,0.4,0.3,20,30,40"},
                                        {"OBJ/box.obj", "OBJ/box.obj", "0.3,0.1,0.2,10,20,30"},
                                        {"OBJ/WusonOBJ.obj", "OBJ/box.obj", "0,1,0,40,50,60"}}));
  const PairMode mode = GENERATE(PairMode::exhaustive, PairMode::directed);
  CAPTURE(c.a, c.b, c.pose);
  std::vector<GridPair> pairs;
  const Mesh mesh_a = load_mesh(model(c.a), FaceKinds::triangles_and_quads);
  const Mesh mesh_b = transformed(load_mesh(model(c.b), FaceKinds::triangles_and_quads), parse_pose(c.pose));
  for_each_candidate(mesh_a, mesh_b, 3000,
                     [&](const PairJob& job) { pairs.push_back(quantise(job.a, job.b, defs::coord_w_default).pair); });
  REQUIRE_FALSE(pairs.empty());
  const auto run = [&](EngineKind kind) {
    EngineOptions options;
    options.kind = kind;
    return make_engine(options)->run(pairs, mode);
  };
  const auto rtl = run(EngineKind::rtl);
  const auto clock_model = run(EngineKind::model);
  const auto eigen = run(EngineKind::eigen);
  const auto exact = run(EngineKind::exact);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    CAPTURE(i);
    REQUIRE(rtl[i].grid == clock_model[i].grid);
    REQUIRE(rtl[i].definite == clock_model[i].definite);
    REQUIRE(rtl[i].axis == clock_model[i].axis);
    REQUIRE(rtl[i].beats == clock_model[i].beats);
    REQUIRE(rtl[i].clocks->answered == clock_model[i].clocks->answered);
    REQUIRE(eigen[i].grid == exact[i].grid);
    REQUIRE(rtl[i].grid == exact[i].grid);
    hits += exact[i].grid;
  }
  CHECK(hits > 0);
  CHECK(hits < pairs.size());
}

TEST_CASE("meshpairs: a PLY shows the faces that hit", "[system][meshpairs]") {
  const TemporaryFolder folder;
  const std::string file_a = model("OBJ/box.obj");  // of quads
  const std::string file_b = model("STL/Spider_ascii.stl");
  const std::string pose = "0.3,0.1,0.2,10,20,30";
  const std::string ply = folder.path("hits.ply");
  const Outcome outcome =
      run_cchip({"meshpairs", file_a, file_b, "--pose", pose, "--engine", "exact", "--format", "csv", "--ply", ply});
  REQUIRE(outcome.code == exit_ok);

  const Mesh a = load_mesh(file_a, FaceKinds::triangles_and_quads);
  const Mesh b = transformed(load_mesh(file_b), parse_pose(pose));
  const Mesh picture = load_mesh(ply, FaceKinds::triangles_and_quads);
  REQUIRE(picture.faces.size() == 2 * a.faces.size() + b.faces.size());  // quads beside triangles are cut in two
  // Each face has its own vertices: three doubles and three bytes of colour.
  const std::string content = folder.read("hits.ply");
  std::size_t at = content.find("end_header\n") + 11;
  std::size_t vertex = 0;
  std::map<std::string, std::size_t> colours_a;
  std::map<std::string, std::size_t> colours_b;
  for (std::size_t i = 0; i < a.faces.size() + b.faces.size(); ++i) {
    const bool of_a = i < a.faces.size();
    const Primitive face = of_a ? a.primitive(i) : b.primitive(i - a.faces.size());
    for (std::size_t k = 0; k < face.vertex_count(); ++k) REQUIRE(face.v[k] == picture.vertices[vertex++]);
    bool hit = false;
    const Mesh& other = of_a ? b : a;
    for (std::size_t k = 0; k < other.faces.size() && !hit; ++k) hit = exact_intersects(face, other.primitive(k));
    for (std::size_t k = 0; k < face.vertex_count(); ++k, at += 27) {
      ++(of_a ? colours_a : colours_b)[content.substr(at + 24, 3) + (hit ? " hit" : "")];
    }
  }
  for (const auto& colours : {colours_a, colours_b}) {
    REQUIRE(colours.size() == 2);  // one colour for all that hit, another for all others
    CHECK(colours.begin()->first.substr(0, 3) != colours.rbegin()->first.substr(0, 3));
    CHECK(colours.begin()->first.size() + colours.rbegin()->first.size() == 3 + 7);
  }

  const Outcome refused =
      run_cchip({"meshpairs", file_a, file_b, "--engine", "exact", "--ply", "/no/such/folder/x.ply"});
  CHECK(refused.code == exit_usage);
  CHECK(refused.out.empty());
  CHECK(refused.err ==
        "cchip: /no/such/folder/x.ply: cannot be written (No such file or directory); check folder, permissions and "
        "disk space\n");
}

TEST_CASE("meshpairs: one model in four file formats", "[system][meshpairs]") {
  const std::vector<std::string> wuson = {model("OBJ/WusonOBJ.obj"), model("STL/Wuson.stl"), model("PLY/Wuson.ply"),
                                          model("OFF/Wuson.off")};
  const std::string first = summary_of(wuson[0], wuson[0], {"--engine", "exact", "--pose", "0.1,0.05,-0.02,0,0,20"});
  CHECK(count(first, "hits") > 0);
  for (const std::string& a : wuson) {
    for (const std::string& b : {wuson[1], wuson[3]}) {
      CAPTURE(a, b);
      CHECK(summary_of(a, b, {"--engine", "exact", "--pose", "0.1,0.05,-0.02,0,0,20"}) == first);
    }
  }
}

TEST_CASE("meshpairs: polygons with more corners are cut, with a notice", "[system][meshpairs]") {
  const TemporaryFolder folder;
  const std::string prism = folder.write("prism.obj",
                                         "v 2 0 0\nv 4 0 0\nv 5 2 0\nv 3 4 0\nv 1 2 0\n"
                                         "v 2 0 3\nv 4 0 3\nv 5 2 3\nv 3 4 3\nv 1 2 3\n"
                                         "f 5 4 3 2 1\nf 6 7 8 9 10\nf 1 2 7 6\nf 2 3 8 7\nf 3 4 9 8\nf 4 5 10 9\n"
                                         "f 5 1 6 10\n");
  const Outcome outcome = run_cchip(
      {"meshpairs", prism, prism, "--pose", "0,0,3", "--engine", "model", "--program", "directed", "--format", "csv"});
  CHECK(outcome.code == exit_ok);
  const auto messages = lines(outcome.err);
  REQUIRE(messages.size() == 3);  // one for A, one for B, the summary
  CHECK(messages[0] == "cchip: " + prism + ": 2 faces with more than four corners or a dent were cut into triangles");
  CHECK(messages[1] == messages[0]);
  const std::string exact = summary_of(prism, prism, {"--pose", "0,0,3", "--engine", "exact"});
  for (const char* number : {"pairs", "hits", "mismatches"}) CHECK(count(messages[2], number) == count(exact, number));
  CHECK(count(exact, "hits") > 10);
  const std::string box = model("OBJ/box.obj");
  CHECK(count(summary_of(box, box, {"--engine", "exact"}), "pairs") == 36 - 3 * 2);  // all but opposite faces
}

TEST_CASE("meshpairs: pose as numbers and as matrix", "[system][meshpairs]") {
  const std::string cube = model("OFF/Cube.off");
  const auto by_pose = summary_of(cube, cube, {"--engine", "exact", "--pose", "0.25,0,0.5,0,0,90"});
  const auto by_matrix =
      summary_of(cube, cube, {"--engine", "exact", "--pose-matrix", "0,-1,0,0.25,1,0,0,0,0,0,1,0.5"});
  CHECK(by_pose == by_matrix);
  CHECK(count(by_pose, "hits") > 0);
  CHECK(by_pose != summary_of(cube, cube, {"--engine", "exact"}));
}

TEST_CASE("meshpairs: no candidates, limited candidates", "[system][meshpairs]") {
  const std::string cube = model("OFF/Cube.off");
  CHECK(summary_of(cube, cube, {"--engine", "model", "--pose", "1000,0,0"}) ==
        "pairs=0 hits=0 mismatches=0 indefinite=0 beats_mean=0.00 clocks=0");
  CHECK(count(summary_of(cube, cube, {"--engine", "exact"}), "pairs") > 7);
  CHECK(count(summary_of(cube, cube, {"--engine", "exact", "--limit", "7"}), "pairs") == 7);
}
