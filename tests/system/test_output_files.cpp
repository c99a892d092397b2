// SPDX-License-Identifier: Apache-2.0
// Options that write files: no input is touched, an older file stays if the run fails, nothing is left behind.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <cchip/mesh_file.hpp>
#include <cchip/program/output_file.hpp>
#include <cchip/program/usage_error.hpp>
#include <map>
#include <thread>

#include "support.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

const std::string cube = std::string(CCHIP_TEST_MODELS) + "/OFF/Cube.off";
const std::string pair_file = header + "\n" + tri_a + "," + b_through + "\n";

std::string content_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::size_t files_in(const TemporaryFolder& folder) {
  const std::filesystem::directory_iterator all(folder.path("."));
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

/// The run is refused because of the name `output`, and no file of the folder changes.
void check_refused(const TemporaryFolder& folder, const std::vector<std::string>& arguments,
                   const std::string& message) {
  CAPTURE(arguments);
  std::map<std::string, std::string> before;
  for (const auto& file : std::filesystem::directory_iterator(folder.path("."))) {
    before[file.path().string()] = content_of(file.path().string());
  }
  const Outcome outcome = run_cchip(arguments);
  CHECK(outcome.code == exit_usage);
  CHECK(outcome.out.empty());
  CHECK(outcome.err == "cchip: " + message + "\n");
  CHECK(files_in(folder) == before.size());
  for (const auto& [path, content] : before) CHECK(content_of(path) == content);
}

}  // namespace

TEST_CASE("output files: an output that is an input is refused before anything is written", "[system][output]") {
  const TemporaryFolder folder;
  const std::string a = folder.write("a.off", content_of(cube));
  const std::string b = folder.write("b.off", content_of(cube));
  const std::string csv = folder.write("pairs.csv", pair_file);
  const std::string link = folder.path("link.off");
  std::filesystem::create_symlink("a.off", link);
  const std::string dotted = folder.path("./a.off");
  const std::string reads_a = ": this is the file that A reads; give another name";
  const std::string reads_b = ": this is the file that B reads; give another name";
  for (const std::string command : {"collide", "meshpairs"}) {
    for (const std::string& name : {a, dotted, link}) {
      check_refused(folder, {command, a, b, "--ply", name}, "--ply " + name + reads_a);
    }
    check_refused(folder, {command, a, b, "--ply", b}, "--ply " + b + reads_b);
  }
  // The part of an output, and what --trace writes beside its file.
  const std::string part = folder.write("hits.ply.part", content_of(cube));
  check_refused(folder, {"collide", part, b, "--ply", folder.path("hits.ply")},
                "--ply " + folder.path("hits.ply") + reads_a);
  const std::string wave = folder.write("run.fst", content_of(cube));
  check_refused(folder, {"meshpairs", a, wave, "--trace", wave}, "--trace " + wave + reads_b);
  const std::string layout = folder.write("run.gtkw", pair_file);
  check_refused(folder, {"pairs", layout, "--trace", wave},
                "--trace " + layout + ": this is the file that FILE reads; give another name");
  const std::string names = folder.write("run.gtkw.axis", pair_file);
  check_refused(folder, {"pairs", names, "--trace", wave},
                "--trace " + names + ": this is the file that FILE reads; give another name");
  const std::string second = folder.write("run_quad_quad.fst", pair_file);
  check_refused(folder, {"pairs", second, "--trace", wave},
                "--trace " + second + ": this is the file that FILE reads; give another name");
  const std::string fresh = folder.path("fresh.fst");
  check_refused(folder, {"meshpairs", a, b, "--trace", fresh, "--ply", fresh},
                "--ply " + fresh + ": this is the file that --trace writes; give another name");
}

TEST_CASE("output files: an older file stays when the run fails", "[system][output]") {
  const TemporaryFolder folder;
  const std::string old = folder.write("old.ply", "precious");
  const std::string missing = folder.path("missing.obj");
  for (const std::string command : {"collide", "meshpairs"}) {
    CHECK(run_cchip({command, cube, missing, "--ply", old}).code == exit_usage);
    CHECK(folder.read("old.ply") == "precious");
    CHECK(run_cchip({command, cube, missing, "--ply", folder.path("new.ply")}).code == exit_usage);
    CHECK(files_in(folder) == 1);
  }
  const std::string wave = folder.write("old.fst", "precious");
  CHECK(run_cchip({"pairs", "-", "--trace", wave}, header + "\n1,2\n").code == exit_usage);
  CHECK(folder.read("old.fst") == "precious");
  CHECK(files_in(folder) == 2);
}

TEST_CASE("output files: a good run replaces the older file", "[system][output]") {
  const TemporaryFolder folder;
  const std::string ply = folder.write("hits.ply", "old");
  std::filesystem::permissions(ply, std::filesystem::perms(0640));
  const std::string link = folder.path("link.ply");
  std::filesystem::create_symlink("hits.ply", link);
  for (const std::string& name : {ply, link}) {
    REQUIRE(run_cchip({"collide", cube, cube, "--ply", name}).code == exit_ok);
    CHECK(load_mesh(ply, FaceKinds::triangles_and_quads).faces.size() == 12);
    CHECK(std::filesystem::status(ply).permissions() == std::filesystem::perms(0640));
    CHECK(std::filesystem::is_symlink(link));
    CHECK(files_in(folder) == 2);
    folder.write("hits.ply", "old");
  }
}

TEST_CASE("output files: the waveform of a run that fails is kept", "[system][output]") {
  const TemporaryFolder folder;
  const std::string wave = folder.path("run.fst");
  std::string text = header + "\n";
  for (int i = 0; i < 4096; ++i) text += tri_a + "," + b_through + "\n";
  const Outcome outcome = run_cchip({"pairs", "-", "--trace", wave, "--trace-clocks", "100"}, text + "1,2\n");
  CHECK(outcome.code == exit_usage);
  CHECK(std::filesystem::file_size(wave) > 1000);
  CHECK(folder.read("run.gtkw").find("[dumpfile] \"" + wave + "\"") != std::string::npos);
  CHECK(folder.read("run.gtkw.mode") == "0 exhaustive\n1 directed\n");
  CHECK(files_in(folder) == 5);  // and the names of axes and of programmes
}

TEST_CASE("output files: devices and pipes are written directly", "[system][output]") {
  CHECK(run_cchip({"collide", cube, cube, "--ply", "/dev/null"}).code == exit_ok);
  CHECK(std::filesystem::is_character_file("/dev/null"));
  const Outcome full = run_cchip({"collide", cube, cube, "--ply", "/dev/full"});
  CHECK(full.code == exit_usage);
  CHECK(full.err.find("cchip: /dev/full: cannot be written (") == 0);

  const TemporaryFolder folder;
  const std::string pipe = folder.path("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::string got;
  std::thread reader([&] { got = content_of(pipe); });
  CHECK(run_cchip({"collide", cube, cube, "--ply", pipe}).code == exit_ok);
  reader.join();
  REQUIRE(run_cchip({"collide", cube, cube, "--ply", folder.path("file.ply")}).code == exit_ok);
  CHECK(got == folder.read("file.ply"));
}

TEST_CASE("output files: a folder, a closed folder, a file that may not be written", "[system][output]") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(sim::OutputFile(folder.path(".")), Catch::Matchers::Contains("(Is a directory)"));
  CHECK_THROWS_WITH(sim::OutputFile(folder.path("no/x")), Catch::Matchers::Contains("(No such file or directory)"));
  std::filesystem::create_symlink("no/x", folder.path("dangling"));
  CHECK_THROWS_AS(sim::OutputFile(folder.path("dangling")), sim::OutputError);
  if (geteuid() == 0) return;  // may write everything
  const std::string locked = folder.write("locked", "precious");
  std::filesystem::permissions(locked, std::filesystem::perms(0400));
  CHECK_THROWS_WITH(sim::OutputFile(locked), Catch::Matchers::Contains("(Permission denied)"));
}
