// SPDX-License-Identifier: Apache-2.0
/// \file
/// A Verilated cchip_chip with its memory as a machine.
#ifndef CCHIP_MACHINES_CHIP_MACHINE_HPP
#define CCHIP_MACHINES_CHIP_MACHINE_HPP

#include <algorithm>
#include <cchip/driver/machine.hpp>
#include <cchip/sim/axi_lines.hpp>
#include <cchip/sim/axi_lite.hpp>
#include <cchip/sim/axi_memory.hpp>
#include <cchip/sim/simulation.hpp>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace cchip::sim {

/// Pins of the port for bitstreams under the names that AxiMemory expects.
template <class Model>
struct BitstreamPins {
  explicit BitstreamPins(Model& m)
      : m_axi_arvalid(m.m_axi_cfg_arvalid),
        m_axi_arready(m.m_axi_cfg_arready),
        m_axi_araddr(m.m_axi_cfg_araddr),
        m_axi_arlen(m.m_axi_cfg_arlen),
        m_axi_arsize(m.m_axi_cfg_arsize),
        m_axi_arburst(m.m_axi_cfg_arburst),
        m_axi_rvalid(m.m_axi_cfg_rvalid),
        m_axi_rready(m.m_axi_cfg_rready),
        m_axi_rdata(m.m_axi_cfg_rdata),
        m_axi_rresp(m.m_axi_cfg_rresp),
        m_axi_rlast(m.m_axi_cfg_rlast) {}
  CData &m_axi_arvalid, &m_axi_arready;
  IData& m_axi_araddr;
  CData &m_axi_arlen, &m_axi_arsize, &m_axi_arburst, &m_axi_rvalid, &m_axi_rready;
  IData& m_axi_rdata;
  CData &m_axi_rresp, &m_axi_rlast;
};

/// Bytes of an AxiLines, as a Machine writes and reads them.
template <class Memory>
void write_bytes(Memory& memory, std::uint64_t address, const Bytes& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const std::size_t at = (address + done) % 64;
    const std::size_t count = std::min(bytes.size() - done, 64 - at);
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(done), count,
                memory.line((address + done) / 64).begin() + static_cast<std::ptrdiff_t>(at));
    done += count;
  }
}
template <class Memory>
Bytes read_bytes(const Memory& memory, std::uint64_t address, std::size_t size) {
  Bytes bytes(size);
  for (std::size_t done = 0; done < size;) {
    const std::size_t at = (address + done) % 64;
    const std::size_t count = std::min(size - done, 64 - at);
    if (const typename Memory::Line* line = memory.find((address + done) / 64)) {
      std::copy_n(line->begin() + static_cast<std::ptrdiff_t>(at), count,
                  bytes.begin() + static_cast<std::ptrdiff_t>(done));
    }
    done += count;
  }
  return bytes;
}
/// The word that a bitstream has there; none: nothing wrote it.
template <class Memory>
std::optional<std::uint32_t> read_word(const Memory& memory, std::uint32_t address) {
  const typename Memory::Line* line = memory.find(address / 64);
  if (line == nullptr) return std::nullopt;
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;) word = word << 8U | (*line)[address % 64 + i];
  return word;
}

/// Host and chip see the same memory at once; memory that nothing wrote reads as 0 for the host, and is a bus error for
/// the chip. A register takes some clocks, memory takes the host none.
/// \tparam DATA_W width of the model's data buses, bit
/// \tparam Bus    what is at the chip's master: an agent with a memory
template <class Model, int DATA_W, class Bus = AxiLines<Model, DATA_W>>
class ChipMachine : public Machine {
 public:
  using Memory = typename Bus::Memory;

  explicit ChipMachine(SimulationOptions options)
      : simulation_(std::move(options)),
        bus_(simulation_.top(), simulation_.seed()),
        registers_(simulation_.top()),
        bitstream_pins_(simulation_.top()),
        bitstreams_(bitstream_pins_) {
    simulation_->cfg_error = 0;
    bitstreams_.backing = [this](std::uint32_t address) { return read_word(memory(), address); };
    simulation_.add(bus_);
    simulation_.add(bitstreams_);
    simulation_.add(registers_);
    reset();
  }

  Simulation<Model>& simulation() { return simulation_; }
  Bus& bus() { return bus_; }
  Memory& memory() { return bus_.memory(); }
  /// The port for bitstreams, which reads the same memory.
  AxiMemory<BitstreamPins<Model>>& bitstreams() { return bitstreams_; }
  /// Chip and bus.
  void reset() { simulation_.reset(2); }

  std::uint32_t read_register(std::uint32_t offset) override {
    const AxiLiteWord word = registers_.read(simulation_, offset);
    if (!word.ok) throw std::runtime_error("chip: register " + std::to_string(offset) + " refuses a read");
    return word.data;
  }
  void write_register(std::uint32_t offset, std::uint32_t value) override {
    if (!registers_.write(simulation_, offset, value))
      throw std::runtime_error("chip: register " + std::to_string(offset) + " refuses a write");
  }

  void write_memory(std::uint64_t address, const Bytes& bytes) override { write_bytes(memory(), address, bytes); }
  Bytes read_memory(std::uint64_t address, std::size_t size) override { return read_bytes(memory(), address, size); }

  bool interrupt() override { return simulation_->irq != 0; }
  void proceed() override { simulation_.step(); }

 private:
  Simulation<Model> simulation_;
  Bus bus_;
  AxiLiteMaster<Model> registers_;
  BitstreamPins<Model> bitstream_pins_;
  AxiMemory<BitstreamPins<Model>> bitstreams_;
};

}  // namespace cchip::sim

#endif
