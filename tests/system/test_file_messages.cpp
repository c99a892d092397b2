// SPDX-License-Identifier: Apache-2.0
// Files of other programs at the command line: what it says about them, and that its remedies work.
#include <catch2/catch.hpp>
#include <cchip/program/usage_error.hpp>
#include <cstdlib>

#include "support.hpp"

using namespace cchip;
using namespace cchip::app;
using namespace cchip::test;

namespace {

const std::string wall = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nf 1 2 3 4\n";
const std::string cloud =
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nelement face 0\n"
    "end_header\n1 1 0\n9 9 9\n";

/// The command between backticks.
std::string command_in(const std::string& message) {
  const auto begin = message.find('`');
  const auto end = message.find('`', begin + 1);
  return end == std::string::npos ? "" : message.substr(begin + 1, end - begin - 1);
}

}  // namespace

TEST_CASE("files: a scan in the place of a mesh", "[system][files]") {
  const TemporaryFolder folder;
  const std::string mesh = folder.write("wall.obj", wall);
  for (const char* const name : {"scan.ply", "scan.xyz", "scan.dat"}) {
    CAPTURE(name);
    const std::string scan = folder.write(name, name == std::string("scan.ply") ? cloud : "1 1 0\n9 9 9\n");
    for (const std::vector<std::string>& pair :
         {std::vector<std::string>{scan, mesh}, std::vector<std::string>{mesh, scan}}) {
      const Outcome outcome = run_cchip({"collide", pair[0], pair[1]});
      CHECK(outcome.code == exit_usage);
      CHECK(outcome.err.find(scan) != std::string::npos);
      CHECK(outcome.err.find("name it first, as A, and give --points") != std::string::npos);
    }
    const Outcome swapped = run_cchip({"collide", mesh, scan, "--points"});
    CHECK(swapped.code == exit_usage);
    CHECK(swapped.err.find("name the file of points first and the mesh behind it") != std::string::npos);
    CHECK(lines(run_cchip({"collide", scan, mesh, "--points"}).out).front() == "touch: 1 point of A meets 1 face of B");
  }
}

TEST_CASE("files: parts that were rounded differently meet with --single", "[system][files]") {
  const TemporaryFolder folder;
  const auto plane = [](const std::string& z) {
    return "v 0 0 " + z + "\nv 1 0 " + z + "\nv 0 1 " + z + "\nf 1 2 3\n";
  };
  const std::string text = folder.write("text.obj", plane("5000.7"));
  const std::string rounded = folder.write("rounded.obj", plane("5000.7001953125"));  // as binary STL holds it
  CHECK(lines(run_cchip({"collide", text, rounded}).out).front() == "apart");
  CHECK(lines(run_cchip({"collide", text, rounded, "--single"}).out).front().rfind("touch", 0) == 0);
  CHECK(lines(run_cchip({"distance", text, rounded, "--single"}).out).front() == "distance 0: they touch or cross");
  const std::string points = folder.write("points.xyz", "0.25 0.25 5000.7\n");
  CHECK(lines(run_cchip({"collide", points, rounded, "--points"}).out).front() == "apart");
  CHECK(lines(run_cchip({"collide", points, rounded, "--points", "--single"}).out).front().rfind("touch", 0) == 0);
  const std::string proof = folder.path("proof.csv");
  CHECK(run_cchip({"collide", text, rounded, "--single", "--certificate", proof}).code == exit_ok);
  CHECK(run_cchip({"check", text, rounded, proof, "--single"}).code == exit_ok);
  CHECK(run_cchip({"meshpairs", text, rounded, "--single", "--engine", "exact"}).out.find("hits=1") !=
        std::string::npos);
  CHECK(run_cchip({"meshpairs", text, rounded, "--engine", "exact"}).out.find("hits=0") != std::string::npos);
}

TEST_CASE("files: assimp converts what the message says", "[system][files]") {
  if (std::system("command -v assimp > /dev/null") != 0) {
    WARN("skipped: no assimp; install Debian's assimp-utils");
    return;
  }
  for (const char* const model : {"X/test_cube_text.x", "AMF/test1.amf", "FBX/box.fbx", "X3D/HelloX3dTrademark.x3d"}) {
    CAPTURE(model);
    const TemporaryFolder folder;
    const std::filesystem::path source = std::filesystem::path(CCHIP_TEST_MODELS) / model;
    if (!std::filesystem::exists(source)) {
      WARN("skipped: no " << source);
      continue;
    }
    const std::string copy = folder.path(source.filename());
    std::filesystem::copy_file(source, copy);
    const Outcome refused = run_cchip({"collide", copy, copy});
    CHECK(refused.code == exit_usage);
    const std::string command = command_in(refused.err);
    REQUIRE(command.rfind("assimp export ", 0) == 0);
    REQUIRE(std::system(("cd " + folder.path("") + " && " + command + " > /dev/null").c_str()) == 0);
    const std::string part = folder.path("part.obj");
    CHECK(run_cchip({"collide", part, part, "--contacts", "first"}).code == exit_ok);
  }
}
