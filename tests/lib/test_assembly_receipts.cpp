// SPDX-License-Identifier: Apache-2.0
// Receipts of assemblies whose verdicts follow from their numbers; what was changed proves nothing that is not so.
#include <catch2/catch.hpp>
#include <cchip/assembly_receipts.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/shapes.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <random>
#include <sstream>
#include <string>

#include "bvh_meshes.hpp"
#include "random_poses.hpp"

using namespace cchip;
using cchip::testing::make_box;
namespace fs = std::filesystem;

namespace cchip {
std::ostream& operator<<(std::ostream& out, ReceiptState state) { return out << name_of(state); }
}  // namespace cchip

namespace {

using RuleKind = AssemblyRule::Kind;

class ReceiptFolder {
 public:
  ReceiptFolder() : path_(fs::temp_directory_path() / ("cchip_receipts_" + std::to_string(std::random_device()()))) {}
  ~ReceiptFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ReceiptFolder(const ReceiptFolder&) = delete;
  ReceiptFolder& operator=(const ReceiptFolder&) = delete;
  std::string path() const { return path_.string(); }
  std::string read(const std::string& name) const {
    std::ifstream file(path_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
  }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(path_)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  fs::path path_;
};

Pose shifted(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }

AssemblyRule rule(RuleKind kind, double limit = 0) {
  AssemblyRule made;
  made.kind = kind;
  made.limit = limit;
  if (kind == RuleKind::inside || kind == RuleKind::same) made.parts = {"a", "b"};
  if (kind == RuleKind::anything) made.reason = "pressed in";
  return made;
}

Assembly two(const Object& a, const Object& b, const Pose& pose_b, const AssemblyRule& with) {
  Assembly assembly;
  assembly.parts = {{"a", a}, {"b", b, pose_b}};
  assembly.rules = {with};
  return assembly;
}

/// Writes the receipts and checks them.
ReceiptReport proved(const Assembly& assembly, const ReceiptFolder& folder) {
  write_receipts(assembly, check(assembly), folder.path());
  return verify_receipts(assembly, folder.path());
}

ReceiptState state_of(const Assembly& assembly) {
  const ReceiptFolder folder;
  const ReceiptReport report = proved(assembly, folder);
  if (report.pairs.empty()) return report.by_boxes == 1 ? ReceiptState::proved : ReceiptState::missing;
  INFO(report.pairs[0].text);
  return report.pairs[0].state;
}

Object box(const Vec3d& low, const Vec3d& high) { return Object(make_box(low, high)); }
const Object cube = box({0, 0, 0}, {1, 1, 1});

/// Boxes on a grid of halves, some of them turned by whole turns of a coordinate system, one inside another now and
/// then.
Assembly boxes_on_a_grid(std::mt19937_64& random) {
  Assembly assembly;
  const auto half = [&random](unsigned count) { return 0.5 * double(random() % count); };
  for (std::size_t i = 0; i < 6; ++i) {
    const Vec3d low(half(6), half(6), half(6));
    Mesh mesh = make_box(low, low + Vec3d(0.5 + half(3), 0.5 + half(3), 0.5 + half(3)));
    if (random() % 3 == 0) mesh = subdivided(mesh);
    assembly.parts.push_back({std::string(1, char('a' + char(i))), Object(mesh)});
  }
  constexpr std::array<RuleKind, 4> kinds = {RuleKind::nothing, RuleKind::touching, RuleKind::overlap,
                                             RuleKind::clearance};
  AssemblyRule all;
  all.kind = kinds[random() % kinds.size()];
  all.limit = 0.5;
  assembly.rules = {all, rule(RuleKind::inside)};
  if (random() % 2 == 0) {
    AssemblyRule free = rule(RuleKind::anything);
    free.parts = {"c", "d"};
    assembly.rules.push_back(free);
  }
  return assembly;
}

}  // namespace

TEST_CASE("receipts: a proof of each verdict", "[assembly][receipts]") {
  const Object small = box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75});
  const auto state = [](const Object& a, const Object& b, const Pose& pose, RuleKind kind, double limit = 0) {
    return state_of(two(a, b, pose, rule(kind, limit)));
  };
  using State = ReceiptState;
  CHECK(state(cube, cube, shifted(2, 0, 0), RuleKind::nothing) == State::proved);
  CHECK(state(cube, cube, shifted(1, 0, 0), RuleKind::nothing) == State::violation);
  CHECK(state(cube, cube, shifted(1, 0, 0), RuleKind::touching) == State::proved);
  CHECK(state(cube, cube, shifted(1, 0, 0), RuleKind::overlap, 0.1) == State::proved);
  CHECK(state(cube, cube, shifted(0.9375, 0, 0), RuleKind::touching) == State::violation);
  CHECK(state(cube, cube, shifted(0.9375, 0, 0), RuleKind::overlap, 0.0625 + 1e-9) == State::proved);
  CHECK(state(cube, cube, shifted(0.9375, 0, 0), RuleKind::overlap, 0.06) == State::unproved);
  CHECK(state(cube, small, shifted(0, 0, 0), RuleKind::nothing) == State::violation);
  CHECK(state(cube, small, shifted(0, 0, 0), RuleKind::inside) == State::violation);  // b in a, and not a in b
  CHECK(state(small, cube, shifted(0, 0, 0), RuleKind::inside) == State::proved);
  CHECK(state(small, cube, shifted(2, 0, 0), RuleKind::inside) == State::violation);
  CHECK(state(cube, cube, shifted(0, 0, 0), RuleKind::same) == State::proved);
  CHECK(state(cube, box({0, 0, 0}, {1, 1, 1}), shifted(0, 0, 0), RuleKind::same) == State::proved);
  CHECK(state(cube, cube, shifted(1, 0, 0), RuleKind::same) == State::unproved);  // a contact is no violation of it
  CHECK(state(cube, cube, shifted(0, 0, 0), RuleKind::nothing) == State::violation);
  CHECK(state(cube, cube, shifted(1.5, 0, 0), RuleKind::clearance, 0.5) == State::proved);  // exactly
  CHECK(state(cube, cube, shifted(1.5, 0, 0), RuleKind::clearance, std::nextafter(0.5, 1)) == State::violation);
  CHECK(state(cube, cube, shifted(1, 0, 0), RuleKind::clearance, 0.5) == State::violation);
  CHECK(state(small, cube, shifted(0, 0, 0), RuleKind::clearance, 0.125) == State::violation);
}

TEST_CASE("receipts: solids in solids and open meshes", "[assembly][receipts]") {
  Mesh shell = make_box({0, 0, 0}, {3, 3, 3});
  const Mesh cavity = make_box({1, 1, 1}, {2, 2, 2});
  for (Mesh::Face face : cavity.faces) {  // turned inside out
    std::swap(face.vertex[0], face.vertex[2]);
    for (std::size_t i = 0; i < static_cast<std::size_t>(face.kind); ++i) face.vertex[i] += 8;
    shell.faces.push_back(face);
  }
  shell.vertices.insert(shell.vertices.end(), cavity.vertices.begin(), cavity.vertices.end());
  const Object hollow(shell);
  const Object pea = box({1.25, 1.25, 1.25}, {1.75, 1.75, 1.75});
  CHECK(state_of(two(hollow, pea, Pose::Identity(), rule(RuleKind::nothing))) == ReceiptState::proved);
  CHECK(state_of(two(hollow, pea, shifted(-1, 0, 0), rule(RuleKind::nothing))) == ReceiptState::violation);
  CHECK(state_of(two(hollow, pea, Pose::Identity(), rule(RuleKind::clearance, 0.25))) == ReceiptState::proved);

  Mesh open = make_box({0, 0, 0}, {1, 1, 1});
  open.faces.pop_back();
  const Object lid(open);
  CHECK(state_of(two(lid, cube, shifted(1, 0, 0), rule(RuleKind::touching))) == ReceiptState::proved);
  CHECK(state_of(two(lid, lid, shifted(1, 0, 0), rule(RuleKind::touching))) == ReceiptState::proved);
  CHECK(state_of(two(lid, lid, shifted(0.5, 0.25, 0.125), rule(RuleKind::touching))) == ReceiptState::violation);
  CHECK(state_of(two(hollow, lid, shifted(0.5, 0.5, 0.5), rule(RuleKind::nothing))) == ReceiptState::violation);
}

TEST_CASE("receipts: of random assemblies they say what the report says", "[assembly][receipts]") {
  std::mt19937_64 random(1000 * sim::seed_from_environment() + 1);
  std::map<std::string, int> states;
  for (int n = 0; n < 60; ++n) {
    const Assembly assembly = boxes_on_a_grid(random);
    const AssemblyReport report = check(assembly);
    const ReceiptFolder folder;
    write_receipts(assembly, report, folder.path());
    const ReceiptReport verified = verify_receipts(assembly, folder.path(), 1 + unsigned(random() % 3));
    std::map<std::pair<std::size_t, std::size_t>, bool> is_violation;
    for (const AssemblyPair& pair : report.pairs) is_violation[{pair.a, pair.b}] = pair.is_violation;
    for (const CheckedReceipt& pair : verified.pairs) {
      INFO(n << ": " << pair.text);
      ++states[name_of(pair.state)];
      const bool violates = is_violation[{pair.a, pair.b}];
      CHECK(pair.state != ReceiptState::refused);
      CHECK(pair.state != ReceiptState::stale);
      CHECK(pair.state != ReceiptState::missing);
      if (pair.state == ReceiptState::proved) CHECK_FALSE(violates);
      if (pair.state == ReceiptState::violation) CHECK(violates);
      is_violation.erase({pair.a, pair.b});
    }
    for (const auto& [numbers, violates] : is_violation) CHECK_FALSE(violates);  // none was left out
  }
  for (const auto& [state, count] : states) std::cout << state << '=' << count << ' ';
  std::cout << '\n';
  CHECK(states["proved"] > 5 * states["unproved"]);
  CHECK(states["violation"] > 0);
}

TEST_CASE("receipts: what was changed proves nothing that is not so", "[assembly][receipts]") {
  std::mt19937_64 random(1000 * sim::seed_from_environment() + 2);
  int refused = 0, unread = 0, same = 0;
  for (int n = 0; n < 12; ++n) {
    const Assembly assembly = boxes_on_a_grid(random);
    const ReceiptFolder folder;
    const ReceiptReport truth = proved(assembly, folder);
    for (const std::string& name : folder.files()) {
      const std::string text = folder.read(name);
      for (int k = 0; k < 8; ++k) {
        std::string changed = text;
        char& byte = changed[random() % changed.size()];
        const char other = "0123456789-,\"abcdef[]"[random() % 21];
        if (byte == other) continue;
        byte = other;
        folder.write(name, changed);
        try {
          const ReceiptReport now = verify_receipts(assembly, folder.path());
          REQUIRE(now.pairs.size() == truth.pairs.size());
          for (std::size_t i = 0; i < now.pairs.size(); ++i) {
            const ReceiptState was = truth.pairs[i].state;
            const ReceiptState is = now.pairs[i].state;
            ++(is == was ? same : refused);
            INFO(changed);
            if (is == ReceiptState::proved) CHECK(was != ReceiptState::violation);
            if (is == ReceiptState::violation) CHECK(was != ReceiptState::proved);
          }
        } catch (const std::runtime_error& error) {
          ++unread;
          CHECK(std::string(error.what()).find("receipts.json: ") != std::string::npos);
        }
      }
      folder.write(name, text);
    }
  }
  std::cout << "refused=" << refused << " unread=" << unread << " same=" << same << '\n';
  CHECK(refused > 0);
  CHECK(unread > 0);
}

TEST_CASE("receipts: stale, missing and refused", "[assembly][receipts]") {
  Assembly assembly = two(cube, cube, shifted(1, 0, 0), rule(RuleKind::touching));
  const ReceiptFolder folder;
  REQUIRE(proved(assembly, folder).count(ReceiptState::proved) == 1);
  const auto text_of = [&](const Assembly& now) { return verify_receipts(now, folder.path()).pairs.at(0).text; };

  Assembly other = assembly;
  other.parts[1].pose = shifted(std::nextafter(1, 2), 0, 0);
  CHECK(text_of(other) == "a and b: the poses are others");
  other = assembly;
  other.parts[0].object = Object(subdivided(make_box({0, 0, 0}, {1, 1, 1})));
  CHECK(text_of(other) == "a and b: the mesh of a is another one");
  CHECK(verify_receipts(other, folder.path()).pairs[0].state == ReceiptState::stale);
  other = assembly;
  other.parts.push_back({"c", cube, shifted(0, 1, 0)});
  CHECK(verify_receipts(other, folder.path()).count(ReceiptState::missing) == 2);
  other = assembly;
  other.rules = {rule(RuleKind::nothing)};  // the same receipt, under a rule that wants more
  CHECK(verify_receipts(other, folder.path()).count(ReceiptState::unproved) == 1);

  const std::string tree = folder.files().back(), tree_text = folder.read(tree);
  REQUIRE(tree.rfind("tree-", 0) == 0);
  folder.write(tree, "{\"collisionchip_tree\":1,\"mesh\":\"" + tree.substr(5, 16) + "\",\"order\":[5,4,3,2,1,0]}\n");
  CHECK(text_of(assembly) == "a and b: 000001.jsonl: it cites other trees");
  folder.write(tree, "");
  CHECK(text_of(assembly) == "a and b: 000001.jsonl: tree: the file is empty or cannot be read");
  fs::remove(folder.path() + "/" + tree);
  CHECK(text_of(assembly) == "a and b: 000001.jsonl: " + tree + " cannot be read");
  folder.write(tree, tree_text);
  CHECK(verify_receipts(assembly, folder.path()).count(ReceiptState::proved) == 1);
  fs::remove(folder.path() + "/000001.jsonl");
  CHECK(text_of(assembly) == "a and b: 000001.jsonl cannot be read");
  CHECK(verify_receipts(assembly, folder.path()).pairs[0].state == ReceiptState::refused);
}

TEST_CASE("receipts: folders", "[assembly][receipts]") {
  const Assembly assembly = two(cube, cube, shifted(1, 0, 0), rule(RuleKind::touching));
  const ReceiptFolder folder;
  CHECK_THROWS_WITH(verify_receipts(assembly, folder.path()), Catch::EndsWith("/receipts.json: cannot be read; give a "
                                                                              "folder that --receipts has written"));
  proved(assembly, folder);
  const std::string text = folder.read("receipts.json");
  proved(assembly, folder);  // in their place
  CHECK(folder.read("receipts.json") == text);
  CHECK(folder.files().size() == 3);  // with a tree
  fs::remove(folder.path() + "/" + folder.files().back());
  CHECK(folder.files() == std::vector<std::string>{"000001.jsonl", "receipts.json"});
  std::string elsewhere = text;
  elsewhere.replace(elsewhere.find("000001.jsonl"), 12, "../1.jsonl");
  folder.write("receipts.json", elsewhere);
  CHECK_THROWS_WITH(verify_receipts(assembly, folder.path()), Catch::Contains("'file' names another folder"));
  fs::remove(folder.path() + "/receipts.json");
  CHECK_THROWS_WITH(proved(assembly, folder), Catch::Contains("holds files, but no receipts.json"));
}
