// SPDX-License-Identifier: Apache-2.0
#include <cchip/stimulus/usage_error.hpp>

#include "hardware.hpp"

namespace cchip::app {
namespace {

[[noreturn]] void refuse(const char* what) {
  throw UsageError(std::string(what) +
                   ": this cchip is built without the simulated hardware; build it with CCHIP_SIMULATION=ON, or use "
                   "the model: --engine model, --device model");
}

}  // namespace

bool has_hardware() { return false; }
void add_chip_device() {}
std::unique_ptr<Device> open_chip(const ChipOptions&) { refuse("device sim"); }
std::unique_ptr<PairEngine> make_rtl(const EngineOptions&) { refuse("engine rtl"); }
std::vector<std::string> files_of_wave(const std::string&) { return {}; }
int run_reconfig_job(const ReconfigJobOptions&, std::ostream&) { refuse("reconfig"); }

}  // namespace cchip::app
