// SPDX-License-Identifier: Apache-2.0
/// \file
/// Level 4 without its software: subsystem, memory, clock, interrupt and FIFOs, bound to one another.
#ifndef CCHIP_LEVELS_PLATFORM_HPP
#define CCHIP_LEVELS_PLATFORM_HPP

#include <cchip/levels/bitstream_memory.hpp>
#include <cchip/levels/subsystem.hpp>
#include <cstdint>
#include <systemc>

namespace cchip::levels {

/// Left unbound: the initiator of subsystem.registers, the writer of requests and the reader of results.
struct Platform {
  /// \param seed,period see Subsystem
  /// \param latency of the memory, for each burst
  Platform(std::uint64_t seed, const sc_core::sc_time& period, const sc_core::sc_time& latency)
      : clk("clk", period), subsystem("subsystem", seed, period), memory("memory", latency) {
    subsystem.clk(clk);
    subsystem.irq(irq);
    subsystem.requests(requests);
    subsystem.results(results);
    subsystem.memory.bind(memory.socket);
  }

  sc_core::sc_clock clk;
  sc_core::sc_signal<bool> irq{"irq"};
  sc_core::sc_fifo<RtlRequest> requests{"requests_fifo"};
  sc_core::sc_fifo<RtlResult> results{"results_fifo"};
  Subsystem subsystem;
  BitstreamMemory memory;
};

}  // namespace cchip::levels

#endif
