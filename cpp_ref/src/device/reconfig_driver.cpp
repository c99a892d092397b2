// SPDX-License-Identifier: Apache-2.0
#include <cchip/device/reconfig_driver.hpp>
#include <cchip/wire/registers.hpp>
#include <stdexcept>
#include <string>

namespace cchip {
namespace {

namespace regs = registers;

constexpr std::size_t tags = std::size_t{1} << defs::tag_w;
constexpr std::size_t nobody = ~std::size_t{0};
constexpr std::uint32_t swap_events = regs::interrupt_status::done_mask | regs::interrupt_status::error_mask;
/// The driver goes on for this long after the last answer, to catch a surplus answer.
constexpr int epilogue = 1000;

class Run {
 public:
  Run(Machine& machine, const std::vector<PairRequest>& pairs, const ReconfigOptions& options)
      : machine_(machine), pairs_(pairs), options_(options), in_flight_(tags, nobody), last_with_(tags, nobody) {
    result_.answers.resize(pairs.size());
  }

  ReconfigResult run() {
    read_capabilities();
    load_bitstreams();
    enable();
    while (answered_ < pairs_.size()) {
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
        all.push_back({4 * slot + m, bitstream_of(place, id)});
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
    machine_.write_register(regs::control::offset, regs::control::scheduler_enable_mask);
  }

  /// A pair waits if one with its tag is still inside: tags are unique in flight.
  void send() {
    if (sent_ == pairs_.size() || in_flight_[tag_of(sent_)] != nobody) return;
    KindRequest request{pairs_[sent_], static_cast<int>(module_of(pairs_[sent_].pair))};
    request.request.tag = tag_of(sent_);
    if (!machine_.send(request)) return;
    in_flight_[tag_of(sent_)] = sent_;
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
    if (index != nobody) {
      result_.answers[index] = {beat, 1};
      in_flight_[beat.beat.tag] = nobody;
      last_with_[beat.beat.tag] = index;
      ++answered_;
      idle_ = 0;
      if (options_.progress) options_.progress(answered_);
    } else if (last_with_[beat.beat.tag] != nobody) {
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
  }

  Machine& machine_;
  const std::vector<PairRequest>& pairs_;
  const ReconfigOptions& options_;
  ReconfigResult result_;
  std::vector<std::size_t> in_flight_;  // by tag: index of the pair inside
  std::vector<std::size_t> last_with_;  // by tag: index of the pair that was answered last
  unsigned slots_ = 0;
  int port_w_ = 8;  // of the configuration port, bit
  std::size_t sent_ = 0;
  std::size_t answered_ = 0;
  std::uint64_t idle_ = 0;
};

}  // namespace

ReconfigResult run_reconfig(Machine& machine, const std::vector<PairRequest>& pairs, const ReconfigOptions& options) {
  return Run(machine, pairs, options).run();
}

}  // namespace cchip
