// SPDX-License-Identifier: Apache-2.0
#include <Vcchip_primtest_subsystem.h>
#include <Vcchip_primtest_subsystem___024root.h>

#include <algorithm>
#include <cchip/internal/wire/registers.hpp>
#include <cchip/machines/pair_streams.hpp>
#include <cchip/machines/probes.hpp>
#include <cchip/machines/simulated_subsystem.hpp>
#include <cchip/sim/axi_lite.hpp>
#include <cchip/sim/axi_memory.hpp>
#include <cchip/sim/simulation.hpp>
#include <cchip/waves/wave_layout.hpp>
#include <deque>
#include <stdexcept>

namespace cchip {
namespace {

using Model = Vcchip_primtest_subsystem;

constexpr std::uint64_t time_units_per_clock = 10;
constexpr std::uint64_t reset_clocks = 2;

/// Counts what the registers do not show.
class Observer : public sim::Agent {
 public:
  explicit Observer(const Model& model) : model_(model) {}

  void drive(const sim::ClockInfo&) override {}
  void sample(const sim::ClockInfo& now) override {
    if (now.in_reset) return;
    ++seen.clocks;
    const auto phase = static_cast<SwapPhase>(probes::swap_phase(model_));
    if (phase == SwapPhase::idle) {
      if (transfers_ && seen.first_swap_end == 0) {
        seen.first_swap_start = begun_;
        seen.first_swap_end = now.clock;
      }
      begun_ = 0;
      transfers_ = false;
    } else if (begun_ == 0) {
      begun_ = now.clock;
    }
    transfers_ = transfers_ || phase == SwapPhase::transfer;
    if (phase != SwapPhase::transfer) return;
    ++seen.transfer_clocks;
    const int other = probes::swap_slot(model_) == 0 ? 1 : 0;
    seen.hidden_clocks += (probes::outstanding(model_) >> (defs::pair_count_w * other) & 0xFFFFU) != 0 ? 1 : 0;
  }

  SubsystemObservations seen;

 private:
  const Model& model_;
  std::uint64_t begun_ = 0;  // the swap in progress; 0: none
  bool transfers_ = false;   // its module is or was written
};

/// Errors of the simulation are defects of the RTL.
template <class Action>
auto guarded(const Action& action) {
  try {
    return action();
  } catch (const sim::SimulationError& error) {
    throw std::runtime_error(std::string("simulated subsystem: ") + error.what() +
                             "; this is a defect, please report it");
  }
}

/// First address of an access on the bus.
std::uint32_t bus_address(std::uint64_t address, std::size_t size) {
  constexpr std::uint64_t bus_bytes = std::uint64_t{1} << 32U;
  if (address % 4 == 0 && size <= bus_bytes && address <= bus_bytes - size) return static_cast<std::uint32_t>(address);
  throw std::runtime_error("simulated subsystem: memory from byte " + std::to_string(address) + " on, " +
                           std::to_string(size) + " bytes: begin at a multiple of 4 and end within 2^32 bytes");
}

}  // namespace

struct SimulatedSubsystem::Parts {
  explicit Parts(const SimulatedSubsystemOptions& o)
      : options(o), simulation(sim::without_timeout(o.seed, o.trace_path, o.trace_clocks)) {
    simulation->cfg_error = 0;
    for (sim::Agent* agent : std::initializer_list<sim::Agent*>{&memory, &registers, &streams, &observer}) {
      simulation.add(*agent);
    }
    simulation.reset(static_cast<int>(reset_clocks));
  }

  SimulatedSubsystemOptions options;
  sim::Simulation<Model> simulation;
  sim::PairStreams<Model> streams{simulation.top(), defs::coord_w_default};
  Observer observer{simulation.top()};
  sim::AxiMemory<Model> memory{simulation.top()};
  sim::AxiLiteMaster<Model> registers{simulation.top()};
};

SimulatedSubsystem::SimulatedSubsystem(const SimulatedSubsystemOptions& options)
    : parts_(guarded([&] { return std::make_unique<Parts>(options); })) {}
SimulatedSubsystem::~SimulatedSubsystem() = default;

std::uint32_t SimulatedSubsystem::read_register(std::uint32_t offset) {
  return guarded([&] {
    const sim::AxiLiteWord word = parts_->registers.read(parts_->simulation, offset);
    if (!word.ok) throw sim::SimulationError("register " + std::to_string(offset) + " refuses a read");
    return word.data;
  });
}

void SimulatedSubsystem::write_register(std::uint32_t offset, std::uint32_t value) {
  guarded([&] {
    if (!parts_->registers.write(parts_->simulation, offset, value)) {
      throw sim::SimulationError("register " + std::to_string(offset) + " refuses a write");
    }
  });
}

void SimulatedSubsystem::write_memory(std::uint64_t address, const Bytes& bytes) {
  parts_->memory.write(bus_address(address, bytes.size()), bytes);
}

Bytes SimulatedSubsystem::read_memory(std::uint64_t address, std::size_t size) {
  return parts_->memory.read(bus_address(address, size), size);
}

bool SimulatedSubsystem::send(const KindRequest& request) { return parts_->streams.send(request); }

std::optional<KindResult> SimulatedSubsystem::receive() {
  std::deque<KindResult>& results = parts_->streams.results;
  if (results.empty()) return std::nullopt;
  const KindResult result = results.front();
  results.pop_front();
  return result;
}

bool SimulatedSubsystem::interrupt() { return parts_->simulation->irq != 0; }

void SimulatedSubsystem::proceed() {
  guarded([&] { parts_->simulation.step(); });
}

const SubsystemObservations& SimulatedSubsystem::observations() const { return parts_->observer.seen; }

void SimulatedSubsystem::write_layout() const {
  if (parts_->options.trace_path.empty()) return;
  const SubsystemObservations& seen = parts_->observer.seen;
  std::uint64_t from = 0;
  std::uint64_t to = parts_->options.trace_clocks;
  if (seen.first_swap_end != 0) {
    from = reset_clocks + seen.first_swap_start;
    to = std::min(to, reset_clocks + seen.first_swap_end);
  }
  write_swap_gtkw(parts_->options.trace_path, from * time_units_per_clock, to * time_units_per_clock);
}

}  // namespace cchip
