// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes of triangles and of quads through two slots whose modules are exchanged at run time, every answer checked.
#ifndef CCHIP_COMMANDS_RECONFIG_HPP
#define CCHIP_COMMANDS_RECONFIG_HPP

#include <cchip/internal/wire/definitions.hpp>
#include <cstdint>
#include <ostream>
#include <string>

namespace cchip::app {

struct ReconfigJobOptions {
  std::uint64_t bitstream_bits = 16384;  ///< payload of each bitstream, at least 8 * defs::bitstream_payload_min
  std::uint64_t pairs = 1500;            ///< of each kind, at most
  PairMode mode = PairMode::exhaustive;
  std::uint64_t seed = 1;
  std::string wave_folder = "build/waves";
};

/// Runs and reports to `out`; returns the exit code.
/// \throws UsageError the waveform cannot be written, a bitstream is too short
int run_reconfig_job(const ReconfigJobOptions& options, std::ostream& out);

}  // namespace cchip::app

#endif
