// SPDX-License-Identifier: Apache-2.0
#include <Vcchip_primtest_subsystem.h>
#include <Vcchip_primtest_subsystem___024root.h>

#include <cchip/rtl/pair_port.hpp>
#include <cchip/rtl/reconfig_run.hpp>
#include <cchip/sim/axi_lite.hpp>
#include <cchip/sim/axi_memory.hpp>
#include <cchip/sim/simulation.hpp>
#include <cchip/waves/wave_layout.hpp>
#include <cchip/wire/bitstream.hpp>
#include <cchip/wire/registers.hpp>
#include <stdexcept>

namespace cchip {
namespace {

using Model = Vcchip_primtest_subsystem;
namespace regs = registers;

constexpr int width = defs::coord_w_default;
constexpr int slots = 2;
constexpr int port_w = 8;
constexpr int clocks_per_word = 2;
constexpr std::uint64_t time_units_per_clock = 10;
constexpr std::size_t tags = std::size_t{1} << defs::tag_w;
constexpr std::size_t nobody = ~std::size_t{0};

/// What is looked at inside.
struct Inside {
  SwapPhase phase;
  unsigned slot;
  std::array<unsigned, 2> pairs;
};
Inside look(const Model& top) {
  const auto* root = top.rootp;
  return {static_cast<SwapPhase>(root->cchip_primtest_subsystem__DOT__u_controller__DOT__u_sequencer__DOT__phase_q),
          root->cchip_primtest_subsystem__DOT__u_scheduler__DOT__slot_of_swap_q,
          {root->cchip_primtest_subsystem__DOT__gen_slots__BRA__0__KET____DOT__u_slot__DOT__outstanding_q,
           root->cchip_primtest_subsystem__DOT__gen_slots__BRA__1__KET____DOT__u_slot__DOT__outstanding_q}};
}

/// The subsystem with its memory and its software.
class System : public sim::Agent {
 public:
  System(const std::vector<ReconfigPair>& pairs, const ReconfigOptions& options)
      : pairs_(pairs), options_(options), simulation_(simulation_options(options)), port_(simulation_.top(), width) {
    result_.answers.resize(pairs.size());
    result_.equation_4 = cchip::transfer_clocks(options.payload_bytes, port_w, clocks_per_word);
    in_flight_.assign(tags, nobody);
    simulation_->cfg_error = 0;
    for (sim::Agent* agent : std::initializer_list<sim::Agent*>{&memory_, &master_, this}) simulation_.add(*agent);
  }

  ReconfigResult run() {
    simulation_.reset();
    set_up();
    running_ = true;
    const std::uint64_t patience = 20 * (result_.equation_4 + 20000);
    while (answered_ < pairs_.size()) {
      simulation_.step();
      if (simulation_.clock() - progress_ > patience) {
        throw sim::SimulationTimeout("no answer for " + std::to_string(patience) + " clocks");
      }
    }
    simulation_.steps(1000);  // an answer too many would come now
    result_.clocks = simulation_.clock();
    write_layout();
    return std::move(result_);
  }

  void drive(const sim::ClockInfo&) override {
    simulation_->m_result_ready = 1;
    const bool offers = running_ && sent_ < pairs_.size() && in_flight_[tag(sent_)] == nobody;
    simulation_->s_pair_valid = offers ? 1 : 0;
    if (!offers || offered_ == sent_ + 1) return;
    const ReconfigPair& p = pairs_[sent_];
    port_.put({p.pair, tag(sent_), static_cast<std::uint8_t>(p.mode)});
    simulation_->s_pair_kind = static_cast<CData>(module_of(p.pair));
    offered_ = sent_ + 1;
  }

  void sample(const sim::ClockInfo& now) override {
    if (now.in_reset) return;
    if (simulation_->m_result_valid != 0) take();
    if (simulation_->s_pair_valid != 0 && simulation_->s_pair_ready != 0) {
      in_flight_[tag(sent_)] = sent_;
      ++sent_;
      progress_ = now.clock;
    }
    count_phases(now.clock);
  }

 private:
  static sim::SimulationOptions simulation_options(const ReconfigOptions& options) {
    sim::SimulationOptions o;
    o.seed = options.seed;
    o.timeout_clocks = 0;
    o.trace_path = options.trace_path;
    o.trace_clocks = options.trace_clocks;
    return o;
  }
  static std::uint16_t tag(std::size_t index) { return static_cast<std::uint16_t>(40503U * index); }

  void write(std::uint32_t offset, std::uint32_t value) {
    if (!master_.write(simulation_, offset, value)) throw sim::SimulationError("a register refuses a write");
  }
  /// Bitstreams into memory, their table into the registers.
  void set_up() {
    const auto bytes = static_cast<std::uint32_t>(options_.payload_bytes + defs::bitstream_header);
    constexpr std::uint32_t align = defs::bitstream_align;
    std::uint32_t address = align;
    for (unsigned slot = 0; slot < slots; ++slot) {
      for (unsigned m = 1; m < 4; ++m) {
        const auto id = static_cast<ModuleId>(m);
        const Bytes payload = make_payload(static_cast<std::uint8_t>(slot), id, options_.payload_bytes,
                                           static_cast<std::uint32_t>(options_.seed));
        memory_.write(address, make_bitstream(static_cast<std::uint8_t>(slot), id, payload));
        write(regs::bitstream_address::offset(4 * slot + m), address);
        write(regs::bitstream_size::offset(4 * slot + m), bytes);
        write(regs::bitstream_valid::offset(4 * slot + m), 1);
        address += (bytes + align - 1) / align * align;
      }
    }
    const auto half_a_transfer = static_cast<std::uint32_t>(result_.equation_4 / 2);
    write(regs::minimum_batch::offset, options_.minimum_batch);
    write(regs::maximum_age::offset, options_.maximum_age == 0 ? half_a_transfer : options_.maximum_age);
    write(regs::control::offset, regs::control::scheduler_enable_mask);
  }

  void take() {
    const PairResult beat = port_.result();
    const std::size_t index = in_flight_[beat.tag];
    progress_ = simulation_.clock();
    if (index == nobody) {
      // the last pair with this tag was answered before, or there was none
      const std::size_t before = last_with_[beat.tag];
      if (before == 0) {
        ++result_.foreign_answers;
      } else {
        ++result_.answers[before - 1].answers;
      }
      return;
    }
    ReconfigAnswer& answer = result_.answers[index];
    answer = {beat.hit,
              beat.grid,
              beat.definite,
              beat.axis.cls != AxisClass::illegal,
              1,
              static_cast<ModuleId>(simulation_->m_result_kind)};
    in_flight_[beat.tag] = nobody;
    last_with_[beat.tag] = index + 1;
    ++answered_;
  }

  void count_phases(std::uint64_t clock) {
    const Inside now = look(simulation_.top());
    if (now.phase != SwapPhase::idle) {
      if (phase_ == SwapPhase::idle) result_.swaps.push_back({static_cast<int>(now.slot), {}, {}, clock, {}});
      ReconfigSwap& swap = result_.swaps.back();
      ++swap.phases[static_cast<std::size_t>(now.phase) - 1];
      const auto* root = simulation_.top().rootp;
      swap.module_id = static_cast<ModuleId>(root->cchip_primtest_subsystem__DOT__swap_module);
      if (now.phase == SwapPhase::transfer) {
        ++result_.transfer_clocks;
        result_.hidden_clocks += now.pairs[1 - now.slot] != 0 ? 1 : 0;
      }
    }
    if (simulation_.top().rootp->cchip_primtest_subsystem__DOT__report_valid != 0) {
      result_.swaps.back().code =
          static_cast<SwapCode>(simulation_.top().rootp->cchip_primtest_subsystem__DOT__report_code);
    }
    phase_ = now.phase;
  }

  void write_layout() const {
    if (options_.trace_path.empty()) return;
    std::uint64_t from = 0;
    std::uint64_t to = options_.trace_clocks;
    if (!result_.swaps.empty()) {
      const ReconfigSwap& first = result_.swaps.front();
      constexpr std::uint64_t reset_clocks = 2;
      from = reset_clocks + first.start;
      to = from;
      for (const std::uint64_t clocks : first.phases) to += clocks;
      to = std::min(to, options_.trace_clocks);
    }
    write_swap_gtkw(options_.trace_path, from * time_units_per_clock, to * time_units_per_clock);
  }

  const std::vector<ReconfigPair>& pairs_;
  ReconfigOptions options_;
  sim::Simulation<Model> simulation_;
  sim::PairPort<Model> port_;
  sim::AxiMemory<Model> memory_{simulation_.top()};
  sim::AxiLiteMaster<Model> master_{simulation_.top()};
  ReconfigResult result_;
  std::vector<std::size_t> in_flight_;
  std::vector<std::size_t> last_with_ = std::vector<std::size_t>(tags, 0);
  std::size_t sent_ = 0;
  std::size_t offered_ = 0;
  std::size_t answered_ = 0;
  std::uint64_t progress_ = 0;
  bool running_ = false;
  SwapPhase phase_ = SwapPhase::idle;
};

void check_pairs(const std::vector<ReconfigPair>& pairs) {
  constexpr std::int32_t limit = std::int32_t{1} << (width - 1);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (const GridPrimitive* p : {&pairs[i].pair.a, &pairs[i].pair.b}) {
      for (std::size_t v = 0; v < p->vertex_count(); ++v) {
        if (p->v[v].minCoeff() >= -limit && p->v[v].maxCoeff() < limit) continue;
        throw std::invalid_argument("pair " + std::to_string(i) + ": coordinate beyond " + std::to_string(width) +
                                    " signed bits; quantise it first");
      }
    }
  }
}

}  // namespace

ModuleId module_of(const GridPair& pair) {
  if (pair.a.kind == Kind::quad && pair.b.kind == Kind::quad) return ModuleId::quad_quad;
  return pair.a.kind == pair.b.kind ? ModuleId::tri_tri : ModuleId::tri_quad;
}

ReconfigResult run_reconfig(const std::vector<ReconfigPair>& pairs, const ReconfigOptions& options) {
  check_pairs(pairs);
  try {
    return System(pairs, options).run();
  } catch (const sim::SimulationError& error) {
    throw std::runtime_error(std::string("reconfiguration: ") + error.what() + "; this is a defect, please report it");
  }
}

}  // namespace cchip
