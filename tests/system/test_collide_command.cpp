// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/internal/judge/brute_force.hpp>
#include <cchip/mesh_file.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/program/usage_error.hpp>
#include <cchip/shapes.hpp>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <streambuf>

#include "pose.hpp"
#include "support.hpp"

using namespace cchip;
using namespace cchip::app;
using namespace cchip::test;

namespace {

const std::string cube_file = std::string(CCHIP_TEST_MODELS) + "/OFF/Cube.off";  // six quads, from -0.5 to 0.5
const std::string poses_header = "r00,r01,r02,r10,r11,r12,r20,r21,r22,tx,ty,tz";

Outcome collide_cubes(std::vector<std::string> options) {
  options.insert(options.begin(), {"collide", cube_file, cube_file});
  return run_cchip(options);
}

std::vector<std::string> rows_of(const std::vector<Contact>& contacts) {
  std::vector<std::string> rows = {"face_a,face_b,relation"};
  for (const Contact& c : contacts) {
    rows.push_back(std::to_string(c.face_a) + "," + std::to_string(c.face_b) +
                   (c.relation == Relation::crossing ? ",crossing" : ",touching"));
  }
  return rows;
}

}  // namespace

TEST_CASE("collide: the first line is the answer, the last one the summary", "[system][collide]") {
  const Outcome apart = collide_cubes({"--pose", "1.0000000000000002,0,0"});
  CHECK(apart.code == exit_ok);
  CHECK(lines(apart.out).size() == 2);
  CHECK(lines(apart.out).front() == "apart");
  CHECK(last_line(apart.out) == "1 query, 0 contacts");
  CHECK(apart.err.empty());
  // They share the corner (0.5, 0.5, 0.5), where three faces of each meet.
  const Outcome corner = collide_cubes({"--pose", "1,1,1"});
  CHECK(lines(corner.out).front() == "touch: 3 faces of A meet 3 of B");
  CHECK(lines(corner.out).at(1) == "face_a  face_b  relation");
  CHECK(last_line(corner.out) == "1 query, 9 contacts");
  const Outcome first = collide_cubes({"--pose", "1,1,1", "--contacts", "first"});
  CHECK(lines(first.out).size() == 2);
  CHECK(lines(first.out).front().rfind("touch: face ", 0) == 0);
  const Outcome two = collide_cubes({"--pose", "1,1,1", "--most", "2"});
  CHECK(lines(two.out).front().rfind("touch: at least ", 0) == 0);
  CHECK(last_line(two.out) == "1 query, 2 contacts");
  CHECK(last_line(first.out) == "1 query, 1 contact");
  // The lines for programs: mismatches only where something was compared.
  CHECK(last_line(collide_cubes({"--pose", "1,1,1", "--format", "csv"}).err)
            .rfind("queries=1 hits=1 contacts=9 open=", 0) == 0);
}

TEST_CASE("collide: times and colours are for a terminal", "[system][collide]") {
  const auto run = [](const std::string& pose, bool person, bool colour) {
    std::istringstream in;
    std::ostringstream out, err;
    CHECK(run_cli({"collide", cube_file, cube_file, "--pose", pose}, {in, out, err, false, person, colour},
                  hardware()) == exit_ok);
    return lines(out.str());
  };
  CHECK(run("5,0,0", true, true).front() == "\x1b[1;32mapart\x1b[0m");
  CHECK(run("1,1,1", true, true).front() == "\x1b[1;33mtouch: 3 faces of A meet 3 of B\x1b[0m");
  CHECK(run("0.5,0.25,0.125", true, true).front().rfind("\x1b[1;31mcross: ", 0) == 0);
  CHECK(run("5,0,0", true, false).front() == "apart");
  CHECK_THAT(run("5,0,0", true, false).back(), Catch::Matchers::Matches("1 query, 0 contacts, [0-9.e-]+ m?s"));
  CHECK(run("5,0,0", false, false).back() == "1 query, 0 contacts");
}

TEST_CASE("collide: JSON lines tell that there is no contact", "[system][collide]") {
  CHECK(collide_cubes({"--pose", "5,0,0", "--format", "jsonl"}).out == "{\"hit\":0,\"relation\":\"apart\"}\n");
  CHECK(collide_cubes({"--pose", "1,0,0", "--counts", "crossing", "--format", "jsonl"}).out ==
        "{\"hit\":0,\"relation\":\"touching\"}\n");
  CHECK(collide_cubes({"--pose", "5,0,0", "--contacts", "first", "--format", "jsonl"}).out == "{\"hit\":0}\n");
}

TEST_CASE("collide: the exit code tells of contacts if asked for", "[system][collide]") {
  CHECK(collide_cubes({"--pose", "1,1,1"}).code == exit_ok);
  CHECK(collide_cubes({"--pose", "1,1,1", "--exit-code"}).code == exit_contact);
  CHECK(collide_cubes({"--pose", "5,0,0", "--exit-code"}).code == exit_ok);
  CHECK(collide_cubes({"--pose", "1,1,1", "--counts", "crossing", "--exit-code"}).code == exit_ok);
  const TemporaryFolder folder;
  const std::string rows = poses_header + ",touches\n1,0,0,0,1,0,0,0,1,5,0,0,0\n1,0,0,0,1,0,0,0,1,1,1,1,";
  CHECK(collide_cubes({"--poses", folder.write("p.csv", rows + "1\n"), "--exit-code"}).code == exit_contact);
  CHECK(collide_cubes({"--poses", folder.write("p.csv", rows + "0\n"), "--exit-code", "--expect", "touches"}).code ==
        exit_mismatch);
}

TEST_CASE("collide: contacts are those of brute force", "[system][collide]") {
  const std::string spider = std::string(CCHIP_TEST_MODELS) + "/OBJ/spider.obj";  // polygons that have to be cut
  const std::string matrix = "40,0,10,3,0,-50,0,2,5,0,30,1";                      // mirrored, sheared
  const Outcome outcome = run_cchip({"collide", spider, cube_file, "--pose-matrix", matrix, "--format", "csv"});
  REQUIRE(outcome.code == exit_ok);
  const Mesh a = load_mesh(spider, FaceKinds::triangles_and_quads);
  const Mesh b = load_mesh(cube_file, FaceKinds::triangles_and_quads);
  const auto expected = brute_force_contacts(a, Pose::Identity(), b, parse_affine_matrix(matrix));
  REQUIRE(expected.size() > 10);
  CHECK(lines(outcome.out) == rows_of(expected));
  CHECK(count(last_line(outcome.err), "contacts") == expected.size());
  const Outcome json = run_cchip({"collide", spider, cube_file, "--pose-matrix", matrix, "--format", "jsonl"});
  CHECK(lines(json.out).size() == expected.size());
  CHECK(lines(json.out).front() == "{\"face_a\":" + std::to_string(expected[0].face_a) +
                                       ",\"face_b\":" + std::to_string(expected[0].face_b) + ",\"relation\":\"" +
                                       (expected[0].relation == Relation::crossing ? "crossing" : "touching") + "\"}");
}

TEST_CASE("collide: a pose of sixteen numbers", "[system][collide]") {
  const std::string twelve = "0,-1,0,1,1,0,0,0.25,0,0,1,0.125";
  const Outcome outcome = collide_cubes({"--pose-matrix", twelve + ",0,0,-0,1", "--format", "csv"});
  CHECK(outcome.code == exit_ok);
  CHECK(lines(outcome.out).size() > 1);
  CHECK(outcome.out == collide_cubes({"--pose-matrix", twelve, "--format", "csv"}).out);
}

TEST_CASE("collide: the functional model of the chip gives the same contacts", "[system][collide]") {
  for (const char* pose : {"1,1,1", "0.5,0.25,0.125,10,20,30", "1.0000000000000002,0,0"}) {
    CAPTURE(pose);
    const Outcome cpu = collide_cubes({"--pose", pose, "--format", "csv"});
    const Outcome model = collide_cubes({"--pose", pose, "--format", "csv", "--device", "model"});
    CHECK(model.code == exit_ok);
    CHECK(model.out == cpu.out);
    CHECK(count(last_line(model.err), "contacts") == count(last_line(cpu.err), "contacts"));
  }
}

TEST_CASE("collide: poses of a file, expected answers", "[system][collide]") {
  const TemporaryFolder folder;
  const std::string rows =
      "corner, 1,0,0,0,1,0,0,0,1,1,1,1,1,9\n"
      "apart,1,0,0,0,1,0,0,0,1,2,0,0,0,0\n"
      "\"flat, through the middle\",1,0,0,0,1,0,0,0,0,0,0,0,1,20\n";
  const std::string header = "note," + poses_header + ",touches,contacts\n";
  const std::string file = folder.write("poses.csv", header + rows);
  const Outcome good = collide_cubes({"--poses", file, "--expect", "touches", "--format", "csv"});
  CHECK(good.code == exit_ok);
  REQUIRE(lines(good.out).size() == 4);
  CHECK(lines(good.out)[0] == "note,touches,input_contacts,hit,contacts,steps,box_tests,pairs,open");
  CHECK(lines(good.out)[1].rfind("corner,1,9,1,1,", 0) == 0);
  CHECK(lines(good.out)[2].rfind("apart,0,0,0,0,", 0) == 0);
  CHECK(lines(good.out)[3].rfind("\"flat, through the middle\",1,20,1,1,", 0) == 0);
  CHECK(last_line(good.err).rfind("queries=3 hits=2 mismatches=0 contacts=2 ", 0) == 0);

  const Mesh cube = load_mesh(cube_file, FaceKinds::triangles_and_quads);
  Pose flat = Pose::Identity();
  flat(2, 2) = 0;
  // Two squares meet all four walls, four segments meet their own wall and the two beside it.
  CHECK(brute_force_contacts(cube, Pose::Identity(), cube, flat).size() == 2 * 4 + 4 * 3);
  CHECK(collide_cubes({"--poses", file, "--expect", "contacts", "--contacts", "all"}).code == exit_ok);

  const std::string wrong = folder.write("wrong.csv", header + rows + "apart,1,0,0,0,1,0,0,0,1,0,0,7,1,1\n");
  const Outcome table = collide_cubes({"--poses", wrong, "--expect", "touches"});
  CHECK(table.code == exit_mismatch);
  REQUIRE(lines(table.out).size() == 4);
  CHECK(lines(table.out)[2] == "touch in 2 of 4 poses");
  CHECK(lines(table.out)[1].rfind("apart  1        1               5    1         0", 0) == 0);
  CHECK(last_line(table.out) == "4 queries, 2 contacts, 1 differs from column touches");
  const Outcome csv = collide_cubes({"--poses", wrong, "--expect", "contacts", "--contacts", "all", "--format", "csv"});
  CHECK(csv.code == exit_mismatch);
  CHECK(lines(csv.err).front() == "cchip: " + wrong + ":5: expected contacts 1, got 0");
}

TEST_CASE("collide: faces within a distance", "[system][collide]") {
  const auto first_line = [](const Outcome& outcome) { return lines(outcome.out).front(); };
  // Cubes with edges of 1, a quarter apart.
  CHECK(first_line(collide_cubes({"--pose", "1.25,0,0"})) == "apart");
  CHECK(first_line(collide_cubes({"--pose", "1.25,0,0", "--within", "0.2"})) == "apart by more than 0.2");
  CHECK(first_line(collide_cubes({"--pose", "1.25,0,0", "--within", "0.25"})).rfind("within 0.25: ", 0) == 0);
  CHECK(collide_cubes({"--pose", "1.25,0,0", "--within", "0.25", "--exit-code"}).code == exit_contact);
  CHECK(collide_cubes({"--pose", "1.25,0,0", "--within", "0.2499999999999999", "--exit-code"}).code == exit_ok);
  CHECK(collide_cubes({"--pose", "1.25,0,0", "--within", "0.2", "--format", "jsonl"}).out == "{\"hit\":0}\n");
  CHECK(lines(collide_cubes({"--pose", "1.25,0,0", "--within", "0.25", "--format", "csv"}).out).front() ==
        "face_a,face_b");
  CHECK(collide_cubes({"--within", "-1"}).code == exit_usage);
  CHECK(collide_cubes({"--within", "far"}).code == exit_usage);
  CHECK(collide_cubes({"--within", "1", "--relation"}).code == exit_usage);
  CHECK(collide_cubes({"--within", "1", "--counts", "crossing"}).code == exit_usage);
}

TEST_CASE("collide: solids", "[system][collide]") {
  // Cubes with edges of 1.
  const auto of = [](std::vector<std::string> arguments) {
    arguments.emplace_back("--solids");
    return collide_cubes(arguments);
  };
  CHECK(of({"--pose", "1.25,0,0"}).out == "disjoint\n");
  CHECK(of({"--pose", "1,0,0"}).out == "touching\n");
  CHECK(of({"--pose", "0.5,0,0"}).out == "overlapping\n");
  CHECK(of({}).out == "equal\n");
  CHECK(of({"--pose-matrix", "0.5,0,0,0,0,0.5,0,0,0,0,0.5,0"}).out == "b_in_a\n");
  CHECK(of({"--pose", "1,0,0", "--format", "csv"}).out == "solids\ntouching\n");
  CHECK(of({"--pose", "1,0,0", "--format", "jsonl"}).out == "{\"solids\":\"touching\"}\n");
  CHECK(of({"--pose", "1,0,0", "--exit-code"}).code == exit_contact);
  CHECK(of({"--pose", "1.25,0,0", "--exit-code"}).code == exit_ok);
  CHECK(of({"--relation"}).code == exit_usage);
  const Outcome flat = of({"--pose-matrix", "1,0,0,0,0,1,0,0,0,0,0,0"});
  CHECK(flat.code == exit_usage);
  CHECK(flat.err.find("the pose of B flattens space") != std::string::npos);
}

TEST_CASE("collide: touching is told from crossing", "[system][collide]") {
  const Outcome flush = collide_cubes({"--pose", "1,0,0"});
  CHECK(lines(flush.out).front() == "touch: 5 faces of A meet 5 of B");
  CHECK(flush.out.find("crossing") == std::string::npos);
  const Outcome deep = collide_cubes({"--pose", "0.5,0.25,0.125"});
  CHECK(lines(deep.out).front().rfind("cross: ", 0) == 0);
  const Outcome only = collide_cubes({"--pose", "1,0,0", "--counts", "crossing"});
  CHECK(only.code == exit_ok);
  CHECK(lines(only.out).front() == "touch: no faces cross");
  CHECK(last_line(only.out) == "1 query, 0 contacts");
  CHECK(lines(collide_cubes({"--pose", "1.5,0,0", "--counts", "crossing"}).out).front() == "apart");
  const Outcome first = collide_cubes({"--pose", "0.5,0.25,0.125", "--contacts", "first", "--relation"});
  CHECK(lines(first.out).front().rfind("cross: face ", 0) == 0);

  const TemporaryFolder folder;
  const std::string poses = folder.write("poses.csv", poses_header +
                                                          "\n1,0,0,0,1,0,0,0,1,1,0,0"           // flush
                                                          "\n1,0,0,0,1,0,0,0,1,0.5,0.25,0.125"  // crossing
                                                          "\n1,0,0,0,1,0,0,0,1,2,0,0\n");       // apart
  const Outcome table = collide_cubes({"--poses", poses, "--relation"});
  CHECK(lines(table.out)[4] == "touch in 2 of 3 poses, cross in 1 of these");
  CHECK(lines(collide_cubes({"--poses", poses, "--counts", "crossing"}).out)[4] == "cross in 1 of 3 poses");
  const Outcome csv = collide_cubes({"--poses", poses, "--relation", "--format", "csv"});
  CHECK(lines(csv.out)[0] == "hit,contacts,steps,box_tests,pairs,open,relation");
  CHECK(lines(csv.out)[1].substr(lines(csv.out)[1].rfind(',')) == ",touching");
  CHECK(lines(csv.out)[2].substr(lines(csv.out)[2].rfind(',')) == ",crossing");
  CHECK(lines(csv.out)[3].substr(lines(csv.out)[3].rfind(',')) == ",apart");
}

TEST_CASE("collide: cpu, model and simulated chip tell touching from crossing alike in 10,000 poses",
          "[system][collide]") {
  // Every second pose turns by quarters and moves by quarters of an edge: flush faces, edges and corners, exact
  // numbers.
  std::mt19937_64 random(sim::seed_from_environment());
  std::uniform_real_distribution<double> angle(-180, 180), shift(-1.1, 1.1);
  std::string text = poses_header + "\n";
  for (int n = 0; n < 10000; ++n) {
    std::string pose;
    for (int i = 0; i < 3; ++i) {
      const double quarter = 0.25 * static_cast<double>(random() % 10) - 1;
      pose += std::to_string(n % 2 == 0 ? quarter : shift(random)) + ",";
    }
    for (int i = 0; i < 3; ++i)
      pose +=
          (i == 0 ? "" : ",") + std::to_string(n % 2 == 0 ? 90.0 * static_cast<double>(random() % 4) : angle(random));
    const Pose placed = parse_pose(pose);
    for (Eigen::Index row = 0; row < 3; ++row)
      for (Eigen::Index column = 0; column < 3; ++column) {
        const double entry = placed(row, column);
        std::ostringstream number;
        number.precision(17);
        number << (n % 2 == 0 ? std::round(entry) : entry);
        text += number.str() + ",";
      }
    for (Eigen::Index row = 0; row < 3; ++row) text += std::to_string(placed(row, 3)) + (row < 2 ? "," : "\n");
  }
  const TemporaryFolder folder;
  const std::string poses = folder.write("poses.csv", text);
  std::map<std::string, int> found;
  std::vector<std::string> expected;
  for (const std::string device : {"cpu", "model", "sim"}) {
    CAPTURE(device);
    const Outcome outcome = collide_cubes({"--poses", poses, "--relation", "--format", "csv", "--device", device});
    REQUIRE(outcome.code == exit_ok);
    std::vector<std::string> relations;
    for (const std::string& row : lines(outcome.out))
      relations.push_back(row.substr(0, row.find(',')) + row.substr(row.rfind(',')));
    REQUIRE(relations.size() == 10001);
    if (device == "cpu") {
      expected = relations;
      for (const std::string& relation : relations) ++found[relation];
    }
    CHECK(relations == expected);
  }
  for (const char* relation : {"0,apart", "1,touching", "1,crossing"}) CHECK(found[relation] > 1000);
}

TEST_CASE("collide: the faces that touch and those that cross are coloured apart", "[system][collide]") {
  const TemporaryFolder folder;
  const auto colours = [&](const std::string& pose) {
    const std::string path = folder.path("hits.ply");
    CHECK(collide_cubes({"--pose", pose, "--ply", path}).code == exit_ok);
    std::ifstream in(path, std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(in), {});
    const auto has = [&text](int r, int g, int b) {
      const std::string bytes = {static_cast<char>(r), static_cast<char>(g), static_cast<char>(b)};
      const std::string words = std::to_string(r) + " " + std::to_string(g) + " " + std::to_string(b);
      return text.find(bytes) != std::string::npos || text.find(words) != std::string::npos;
    };
    return std::pair(has(245, 190, 50) && has(110, 200, 225), has(235, 94, 40) && has(30, 110, 210));
  };
  CHECK(colours("1,0,0") == std::pair(true, false));           // touching only
  CHECK(colours("0.5,0.25,0.125") == std::pair(false, true));  // crossing only
}

TEST_CASE("collide: thousands of poses", "[system][collide]") {
  const TemporaryFolder folder;
  std::string text = "touches," + poses_header + "\n";
  for (int i = 0; i < 3000; ++i) {  // along x in steps of an eighth: apart behind 1
    text += std::string(i <= 8 ? "1" : "0") + ",1,0,0,0,1,0,0,0,1," + std::to_string(i / 8.0) + ",0,0\n";
  }
  const Outcome outcome = collide_cubes({"--poses", folder.write("poses.csv", text), "--expect", "touches"});
  CHECK(outcome.code == exit_ok);
  REQUIRE(lines(outcome.out).size() == 3);  // names, answer, summary
  CHECK(lines(outcome.out)[1] == "touch in 9 of 3000 poses");
  CHECK(last_line(outcome.out) == "3000 queries, 9 contacts, 0 differ from column touches");
}

namespace {

/// A header and endless rows of poses, until some of the answers have been written.
class EndlessPoses : public std::streambuf {
 public:
  explicit EndlessPoses(std::ostringstream& out) : out_(out) {}
  int rows = 0;

 protected:
  int_type underflow() override {
    if (rows == 100000 || out_.tellp() > std::streamoff{0}) return traits_type::eof();
    text_ = (rows++ == 0 ? poses_header : "1,0,0,0,1,0,0,0,1,0,0,7") + "\n";
    setg(text_.data(), text_.data(), text_.data() + text_.size());
    return traits_type::to_int_type(text_.front());
  }

 private:
  std::ostringstream& out_;
  std::string text_;
};

}  // namespace

TEST_CASE("collide: poses are a stream, and - is standard input", "[system][collide]") {
  for (const std::string format : {"table", "csv", "jsonl"}) {
    CAPTURE(format);
    std::ostringstream out;
    std::ostringstream err;
    EndlessPoses poses(out);
    std::istream in(&poses);
    CHECK(run_cli({"collide", cube_file, cube_file, "--poses", "-", "--format", format}, {in, out, err, false},
                  hardware()) == exit_ok);
    CHECK(poses.rows > 1000);
    CHECK(poses.rows < 10000);
  }
  const Outcome wrong = run_cchip({"collide", cube_file, cube_file, "--poses", "-"}, poses_header + "\n1\n");
  CHECK(wrong.err == "cchip: -:2: the row has 1 fields, but the header names 12 columns; write one field per column\n");
}

TEST_CASE("collide: a mesh from standard input", "[system][collide]") {
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const std::string command : {"collide", "meshpairs"}) {
    const Outcome outcome = run_cchip({command, "-", cube_file, "--format", "csv"}, off);
    CHECK(outcome.code == exit_ok);
    CHECK(count(last_line(outcome.err), "hits") > 0);
    CHECK(run_cchip({command, "-", cube_file}).err == "cchip: -: standard input is empty; send a mesh\n");
    CHECK(run_cchip({command, "-", "-"}, off).err ==
          "cchip: -: standard input can be read once only; name a file for all but one\n");
    CHECK(
        run_cchip({command, "-", cube_file}, "v 0 0 0\n").err ==
        "cchip: -: the file holds no faces, only 1 vertices; to ask about a point cloud, name it first, as A, and give "
        "--points (load_points())\n");
  }
}

TEST_CASE("collide: faces that cannot be used are left out if asked for", "[system][collide]") {
  // Face 0 of the square is good and holds the corner of the other mesh; face 1 names a vertex that is not there, the
  // sides 0 and 3 of face 2 cross.
  const TemporaryFolder folder;
  const std::string bad = folder.write("bad.obj",
                                       "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 2 1 0\nf 1 2 3 4\nf 1 2 9\n"
                                       "f 1 3 5 2 4\n");
  const std::string other = folder.write("other.obj", "v 1 0.5 0\nv 1 0.5 5\nv 2 0.5 5\nf 1 2 3\n");
  for (const std::string command : {"collide", "meshpairs"}) {
    CAPTURE(command);
    const Outcome strict = run_cchip({command, bad, other, "--format", "csv"});
    CHECK(strict.code == exit_usage);
    CHECK(strict.out.empty());
    const Outcome lenient = run_cchip({command, bad, other, "--lenient", "--format", "csv"});
    CHECK(lenient.code == exit_left_out);
    REQUIRE(lines(lenient.out).size() == 2);
    CHECK(lines(lenient.out)[1].rfind("0,0,", 0) == 0);
    REQUIRE(lines(lenient.err).size() == 4);
    CHECK(lines(lenient.err)[0] ==
          "cchip: " + bad + ": line 7: face 1: vertex index 9 is out of range (the mesh has 5 vertices)");
    CHECK(lines(lenient.err)[1].rfind("cchip: " + bad + ": line 8: face 2: its sides ", 0) == 0);
    CHECK(lines(lenient.err)[2] == "cchip: " + bad + ": 2 faces were left out because they cannot be used");
    CHECK(count(lines(lenient.err)[3], "hits") == 1);
    CHECK(count(lines(lenient.err)[3], "left_out") == 2);
    // Nothing to leave out: the answer is complete.
    const Outcome good = run_cchip({command, other, other, "--lenient", "--format", "csv"});
    CHECK(good.code == exit_ok);
    CHECK(count(last_line(good.err), "left_out") == 0);
  }
  const std::string poses = folder.write("poses.csv", poses_header + ",touches\n1,0,0,0,1,0,0,0,1,0,0,0,1\n");
  std::vector<std::string> many = {"collide", bad, other, "--lenient", "--poses", poses, "--expect", "touches"};
  CHECK(run_cchip(many).code == exit_left_out);
  folder.write("poses.csv", poses_header + ",touches\n1,0,0,0,1,0,0,0,1,0,0,0,0\n");
  CHECK(run_cchip(many).code == exit_mismatch);  // that answers differ says more
}

TEST_CASE("collide: picture", "[system][collide]") {
  const TemporaryFolder folder;
  const std::string ply = folder.path("hits.ply");
  REQUIRE(collide_cubes({"--pose", "1,1,1", "--ply", ply}).code == exit_ok);
  const Mesh both = load_mesh(ply, FaceKinds::triangles_and_quads);
  CHECK(both.faces.size() == 12);
  std::set<double> xs;
  for (const Vec3d& v : both.vertices) xs.insert(v.x());
  CHECK(xs == std::set<double>{-0.5, 0.5, 1.5});
  // With only one contact fewer faces are coloured.
  const std::string one = folder.path("one.ply");
  REQUIRE(collide_cubes({"--pose", "1,1,1", "--contacts", "first", "--ply", one}).code == exit_ok);
  CHECK(folder.read("one.ply").size() == folder.read("hits.ply").size());
  CHECK(folder.read("one.ply") != folder.read("hits.ply"));
}

TEST_CASE("collide: the picture has the curves where the surfaces cross", "[system][collide]") {
  const TemporaryFolder folder;
  const auto edges_of = [&](const std::string& pose) {
    const std::string ply = folder.path("hits.ply");
    REQUIRE(collide_cubes({"--pose", pose, "--ply", ply}).code == exit_ok);
    CHECK(load_mesh(ply, FaceKinds::triangles_and_quads).faces.size() == 12);
    const std::string content = folder.read("hits.ply");
    const auto end = content.find("end_header\n");
    const auto at = content.find("element edge ");
    if (at == std::string::npos) return std::vector<std::pair<Vec3d, Vec3d>>();
    const std::size_t count = std::stoul(content.substr(at + 13));
    // Vertices: three doubles and a colour; edges, at the end: two numbers.
    const auto number = [&](std::size_t place) {
      std::uint32_t value = 0;
      std::memcpy(&value, content.data() + place, sizeof value);
      return value;
    };
    std::vector<std::pair<Vec3d, Vec3d>> edges;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t edge = content.size() - 8 * (count - i);
      const auto point = [&](std::uint32_t vertex) {
        Vec3d p;
        std::memcpy(p.data(), content.data() + end + 11 + 27 * std::size_t{vertex}, 24);
        return p;
      };
      edges.emplace_back(point(number(edge)), point(number(edge + 4)));
    }
    return edges;
  };
  // Cubes that are moved along the diagonal: one closed curve of six sides around the common cube.
  const auto sides = edges_of("0.25,0.25,0.25");
  REQUIRE(sides.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(sides[i].second == sides[(i + 1) % 6].first);
    // A side of the common cube, from -0.25 to 0.5: not at its two corners that lie in a vertex of one of the cubes.
    CHECK((sides[i].second - sides[i].first).norm() == 0.75);
    const Vec3d p = sides[i].first;
    for (const double x : p) CHECK((x == -0.25 || x == 0.5));
    CHECK(p.sum() != -0.75);
    CHECK(p.sum() != 1.5);
  }
  CHECK(edges_of("5,0,0").empty());
  CHECK(edges_of("1,1,1").empty());  // they share a point
}

TEST_CASE("collide: the points of a scan", "[system][collide]") {
  const TemporaryFolder folder;
  // Distances from the cube: 0.25, 0 on a face, 0.5 inside, 0.25 from a corner.
  const std::string xyz = folder.write("scan.xyz", "0.75 0 0\n0.25 0.5 0 99\n0 0 0\n# a corner\n0.5 0.5 0.75\n");
  const auto points = [&](const std::string& file, std::vector<std::string> options, const std::string& input = "") {
    options.insert(options.begin(), {"collide", file, cube_file, "--points"});
    return run_cchip(options, input);
  };
  const Outcome none = points(xyz, {"--pose", "9,0,0"});
  CHECK(none.code == exit_ok);
  CHECK(none.out == "apart\n1 query, 0 contacts\n");
  CHECK(none.err.empty());
  const Outcome point = points(xyz, {"--exit-code"});
  CHECK(point.code == exit_contact);
  CHECK(lines(point.out).front() == "touch: 1 point of A meets 1 face of B");
  CHECK(lines(point.out).at(1) == "point  face");
  CHECK(lines(point.out).at(2).substr(0, 1) == "1");
  CHECK(last_line(point.out) == "1 query, 1 contact");
  const auto met = [&](const std::string& radius) {
    const Outcome outcome = points(xyz, {"--radius", radius, "--format", "csv"});
    CHECK(outcome.code == exit_ok);
    std::map<std::string, int> count_of_point;
    for (const std::string& line : lines(outcome.out)) ++count_of_point[line.substr(0, line.find(','))];
    CHECK(count_of_point["point"] == 1);
    count_of_point.erase("point");
    CHECK(count(last_line(outcome.err), "hits") == 1);
    return count_of_point;
  };
  using Counts = std::map<std::string, int>;
  CHECK(met("0.2") == Counts{{"1", 1}});
  CHECK(met("0.24999999999999997") == Counts{{"1", 1}});
  CHECK(met("0.25") == Counts{{"0", 1}, {"1", 2}, {"3", 3}});  // point 1 is 0.25 from the face beside its own
  CHECK(met("0.5")["2"] == 6);
  CHECK(lines(points(xyz, {"--radius", "0.25", "--contacts", "first"}).out).front().rfind("touch: point ", 0) == 0);
  CHECK(lines(points(xyz, {"--radius", "0.25", "--most", "2"}).out).front().rfind("touch: at least ", 0) == 0);
  CHECK(points(xyz, {"--pose", "9,0,0", "--format", "jsonl"}).out == "{\"hit\":0}\n");
  CHECK(points(xyz, {"--format", "jsonl"}).out.rfind("{\"point\":1,\"face\":", 0) == 0);
  // What a sensor did not see, from standard input.
  const Outcome nan = points("-", {"--format", "csv"}, "nan nan nan\n0.25 0.5 0\n");
  CHECK(lines(nan.out).at(1).substr(0, 2) == "0,");
  CHECK(lines(nan.err).front() ==
        "cchip: -: 1 point without finite coordinates left out; the others are numbered from 0");
  // A mesh for a scan: its corners.
  CHECK(lines(points(std::string(CCHIP_TEST_MODELS) + "/PLY/cube.ply", {"--pose", "0.5,0.5,0.5"}).out)
            .front()
            .rfind("touch: ", 0) == 0);
}

TEST_CASE("collide: errors about points", "[system][collide]") {
  const TemporaryFolder folder;
  const std::string xyz = folder.write("scan.xyz", "0.75 0 0\n");
  const auto error = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"collide", xyz, cube_file});
    const Outcome outcome = run_cchip(options);
    CHECK(outcome.code == exit_usage);
    CHECK(outcome.out.empty());
    return outcome.err;
  };
  for (const std::string radius : {"-1", "nan", "inf", "wide"}) {
    CHECK(error({"--points", "--radius", radius}) ==
          "cchip: --radius: '" + radius + "' is not a radius; give a number that is at least 0\n");
  }
  CHECK(error({"--radius", "1"}) == "cchip: --radius requires --points; see cchip collide --help\n");
  CHECK(error({"--points", "--within", "1"}).find("excludes") != std::string::npos);
  CHECK(error({"--points", "--ply", "x.ply"}).find("excludes") != std::string::npos);
  CHECK(error({"--points", "--device", "model"}) ==
        "cchip: --points: device model knows faces only; leave --device out\n");
  CHECK(error({"--points", "--contacts", "first", "--most", "2"}).rfind("cchip: --most: ", 0) == 0);
  folder.write("scan.xyz", "1 2\n");
  CHECK(error({"--points"}).rfind("cchip: " + xyz + ":1: ", 0) == 0);
}

TEST_CASE("collide: the view for a browser", "[system][collide]") {
  const TemporaryFolder folder;
  CHECK(collide_cubes({"--html", "view.txt"}).err ==
        "cchip: --html view.txt: the view is an HTML file; give a name that ends with .html\n");
  CHECK(collide_cubes({"--html", folder.path("v.html"), "--poses", "-"}).code == exit_usage);
  // A folder that stands for the library: the view holds what is in it.
  std::filesystem::create_directories(folder.path("examples/js/controls"));
  setenv("CCHIP_THREE", folder.path("").c_str(), 1);
  const Outcome missing = collide_cubes({"--html", folder.path("v.html")});
  CHECK(missing.code == exit_usage);
  CHECK(missing.err == "cchip: --html: the library three.js is missing (" + folder.path("three.min.js") +
                           "); install Debian's package libjs-three, or name the folder of three.js 0.111 in "
                           "CCHIP_THREE\n");
  CHECK_FALSE(std::filesystem::exists(folder.path("v.html")));
  folder.write("three.min.js", "three @DATA@;");
  folder.write("examples/js/controls/OrbitControls.js", "controls;");
  const Outcome good = collide_cubes({"--html", folder.path("v.html"), "--pose", "1,1,1"});
  unsetenv("CCHIP_THREE");
  CHECK(good.code == exit_ok);
  const std::string page = folder.read("v.html");
  CHECK(page.find("<script>three @DATA@;</script>") != std::string::npos);
  CHECK(page.find("<script>controls;</script>") != std::string::npos);
  CHECK(page.find("\"answer\":\"touch: 3 faces of A meet 3 of B\"") != std::string::npos);
  // Six squares of two triangles and four edges each; nine contacts that touch.
  CHECK(page.find("\"faces\":[0,0,1,1,2,2,3,3,4,4,5,5]") != std::string::npos);
  const std::string contacts = page.substr(page.find("\"contacts\":["));
  CHECK(std::count(contacts.begin(), contacts.begin() + static_cast<std::ptrdiff_t>(contacts.find("]]")), '[') == 10);
}

TEST_CASE("collide: wrong input is one line and exit code 2", "[system][collide]") {
  const TemporaryFolder folder;
  const std::string good_row = "1,0,0,0,1,0,0,0,1,0,0,0\n";
  const auto poses = [&](const std::string& name, const std::string& text) {
    return std::vector<std::string>{"--poses", folder.write(name, text)};
  };
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--pose", "1,2"}, "--pose: got 2 numbers"},
      {{"--pose-matrix", "1,0,0"}, "--pose-matrix: got 3 numbers"},
      {{"--pose-matrix", "1e200,0,0,0,0,1,0,0,0,0,1,0"}, "pose of B: row 0, column 0 is not finite or beyond 2^500"},
      {{"--device", "fpga"}, "--device: device fpga is not known: the devices are cpu, model"},
      {{"--expect", "touches"}, "--expect"},
      {{"--most", "0"}, "--most"},
      {{"--poses", folder.path("none.csv")}, "none.csv: the file cannot be read"},
      {poses("empty.csv", ""), "empty.csv:1: the file is empty"},
      {poses("short.csv", "r00,r01\n"), "short.csv:1: column r02 is missing"},
      {poses("twice.csv", poses_header + ",tx\n" + good_row), "twice.csv:1: column tx is there twice"},
      {poses("text.csv", poses_header + "\n" + good_row + "1,0,0,0,x,0,0,0,1,0,0,0\n"),
       "text.csv:3: column r11: 'x' is not a number"},
      {poses("fields.csv", poses_header + "\n1,2\n"), "fields.csv:2: the row has 2 fields"},
      {poses("huge.csv", poses_header + "\n" + good_row + "1e300,0,0,0,1,0,0,0,1,0,0,0\n"),
       "huge.csv:3: pose of B: row 0, column 0 is not finite or beyond 2^500"},
  };
  for (const auto& [options, message] : cases) {
    const Outcome outcome = collide_cubes(options);
    CAPTURE(message, outcome.err);
    CHECK(outcome.code == exit_usage);
    CHECK(outcome.out.empty());
    CHECK(lines(outcome.err).size() == 1);
    CHECK(outcome.err.find(message) != std::string::npos);
  }
  std::vector<std::string> named = poses("named.csv", poses_header + ",n\n1,0,0,0,1,0,0,0,1,0,0,0,yes\n");
  named.insert(named.end(), {"--expect", "n"});
  CHECK(collide_cubes(named).err.find("named.csv:2: the expected answer is not a whole number") != std::string::npos);
  named.back() = "m";
  CHECK(collide_cubes(named).err.find("named.csv:1: column m of --expect is missing") != std::string::npos);
  CHECK(run_cchip({"collide", cube_file, folder.path("none.off")}).code == exit_usage);
}

namespace {

/// Columns of a CSV text that are named.
std::vector<std::vector<std::string>> columns_of(const std::string& text, const std::vector<std::string>& names) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> places;
  for (const std::string& line : lines(text)) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    if (rows.empty()) {
      for (const std::string& name : names) {
        const auto found = std::find(cells.begin(), cells.end(), name);
        REQUIRE(found != cells.end());
        places.push_back(static_cast<std::size_t>(found - cells.begin()));
      }
    }
    rows.emplace_back();
    for (const std::size_t place : places) rows.back().push_back(cells.at(place));
  }
  return rows;
}

/// Poses of a file for `--poses`: apart, touching, crossing, and one that the chip leaves to the CPU.
std::string many_poses(double size) {
  std::string text = poses_header + "\n";
  for (int i = 0; i < 12; ++i) {
    const Pose pose = make_pose({size * i / 8, size * (i % 3) / 16, 0.01 * i}, {10.0 * i, 3.0 * i, 0});
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) text += std::to_string(pose(row, column)) + ",";
    }
    for (int row = 0; row < 3; ++row) text += std::to_string(pose(row, 3)) + (row < 2 ? "," : "\n");
  }
  return text + "0,0,0,0,0,0,0,0,0,0,0,0\n";
}

}  // namespace

TEST_CASE("collide: device sim answers face for face like device cpu", "[system][collide][chip]") {
  const std::string models = CCHIP_TEST_MODELS;
  struct Case {
    std::string a, b, pose;
    double size;
  };
  const Case c =
      GENERATE_COPY(Case{models + "/OBJ/spider.obj", models + "/OBJ/spider.obj", "20,5,3,10,0,0", 80},     // triangles
                    Case{models + "/OFF/Cube.off", models + "/OFF/Cube.off", "0.25,0.5,0.125,0,30,0", 1},  // quads
                    Case{models + "/OFF/Cube.off", models + "/OFF/Wuson.off", "0.5,0,0,10,0,0", 1});
  CAPTURE(c.a, c.b);
  const auto run = [&](const std::string& device, std::vector<std::string> options) {
    options.insert(options.begin(), {"collide", c.a, c.b, "--device", device, "--format", "csv"});
    const Outcome outcome = run_cchip(options);
    CAPTURE(device, outcome.err);
    REQUIRE(outcome.code == exit_ok);
    return outcome;
  };
  // one query, all contacts: the rows are the faces
  const Outcome cpu = run("cpu", {"--pose", c.pose});
  const Outcome sim = run("sim", {"--pose", c.pose});
  CHECK(cpu.out == sim.out);
  CHECK(lines(cpu.out).size() > 1);
  CHECK(last_line(sim.err).find(" fallbacks=0 swaps=0 swap_clocks=0 clocks_mean=") != std::string::npos);
  // one query, the first contact: any of them
  const Outcome first = run("sim", {"--pose", c.pose, "--contacts", "first"});
  REQUIRE(lines(first.out).size() == 2);
  const std::vector<std::string> all = lines(cpu.out);
  const std::string faces = lines(first.out)[1] + ",";
  CHECK(std::any_of(all.begin() + 1, all.end(), [&](const std::string& row) { return row.rfind(faces, 0) == 0; }));
  // a batch; the singular map of its last row is the CPU's
  const TemporaryFolder folder;
  const std::string poses = folder.write("poses.csv", many_poses(c.size));
  for (const std::string contacts : {"first", "all"}) {
    CAPTURE(contacts);
    const Outcome many_cpu = run("cpu", {"--poses", poses, "--contacts", contacts});
    for (const std::string slots : {"0", "1", "2"}) {  // static, and with modules that are exchanged
      CAPTURE(slots);
      const Outcome many_sim = run("sim", {"--poses", poses, "--contacts", contacts, "--slots", slots});
      CHECK(columns_of(many_cpu.out, {"hit", "contacts"}) == columns_of(many_sim.out, {"hit", "contacts"}));
      CHECK(last_line(many_sim.err).find(" fallbacks=1 ") != std::string::npos);
    }
    const Outcome three = run("sim", {"--poses", poses, "--contacts", contacts, "--chips", "3"});
    CHECK(columns_of(many_cpu.out, {"hit", "contacts"}) == columns_of(three.out, {"hit", "contacts"}));
    CHECK(last_line(three.err).find(" fallbacks=1 ") != std::string::npos);
  }
}

TEST_CASE("collide: the waveform of device sim", "[system][collide][chip]") {
  const TemporaryFolder folder;
  const std::string wave = folder.path("chip.fst");
  const Outcome outcome = collide_cubes({"--pose", "1,1,1", "--device", "sim", "--trace", wave});
  CHECK(outcome.code == exit_ok);
  CHECK(folder.read("chip.fst").size() > 10000);
  CHECK(folder.read("chip.gtkw").find("TOP.cchip_chip.u_core.") != std::string::npos);
  const Outcome cpu = collide_cubes({"--trace", wave});
  CHECK(cpu.code == exit_usage);
  CHECK(cpu.err == "cchip: --trace: device cpu has no waveform; add --device sim, or leave --trace out\n");
  CHECK(collide_cubes({"--device", "sim", "--trace", cube_file}).code == exit_usage);  // an input
  CHECK(collide_cubes({"--slots", "1"}).err ==
        "cchip: --slots: device cpu has no slots; add --device sim, or leave --slots out\n");
  CHECK(collide_cubes({"--device", "sim", "--slots", "3"}).code == exit_usage);
  CHECK(collide_cubes({"--chips", "2"}).err ==
        "cchip: --chips: device cpu has no chips; add --device sim, or leave --chips out\n");
  for (const std::string count : {"0", "9", "two", "-1", "2.5", ""}) {
    CAPTURE(count);
    const Outcome wrong = collide_cubes({"--device", "sim", "--chips", count});
    CHECK(wrong.code == exit_usage);
    CHECK(wrong.err.rfind("cchip: --chips: ", 0) == 0);
    CHECK(lines(wrong.err).size() == 1);
  }
}
