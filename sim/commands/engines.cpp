// SPDX-License-Identifier: Apache-2.0
#include "engines.hpp"

#include <fmt/format.h>

#include <cchip/internal/driver/model_engine.hpp>
#include <cchip/internal/reference/eigen_sat.hpp>
#include <cchip/machines/rtl_engine.hpp>
#include <cchip/program/usage_error.hpp>
#include <cchip/waves/wave_layout.hpp>
#include <filesystem>

namespace cchip::app {
namespace {

/// A waveform of the RTL and the files of its layout.
std::vector<std::string> files_of_wave(const std::string& fst_path) {
  std::vector<std::string> files = gtkw_files(fst_path, ModuleId::tri_tri);  // all modules have the same
  files.insert(files.begin(), fst_path);
  return files;
}

std::unique_ptr<PairEngine> make_rtl(const EngineOptions& options) {
  RtlEngineOptions rtl;
  rtl.seed = options.seed;
  rtl.trace_path = options.trace_path;
  rtl.trace_clocks = options.trace_clocks;
  return make_rtl_engine(rtl);
}

void check(const EngineOptions& options) {
  if (options.trace_path.empty()) return;
  if (options.kind != EngineKind::rtl) {
    throw UsageError(fmt::format("--trace: engine {} has no waveform; use --engine rtl", to_name(options.kind)));
  }
  check_wave_name(options.trace_path);
  for (const std::string& file : files_of_wave(options.trace_path)) sim::check_writable(file);
}

}  // namespace

const char* to_name(EngineKind kind) {
  switch (kind) {
    case EngineKind::rtl:
      return "rtl";
    case EngineKind::model:
      return "model";
    case EngineKind::eigen:
      return "eigen";
    case EngineKind::exact:
      return "exact";
  }
  return "?";
}

bool is_hardware(EngineKind kind) { return kind == EngineKind::rtl || kind == EngineKind::model; }

void check_wave_name(const std::string& path) {
  if (std::filesystem::path(path).extension() == ".fst") return;
  throw UsageError(fmt::format("--trace {}: the waveform is an FST; give a name that ends with .fst", path));
}

std::vector<sim::NamedPath> trace_files(const EngineOptions& options) {
  if (options.trace_path.empty()) return {};
  const std::filesystem::path path(options.trace_path);
  std::vector<sim::NamedPath> files;
  for (const char* const module : {"", "_tri_tri", "_tri_quad", "_quad_quad"}) {
    std::filesystem::path file = path;
    file.replace_filename(path.stem().string() + module + path.extension().string());
    for (const std::string& name : files_of_wave(file.string())) files.push_back({"--trace", name});
  }
  return files;
}

std::unique_ptr<PairEngine> make_engine(const EngineOptions& options) {
  check(options);
  switch (options.kind) {
    case EngineKind::rtl:
      return make_rtl(options);
    case EngineKind::model:
      return make_model_engine(defs::coord_w_default);
    case EngineKind::eigen:
      return make_function_engine("eigen", defs::coord_w_default,
                                  [](const GridPair& pair) { return eigen_intersects(pair, defs::coord_w_default); });
    case EngineKind::exact:
      return make_exact_engine(defs::coord_w_default);
  }
  return nullptr;
}

}  // namespace cchip::app
