// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cchip/driver/reconfig_driver.hpp>
#include <cchip/internal/wire/registers.hpp>
#include <stdexcept>
#include <string>

namespace cchip {
namespace {

namespace regs = registers;

constexpr std::size_t tags = std::size_t{1} << defs::tag_w;
constexpr std::size_t no_pair = ~std::size_t{0};
constexpr std::uint32_t swap_events = regs::interrupt_status::done_mask | regs::interrupt_status::error_mask;
/// The driver continues for this long after the last answer, to catch a surplus answer.
constexpr int epilogue = 1000;

class Run {
 public:
  Run(PairMachine& machine, const std::vector<PairRequest>& pairs, const ReconfigOptions& options)
      : machine_(machine), pairs_(pairs), options_(options), in_flight_(tags, no_pair), last_with_(tags, no_pair) {
    result_.answers.resize(pairs.size());
  }

  ReconfigResult run() {
    read_capabilities();
    load_bitstreams();
    sort();
    enable();
    while (answered_ < pairs_.size()) {
      load_ahead();
      send();
      proceed();
      if (++idle_ > options_.patience) {
        throw std::runtime_error("no pair accepted or answered for " + std::to_string(options_.patience) +
                                 " steps of the machine, " + std::to_string(answered_) + " of " +
                                 std::to_string(pairs_.size()) + " pairs answered");
      }
    }
    for (int i = 0; i < epilogue; ++i) proceed();
    return std::move(result_);
  }

 private:
  void read_capabilities() {
    const std::uint32_t value = machine_.read_register(regs::capabilities::offset);
    const unsigned width = (value & regs::capabilities::coord_w_mask) >> regs::capabilities::coord_w_shift;
    slots_ = (value & regs::capabilities::slots_mask) >> regs::capabilities::slots_shift;
    port_w_ = static_cast<int>((value & regs::capabilities::cfg_w_mask) >> regs::capabilities::cfg_w_shift);
    const std::int32_t limit = std::int32_t{1} << (width - 1);
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      for (const GridPrimitive* p : {&pairs_[i].pair.a, &pairs_[i].pair.b}) {
        for (std::size_t v = 0; v < p->vertex_count(); ++v) {
          if (p->v[v].minCoeff() >= -limit && p->v[v].maxCoeff() < limit) continue;
          throw std::invalid_argument("pair " + std::to_string(i) + ": coordinate beyond " + std::to_string(width) +
                                      " signed bits; quantise it first");
        }
      }
    }
  }

  struct Loaded {
    unsigned index;  ///< in the table of bitstreams
    Bytes bytes;
  };

  Bytes bitstream_of(std::uint8_t slot, ModuleId id) const {
    if (options_.bitstream) return options_.bitstream(slot, id);
    return make_bitstream(slot, id, make_payload(slot, id, options_.payload_bytes, options_.seed));
  }

  /// All bitstreams, each as the machine will take it.
  std::vector<Loaded> checked_bitstreams() const {
    std::vector<Loaded> all;
    for (unsigned slot = 0; slot < slots_; ++slot) {
      for (unsigned m = 1; m < 4; ++m) {
        const auto id = static_cast<ModuleId>(m);
        const auto place = static_cast<std::uint8_t>(slot);
        all.push_back({unsigned{defs::table_modules} * slot + m, bitstream_of(place, id)});
        try {
          check_bitstream(all.back().bytes, place, id, port_w_);
        } catch (const BitstreamError& error) {
          throw BitstreamError(error.code(),
                               "slot " + std::to_string(slot) + ", module " + to_name(id) + ": " + error.what());
        }
      }
    }
    return all;
  }

  void load_bitstreams() {
    constexpr std::uint32_t align = defs::bitstream_align;
    std::uint32_t address = align;
    for (const Loaded& loaded : checked_bitstreams()) {
      const auto bytes = static_cast<std::uint32_t>(loaded.bytes.size());
      machine_.write_memory(address, loaded.bytes);
      machine_.write_register(regs::bitstream_address::offset(loaded.index), address);
      machine_.write_register(regs::bitstream_size::offset(loaded.index), bytes);
      machine_.write_register(regs::bitstream_valid::offset(loaded.index), 1);
      address += (bytes + align - 1) / align * align;
    }
  }

  void enable() {
    machine_.write_register(regs::minimum_batch::offset, options_.minimum_batch);
    machine_.write_register(regs::maximum_age::offset, options_.maximum_age);
    machine_.write_register(regs::interrupt_status::offset, swap_events);
    machine_.write_register(regs::interrupt_enable::offset, swap_events);
    if (options_.batch == 0) machine_.write_register(regs::control::offset, regs::control::scheduler_enable_mask);
  }

  /// Order of the pairs: as they come, or in batches, the kinds in turn.
  void sort() {
    batch_of_.resize(pairs_.size());
    if (options_.batch == 0) {
      for (std::size_t i = 0; i < pairs_.size(); ++i) order_.push_back(i);
      batches_.push_back({ModuleId::blank, pairs_.size()});
      ready_ = 1;
      return;
    }
    std::array<std::vector<std::size_t>, 4> of_kind;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      of_kind[static_cast<std::size_t>(module_of(pairs_[i].pair))].push_back(i);
    }
    for (std::size_t round = 0; order_.size() < pairs_.size(); ++round) {
      for (std::size_t kind = 1; kind < 4; ++kind) {
        const auto& all = of_kind[kind];
        const std::size_t begin = std::min(round * options_.batch, all.size());
        const std::size_t end = std::min(begin + options_.batch, all.size());
        if (begin == end) continue;
        for (std::size_t i = begin; i < end; ++i) {
          order_.push_back(all[i]);
          batch_of_[all[i]] = batches_.size();
        }
        batches_.push_back({static_cast<ModuleId>(kind), end - begin});
      }
    }
  }

  /// The module of a batch goes into the slot of batch % slots, once that slot's former batch is answered, and not
  /// before the batch ahead of it is sent.
  void load_ahead() {
    if (loading_ || ready_ == batches_.size() || ready_ > batch_to_send() + 1) return;
    if (ready_ >= slots_ && batches_[ready_ - slots_].open > 0) return;
    const auto slot = static_cast<std::uint32_t>(ready_ % slots_);
    const auto module_id = static_cast<std::uint32_t>(batches_[ready_].module_id);
    machine_.write_register(regs::command::offset,
                            regs::command::go_mask | module_id << regs::command::module_id_shift | slot);
    loading_ = true;
  }
  std::size_t batch_to_send() const { return sent_ < order_.size() ? batch_of_[order_[sent_]] : batches_.size(); }

  /// A pair waits while one with its tag is inside, tags are unique in flight, and until the module of its batch is
  /// there.
  void send() {
    if (sent_ == pairs_.size() || in_flight_[tag_of(sent_)] != no_pair || ready_ <= batch_to_send()) return;
    const std::size_t index = order_[sent_];
    KindRequest request{pairs_[index], static_cast<int>(module_of(pairs_[index].pair))};
    request.request.tag = tag_of(sent_);
    if (!machine_.send(request)) return;
    in_flight_[tag_of(sent_)] = index;
    ++sent_;
    idle_ = 0;
  }

  void proceed() {
    machine_.proceed();
    while (const auto beat = machine_.receive()) take(*beat);
    if (machine_.interrupt()) take_swap();
  }

  void take(const KindResult& beat) {
    const std::size_t index = in_flight_[beat.beat.tag];
    if (index != no_pair) {
      result_.answers[index] = {beat, 1};
      in_flight_[beat.beat.tag] = no_pair;
      last_with_[beat.beat.tag] = index;
      --batches_[batch_of_[index]].open;
      ++answered_;
      idle_ = 0;
      if (options_.progress) options_.progress(answered_);
    } else if (last_with_[beat.beat.tag] != no_pair) {
      ++result_.answers[last_with_[beat.beat.tag]].answers;
    } else {
      ++result_.foreign_answers;
    }
  }

  void take_swap() {
    machine_.write_register(regs::interrupt_status::offset, swap_events);
    const std::uint32_t report = machine_.read_register(regs::report::offset);
    ReconfigSwap swap;
    swap.slot = static_cast<int>((report & regs::report::slot_mask) >> regs::report::slot_shift);
    swap.module_id = static_cast<ModuleId>((report & regs::report::module_id_mask) >> regs::report::module_id_shift);
    swap.code = static_cast<SwapCode>((report & regs::report::code_mask) >> regs::report::code_shift);
    for (std::uint32_t p = 0; p < swap.phases.size(); ++p) {
      swap.phases[p] = machine_.read_register(regs::phase_clocks::offset(p));
    }
    result_.swaps.push_back(swap);
    if (!loading_) return;
    loading_ = false;
    ++ready_;
    idle_ = 0;
    if (swap.code == SwapCode::ok || swap.code == SwapCode::same) return;
    throw std::runtime_error(std::string("module ") + to_name(swap.module_id) + " cannot be loaded into slot " +
                             std::to_string(swap.slot) + ": swap code " + std::to_string(static_cast<int>(swap.code)) +
                             "; see SwapCode in docs/hardware/definitions.md");
  }

  struct Batch {
    ModuleId module_id;
    std::size_t open;  ///< pairs without an answer
  };

  PairMachine& machine_;
  const std::vector<PairRequest>& pairs_;
  const ReconfigOptions& options_;
  ReconfigResult result_;
  std::vector<std::size_t> in_flight_;  // by tag: index of the pair inside
  std::vector<std::size_t> last_with_;  // by tag: index of the pair that was answered last
  std::vector<std::size_t> order_;      // of the pairs, as they are sent
  std::vector<std::size_t> batch_of_;   // by pair
  std::vector<Batch> batches_;
  std::size_t ready_ = 0;  // batches whose module was loaded
  bool loading_ = false;
  unsigned slots_ = 0;
  int port_w_ = 8;  // of the configuration port, bit
  std::size_t sent_ = 0;
  std::size_t answered_ = 0;
  std::uint64_t idle_ = 0;
};

}  // namespace

ReconfigResult run_reconfig(PairMachine& machine, const std::vector<PairRequest>& pairs,
                            const ReconfigOptions& options) {
  return Run(machine, pairs, options).run();
}

}  // namespace cchip
