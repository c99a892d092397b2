// SPDX-License-Identifier: Apache-2.0
/// \file
/// The refinement levels as functions from stimulus to answers. One process can run one of them only once, because
/// SystemC elaborates once: see in_child().
#ifndef CCHIP_LEVELS_LEVEL_HPP
#define CCHIP_LEVELS_LEVEL_HPP

#include <cchip/levels/stimulus.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace cchip::levels {

struct LevelOptions {
  /// Payload of each bitstream, bytes; 0: those of Table 1 of the paper (default_payload_bytes()).
  std::size_t payload_bytes = 2048;
  /// Seed of what RTL leaves undefined at power-up and of the bitstreams.
  std::uint64_t seed = 1;
  /// L3: false leaves out the process of listing 3.3, to see what happens.
  bool reset_on_configuration = true;
};

struct LevelResult {
  std::vector<std::uint8_t> answers;  ///< in the order of the stimulus: 1 the closed primitives share a point
  std::uint64_t swaps = 0;            ///< configurations of another module
  double simulated_seconds = 0;
  double wall_seconds = 0;  ///< of the simulation, without elaboration
  std::uint64_t deltas = 0;
};

/// L0: the functional modules side by side, with FIFOs, without time (paper, figure 3).
/// All: \throws std::runtime_error not every primitive pair is answered; says why
LevelResult run_l0(const Stimulus& stimulus, const LevelOptions& options);
/// L1: the same modules made reconfigurable, behind one set of portals, C3 in the API (figures 4 and 5).
LevelResult run_l1(const Stimulus& stimulus, const LevelOptions& options);
/// L2: L1 with the times of equations (4) to (6) with the paper's port and bus.
LevelResult run_l2(const Stimulus& stimulus, const LevelOptions& options);
/// L3: Verilated RTL as closed components with pins in port groups, reset on configuration beside each; configuration
/// takes the time of equation (4). Clock 100 MHz.
LevelResult run_l3(const Stimulus& stimulus, const LevelOptions& options);
/// L3 whose first test is loaded from the beginning.
LevelResult run_l3_preloaded(const Stimulus& stimulus, const LevelOptions& options);
/// One test of L3 bound directly, without library; a stimulus of one kind.
LevelResult run_l3_direct(const Stimulus& stimulus, const LevelOptions& options);
/// L4: RTL of the subsystem with one slot and its configuration controller; registers and the memory of the bitstreams
/// over TLM-2.0. Clock 100 MHz, configuration port 8 bit at 50 MHz.
LevelResult run_l4(const Stimulus& stimulus, const LevelOptions& options);

/// Runs `job` in a child process and returns its result.
/// \throws std::runtime_error with the message of what `job` threw, or that the child ended by a signal
LevelResult in_child(const std::function<LevelResult()>& job);

}  // namespace cchip::levels

#endif
