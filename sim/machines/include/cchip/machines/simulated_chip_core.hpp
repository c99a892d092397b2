// SPDX-License-Identifier: Apache-2.0
/// \file
/// A Verilated cchip_chip_core between a memory that holds images and both rings, and a host that submits and collects.
#ifndef CCHIP_MACHINES_SIMULATED_CHIP_CORE_HPP
#define CCHIP_MACHINES_SIMULATED_CHIP_CORE_HPP

#include <cchip/internal/image/image.hpp>
#include <cchip/machines/chip_answer.hpp>
#include <cchip/sim/axi_lines.hpp>
#include <cchip/sim/bits.hpp>
#include <cchip/sim/simulation.hpp>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace cchip::sim {

struct ChipOptions {
  unsigned query_log2 = 8;       ///< lines of the ring of queries
  unsigned record_log2 = 12;     ///< records of the other one
  std::uint64_t host_every = 1;  ///< clocks from one look of the host at its rings to the next
  std::uint32_t generation = 0;  ///< upper byte of all tags
};

/// Scoreboard of the rings: every record is looked at when it is read, and what is wrong with it is kept.
/// \tparam Config names the Verilated class `Model`, DATA_W and LOCKS
template <class Config>
class SimulatedChipCore {
 public:
  using Model = typename Config::Model;
  using Memory = AxiLines<Model, Config::DATA_W>;
  static constexpr std::uint64_t query_line = 0x1000;
  static constexpr std::uint64_t record_line = 0x80000000;
  static constexpr std::uint64_t first_image = 0x10000;

  explicit SimulatedChipCore(SimulationOptions options, ChipOptions chip = {})
      : simulation_(std::move(options)), memory_(simulation_.top(), simulation_.seed()), chip_(chip) {
    simulation_.add(memory_);
    Model& m = simulation_.top();
    m.core_rst = 0;
    m.pairs_each = 3;
    m.step_limit = 0xffffffff;
    m.open_limit = 16;
    m.memory_limit = 100000;
    m.query_base = query_line;
    m.record_base = 4 * record_line;
    for (int lock = 0; lock < Config::LOCKS; ++lock) {  // no line is locked
      set_bits(m.lock_first, 32 * lock, 32, 1);
      set_bits(m.lock_last, 32 * lock, 32, 0);
    }
    m.invalidate_valid = 0;
    m.invalidate_first = 0;
    m.invalidate_last = 0;
    reset();
  }

  Simulation<Model>& simulation() { return simulation_; }
  Model& top() { return simulation_.top(); }
  Memory& memory() { return memory_; }
  ChipOptions& chip() { return chip_; }

  /// Puts an image behind those that are there. \returns its line
  std::uint64_t place(const bvh::Image& image) {
    const std::uint64_t at = next_image_;
    memory_.write(at, image.lines);
    next_image_ += image.lines.size() + 64;
    return at;
  }

  /// \returns its number
  std::size_t submit(Query query) {
    query.tag = chip_.generation << 24 | static_cast<std::uint32_t>(answers_.size());
    return submit_line(encode(query));
  }
  /// A descriptor as it is, but for its tag.
  std::size_t submit_line(Line descriptor) {
    put(descriptor, query_field::tag, chip_.generation << 24 | static_cast<std::uint32_t>(answers_.size()));
    descriptors_.push_back(descriptor);
    answers_.emplace_back();
    ++unanswered_;
    return answers_.size() - 1;
  }
  const std::vector<ChipAnswer>& answers() const { return answers_; }
  std::size_t unanswered() const { return unanswered_; }
  /// Records of no query, done records that came twice, pair records after theirs, wrong phase bits.
  const std::vector<std::string>& wrong() const { return wrong_; }
  std::size_t duplicated() const { return duplicated_; }
  std::uint64_t clocks() const { return clocks_; }
  std::uint64_t count_pairs() const { return pairs_; }
  std::uint64_t count_steps() const { return steps_; }

  /// Chip and bus are reset; the host drops its queries and takes a new generation of tags.
  void reset() {
    descriptors_.clear();
    answers_.clear();
    written_ = read_ = 0;
    unanswered_ = 0;
    Model& m = top();
    m.enable = 0;
    m.query_size_log2 = static_cast<CData>(chip_.query_log2);
    m.record_size_log2 = static_cast<CData>(chip_.record_log2);
    m.query_producer = 0;
    m.record_consumer = 0;
    for (std::uint64_t i = 0; i < (std::uint64_t{1} << chip_.record_log2); i += 4)
      memory_.line(record_line + i / 4) = {};
    simulation_.reset(3);
    m.enable = 1;
  }

  void step() {
    if (clocks_ % chip_.host_every == 0) host();
    simulation_.step();
    pairs_ += top().count_pair;
    steps_ += top().count_step;
    ++clocks_;
  }
  void steps(std::uint64_t clocks) {
    for (std::uint64_t i = 0; i < clocks; ++i) step();
  }
  /// Until every query has its answer. \returns false if that takes longer than that many clocks
  bool run(std::uint64_t most_clocks) {
    for (std::uint64_t i = 0; unanswered_ > 0; ++i) {
      if (i == most_clocks) return false;
      step();
    }
    return true;
  }

 private:
  void host() {
    Model& m = top();
    while (written_ < descriptors_.size() &&
           static_cast<std::uint16_t>(written_ - m.query_consumer) < (1U << chip_.query_log2)) {
      memory_.line(query_line + (written_ & ((1U << chip_.query_log2) - 1))) = descriptors_[written_];
      ++written_;
    }
    m.query_producer = static_cast<SData>(written_);
    for (; read_ != m.record_producer; ++read_) {
      const std::uint32_t place = read_ & ((1U << chip_.record_log2) - 1);
      RecordBytes bytes;
      std::memcpy(bytes.data(), memory_.line(record_line + place / 4).data() + 16 * (place % 4), bytes.size());
      collect(bytes);
    }
    m.record_consumer = read_;
  }

  void collect(const RecordBytes& bytes) {
    const bool phase = (bytes[7] >> 7) != 0;
    if (phase != ((read_ >> chip_.record_log2 & 1) == 0)) wrong_.push_back("phase of record " + std::to_string(read_));
    const std::uint32_t tag = decode_pair(bytes).tag;
    const std::size_t number = tag & 0xffffff;
    if (tag >> 24 != chip_.generation || number >= answers_.size()) {
      wrong_.push_back("record of no query, tag " + std::to_string(tag));
      return;
    }
    ChipAnswer& answer = answers_[number];
    if (answer.done) {
      wrong_.push_back("record after the last one of query " + std::to_string(number));
      ++duplicated_;
      return;
    }
    if (!is_done(bytes)) {
      answer.pairs.push_back(decode_pair(bytes));
      return;
    }
    answer.done = decode_done(bytes);
    --unanswered_;
    if (answer.done->pairs != answer.pairs.size())
      wrong_.push_back("number of pairs of query " + std::to_string(number));
  }

  Simulation<Model> simulation_;
  Memory memory_;
  ChipOptions chip_;
  std::vector<Line> descriptors_;
  std::vector<ChipAnswer> answers_;
  std::vector<std::string> wrong_;
  std::uint64_t next_image_ = first_image;
  std::size_t written_ = 0;
  std::uint32_t read_ = 0;
  std::size_t unanswered_ = 0, duplicated_ = 0;
  std::uint64_t clocks_ = 0, pairs_ = 0, steps_ = 0;
};

}  // namespace cchip::sim

#endif
