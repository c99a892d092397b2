// SPDX-License-Identifier: Apache-2.0
/// \file
/// A waveform of every failure without the cost of writing one for every run.
#ifndef CCHIP_SIM_WAVE_ON_FAILURE_HPP
#define CCHIP_SIM_WAVE_ON_FAILURE_HPP

#include <cchip/sim/errors.hpp>
#include <cchip/sim/simulation.hpp>
#include <cstdint>
#include <exception>
#include <iostream>
#include <memory>
#include <string>

namespace cchip::sim {

/// Folder of the waveforms: environment variable CCHIP_WAVES, or waves/ in the build folder.
inline std::string wave_folder() {
  const char* folder = std::getenv("CCHIP_WAVES");
  return folder != nullptr && *folder != '\0' ? folder : CCHIP_WAVE_FOLDER;
}

/// Runs body(options) without a waveform. If it throws, runs it once more with the same options and writes the waveform
/// <wave_folder>/<name>.fst of the clocks before the failure, if the model was built with waveforms
/// (CchipVerilate.cmake). Then throws: a SimulationError as a SimulationError, with the file's name in the message;
/// anything else (a REQUIRE of Catch2) unchanged, with the name printed on standard error. CHECK does not throw: inside
/// the body use REQUIRE, cchip::sim::require() or the agents' own errors. The body must behave the same when called
/// twice, and must build its Simulation from the options it gets. If it builds several, one after the other, the wave
/// shows the last, which is the one that failed.
template <class Body>
void with_wave_on_failure(const std::string& name, Body&& body, SimulationOptions options = {}) {
  options.clocks_run = std::make_shared<std::uint64_t>(0);
  try {
    body(static_cast<const SimulationOptions&>(options));
    return;
  } catch (...) {
    options.trace_path = wave_folder() + "/" + name + ".fst";
    options.trace_optional = true;
    const std::uint64_t clocks = *options.clocks_run;
    if (options.trace_clocks != 0 && clocks >= options.trace_clocks) {
      options.trace_from = clocks + 1 - options.trace_clocks;
    }
    const std::exception_ptr first = std::current_exception();
    try {
      body(static_cast<const SimulationOptions&>(options));
    } catch (const SimulationError&) {
      throw;  // names the wave
    } catch (...) {
      std::cerr << "seed " << options.seed << ", wave " << options.trace_path << std::endl;
      std::rethrow_exception(first);
    }
    std::cerr << name << ": the failure does not repeat with the same seed " << options.seed << std::endl;
    std::rethrow_exception(first);
  }
}

}  // namespace cchip::sim

#endif
