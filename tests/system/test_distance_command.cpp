// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cchip/program/usage_error.hpp>

#include "support.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

const std::string cube_file = std::string(CCHIP_TEST_MODELS) + "/OFF/Cube.off";  // six quads, from -0.5 to 0.5

Outcome distance_of_cubes(std::vector<std::string> options) {
  options.insert(options.begin(), {"distance", cube_file, cube_file});
  return run_cchip(options);
}

/// Bounds of one row of CSV.
std::string first_cells(const std::string& csv, std::size_t count) {
  const std::string row = lines(csv).at(1);
  std::size_t end = 0;
  for (std::size_t i = 0; i < count; ++i) end = row.find(',', end + (i > 0 ? 1 : 0));
  return row.substr(0, end);
}

/// A triangle in the plane z = `z`, and one that has a corner alone in it.
std::string flat(const std::string& z) { return "v 0 0 " + z + "\nv 4 0 " + z + "\nv 0 4 " + z + "\nf 1 2 3\n"; }
const std::string corner = "v 1 1 0\nv 1 1 5\nv 1 2 5\nf 1 2 3\n";

}  // namespace

TEST_CASE("distance: bounds, nearest points and their faces", "[system][distance]") {
  const TemporaryFolder folder;
  const std::string a = folder.write("a.obj", flat("-0.75"));
  const std::string b = folder.write("b.obj", corner);
  const Outcome table = run_cchip({"distance", a, b});
  CHECK(table.code == exit_ok);
  CHECK(table.err.empty());
  CHECK(lines(table.out) == std::vector<std::string>{"distance 0.75",
                                                     "lower  upper  face_a  ax  ay  az     face_b  bx  by  bz",
                                                     "0.75   0.75   0       1   1   -0.75  0       1   1   0"});
  const Outcome csv = run_cchip({"distance", a, b, "--format", "csv"});
  CHECK(csv.out == "lower,upper,face_a,ax,ay,az,face_b,bx,by,bz\n0.75,0.75,0,1,1,-0.75,0,1,1,0\n");
  CHECK(csv.err.empty());
  const Outcome json = run_cchip({"distance", a, b, "--format", "jsonl"});
  CHECK(json.out ==
        "{\"lower\":0.75,\"upper\":0.75,\"face_a\":0,\"ax\":1.0,\"ay\":1.0,\"az\":-0.75,\"face_b\":0,\"bx\":1.0,"
        "\"by\":1.0,\"bz\":0.0}\n");
}

TEST_CASE("distance: a pose places B", "[system][distance]") {
  // Corners (0.5, 0.5, .) and (1.5, 1.5, .): the square root of 2 lies between two doubles.
  const Outcome root = distance_of_cubes({"--pose", "2,2,0"});
  CHECK(lines(root.out).front() == "distance from 1.414213562373095 to 1.4142135623730951");
  CHECK(first_cells(distance_of_cubes({"--pose-matrix", "1,0,0,2,0,1,0,2,0,0,1,0", "--format", "csv"}).out, 2) ==
        "1.414213562373095,1.4142135623730951");
  CHECK(lines(distance_of_cubes({"--pose", "1,1,1"}).out).front() == "distance 0: they touch or cross");
  CHECK(lines(distance_of_cubes({"--pose", "1.0000000000000002,0,0"}).out).front() == "distance 2.220446049250313e-16");
  // A cube of half the size inside: surfaces, not volumes.
  CHECK(lines(distance_of_cubes({"--pose-matrix", "0.5,0,0,0,0,0.5,0,0,0,0,0.5,0"}).out).front() == "distance 0.25");
}

TEST_CASE("distance: a search that may end early", "[system][distance]") {
  const Outcome above = distance_of_cubes({"--pose", "3,0,0", "--stop-above", "1.5"});
  CHECK(above.code == exit_ok);
  CHECK(above.out == "distance above 1.5\n");
  CHECK(lines(distance_of_cubes({"--pose", "3,0,0", "--stop-above", "1.5", "--format", "csv"}).out).at(1) ==
        "1.5,inf,,,,,,,,");
  CHECK(distance_of_cubes({"--pose", "3,0,0", "--stop-above", "1.5", "--format", "jsonl"}).out ==
        "{\"lower\":1.5,\"upper\":null,\"face_a\":null,\"ax\":null,\"ay\":null,\"az\":null,\"face_b\":null,"
        "\"bx\":null,\"by\":null,\"bz\":null}\n");
  CHECK(lines(distance_of_cubes({"--pose", "3,0,0", "--stop-above", "2"}).out).front() == "distance 2");
  const std::string bounds =
      first_cells(distance_of_cubes({"--pose", "2,2,0", "--relative-error", "0.25", "--format", "csv"}).out, 2);
  const double lower = std::stod(bounds);
  const double upper = std::stod(bounds.substr(bounds.find(',') + 1));
  CHECK(lower * lower <= 2);
  CHECK(upper * upper >= 2);
  CHECK(upper - lower <= 0.25 * upper);
}

TEST_CASE("distance: along a direction until they touch or are clear", "[system][distance]") {
  const auto along = [](const std::string& pose, const std::string& direction) {
    return distance_of_cubes({"--pose", pose, "--along", direction, "--format", "csv"});
  };
  CHECK(along("3,0.5,0", "-1,0,0").out.rfind("answer,factor,lower,upper,face_a,face_b\ntouch,2,2,2,", 0) == 0);
  CHECK(first_cells(along("3,0.5,0", "-3,0,0").out, 2) == "touch,0.6666666666666666");  // 2/3
  CHECK(lines(along("3,0.5,0", "0,1,0").out).at(1) == "never,,,,,");
  CHECK(first_cells(along("0.75,0.5,0", "0,1,0").out, 4) == "clear,0.5,0.5,0.5");
  CHECK(first_cells(along("1,0.5,0", "1,0,0").out, 4) == "clear,0,0,0");
  const Outcome table = distance_of_cubes({"--pose", "3,0.5,0", "--along", "-1,0,0"});
  CHECK(table.code == exit_ok);
  CHECK(lines(table.out).front() == "touch after 2 times the direction");
  CHECK(lines(table.out).size() == 3);
  CHECK(lines(distance_of_cubes({"--pose", "3,0.5,0", "--along", "-3,0,0"}).out).front() ==
        "touch after 0.6666666666666666 times the direction, rounded: it is from 0.6666666666666666 to "
        "0.6666666666666667");
  CHECK(distance_of_cubes({"--pose", "3,0.5,0", "--along", "0,1,0"}).out == "they never touch in this direction\n");
  CHECK(distance_of_cubes({"--pose", "3,0.5,0", "--along", "0,1,0", "--format", "jsonl"}).out ==
        "{\"answer\":\"never\",\"factor\":null,\"lower\":null,\"upper\":null,\"face_a\":null,\"face_b\":null}\n");
}

TEST_CASE("distance: faces that cannot be used", "[system][distance]") {
  const TemporaryFolder folder;
  const std::string bad = folder.write("bad.obj", flat("0") + "f 1 2 9\n");
  const std::string good = folder.write("good.obj", flat("2"));
  CHECK(run_cchip({"distance", bad, good}).code == exit_usage);
  const Outcome lenient = run_cchip({"distance", bad, good, "--lenient"});
  CHECK(lenient.code == exit_left_out);
  CHECK(lines(lenient.out).front() == "distance 2");
  CHECK(lenient.err.find("bad.obj: line 5: face 1") != std::string::npos);
}

TEST_CASE("distance: a picture with the line between the nearest points", "[system][distance]") {
  const TemporaryFolder folder;
  const std::string ply = folder.path("far.ply");
  CHECK(distance_of_cubes({"--pose", "3,0,0", "--ply", ply}).code == exit_ok);
  const std::string text = folder.read("far.ply");
  CHECK(text.find("element edge 1\n") != std::string::npos);
  // Above the limit no points are known.
  CHECK(distance_of_cubes({"--pose", "3,0,0", "--stop-above", "1", "--ply", ply}).code == exit_ok);
  CHECK(folder.read("far.ply").find("element edge") == std::string::npos);
  CHECK(distance_of_cubes({"--ply", folder.path("far.png")}).err.find("give a name that ends with .ply") !=
        std::string::npos);
}

TEST_CASE("distance: standard input and errors", "[system][distance]") {
  const TemporaryFolder folder;
  CHECK(
      lines(run_cchip({"distance", "-", folder.write("b.obj", corner)}, "OFF\n3 1 0\n0 0 -1\n4 0 -1\n0 4 -1\n3 0 1 2\n")
                .out)
          .front() == "distance 1");
  const auto error = [](std::vector<std::string> options) {
    const Outcome outcome = distance_of_cubes(std::move(options));
    CHECK(outcome.code == exit_usage);
    CHECK(outcome.out.empty());
    return outcome.err;
  };
  const std::string below_1 = "'; write a number that is at least 0 and less than 1\n";
  for (const std::string text : {"1", "-0.1", "nan", "ten"}) {
    CHECK(error({"--relative-error", text}) == "cchip: --relative-error: got '" + text + below_1);
  }
  for (const std::string text : {"-1", "nan", "inf", "5m"}) {
    CHECK(error({"--stop-above", text}) ==
          "cchip: --stop-above: got '" + text + "'; write a number that is at least 0\n");
  }
  CHECK(error({"--along", "1,0"}) == "cchip: --along: got 2 numbers; write x,y,z\n");
  CHECK(error({"--along", "0,-0,0"}) == "cchip: --along: the direction is 0; write another vector, like 0,0,1\n");
  CHECK(error({"--along", "1,nan,0"}) ==
        "cchip: --along: number 2: 'nan' is not finite; write a finite decimal number\n");
  CHECK(error({"--along", "1,0,0", "--stop-above", "1"}) ==
        "cchip: --stop-above excludes --along; see cchip distance --help\n");
  CHECK(error({"--pose", "1,0,0", "2"}).find("the pose is one word") != std::string::npos);
  CHECK(run_cchip({"distance", cube_file}).err == "cchip: the second mesh, B, is missing; see cchip distance --help\n");
  CHECK(run_cchip({"distance", "-", "-"}).err ==
        "cchip: -: standard input can be read once only; name a file for all but one\n");
}
