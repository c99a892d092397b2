// SPDX-License-Identifier: Apache-2.0
// cchip collide --certificate and cchip check.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/program/usage_error.hpp>

#include "support.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

const std::string cube_file = std::string(CCHIP_TEST_MODELS) + "/OFF/Cube.off";      // six quads, from -0.5 to 0.5
const std::string spider_file = std::string(CCHIP_TEST_MODELS) + "/OBJ/spider.obj";  // polygons that have to be cut

Outcome prove(const std::string& a, const std::string& b, const std::string& file, std::vector<std::string> options) {
  options.insert(options.begin(), {"collide", a, b, "--certificate", file});
  Outcome outcome = run_cchip(options);
  CHECK(outcome.code == exit_ok);
  return outcome;
}

Outcome check(const std::string& a, const std::string& b, const std::string& file, std::vector<std::string> options) {
  options.insert(options.begin(), {"check", a, b, file});
  return run_cchip(options);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::runtime_error("no " + what + " in " + text);
  return text.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE("check: a certificate of collide is accepted, its claim is the answer", "[system][check]") {
  const TemporaryFolder folder;
  const std::string file = folder.path("proof.jsonl");
  struct Case {
    std::vector<std::string> pose;
    std::vector<std::string> options;
    std::string claim;
  };
  const std::vector<Case> cases = {
      {{"--pose", "5,0,0"}, {}, "no contacts, apart"},
      {{"--pose", "1,1,1"}, {}, "9 contacts and no others, touching"},
      {{"--pose-matrix", "1,0,0,1,0,1,0,1,0,0,1,1"}, {}, "9 contacts and no others, touching"},
      {{"--pose", "1,1,1"}, {"--counts", "crossing"}, "no contacts, touching"},
      {{"--pose", "5,0,0"}, {"--contacts", "first"}, "no contacts"}};
  for (const Case& c : cases) {
    std::vector<std::string> options = c.pose;
    options.insert(options.end(), c.options.begin(), c.options.end());
    prove(cube_file, cube_file, file, options);
    const Outcome outcome = check(cube_file, cube_file, file, c.pose);
    CHECK(outcome.code == exit_ok);
    CHECK(outcome.out == "accepted: " + c.claim + "\ncertificates=1 accepted=1 refused=0\n");
    CHECK(outcome.err.empty());
  }
  prove(cube_file, cube_file, file, {"--pose", "1,1,1", "--contacts", "first"});
  CHECK_THAT(lines(check(cube_file, cube_file, file, {"--pose", "1,1,1"}).out).front(),
             Catch::Matchers::Matches("accepted: face [0-5] of A meets face [0-5] of B"));
  // Faces that were cut, and the model of the chip.
  const std::vector<std::string> pose = {"--pose-matrix", "40,0,10,3,0,-50,0,2,5,0,30,1"};
  prove(spider_file, cube_file, file, {pose[0], pose[1], "--device", "model"});
  CHECK_THAT(check(spider_file, cube_file, file, pose).out, Catch::StartsWith("accepted: "));
  // From standard input.
  const Outcome piped = run_cchip({"check", spider_file, cube_file, "-", pose[0], pose[1]}, folder.read("proof.jsonl"));
  CHECK(last_line(piped.out) == "certificates=1 accepted=1 refused=0");
}

TEST_CASE("check: trees are made once and cited", "[system][check]") {
  const TemporaryFolder folder;
  const std::string file = folder.path("proof.jsonl"), spider = folder.path("spider.tree"),
                    cube = folder.path("cube.tree");
  CHECK(run_cchip({"tree", spider_file, spider}).code == exit_ok);
  CHECK(run_cchip({"tree", cube_file, cube}).code == exit_ok);
  const std::string poses = folder.write("poses.csv", "tx,ty,tz\n0,0,0\n60,0,10\n500,0,0\n");
  const std::vector<std::string> trees = {"--poses", poses, "--tree-a", spider, "--tree-b", cube};
  std::vector<std::string> options = trees;
  options.insert(options.end(), {"--contacts", "all"});
  prove(spider_file, cube_file, file, options);
  const std::string proof = folder.read("proof.jsonl");
  CHECK_THAT(proof, Catch::Contains("{\"collisionchip_certificate\":3,") && !Catch::Contains("order_a"));
  const Outcome outcome = check(spider_file, cube_file, file, trees);
  CHECK(outcome.code == exit_ok);
  CHECK(last_line(outcome.out) == "certificates=3 accepted=3 refused=0");
  const Outcome without = check(spider_file, cube_file, file, {"--poses", poses});
  CHECK(without.code == exit_refused);
  CHECK_THAT(without.out, Catch::Contains("it cites trees, and none are given"));
  folder.write("cube.tree", "{\"collisionchip_tree\":1,\"mesh\":\"0000000000000000\",\"order\":[[0,5]]}\n");
  const auto refuses = [](const std::vector<std::string>& arguments, const std::string& why) {
    const Outcome refused = run_cchip(arguments);
    CHECK(refused.code == exit_usage);
    CHECK_THAT(refused.err, Catch::Contains(why));
  };
  refuses({"check", spider_file, cube_file, file, "--poses", poses, "--tree-a", spider, "--tree-b", cube},
          "cube.tree: tree: it is of another mesh; make it of this mesh with cchip tree");
  refuses(
      {"check", spider_file, cube_file, file, "--poses", poses, "--tree-a", spider, "--tree-b", folder.path("none")},
      "none: the file cannot be read");
  refuses({"check", spider_file, cube_file, file, "--poses", poses, "--tree-a", spider}, "--tree-b");
  refuses({"collide", spider_file, cube_file, "--tree-a", spider, "--tree-b", cube}, "--certificate");
  refuses({"tree", folder.path("none.off"), spider}, "none.off");
  refuses({"tree", cube_file, cube_file}, "Cube.off");
}

TEST_CASE("check: what does not hold is refused, the cell and the reason named", "[system][check]") {
  const TemporaryFolder folder;
  const std::string file = folder.path("proof.jsonl");
  prove(cube_file, cube_file, file, {"--pose", "5,0,0"});
  const auto refusal = [&](const std::string& text, const std::string& pose = "5,0,0") {
    const Outcome outcome = check(cube_file, cube_file, folder.write("changed.jsonl", text), {"--pose", pose});
    CHECK(outcome.code == exit_refused);
    CHECK(last_line(outcome.out) == "certificates=1 accepted=0 refused=1");
    return lines(outcome.out).front();
  };
  const std::string text = folder.read("proof.jsonl");
  REQUIRE(lines(text).size() == 2);
  CHECK(refusal(text, "5,0,1") == "refused: cell 0: the certificate is of other poses");
  CHECK(refusal(replaced(text, "\"apart\"", "\"touching\"")) == "refused: claim: another relation than claimed");
  CHECK(refusal(lines(text)[0] + "\n") == "refused: claim: cells are missing");
  CHECK(refusal(lines(text)[0] + "\n{\"cell\":\"separated\",\"direction\":[\"-1\",\"0\",\"0\"]}\n") ==
        "refused: cell 0: A is not strictly below B");
  const std::string split = "{\"cell\":\"split_a\",\"at\":3}\n";
  const std::string good = "{\"cell\":\"separated\",\"direction\":[\"1\",\"0\",\"0\"]}\n";
  CHECK(refusal(lines(text)[0] + "\n" + split + good + replaced(good, "1", "0")) ==
        "refused: cell 2: the direction is 0");
}

TEST_CASE("check: a certificate for each pose of a file", "[system][check]") {
  const TemporaryFolder folder;
  const std::string file = folder.path("proof.jsonl");
  const std::string header = "r00,r01,r02,r10,r11,r12,r20,r21,r22,tx,ty,tz\n";
  const std::string rows = "1,0,0,0,1,0,0,0,1,1,1,1\n1,0,0,0,1,0,0,0,1,5,0,0\n1,0,0,0,1,0,0,0,1,0.5,0.25,0.125\n";
  const std::string poses = folder.write("poses.csv", header + rows);
  prove(cube_file, cube_file, file, {"--poses", poses, "--contacts", "all"});
  const Outcome good = check(cube_file, cube_file, file, {"--poses", poses});
  CHECK(good.code == exit_ok);
  REQUIRE(lines(good.out).size() == 4);
  CHECK(lines(good.out)[0] == "certificate 1 accepted: 9 contacts and no others");
  CHECK(lines(good.out)[1] == "certificate 2 accepted: no contacts");
  CHECK(lines(good.out)[3] == "certificates=3 accepted=3 refused=0");
  const std::string other = folder.write("other.csv", header + replaced(rows, "5,0,0", "4,0,0"));
  const Outcome one = check(cube_file, cube_file, file, {"--poses", other});
  CHECK(one.code == exit_refused);
  CHECK(lines(one.out)[1] == "certificate 2 refused: cell 0: the certificate is of other poses");
  CHECK(last_line(one.out) == "certificates=3 accepted=2 refused=1");
  // Another number of poses.
  const std::string fewer = folder.write("fewer.csv", header + rows.substr(0, rows.find('\n') + 1));
  const Outcome few = check(cube_file, cube_file, file, {"--poses", fewer});
  CHECK(few.code == exit_usage);
  CHECK_THAT(few.err, Catch::Contains("it holds more certificates than there are poses, 1"));
  const std::string more = folder.write("more.csv", header + rows + rows);
  const Outcome many = check(cube_file, cube_file, file, {"--poses", more});
  CHECK(many.code == exit_usage);
  CHECK_THAT(many.err, Catch::Contains("it holds fewer certificates than there are poses, 3"));
}

TEST_CASE("check: hostile files and wrong options end with a line and exit code 2", "[system][check]") {
  const TemporaryFolder folder;
  const std::string file = folder.path("proof.jsonl");
  prove(cube_file, cube_file, file, {"--pose", "5,0,0"});
  const std::string text = folder.read("proof.jsonl");
  const auto refuses = [&](const std::vector<std::string>& arguments, const std::string& reason) {
    const Outcome outcome = run_cchip(arguments);
    INFO(outcome.err);
    CHECK(outcome.code == exit_usage);
    CHECK(lines(outcome.err).size() == 1);
    CHECK_THAT(outcome.err, Catch::StartsWith("cchip: ") && Catch::Contains(reason));
  };
  const auto refuses_text = [&](const std::string& hostile, const std::string& reason) {
    refuses({"check", cube_file, cube_file, folder.write("hostile.jsonl", hostile)}, reason);
  };
  refuses_text("", "it holds fewer certificates than there are poses");
  refuses_text("\n", "certificate, line 1: ");
  refuses_text("{}", "certificate, line 1: ");
  refuses_text(std::string(100000, '['), "certificate, line 1: ");
  refuses_text("\xff\xfe", "certificate, line 1: ");
  refuses_text(std::string("\0\0", 2), "certificate, line 1: ");
  refuses_text(text + "{\"cell\":\"magic\"}\n", "certificate, line 3: unknown word");
  refuses_text(replaced(text, "certificate\":1", "certificate\":4"),
               "line 1: no certificate, or another version of it");
  refuses_text(text + "[1]\n", "certificate, line 3: ");
  refuses({"check", cube_file, cube_file, folder.path("none")}, "none: the file cannot be read");
  refuses({"check", cube_file, cube_file, folder.path("")}, "is a directory");
  refuses({"check", cube_file, file, file}, "proof.jsonl: ");
  refuses({"check", cube_file, "-", "-"}, "-");
  refuses({"check", cube_file, cube_file}, "FILE");
  refuses({"check", cube_file, cube_file, file, "--pose", "1,2"}, "--pose");
  refuses({"check", cube_file, cube_file, file, "--pose", "1,2,3", "--poses", file}, "--pose");
  refuses({"collide", cube_file, cube_file, "--certificate", cube_file}, "this is the file that A reads");
  refuses({"collide", cube_file, cube_file, "--certificate", folder.path("no/folder/proof")}, "cannot be written");
}

TEST_CASE("check: faces that were left out are left out again", "[system][check]") {
  const TemporaryFolder folder;
  const std::string broken = folder.write("broken.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\nf 1 2 3\n");
  const std::string file = folder.path("proof.jsonl");
  CHECK(run_cchip({"collide", broken, cube_file, "--lenient", "--certificate", file}).code == exit_left_out);
  const Outcome outcome = check(broken, cube_file, file, {"--lenient"});
  CHECK(outcome.code == exit_left_out);
  CHECK(last_line(outcome.out) == "certificates=1 accepted=1 refused=0");
  CHECK(check(broken, cube_file, file, {}).code == exit_usage);
}
