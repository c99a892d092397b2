// SPDX-License-Identifier: Apache-2.0
// Every signal of the GTKWave layout must be in the waveform that it belongs to.
#include <Vbroad_phase.h>
#include <gtkwave/fstapi.h>

#include <catch2/catch.hpp>
#include <cchip/internal/driver/primtest_engine.hpp>
#include <cchip/internal/wire/axis.hpp>
#include <cchip/internal/wire/code_names.hpp>
#include <cchip/machines/rtl_engine.hpp>
#include <cchip/machines/simulated_chip.hpp>
#include <cchip/machines/simulated_subsystem.hpp>
#include <cchip/sim/simulation.hpp>
#include <cchip/sim/wave_on_failure.hpp>
#include <cchip/waves/wave_layout.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

using namespace cchip;

namespace {

/// f(handle, full name) of every signal, a name like "TOP.module.name[7:0]".
template <class F>
void for_each_signal(void* reader, F f) {
  std::vector<std::string> scopes{""};
  while (const fstHier* entry = fstReaderIterateHier(reader)) {
    if (entry->htyp == FST_HT_SCOPE) scopes.push_back(scopes.back() + entry->u.scope.name + ".");
    if (entry->htyp == FST_HT_UPSCOPE) scopes.pop_back();
    if (entry->htyp != FST_HT_VAR) continue;
    std::string name = entry->u.var.name;
    const auto space = name.find(' ');  // "name [7:0]"
    if (space != std::string::npos) name.erase(space, 1);
    f(entry->u.var.handle, scopes.back() + name);
  }
}

std::set<std::string> signals_of(const std::string& fst) {
  std::set<std::string> names;
  void* reader = fstReaderOpen(fst.c_str());
  REQUIRE(reader != nullptr);
  for_each_signal(reader, [&](fstHandle, const std::string& name) { names.insert(name); });
  fstReaderClose(reader);
  return names;
}

/// Signals that the layout names, all of which must be in the waveform beside it.
int check_signals(const std::string& stem) {
  const std::set<std::string> signals = signals_of(stem + ".fst");
  REQUIRE(signals.size() > 100);
  std::ifstream file(stem + ".gtkw");
  int named = 0;
  for (std::string line; std::getline(file, line);) {
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
  return named;
}

/// A row of a layout that shows names, and the names of its file by the value as GTKWave prints it.
struct NamedRow {
  std::string label;
  std::string signal;     ///< full name
  std::vector<int> bits;  ///< from the left, as GTKWave counts them; empty: all
  bool octal = false;
  std::string ending;  ///< of the file
  std::map<std::string, std::string> names;
};

std::vector<NamedRow> named_rows(const std::string& layout) {
  std::vector<NamedRow> rows;
  std::ifstream file(layout);
  REQUIRE(file);
  unsigned flags = 0;
  std::string names;
  for (std::string line; std::getline(file, line);) {
    if (line.front() == '@') flags = static_cast<unsigned>(std::stoul(line.substr(1), nullptr, 16));
    if (line.front() == '@') names.clear();
    if (line.front() == '^') names = line.substr(line.find(' ') + 1);
    if (line.front() != '+' && line.front() != '#') continue;
    CHECK(names.empty() == ((flags & 0x2000) == 0));  // GTKWave's flag of a translated trace
    if (names.empty()) continue;
    NamedRow row;
    row.label = line.substr(2, line.find('}') - 2);
    row.octal = (flags & 0x10) != 0;
    row.ending = names.substr(names.rfind('.') + 1);
    CHECK(names == layout + '.' + row.ending);  // beside the layout
    std::istringstream words(line.substr(line.find('}') + 1));
    for (std::string word; words >> word;) {
      if (word.front() == '(') row.bits.push_back(std::stoi(word.substr(1)));
      row.signal = word.substr(word.find("TOP."));
    }
    std::ifstream list(names);
    REQUIRE(list);
    for (std::string entry; std::getline(list, entry);) {
      const auto space = entry.find(' ');
      CHECK(row.names.emplace(entry.substr(0, space), entry.substr(space + 1)).second);
    }
    rows.push_back(row);
  }
  return rows;
}

/// All values that the signals take, as text of bits.
std::map<std::string, std::set<std::string>> values_of(const std::string& fst) {
  struct Reading {
    std::map<std::uint32_t, std::set<std::string>> values;
  } reading;
  std::multimap<std::uint32_t, std::string> names;  // aliases share a handle
  void* reader = fstReaderOpen(fst.c_str());
  REQUIRE(reader != nullptr);
  for_each_signal(reader, [&](fstHandle handle, const std::string& name) { names.emplace(handle, name); });
  fstReaderSetFacProcessMaskAll(reader);
  fstReaderIterBlocks(
      reader,
      [](void* user, std::uint64_t, fstHandle handle, const unsigned char* value) {
        static_cast<Reading*>(user)->values[handle].insert(reinterpret_cast<const char*>(value));
      },
      &reading, nullptr);
  fstReaderClose(reader);
  std::map<std::string, std::set<std::string>> values;
  for (const auto& [handle, name] : names) values[name] = reading.values[handle];
  return values;
}

/// What the library calls the code of a row; empty: nothing.
std::string name_of_code(const std::string& ending, unsigned value) {
  const auto text = [](const char* name) { return std::string(name == nullptr ? "" : name); };
  if (ending == "axis") return to_symbol(axis_code_from_bits(static_cast<std::uint16_t>(value)));
  if (ending == "mode") return text(name_of(static_cast<PairMode>(value)));
  if (ending == "programme") return text(name_of(static_cast<Programme>(value)));
  if (ending == "module" || ending == "kind") return text(name_of(static_cast<ModuleId>(value)));
  if (ending == "phase") return text(name_of(static_cast<SwapPhase>(value)));
  if (ending == "swap") return text(name_of(static_cast<SwapCode>(value)));
  if (ending == "end") return text(name_of(static_cast<QueryCode>(value)));
  if (ending == "answer") return text(name_of(static_cast<QueryAnswer>(value)));
  FAIL("no such file of names: " + ending);
  return {};
}

/// As GTKWave prints it: octal with leading zeros, decimal without.
std::string printed(unsigned value, std::size_t width, bool octal) {
  std::ostringstream text;
  if (octal) {
    text << std::oct << std::setfill('0') << std::setw(static_cast<int>((width + 2) / 3));
  }
  text << value;
  return text.str();
}

}  // namespace

TEST_CASE("harness: every code in a waveform has its name", "[unit][harness]") {
  const ModuleId id = GENERATE(ModuleId::tri_tri, ModuleId::quad_quad);
  const PairMode mode = GENERATE(PairMode::exhaustive, PairMode::directed);
  RtlEngineOptions options;
  options.trace_path = sim::wave_folder() + "/harness_names.fst";
  options.trace_clocks = 0;
  std::vector<GridPair> pairs(3);
  for (std::size_t i = 0; i < pairs.size(); ++i) {  // coplanar, apart, degenerate
    const auto z = static_cast<std::int32_t>(i);
    pairs[i].a.kind = kinds_of(id)[0];
    pairs[i].b.kind = kinds_of(id)[1];
    pairs[i].a.v = {Vec3i(0, 0, 0), Vec3i(4, 0, 0), Vec3i(4, 4, 0), Vec3i(0, 4, 0)};
    pairs[i].b.v = {Vec3i(1, 1, z), Vec3i(5, 1, z), Vec3i(5, 5, 2 * z), Vec3i(1, 5, 2 * z)};
  }
  pairs[2].b.v = {Vec3i(9, 0, 0), Vec3i(9, 0, 0), Vec3i(9, 0, 0), Vec3i(9, 0, 0)};
  make_rtl_engine(options)->run(pairs, mode);
  auto values = values_of(options.trace_path);
  const auto rows = named_rows(gtkw_files(options.trace_path, id).front());
  CHECK(rows.size() == 8);
  for (const NamedRow& row : rows) {
    const auto& occurring = values[row.signal];
    CAPTURE(row.label, row.signal);
    CHECK_FALSE(occurring.empty());
    for (const std::string& word : occurring) {
      std::string code = row.bits.empty() ? word : "";
      for (const int bit : row.bits) code += word.at(static_cast<std::size_t>(bit));
      const auto value = static_cast<unsigned>(std::stoul(code, nullptr, 2));
      const std::string name = name_of_code(row.ending, value);
      if (name.empty()) continue;  // random bits before the first valid
      const auto found = row.names.find(printed(value, code.size(), row.octal));
      CAPTURE(code);
      CHECK((found != row.names.end() && found->second == name));
    }
  }
}

TEST_CASE("harness: files of names hold every code", "[unit][harness]") {
  const std::string fst = sim::wave_folder() + "/harness_codes.fst";
  const std::string layout = sim::wave_folder() + "/harness_codes.gtkw";
  const int which = GENERATE(0, 1, 2, 3);
  std::set<std::string> expected;
  if (which == 0) {
    write_gtkw(fst, ModuleId::tri_quad);
    expected = {"axis", "mode", "programme"};
  } else if (which == 1) {
    write_swap_gtkw(fst, 1000, 2000);
    expected = {"kind", "module", "phase", "swap"};
  } else if (which == 2) {
    write_broad_phase_gtkw(fst, 1000, 2000);
    expected = {"answer", "end"};
  } else {
    write_chip_gtkw(fst, 1000, 2000, 2);
    expected = {"module", "phase", "swap"};
  }
  std::set<std::string> endings;
  for (const NamedRow& row : named_rows(layout)) {
    CAPTURE(row.label);
    endings.insert(row.ending);
    std::size_t named = 0;
    for (unsigned value = 0; value < 512; ++value) {
      if (row.ending != "axis" && value > 255) break;  // a code of eight bits at most
      if (row.ending == "kind" && value >> defs::kind_w != 0) break;
      const std::string name = name_of_code(row.ending, value);
      if (name.empty()) continue;
      ++named;
      const auto found = row.names.find(printed(value, 9, row.octal));
      CAPTURE(value);
      CHECK((found != row.names.end() && found->second == name));
    }
    CHECK(named == row.names.size());
  }
  CHECK(endings == expected);
}

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
  CHECK(check_signals(sim::wave_folder() + "/harness_layout_" + to_name(id)) > 100);

  std::ifstream file(sim::wave_folder() + "/harness_layout_" + to_name(id) + ".gtkw");
  std::set<std::string> groups;
  bool dumpfile = false;
  bool savefile = false;
  for (std::string line; std::getline(file, line);) {
    dumpfile = dumpfile || line == "[dumpfile] \"" + options.trace_path + "\"";
    savefile = savefile || line == "[savefile] \"" + sim::wave_folder() + "/harness_layout_" + to_name(id) + ".gtkw\"";
    if (line.front() == '-') groups.insert(line.substr(1));
  }
  CHECK(dumpfile);
  CHECK(savefile);
  for (const char* group : {"stream s_pair", "axis controller", "macro stage 1 select", "macro stage 2 axis",
                            "macro stage 3 project", "macro stage 4 compare", "stream m_result"}) {
    CHECK(groups.count(group) == 1);
  }
}

TEST_CASE("harness: the layouts of chip, subsystem and broad phase name signals that exist", "[unit][harness]") {
  const std::string which = GENERATE("chip", "chip_1", "chip_2", "subsystem", "broad_phase");
  CAPTURE(which);
  const std::string stem = sim::wave_folder() + "/harness_layout_" + which;
  const std::string fst = stem + ".fst";
  if (which == "subsystem") {
    SimulatedSubsystemOptions options;
    options.trace_path = fst;
    options.trace_clocks = 10;
    SimulatedSubsystem(options).write_layout();
  } else if (which == "broad_phase") {
    sim::SimulationOptions options;
    options.trace_path = fst;
    sim::Simulation<Vbroad_phase> simulation(options);
    simulation.step();
    write_broad_phase_gtkw(fst, 0, 10);
  } else {
    SimulatedChipOptions options;
    options.trace_path = fst;
    options.trace_clocks = 10;
    if (which != "chip") options.slots = static_cast<unsigned>(which.back() - '0');
    make_simulated_chip(options);
  }
  CHECK(check_signals(stem) > 20);
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
