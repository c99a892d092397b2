// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of a simulation beside the model: drivers, monitors, sinks.
#ifndef CCHIP_SIM_AGENT_HPP
#define CCHIP_SIM_AGENT_HPP

#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

namespace cchip::sim {

namespace detail {

/// Whether an AXI4 master says size and burst; a block inside of a chip leaves these constants to its top.
template <class Model, class = void>
struct HasSize : std::false_type {};
template <class Model>
struct HasSize<Model, std::void_t<decltype(std::declval<Model&>().m_axi_arsize)>> : std::true_type {};

}  // namespace detail

struct ClockInfo {
  std::uint64_t clock = 0;  ///< number of the clock, counted from 0 after the last reset
  bool in_reset = false;    ///< rst is 1 on this clock: nothing is handed over
};

/// Called once per clock by Simulation::step(), see the timing diagram there.
class Agent {
 public:
  virtual ~Agent() = default;
  /// Sets inputs of the model; sees its outputs as they are after the last rising edge.
  virtual void drive(const ClockInfo&) {}
  /// Looks at all signals, settled, just before the rising edge; sets none.
  virtual void sample(const ClockInfo&) {}
  /// What this agent is still waiting for, for the message of a timeout; empty if nothing.
  virtual std::string waits_for() const { return {}; }
};

}  // namespace cchip::sim

#endif
