// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact model of cchip_axi_read. A Moore machine, like those in stream.hpp.
#ifndef CCHIP_BLOCKS_AXI_READ_HPP
#define CCHIP_BLOCKS_AXI_READ_HPP

#include <cchip/blocks/line_data.hpp>
#include <cchip/internal/model/stream.hpp>
#include <cchip/internal/wire/definitions.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace cchip::model {

/// cchip_axi_read: lines for several clients from a memory that answers in any order.
class AxiRead {
 public:
  struct Request {
    std::size_t slot = 0;
    std::uint64_t line = 0;  ///< address / 64
  };
  struct Beat {
    std::size_t id = 0;
    LineData data{};
    bool okay = true;
    bool last = false;
  };
  struct Inputs {
    std::uint32_t limit = 0;
    std::vector<std::optional<Request>> requests;  ///< one for each client
    bool arready = false;
    std::optional<Beat> beat;  ///< rvalid = 1
  };
  struct Address {
    std::size_t id = 0;
    std::uint64_t line = 0;
  };
  struct Answer {
    std::size_t client = 0;
    std::size_t slot = 0;
    bool last = false;
    ReadCode code = ReadCode::ok;     ///< defined if last
    std::optional<std::size_t> beat;  ///< without: an answer without data
    LineData data{};
  };

  /// \param beats of a line
  AxiRead(std::size_t clients, std::size_t slots, std::size_t beats)
      : slots_(slots),
        beats_(beats),
        queues_(clients, Fifo<Request>(slots)),
        reads_(clients * slots),
        outstanding_(reads_.size()) {}

  const std::optional<Answer>& answer() const { return answer_; }
  const std::optional<Address>& address() const { return address_; }
  bool rready() const { return rready_; }
  bool any_outstanding() const { return any_outstanding_; }
  /// Of each ID: its address is on offer, or its response is outstanding.
  const std::vector<bool>& outstanding() const { return outstanding_; }

  void clock(const Inputs& in);
  void reset(std::uint32_t limit);

 private:
  struct Read {
    bool live = false;  // the client waits
    bool owed = false;  // memory has beats to send
    int ticks = 0;      // seen while live, at most 2
    std::size_t count = 0;
    bool bad = false;
  };
  struct Failure {
    std::size_t id;
    ReadCode code;
  };
  struct Place {  // a beat or a failure, with what was known of its read when it came
    std::optional<Failure> failure;
    Beat beat;
    Read was;
  };

  /// What happens to the addresses on this clock, decided from the state before it.
  struct Addresses {
    bool dead = false;    // the one on offer has been given up
    bool issue = false;   // the head is put on offer
    bool refuse = false;  // the head is answered without having been offered
    bool load = false;    // the place of the head is free
    bool taken = false;
    bool next_owed = false;  // the place of the one behind the head has a response outstanding
  };

  bool late(std::size_t id) const { return reads_[id].live && reads_[id].ticks == 2; }

  Addresses decide(bool arready) const;
  std::optional<Failure> next_failure(bool refuse) const;
  void clock_outstanding();
  void clock_ticks();
  void clock_answer();
  void clock_place();
  void clock_addresses(const Addresses& now);
  void clock_requests(const std::vector<std::optional<Request>>& requests, bool load_head);
  void answer_failure(const Failure& failure, const Read& was);
  void answer_beat(const Beat& beat, const Read& was);

  std::size_t slots_;
  std::size_t beats_;
  std::vector<Fifo<Request>> queues_;
  std::vector<Read> reads_;
  std::vector<bool> outstanding_;
  std::size_t served_ = 0;
  SkidBuffer<Address> next_;
  std::optional<Address> head_, address_;
  bool head_owed_ = false;  // or an address in front of it was given up
  bool was_dead_ = false;
  bool refused_ = false;  // the head, on the last clock
  bool address_awaited_ = false;
  std::optional<std::size_t> issued_, taken_;  // on the last clock
  std::optional<Answer> answer_;
  Timeout timeout_{defs::memory_limit_default};
  bool tick_ = false;  // it expired on the last clock
  bool rready_ = false, any_outstanding_ = false;
  std::size_t scan_ = 0;
  std::optional<std::size_t> found_;
  std::optional<Failure> failing_, failed_;
  std::optional<Beat> beat_;
  std::optional<Place> place_;
};

}  // namespace cchip::model

#endif
