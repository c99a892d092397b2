// SPDX-License-Identifier: Apache-2.0
// Wrong input and wrong command lines: one line with place and remedy, nothing on stdout, exit code 2.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/program/usage_error.hpp>

#include "support.hpp"

using namespace cchip::test;
using cchip::exit_usage;

namespace {

void check_error(std::vector<std::string> arguments, const std::string& expected, const std::string& input = "") {
  CAPTURE(arguments);
  const Outcome outcome = run_cchip(std::move(arguments), input);
  CHECK(outcome.err == expected + "\n");
  CHECK(outcome.out.empty());
  CHECK(outcome.code == exit_usage);
}

/// A good row 2, then row 3 with one field replaced.
std::string with_field(std::size_t index, const std::string& value) {
  std::vector<std::string> fields;
  std::istringstream in(tri_a + "," + b_through);
  for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
  fields.at(index) = value;
  std::string row = fields[0];
  for (std::size_t i = 1; i < fields.size(); ++i) row += "," + fields[i];
  return header + "\n" + tri_a + "," + b_through + "\n" + row + "\n";
}

}  // namespace

TEST_CASE("errors: files that are not there", "[system][errors]") {
  const TemporaryFolder folder;
  const std::string missing = folder.path("missing.csv");
  check_error(
      {"pairs", missing},
      "cchip: " + missing + ": the file cannot be read (No such file or directory); check its name and permissions");
  const std::string directory = folder.path(".");
  check_error({"pairs", directory},
              "cchip: " + directory + ": the file cannot be read (is a directory); check its name and permissions");
}

TEST_CASE("errors: header", "[system][errors]") {
  const TemporaryFolder folder;
  const std::string remedy = "; the first row must name the columns a0x,a0y,a0z to a2z and b0x,b0y,b0z to b2z";
  const std::string empty = folder.write("empty.csv", "");
  check_error({"pairs", empty},
              "cchip: " + empty + ":1: the file is empty; write a first row with the column names a0x to b2z");
  const std::string no_b2z = folder.write("f.csv", header.substr(0, header.size() - 4) + "\n");
  check_error({"pairs", no_b2z}, "cchip: " + no_b2z + ":1: column b2z is missing" + remedy);
  check_error({"pairs", "-"}, "cchip: -:1: column a0x is missing" + remedy, tri_a + "," + b_through + "\n");
  std::string semicolons = header;
  std::replace(semicolons.begin(), semicolons.end(), ',', ';');
  const std::string no_a0x = "cchip: -:1: column a0x is missing; ";
  check_error({"pairs", "-"}, no_a0x + "the columns seem to be separated by semicolons: write commas",
              semicolons + "\n");
  std::replace(semicolons.begin(), semicolons.end(), ';', '\t');
  check_error({"pairs", "-"}, no_a0x + "the columns seem to be separated by tabs: write commas", semicolons + "\n");
  const std::string binary = "this looks like a binary file or UTF-16: give a CSV file in UTF-8";
  check_error({"pairs", "-"}, no_a0x + binary, std::string("glTF\2\0\0\0\n", 9));
  check_error({"pairs", "-"}, "cchip: -:1: a double quote stands inside a field; " + binary,
              std::string("\x7f"
                          "ELF\2\1\0x\"y\n",
                          11));
  check_error({"pairs", "-"}, "cchip: -:1: column a1y is there twice; rename or remove one of them", header + ",a1y\n");
  check_error({"pairs", "-", "--expect", "touches"},
              "cchip: -:1: column 'touches' of --expect is missing; name a column of the file that holds 0 or 1",
              header + "\n");
}

TEST_CASE("errors: coordinates", "[system][errors]") {
  const TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"nan", "'nan' is not finite; write a finite decimal number"},
      {"NaN", "'NaN' is not finite; write a finite decimal number"},
      {"inf", "'inf' is not finite; write a finite decimal number"},
      {"-Infinity", "'-Infinity' is not finite; write a finite decimal number"},
      {"left", "'left' is not a number; write a finite decimal number"},
      {"1.5m", "'1.5m' is not a number; write a finite decimal number"},
      {"\"1,5\"", "'1,5' has a decimal comma; write a decimal point"},
      {"", "the field is empty; write a finite decimal number"},
      {"1e999", "'1e999' is too large for a double; scale the coordinates down"}};
  for (const auto& [text, message] : cases) {
    for (const std::string engine : {"model", "exact"}) {
      const std::string file = folder.write("f.csv", with_field(10, text));
      std::string expected = "cchip: ";
      expected.append(file).append(":3: column b0y: ").append(message);
      check_error({"pairs", file, "--engine", engine}, expected);
    }
  }
}

TEST_CASE("errors: rows", "[system][errors]") {
  const std::string row = tri_a + "," + b_through;
  check_error({"pairs", "-"},
              "cchip: -:3: the row has 17 fields, but the header names 18 columns; write one field per column",
              header + "\n" + row + "\n" + row.substr(0, row.size() - 2) + "\n");
  check_error({"pairs", "-", "--expect", "e"}, "cchip: -:2: column e: 'yes' is not an answer; write 0 or 1",
              header + ",e\n" + row + ",yes\n");
  check_error({"pairs", "-"}, "cchip: -:2: column kind_a: 'hexagon' is not a known kind; write tri or quad",
              header + ",kind_a\n" + row + ",hexagon\n");
  check_error({"pairs", "-"}, "cchip: -:2: a quoted field is not closed; end it with a double quote",
              header + ",note\n" + row + ",\"open\n");
}

TEST_CASE("errors: quads", "[system][errors]") {
  const std::string start =
      header + ",kind_b,b3x,b3y,b3z\n" + tri_a + "," + b_through + ",tri,,,\n" + tri_a + "," + b_above;
  for (const std::string engine : {"rtl", "model", "eigen", "exact"}) {
    check_error({"pairs", "-", "--engine", engine},
                "cchip: -:3: column kind_b: 'Quad' is not a known kind; write tri or quad", start + ",Quad,4,4,2\n");
    check_error({"pairs", "-", "--engine", engine},
                "cchip: -:3: column b3y: the field is empty; write a finite decimal number", start + ",quad,4,,2\n");
    check_error({"pairs", "-", "--engine", engine},
                "cchip: -:2: kind_a is quad, but column a3x is missing; add the columns a3x, a3y and a3z",
                header + ",kind_a\n" + tri_a + "," + b_through + ",quad\n");
  }
}

TEST_CASE("errors: magnitudes that no grid holds", "[system][errors]") {
  const std::string far = "1e10,1e-12,0,1e10,2e-13,1e-12,1e10,0,3e-13";
  const Outcome outcome =
      run_cchip({"pairs", "-", "--engine", "model"}, header + "\n" + tri_a + "," + b_through + "\n" + far + "," +
                                                         "1e10,1e-12,0,1e10,2e-13,1e-12,10000000000.000002,0,3e-13\n");
  CHECK(outcome.code == exit_usage);
  CHECK(outcome.out.empty());
  CHECK(lines(outcome.err).size() == 1);
  CHECK_THAT(outcome.err, Catch::Matchers::StartsWith("cchip: -:3: the pair is too small for its distance"));
  CHECK_THAT(outcome.err, Catch::Matchers::Contains("move both primitives nearer to the origin"));
}

TEST_CASE("errors: meshes", "[system][errors]") {
  const std::string models = CCHIP_TEST_MODELS;
  const TemporaryFolder folder;
  const std::string good = models + "/OFF/Cube.off";
  const std::string empty = folder.write("empty.stl", "");
  const std::string no_faces = folder.write("points.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n");
  for (const std::string& bad : {folder.path("missing.obj"), empty, no_faces, models + "/invalid/empty.obj",
                                 models + "/invalid/empty.off", models + "/OBJ/point_cloud.obj"}) {
    for (const auto& files : {std::vector<std::string>{bad, good}, std::vector<std::string>{good, bad}}) {
      CAPTURE(bad);
      const Outcome outcome = run_cchip({"meshpairs", files[0], files[1], "--engine", "exact"});
      CHECK(outcome.code == exit_usage);
      CHECK(outcome.out.empty());
      REQUIRE(lines(outcome.err).size() == 1);
      CHECK(outcome.err.rfind("cchip: " + bad + ": ", 0) == 0);  // then what is wrong, and what to do
      CHECK(outcome.err.find("; ") != std::string::npos);
    }
  }
}

TEST_CASE("errors: values without a meaning", "[system][errors]") {
  const std::string cube = std::string(CCHIP_TEST_MODELS) + "/OFF/Cube.off";
  const std::string input = header + "\n" + tri_a + "," + b_through + "\n";
  const std::string from_0 = "; write a whole number, 0 or more";
  const std::string from_1 = "; write a whole number, 1 or more";
  check_error({"meshpairs", cube, cube, "--limit", "-1"}, "cchip: --limit: got '-1'" + from_0);
  check_error({"pairs", "-", "--seed", "-3"}, "cchip: --seed: got '-3'" + from_0, input);
  check_error({"pairs", "-", "--seed", "abc"}, "cchip: --seed: got 'abc'" + from_0, input);
  check_error({"pairs", "-", "--seed", "18446744073709551616"}, "cchip: --seed: got '18446744073709551616'" + from_0,
              input);
  check_error({"pairs", "-", "--trace", "x.fst", "--trace-clocks", "-1"}, "cchip: --trace-clocks: got '-1'" + from_0,
              input);
  check_error({"pairs", "-", "--trace-clocks", "5"}, "cchip: --trace-clocks requires --trace; see cchip pairs --help",
              input);
  check_error({"pairs", "-", "--trace", "t.vcd"},
              "cchip: --trace t.vcd: the waveform is an FST; give a name that ends with .fst", input);
  check_error({"collide", cube, cube, "--most", "0"}, "cchip: --most: got '0'" + from_1);
  check_error({"collide", cube, cube, "--contacts", "first", "--most", "2"},
              "cchip: --most: each query stops at its first contact; add --contacts all, or leave --most out");
  check_error({"reconfig", "--pairs", "0"}, "cchip: --pairs: got '0'" + from_1);
  for (const std::string bits : {"1000000000000", "0", "-1", "127"}) {
    check_error({"reconfig", "--bitstream-bits", bits},
                "cchip: --bitstream-bits: got '" + bits + "'; write a whole number from 128 to 134217728");
  }
  for (const std::string option : {"--pose", "--pose-matrix", "--poses", "--ply", "--device"}) {
    check_error({"collide", cube, cube, option, ""},
                "cchip: " + option + ": the value is empty; write one, or leave the option out");
  }
  for (const std::string option : {"--trace", "--expect"}) {
    check_error({"pairs", "-", option, ""},
                "cchip: " + option + ": the value is empty; write one, or leave the option out", input);
  }
  check_error({"demo", "--ply", "x.ply", "--seed", "2"}, "cchip: --seed excludes --ply; see cchip demo --help");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"0,0,0", "0", "0", "90"}, {"0", "0", "0"}, {"1,", "2,", "3"}, {"1,0,0", "-2", "0"}}) {
    std::vector<std::string> arguments = {"collide", cube, cube, "--pose"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    check_error(arguments, "cchip: " + words[1] +
                               ": the pose is one word; write its numbers with commas and no spaces, like "
                               "0.5,0,0,0,0,90");
  }
}

TEST_CASE("errors: command line", "[system][errors]") {
  const std::string help = "; see cchip --help";
  const std::string pairs_help = "; see cchip pairs --help";
  check_error(
      {},
      "cchip: the command is missing; the commands are collide, distance, check, tree, clash, pairs, meshpairs, "
      "demo, reconfig, "
      "version, help" +
          help);
  check_error({"pairs"}, "cchip: the file of the pairs, FILE, is missing; see cchip pairs --help");
  check_error({"pairs", "f", "--engine", "abacus"},
              "cchip: --engine: abacus not in {rtl,model,eigen,exact}" + pairs_help);
  check_error({"pairs", "f", "--format", "xml"}, "cchip: --format: xml not in {table,csv,jsonl}" + pairs_help);
  const std::string commands =
      ": no such command; the commands are collide, distance, check, tree, clash, pairs, meshpairs, demo, reconfig, "
      "version, "
      "help";
  check_error({"foo"}, "cchip: foo" + commands);
  check_error({"foo", "--engine", "model"}, "cchip: foo" + commands);
  check_error({"--foo"}, "cchip: --foo: no such option; see cchip --help");
  check_error({"--foo", "foo"}, "cchip: --foo: no such option; see cchip --help");
  check_error({"pairs", "f", "--nonsense"}, "cchip: --nonsense: no such option; see cchip pairs --help");
  check_error({"meshpairs", "f", "--limits", "7"},
              "cchip: --limits: no such option; did you mean --limit? see cchip meshpairs --help");
  check_error({"pairs", "f", "g"}, "cchip: g: one argument too many; see cchip pairs --help");

  const std::string input = header + "\n" + tri_a + "," + b_through + "\n";
  check_error({"pairs", "-", "--program", "clever"},
              "cchip: --program: clever not in {exhaustive,directed}" + pairs_help, input);
  for (const std::string engine : {"model", "eigen", "exact"}) {
    check_error({"pairs", "-", "--engine", engine, "--trace", "x.fst"},
                "cchip: --trace: engine " + engine + " has no waveform; use --engine rtl", input);
  }
  check_error(
      {"pairs", "-", "--trace", "/no/such/folder/x.fst"},
      "cchip: /no/such/folder/x.fst: cannot be written (No such file or directory); check folder, permissions and disk "
      "space",
      input);
  const std::string cube = std::string(CCHIP_TEST_MODELS) + "/OFF/Cube.off";
  check_error({"meshpairs", cube, cube, "--pose", "1,2"},
              "cchip: --pose: got 2 numbers; write tx,ty,tz or tx,ty,tz,rx,ry,rz");
  check_error({"meshpairs", cube, cube, "--pose", "1,2,up"},
              "cchip: --pose: number 3: 'up' is not a number; write a finite decimal number");
  check_error(
      {"meshpairs", cube, cube, "--pose-matrix", "2,0,0,0,0,1,0,0,0,0,1,0"},
      "cchip: --pose-matrix: the left 3x3 part is not a rotation; write an orthonormal matrix with determinant 1 "
      "(to 1e-9)");
}

TEST_CASE("errors: what is missing or misspelt is named", "[system][errors]") {
  const std::string cube = std::string(CCHIP_TEST_MODELS) + "/OFF/Cube.off";
  for (const std::string command : {"collide", "meshpairs"}) {
    check_error({command}, "cchip: the first mesh, A, is missing; see cchip " + command + " --help");
    check_error({command, cube}, "cchip: the second mesh, B, is missing; see cchip " + command + " --help");
    check_error({command, cube, cube, "--format", "CSV"},
                "cchip: --format: CSV not in {table,csv,jsonl}; see cchip " + command + " --help");
    check_error({command, cube, cube, "--pos", "1,2,3"},
                "cchip: --pos: no such option; did you mean --pose? see cchip " + command + " --help");
    check_error({command, cube, cube, "--psoe=1,2,3"},
                "cchip: --psoe: no such option; did you mean --pose? see cchip " + command + " --help");
  }
  check_error({"collide", cube, cube, "--expect", "touches"},
              "cchip: --expect requires --poses; see cchip collide --help");
  const std::string commands =
      " the commands are collide, distance, check, tree, clash, pairs, meshpairs, demo, reconfig, version, help";
  check_error({"colide", cube, cube}, "cchip: colide: no such command; did you mean collide?" + commands);
  check_error({"mehspairs"}, "cchip: mehspairs: no such command; did you mean meshpairs?" + commands);
  check_error({"help", "pair"}, "cchip: pair: no such command; did you mean pairs?" + commands);
  check_error({"--verison"}, "cchip: --verison: no such option; did you mean --version? see cchip --help");
}

TEST_CASE("errors: values that look right", "[system][errors]") {
  const std::string cube = std::string(CCHIP_TEST_MODELS) + "/OFF/Cube.off";
  const TemporaryFolder folder;
  check_error({"collide", cube, cube, "--device", "sim", "--trace", "x.vcd"},
              "cchip: --trace x.vcd: the waveform is an FST; give a name that ends with .fst");
  for (const std::string command : {"collide", "meshpairs"}) {
    check_error({command, cube, cube, "--ply", "out.txt"},
                "cchip: --ply out.txt: the picture is a PLY file; give a name that ends with .ply");
    check_error({command, cube, cube, "--pose", "1 2 3"},
                "cchip: --pose: '1 2 3' has no commas; write commas between the numbers, like 0.5,0,0");
    check_error({command, cube, cube, "--pose-matrix", "1,0,0,0,0,1,0,0,0,0,1,0,5,0,0,1"},
                "cchip: --pose-matrix: the last row of the 4x4 matrix is 5,0,0,1, but must be 0,0,0,1; write the "
                "numbers row by row (transpose a matrix that is written column by column)");
  }
  const std::string empty = folder.write("empty.obj", "");
  check_error({"collide", cube, empty}, "cchip: " + empty + ": the file is empty (0 bytes); write the mesh again");
  const std::string part = folder.write("part.STEP", "ISO-10303-21;");
  check_error({"collide", part, cube}, "cchip: " + part +
                                           ": is STEP (surfaces of CAD, not a mesh), which is not read; mesh it first, "
                                           "for example with `gmsh -2 part.STEP -o part.stl` or with FreeCAD");
  for (const auto& [end, name] : {std::pair<std::string, std::string>{"gltf", "glTF"}, {"3mf", "3MF"}}) {
    const std::string scene = folder.write("scene." + end, "<xml/>");
    check_error(
        {"collide", scene, cube},
        "cchip: " + scene + ": is " + name +
            ", which is not read; `cchip clash` judges the parts of .glb, .gltf and .3mf files; for one mesh convert "
            "it with trimesh, which keeps numbers, axes and the places of the parts: `python3 -c \"import trimesh; "
            "trimesh.load_mesh('scene." +
            end + "').export('part.obj', digits=17)\"`");
  }
  const std::string scene = folder.write("scene.dae", "<xml/>");
  check_error({"collide", scene, cube},
              "cchip: " + scene +
                  ": is COLLADA, which is not read; convert it to PLY with MeshLab, which keeps axes and units: File, "
                  "Import Mesh, then File, Export Mesh As (Debian's assimp turns, scales or refuses some of them)");
}

TEST_CASE("help: every command has its own, with exit codes", "[system][errors]") {
  for (const std::string command : {"collide", "pairs", "meshpairs", "demo", "reconfig"}) {
    CAPTURE(command);
    const Outcome help = run_cchip({command, "--help"});
    CHECK(help.code == cchip::exit_ok);
    CHECK(help.out.find("Exit codes: 0 done,") != std::string::npos);
    // Not all of it: CLI11 lists what an option excludes in the order of addresses.
    const std::vector<std::string> same = lines(run_cchip({"help", command}).out);
    CHECK(same.size() == lines(help.out).size());
    CHECK(same.at(1) == "Usage: cchip " + command + lines(help.out).at(1).substr(13 + command.size()));
  }
  CHECK(run_cchip({"help"}).out == run_cchip({"--help"}).out);
  CHECK(run_cchip({"help"}).out.find("library") != std::string::npos);
  CHECK(run_cchip({"-v"}).out == run_cchip({"version"}).out);
  const Outcome version = run_cchip({"version", "--help"});
  CHECK(version.out.find("Print the version") != std::string::npos);
  CHECK(version.out.find("cchip collide") == std::string::npos);
}
