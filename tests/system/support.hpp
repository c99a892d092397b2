// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the tests of the command line share.
#ifndef CCHIP_TESTS_SYSTEM_SUPPORT_HPP
#define CCHIP_TESTS_SYSTEM_SUPPORT_HPP

#include <unistd.h>

#include <cchip/internal/driver/pair_engine.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli.hpp"
#include "hardware.hpp"

namespace cchip::test {

/// A folder that is deleted with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "cchip_test_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder: check TMPDIR");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string path(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  std::string read(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(path(name), std::ios::binary).rdbuf();
    return text.str();
  }

 private:
  std::filesystem::path path_;
};

struct Outcome {
  int code = -1;
  std::string out;
  std::string err;
};

/// The command line in this process.
inline Outcome run_cchip(std::vector<std::string> arguments, const std::string& input = "", bool terminal = false) {
  std::istringstream in(input);
  std::ostringstream out;
  std::ostringstream err;
  const int code = app::run_cli(std::move(arguments), {in, out, err, terminal}, app::hardware());
  return {code, out.str(), err.str()};
}

inline std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) result.push_back(line);
  return result;
}

inline std::string last_line(const std::string& text) {
  const std::vector<std::string> all = lines(text);
  return all.empty() ? "" : all.back();
}

/// Value of "name=value" in a summary line.
inline std::uint64_t count(const std::string& summary, const std::string& name) {
  const auto at = (" " + summary).find(" " + name + "=");
  if (at == std::string::npos) throw std::runtime_error("no " + name + " in: " + summary);
  return std::stoull(summary.substr(at + name.size() + 1));
}

inline const std::string header = "a0x,a0y,a0z,a1x,a1y,a1z,a2x,a2y,a2z,b0x,b0y,b0z,b1x,b1y,b1z,b2x,b2y,b2z";
/// Triangle A of the hand-made pairs.
inline const std::string tri_a = "0,0,0,4,0,0,0,4,0";
/// Partners of tri_a, the answers worked out by hand.
inline const std::string b_through = "1,1,-1,1,1,1,2,2,1";       // its edge 0 passes (1,1,0): hit
inline const std::string b_above = "0,0,1,4,0,1,0,4,2";          // z >= 1: no, separated by A's normal
inline const std::string b_touching = "1,1,0,1,1,3,2,1,3";       // vertex 0 lies in A: hit
inline const std::string b_just_above = "1,1,1e-9,1,1,3,2,1,3";  // the same, lifted: no, but a hit on the grid
inline const std::string b_coplanar = "1,1,0,2,1,0,1,2,0";       // inside A, in its plane: hit

/// Pairs of all kinds in one file, the answers worked out by hand.
inline const std::string mixed_header = "note," + header + ",kind_a,a3x,a3y,a3z,kind_b,b3x,b3y,b3z,touches";
inline const std::vector<std::string> mixed_rows = {
    "triangle through triangle," + tri_a + "," + b_through + ",tri,,,,tri,,,,1",
    "triangle in the square's second half,1,3,-1,1,3,1,1,4,1,0,0,0,4,0,0,4,4,0,tri,,,,quad,0,4,0,1",
    "the square's second half is not there,1,3,-1,1,3,1,1,4,1,0,0,0,4,0,0,4,4,0,tri,,,,tri,,,,0",
    "square and triangle beside it,0,0,0,4,0,0,4,4,0,5,3,-1,5,3,1,5,4,1,quad,0,4,0,tri,,,,0",
    "square through square,0,0,0,4,0,0,4,4,0,1,1,-1,3,1,-1,3,1,1,quad,0,4,0,quad,1,1,1,1",
    "square above square,0,0,0,4,0,0,4,4,0,0,0,1,4,0,1,4,4,1,quad,0,4,0,quad,0,4,1,0",
    "outline that crosses itself,0,0,0,4,4,0,4,0,0,2,1,-1,2,1,1,3,1,1,quad,0,4,0,tri,,,,1",
    "outline that crosses itself; beside it,0,0,0,4,4,0,4,0,0,5,1,-1,5,1,1,6,1,1,quad,0,4,0,tri,,,,0",
    "vertex inside the others,0,0,0,9,0,0,2,2,0,3,3,-1,3,3,1,4,3,1,quad,0,9,0,tri,,,,1",
    "tetrahedron holds the triangle,0,0,0,9,0,0,0,9,0,1,1,1,2,1,1,1,2,1,quad,0,0,9,tri,,,,1",
    "tetrahedron and triangle in front of its slope,0,0,0,9,0,0,0,9,0,5,5,1,5,5,2,6,5,1,quad,0,0,9,tri,,,,0",
    "tetrahedron touches tetrahedron,0,0,0,9,0,0,0,9,0,3,3,3,9,9,9,9,9,3,quad,0,0,9,quad,9,3,9,1",
    "segment crosses segment,0,0,0,4,4,0,2,2,0,4,0,0,0,4,0,1,3,0,quad,1,1,0,tri,,,,1",
    "segment beside segment,0,0,0,4,4,0,2,2,0,5,0,0,5,4,0,5,3,0,quad,1,1,0,quad,5,1,0,0",
};
inline std::string mixed_file() {
  std::string text = mixed_header + "\n";
  for (const std::string& row : mixed_rows) text += row + "\n";
  return text;
}

/// An answer of an engine without a clock.
inline EngineAnswer answer(bool grid, bool definite) {
  EngineAnswer result;
  result.grid = grid;
  result.definite = definite;
  result.hit = grid || !definite;
  return result;
}

/// Engine that answers as the test tells it.
class ScriptedEngine : public PairEngine {
 public:
  using Answer = EngineAnswer (*)(const GridPair&);
  explicit ScriptedEngine(Answer answer) : answer_(answer) {}
  const char* name() const override { return "scripted"; }
  int coord_w() const override { return 16; }
  using PairEngine::run;
  std::vector<EngineAnswer> run(const std::vector<GridPair>& pairs, const std::vector<PairMode>&) override {
    batches.push_back(pairs.size());
    std::vector<EngineAnswer> answers;
    answers.reserve(pairs.size());
    for (const GridPair& pair : pairs) answers.push_back(answer_(pair));
    return answers;
  }
  std::vector<std::size_t> batches;

 private:
  Answer answer_;
};

}  // namespace cchip::test

#endif
