// SPDX-License-Identifier: Apache-2.0
// Every signal of the GTKWave layout must be in the waveform that it belongs to.
#include <gtkwave/fstapi.h>

#include <catch2/catch.hpp>
#include <cchip/driver/primtest_engine.hpp>
#include <cchip/machines/rtl_engine.hpp>
#include <cchip/sim/wave_on_failure.hpp>
#include <cchip/waves/wave_layout.hpp>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

using namespace cchip;

namespace {

/// Full names of all signals, "TOP.module.name[7:0]".
std::set<std::string> signals_of(const std::string& fst) {
  std::set<std::string> names;
  void* reader = fstReaderOpen(fst.c_str());
  REQUIRE(reader != nullptr);
  std::vector<std::string> scopes{""};
  while (const fstHier* entry = fstReaderIterateHier(reader)) {
    if (entry->htyp == FST_HT_SCOPE) scopes.push_back(scopes.back() + entry->u.scope.name + ".");
    if (entry->htyp == FST_HT_UPSCOPE) scopes.pop_back();
    if (entry->htyp != FST_HT_VAR) continue;
    std::string name = entry->u.var.name;
    const auto space = name.find(' ');  // "name [7:0]"
    if (space != std::string::npos) name.erase(space, 1);
    names.insert(scopes.back() + name);
  }
  fstReaderClose(reader);
  return names;
}

}  // namespace

TEST_CASE("harness: the layout names signals that exist", "[unit][harness]") {
  const ModuleId id = GENERATE(ModuleId::tri_tri, ModuleId::tri_quad, ModuleId::quad_quad);
  CAPTURE(to_name(id));
  RtlEngineOptions options;
  options.trace_path = sim::wave_folder() + "/harness_layout_" + to_name(id) + ".fst";
  options.trace_clocks = 10;
  GridPair pair;
  pair.a.kind = kinds_of(id)[0];
  pair.b.kind = kinds_of(id)[1];
  make_rtl_engine(options)->run({pair}, PairMode::directed);
  const std::set<std::string> signals = signals_of(options.trace_path);
  REQUIRE(signals.size() > 100);

  std::ifstream file(sim::wave_folder() + "/harness_layout_" + to_name(id) + ".gtkw");
  int named = 0;
  std::set<std::string> groups;
  bool dumpfile = false;
  bool savefile = false;
  for (std::string line; std::getline(file, line);) {
    dumpfile = dumpfile || line == "[dumpfile] \"" + options.trace_path + "\"";
    savefile = savefile || line == "[savefile] \"" + sim::wave_folder() + "/harness_layout_" + to_name(id) + ".gtkw\"";
    if (line.front() == '-') groups.insert(line.substr(1));
    if (line.front() != '+' && line.front() != '#') continue;
    std::istringstream words(line);
    for (std::string word; words >> word;) {  // "(3)TOP.name[7:0]"
      const auto at = word.find("TOP.");
      if (at == std::string::npos) continue;
      INFO(line.substr(0, 80));
      CHECK(signals.count(word.substr(at)) == 1);
      ++named;
    }
  }
  CHECK(dumpfile);
  CHECK(savefile);
  CHECK(named > 100);
  for (const char* group : {"stream s_pair", "axis controller", "macro stage 1 select", "macro stage 2 axis",
                            "macro stage 3 project", "macro stage 4 compare", "stream m_result"}) {
    CHECK(groups.count(group) == 1);
  }
}

TEST_CASE("harness: each module of an engine has its waveform", "[unit][harness]") {
  RtlEngineOptions options;
  options.trace_path = sim::wave_folder() + "/harness_modules.fst";
  options.trace_clocks = 10;
  std::vector<GridPair> pairs(3);
  pairs[0].b.kind = pairs[1].a.kind = pairs[2].a.kind = pairs[2].b.kind = Kind::quad;
  const auto path = [](const std::string& end) { return sim::wave_folder() + "/harness_modules" + end; };
  for (const char* end : {".fst", "_tri_tri.fst", "_tri_quad.fst", "_quad_quad.fst"})
    std::filesystem::remove(path(end));
  make_rtl_engine(options)->run(pairs, PairMode::directed);
  CHECK(std::filesystem::exists(path(".fst")));  // of tri_quad, the first that was needed
  CHECK(std::filesystem::exists(path("_quad_quad.fst")));
  CHECK(std::filesystem::exists(path("_quad_quad.gtkw")));
  CHECK_FALSE(std::filesystem::exists(path("_tri_quad.fst")));
  CHECK_FALSE(std::filesystem::exists(path("_tri_tri.fst")));
}

TEST_CASE("harness: a layout that cannot be written is an error", "[unit][harness]") {
  CHECK_THROWS_WITH(write_gtkw("/dev/null/wave.fst", ModuleId::tri_tri), Catch::Contains("cannot be written"));
}
