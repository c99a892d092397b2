// SPDX-License-Identifier: Apache-2.0
#include "engines.hpp"

#include <fmt/format.h>

#include <cchip/reference/eigen_sat.hpp>
#include <cchip/rtl/rtl_engine.hpp>
#include <cchip/stimulus/usage_error.hpp>
#include <fstream>

namespace cchip::app {
namespace {

void check(const EngineOptions& options) {
  if (options.trace_path.empty()) return;
  if (options.kind != EngineKind::rtl) {
    throw UsageError(fmt::format("--trace: engine {} has no waveform; use --engine rtl", to_name(options.kind)));
  }
  if (!std::ofstream(options.trace_path, std::ios::app)) {
    throw UsageError(
        fmt::format("{}: the waveform cannot be written; check folder and permissions", options.trace_path));
  }
}

std::unique_ptr<PairEngine> make_rtl(const EngineOptions& options) {
  RtlEngineOptions rtl;
  rtl.seed = options.seed;
  rtl.trace_path = options.trace_path;
  rtl.trace_clocks = options.trace_clocks;
  return make_rtl_engine(rtl);
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
